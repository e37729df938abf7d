// Faces, plates, rims and boxes of elements.
#include "styles/elements/mesh_builder.h"

#include <algorithm>
#include <array>
#include <utility>

namespace blockrand::elements {

using model::Point2;
using model::Point3;

void MeshBuilder::face(std::span<const Point3> corners, Part part) {
  const auto first = static_cast<std::uint32_t>(mesh_.indices.size());
  for (const Point3& p : corners) {
    // Minus zero and zero are one place.
    const Point3 clean{p.x + 0.0, p.y + 0.0, p.z + 0.0};
    const auto [at, is_new] = corner_at_.try_emplace(clean, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(clean);
    if (mesh_.indices.size() > first && (mesh_.indices.back() == at->second || mesh_.indices[first] == at->second))
      continue;
    mesh_.indices.push_back(at->second);
  }
  const auto count = static_cast<std::uint32_t>(mesh_.indices.size()) - first;
  if (count < 3)
    mesh_.indices.resize(first);
  else
    mesh_.faces.push_back({first, count, part});
}

bool MeshBuilder::plate(const Outline& outer, std::span<const Outline> holes, double z, Part part) {
  std::vector<Point2> points;
  std::vector<std::vector<std::uint32_t>> loops;
  const auto add = [&](const Outline& outline, bool reversed) {
    std::vector<std::uint32_t> loop;
    for (const Point2 p : outline) {
      loop.push_back(static_cast<std::uint32_t>(points.size()));
      points.push_back(p);
    }
    if (reversed) std::reverse(loop.begin(), loop.end());
    loops.push_back(std::move(loop));
  };
  add(outer, false);
  for (const Outline& hole : holes) add(hole, true);
  const auto faces = convex_faces(points, loops);
  if (!faces) return false;
  std::vector<Point3> corners;
  for (const auto& f : *faces) {
    corners.clear();
    for (const std::uint32_t i : f) corners.push_back({points[i].x, points[i].y, z});
    face(corners, part);
  }
  return true;
}

void MeshBuilder::rim(const Outline& outline, double z_front, double z_back, Part part) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point2 a = outline[i], b = outline[(i + 1) % outline.size()];
    face(std::array<Point3, 4>{{{a.x, a.y, z_back}, {b.x, b.y, z_back}, {b.x, b.y, z_front}, {a.x, a.y, z_front}}},
         part);
  }
}

void MeshBuilder::recess(const Outline& outline, double z_front, double z_back, Part part) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point2 a = outline[i], b = outline[(i + 1) % outline.size()];
    face(std::array<Point3, 4>{{{b.x, b.y, z_back}, {a.x, a.y, z_back}, {a.x, a.y, z_front}, {b.x, b.y, z_front}}},
         part);
  }
}

void MeshBuilder::box(Point3 a, Point3 b, Part part, unsigned hidden) {
  const auto add = [&](unsigned side, const std::array<Point3, 4>& corners) {
    if ((hidden & side) == 0) face(corners, part);
  };
  begin_body();
  add(kFront, {{{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}}});
  add(kBack, {{{b.x, a.y, a.z}, {a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}}});
  add(kLeft, {{{a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z}}});
  add(kRight, {{{b.x, a.y, b.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}}});
  add(kBottom, {{{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}}});
  add(kTop, {{{a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z}}});
}

void MeshBuilder::prism(const Outline& convex, double z_front, double z_back, Part part) {
  begin_body();
  std::vector<Point3> corners;
  for (const Point2 p : convex) corners.push_back({p.x, p.y, z_front});
  face(corners, part);
  for (Point3& p : corners) p.z = z_back;
  std::reverse(corners.begin(), corners.end());
  face(corners, part);
  rim(convex, z_front, z_back, part);
}

void MeshBuilder::append(const ElementMesh& mesh, Point3 by) {
  begin_body();
  const auto vertex = static_cast<std::uint32_t>(mesh_.vertices.size());
  const auto index = static_cast<std::uint32_t>(mesh_.indices.size());
  for (const Point3& p : mesh.vertices) mesh_.vertices.push_back({p.x + by.x, p.y + by.y, p.z + by.z});
  for (const std::uint32_t i : mesh.indices) mesh_.indices.push_back(i + vertex);
  for (const ElementFace& f : mesh.faces) mesh_.faces.push_back({f.first + index, f.count, f.part});
}

ElementMesh MeshBuilder::take() {
  corner_at_.clear();
  return std::exchange(mesh_, {});
}

}  // namespace blockrand::elements
