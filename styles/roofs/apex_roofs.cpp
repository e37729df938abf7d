// Roofs around an apex over the centroid: rings of the plan (pyramid, dome, onion, spire) and crossing gables.
#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"
#include "styles/roofs/shape_tables.h"

namespace blockrand::roofs {

using model::Point2;
using model::Point3;
using model::Polygon;
using model::RoofShape;

namespace {

constexpr double kLeastDistance = 0.05;  // m from apex to edge. A nearer one would get a face that stands upright.
/// m. A ring is left out where an edge of it would be shorter: rounding moves ring points by up to 0.7 mm, and the
/// checker wants faces of four corners nowhere narrower than 2 mm.
constexpr double kShortestRingEdge = 0.01;
/// Plans may have such short edges themselves; then their wide rings stay down to this share of the plan's size.
constexpr double kSmallestRingOfFinePlans = 0.7;
constexpr double kShortestRingEdgeOfFinePlans = 0.004;  // m, twice the checker's narrowest
constexpr double kLeastRise = 0.004;  // m between rings. Less is a flat step in which rounding decides what lies above.

constexpr std::size_t kMostCrossedEdges = 12;  // docs/roofs.md: more gables than that are a zigzag, no roof
constexpr double kNarrowestGable = 0.02;       // m. Its peak would stand within rounding of the corners.
/// m off their common plane. Half of what the checker allows: the rest is for rounding.
constexpr double kOnePlane = 0.005;

/// The centroid on the grid, when it sees every edge of the plan well from inside.
std::optional<Point2> apex_over(const Polygon& plan) {
  const auto& points = plan.outer.points;
  if (!plan.holes.empty() || points.size() < 3) return std::nullopt;
  const Point2 apex = model::snap(geometry::centroid(points));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point2 a = points[i], b = points[(i + 1) % points.size()];
    const double left = (b.x - a.x) * (apex.y - a.y) - (b.y - a.y) * (apex.x - a.x);
    if (left < kLeastDistance * distance(a, b)) return std::nullopt;
  }
  return apex;
}

double shortest_edge(const Polygon& plan) {
  const auto& points = plan.outer.points;
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i)
    shortest = std::min(shortest, distance(points[i], points[(i + 1) % points.size()]));
  return shortest;
}

/// Are the four points, in this order, within kOnePlane of one plane? Their diagonals span it.
bool one_plane(const Point3 (&p)[4]) {
  const double ux = p[2].x - p[0].x, uy = p[2].y - p[0].y, uz = p[2].z - p[0].z;
  const double vx = p[3].x - p[1].x, vy = p[3].y - p[1].y, vz = p[3].z - p[1].z;
  const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const double size = std::sqrt(nx * nx + ny * ny + nz * nz);
  // The diagonals' distance is twice each corner's from the plane half-way between them.
  const double apart = nx * (p[1].x - p[0].x) + ny * (p[1].y - p[0].y) + nz * (p[1].z - p[0].z);
  return size > 0 && std::fabs(apart) <= 2 * kOnePlane * size;
}

constexpr ApexRing kPyramid[] = {{1, 0}, {0, 1}};
constexpr double kCos15 = 0.96592582628906829, kSin15 = 0.25881904510252076;
constexpr double kCos30 = 0.86602540378443865, kCos45 = 0.70710678118654752;
constexpr ApexRing kDome[] = {{1, 0},        {kCos15, kSin15}, {kCos30, 0.5}, {kCos45, kCos45},
                              {0.5, kCos30}, {kSin15, kCos15}, {0, 1}};
constexpr ApexRing kOnion[] = {{1, 0},       {0.82, 0.04}, {0.93, 0.12}, {1, 0.22},    {0.96, 0.34},
                               {0.78, 0.48}, {0.48, 0.62}, {0.22, 0.74}, {0.08, 0.86}, {0, 1}};
constexpr ApexRing kSpire[] = {{1, 0}, {0.5, 0.15}, {0, 1}};

}  // namespace

std::span<const ApexRing> apex_rings(RoofShape shape) {
  const auto* rings = model::constructed_as<model::ApexRoof>(shape);
  if (!rings) return {};
  switch (rings->profile) {
    case model::ApexProfile::pyramid:
      return kPyramid;
    case model::ApexProfile::dome:
      return kDome;
    case model::ApexProfile::onion:
      return kOnion;
    case model::ApexProfile::spire:
      return kSpire;
  }
  return {};
}

