// Balconies: a slab on brackets with a railing on three sides.
#include <array>
#include <cmath>

#include "styles/elements/joinery.h"
#include "styles/elements/sweep.h"

namespace blockrand::elements {
namespace {

/// m. Posts at the corners, from the slab's edge to their middle; rails are narrower, so that no two faces are in one
/// plane.
constexpr double kPost = 0.05, kEdge = 0.07, kRail = 0.035;
/// m. Upright bars, and how far they reach into the rails.
constexpr double kBar = 0.016, kGrip = 0.01;

/// One side of a railing from u0 to u1: along x before the wall, or along z beside the door.
struct Side {
  bool front = true;
  double line = 0;  ///< m: z of the front, x of a side
  double u0 = 0, u1 = 0;
};

void side_box(MeshBuilder& b, const Side& s, double u0, double u1, double y0, double y1, double thick, Part part) {
  if (s.front)
    b.box({u0, y0, s.line - thick / 2}, {u1, y1, s.line + thick / 2}, part);
  else
    b.box({s.line - thick / 2, y0, u0}, {s.line + thick / 2, y1, u1}, part);
}

void add_bars(MeshBuilder& b, const Side& s, double height, double spacing, int detail) {
  side_box(b, s, s.u0, s.u1, height - 0.04, height, kRail, Part::metal);
  side_box(b, s, s.u0, s.u1, 0.08, 0.08 + kRail, kRail, Part::metal);
  const double low = 0.08 + kRail - kGrip, high = height - 0.04 + kGrip, length = s.u1 - s.u0;
  if (detail == 0) return side_box(b, s, s.u0 + kBar, s.u1 - kBar, low, high, kBar, Part::metal);
  const int count = static_cast<int>(std::floor(length / spacing));
  for (int k = 1; k < count; ++k) {
    const double u = s.u0 + length * k / count;
    side_box(b, s, u - kBar / 2, u + kBar / 2, low, high, kBar, Part::metal);
  }
}

/// Balusters between plinth and coping, square and narrow in the middle.
void add_balustrade(MeshBuilder& b, const Side& s, double height, double spacing, int detail) {
  side_box(b, s, s.u0, s.u1, -kApart, 0.10, 0.16, Part::surround);
  side_box(b, s, s.u0, s.u1, height - 0.10, height, 0.18, Part::surround);
  const double low = 0.10 - kGrip, high = height - 0.10 + kGrip, length = s.u1 - s.u0;
  const int count = std::max(1, static_cast<int>(std::floor(length / std::max(2 * spacing, 0.22))));
  for (int k = 0; k < count; ++k) {
    const double u = s.u0 + length * (k + 0.5) / count, waist = low + (high - low) * 0.45;
    if (detail == 0) {
      side_box(b, s, u - 0.04, u + 0.04, low, high, 0.08, Part::surround);
      continue;
    }
    side_box(b, s, u - 0.05, u + 0.05, low, waist, 0.10, Part::surround);
    side_box(b, s, u - 0.03, u + 0.03, waist - kGrip, high, 0.06, Part::surround);
  }
}

}  // namespace

Made make_balcony(const Request& r, Element& element) {
  const Values& v = r.values;
  const double depth = v.number("depth"), slab = v.number("slab"), half = r.width / 2;
  const int detail = v.detail(), consoles = v.count("consoles");
  MeshBuilder builder;
  builder.box({-half, -slab, -kApart}, {half, 0, depth}, Part::surround);
  const double wide = v.number("console_width"), high = v.number("console_height");
  if (consoles > 0 && consoles * wide * 1.5 > r.width) return no_room("so many brackets");
  for (int k = 0; k < consoles; ++k) {
    const double free = half - wide / 2 - 0.12;
    const double x = consoles == 1 ? 0 : -free + 2 * free * k / (consoles - 1);
    add_console(builder, x, -slab + kApart, wide, high, depth * 0.75, detail);
  }
  const bool stone = v.is("railing", "stone");
  const double post = stone ? 0.22 : kPost, edge = stone ? 0.13 : kEdge;
  const double x = half - edge, z = depth - edge, spacing = v.number("bar_spacing");
  if (x < post || z < post) return no_room("a railing");
  for (const double side : {-x, x})
    builder.box({side - post / 2, -2 * kApart, z - post / 2}, {side + post / 2, r.height + 0.02, z + post / 2},
                stone ? Part::surround : Part::metal);
  // Rails end within the posts, where they do not overlap, and within the wall.
  const double rail = stone ? 0.09 : kRail / 2;
  const std::array<Side, 3> sides{
      {{true, z, -x + rail, x - rail}, {false, -x, -kApart, z - kGrip}, {false, x, -kApart, z - kGrip}}};
  for (const Side& s : sides) {
    if (v.is("railing", "bars")) add_bars(builder, s, r.height, spacing, detail);
    if (stone) add_balustrade(builder, s, r.height, spacing, detail);
    if (v.is("railing", "panels") || v.is("railing", "glass")) {
      const bool glass = v.is("railing", "glass");
      side_box(builder, s, s.u0, s.u1, r.height - 0.04, r.height, kRail, Part::metal);
      side_box(builder, s, s.u0, s.u1, 0.06, r.height - 0.04 + kGrip, glass ? 0.012 : 0.024,
               glass ? Part::glass : Part::panel);
    }
  }
  element.mesh = builder.take();
  return {};
}

}  // namespace blockrand::elements
