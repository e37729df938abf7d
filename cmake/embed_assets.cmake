# Files as part of the program: writes a source that defines `std::string_view NAMESPACE::asset(std::string_view name)`.
# Called by blockrand_assets (BlockrandTargets.cmake) whenever one of the files changes.
#   cmake -DSOURCE=generated.cpp -DHEADER=pipeline/outputs/assets.h -DNAMESPACE=blockrand::outputs -DFOLDER=… -DFILES=a.css,b.js -P …
string(REPLACE "," ";" files "${FILES}")
set(text "// Made by cmake/embed_assets.cmake: do not edit.
#include \"${HEADER}\"

#include <stdexcept>
#include <string>

namespace ${NAMESPACE} {
namespace {

struct Asset {
  std::string_view name, content;
};
constexpr Asset kAssets[] = {
")
foreach(file IN LISTS files)
  file(READ "${FOLDER}/${file}" hex HEX)
  string(LENGTH "${hex}" digits)
  math(EXPR bytes "${digits} / 2")
  # Every byte is escaped: no quote, no trigraph, no @ of CMake can come between. 64 bytes a line.
  string(REGEX REPLACE "(..)" "\\\\x\\1" escaped "${hex}")
  string(REPEAT "...." 64 line)
  string(REGEX REPLACE "(${line})" "\\1\"\n     \"" escaped "${escaped}")
  string(APPEND text "    {\"${file}\", {\"${escaped}\", ${bytes}}},\n")
endforeach()
string(APPEND text "};

}  // namespace

std::string_view asset(std::string_view name) {
  for (const Asset& a : kAssets)
    if (a.name == name) return a.content;
  throw std::logic_error(std::string(name) + \" is no part of the program\");
}

}  // namespace ${NAMESPACE}
")
file(WRITE "${SOURCE}" "${text}")
