# One library target per folder. A target sees its own headers and those of the targets it links, nothing else:
# every folder's headers stand behind an include directory of their own (a link farm in the build tree), so an include
# across the arrows of ARCHITECTURE.md, "Targets that cannot see too far", does not compile.
#
#   OPTIMISED: O3 where nothing is said: with -O2, cities at LoD3 take up to 4 % more (docs/internal/RESULTS.md). O2 for what
#   reads and checks, which is as fast with it. Og for what nobody waits for: commands, options, orchestration. Each level
#   compiles a tenth to a third faster than the one before.
#   HEADERS standard | own | none: which precompiled header; `model` where nothing is said. `own` for targets with flags of
#   their own, which compile it again.
#   blockrand_library(NAME base FOLDER pipeline/base SOURCES a.cpp ... LINKS blockrand::model ... PRIVATE_LINKS CGAL::CGAL ...)

# Bit-for-bit reproducible floating point on every x86-64 (ARCHITECTURE.md, law 3): no contraction, no fast-math, no -march.
add_library(blockrand_options INTERFACE)
target_compile_definitions(blockrand_options INTERFACE BLOCKRAND_VERSION="${PROJECT_VERSION}")
# -Wswitch-enum: who adds an enumerator is told of every switch that forgets it, one with `default:` too.
# -Wrestrict, -Wstringop-overflow, -Wstringop-overread, -Warray-bounds: g++ 12 sees overlaps and overflows in std::string that are not there (GCC
# bug 105651 and its kin).
target_compile_options(blockrand_options INTERFACE -Wall -Wextra -Wswitch-enum -ffp-contract=off
                       "$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-stringop-overflow;-Wno-stringop-overread;-Wno-array-bounds>"
                       $<$<BOOL:${BLOCKRAND_WERROR}>:-Werror>)
# GCC collects its garbage from 128 MB on, many times for a source of 600 MB: a sixth of the time. Half a source's memory may
# lie uncollected now; the largest take 0.1 GB more, 1.3 GB in all.
target_compile_options(blockrand_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=400000>)
if(BLOCKRAND_SANITIZE)
  # Undefined behaviour ends the program as a bad access does: a message alone fails no test.
  target_compile_options(blockrand_options INTERFACE -fsanitize=${BLOCKRAND_SANITIZE} -fno-sanitize-recover=all
                         -fno-omit-frame-pointer)
  target_link_options(blockrand_options INTERFACE -fsanitize=${BLOCKRAND_SANITIZE})
endif()

# Half of the compiler's time went into reading the same headers again: what nearly all sources include is compiled once.
# A precompiled header holds only what a target may know: `standard` is the standard library and fmt, `model` the types
# of pipeline/model besides. A source includes what it uses all the same: -DBLOCKRAND_PCH=OFF builds without.
option(BLOCKRAND_PCH "Compile common headers once" ON)
set(standard_headers ${CMAKE_CURRENT_LIST_DIR}/standard_headers.h)

# blockrand_common_headers(standard): the target whose compiled headers others reuse. `model` and `tests` add headers.
function(blockrand_common_headers name)
  if(NOT BLOCKRAND_PCH)
    return()
  endif()
  set(unit ${CMAKE_BINARY_DIR}/${name}_headers.cpp)
  file(CONFIGURE OUTPUT ${unit} CONTENT "// A target needs a source.\n")
  add_library(blockrand_${name}_headers OBJECT ${unit})
  target_link_libraries(blockrand_${name}_headers PRIVATE blockrand_options ${ARGN})
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # ccache preprocesses: it must see that a precompiled header was used.
    target_compile_options(blockrand_options INTERFACE -fpch-preprocess)
  endif()
  set(model_headers "<pipeline/model/region.h>")
  set(tests_headers ${model_headers} "<fstream>" "<gmock/gmock.h>" "<gtest/gtest.h>" "<iostream>" "<random>")
  target_precompile_headers(blockrand_${name}_headers PRIVATE ${standard_headers} ${${name}_headers})
endfunction()

function(blockrand_use_headers target which)
  if(NOT BLOCKRAND_PCH OR which STREQUAL none)
    return()
  endif()
  if(which STREQUAL own)
    target_precompile_headers(${target} PRIVATE ${standard_headers} "<pipeline/model/region.h>")
  elseif(which STREQUAL standard OR which STREQUAL tests)
    target_precompile_headers(${target} REUSE_FROM blockrand_${which}_headers)
  else()
    target_precompile_headers(${target} REUSE_FROM blockrand_model_headers)
  endif()
endfunction()

# The optimiser instantiates the same templates for each source: sources that compiled_together.cmake names together go as
# one, which halves a first build. Warnings name the sources all the same. OFF for tools that want a command per source.
option(BLOCKRAND_TOGETHER "Compile small sources of a folder as one" ON)
function(blockrand_compile_together name)
  set_property(GLOBAL APPEND PROPERTY blockrand_groups_${name} "${ARGN}|")
endfunction()
include(compiled_together)

