# Target flags shared by all of Scree, as functions: nothing is set globally.

# scree_target(name): include root, warnings, sanitizers. -ffp-contract=off because the compiler must not decide per
# inlining context whether a*b+c is fused: the same expression has to give the same bits everywhere. -Wrestrict of
# GCC 12 warns of every std::string concatenation (GCC bug 105651).
function(scree_target name)
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}> $<INSTALL_INTERFACE:include/scree>)
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_compile_options(${name} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> -ffp-contract=off>)
  if(SCREE_SANITIZE)
    target_compile_options(${name} PUBLIC $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${SCREE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all>)
    target_link_options(${name} PUBLIC -fsanitize=${SCREE_SANITIZE})
  endif()
  if(SCREE_HAVE_FUZZ)  # coverage for libFuzzer
    target_compile_options(${name} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=fuzzer-no-link>)
  endif()
endfunction()

# scree_library(name SOURCES ...): static library with alias scree::<name without scree_>.
function(scree_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;HEADERS" ${ARGN})
  add_library(${name} STATIC ${arg_SOURCES})
  string(REPLACE "scree_" "" short ${name})
  add_library(scree::${short} ALIAS ${name})
  set_target_properties(${name} PROPERTIES EXPORT_NAME ${short} POSITION_INDEPENDENT_CODE ON)
  if(arg_HEADERS)
    target_sources(${name} PUBLIC FILE_SET HEADERS BASE_DIRS ${CMAKE_SOURCE_DIR} FILES ${arg_HEADERS})
  endif()
  scree_target(${name})
endfunction()

# scree_numerics(name): where tests spend their time. A build for sanitizers asks for -Og, under which these would run for
# minutes.
function(scree_numerics name)
  if(SCREE_SANITIZE)
    target_compile_options(${name} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-O1>)
  endif()
endfunction()

# scree_program_of_tests(name): tests spend their time in the libraries; optimising their own long functions fully costs a
# third of what a build from nothing takes.
function(scree_program_of_tests name)
  target_compile_options(${name} PRIVATE $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CONFIG:Release>>:-O1>)
endfunction()

# scree_test(name SOURCES ... LIBRARIES ...): one GoogleTest program, one ctest entry a test case.
function(scree_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  scree_target(${name})
  scree_program_of_tests(${name})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} GTest::gtest GTest::gtest_main)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  add_test(NAME ${name} COMMAND ${name} WORKING_DIRECTORY ${CMAKE_BINARY_DIR})
  # Tests ask for more threads than there may be cores, beside other tests: waiting threads must not spin.
  # What is kept between runs must not outlive a change of the code that made it.
  set_tests_properties(${name} PROPERTIES ENVIRONMENT
    "OMP_WAIT_POLICY=passive;SCREE_CACHE=;LSAN_OPTIONS=suppressions=${CMAKE_SOURCE_DIR}/tests/leaks.supp:print_suppressions=0")
endfunction()
