# Script mode: configures build_info.cpp; run at every build, because the commit changes without a new configure.
# configure_file leaves an unchanged file alone, so nothing is rebuilt for nothing.
execute_process(COMMAND git rev-parse --short=12 HEAD WORKING_DIRECTORY ${SOURCE_DIR}
                OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  set(COMMIT "unknown")
else()
  execute_process(COMMAND git diff-index --quiet HEAD -- WORKING_DIRECTORY ${SOURCE_DIR} RESULT_VARIABLE modified ERROR_QUIET)
  if(NOT modified EQUAL 0)
    string(APPEND COMMIT "-modified")
  endif()
endif()
configure_file(${SOURCE_DIR}/kernels/base/build_info.cpp.in ${OUTPUT} @ONLY)
