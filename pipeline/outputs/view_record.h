// What the page of `blockrand view` is told of a build: view.json.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blockrand::outputs {

/// Where a tileset lies.
struct TilesetExtent {
  double longitude = 0, latitude = 0;  ///< degrees: the middle
  double height = 0;                   ///< m: the least, above the ellipsoid
};
/// \param tileset  the text of a tileset.json, whose root has a region
/// \returns nothing where it is none
std::optional<TilesetExtent> extent_of_tileset(std::string_view tileset);

struct ViewRecord {
  std::string name;  ///< for people
  int lod = 0;       ///< highest level of detail
  std::uint64_t buildings = 0;
  std::string attribution;
  TilesetExtent extent;
  std::string tileset;                   ///< path relative to the page
  std::vector<std::string> places;       ///< paths of places.tsv
  std::optional<std::string> explained;  ///< folder of explanations
  std::string data_time;                 ///< ISO 8601; may be empty
};
std::string view_json(const ViewRecord& record);

}  // namespace blockrand::outputs
