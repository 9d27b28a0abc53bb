# format.cmake: every C++ source is as clang-format leaves it. Usage: cmake -DCLANG_FORMAT=... -DROOT=... -P format.cmake
file(GLOB_RECURSE sources ${ROOT}/kernels/*.h ${ROOT}/kernels/*.cpp ${ROOT}/shapes/*.h ${ROOT}/shapes/*.cpp
     ${ROOT}/training/*.h ${ROOT}/training/*.cpp ${ROOT}/core/*.h ${ROOT}/core/*.cpp ${ROOT}/tools/*.h ${ROOT}/tools/*.cpp
     ${ROOT}/tests/*.h ${ROOT}/tests/*.cpp ${ROOT}/kernels/*.cu ${ROOT}/tools/*.cu)
execute_process(COMMAND ${CLANG_FORMAT} --dry-run --Werror ${sources} RESULT_VARIABLE status ERROR_VARIABLE output)
if(NOT status EQUAL 0)
  string(REGEX MATCHALL "[^\n]*: error: code should be clang-formatted" lines "${output}")
  list(JOIN lines "\n" text)
  message("${text}")
  message(FATAL_ERROR "not formatted: run clang-format -i on these files")
endif()
