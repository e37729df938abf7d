// Leaves, panes and glazing bars.
#include "styles/elements/joinery.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace blockrand::elements {

using model::Point2;
using model::Point3;

Made no_room(std::string_view what) { return tl::unexpected(fmt::format("no room for {}", what)); }

Outline with_foot(Outline outline, double y) {
  const double least = bounds_of(outline).least.y;
  for (Point2& p : outline)
    if (p.y == least) p.y = y;
  return outline;
}

void add_strip(MeshBuilder& builder, const Outline& outline, double z_front, double z_back, Part part) {
  if (outline.empty()) return;
  builder.begin_body();
  builder.plate(outline, {}, z_front, part);
  builder.rim(outline, z_front, z_back, part);
}

Made add_bars(MeshBuilder& builder, const Outline& pane, const Bars& bars, double front, double glass, Part part) {
  const Bounds2 box = bounds_of(pane);
  if (bars.upright > 0 && (box.width() - bars.upright * bars.width) / (bars.upright + 1) < kLeastPane)
    return no_room("so many upright bars");
  if (bars.level > 0 && (box.height() - bars.level * bars.width) / (bars.level + 1) < kLeastPane)
    return no_room("so many level bars");
  // Front and the two long sides; the ends touch the leaf.
  const auto add = [&](const Outline& strip, bool upright, double z) {
    if (strip.empty()) return;
    builder.begin_body();
    builder.plate(strip, {}, z, part);
    for (std::size_t i = 0; i < strip.size(); ++i) {
      const Point2 a = strip[i], b = strip[(i + 1) % strip.size()];
      if (upright ? std::fabs(a.x - b.x) > 1e-9 : std::fabs(a.y - b.y) > 1e-9) continue;
      builder.face(std::array<Point3, 4>{{{a.x, a.y, glass}, {b.x, b.y, glass}, {b.x, b.y, z}, {a.x, a.y, z}}}, part);
    }
  };
  for (int k = 1; k <= bars.upright; ++k) {
    const double x = box.least.x + box.width() * k / (bars.upright + 1);
    add(between_x(pane, x - bars.width / 2, x + bars.width / 2), true, front - kApart);
  }
  for (int k = 1; k <= bars.level; ++k) {
    const double y = box.least.y + box.height() * k / (bars.level + 1);
    add(between_y(pane, y - bars.width / 2, y + bars.width / 2), false, front - 2 * kApart);
  }
  return {};
}

Made add_leaves(MeshBuilder& builder, const Outline& hole, const Leaves& l) {
  if (hole.empty()) return no_room("leaves");
  const Bounds2 box = bounds_of(hole);
  const auto line = [&](int k) { return box.least.x + box.width() * k / l.count; };
  std::vector<Outline> panes;
  for (int k = 0; k < l.count; ++k) {
    Outline pane = inset(between_x(hole, line(k), line(k + 1)), l.stile);
    const Bounds2 b = bounds_of(pane);
    if (pane.empty() || b.width() < kLeastPane || b.height() < kLeastPane) return no_room("the panes of its leaves");
    panes.push_back(std::move(pane));
  }
  const double glass = l.z - (l.sides ? kGlassBack : kApart);
  builder.begin_body();
  if (l.stile > 0 && !builder.plate(hole, panes, l.z, l.part)) return no_room("the stiles of its leaves");
  for (const Outline& pane : panes) {
    if (l.sides && l.stile > 0) builder.recess(pane, l.z, glass, l.part);
    builder.begin_body();
    builder.plate(pane, {}, glass, Part::glass);
    if (l.sides)
      if (Made made = add_bars(builder, pane, l.bars, l.z, glass, l.part); !made) return made;
  }
  if (l.strips)
    for (int k = 1; k < l.count; ++k)
      add_strip(builder, between_x(hole, line(k) - 0.02, line(k) + 0.02), l.z + 0.010, l.z, l.part);
  return {};
}

}  // namespace blockrand::elements
