#include "pipeline/outputs/tileset/tileset.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kEarthRadius = 6335000;  // m; the smallest radius of curvature of the ellipsoid
// m; positions and places count in 1/4096 m, and a long element turns by up to 3e-5 with the rounding of its rotation
constexpr double kBoxMargin = 0.005;

/// Degrees and metres.
struct Bounds {
  double west = 0, south = 0, east = 0, north = 0, low = 0, high = 0;
  void add(const Bounds& b) {
    west = std::min(west, b.west);
    south = std::min(south, b.south);
    east = std::max(east, b.east);
    north = std::max(north, b.north);
    low = std::min(low, b.low);
    high = std::max(high, b.high);
  }
};

/// Degrees of latitude, beyond which bounds are those of a polar cap: 10 bulges are enough for the box's corners while the tangent of the latitude is below 20.
constexpr double kPolar = 87;

Bounds widened_bounds(const TileEntry& tile) {
  const double e = std::max(std::abs(tile.min.x), std::abs(tile.max.x));
  const double n = std::max(std::abs(tile.min.y), std::abs(tile.max.y));
  const double bulge = (e * e + n * n) / kEarthRadius;
  const double horizontal = (0.05 + 10 * bulge) / kEarthRadius / kRadians;
  const double vertical = 0.05 + bulge;
  const double latitude = std::max(std::abs(tile.south), std::abs(tile.north));
  // cos(latitude) >= 1 - latitude/90: a bound that needs no cosine.
  const double shrink = std::max(1 - latitude / 90, 1e-3);
  if (latitude > kPolar) {
    // Corners of the box lie on any meridian here, and farther from the pole than what is in it; no farther from that than
    // across the circle around the box.
    const double across = (2 * std::sqrt(e * e + n * n) + 0.05) / kEarthRadius / kRadians + horizontal;
    return {-180,
            std::max(tile.south - across, -90.0),
            180,
            std::min(tile.north + across, 90.0),
            tile.min_height - vertical,
            tile.max_height + vertical};
  }
  Bounds b{tile.west - horizontal / shrink, tile.south - horizontal,    tile.east + horizontal / shrink,
           tile.north + horizontal,         tile.min_height - vertical, tile.max_height + vertical};
  if (tile.west > tile.east || b.west < -180 || b.east > 180) {
    b.west = -180;  // rare, and a whole circle of latitude is a correct bound for what crosses 180 degrees
    b.east = 180;
  }
  b.south = std::max(b.south, -90.0);
  b.north = std::min(b.north, 90.0);
  return b;
}

/// Position along a Z-order curve from the root, so that every subtree is a run of tiles.
std::uint64_t z_order(model::TileId id) {
  std::uint64_t key = 0;
  for (int bit = id.level; bit >= 0; --bit)
    key = key << 2 | static_cast<std::uint64_t>(id.y >> bit & 1u) << 1 | (id.x >> bit & 1u);
  return key;
}

class Writer {
 public:
  Writer(std::span<const TileEntry> tiles, const TilesetOptions& options) : options_(options) {
    for (const TileEntry& tile : tiles) leaves_.push_back({z_order(tile.id), &tile, widened_bounds(tile)});
    std::sort(leaves_.begin(), leaves_.end(), [](const Leaf& a, const Leaf& b) { return a.key < b.key; });
  }

  std::string write() {
    out_ = "{\"asset\":{\"version\":\"1.1\",\"extras\":{\"generator\":";
    append_json(out_, options_.generator);
    out_ += ",\"crs\":";
    append_json(out_, options_.crs);
    out_ += ",\"height_reference\":";
    append_json(out_, options_.height_reference);
    out_ += ",\"attribution\":";
    append_json(out_, options_.attribution);
    out_ += "}},";
    if (leaves_.empty()) {
      out_ +=
          "\"geometricError\":0,\"root\":{\"boundingVolume\":{\"box\":[0,0,0,0,0,0,0,0,0,0,0,0]},"
          "\"geometricError\":0,\"refine\":\"ADD\"}}\n";
      return std::move(out_);
    }
    // The root is the lowest tile that holds all leaves (-1: the whole Earth), but never a leaf itself.
    const int leaf_level = leaves_.front().tile->id.level;
    int level = leaf_level;
    while (shift(leaves_.front().key, leaf_level - level) != shift(leaves_.back().key, leaf_level - level)) --level;
    level = std::min(level, leaf_level - 1);
    geometric_error(2 * error_at(level, leaf_level));
    out_ += ",\"root\":";
    parent(0, leaves_.size(), level, leaf_level, true);
    out_ += "}\n";
    return std::move(out_);
  }

 private:
  struct Leaf {
    std::uint64_t key = 0;
    const TileEntry* tile = nullptr;
    Bounds bounds;
  };

  static std::uint64_t shift(std::uint64_t key, int levels) { return key >> (2 * levels); }

  double error_at(int level, int leaf_level) const {
    double error = options_.parent_error;
    for (int l = leaf_level - 1; l > level; --l) error *= 2;
    return error;
  }

  void geometric_error(double error) {
    out_ += "\"geometricError\":";
    append_number(out_, error);
  }

