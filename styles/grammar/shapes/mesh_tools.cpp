#include "styles/grammar/shapes/mesh_tools.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "pipeline/base/portable_math.h"

namespace blockrand::grammar {

void Box::add(Vector3 p) {
  if (empty) {
    low = high = p;
    empty = false;
    return;
  }
  low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
}

Box box_of(std::span<const Vector3> points) {
  Box box;
  for (const Vector3 p : points) box.add(p);
  return box;
}

Box box_of(const Mesh& mesh) {
  Box box;
  for (const MeshFace& face : mesh.faces)
    for (const Loop& loop : face.loops)
      for (const Corner c : loop) box.add(mesh.vertices[c.vertex]);
  return box;
}

Vector3 area_vector(const Mesh& mesh, const Loop& loop) {
  Vector3 sum;
  if (loop.size() < 3) return sum;
  // Relative to the first point: large coordinates must not swallow small areas.
  const Vector3 base = mesh.vertices[loop[0].vertex];
  Vector3 before = mesh.vertices[loop[1].vertex] - base;
  for (std::size_t i = 2; i < loop.size(); ++i) {
    const Vector3 here = mesh.vertices[loop[i].vertex] - base;
    sum = sum + cross(before, here);
    before = here;
  }
  return sum;
}

Vector3 area_vector(const Mesh& mesh, const MeshFace& face) {
  Vector3 sum;
  for (const Loop& loop : face.loops) sum = sum + area_vector(mesh, loop);
  return sum;
}

Vector3 face_normal(const Mesh& mesh, const MeshFace& face) {
  return face.loops.empty() ? Vector3{} : normalized(area_vector(mesh, face.loops[0]));
}

double face_area(const Mesh& mesh, const MeshFace& face) {
  if (face.loops.empty()) return 0;
  const Vector3 normal = face_normal(mesh, face);
  return std::max(0.0, dot(area_vector(mesh, face), normal) / 2);
}

double signed_volume(const Mesh& mesh) {
  if (mesh.faces.empty()) return 0;
  const Vector3 middle = mesh.vertices.empty() ? Vector3{} : mesh.vertices[0];
  double six = 0;
  for (const MeshFace& face : mesh.faces) {
    if (face.loops.empty() || face.loops[0].empty()) continue;
    const Vector3 base = mesh.vertices[face.loops[0][0].vertex];
    for (const Loop& loop : face.loops) {
      // A cone from `middle` over triangles from the face's first corner; right for bent faces, too.
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vector3 a = mesh.vertices[loop[i].vertex], b = mesh.vertices[loop[(i + 1) % loop.size()].vertex];
        six += dot(base - middle, cross(a - middle, b - middle));
      }
    }
  }
  return six / 6;
}

Vector3 face_middle(const Mesh& mesh, const MeshFace& face) {
  Vector3 sum;
  if (face.loops.empty() || face.loops[0].empty()) return sum;
  for (const Corner c : face.loops[0]) sum = sum + mesh.vertices[c.vertex];
  return sum * (1.0 / static_cast<double>(face.loops[0].size()));
}

std::vector<EdgeSide> edge_sides(const Mesh& mesh) {
  std::vector<EdgeSide> out;
  std::size_t count = 0;
  for (const MeshFace& face : mesh.faces)
    for (const Loop& loop : face.loops) count += loop.size();
  out.reserve(count);
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    for (std::uint32_t l = 0; l < mesh.faces[f].loops.size(); ++l) {
      const Loop& loop = mesh.faces[f].loops[l];
      for (std::uint32_t c = 0; c < loop.size(); ++c) {
        const std::uint32_t a = loop[c].vertex, b = loop[c + 1 == loop.size() ? 0 : c + 1].vertex;
        if (a != b) out.push_back({std::min(a, b), std::max(a, b), f, l, c, a < b});
      }
    }
  std::sort(out.begin(), out.end(), [](const EdgeSide& a, const EdgeSide& b) {
    return std::tie(a.low, a.high, a.face, a.loop, a.corner) < std::tie(b.low, b.high, b.face, b.loop, b.corner);
  });
  return out;
}

bool is_closed(const Mesh& mesh) {
  if (mesh.faces.size() < 4) return false;
  const auto sides = edge_sides(mesh);
  for (std::size_t i = 0; i < sides.size();) {
    int balance = 0;
    const std::size_t start = i;
    for (; i < sides.size() && sides[i].low == sides[start].low && sides[i].high == sides[start].high; ++i)
      balance += sides[i].forward ? 1 : -1;
    if (balance != 0) return false;
  }
  return !sides.empty();
}

