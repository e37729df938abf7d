# Run by cpack after each package. Its .tar.gz holds files in the order of the folders on disk, which is another one on
# another machine: packed again by GNU tar, sorted, as nobody's files, at the source's time.
if(NOT CPACK_GENERATOR STREQUAL "TGZ")
  return()
endif()
get_filename_component(folder ${CPACK_TEMPORARY_INSTALL_DIRECTORY} NAME)
string(TIMESTAMP seconds "%s" UTC)
foreach(archive ${CPACK_PACKAGE_FILES})
  execute_process(
    COMMAND tar --sort=name --format=gnu --owner=0 --group=0 --numeric-owner --mtime=@${seconds}
            --directory ${CPACK_TOPLEVEL_DIRECTORY} --create ${folder}
    COMMAND gzip -9n
    OUTPUT_FILE ${archive} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
