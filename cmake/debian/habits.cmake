# Run by cpack over the staged files of each package. A Debian package keeps its documentation in Debian's ways:
# compressed manual and changelogs, a copyright file that points to the licences every Debian has.
if(NOT CPACK_GENERATOR STREQUAL "DEB")
  return()
endif()
set(root ${CPACK_TEMPORARY_INSTALL_DIRECTORY}${CPACK_PACKAGING_INSTALL_PREFIX})
set(doc ${root}/${CPACK_BLOCKRAND_DOC_FOLDER})
set(man ${root}/${CPACK_BLOCKRAND_MAN_FOLDER}/man1/blockrand.1)

file(REMOVE ${doc}/LICENSE ${doc}/LICENSE.DejaVu)
file(COPY_FILE ${CMAKE_CURRENT_LIST_DIR}/copyright ${doc}/copyright)
file(RENAME ${doc}/CHANGELOG.md ${doc}/changelog)
# SOURCE_DATE_EPOCH, where it is set, is the time that this gives.
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(${CMAKE_CURRENT_LIST_DIR}/changelog.in ${doc}/changelog.Debian @ONLY)
# -n: neither name nor time of the file goes into the compressed one.
execute_process(COMMAND gzip -9n ${man} ${doc}/changelog ${doc}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