void reverse_face(MeshFace& face, std::vector<std::vector<Vector2>>* uv) {
  for (std::size_t l = 0; l < face.loops.size(); ++l) {
    Loop& loop = face.loops[l];
    const std::size_t n = loop.size();
    if (n < 2) continue;
    Loop turned(n);
    std::vector<Vector2> turned_uv(n);
    const bool has_uv = uv != nullptr && l < uv->size() && (*uv)[l].size() == n;
    for (std::size_t i = 0; i < n; ++i) {
      // Corner 1 first: the edge from 0 to 1 becomes that from 1 to 0, and its tags go along.
      const std::size_t from = (n + 1 - i) % n;
      turned[i] = {loop[from].vertex, loop[(from + n - 1) % n].edge_tags};
      if (has_uv) turned_uv[i] = (*uv)[l][from];
    }
    loop = std::move(turned);
    if (has_uv) (*uv)[l] = std::move(turned_uv);
  }
}

void reverse_faces(Mesh& mesh) {
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    bool first = true;
    const MeshFace before = mesh.faces[f];
    for (UvSet& set : mesh.uv) {
      if (f >= set.size()) continue;
      MeshFace turned = before;
      reverse_face(turned, &set[f]);
      if (first) mesh.faces[f] = std::move(turned);
      first = false;
    }
    if (first) reverse_face(mesh.faces[f]);
  }
}

std::uint16_t add_tag(Mesh& mesh, std::uint16_t tags, std::string_view tag) {
  std::vector<std::string> set = mesh.tag_sets[tags];
  if (std::find(set.begin(), set.end(), tag) != set.end()) return tags;
  set.emplace_back(tag);
  std::sort(set.begin(), set.end());
  for (std::size_t i = 0; i < mesh.tag_sets.size(); ++i)
    if (mesh.tag_sets[i] == set) return static_cast<std::uint16_t>(i);
  if (mesh.tag_sets.size() >= 65535) return tags;
  mesh.tag_sets.push_back(std::move(set));
  return static_cast<std::uint16_t>(mesh.tag_sets.size() - 1);
}

const std::vector<std::vector<Vector2>>* uv_of(const Mesh& mesh, int set, std::size_t face) {
  const UvSet& uv = mesh.uv[static_cast<std::size_t>(set)];
  if (face >= uv.size() || uv[face].empty()) return nullptr;
  return &uv[face];
}

Mesh extract_faces(const Mesh& mesh, std::span<const std::uint32_t> faces) {
  Mesh out;
  out.tag_sets = mesh.tag_sets;
  constexpr std::uint32_t kNone = 0xffffffff;
  // A face of a large mesh: what is done for each must not take time for all vertices.
  std::size_t corners = 0;
  for (const std::uint32_t f : faces)
    for (const Loop& loop : mesh.faces[f].loops) corners += loop.size();
  const bool few = corners < mesh.vertices.size() / 4;
  std::vector<std::uint32_t> all(few ? 0 : mesh.vertices.size(), kNone);
  std::unordered_map<std::uint32_t, std::uint32_t> some;
  const auto place_of = [&](std::uint32_t vertex) -> std::uint32_t& {
    return few ? some.emplace(vertex, kNone).first->second : all[vertex];
  };
  out.faces.reserve(faces.size());
  for (const std::uint32_t f : faces) {
    out.faces.push_back(mesh.faces[f]);
    for (Loop& loop : out.faces.back().loops)
      for (Corner& c : loop) {
        std::uint32_t& to = place_of(c.vertex);
        if (to == kNone) {
          to = static_cast<std::uint32_t>(out.vertices.size());
          out.vertices.push_back(mesh.vertices[c.vertex]);
        }
        c.vertex = to;
      }
  }
  for (int s = 0; s < kUvSetCount; ++s) {
    const UvSet& from = mesh.uv[static_cast<std::size_t>(s)];
    if (from.empty()) continue;
    UvSet& to = out.uv[static_cast<std::size_t>(s)];
    for (const std::uint32_t f : faces) to.push_back(f < from.size() ? from[f] : UvSet::value_type{});
  }
  return out;
}

void append(Mesh& mesh, const Mesh& other) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  const std::size_t face_base = mesh.faces.size();
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  std::vector<std::uint16_t> tags(other.tag_sets.size(), 0);
  for (std::size_t i = 1; i < other.tag_sets.size(); ++i)
    for (const std::string& tag : other.tag_sets[i]) tags[i] = add_tag(mesh, tags[i], tag);
  for (MeshFace face : other.faces) {
    face.tags = tags[face.tags];
    for (Loop& loop : face.loops)
      for (Corner& c : loop) c = {c.vertex + base, tags[c.edge_tags]};
    mesh.faces.push_back(std::move(face));
  }
  for (std::size_t s = 0; s < mesh.uv.size(); ++s) {
    if (mesh.uv[s].empty() && other.uv[s].empty()) continue;
    mesh.uv[s].resize(face_base);
    mesh.uv[s].insert(mesh.uv[s].end(), other.uv[s].begin(), other.uv[s].end());
    mesh.uv[s].resize(mesh.faces.size());
  }
}

