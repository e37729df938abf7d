# Read by cpack when it starts. Time stamps in packages are those of the source, so that the same source gives the same
# package: SOURCE_DATE_EPOCH where it is set (reproducible-builds.org), else the commit's time, else, without git, 1980.
if("$ENV{SOURCE_DATE_EPOCH}" STREQUAL "")
  execute_process(COMMAND git -C ${CPACK_BLOCKRAND_SOURCE_DIR} log -1 --format=%ct OUTPUT_VARIABLE seconds
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(failed OR NOT seconds MATCHES "^[0-9]+$")
    set(seconds 315532800)
  endif()
  set(ENV{SOURCE_DATE_EPOCH} ${seconds})
endif()
