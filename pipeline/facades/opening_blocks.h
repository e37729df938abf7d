// What openings take up inside a solid, and what of the solid stands in the way.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/facades/outlines.h"
#include "pipeline/facades/wall_frame.h"
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

/// The faces of a solid, each by something that is never smaller: upright ones by the rectangle around them, others by
/// the points between two planes over their outline (holes are filled).
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
    Box2 box;
    double low = 0, high = 0;
    bool steep = false;  ///< no height can be told of its plane
    model::Point3 at;    ///< a point of its plane
    double sx = 0, sy = 0;
    double slack = 0;  ///< m of height that its corners lie off the plane at most
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
};

}  // namespace blockrand::facades