  /// Writes the smallest node for leaves [first, last), which all lie in one tile of `level`.
  void node(std::size_t first, std::size_t last, int level, int leaf_level) {
    if (last - first == 1) return leaf(*leaves_[first].tile);
    while (shift(leaves_[first].key, leaf_level - level - 1) == shift(leaves_[last - 1].key, leaf_level - level - 1))
      ++level;
    parent(first, last, level, leaf_level, false);
  }

  void parent(std::size_t first, std::size_t last, int level, int leaf_level, bool root) {
    Bounds bounds = leaves_[first].bounds;
    for (std::size_t i = first + 1; i < last; ++i) bounds.add(leaves_[i].bounds);
    out_ += "{\"boundingVolume\":{\"region\":[";
    for (const double degrees : {bounds.west, bounds.south, bounds.east, bounds.north}) {
      append_number(out_, degrees * kRadians);
      out_ += ',';
    }
    append_number(out_, bounds.low);
    out_ += ',';
    append_number(out_, bounds.high);
    out_ += "]},";
    geometric_error(error_at(level, leaf_level));
    if (root) out_ += ",\"refine\":\"ADD\"";
    out_ += ",\"children\":[";
    for (std::size_t i = first; i < last;) {
      const std::uint64_t child = shift(leaves_[i].key, leaf_level - level - 1);
      std::size_t end = i;
      while (end < last && shift(leaves_[end].key, leaf_level - level - 1) == child) ++end;
      if (i != first) out_ += ',';
      node(i, end, level + 1, leaf_level);
      i = end;
    }
    out_ += "]}";
  }

  /// The tile's levels, one inside the other in the same box; the outermost has the transform.
  void leaf(const TileEntry& tile) {
    assert(tile.id.level == leaves_.front().tile->id.level);
    if (!tile.surroundings && !tile.ground) return buildings(tile, true);
    level(tile, true, options_.parent_error);
    out_ += ",\"refine\":\"ADD\",\"children\":[";
    for (const std::optional<TilePiece>* beside : {&tile.ground, &tile.surroundings}) {
      if (!*beside) continue;
      if (out_.back() != '[') out_ += ',';
      out_ += '{';
      box((*beside)->min, (*beside)->max);
      out_ += ',';
      geometric_error(0);
      content((*beside)->uri);
      out_ += '}';
    }
    if (!tile.uri.empty() || !tile.pieces.empty()) {
      out_ += ',';
      buildings(tile, false);
    }
    out_ += "]}";
  }

  /// \param outermost  it has the transform
  void buildings(const TileEntry& tile, bool outermost) {
    for (std::size_t i = 0; i < tile.coarser.size(); ++i) {
      level(tile, outermost && i == 0, tile.coarser[i].geometric_error);
      out_ += ",\"refine\":\"REPLACE\"";
      content(tile.coarser[i].uri);
      out_ += ",\"children\":[";
    }
    if (tile.pieces.empty()) {
      level(tile, outermost && tile.coarser.empty(), 0);
      content(tile.uri);
      out_ += '}';
    } else {
      if (tile.coarser.empty()) {
        level(tile, outermost, options_.parent_error);
        out_ += ",\"children\":[";
      }
      for (const TilePiece& piece : tile.pieces) {
        if (&piece != tile.pieces.data()) out_ += ',';
        out_ += '{';
        box(piece.min, piece.max);
        out_ += ',';
        geometric_error(0);
        content(piece.uri);
        out_ += '}';
      }
      if (tile.coarser.empty()) out_ += "]}";
    }
    for (std::size_t i = 0; i < tile.coarser.size(); ++i) out_ += "]}";
  }

  /// Begins a level of a tile.
  void level(const TileEntry& tile, bool outermost, double error) {
    out_ += '{';
    box(tile.min, tile.max);
    if (outermost) transform(tile);
    out_ += ',';
    geometric_error(error);
  }

  void content(const std::string& uri) {
    out_ += ",\"content\":{\"uri\":";
    append_json(out_, uri);
    out_ += '}';
  }

  void box(const model::Point3& min, const model::Point3& max) {
    out_ += "\"boundingVolume\":{\"box\":[";
    const double centre[3] = {(min.x + max.x) / 2, (min.y + max.y) / 2, (min.z + max.z) / 2};
    const double half[3] = {(max.x - min.x) / 2 + kBoxMargin, (max.y - min.y) / 2 + kBoxMargin,
                            (max.z - min.z) / 2 + kBoxMargin};
    for (const double c : centre) {
      append_number(out_, c);
      out_ += ',';
    }
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < 3; ++i) {
        append_number(out_, i == axis ? half[axis] : 0.0);
        if (axis != 2 || i != 2) out_ += ',';
      }
    out_ += "]}";
  }

  void transform(const TileEntry& tile) {
    out_ += ",\"transform\":[";
    for (int i = 0; i < 16; ++i) {
      if (i) out_ += ',';
      append_number(out_, tile.enu_to_ecef[static_cast<std::size_t>(i)]);
    }
    out_ += ']';
  }

  const TilesetOptions& options_;
  std::vector<Leaf> leaves_;
  std::string out_;
};

}  // namespace

std::string write_tileset(std::span<const TileEntry> tiles, const TilesetOptions& options) {
  return Writer(tiles, options).write();
}

}  // namespace blockrand::outputs
