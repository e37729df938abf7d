// What a build consists of for those who send it elsewhere: every file, and what must be there before it.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace blockrand::outward {

/// In which order files may become visible: none leads to one of a later step.
enum class Step : std::uint8_t {
  contents,   ///< what leads nowhere: textures, CityGML, GeoPackages, explanations
  tiles,      ///< GLB files, which show textures
  tilesets,   ///< from those that lead to tiles alone up to tileset.json
  documents,  ///< pages and projects that link the others
  record      ///< build.json, of areas first
};
std::string_view name(Step step);  ///< "contents"

struct BuildFile {
  std::string path;  ///< relative to the build, '/' separated
  std::uint64_t bytes = 0;
  std::string sha256;
  Step step = Step::contents;
  int level = 0;  ///< of tilesets: 0 leads to no other tileset, 1 to such ones; of records: 0 of areas, 1 of the whole
};

/// By the name alone.
Step step_of(std::string_view path);

/// All files of a build and of its areas, by path, as their build.json name them. run.json, which tells of the machine, is none.
/// \throws base::InputError  a record is missing or damaged, or names a path that leads out of the build; a tileset leads to
///                           a file that the build does not name
std::map<std::string, BuildFile> files_of_build(const std::string& folder);

/// What a tileset leads to, relative to the build; addresses with a scheme ("https:") are left out.
/// \param path  of the tileset, relative to the build
std::vector<std::string> contents_of_tileset(const std::string& folder, const std::string& path);

/// What a GLB file reads beside itself (textures, buffers), relative to the build.
std::vector<std::string> companions_of_glb(const std::string& folder, const std::string& path);

}  // namespace blockrand::outward
