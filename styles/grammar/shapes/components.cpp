#include "styles/grammar/shapes/components.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "styles/grammar/shapes/mesh_tools.h"

namespace blockrand::grammar {

namespace {

constexpr double kTrimHorizontal =
    0.64278760968653932632;  ///< sine of 40 degrees: edges lower than that are horizontal
constexpr double kConcave = 1e-9;
constexpr double kLevel = 1e-6;  ///< rise over length of an edge that is level

bool is_bottom(const Mesh& mesh, std::uint32_t face) {
  for (const std::string& tag : mesh.tag_sets[mesh.faces[face].tags])
    if (tag_matches("roof.bottom", tag)) return true;
  return false;
}

class Finder {
 public:
  Finder(const Shape& shape, ComponentSplit& out) : shape_(shape), mesh_(mesh_of(shape)), out_(out) {
    normals_.reserve(mesh_.faces.size());
    for (const MeshFace& face : mesh_.faces) normals_.push_back(face_normal(mesh_, face));
  }

  void faces(bool trim) {
    const Frame object = trim ? scope_in_object(shape_) : Frame{};
    if (mesh_.faces.size() == 1) {  // facades: no neighbours, all is border
      add_face(0);
      out_.items.back().border = true;
      return;
    }
    prepare();
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f) {
      add_face(f);
      Component& item = out_.items.back();
      Frame aligned;
      if (trim) aligned = compose(object, frame_of(item));
      for (std::uint32_t l = 0; l < mesh_.faces[f].loops.size(); ++l)
        for (std::uint32_t c = 0; c < mesh_.faces[f].loops[l].size(); ++c) {
          const auto group = group_of(f, l, c);
          if (group.second - group.first == 1) item.border = true;
          if (!trim || group.second - group.first != 2) continue;
          const EdgeSide& other = sides_[sides_[group.first].face == f ? group.first + 1 : group.first];
          if (other.face == f) continue;
          add_trim_plane(item, f, l, c, other.face, object, aligned);
        }
    }
  }

  void face_edges() {
    prepare();
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f)
      for (std::uint32_t l = 0; l < mesh_.faces[f].loops.size(); ++l)
        for (std::uint32_t c = 0; c < mesh_.faces[f].loops[l].size(); ++c) {
          Component item = edge_item(f, l, c);
          const auto group = group_of(f, l, c);
          item.border = group.second - group.first == 1;
          item.up = normals_[f];
          item.normal = normalized(cross(vector_of(item), normals_[f]));
          out_.items.push_back(std::move(item));
        }
    classify();
  }