std::optional<Roof> apex_roof(const Polygon& plan, RoofMeasures measures, std::span<const ApexRing> rings) {
  const auto apex = apex_over(plan);
  if (!apex || measures.height < kLeastRise || rings.size() < 2) return std::nullopt;
  const auto& points = plan.outer.points;
  const std::size_t n = points.size();

  const double shortest = shortest_edge(plan);
  const double limit = std::clamp(kSmallestRingOfFinePlans * shortest, kShortestRingEdgeOfFinePlans, kShortestRingEdge);
  std::vector<std::vector<Point3>> levels;
  for (const ApexRing& ring : rings.first(rings.size() - 1)) {
    const double z = measures.eaves + measures.height * ring.height;
    if (!levels.empty()) {
      if (shortest * ring.size < limit) continue;
      if (z - levels.back()[0].z < kLeastRise || measures.height * (1 - ring.height) < kLeastRise) continue;
    }
    std::vector<Point3> level;
    for (const Point2 p : points) {
      const Point2 at =
          levels.empty()
              ? p
              : model::snap(Point2{apex->x + ring.size * (p.x - apex->x), apex->y + ring.size * (p.y - apex->y)});
      level.push_back({at.x, at.y, z});
    }
    levels.push_back(std::move(level));
  }

  const Point3 top{apex->x, apex->y, measures.eaves + measures.height};
  Roof roof;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    for (std::size_t l = 0; l < levels.size(); ++l) {
      std::vector<Point3> loop{levels[l][i], levels[l][j]};
      if (l + 1 < levels.size())
        loop.insert(loop.end(), {levels[l + 1][j], levels[l + 1][i]});
      else
        loop.push_back(top);
      roof.surfaces.push_back({static_cast<std::int32_t>(i), {std::move(loop)}});
    }
    roof.wall_tops.push_back({levels[0][j], levels[0][i]});
  }
  return roof;
}

std::optional<Roof> crossed_roof(const Polygon& plan, RoofMeasures measures, double gable_height) {
  const auto apex = apex_over(plan);
  const auto& points = plan.outer.points;
  const std::size_t n = points.size();
  if (!apex || n > kMostCrossedEdges || shortest_edge(plan) < kNarrowestGable) return std::nullopt;
  const double gable = measures.height * gable_height;
  if (gable < kLeastRise) return std::nullopt;
  for (std::size_t i = 0; i < n; ++i)
    if (geometry::orientation(geometry::to_grid(points[i]), geometry::to_grid(points[(i + 1) % n]),
                              geometry::to_grid(points[(i + 2) % n])) < 0)
      return std::nullopt;

  const auto corner = [&](std::size_t i) { return Point3{points[i].x, points[i].y, measures.eaves}; };
  const auto peak = [&](std::size_t i) {
    const Point2 a = points[i], b = points[(i + 1) % n];
    const Point2 middle = model::snap(Point2{a.x + (b.x - a.x) / 2, a.y + (b.y - a.y) / 2});
    return Point3{middle.x, middle.y, measures.eaves + gable};
  };
  const Point3 top{apex->x, apex->y, measures.eaves + measures.height};
  Roof roof;
  for (std::size_t i = 0; i < n; ++i) {
    // Around corner i: the half of edge i - 1 that ends there, the half of edge i that begins there.
    const std::size_t before = (i + n - 1) % n;
    const Point3 lozenge[4] = {corner(i), peak(i), top, peak(before)};
    if (one_plane(lozenge)) {
      roof.surfaces.push_back({static_cast<std::int32_t>(i), {{lozenge[0], lozenge[1], lozenge[2], lozenge[3]}}});
    } else {
      roof.surfaces.push_back({static_cast<std::int32_t>(before), {{lozenge[0], lozenge[2], lozenge[3]}}});
      roof.surfaces.push_back({static_cast<std::int32_t>(i), {{lozenge[0], lozenge[1], lozenge[2]}}});
    }
    roof.wall_tops.push_back({corner((i + 1) % n), peak(i), corner(i)});
  }
  return roof;
}

}  // namespace blockrand::roofs
