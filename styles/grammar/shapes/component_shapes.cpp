// Components as shapes of their own: frames, groups, connected sets.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "styles/grammar/shapes/components.h"
#include "styles/grammar/shapes/mesh_tools.h"

namespace blockrand::grammar {

namespace {

/// The component's own frame, in the parent's scope.
Frame own_frame(const ComponentSplit& split, const Component& item) {
  const Mesh& mesh = mesh_of(split.parent);
  switch (split.kind) {
    case ComponentKind::edges: {
      const Vector3 a = mesh.vertices[item.vertex_a], x = normalized(mesh.vertices[item.vertex_b] - a);
      const Vector3 y = normalized(cross(item.normal, x));
      if (x == Vector3{} || y == Vector3{}) return frame_with_z(a, item.normal, x);
      return {a, {x, y, cross(x, y)}};
    }
    case ComponentKind::face_edges: {
      const Vector3 a = mesh.vertices[item.vertex_a];
      return frame_with_z(a, item.normal, mesh.vertices[item.vertex_b] - a);
    }
    case ComponentKind::vertices:
      return frame_with_z(mesh.vertices[item.vertex_a], item.normal, cross({0, 1, 0}, item.normal));
    case ComponentKind::face_vertices:
      return frame_with_z(mesh.vertices[item.vertex_a], item.normal, cross(item.up, item.normal));
    case ComponentKind::faces:
    case ComponentKind::groups:
    case ComponentKind::materials:
    case ComponentKind::holes:
      break;
  }
  const Loop& loop = mesh.faces[item.face].loops[item.loop];
  const Vector3 a = mesh.vertices[loop[0].vertex], b = mesh.vertices[loop[1 % loop.size()].vertex];
  if (split.kind == ComponentKind::holes) return frame_with_z(b, item.normal, a - b);
  return frame_with_z(a, item.normal, b - a);
}

bool has_faces(ComponentKind kind) {
  return kind == ComponentKind::faces || kind == ComponentKind::groups || kind == ComponentKind::materials ||
         kind == ComponentKind::holes;
}

Shape assemble(const ComponentSplit& split, std::span<const std::size_t> chosen) {
  const Mesh& mesh = mesh_of(split.parent);
  Shape shape = split.parent;
  shape.mesh = nullptr;
  const Component& first = split.items[chosen[0]];
  const Frame frame = split.alignment == ComponentAlignment::z_up ? own_frame(split, first) : Frame{};
  if (split.alignment == ComponentAlignment::z_up) {
    shape.pivot = compose(scope_in_object(split.parent), frame);
    shape.scope = {};
    shape.size = {};
  }
  // Rounding must not make flat shapes thick.
  const auto flatten = [](Vector3 p) {
    constexpr double kFlat = 1e-9;
    return Vector3{std::fabs(p.x) < kFlat ? 0 : p.x, std::fabs(p.y) < kFlat ? 0 : p.y,
                   std::fabs(p.z) < kFlat ? 0 : p.z};
  };
  if (has_faces(split.kind)) {
    Mesh part;
    if (split.kind == ComponentKind::holes) {
      for (const std::size_t i : chosen) {
        const Component& item = split.items[i];
        Mesh one;
        one.tag_sets = mesh.tag_sets;
        one.vertices = mesh.vertices;
        MeshFace face{{mesh.faces[item.face].loops[item.loop]}, 0, mesh.faces[item.face].material};
        reverse_face(face);
        one.faces.push_back(std::move(face));
        drop_unused_vertices(one);
        append(part, one);
      }
    } else {
      std::vector<std::uint32_t> faces;
      for (const std::size_t i : chosen) {
        const Component& item = split.items[i];
        if (item.faces.empty())
          faces.push_back(item.face);
        else
          faces.insert(faces.end(), item.faces.begin(), item.faces.end());
      }
      part = extract_faces(mesh, faces);
    }
    if (split.alignment == ComponentAlignment::z_up) {
      into_frame(part, frame);
      for (Vector3& p : part.vertices) p = flatten(p);
    }
    take_mesh(shape, std::move(part));
    return shape;
  }
  Box box;
  for (const std::size_t i : chosen)
    for (const std::uint32_t v : {split.items[i].vertex_a, split.items[i].vertex_b})
      box.add(split.alignment == ComponentAlignment::z_up ? flatten(place_back(frame, mesh.vertices[v]))
                                                          : mesh.vertices[v]);
  shape.scope.origin = shape.scope.origin + turn(shape.scope, box.low);
  shape.size = box.extent();
  return shape;
}

}  // namespace

Shape component_shape(const ComponentSplit& split, std::size_t item) {
  Shape shape = assemble(split, std::span(&item, 1));
  const auto& planes = split.items[item].trim_planes;
  if (!planes.empty()) {
    auto all = shape.trim_planes ? *shape.trim_planes : std::vector<TrimPlane>{};
    all.insert(all.end(), planes.begin(), planes.end());
    shape.trim_planes = std::make_shared<const std::vector<TrimPlane>>(std::move(all));
  }
  return shape;
}

std::optional<Shape> component_group(const ComponentSplit& split, std::span<const std::size_t> chosen) {
  if (chosen.empty()) return {};
  return assemble(split, chosen);
}

std::vector<std::vector<std::size_t>> connected_sets(const ComponentSplit& split, std::span<const std::size_t> chosen) {
  std::vector<std::size_t> root(chosen.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  const Mesh& mesh = mesh_of(split.parent);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> seen;
  const auto meet = [&](std::uint32_t a, std::uint32_t b, std::size_t i) {
    const auto [it, added] = seen.emplace(std::pair(std::min(a, b), std::max(a, b)), i);
    if (added) return;
    const std::size_t p = find(it->second), q = find(i);
    root[std::max(p, q)] = std::min(p, q);
  };
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const Component& item = split.items[chosen[i]];
    if (!has_faces(split.kind)) {
      meet(item.vertex_a, item.vertex_a, i);
      meet(item.vertex_b, item.vertex_b, i);
      continue;
    }
    const auto faces = item.faces.empty() ? std::vector<std::uint32_t>{item.face} : item.faces;
    for (const std::uint32_t f : faces)
      for (const Loop& loop : mesh.faces[f].loops)
        for (std::size_t c = 0; c < loop.size(); ++c) meet(loop[c].vertex, loop[(c + 1) % loop.size()].vertex, i);
  }
  std::vector<std::vector<std::size_t>> out;
  std::vector<std::size_t> place(chosen.size(), chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const std::size_t r = find(i);
    if (place[r] == chosen.size()) {
      place[r] = out.size();
      out.emplace_back();
    }
    out[place[r]].push_back(chosen[i]);
  }
  return out;
}

}  // namespace blockrand::grammar