  void edges() {
    prepare();
    std::vector<bool> done(sides_.size(), false);
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f)
      for (std::uint32_t l = 0; l < mesh_.faces[f].loops.size(); ++l)
        for (std::uint32_t c = 0; c < mesh_.faces[f].loops[l].size(); ++c) {
          const auto group = group_of(f, l, c);
          if (group.first == group.second || done[group.first]) continue;
          done[group.first] = true;
          Component item = edge_item(f, l, c);
          item.border = group.second - group.first == 1;
          Vector3 sum;
          for (std::size_t k = group.first; k < group.second; ++k) sum = sum + normals_[sides_[k].face];
          item.normal = normalized(sum);
          out_.items.push_back(std::move(item));
        }
    classify();
  }

  void vertices(bool by_face) {
    prepare();
    std::vector<bool> border(mesh_.vertices.size(), false);
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      const bool alone = group_[i].second - group_[i].first == 1;
      if (alone) border[sides_[i].low] = border[sides_[i].high] = true;
    }
    std::vector<Vector3> sum(mesh_.vertices.size());
    std::vector<Component> first(mesh_.vertices.size());
    std::vector<bool> seen(mesh_.vertices.size(), false);
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f)
      for (std::uint32_t l = 0; l < mesh_.faces[f].loops.size(); ++l)
        for (std::uint32_t c = 0; c < mesh_.faces[f].loops[l].size(); ++c) {
          Component item = edge_item(f, l, c);
          item.vertex_b = item.vertex_a;
          item.border = border[item.vertex_a];
          sum[item.vertex_a] = sum[item.vertex_a] + normals_[f];
          if (by_face) {
            const Loop& loop = mesh_.faces[f].loops[l];
            const Vector3 p = mesh_.vertices[loop[c].vertex];
            const Vector3 in = normalized(p - mesh_.vertices[loop[(c + loop.size() - 1) % loop.size()].vertex]);
            const Vector3 on = normalized(mesh_.vertices[loop[(c + 1) % loop.size()].vertex] - p);
            item.up = normals_[f];
            item.normal = normalized(cross(in + on, normals_[f]));
            out_.items.push_back(std::move(item));
          } else if (!seen[item.vertex_a]) {
            seen[item.vertex_a] = true;
            first[item.vertex_a] = std::move(item);
          }
        }
    if (by_face) return;
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v)
      if (seen[v]) {
        first[v].normal = normalized(sum[v]);
        out_.items.push_back(std::move(first[v]));
      }
  }

  void groups(bool by_material) {
    std::map<std::uint16_t, std::size_t> known;
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f) {
      const std::uint16_t key = by_material ? mesh_.faces[f].material : 0;
      const auto [it, added] = known.emplace(key, out_.items.size());
      if (added) add_face(f);
      out_.items[it->second].faces.push_back(f);
    }
  }

  void holes() {
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f)
      for (std::uint32_t l = 1; l < mesh_.faces[f].loops.size(); ++l) {
        add_face(f);
        out_.items.back().loop = l;
      }
  }

  /// The frame of a face component in the scope: at its first vertex, x along the first edge.
  Frame frame_of(const Component& item) const {
    const Loop& loop = mesh_.faces[item.face].loops[item.loop];
    const Vector3 a = mesh_.vertices[loop[0].vertex], b = mesh_.vertices[loop[1 % loop.size()].vertex];
    return frame_with_z(a, item.normal, b - a);
  }

 private:
  Component edge_item(std::uint32_t f, std::uint32_t l, std::uint32_t c) const {
    const Loop& loop = mesh_.faces[f].loops[l];
    Component item;
    item.face = f;
    item.loop = l;
    item.corner = c;
    item.vertex_a = loop[c].vertex;
    item.vertex_b = loop[(c + 1) % loop.size()].vertex;
    return item;
  }
  Vector3 vector_of(const Component& item) const {
    return mesh_.vertices[item.vertex_b] - mesh_.vertices[item.vertex_a];
  }
  void add_face(std::uint32_t f) {
    Component& item = out_.items.emplace_back();
    item.face = f;
    item.normal = normals_[f];
  }

  void prepare() {
    sides_ = edge_sides(mesh_);
    group_.resize(sides_.size());
    first_side_.clear();
    std::uint32_t total = 0;
    for (const MeshFace& face : mesh_.faces)
      for (const Loop& loop : face.loops) {
        first_side_.push_back(total);
        total += static_cast<std::uint32_t>(loop.size());
      }
    face_loops_.clear();
    std::uint32_t loops = 0;
    for (const MeshFace& face : mesh_.faces) {
      face_loops_.push_back(loops);
      loops += static_cast<std::uint32_t>(face.loops.size());
    }
    side_of_.assign(total, 0xffffffff);
    for (std::size_t i = 0; i < sides_.size();) {
      std::size_t end = i;
      while (end < sides_.size() && sides_[end].low == sides_[i].low && sides_[end].high == sides_[i].high) ++end;
      for (std::size_t k = i; k < end; ++k) {
        group_[k] = {i, end};
        side_of_[first_side_[face_loops_[sides_[k].face] + sides_[k].loop] + sides_[k].corner] =
            static_cast<std::uint32_t>(k);
      }
      i = end;
    }
  }
  /// All sides of the edge: first and past the last in sides_.
  std::pair<std::size_t, std::size_t> group_of(std::uint32_t f, std::uint32_t l, std::uint32_t c) const {
    const std::uint32_t side = side_of_[first_side_[face_loops_[f] + l] + c];
    return side == 0xffffffff ? std::pair<std::size_t, std::size_t>{} : group_[side];
  }

  void add_trim_plane(Component& item, std::uint32_t f, std::uint32_t l, std::uint32_t c, std::uint32_t other,
                      const Frame& object, const Frame& aligned) const {
    const Loop& loop = mesh_.faces[f].loops[l];
    const Vector3 a = mesh_.vertices[loop[c].vertex], b = mesh_.vertices[loop[(c + 1) % loop.size()].vertex];
    const Vector3 normal = normalized(cross(b - a, normals_[f] + normals_[other]));
    if (normal == Vector3{}) return;  // a fold back onto itself
    // A plane that would cut the face itself (at inner corners) is none.
    for (const Loop& ring : mesh_.faces[f].loops)
      for (const Corner corner : ring)
        if (dot(normal, mesh_.vertices[corner.vertex] - a) > 1e-6) return;
    TrimPlane plane;
    plane.point = place(object, a);
    plane.normal = turn(object, normal);
    const Vector3 along = normalized(turn(object, b - a));
    plane.horizontal = std::fabs(dot(along, aligned.axes[1])) < kTrimHorizontal;
    item.trim_planes.push_back(plane);
  }

  /// eave, hip, valley, ridge, and which way such edges run.
  void classify() {
    const auto neighbours = [&](const Component& item) {
      const auto group = group_of(item.face, item.loop, item.corner);
      std::vector<EdgeSide> out;
      for (std::size_t k = group.first; k < group.second; ++k) out.push_back(sides_[k]);
      return out;
    };
    std::vector<bool> on_eave(mesh_.vertices.size(), false);
    const auto eave = [&](Component& item, const std::vector<EdgeSide>& around) {
      std::vector<EdgeSide> roof;
      for (const EdgeSide& side : around)
        if (!is_bottom(mesh_, side.face)) roof.push_back(side);
      if (roof.size() != 1) return false;
      const EdgeSide& side = roof[0];
      const Vector3 a = mesh_.vertices[side.forward ? side.low : side.high];
      const Vector3 b = mesh_.vertices[side.forward ? side.high : side.low];
      if (std::fabs(b.y - a.y) > kLevel * length(b - a)) return false;
      if (around.size() == 1 && mesh_.faces.size() == 1) return false;
      if (face_middle(mesh_, mesh_.faces[side.face]).y < a.y - kLevel) return false;
      if (out_.kind == ComponentKind::edges) {
        item.vertex_a = side.forward ? side.low : side.high;
        item.vertex_b = side.forward ? side.high : side.low;
        item.face = side.face;
        item.loop = side.loop;
        item.corner = side.corner;
      }
      return true;
    };
    for (Component& item : out_.items) {
      if (!eave(item, neighbours(item))) continue;
      item.roof_edge = Selector::Kind::eave;
      on_eave[item.vertex_a] = on_eave[item.vertex_b] = true;
    }
    for (Component& item : out_.items) {
      if (item.roof_edge != Selector::Kind::none) continue;
      const auto around = neighbours(item);
      if (around.size() != 2 || is_bottom(mesh_, around[0].face) || is_bottom(mesh_, around[1].face)) continue;
      const Vector3 n = normals_[around[0].face], m = normals_[around[1].face];
      if (std::fabs(n.y) < 1e-3 || std::fabs(m.y) < 1e-3) continue;  // a verge over an upright gable
      const EdgeSide& side = around[0];
      const Vector3 along =
          mesh_.vertices[side.forward ? side.high : side.low] - mesh_.vertices[side.forward ? side.low : side.high];
      const double fold = dot(cross(n, m), normalized(along));
      const bool touches = on_eave[item.vertex_a] || on_eave[item.vertex_b];
      item.roof_edge = fold < -kConcave ? Selector::Kind::valley
                       : touches        ? Selector::Kind::hip
                                        : Selector::Kind::ridge;
      if (out_.kind == ComponentKind::edges && mesh_.vertices[item.vertex_b].y < mesh_.vertices[item.vertex_a].y)
        std::swap(item.vertex_a, item.vertex_b);
    }
  }

  const Shape& shape_;
  const Mesh& mesh_;
  ComponentSplit& out_;
  std::vector<Vector3> normals_;
  std::vector<EdgeSide> sides_;
  std::vector<std::pair<std::size_t, std::size_t>> group_;
  std::vector<std::uint32_t> first_side_, face_loops_, side_of_;
};

}  // namespace

std::optional<ComponentKind> component_kind(std::string_view word) {
  constexpr std::array<std::string_view, 8> kWords{"f", "e", "fe", "v", "fv", "g", "m", "h"};
  for (std::size_t i = 0; i < kWords.size(); ++i)
    if (kWords[i] == word) return static_cast<ComponentKind>(i);
  return {};
}

ComponentSplit components(const Shape& shape, ComponentKind kind, ComponentAlignment alignment) {
  ComponentSplit out;
  out.parent = shape;
  out.kind = kind;
  out.alignment = alignment;
  Finder finder(shape, out);
  switch (kind) {
    case ComponentKind::faces:
      finder.faces(true);
      break;
    case ComponentKind::edges:
      finder.edges();
      break;
    case ComponentKind::face_edges:
      finder.face_edges();
      break;
    case ComponentKind::vertices:
    case ComponentKind::face_vertices:
      finder.vertices(kind == ComponentKind::face_vertices);
      break;
    case ComponentKind::groups:
    case ComponentKind::materials:
      finder.groups(kind == ComponentKind::materials);
      break;
    case ComponentKind::holes:
      finder.holes();
      break;
  }
  return out;
}

}  // namespace blockrand::grammar
