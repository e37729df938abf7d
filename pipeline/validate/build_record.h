// build.json read back: what the build says of itself, and whether its files are the ones it lists.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/progress.h"
#include "pipeline/validate/checked_json.h"
#include "pipeline/validate/finding_log.h"

namespace blockrand::validate {

struct BuildFile {
  std::uint64_t bytes = 0;
  std::string sha256;
};

struct BuildRecord {
  Json json;
  int lod = 2;
  std::set<std::string, std::less<>> formats;  ///< "gltf", "citygml" …
  bool baked = false;                          ///< elements are triangles of their buildings' meshes
  bool single_objects = false;                 ///< model.glb is made of objects of houses
  bool single_baked = false;                   ///< the same, in model.glb
  bool people = false;                         ///< property tables have the attribute profile `people`
  bool lean_citygml = false;                   ///< CityGML of LoD3 has flat openings, ornaments without small pieces
  bool gzip = false, precompress = false, single_glb = false, single_cityjson = false, report = false, explain = false;
  std::string crs, pipeline, vertical_crs, height_reference;
  std::string
      raised_from;  ///< vertical CRS from which heights were raised to the ellipsoid in 3D Tiles; empty: none, or unknown
  double accuracy = 0;  ///< m, as PROJ states it for the operation
  std::string extract_path, extract_sha256;
  std::map<std::string, BuildFile> files;
  /// A member of "counts"; nothing where it is missing.
  std::optional<std::uint64_t> count(const char* name) const { return whole(member(member(json, "counts"), name)); }
  bool has(std::string_view format) const { return formats.find(format) != formats.end(); }
};

/// Reads FOLDER/build.json and checks that its fields are there and do not contradict each other (BUILD_JSON).
/// \return nothing where it is no JSON object
std::optional<BuildRecord> read_build_record(const std::string& folder, FindingLog& log);

/// The files below the folder (build.json and run.json left out) against the list: FILE_MISSING, FILE_UNLISTED; and
/// against the configuration (BUILD_JSON).
/// \return side files of other programs (base::is_side_file), sorted: they are no findings
std::vector<std::string> check_file_list(const std::string& folder, const BuildRecord& record, FindingLog& log);

/// Sizes and SHA-256 of all listed files that are there: FILE_CHANGED. Phase "hashes" of `progress`.
/// \return how many files were read
std::uint64_t check_hashes(const std::string& folder, const BuildRecord& record, int workers, base::Progress& progress,
                           FindingLog& log);

}  // namespace blockrand::validate