void drop_unused_vertices(Mesh& mesh) {
  constexpr std::uint32_t kNone = 0xffffffff;
  std::vector<std::uint32_t> moved(mesh.vertices.size(), kNone);
  std::vector<Vector3> kept;
  for (MeshFace& face : mesh.faces)
    for (Loop& loop : face.loops)
      for (Corner& c : loop) {
        if (moved[c.vertex] == kNone) {
          moved[c.vertex] = static_cast<std::uint32_t>(kept.size());
          kept.push_back(mesh.vertices[c.vertex]);
        }
        c.vertex = moved[c.vertex];
      }
  mesh.vertices = std::move(kept);
}

void drop_broken_faces(Mesh& mesh) {
  std::vector<std::uint32_t> kept;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    MeshFace& face = mesh.faces[f];
    if (face.loops.empty() || face.loops[0].size() < 3) continue;
    kept.push_back(f);
    for (std::size_t l = face.loops.size(); l-- > 1;)
      if (face.loops[l].size() < 3) {
        face.loops.erase(face.loops.begin() + static_cast<std::ptrdiff_t>(l));
        for (UvSet& set : mesh.uv)
          if (f < set.size() && l < set[f].size()) set[f].erase(set[f].begin() + static_cast<std::ptrdiff_t>(l));
      }
  }
  if (kept.size() < mesh.faces.size()) {
    std::string asset = std::move(mesh.asset);
    mesh = extract_faces(mesh, kept);
    mesh.asset = std::move(asset);
  }
}

void weld(Mesh& mesh, double tolerance) {
  const std::size_t n = mesh.vertices.size();
  std::vector<std::uint32_t> order(n), to(n);
  std::iota(order.begin(), order.end(), 0u);
  std::iota(to.begin(), to.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(mesh.vertices[a].x, a) < std::tie(mesh.vertices[b].x, b);
  });
  for (std::size_t i = 0; i < n; ++i) {
    if (to[order[i]] != order[i]) continue;
    const Vector3 p = mesh.vertices[order[i]];
    for (std::size_t k = i + 1; k < n && mesh.vertices[order[k]].x - p.x <= tolerance; ++k)
      if (to[order[k]] == order[k] && length(mesh.vertices[order[k]] - p) <= tolerance) to[order[k]] = order[i];
  }
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t l = 0; l < mesh.faces[f].loops.size(); ++l) {
      Loop& loop = mesh.faces[f].loops[l];
      for (Corner& c : loop) c.vertex = to[c.vertex];
      for (std::size_t i = loop.size(); i-- > 0;) {
        if (loop.size() < 2 || loop[i].vertex != loop[(i + 1) % loop.size()].vertex) continue;
        loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(i));
        for (UvSet& set : mesh.uv)
          if (f < set.size() && l < set[f].size() && i < set[f][l].size())
            set[f][l].erase(set[f][l].begin() + static_cast<std::ptrdiff_t>(i));
      }
    }
  drop_broken_faces(mesh);
  drop_unused_vertices(mesh);
}

void join_borders(Mesh& mesh, double tolerance) {
  // Each round puts one vertex into each open edge that has one on it; edges get shorter, so this ends.
  for (int round = 0; round < 64; ++round) {
    const auto sides = edge_sides(mesh);
    std::vector<EdgeSide> open;
    std::vector<bool> on_border(mesh.vertices.size(), false);
    for (std::size_t i = 0; i < sides.size();) {
      std::size_t end = i;
      int balance = 0;
      for (; end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high; ++end)
        balance += sides[end].forward ? 1 : -1;
      if (balance != 0)
        for (std::size_t k = i; k < end; ++k) {
          open.push_back(sides[k]);
          on_border[sides[k].low] = on_border[sides[k].high] = true;
        }
      i = end;
    }
    struct Insert {
      EdgeSide side;
      std::uint32_t vertex;
      double t;
    };
    std::vector<Insert> inserts;
    for (const EdgeSide& side : open) {
      const Vector3 a = mesh.vertices[side.low], d = mesh.vertices[side.high] - a;
      const double square = dot(d, d);
      if (!(square > 0)) continue;
      for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
        if (!on_border[v] || v == side.low || v == side.high) continue;
        const double t = dot(mesh.vertices[v] - a, d) / square;
        if (t <= 0 || t >= 1) continue;
        const Vector3 off = mesh.vertices[v] - (a + d * t);
        if (dot(off, off) > tolerance * tolerance) continue;
        inserts.push_back({side, v, t});
        break;
      }
    }
    if (inserts.empty()) return;
    // From the last corner to the first, so that places stay right.
    std::sort(inserts.begin(), inserts.end(), [](const Insert& a, const Insert& b) {
      return std::tie(b.side.face, b.side.loop, b.side.corner) < std::tie(a.side.face, a.side.loop, a.side.corner);
    });
    for (const Insert& in : inserts) {
      Loop& loop = mesh.faces[in.side.face].loops[in.side.loop];
      const std::size_t at = in.side.corner + 1;
      const double t = in.side.forward ? in.t : 1 - in.t;
      for (UvSet& set : mesh.uv)
        if (in.side.face < set.size() && in.side.loop < set[in.side.face].size()) {
          auto& uv = set[in.side.face][in.side.loop];
          const Vector2 a = uv[in.side.corner], b = uv[at % uv.size()];
          uv.insert(uv.begin() + static_cast<std::ptrdiff_t>(at), {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t});
        }
      loop.insert(loop.begin() + static_cast<std::ptrdiff_t>(at), {in.vertex, loop[in.side.corner].edge_tags});
    }
  }
}

