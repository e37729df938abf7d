# What is installed where, and the packages made of it: cmake --install, and cpack's .deb and .tar.gz.
#   share/blockrand/configs             presets and materials; the program finds them from its own place
#   share/man, share/bash-completion …  printed by the program itself, from its option table
include(GNUInstallDirs)
set(documents ${CMAKE_BINARY_DIR}/documents)
set(doc_folder ${CMAKE_INSTALL_DOCDIR})

# blockrand_prints(FILE ARGUMENTS…): what `blockrand ARGUMENTS` says, as a file that follows the program.
function(blockrand_prints file)
  get_filename_component(folder ${documents}/${file} DIRECTORY)
  file(MAKE_DIRECTORY ${folder})
  add_custom_command(OUTPUT ${documents}/${file} COMMAND blockrand ${ARGN} > ${documents}/${file}.new
                     COMMAND ${CMAKE_COMMAND} -E rename ${documents}/${file}.new ${documents}/${file}
                     DEPENDS blockrand VERBATIM)
  set_property(GLOBAL APPEND PROPERTY BLOCKRAND_DOCUMENTS ${documents}/${file})
endfunction()
blockrand_prints(blockrand.1 help man)
blockrand_prints(bash/blockrand help completion bash)
blockrand_prints(zsh/_blockrand help completion zsh)
blockrand_prints(fish/blockrand.fish help completion fish)
get_property(printed GLOBAL PROPERTY BLOCKRAND_DOCUMENTS)
add_custom_target(documents ALL DEPENDS ${printed})

# Folders that an install makes are for everyone to read, whatever the umask.
set(CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
install(TARGETS blockrand RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DATADIR}/blockrand)
install(FILES ${documents}/blockrand.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${documents}/bash/blockrand DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${documents}/zsh/_blockrand DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(FILES ${documents}/fish/blockrand.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${doc_folder})
install(FILES pipeline/picture/fonts/LICENSE.txt DESTINATION ${doc_folder} RENAME LICENSE.DejaVu)  # the program holds the font
install(FILES viewer/bundle/LICENSES.txt DESTINATION ${doc_folder} RENAME LICENSES.viewer)  # and the page of `view`
if(JEMALLOC_LIBRARY AND EXISTS /usr/share/doc/libjemalloc-dev/copyright)  # the program holds the allocator
  install(FILES /usr/share/doc/libjemalloc-dev/copyright DESTINATION ${doc_folder} RENAME LICENSES.jemalloc)
endif()
install(FILES samples/blockrand-viertel.osm DESTINATION ${doc_folder}/examples)

set(CPACK_GENERATOR DEB TGZ)
set(CPACK_PACKAGE_NAME blockrand)
set(CPACK_PACKAGE_VENDOR "Blockrand")
set(CPACK_PACKAGE_CONTACT "Blockrand maintainers <maintainers@blockrand.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "rebuild a real neighbourhood in 3D from an OpenStreetMap extract")
set(CPACK_PACKAGE_DESCRIPTION
"Blockrand reads an OpenStreetMap extract and writes every building in it as
a closed, georeferenced solid with a roof: as 3D Tiles, CityGML, CityJSON and
GeoPackage. What the map does not say is inferred, and every value says where
it came from.")
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS ${CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS})
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_SOURCE_DIR}/LICENSE)
# The same bytes from the same commit: every time stamp is the commit's. Set when cpack starts.
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_SOURCE_DIR}/cmake/package_time.cmake)
set(CPACK_BLOCKRAND_SOURCE_DIR ${CMAKE_SOURCE_DIR})
set(CPACK_BLOCKRAND_DOC_FOLDER ${doc_folder})
set(CPACK_BLOCKRAND_MAN_FOLDER ${CMAKE_INSTALL_MANDIR})
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/cmake/debian/habits.cmake)
set(CPACK_POST_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/cmake/sorted_archive.cmake)
set(CPACK_SYSTEM_NAME ${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR})

set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Beside the libraries that dpkg-shlibdeps finds: coordinate systems and the EGM96 geoid are data, and some libraries are loaded by name.
set(CPACK_DEBIAN_PACKAGE_DEPENDS proj-data)
find_program(BLOCKRAND_DPKG_QUERY dpkg-query)
get_property(loaded GLOBAL PROPERTY blockrand_loaded_files)
foreach(file IN LISTS loaded)
  if(BLOCKRAND_DPKG_QUERY)
    execute_process(COMMAND ${BLOCKRAND_DPKG_QUERY} --search ${file} OUTPUT_VARIABLE owner ERROR_QUIET)
    if(owner MATCHES "^([a-z0-9.+-]+)")
      string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", ${CMAKE_MATCH_1}")
    endif()
  endif()
endforeach()
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
