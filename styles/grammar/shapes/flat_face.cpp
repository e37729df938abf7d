#include "styles/grammar/shapes/flat_face.h"

#include <cmath>

#include "pipeline/geometry/triangulate.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::grammar {

namespace {

constexpr double kWidest = 2048;     ///< plan units across: well inside kWidestSkeleton
constexpr double kMostScale = 1024;  ///< a micrometre; finer is rounding of the input

double scale_for(double extent) {
  double scale = 1;
  while (scale < kMostScale && extent * scale * 2 <= kWidest) scale *= 2;
  while (extent * scale > kWidest && scale > 1e-3) scale /= 2;
  return scale;
}

}  // namespace

std::optional<FlatFace> flat_face(const Mesh& mesh, std::size_t face) {
  const MeshFace& f = mesh.faces[face];
  if (f.loops.empty() || f.loops[0].size() < 3) return {};
  FlatFace out;
  const Vector3 a = mesh.vertices[f.loops[0][0].vertex], b = mesh.vertices[f.loops[0][1].vertex];
  const Vector3 normal = face_normal(mesh, f);
  if (normal == Vector3{}) return {};
  out.plane = frame_with_z(a, normal, b - a);
  Box box;
  for (const Loop& loop : f.loops)
    for (const Corner c : loop) box.add(place_back(out.plane, mesh.vertices[c.vertex]));
  out.scale = scale_for(std::max(box.extent().x, box.extent().y));
  for (std::size_t l = 0; l < f.loops.size(); ++l) {
    model::Ring ring;
    for (const Corner c : f.loops[l]) {
      const Vector3 p = place_back(out.plane, mesh.vertices[c.vertex]);
      ring.points.push_back(model::snap(model::Point2{p.x * out.scale, p.y * out.scale}));
      out.vertices.push_back(c.vertex);
      out.corners.push_back(c);
    }
    if (l == 0)
      out.polygon.outer = std::move(ring);
    else
      out.polygon.holes.push_back(std::move(ring));
  }
  if (!geometry::strictly_simple(out.polygon)) return {};
  return out;
}

std::vector<std::array<Corner, 3>> triangles_of(const Mesh& mesh, std::size_t face) {
  const MeshFace& f = mesh.faces[face];
  std::vector<Corner> corners;
  std::vector<std::vector<std::uint32_t>> loops;
  const Vector3 normal = face_normal(mesh, f);
  if (normal == Vector3{}) return {};
  const Frame plane = frame_with_z(mesh.vertices[f.loops[0][0].vertex], normal, {1, 0, 0});
  Box box;
  for (const Loop& loop : f.loops) {
    loops.emplace_back();
    for (const Corner c : loop) {
      loops.back().push_back(static_cast<std::uint32_t>(corners.size()));
      corners.push_back(c);
      box.add(place_back(plane, mesh.vertices[c.vertex]));
    }
  }
  const double scale = scale_for(std::max(box.extent().x, box.extent().y));
  std::vector<geometry::Grid2> points;
  for (const Corner c : corners) {
    const Vector3 p = place_back(plane, mesh.vertices[c.vertex]);
    points.push_back(geometry::to_grid(model::Point2{p.x * scale, p.y * scale}));
  }
  const auto triangles = geometry::triangulate(points, loops);
  std::vector<std::array<Corner, 3>> out;
  if (!triangles) return out;
  for (const auto& t : *triangles) out.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
  return out;
}

}  // namespace blockrand::grammar
