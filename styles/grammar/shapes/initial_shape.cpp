#include "styles/grammar/shapes/initial_shape.h"

#include <map>
#include <tuple>

#include "styles/grammar/shapes/mesh_tools.h"

namespace blockrand::grammar {

namespace {

/// Without points that lie on their neighbours. The first edge stays the first, also when its end is dropped.
std::vector<Vector3> tidy(const std::vector<Vector3>& ring) {
  std::vector<Vector3> out;
  for (const Vector3 p : ring) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
    if (out.empty() || length(p - out.back()) > kSamePoint) out.push_back(p);
  }
  while (out.size() > 1 && length(out.front() - out.back()) <= kSamePoint) out.pop_back();
  return out;
}

}  // namespace

Shape initial_shape(std::span<const InitialPolygon> polygons, std::vector<double> street_widths) {
  Shape shape;
  auto origin = std::make_shared<Origin>();
  origin->street_widths = std::move(street_widths);
  Mesh mesh;
  bool framed = false;
  std::map<std::tuple<double, double, double>, std::uint32_t> known;
  const auto vertex = [&](Vector3 p) {
    const auto [it, added] = known.emplace(std::tuple(p.x, p.y, p.z), static_cast<std::uint32_t>(mesh.vertices.size()));
    if (added) mesh.vertices.push_back(p);
    return it->second;
  };
  for (const InitialPolygon& polygon : polygons) {
    const std::vector<Vector3> ring = tidy(polygon.outline);
    if (ring.size() < 3) continue;
    MeshFace face;
    face.loops.emplace_back();
    for (const Vector3 p : ring) face.loops[0].push_back({vertex(p), 0});
    const Vector3 normal = face_normal(mesh, face);
    if (normal == Vector3{} || face_area(mesh, face) < kSamePoint * kSamePoint) continue;
    for (const auto& hole : polygon.holes) {
      const std::vector<Vector3> points = tidy(hole);
      if (points.size() < 3) continue;
      MeshFace turned;
      turned.loops.emplace_back();
      for (const Vector3 p : points) turned.loops[0].push_back({vertex(p), 0});
      if (dot(face_normal(mesh, turned), normal) > 0) reverse_face(turned);
      face.loops.push_back(std::move(turned.loops[0]));
    }
    if (!framed) {
      origin->world = frame_with_y(ring[0], normal, ring[1] - ring[0]);
      framed = true;
    }
    mesh.faces.push_back(std::move(face));
  }
  if (framed) into_frame(mesh, origin->world);
  if (framed) {
    const Loop& first = mesh.faces[0].loops[0];
    for (std::size_t i = 0; i < first.size(); ++i) {
      const Vector3 along = mesh.vertices[first[(i + 1) % first.size()].vertex] - mesh.vertices[first[i].vertex];
      origin->edge_normals.push_back(normalized(cross(along, {0, 1, 0})));
    }
  }
  drop_unused_vertices(mesh);
  shape.origin = std::move(origin);
  take_mesh(shape, std::move(mesh));
  return shape;
}

Shape initial_shape(std::vector<Vector3> outline) {
  const InitialPolygon polygon{std::move(outline), {}};
  return initial_shape(std::span(&polygon, 1));
}

}  // namespace blockrand::grammar
