#include "styles/grammar/shapes/extrude.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace blockrand::grammar {

namespace {

constexpr double kCoplanar = 1e-6;  ///< sine of the angle between normals, and m per m of extent, within one plane

bool coplanar(const Mesh& mesh) {
  const Vector3 normal = face_normal(mesh, mesh.faces[0]);
  const double level = dot(normal, mesh.vertices[mesh.faces[0].loops[0][0].vertex]);
  const double reach = kCoplanar * (1 + length(box_of(mesh).extent()));
  for (const MeshFace& face : mesh.faces) {
    for (const Loop& loop : face.loops)
      for (const Corner c : loop)
        if (std::fabs(dot(normal, mesh.vertices[c.vertex]) - level) > reach) return false;
    if (dot(face_normal(mesh, face), normal) < 0) return false;
  }
  return true;
}

/// Sum of the normals of the faces at each vertex, stretched so that their planes all move by 1.
std::vector<Vector3> vertex_ways(const Mesh& mesh) {
  std::vector<std::vector<Vector3>> around(mesh.vertices.size());
  for (const MeshFace& face : mesh.faces) {
    const Vector3 normal = face_normal(mesh, face);
    for (const Loop& loop : face.loops)
      for (const Corner c : loop) {
        auto& list = around[c.vertex];
        const bool known =
            std::any_of(list.begin(), list.end(), [&](Vector3 n) { return length(n - normal) < kCoplanar; });
        if (!known) list.push_back(normal);
      }
  }
  std::vector<Vector3> out;
  for (const auto& list : around) {
    Vector3 sum;
    for (const Vector3 n : list) sum = sum + n;
    sum = normalized(sum);
    double least = 1;
    for (const Vector3 n : list) least = std::min(least, dot(sum, n));
    constexpr double kLongest = 5;  // times the distance: sharper corners are cut short
    out.push_back(sum * std::min(kLongest, least > 0 ? 1 / least : 1.0));
  }
  return out;
}

/// Least and most of the vertices of faces along a direction.
std::pair<double, double> extent_along(const Mesh& mesh, Vector3 direction) {
  double low = 1e300, high = -1e300;
  for (const MeshFace& face : mesh.faces)
    for (const Loop& loop : face.loops)
      for (const Corner c : loop) {
        low = std::min(low, dot(direction, mesh.vertices[c.vertex]));
        high = std::max(high, dot(direction, mesh.vertices[c.vertex]));
      }
  return {low, high};
}

/// Sides on edges that one face has, in the order of the faces.
std::vector<EdgeSide> border_of(const std::vector<EdgeSide>& sides) {
  std::vector<EdgeSide> border;
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    if (end - i == 1) border.push_back(sides[i]);
    i = end;
  }
  std::sort(border.begin(), border.end(), [](const EdgeSide& a, const EdgeSide& b) {
    return std::tie(a.face, a.loop, a.corner) < std::tie(b.face, b.loop, b.corner);
  });
  return border;
}

}  // namespace

