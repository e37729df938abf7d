// Flat roofs, and directions.
#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "styles/roofs/roof.h"
#include "styles/roofs/roof_sides.h"

namespace blockrand::roofs {

using model::Point2;
using model::Point3;
using model::Polygon;
using model::Ring;

namespace {

/// Visits all rings, outer first.
template <class Visit>
void for_each_ring(const Polygon& plan, Visit&& visit) {
  visit(plan.outer);
  for (const Ring& hole : plan.holes) visit(hole);
}

/// The roof whose height over every plan point is `z(point)`, an affine function.
template <class Height>
Roof single_plane(const Polygon& plan, Height&& z) {
  Roof roof;
  Roof::Surface surface;
  for_each_ring(plan, [&](const Ring& ring) {
    std::vector<Point3> loop;
    for (const Point2 p : ring.points) loop.push_back({p.x, p.y, z(p)});
    for (std::size_t i = 0; i < loop.size(); ++i) roof.wall_tops.push_back({loop[(i + 1) % loop.size()], loop[i]});
    surface.loops.push_back(std::move(loop));
  });
  roof.surfaces.push_back(std::move(surface));
  return roof;
}

}  // namespace

Point2 compass_vector(double degrees) {
  constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180;
  return {base::sin(degrees * kRadiansPerDegree), base::cos(degrees * kRadiansPerDegree)};
}

Point2 default_slope(const Polygon& plan, const std::vector<model::RoofEdge>& edges) {
  const std::vector<PlanSide> all = plan_sides(plan);
  const std::size_t n = plan.outer.size();
  const bool known = edges.size() == all.size();
  const auto is = [&](std::size_t e, model::RoofEdge kind) { return known && edges[e] == kind; };
  // How much party wall looks the other way, m.
  const auto opposite = [&](std::size_t e) {
    double length = 0;
    for (std::size_t f = 0; f < n; ++f) {
      if (!is(f, model::RoofEdge::party_wall)) continue;
      const Point2 u = all[e].outwards(), v = all[f].outwards();
      constexpr double kOpposite = -0.7;  // cosine of about 135 degrees
      if (u.x * v.x + u.y * v.y < kOpposite) length += all[f].length;
    }
    return length;
  };
  const auto street = known ? street_outlook(all, edges) : std::nullopt;
  const bool in_row = known && std::find(edges.begin(), edges.end(), model::RoofEdge::party_wall) != edges.end();
  double longest = 0;
  for (std::size_t e = 0; e < n; ++e) longest = std::max(longest, all[e].length);
  const double least = std::min(2.0, 0.3 * longest);  // m. Chips of walls and sides of bays have no say.
  Point2 down{0, -1};
  double best = -1;
  int best_rank = -1;
  for (std::size_t e = 0; e < n; ++e) {
    const bool party = is(e, model::RoofEdge::party_wall);
    const bool leans = !party && opposite(e) > all[e].length / 2;
    const double away = street ? -(all[e].outwards().x * street->x + all[e].outwards().y * street->y) : 0;
    constexpr double kAway = 0.7;  // cosine of about 45 degrees
    const int rank = party || all[e].length < least             ? 0
                     : in_row && away > kAway                   ? 4
                     : leans && !is(e, model::RoofEdge::street) ? 3
                     : in_row && is(e, model::RoofEdge::street) ? 2
                                                                : 1;
    if (rank < best_rank || (rank == best_rank && all[e].length <= best)) continue;
    best_rank = rank;
    best = all[e].length;
    down = all[e].outwards();
  }
  return down;
}

Roof flat_roof(const Polygon& plan, double z) {
  return single_plane(plan, [z](Point2) { return z; });
}

}  // namespace blockrand::roofs
