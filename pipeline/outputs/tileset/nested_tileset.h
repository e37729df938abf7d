// The tileset of many tilesets: a tree of files, none of which grows with their number.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "pipeline/model/region.h"

namespace blockrand::outputs {

/// West, south, east, north in radians, lowest and highest in metres above the ellipsoid: a region of 3D Tiles.
using RegionVolume = std::array<double, 6>;

/// A tileset that another one leads to.
struct NestedTileset {
  model::TileId tile;  ///< what it covers, about
  std::string uri;     ///< relative to the outermost
  RegionVolume volume{};
  double error = 0;  ///< m, of its root
};

/// Tilesets by path: "tileset.json" leads to all, by way of tilesets/LEVEL/X/Y.json where there are many. Nodes are tiles of the
/// quadtree, each with the volume of what is below it and twice the largest error; one without a sibling is left out.
/// \param tilesets  in any order; none lies within another one's tile \param asset  of each file
/// \param most      a file names at most four times as many
std::map<std::string, std::string> nested_tilesets(const std::vector<NestedTileset>& tilesets,
                                                   const nlohmann::ordered_json& asset, std::size_t most = 64);

}  // namespace blockrand::outputs
