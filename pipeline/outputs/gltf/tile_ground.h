// The ground of a tile with its picture, where --ground asks for it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/model/ground_mesh.h"
#include "pipeline/outputs/gltf/ground_picture.h"
#include "pipeline/outputs/output.h"
#include "pipeline/outputs/tileset/tileset.h"

namespace blockrand::outputs {

/// What a build's list tells of the pictures, and where they are.
inline constexpr std::string_view kTileFolder = "tiles/";

struct TileGround {
  model::GroundMesh mesh;
  GroundCover cover;
  std::string webp, png;  ///< below the build's folder; empty where no image shows any of it
};

/// Makes it and writes the pictures: "tiles/15/X/Y_ground.webp", and .png with at most kPngPixels along a side, for readers that know
/// no WebP. Nothing where no picture of the ground is asked for, or the tile has no square.
std::optional<TileGround> write_tile_ground(FinishedTile& tile, const OutputContext& context);

/// m above the build's height reference.
double lowest_point(const model::GroundMesh& mesh);

/// Counts what a build tells of its grounds.
class GroundFigures {
 public:
  void add(const TileEntry& entry);
  /// "12 tiles, pixels of 0.20 m; no image shows 3 % of it"; empty where there is none.
  std::string text() const;
  /// Whether pixels are coarser than asked, and why; empty where not.
  std::string coarser(double asked) const;

 private:
  std::uint64_t tiles_ = 0, cells_ = 0, bare_ = 0;
  double finest_ = 0, coarsest_ = 0;
};

}  // namespace blockrand::outputs
