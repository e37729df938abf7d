// tileset.json read back: the rules of 3D Tiles 1.1, and where each tile's content must lie.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/validate/earth.h"
#include "pipeline/validate/finding.h"

namespace blockrand::validate {

/// A bounding volume in earth-centred coordinates.
struct Volume {
  enum class Kind { region, box, sphere } kind = Kind::region;
  std::array<double, 6> region{};            ///< west, south, east, north in radians; lowest and highest, m
  model::Point3 centre;                      ///< of a box or sphere
  std::array<model::Point3, 3> half_axes{};  ///< of a box
  double radius = 0;                         ///< of a sphere

  /// How many metres a point lies outside; 0 inside.
  double outside(const model::Point3& ecef) const;
  /// The eight corners of a box; empty for others.
  std::vector<model::Point3> corners() const;
};

/// A tile with content.
struct TilesetEntry {
  std::string uri;
  Matrix transform = kIdentity;                        ///< of the content to earth-centred coordinates
  std::vector<std::shared_ptr<const Volume>> volumes;  ///< of the tile first, then of its ancestors
};

struct Tileset {
  bool readable = false;
  std::string crs, height_reference;            ///< as asset.extras says
  std::map<std::string, TilesetEntry> entries;  ///< by uri
  std::vector<Finding> findings;                ///< TILESET_RULE, TILE_BOUNDS
};

/// Reads and checks: versions, volumes, errors that do not grow towards the leaves, transforms that are rigid
/// east-north-up frames on the ellipsoid, volumes inside of their ancestors', content named once. Never throws on
/// account of the bytes.
Tileset read_tileset(std::string_view bytes, const std::string& name);

/// The largest distance in metres by which a vertex lies outside of the tile's own volume and of its ancestors'.
struct Overhang {
  double own = 0, ancestor = 0;
};
Overhang overhang(const TilesetEntry& entry, const std::vector<model::Point3>& vertices);

/// What a vertex may lie outside: positions are stored as floats.
inline constexpr double kVolumeTolerance = 0.002;  // m

}  // namespace blockrand::validate
