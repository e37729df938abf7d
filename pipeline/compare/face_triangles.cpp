#include "pipeline/compare/face_triangles.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pipeline/compare/area_vector.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::compare {

namespace {

constexpr double kLeastArea = 1e-10;  // m². Smaller polygons are lines.
// Steps per metre of the integers that the triangulation decides on: fine enough that no two points of a file with
// millimetres become one, coarse enough for 32 bits at a kilometre.
constexpr double kSteps = 65536;

/// The coordinate plane that a polygon shows the most of itself to, turned so that it runs counter-clockwise there.
struct Shadow {
  int axis = 2;  ///< left out
  bool turned = false;
  Point3 normal, base;

  model::Point2 of(Point3 p) const {
    const double x = p.x - base.x, y = p.y - base.y, z = p.z - base.z;
    const model::Point2 flat = axis == 2 ? model::Point2{x, y} : axis == 0 ? model::Point2{y, z} : model::Point2{z, x};
    return turned ? model::Point2{flat.y, flat.x} : flat;
  }
  /// The point of the plane through `base` above a point of the shadow.
  Point3 lifted(model::Point2 p) const {
    if (turned) p = {p.y, p.x};
    if (axis == 2) return {base.x + p.x, base.y + p.y, base.z - (normal.x * p.x + normal.y * p.y) / normal.z};
    if (axis == 0) return {base.x - (normal.y * p.x + normal.z * p.y) / normal.x, base.y + p.x, base.z + p.y};
    return {base.x + p.y, base.y - (normal.z * p.x + normal.x * p.y) / normal.y, base.z + p.x};
  }
};

Shadow shadow_of(const Rings3& rings, Point3 normal) {
  const double x = std::fabs(normal.x), y = std::fabs(normal.y), z = std::fabs(normal.z);
  Shadow out;
  out.axis = z >= x && z >= y ? 2 : x >= y ? 0 : 1;
  out.turned = (out.axis == 2 ? normal.z : out.axis == 0 ? normal.x : normal.y) < 0;
  out.normal = normal;
  out.base = rings[0][0];
  return out;
}

std::optional<std::vector<Triangle3>> plain(const Rings3& rings, const Shadow& shadow) {
  std::vector<geometry::Grid2> points;
  std::vector<Point3> corners;
  std::vector<std::vector<std::uint32_t>> loops;
  for (const auto& ring : rings) {
    auto& loop = loops.emplace_back();
    for (const Point3& p : ring) {
      const model::Point2 flat = shadow.of(p);
      const geometry::Grid2 at{geometry::to_steps(flat.x * kSteps), geometry::to_steps(flat.y * kSteps)};
      if (!loop.empty() && (at == points.back() || at == points[loop.front()])) continue;
      loop.push_back(static_cast<std::uint32_t>(points.size()));
      points.push_back(at);
      corners.push_back(p);
    }
    if (loop.size() < 3) {
      if (loops.size() == 1) return std::nullopt;
      loops.pop_back();  // a hole without an area; its points are named by no loop
    }
  }
  const auto triangles = geometry::triangulate(points, loops);
  if (!triangles) return std::nullopt;
  std::vector<Triangle3> out;
  for (const auto& t : *triangles) out.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
  return out;
}

std::vector<Triangle3> mended_triangles(const Rings3& rings, const Shadow& shadow) {
  constexpr double kLeastPiece = 1e-4, kClearance = 0.002;  // m², m: what the grid of a millimetre can hold apart
  std::vector<model::Ring> flat;
  std::vector<bool> inner;
  for (const auto& ring : rings) {
    model::Ring& out = flat.emplace_back();
    for (const Point3& p : ring) out.points.push_back(model::snap(shadow.of(p)));
    out.nodes.assign(out.points.size(), 0);
    inner.push_back(flat.size() > 1);
  }
  std::vector<Triangle3> out;
  for (const model::Polygon& polygon : geometry::make_valid(flat, inner, kLeastPiece, kClearance).polygons) {
    std::vector<geometry::Grid2> points;
    std::vector<Point3> corners;
    std::vector<std::vector<std::uint32_t>> loops;
    const auto add = [&](const model::Ring& ring) {
      auto& loop = loops.emplace_back();
      for (const model::Point2& p : ring.points) {
        loop.push_back(static_cast<std::uint32_t>(points.size()));
        points.push_back(geometry::to_grid(p));
        corners.push_back(shadow.lifted(p));
      }
    };
    add(polygon.outer);
    for (const model::Ring& hole : polygon.holes) add(hole);
    if (const auto triangles = geometry::triangulate(points, loops))
      for (const auto& t : *triangles) out.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
  }
  return out;
}

}  // namespace

std::vector<Triangle3> triangles_of(const Rings3& rings, bool* mended) {
  if (rings.empty() || rings[0].size() < 3) return {};
  const Point3 normal = area_vector(rings[0]);
  if (!(length(normal) > 2 * kLeastArea)) return {};
  if (rings.size() == 1 && rings[0].size() == 3) return {{rings[0][0], rings[0][1], rings[0][2]}};
  const Shadow shadow = shadow_of(rings, normal);
  if (auto triangles = plain(rings, shadow)) return *std::move(triangles);
  if (mended) *mended = true;
  return mended_triangles(rings, shadow);
}

}  // namespace blockrand::compare
