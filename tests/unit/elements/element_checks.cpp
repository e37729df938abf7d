#include "tests/unit/elements/element_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/solid_builder.h"
#include "styles/elements/flat_shapes.h"

namespace blockrand::elements::checks {
namespace {

using model::Point2;
using model::Point3;

Point3 minus(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point3 cross(Point3 a, Point3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double dot(Point3 a, Point3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(Point3 a) { return std::sqrt(dot(a, a)); }

std::vector<Point3> corners(const ElementMesh& mesh, const ElementFace& f) {
  std::vector<Point3> out;
  for (std::uint32_t i = 0; i < f.count; ++i) out.push_back(mesh.vertices[mesh.indices[f.first + i]]);
  return out;
}

/// Newell's normal: twice the area long.
Point3 normal(const std::vector<Point3>& c) {
  Point3 n;
  for (std::size_t i = 1; i + 1 < c.size(); ++i) {
    const Point3 x = cross(minus(c[i], c[0]), minus(c[i + 1], c[0]));
    n = {n.x + x.x, n.y + x.y, n.z + x.z};
  }
  return n;
}

}  // namespace

std::string faces_wrong(const ElementMesh& mesh) {
  for (const Point3& p : mesh.vertices)
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return "a vertex is not finite";
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> used;
  for (std::size_t k = 0; k < mesh.faces.size(); ++k) {
    const ElementFace& f = mesh.faces[k];
    if (f.count < 3 || f.first + f.count > mesh.indices.size()) return fmt::format("face {} has no corners", k);
    for (std::uint32_t i = 0; i < f.count; ++i)
      if (mesh.indices[f.first + i] >= mesh.vertices.size()) return fmt::format("face {} has a corner that is none", k);
    const auto c = corners(mesh, f);
    const Point3 n = normal(c);
    const double area = length(n) / 2;
    if (!(area > 1e-9)) return fmt::format("face {} has no area", k);
    for (std::size_t i = 0; i < c.size(); ++i) {
      if (std::fabs(dot(minus(c[i], c[0]), n)) / length(n) > 1e-6) return fmt::format("face {} is not plane", k);
      const Point3 a = c[i], b = c[(i + 1) % c.size()], d = c[(i + 2) % c.size()];
      if (!(dot(cross(minus(b, a), minus(d, b)), n) > 0)) return fmt::format("face {} is not strictly convex", k);
      const auto edge = std::pair(mesh.indices[f.first + i], mesh.indices[f.first + (i + 1) % f.count]);
      if (++used[edge] > 1) return fmt::format("two faces turn the same way at an edge of face {}", k);
    }
  }
  return {};
}

std::vector<Body> bodies(const ElementMesh& mesh) {
  std::vector<std::uint32_t> root(mesh.vertices.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (const ElementFace& f : mesh.faces)
    for (std::uint32_t i = 1; i < f.count; ++i) root[find(mesh.indices[f.first + i])] = find(mesh.indices[f.first]);
  std::map<std::uint32_t, Body> by_root;
  for (std::size_t k = 0; k < mesh.faces.size(); ++k)
    by_root[find(mesh.indices[mesh.faces[k].first])].faces.push_back(static_cast<std::uint32_t>(k));
  std::vector<Body> out;
  for (auto& [r, body] : by_root) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const std::uint32_t k : body.faces) {
      const ElementFace& f = mesh.faces[k];
      for (std::uint32_t i = 0; i < f.count; ++i)
        ++edges[{mesh.indices[f.first + i], mesh.indices[f.first + (i + 1) % f.count]}];
    }
    body.closed = std::all_of(edges.begin(), edges.end(), [&](const auto& e) {
      const auto back = edges.find({e.first.second, e.first.first});
      return e.second == 1 && back != edges.end() && back->second == 1;
    });
    out.push_back(std::move(body));
  }
  return out;
}

double volume(const ElementMesh& mesh, const Body& body) {
  double six = 0;
  for (const std::uint32_t k : body.faces) {
    const auto c = corners(mesh, mesh.faces[k]);
    for (std::size_t i = 1; i + 1 < c.size(); ++i) six += dot(c[0], cross(c[i], c[i + 1]));
  }
  return six / 6;
}

std::string solid_defect(const ElementMesh& mesh, const Body& body) {
  geometry::SolidBuilder builder;
  for (const std::uint32_t k : body.faces) builder.add_face(corners(mesh, mesh.faces[k]), model::Face{});
  const auto check = geometry::check_solid(builder.take());
  return check.text();
}

std::string flicker(const ElementMesh& mesh) {
  struct Plane {
    Point3 n;
    double d;
    std::vector<Point3> c;
  };
  std::vector<Plane> planes;
  for (const ElementFace& f : mesh.faces) {
    auto c = corners(mesh, f);
    Point3 n = normal(c);
    const double l = length(n);
    n = {n.x / l, n.y / l, n.z / l};
    const double d = dot(n, c[0]);
    // Never seen: what lies on the ground, and backs of trim inside the wall.
    if (n.y < -0.999 && -d < 1e-6) continue;
    if (n.z < -0.999 && -d > -0.03) continue;
    planes.push_back({n, d, std::move(c)});
  }
  for (std::size_t i = 0; i < planes.size(); ++i)
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      const Plane &a = planes[i], &b = planes[j];
      if (dot(a.n, b.n) < 0.99999 || std::fabs(a.d - b.d) > 0.003) continue;
      // Both in the plane of the first.
      Point3 u = minus(a.c[1], a.c[0]);
      const double l = length(u);
      u = {u.x / l, u.y / l, u.z / l};
      const Point3 v = cross(a.n, u);
      const auto flat = [&](const std::vector<Point3>& c) {
        Outline out;
        for (const Point3& p : c) out.push_back({dot(p, u), dot(p, v)});
        return out;
      };
      Outline common = flat(a.c);
      const Outline other = flat(b.c);
      for (std::size_t k = 0; k < other.size() && !common.empty(); ++k) {
        const Point2 p = other[k], q = other[(k + 1) % other.size()];
        const double m = std::sqrt((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y));
        const Point2 out{(q.y - p.y) / m, -(q.x - p.x) / m};
        common = clipped(common, out, out.x * p.x + out.y * p.y);
      }
      if (!common.empty() && signed_area(common) > 5e-4)
        return fmt::format(
            "faces {} and {} overlap by {:.4f} m² in one plane near ({:.3f} {:.3f} {:.3f}), looking along ({:.2f} "
            "{:.2f} {:.2f})",
            i, j, signed_area(common), a.c[0].x, a.c[0].y, a.c[0].z, a.n.x, a.n.y, a.n.z);
    }
  return {};
}

std::string open_place(const Element& element) {
  const Outline& outline = element.opening.outline;
  const Bounds2 box = bounds_of(outline);
  const Outline sure = inset(outline, 0.002);
  constexpr int kSteps = 23;
  for (int i = 1; i < kSteps; ++i)
    for (int j = 1; j < kSteps; ++j) {
      const Point2 p{box.least.x + box.width() * (i + 0.013) / kSteps,
                     box.least.y + box.height() * (j + 0.017) / kSteps};
      if (!geometry::contains(sure, p)) continue;
      bool covered = false;
      for (const ElementFace& f : element.mesh.faces) {
        const auto c = corners(element.mesh, f);
        if (normal(c).z <= 1e-9) continue;
        bool inside = true;
        for (std::size_t k = 0; k < c.size() && inside; ++k) {
          const Point3 a = c[k], b = c[(k + 1) % c.size()];
          inside = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) >= 0;
        }
        covered |= inside;
        if (covered) break;
      }
      if (!covered) return fmt::format("one sees through at ({:.3f}, {:.3f})", p.x, p.y);
    }
  return {};
}

}  // namespace blockrand::elements::checks
