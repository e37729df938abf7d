#include "styles/roofs/wing_ends.h"

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/roof_surfaces.h"
#include "pipeline/geometry/weighted_skeleton.h"

namespace blockrand::roofs {

using model::Point2;
using model::Point3;
using model::Polygon;

namespace {

// Which edges are the ends of wings.
constexpr double kWidestEnd = 30;                      ///< m. A wider end is no gable of a wing but the side of a hall.
constexpr double kLeastCosine = -0.70710678118654752;  ///< corners of an end from 45 to 135 degrees
constexpr double kMostCosine = 0.70710678118654752;
constexpr double kCompact = 0.88;  ///< of the hull's area: a plan with recesses and bends, but one wing (an L has 0.8)
constexpr double kAlmostCompact = 0.7;  ///< ... and one in which no end of a wing was found
constexpr double kAlongAxis = 0.94;     ///< cosine of 20 degrees: pieces of a bent end wall
constexpr double kEndZone = 0.25;       ///< of the plan's length: an end wall with a recess
constexpr double kSquareEnough =
    0.8660254037844386;  ///< cosine of the 30 degrees by which a ridge may leave its end obliquely

int turn(Point2 a, Point2 b, Point2 c) {
  return geometry::orientation(geometry::to_grid(a), geometry::to_grid(b), geometry::to_grid(c));
}

/// Cosine of the angle at b.
double cosine(Point2 a, Point2 b, Point2 c) {
  const double ux = a.x - b.x, uy = a.y - b.y, vx = c.x - b.x, vy = c.y - b.y;
  return (ux * vx + uy * vy) / std::sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy));
}
bool end_corner(Point2 a, Point2 b, Point2 c) {
  const double k = cosine(a, b, c);
  return turn(a, b, c) > 0 && k >= kLeastCosine && k <= kMostCosine;
}

/// Keeps of candidates that share a corner the shorter one.
std::vector<std::uint32_t> without_neighbours(const std::vector<PlanSide>& edges,
                                              std::vector<std::uint32_t> candidates) {
  std::stable_sort(candidates.begin(), candidates.end(), [&](std::uint32_t a, std::uint32_t b) {
    return edges[a].length != edges[b].length ? edges[a].length < edges[b].length : a < b;
  });
  std::vector<std::uint32_t> kept;
  for (const std::uint32_t c : candidates) {
    const bool beside = std::any_of(kept.begin(), kept.end(), [&](std::uint32_t k) {
      return k == c || edges[k].to == edges[c].from || edges[c].to == edges[k].from;
    });
    if (!beside) kept.push_back(c);
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

/// Does a ridge go on from the top of a hip's triangle, about square to its edge? A piece of a long wall between two
/// steps has a triangle, too, but the ridge passes it.
bool ridge_leaves(const std::vector<geometry::RoofSurfaces::Surface>& surfaces, const std::vector<Point3>& triangle,
                  const PlanSide& edge) {
  Point3 top = triangle[0];
  for (const Point3 p : triangle)
    if (p.z > top.z) top = p;
  const Point2 out = edge.outwards();
  for (const auto& s : surfaces)
    for (const auto& loop : s.loops)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Point3 a = loop[i], b = loop[(i + 1) % loop.size()];
        if (a != top || b.z <= 0) continue;
        const double dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
        if (-(dx * out.x + dy * out.y) >= kSquareEnough * length) return true;
      }
  return false;
}

/// The plan's area by that of its convex hull; 0 with holes, and where no hull encloses an area.
double compactness(const Polygon& plan) {
  if (!plan.holes.empty() || plan.outer.size() < 3) return 0;
  std::vector<Point2> points = plan.outer.points;
  std::sort(points.begin(), points.end());
  std::vector<Point2> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t start = hull.size();
    for (const Point2 p : points) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  const double around = geometry::signed_area(hull);
  return around > 0 ? geometry::signed_area(plan.outer.points) / around : 0;
}

/// The two ends of a plan that is one wing: the walls that look along its axis and against it.
std::vector<std::uint32_t> axis_ends(const Polygon& plan, const std::vector<PlanSide>& edges, Point2 axis) {
  std::vector<std::uint32_t> found;
  for (const double way : {1.0, -1.0})
    for (const std::uint32_t e : ends_towards(plan, edges, {way * axis.x, way * axis.y})) found.push_back(e);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  // The two ends of a triangle share a corner: the shorter one is it.
  return found.size() == 2 ? without_neighbours(edges, std::move(found)) : found;
}

}  // namespace

