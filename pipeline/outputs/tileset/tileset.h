// The tileset that places a build's tiles on the globe.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/model/region.h"

namespace blockrand::outputs {

/// m. What a level lacks, as viewers measure it: with the usual 16 pixels of tolerance, 1080 lines and a field of view
/// of 60 degrees they go on to the next finer level within 58 times this distance. LoD2 lacks facades; within 350 m a
/// storey of 3 m with its windows is 8 pixels high. Blocks without roofs are no level of their own: their files have 95 % of
/// the bytes of those with roofs.
inline constexpr double kRoofError = 6;

/// The same buildings in less detail.
struct CoarserLevel {
  std::string uri;
  double geometric_error = 0;  ///< m
};

/// A part of a tile's buildings, in the frame of the tile.
struct TilePiece {
  std::string uri;
  model::Point3 min, max;  ///< as TileEntry has them
};

/// A tile with content.
struct TileEntry {
  model::TileId id;
  std::string uri;                                  ///< relative to the tileset: "tiles/15/x/y.glb"; empty with pieces
  std::vector<TilePiece> pieces;                    ///< instead of the one file
  std::vector<CoarserLevel> coarser;                ///< the coarsest first; errors fall
  std::optional<TilePiece> surroundings;            ///< a tile of its own beside that of the buildings
  std::optional<TilePiece> ground;                  ///< another: the ground as a picture
  double ground_pixel = 0;                          ///< m, of that picture
  std::uint64_t ground_cells = 0, bare_cells = 0;   ///< of its mesh; of them without a pixel of any image
  std::array<double, 16> enu_to_ecef{};             ///< column-major
  model::Point3 min, max;                           ///< of all levels: m east, north, up of the tile's origin
  double west = 0, south = 0, east = 0, north = 0;  ///< degrees; west > east where the mesh crosses 180°
  double min_height = 0, max_height = 0;            ///< m above the ellipsoid
  std::set<std::string> textures;                   ///< names of those that its files show
  std::uint64_t too_light = 0;                      ///< triangles that stay plain: lighter than their texture
};

struct TilesetOptions {
  std::string crs;               ///< of the build
  std::string height_reference;  ///< in words
  std::string generator;
  std::string attribution;
  /// m. Geometric error of the parents of the leaves; it doubles with every level above. A viewer with the usual 16
  /// pixels of tolerance and 1080 lines then loads buildings within about 6 km.
  double parent_error = 100;
};

/// A 3D Tiles 1.1 tileset.json: leaves with content in boxes (in the tile's frame, z up), above them their parents in
/// the geodetic quadtree as regions without content, where a parent with a single child is left out but for the root.
///
/// Where there are surroundings or a picture of the ground, they and the buildings are children of a tile without content: they
/// stay when levels of buildings replace each other.
/// A tile with coarser levels is a chain of them, each replaced by the next (REPLACE), the finest last. Pieces are the children of
/// what would have been their parent; where there is no coarser level, of a tile without content.
///
/// Regions are widened by what a box corner can lie outside the bounds of its vertices: 5 cm, and 10 r²/R horizontally
/// and r²/R vertically for a mesh of radius r around its origin (R: the Earth's), from the convergence of meridians up
/// to 79° of latitude and from the curvature. Angles are degrees times a constant; no other maths enters.
/// Without tiles the root is an empty box.
/// \param tiles  in any order; no two with the same id, all of one level
std::string write_tileset(std::span<const TileEntry> tiles, const TilesetOptions& options);

}  // namespace blockrand::outputs
