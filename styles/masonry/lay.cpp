#include <algorithm>
#include <cmath>

#include "pipeline/geometry/polygon_measures.h"
#include "styles/masonry/field.h"

namespace blockrand::masonry {

Masonry usual_masonry(Bond bond) {
  Masonry out;
  out.bond = bond;
  if (is_brick(bond)) {
    const BrickFormat& normal = kBrickFormats[0];
    out.length = normal.length, out.width = normal.width, out.height = normal.height;
    out.perpend = normal.perpend, out.bed = normal.bed;
    return out;
  }
  out.perpend = out.bed = 0.012;
  out.relief = 0.018;
  if (bond == Bond::ashlar) out.length = 0.62, out.width = 0.32, out.height = 0.30;
  if (bond == Bond::rubble) out.length = 0.32, out.width = 0.2, out.height = 0.17, out.perpend = out.bed = 0.018;
  if (bond == Bond::cyclopean) out.length = 0.62, out.width = 0.4, out.height = 0.54, out.perpend = out.bed = 0.016;
  return out;
}

bool can_be_laid(const Masonry& m) {
  const auto positive = [](double v) { return std::isfinite(v) && v > 0; };
  return positive(m.length) && positive(m.width) && positive(m.height) && positive(m.perpend) && positive(m.bed) &&
         m.perpend * 2 <= std::min(m.width, m.length / 4) && m.bed <= m.height;
}

std::optional<LaidWall> lay(const WallToLay& wall, const Masonry& m) {
  if (!can_be_laid(m) || wall.outline.size() < 3) return std::nullopt;
  LaidWall out;
  // A wall shorter than two bricks has no bond.
  if (!(wall.to - wall.from > m.width)) return out;
  Dressings dressings = dress(wall, m);
  out.undressed = dressings.undressed;
  out.stones = std::move(dressings.stones);
  if (has_courses(m.bond))
    lay_courses(wall, m, dressings.blocked, out);
  else
    lay_cells(wall, m, std::move(dressings.blocked), out);
  std::erase_if(out.stones, [&](const Stone& s) {
    return std::ranges::any_of(wall.covered, [&](const Outline& o) {
      return std::ranges::all_of(s.outline, [&](const Point2& p) { return geometry::contains(o, p); });
    });
  });
  for (std::size_t i = 0; i < out.stones.size(); ++i) {
    // Shades go by places, so that a stone keeps its own when another one goes.
    const Point2 middle = geometry::centroid(out.stones[i].outline);
    const auto place = static_cast<std::uint64_t>(std::llround((middle.x + 1000) * 64)) * 1000003 +
                       static_cast<std::uint64_t>(std::llround((middle.y + 1000) * 64));
    out.stones[i].shade = static_cast<std::uint8_t>(unit_of(wall.seed, place, 7) * 3);
  }
  return out;
}

}  // namespace blockrand::masonry
