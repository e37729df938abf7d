// What openings take up inside a solid, and what of the solid stands in the way.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "pipeline/base/random.h"
#include "pipeline/facades/outlines.h"
#include "pipeline/facades/wall_frame.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/model/solid.h"

namespace blockrand::facades {

/// A convex quadrangle of the plan, counter-clockwise, from one height to another: what a reveal or a tunnel takes up.
struct Block {
  std::array<model::Point2, 4> plan;
  double low = 0, high = 0;
  Box2 box;  ///< around the plan

  Block(const std::array<model::Point2, 4>& corners, double from, double to)
      : plan(corners), low(from), high(to), box(box_of(corners)) {}
  /// Convex, counter-clockwise, not flat.
  bool valid() const;
  bool contains(model::Point2 p) const;
  bool meets_segment(model::Point2 a, model::Point2 b) const;
  bool meets(const Block& other) const;
};

/// Boxes that come one by one, and which of them may meet another. Walls of towers have a hundred thousand openings, each
/// of which is held against the others near it.
class GrowingCells {
 public:
  /// \param low, high  m, of the third direction; 0 and 0 where there are but two
  void add(const Box2& box, double low, double high, std::uint32_t item);

  /// Calls `visit(item)` for all whose box may come within `distance` of this one, some of them more than once, until it
  /// returns true; tells whether it did.
  template <class Visit>
  bool any_near(const Box2& box, double low, double high, double distance, Visit&& visit) const {
    const Range range = range_of(box, low, high, distance);
    for (const std::uint32_t item : long_ones_)
      if (visit(item)) return true;
    for (std::int64_t x = range.low[0]; x <= range.high[0]; ++x)
      for (std::int64_t y = range.low[1]; y <= range.high[1]; ++y)
        for (std::int64_t z = range.low[2]; z <= range.high[2]; ++z)
          if (const auto cell = cells_.find({x, y, z}); cell != cells_.end())
            for (const std::uint32_t item : cell->second)
              if (visit(item)) return true;
    return false;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Range {
    Cell low, high;
  };
  struct Hash {
    std::size_t operator()(const Cell& c) const {
      return base::mix64(base::mix64(base::mix64(static_cast<std::uint64_t>(c[0])) ^ static_cast<std::uint64_t>(c[1])) ^
                         static_cast<std::uint64_t>(c[2]));
    }
  };
  static Range range_of(const Box2& box, double low, double high, double distance);

  std::unordered_map<Cell, std::vector<std::uint32_t>, Hash> cells_;
  std::vector<std::uint32_t> long_ones_;  ///< of very many cells: tunnels through whole blocks
};

/// The faces of a solid, each by something that is never smaller: upright ones by the rectangle around them, others by
/// the points between two planes over their outline. Holes of slopes, in which dormers stand, are open.
class Obstacles {
 public:
  /// \param solid  must outlive this
  explicit Obstacles(const model::Solid& solid);

  /// Whether a face other than these two comes into a block. May say so of faces that just miss it.
  bool blocked(const Block& block, std::uint32_t own, std::uint32_t other) const;

 private:
  /// A face that is not upright.
  struct Slope {
    std::vector<model::Point2> ring;
    std::vector<std::vector<model::Point3>> holes;
    Box2 box;
    double low = 0, high = 0;
    bool steep = false;  ///< no height can be told of its plane
    model::Point3 at;    ///< a point of its plane
    double sx = 0, sy = 0;
    double slack = 0;  ///< m of height that its corners lie off the plane at most
    /// Whether the slope itself, not one of its holes, is where its plane goes through the block. For what meets no outer border.
    bool reaches(const Block& block) const;
    double z(model::Point2 p) const { return at.z + (p.x - at.x) * sx + (p.y - at.y) * sy; }
  };
  struct Upright {
    model::Point2 a, b;
    Box2 box;
    double low = 0, high = 0;
    std::uint32_t face = 0;
  };
  void add_slope(const model::Solid& solid, std::uint32_t face);

  std::vector<Upright> uprights_;
  std::vector<Slope> slopes_;
  geometry::BoxIndex upright_boxes_, slope_boxes_;
};

}  // namespace blockrand::facades
