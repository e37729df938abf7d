#include "pipeline/facades/wall_corners.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/grid.h"

namespace blockrand::facades {
namespace {

double top_of(const WallFrame& wall, double eaves) {
  return wall.base + std::clamp(eaves - wall.base, 0.0, wall.height);
}

}  // namespace

double eaves_level(const model::BuildingPart& part) {
  const model::Attributes& a = part.attributes;
  const double roof = a.roof_shape.value == model::RoofShape::flat ? 0 : a.roof_height.value;
  const double asked = a.ground_height.value + a.height.value - roof;
  const model::Solid& solid = part.lod2;
  std::vector<bool> of_wall(solid.vertices.size(), false);
  const auto visit = [&](const model::Face& face, auto&& take) {
    for (const model::Solid::Loop& loop : solid.loops_of(face))
      for (const std::uint32_t v : solid.indices_of(loop)) take(v);
  };
  // Upright faces within the roof have no edge.
  for (const model::Face& face : solid.faces)
    if (face.kind == model::SurfaceKind::wall && face.edge >= 0)
      visit(face, [&](std::uint32_t v) { of_wall[v] = true; });
  double lowest = std::numeric_limits<double>::infinity();
  bool as_asked = false;
  for (const model::Face& face : solid.faces)
    if (face.kind == model::SurfaceKind::roof)
      visit(face, [&](std::uint32_t v) {
        if (!of_wall[v]) return;
        const double z = solid.vertices[v].z;
        lowest = std::min(lowest, z);
        as_asked = as_asked || std::fabs(z - asked) < kSameEaves;
      });
  return as_asked || !std::isfinite(lowest) ? asked : lowest;
}

void link_corners(std::span<FacadeSegment> segments, std::span<const WallFrame> walls, double eaves) {
  // Walls by the place of their right end, which is another one's left end.
  std::map<geometry::Grid2, std::vector<std::uint32_t>> ending;
  for (std::uint32_t w = 0; w < walls.size(); ++w)
    ending[geometry::to_grid(walls[w].at({walls[w].length, 0}).xy())].push_back(w);
  constexpr std::size_t kNone = ~std::size_t{0};
  std::vector<std::size_t> last_of(walls.size(), kNone);
  for (std::size_t s = 0; s < segments.size(); ++s)
    if (segments[s].ends_wall) last_of[segments[s].wall] = s;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    FacadeSegment& mine = segments[s];
    if (s > 0 && segments[s - 1].wall == mine.wall && mine.from - segments[s - 1].to < kShortestFacadeSegment) {
      mine.kind_left = segments[s - 1].kind;
      segments[s - 1].kind_right = mine.kind;
    }
    if (!mine.starts_wall) continue;
    const WallFrame& after = walls[mine.wall];
    const auto before_here = ending.find(geometry::to_grid(after.start));
    if (before_here == ending.end()) continue;
    for (const std::uint32_t w : before_here->second) {
      const WallFrame& before = walls[w];
      if (last_of[w] == kNone || std::fabs(before.base - after.base) > kSameLevel ||
          std::fabs(top_of(before, eaves) - top_of(after, eaves)) > kSameLevel)
        continue;
      const double across = before.along.x * after.along.y - before.along.y * after.along.x;
      const double forth = before.along.x * after.along.x + before.along.y * after.along.y;
      FacadeSegment& other = segments[last_of[w]];
      mine.turn_left = other.turn_right = base::atan2(across, forth) * base::kDegreesPerRadian;
      mine.kind_left = other.kind;
      other.kind_right = mine.kind;
      break;
    }
  }
}

}  // namespace blockrand::facades
