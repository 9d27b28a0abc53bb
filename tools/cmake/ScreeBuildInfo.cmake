# scree_build_info: a library of its own, so that a new commit relinks the programs that name it and nothing else.
set(features)
foreach(part CUDA MESH TRAINING EXCHANGE ONNX BENCHMARKS)
  if(SCREE_HAVE_${part})
    string(TOLOWER ${part} name)
    list(APPEND features ${name})
  endif()
endforeach()
list(JOIN features " " features)
set(generated ${CMAKE_BINARY_DIR}/generated/build_info.cpp)
add_custom_target(scree_write_build_info
  COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${CMAKE_SOURCE_DIR} -DOUTPUT=${generated} -DVERSION=${PROJECT_VERSION}
          "-DCOMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}" -DBUILD_TYPE=${CMAKE_BUILD_TYPE}
          "-DFEATURES=${features}" -P ${CMAKE_SOURCE_DIR}/tools/cmake/write_build_info.cmake
  BYPRODUCTS ${generated} VERBATIM)
scree_library(scree_build_info SOURCES ${generated} HEADERS ${CMAKE_SOURCE_DIR}/kernels/base/build_info.h)
add_dependencies(scree_build_info scree_write_build_info)
