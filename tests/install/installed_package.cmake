# installed_package.cmake: installs Scree to a fresh prefix, moves that, builds main.cpp against it and runs it.
# Usage: cmake -DBUILD=... -DSOURCE=tests/install -DWORK=scratch folder -P installed_package.cmake
file(REMOVE_RECURSE ${WORK})
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN} failed:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/first)
file(RENAME ${WORK}/first ${WORK}/prefix)  # nothing may point to where it was
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/falling ${SOURCE}/falling.toml)
if(NOT output STREQUAL "0.100000 s 0.950000 m\n")  # z = 1 - g t^2 / 2
  message(FATAL_ERROR "the program printed '${output}'")
endif()
run(${WORK}/prefix/bin/scree check ${SOURCE}/falling.toml)
file(REMOVE_RECURSE ${WORK})
