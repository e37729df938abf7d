#include "pipeline/validate/solids.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>

#include "pipeline/geometry/cgal_validator.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/triangulate.h"

namespace blockrand::validate {
namespace {

using model::Point3;

template <class SolidValidator>
auto said_by(const SolidValidator& validator) -> decltype(validator()) {
  try {
    return validator();
  } catch (const std::exception& error) {
    return {std::string("the judge gave up: ") + error.what()};
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

constexpr double kLargestSolid = 100000, kLargestMesh = 30000;  // m, so that exact arithmetic can work on them

/// Our own checker's word.
struct Own {
  std::string text;
  int number = 0;
};
Own own(const geometry::SolidCheck& check) { return check.valid() ? Own{} : Own{check.text(), check.code()}; }

/// Nothing where it has no points, or is too large.
std::optional<model::Solid> solid_of(const ReadSolid& read) {
  std::vector<Point3> points;
  for (const ReadPolygon& polygon : read.polygons)
    for (const auto& ring : polygon.rings) points.insert(points.end(), ring.begin(), ring.end());
  if (points.empty()) return std::nullopt;
  const Welder index(std::move(points));
  if (!compact(index.points(), kLargestSolid)) return std::nullopt;
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
  return solid;
}

Own own_validity(const ReadSolid& read) {
  if (std::all_of(read.polygons.begin(), read.polygons.end(), [](const ReadPolygon& p) { return p.rings.empty(); }))
    return own(geometry::SolidCheck{geometry::SolidDefect::empty});
  const auto solid = solid_of(read);
  if (!solid) return {"a body of more than 100 km"};
  return own(geometry::check_solid(*solid));
}

std::string cgal_validity(const ReadSolid& read) {
  std::vector<geometry::PolygonRings> polygons;
  polygons.reserve(read.polygons.size());
  for (const ReadPolygon& p : read.polygons) polygons.push_back(p.rings);
  return geometry::validate_solid(polygons);
}

Own own_validity(const std::vector<GlbTriangle>& read) {
  constexpr double kSteps = 65536;  // per metre; positions are floats
  const auto mesh = read_mesh(read);
  if (!mesh) return {"a body of more than 30 km"};
  const Point3 o = mesh->vertices.front();
  std::vector<geometry::Grid3> vertices;
  for (const Point3& p : mesh->vertices)
    vertices.push_back(
        {std::llrint((p.x - o.x) * kSteps), std::llrint((p.y - o.y) * kSteps), std::llrint((p.z - o.z) * kSteps)});
  return own(geometry::check_mesh(vertices, mesh->triangles));
}

std::string cgal_validity(const std::vector<GlbTriangle>& read) {
  std::vector<std::vector<Point3>> triangles;
  triangles.reserve(read.size());
  for (const GlbTriangle& t : read) triangles.emplace_back(t.corners.begin(), t.corners.end());
  return geometry::validate_triangles(triangles);
}

template <class OwnValidator, class CgalValidator>
SolidValidity validity_by(const OwnValidator& own_validator, const CgalValidator& cgal_validator) {
  Own said = said_by(own_validator);
  return {std::move(said.text), said_by(cgal_validator), said.number};
}

}  // namespace

SolidValidity surfaces_validity(const ReadSolid& surfaces) {
  constexpr int kShellCodes = 300;  // from here on they are about the shell, not about its polygons
  const Own said = said_by([&] { return own_validity(surfaces); });
  if (said.number == 0 || said.number >= kShellCodes) return {};
  return {said.text, said.text, said.number};
}

std::string SolidValidity::text() const {
  return fmt::format("own checker: {}; CGAL: {}", own.empty() ? "valid" : own, cgal.empty() ? "valid" : cgal);
}

std::optional<ReadMesh> read_mesh(const ReadSolid& read) {
  auto solid = solid_of(read);
  if (!solid || std::any_of(solid->faces.begin(), solid->faces.end(),
                            [](const model::Face& face) { return face.loop_count == 0; }))
    return std::nullopt;
  auto triangles = geometry::triangulate(*solid);
  if (!triangles) return std::nullopt;
  return ReadMesh{std::move(solid->vertices), std::move(triangles->triangles)};
}

std::optional<ReadMesh> read_mesh(const std::vector<GlbTriangle>& read) {
  std::vector<Point3> points;
  points.reserve(read.size() * 3);
  for (const GlbTriangle& t : read) points.insert(points.end(), t.corners.begin(), t.corners.end());
  if (points.empty()) return std::nullopt;
  const Welder index(std::move(points));
  if (!compact(index.points(), kLargestMesh)) return std::nullopt;
  ReadMesh out{index.points(), {}};
  for (const GlbTriangle& t : read)
    out.triangles.push_back({index(t.corners[0]), index(t.corners[1]), index(t.corners[2])});
  return out;
}

SolidValidity validator(const ReadSolid& solid) {
  return validity_by([&] { return own_validity(solid); }, [&] { return cgal_validity(solid); });
}

SolidValidity validator(const std::vector<GlbTriangle>& triangles) {
  if (triangles.empty())
    return {own(geometry::SolidCheck{geometry::SolidDefect::empty}).text, "no faces",
            iso_code(geometry::SolidDefect::empty)};
  return validity_by([&] { return own_validity(triangles); }, [&] { return cgal_validity(triangles); });
}

void note(const SolidValidity& validity, const std::string& file, const std::string& object, const std::string& which,
          std::vector<Finding>& findings) {
  if (validity.valid()) return;
  findings.push_back({validity.agreed() ? Check::solid_invalid : Check::validators_disagree, file, object,
                      which + ": " + validity.text(), validity.number});
}

}  // namespace blockrand::validate