void extrude(Shape& shape, ExtrudeWay way, double distance) {
  const Mesh& old = mesh_of(shape);
  if (old.faces.empty() || distance == 0 || !std::isfinite(distance)) {
    if (way != ExtrudeWay::flat_top || old.faces.empty()) return;
  }
  const Vector3 first_normal = face_normal(old, old.faces[0]);
  if (first_normal == Vector3{}) return;
  const Vector3 up = normalized(turn_back(scope_in_object(shape), turn_back(object_in_world(shape), {0, 1, 0})));
  const bool upwards = way == ExtrudeWay::world_up || way == ExtrudeWay::flat_top;
  const bool one_body = way != ExtrudeWay::face_normal || coplanar(old);

  Mesh out;
  out.tag_sets = old.tag_sets;
  std::vector<std::vector<std::uint32_t>> bodies;
  if (one_body) {
    bodies.emplace_back();
    for (std::uint32_t f = 0; f < old.faces.size(); ++f) bodies[0].push_back(f);
  } else {
    for (std::uint32_t f = 0; f < old.faces.size(); ++f) bodies.push_back({f});
  }
  double flat_level = 0;
  if (way == ExtrudeWay::flat_top) {
    const auto [low, high] = extent_along(old, up);
    // From the lowest vertex upwards, from the highest downwards; never inside the face's own extent.
    flat_level = distance >= 0 ? std::max(low + distance, high) : std::min(high + distance, low);
    if (flat_level == low && flat_level == high) return;
  }
  const std::vector<Vector3> ways = way == ExtrudeWay::vertex_normal ? vertex_ways(old) : std::vector<Vector3>{};

  for (const auto& body : bodies) {
    Mesh base = extract_faces(old, body);
    // extract_faces numbers vertices in order of use: the same walk finds the old ones.
    std::vector<std::uint32_t> from(base.vertices.size());
    for (std::size_t i = 0; i < body.size(); ++i)
      for (std::size_t l = 0; l < base.faces[i].loops.size(); ++l)
        for (std::size_t c = 0; c < base.faces[i].loops[l].size(); ++c)
          from[base.faces[i].loops[l][c].vertex] = old.faces[body[i]].loops[l][c].vertex;
    const Vector3 normal = face_normal(base, base.faces[0]);
    const auto n = static_cast<std::uint32_t>(base.vertices.size());
    std::vector<Vector3> moved(n);
    for (std::uint32_t v = 0; v < n; ++v) {
      const Vector3 p = base.vertices[v];
      if (way == ExtrudeWay::face_normal)
        moved[v] = p + normal * distance;
      else if (way == ExtrudeWay::vertex_normal)
        moved[v] = p + ways[from[v]] * distance;
      else if (way == ExtrudeWay::world_up)
        moved[v] = p + up * distance;
      else
        moved[v] = p + up * (flat_level - dot(up, p));
    }
    // Downwards of the face, whichever way it looks.
    const bool below = upwards
                           ? dot(normal, up) * (way == ExtrudeWay::flat_top ? (distance < 0 ? -1 : 1) : distance) < 0
                           : distance < 0;
    Mesh solid;
    solid.tag_sets = base.tag_sets;
    solid.vertices = base.vertices;
    solid.vertices.insert(solid.vertices.end(), moved.begin(), moved.end());
    const std::size_t count = base.faces.size();
    for (auto& set : base.uv)
      if (!set.empty()) set.resize(count);
    for (int top = 0; top < 2; ++top)
      for (std::size_t f = 0; f < count; ++f) {
        MeshFace face = base.faces[f];
        std::array<std::vector<std::vector<Vector2>>, kUvSetCount> uv;
        for (std::size_t s = 0; s < uv.size(); ++s)
          if (!base.uv[s].empty()) uv[s] = base.uv[s][f];
        if ((top == 0) != below) {
          const MeshFace before = face;
          reverse_face(face);
          for (auto& u : uv)
            if (!u.empty()) {
              MeshFace scratch = before;
              reverse_face(scratch, &u);
            }
        }
        if (top == 1)
          for (Loop& loop : face.loops)
            for (Corner& c : loop) c.vertex += n;
        face.tags = add_tag(solid, face.tags, top == 0 ? "extrude.bottom" : "extrude.top");
        solid.faces.push_back(std::move(face));
        for (std::size_t s = 0; s < uv.size(); ++s)
          if (!base.uv[s].empty()) solid.uv[s].push_back(std::move(uv[s]));
      }
    for (const EdgeSide& side : border_of(edge_sides(base))) {
      const std::uint32_t a = side.forward ? side.low : side.high, b = side.forward ? side.high : side.low;
      const MeshFace& face = base.faces[side.face];
      MeshFace wall;
      wall.material = face.material;
      const std::uint16_t edge = face.loops[side.loop][side.corner].edge_tags;
      wall.tags = add_tag(solid, edge, side.loop == 0 ? "extrude.side.outer" : "extrude.side.inner");
      const bool flat_a = length(moved[a] - base.vertices[a]) < 1e-9,
                 flat_b = length(moved[b] - base.vertices[b]) < 1e-9;
      if (flat_a && flat_b) continue;
      Loop loop{{a, edge}, {b, 0}};
      if (!flat_b) loop.push_back({b + n, 0});
      if (!flat_a) loop.push_back({a + n, 0});
      wall.loops.push_back(std::move(loop));
      if (below) reverse_face(wall);
      solid.faces.push_back(std::move(wall));
    }
    for (auto& set : solid.uv)
      if (!set.empty()) set.resize(solid.faces.size());
    append(out, solid);
  }
  if (way == ExtrudeWay::flat_top) weld(out, 1e-9);
  const Vector3 y = upwards ? up : first_normal;
  shape.size = {0, distance < 0 ? -1.0 : 0.0, 0};
  take_mesh_in_frame(shape, std::move(out), frame_with_y({}, y, {1, 0, 0}));
}

}  // namespace blockrand::grammar