# In the directory of the target: source properties belong there.
function(blockrand_group_sources target name)
  get_property(groups GLOBAL PROPERTY blockrand_groups_${name})
  if(NOT BLOCKRAND_TOGETHER OR NOT groups)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  set(number 1)
  foreach(source IN LISTS groups)
    string(REPLACE "|" "" file "${source}")
    if(file)
      get_target_property(sources ${target} SOURCES)
      if(NOT file IN_LIST sources)
        message(FATAL_ERROR "cmake/compiled_together.cmake names ${file}, which is no source of ${target}: take it out")
      endif()
      set_source_files_properties(${file} PROPERTIES UNITY_GROUP group_${number})
    endif()
    if(source MATCHES "\\|$")
      math(EXPR number "${number} + 1")
    endif()
  endforeach()
endfunction()

function(blockrand_library)
  cmake_parse_arguments(ARG "" "NAME;FOLDER;HEADERS;OPTIMISED" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
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
    blockrand_use_headers(${target} "${ARG_HEADERS}")
    blockrand_group_sources(${target} ${ARG_NAME})
    if(ARG_OPTIMISED)
      target_compile_options(${target} PRIVATE $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU,Clang>>:-${ARG_OPTIMISED}>)
    endif()
    set_property(GLOBAL APPEND PROPERTY blockrand_archives ${target})
  else()
    add_library(${target} INTERFACE)
    target_include_directories(${target} INTERFACE ${farm})
    target_link_libraries(${target} INTERFACE ${ARG_LINKS})
  endif()
  add_library(blockrand::${ARG_NAME} ALIAS ${target})
  set_property(GLOBAL APPEND PROPERTY blockrand_table "${ARG_FOLDER}|${ARG_LINKS};${ARG_PRIVATE_LINKS}")
endfunction()

# A library that the program loads when it needs it (pipeline/base/shared_library.h): its headers for `target` and those who link it, and its
# file's name as BLOCKRAND_<NAME>_SONAME.
function(blockrand_loads target name library)
  target_include_directories(${target} SYSTEM PUBLIC $<TARGET_PROPERTY:${library},INTERFACE_INCLUDE_DIRECTORIES>)
  foreach(configuration IN ITEMS "" _NONE _RELEASE _RELWITHDEBINFO _NOCONFIG)
    if(NOT soname)
      get_target_property(soname ${library} IMPORTED_SONAME${configuration})
      get_target_property(file ${library} IMPORTED_LOCATION${configuration})
    endif()
  endforeach()
  if(NOT soname)
    message(FATAL_ERROR "${library}: its CMake files do not name its SONAME. Use the distribution's package")
  endif()
  target_compile_definitions(${target} PRIVATE BLOCKRAND_${name}_SONAME="${soname}")
  set_property(GLOBAL APPEND PROPERTY blockrand_loaded_files ${file})
endfunction()

# Files that are part of the program, such as style sheets and scripts: `asset("report/report.css")`, which HEADER declares.
#   blockrand_assets(blockrand_outputs HEADER pipeline/outputs/assets.h NAMESPACE blockrand::outputs FILES report/report.css …)
function(blockrand_assets target)
  cmake_parse_arguments(ARG "" "HEADER;NAMESPACE;FOLDER" "FILES" ${ARGN})
  if(NOT ARG_FOLDER)
    set(ARG_FOLDER ${CMAKE_CURRENT_SOURCE_DIR})
  endif()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${target}_assets.cpp)
  set(script ${CMAKE_SOURCE_DIR}/cmake/embed_assets.cmake)
  set(paths ${ARG_FILES})
  list(TRANSFORM paths PREPEND ${ARG_FOLDER}/)
  list(JOIN ARG_FILES "," files)
  add_custom_command(OUTPUT ${source} DEPENDS ${paths} ${script} VERBATIM
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${source} -DHEADER=${ARG_HEADER} -DNAMESPACE=${ARG_NAMESPACE} -DFOLDER=${ARG_FOLDER}
            -DFILES=${files} -P ${script})
  target_sources(${target} PRIVATE ${source})
  set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# Writes the table of targets, in the order of the build, as ARCHITECTURE.md has it: a test compares the two.
function(blockrand_write_target_table file)
  get_property(rows GLOBAL PROPERTY blockrand_table)
  set(text "| folder | knows | and of others |\n|---|---|---|\n")
  set(ours "")
  set(others "")
  set(folder "")
  foreach(item IN LISTS rows ITEMS "|")
    if(item MATCHES "^([^|]*)\\|(.*)$")
      if(folder)
        list(SORT ours)
        list(SORT others)
        list(REMOVE_DUPLICATES ours)
        list(REMOVE_DUPLICATES others)
        list(JOIN ours "`, `" ours_text)
        list(JOIN others ", " others_text)
        if(ours_text)
          set(ours_text "`${ours_text}`")
        endif()
        string(APPEND text "| `${folder}` | ${ours_text} | ${others_text} |\n")
      endif()
      set(folder "${CMAKE_MATCH_1}")
      set(ours "")
      set(others "")
      set(item "${CMAKE_MATCH_2}")
    endif()
    if(item MATCHES "^blockrand::(.*)$")
      list(APPEND ours "${CMAKE_MATCH_1}")
    elseif(item MATCHES "^([A-Za-z_0-9]+)")
      list(APPEND others "${CMAKE_MATCH_1}")
    endif()
  endforeach()
  file(WRITE ${file} "${text}")
endfunction()
