# One library target per folder. A target sees its own headers and those of the targets it links, nothing else:
# every folder's headers stand behind an include directory of their own (a link farm in the build tree), so an include
# across the arrows of DESIGN section 4 does not compile.
#
#   blockrand_library(NAME base FOLDER pipeline/base SOURCES a.cpp ... LINKS blockrand::model ... PRIVATE_LINKS CGAL::CGAL ...)

# Bit-for-bit reproducible floating point on every x86-64 (DESIGN law 3): no contraction, no fast-math, no -march.
add_library(blockrand_options INTERFACE)
target_compile_definitions(blockrand_options INTERFACE BLOCKRAND_VERSION="${PROJECT_VERSION}")
# -Wrestrict: g++ 12 sees overlaps in std::string operator+ that are not there (GCC bug 105651).
target_compile_options(blockrand_options INTERFACE -Wall -Wextra -ffp-contract=off
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
                       $<$<BOOL:${BLOCKRAND_WERROR}>:-Werror>)
if(BLOCKRAND_SANITIZE)
  target_compile_options(blockrand_options INTERFACE -fsanitize=${BLOCKRAND_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(blockrand_options INTERFACE -fsanitize=${BLOCKRAND_SANITIZE})
endif()

function(blockrand_library)
  cmake_parse_arguments(ARG "" "NAME;FOLDER" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  set(target blockrand_${ARG_NAME})
  set(farm ${CMAKE_BINARY_DIR}/include/${ARG_NAME})
  get_filename_component(parent ${farm}/${ARG_FOLDER} DIRECTORY)
  file(MAKE_DIRECTORY ${parent})
  if(NOT EXISTS ${farm}/${ARG_FOLDER})
    file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${ARG_FOLDER} ${farm}/${ARG_FOLDER} SYMBOLIC)
  endif()
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    target_include_directories(${target} PUBLIC ${farm})
    target_link_libraries(${target} PUBLIC ${ARG_LINKS} PRIVATE ${ARG_PRIVATE_LINKS} blockrand_options)
  else()
    add_library(${target} INTERFACE)
    target_include_directories(${target} INTERFACE ${farm})
    target_link_libraries(${target} INTERFACE ${ARG_LINKS})
  endif()
  add_library(blockrand::${ARG_NAME} ALIAS ${target})
endfunction()
