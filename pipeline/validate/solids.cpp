#include "pipeline/validate/solids.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>

#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/second_judge.h"
#include "pipeline/geometry/triangulate.h"

namespace blockrand::validate {
namespace {

using model::Point3;

template <class Judge>
std::string said_by(const Judge& judge) {
  try {
    return judge();
  } catch (const std::exception& error) {
    return std::string("the judge gave up: ") + error.what();
  }
}

/// Numbers equal points alike.
class Welder {
 public:
  explicit Welder(std::vector<Point3> points) : points_(std::move(points)) {
    std::sort(points_.begin(), points_.end());
    points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
  }
  const std::vector<Point3>& points() const { return points_; }
  std::uint32_t operator()(const Point3& p) const {
    return static_cast<std::uint32_t>(std::lower_bound(points_.begin(), points_.end(), p) - points_.begin());
  }

 private:
  std::vector<Point3> points_;
};

/// Whether exact arithmetic can work on it.
bool compact(const std::vector<Point3>& sorted, double largest) {
  for (const Point3& p : sorted) {
    const Point3& o = sorted.front();
    if (!(std::max({std::fabs(p.x - o.x), std::fabs(p.y - o.y), std::fabs(p.z - o.z)}) < largest)) return false;
  }
  return true;
}

std::string own_verdict(const ReadSolid& read) {
  std::vector<Point3> points;
  for (const ReadPolygon& polygon : read.polygons)
    for (const auto& ring : polygon.rings) points.insert(points.end(), ring.begin(), ring.end());
  if (points.empty()) return "no faces";
  const Welder index(std::move(points));
  if (!compact(index.points(), 100000)) return "a body of more than 100 km";
  model::Solid solid;
  solid.vertices = index.points();
  for (const ReadPolygon& polygon : read.polygons) {
    model::Face face;
    face.first_loop = static_cast<std::uint32_t>(solid.loops.size());
    face.loop_count = static_cast<std::uint32_t>(polygon.rings.size());
    for (const auto& ring : polygon.rings) {
      solid.loops.push_back(
          {static_cast<std::uint32_t>(solid.indices.size()), static_cast<std::uint32_t>(ring.size())});
      for (const Point3& p : ring) solid.indices.push_back(index(p));
    }
    solid.faces.push_back(face);
  }
  const auto triangles = geometry::triangulate(solid);
  if (!triangles) return "a face is no simple polygon";
  const geometry::SolidCheck check = geometry::check_solid(solid, *triangles);
  return check.valid() ? "" : check.text();
}

std::string cgal_verdict(const ReadSolid& read) {
  std::vector<geometry::PolygonRings> polygons;
  polygons.reserve(read.polygons.size());
  for (const ReadPolygon& p : read.polygons) polygons.push_back(p.rings);
  return geometry::judge_solid(polygons);
}

std::string own_verdict(const std::vector<GlbTriangle>& read) {
  constexpr double kSteps = 65536;  // per metre; positions are floats
  std::vector<Point3> points;
  points.reserve(read.size() * 3);
  for (const GlbTriangle& t : read) points.insert(points.end(), t.corners.begin(), t.corners.end());
  const Welder index(std::move(points));
  if (!compact(index.points(), 30000)) return "a body of more than 30 km";
  const Point3 o = index.points().front();
  std::vector<geometry::Grid3> vertices;
  for (const Point3& p : index.points())
    vertices.push_back(
        {std::llrint((p.x - o.x) * kSteps), std::llrint((p.y - o.y) * kSteps), std::llrint((p.z - o.z) * kSteps)});
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const GlbTriangle& t : read)
    triangles.push_back({index(t.corners[0]), index(t.corners[1]), index(t.corners[2])});
  const geometry::SolidCheck check = geometry::check_mesh(vertices, triangles);
  return check.valid() ? "" : check.text();
}

std::string cgal_verdict(const std::vector<GlbTriangle>& read) {
  std::vector<std::vector<Point3>> triangles;
  triangles.reserve(read.size());
  for (const GlbTriangle& t : read) triangles.emplace_back(t.corners.begin(), t.corners.end());
  return geometry::judge_triangles(triangles);
}

}  // namespace

std::string Verdict::text() const {
  return fmt::format("own checker: {}; CGAL: {}", own.empty() ? "valid" : own, cgal.empty() ? "valid" : cgal);
}

Verdict judge(const ReadSolid& solid) {
  return {said_by([&] { return own_verdict(solid); }), said_by([&] { return cgal_verdict(solid); })};
}

Verdict judge(const std::vector<GlbTriangle>& triangles) {
  if (triangles.empty()) return {"no faces", "no faces"};
  return {said_by([&] { return own_verdict(triangles); }), said_by([&] { return cgal_verdict(triangles); })};
}

void note(const Verdict& verdict, const std::string& file, const std::string& object, const std::string& which,
          std::vector<Finding>& findings) {
  if (verdict.valid()) return;
  findings.push_back(
      {verdict.agreed() ? Check::solid_invalid : Check::judges_disagree, file, object, which + ": " + verdict.text()});
}

}  // namespace blockrand::validate