std::vector<PlanSide> plan_sides(const Polygon& plan) {
  std::vector<PlanSide> out;
  const auto add = [&](const model::Ring& ring) {
    const std::size_t n = ring.size();
    for (std::size_t i = 0; i < n; ++i) {
      PlanSide e{ring.points[i], ring.points[(i + 1) % n], ring.points[(i + n - 1) % n], ring.points[(i + 2) % n], 0};
      const double dx = e.to.x - e.from.x, dy = e.to.y - e.from.y;
      e.length = std::sqrt(dx * dx + dy * dy);
      out.push_back(e);
    }
  };
  add(plan.outer);
  for (const model::Ring& hole : plan.holes) add(hole);
  return out;
}

bool is_one_wing(const Polygon& plan) { return compactness(plan) >= kCompact; }

Point2 ridge_axis(const Polygon& plan, const RoofRequest& request) {
  Point2 axis = geometry::long_axis(plan.outer.points);
  const double along = request.down ? std::fabs(request.down->x * axis.x + request.down->y * axis.y) : 0;
  const double across = request.down ? std::fabs(request.down->x * axis.y - request.down->y * axis.x) : 0;
  const bool turned = request.down ? along > across : request.across;
  if (turned) axis = {-axis.y, axis.x};
  return axis;
}

std::vector<std::uint32_t> ends_towards(const Polygon& plan, const std::vector<PlanSide>& edges, Point2 towards) {
  const auto count = static_cast<std::uint32_t>(plan.outer.size());
  const geometry::Extent extent = geometry::extent_along(plan.outer.points, towards);
  const double zone = extent.maximum - kEndZone * (extent.maximum - extent.minimum);
  std::uint32_t best = 0;
  double most = -2;
  std::vector<char> looks_along(count, 0);
  for (std::uint32_t i = 0; i < count; ++i) {
    const PlanSide& e = edges[i];
    const Point2 out = e.outwards();
    const double looks = out.x * towards.x + out.y * towards.y;
    const double place = ((e.from.x + e.to.x) * towards.x + (e.from.y + e.to.y) * towards.y) / 2;
    looks_along[i] = looks >= kAlongAxis && place >= zone;
    // Of several that look alike, as on a regular plan, the first.
    constexpr double kAlike = 1e-3;
    if (place >= zone && looks > most + kAlike) {
      most = looks;
      best = i;
    }
  }
  looks_along[best] = 1;
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < count; ++i)
    if (looks_along[i]) found.push_back(i);
  return found;
}

std::vector<std::uint32_t> wing_ends(const Polygon& plan, const RoofRequest& request) {
  const std::vector<PlanSide> edges = plan_sides(plan);
  const double compact = compactness(plan);
  if (compact >= kCompact) return axis_ends(plan, edges, ridge_axis(plan, request));
  const auto hips = geometry::weighted_skeleton(plan, std::vector<geometry::EdgeProfile>(edges.size()));
  if (!hips) return {};
  const auto surfaces = geometry::roof_surfaces(plan, *hips, 1).surfaces;
  std::vector<std::uint32_t> found;
  for (const auto& s : surfaces) {
    if (s.loops[0].size() != 3) continue;
    const PlanSide& e = edges[s.edge];
    if (e.length <= kWidestEnd && end_corner(e.before, e.from, e.to) && end_corner(e.from, e.to, e.after) &&
        ridge_leaves(surfaces, s.loops[0], e))
      found.push_back(s.edge);
  }
  if (found.empty() && compact >= kAlmostCompact) return axis_ends(plan, edges, ridge_axis(plan, request));
  return without_neighbours(edges, std::move(found));
}

}  // namespace blockrand::roofs