void into_frame(Mesh& mesh, const Frame& inner) {
  for (Vector3& p : mesh.vertices) p = place_back(inner, p);
}

const Mesh& mesh_of(const Shape& shape) {
  static const Mesh kEmpty;
  return shape.mesh ? *shape.mesh : kEmpty;
}

const Mesh& MeshPointer::made() const {
  auto mesh = std::make_shared<Mesh>();
  MeshFace& face = mesh->faces.emplace_back();
  face.material = face_.material;
  Loop& loop = face.loops.emplace_back();
  loop.reserve(face_.size);
  mesh->vertices.assign(face_.points.begin(), face_.points.begin() + face_.size);
  for (std::uint32_t i = 0; i < face_.size; ++i) loop.push_back({i, 0});
  mesh_ = std::move(mesh);
  return *mesh_;
}

namespace {

/// Moves scope and points to the points' box.
void fit_scope(Shape& shape, const Box& box, std::span<Vector3> points) {
  Vector3 corner = box.low, size = box.high - box.low;
  for (int i = 0; i < 3; ++i)
    if (component(shape.size, i) < 0) {
      set_component(corner, i, component(box.high, i));
      set_component(size, i, -component(size, i));
    }
  if (corner != Vector3{})
    for (Vector3& p : points) p = p - corner;
  shape.scope.origin = shape.scope.origin + turn(shape.scope, corner);
  shape.size = size;
}

}  // namespace

void take_mesh(Shape& shape, Mesh mesh) {
  const Box box = box_of(mesh);
  if (box.empty) {
    shape.mesh = nullptr;
    return;
  }
  fit_scope(shape, box, mesh.vertices);
  shape.mesh = std::make_shared<const Mesh>(std::move(mesh));
}

void take_face(Shape& shape, SmallFace face) {
  const std::span<Vector3> points = std::span(face.points).first(face.size);
  fit_scope(shape, box_of(points), points);
  shape.mesh = face;
}

void take_mesh_in_frame(Shape& shape, Mesh mesh, const Frame& inner) {
  into_frame(mesh, inner);
  shape.scope = compose(shape.scope, inner);
  take_mesh(shape, std::move(mesh));
}

void keep_scope(Shape& shape, Mesh mesh) {
  shape.mesh = mesh.faces.empty() ? nullptr : std::make_shared<const Mesh>(std::move(mesh));
}

namespace {

/// The hint without its part along `axis`, length one; another hint where that is nothing.
Vector3 across(Vector3 axis, Vector3 hint) {
  constexpr double kParallel = 1e-9;  // sine of the angle: nearer directions say nothing
  for (const Vector3 candidate : {hint, Vector3{1, 0, 0}, Vector3{0, 0, 1}, Vector3{0, 1, 0}}) {
    const Vector3 rest = candidate - axis * dot(candidate, axis);
    if (length(rest) > kParallel * std::max(1e-12, length(candidate))) return normalized(rest);
  }
  return {1, 0, 0};
}

}  // namespace

Frame frame_with_y(Vector3 origin, Vector3 up, Vector3 x_hint) {
  Vector3 y = normalized(up);
  if (y == Vector3{}) y = {0, 1, 0};
  const Vector3 x = across(y, x_hint);
  return {origin, {x, y, cross(x, y)}};
}

Frame frame_with_z(Vector3 origin, Vector3 out, Vector3 x_hint) {
  Vector3 z = normalized(out);
  if (z == Vector3{}) z = {0, 0, 1};
  const Vector3 x = across(z, x_hint);
  return {origin, {x, cross(z, x), z}};
}

}  // namespace blockrand::grammar
