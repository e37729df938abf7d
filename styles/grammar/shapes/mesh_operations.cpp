// Mending and changing meshes (docs/rule_language.md §2.6).
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/valid_polygon.h"
#include "styles/grammar/shapes/flat_face.h"
#include "styles/grammar/shapes/operation_list.h"

namespace blockrand::grammar {

namespace {

bool has_uv(const Mesh& mesh, std::size_t face) {
  for (int s = 0; s < kUvSetCount; ++s)
    if (uv_of(mesh, s, face) != nullptr) return true;
  return false;
}

/// Joins faces of one plane, material and tag set over their common edges. Faces with uv stay: their seams count.
void join_coplanar(Mesh& mesh, double cosine) {
  const std::size_t n = mesh.faces.size();
  std::vector<Vector3> normals;
  for (const MeshFace& face : mesh.faces) normals.push_back(face_normal(mesh, face));
  std::vector<std::size_t> root(n);
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  const auto sides = edge_sides(mesh);
  bool any = false;
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const EdgeSide &a = sides[i], &b = sides[i + 1];
    if (a.low != b.low || a.high != b.high || a.forward == b.forward || a.face == b.face) continue;
    const bool third = (i + 2 < sides.size() && sides[i + 2].low == a.low && sides[i + 2].high == a.high) ||
                       (i > 0 && sides[i - 1].low == a.low && sides[i - 1].high == a.high);
    const MeshFace &f = mesh.faces[a.face], &g = mesh.faces[b.face];
    if (third || f.material != g.material || f.tags != g.tags || has_uv(mesh, a.face) || has_uv(mesh, b.face)) continue;
    // Against the root's normal: a curve of many flat folds must not become one face.
    const std::size_t p = find(a.face), q = find(b.face);
    if (p == q || dot(normals[p], normals[q]) < cosine) continue;
    root[std::max(p, q)] = std::min(p, q);
    any = true;
  }
  if (!any) return;
  std::map<std::size_t, std::vector<std::uint32_t>> groups;
  for (std::uint32_t f = 0; f < n; ++f) groups[find(f)].push_back(f);
  Mesh out;
  out.vertices = mesh.vertices;
  out.tag_sets = mesh.tag_sets;
  for (const auto& [first, faces] : groups) {
    if (faces.size() == 1) {
      out.faces.push_back(mesh.faces[first]);
    } else {
      std::vector<LooseEdge> edges;
      for (const std::uint32_t f : faces)
        for (const Loop& loop : mesh.faces[f].loops)
          for (std::size_t c = 0; c < loop.size(); ++c)
            edges.push_back({loop[c].vertex, loop[(c + 1) % loop.size()].vertex, loop[c].edge_tags,
                             static_cast<std::uint32_t>(edges.size())});
      auto joined = faces_of_edges(mesh.vertices, std::move(edges), normals[first]);
      for (MeshFace& face : joined) {
        face.tags = mesh.faces[first].tags;
        face.material = mesh.faces[first].material;
        out.faces.push_back(std::move(face));
      }
    }
    for (std::size_t s = 0; s < mesh.uv.size(); ++s)
      if (!mesh.uv[s].empty()) {
        out.uv[s].resize(out.faces.size());
        if (faces.size() == 1 && first < mesh.uv[s].size()) out.uv[s].back() = mesh.uv[s][first];
      }
  }
  mesh = std::move(out);
}

/// Drops vertices that lie on a straight way between the same two neighbours in all their faces.
void drop_straight_vertices(Mesh& mesh, double sine) {
  struct Use {
    std::set<std::uint32_t> neighbours;
    bool straight = true;
  };
  std::vector<Use> uses(mesh.vertices.size());
  for (const MeshFace& face : mesh.faces)
    for (const Loop& loop : face.loops)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Corner before = loop[(i + loop.size() - 1) % loop.size()], after = loop[(i + 1) % loop.size()];
        Use& use = uses[loop[i].vertex];
        use.neighbours.insert(before.vertex);
        use.neighbours.insert(after.vertex);
        const Vector3 in = normalized(mesh.vertices[loop[i].vertex] - mesh.vertices[before.vertex]);
        const Vector3 on = normalized(mesh.vertices[after.vertex] - mesh.vertices[loop[i].vertex]);
        if (length(cross(in, on)) > sine || dot(in, on) < 0 || before.edge_tags != loop[i].edge_tags)
          use.straight = false;
      }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t l = 0; l < mesh.faces[f].loops.size(); ++l) {
      Loop& loop = mesh.faces[f].loops[l];
      const auto dropped = [&](std::size_t i) {
        const Use& use = uses[loop[i].vertex];
        return use.straight && use.neighbours.size() == 2;
      };
      std::size_t stay = 0;
      for (std::size_t i = 0; i < loop.size(); ++i) stay += dropped(i) ? 0 : 1;
      if (stay < 3 || stay == loop.size()) continue;
      for (std::size_t i = loop.size(); i-- > 0;) {
        if (!dropped(i)) continue;
        loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(i));
        for (UvSet& set : mesh.uv)
          if (f < set.size() && l < set[f].size() && i < set[f][l].size())
            set[f][l].erase(set[f][l].begin() + static_cast<std::ptrdiff_t>(i));
      }
    }
  drop_unused_vertices(mesh);
}

void drop_tiny_and_double_faces(Mesh& mesh, double least_area) {
  std::vector<std::uint32_t> kept;
  std::set<std::vector<std::uint32_t>> seen;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    if (face_area(mesh, mesh.faces[f]) <= least_area) continue;
    std::vector<std::uint32_t> key;
    for (const Loop& loop : mesh.faces[f].loops)
      for (const Corner c : loop) key.push_back(c.vertex);
    std::sort(key.begin(), key.end());
    if (!seen.insert(key).second) continue;
    kept.push_back(f);
  }
  if (kept.size() < mesh.faces.size()) mesh = extract_faces(mesh, kept);
}

}  // namespace

Result run_reverse_normals(Shape& shape, const OperationInput&, Arguments) {
  if (!shape.mesh) return {};
  Mesh mesh = *shape.mesh;
  reverse_faces(mesh);
  keep_scope(shape, std::move(mesh));
  return {};
}

Result run_delete_holes(Shape& shape, const OperationInput&, Arguments) {
  if (!shape.mesh) return {};
  Mesh mesh = *shape.mesh;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    mesh.faces[f].loops.resize(1);
    for (UvSet& set : mesh.uv)
      if (f < set.size() && !set[f].empty()) set[f].resize(1);
  }
  drop_unused_vertices(mesh);
  keep_scope(shape, std::move(mesh));
  return {};
}

Result run_cleanup_geometry(Shape& shape, const OperationInput&, Arguments arguments) {
  const std::string_view what = word(arguments, 0);
  if (what != "vertices" && what != "edges" && what != "faces" && what != "all")
    return failure(unknown_word(what, "vertices, edges, faces, all"));
  if (!is_number(arguments, 1)) return failure("the tolerance must be a number from 0 to 1");
  const double tolerance = std::clamp(number(arguments, 1), 0.0, 1.0);
  if (!shape.mesh) return {};
  Mesh mesh = *shape.mesh;
  // Rounding is mended at tolerance 0, too.
  weld(mesh, std::max(1e-6, tolerance));
  const auto turn = base::sin_cos(std::max(1e-4, 10 * tolerance) * base::kRadiansPerDegree);
  if (what == "edges" || what == "all") join_coplanar(mesh, turn.cos);
  if (what == "vertices" || what == "all") drop_straight_vertices(mesh, turn.sin);
  if (what == "faces" || what == "all") drop_tiny_and_double_faces(mesh, std::max(1e-9, tolerance));
  take_mesh(shape, std::move(mesh));
  return {};
}

Result run_convexify(Shape& shape, const OperationInput&, Arguments arguments) {
  if (auto ok = wants_numbers(arguments); !ok) return ok;
  // Only cuts shorter than this are made; a part that a longer one would divide stays concave.
  const double longest = arguments.empty() ? 1e300 : number(arguments, 0);
  if (!shape.mesh) return {};
  const Mesh& old = *shape.mesh;
  Mesh out;
  out.vertices = old.vertices;
  out.tag_sets = old.tag_sets;
  bool changed = false;
  for (std::size_t f = 0; f < old.faces.size(); ++f) {
    const MeshFace& face = old.faces[f];
    const Vector3 normal = face_normal(old, face);
    const auto turn_at = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      return dot(cross(old.vertices[b] - old.vertices[a], old.vertices[c] - old.vertices[b]), normal);
    };
    bool convex = face.loops.size() == 1;
    const Loop& outline = face.loops[0];
    for (std::size_t i = 0; convex && i < outline.size(); ++i)
      convex = turn_at(outline[i].vertex, outline[(i + 1) % outline.size()].vertex,
                       outline[(i + 2) % outline.size()].vertex) >= -1e-9;
    const auto triangles = convex ? std::vector<std::array<Corner, 3>>{} : triangles_of(old, f);
    if (convex || triangles.empty()) {
      out.faces.push_back(face);
      for (std::size_t s = 0; s < old.uv.size(); ++s)
        if (!old.uv[s].empty()) {
          out.uv[s].resize(out.faces.size());
          if (f < old.uv[s].size()) out.uv[s].back() = old.uv[s][f];
        }
      continue;
    }
    changed = true;
    // Which edges of the triangles are edges of the face, and their place along it.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::uint32_t, std::uint16_t>> own;
    std::map<std::uint32_t, std::pair<std::size_t, std::size_t>> place_of;
    for (std::size_t l = 0; l < face.loops.size(); ++l)
      for (std::size_t c = 0; c < face.loops[l].size(); ++c) {
        const Loop& loop = face.loops[l];
        own[{loop[c].vertex, loop[(c + 1) % loop.size()].vertex}] = {static_cast<std::uint32_t>(own.size()),
                                                                     loop[c].edge_tags};
        place_of[loop[c].vertex] = {l, c};
      }
    // Triangles grow together over inner edges as long as the result stays convex.
    std::vector<std::vector<std::uint32_t>> parts;
    for (const auto& t : triangles) parts.push_back({t[0].vertex, t[1].vertex, t[2].vertex});
    bool merged = true;
    while (merged) {
      merged = false;
      for (std::size_t a = 0; a < parts.size() && !merged; ++a)
        for (std::size_t b = a + 1; b < parts.size() && !merged; ++b)
          for (std::size_t i = 0; i < parts[a].size() && !merged; ++i) {
            const std::uint32_t p = parts[a][i], q = parts[a][(i + 1) % parts[a].size()];
            for (std::size_t k = 0; k < parts[b].size(); ++k) {
              if (parts[b][k] != q || parts[b][(k + 1) % parts[b].size()] != p) continue;
              std::vector<std::uint32_t> ring;
              for (std::size_t m = 1; m <= parts[a].size(); ++m) ring.push_back(parts[a][(i + m) % parts[a].size()]);
              for (std::size_t m = 2; m < parts[b].size(); ++m) ring.push_back(parts[b][(k + m) % parts[b].size()]);
              bool good = true;
              if (length(old.vertices[q] - old.vertices[p]) < longest) {
                for (std::size_t m = 0; m < ring.size() && good; ++m)
                  good = turn_at(ring[m], ring[(m + 1) % ring.size()], ring[(m + 2) % ring.size()]) >= -1e-9;
              } else {  // a ring round a hole would touch itself
                good = std::set<std::uint32_t>(ring.begin(), ring.end()).size() == ring.size();
              }
              if (!good) continue;
              parts[a] = std::move(ring);
              parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(b));
              merged = true;
              break;
            }
          }
    }
    // In the order of the edges they begin with.
    std::vector<std::pair<std::uint32_t, Loop>> ordered;
    for (const auto& ring : parts) {
      std::uint32_t best = 0xffffffff;
      std::size_t start = 0;
      for (std::size_t i = 0; i < ring.size(); ++i)
        if (const auto it = own.find({ring[i], ring[(i + 1) % ring.size()]});
            it != own.end() && it->second.first < best) {
          best = it->second.first;
          start = i;
        }
      Loop loop;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::uint32_t a = ring[(start + i) % ring.size()], b = ring[(start + i + 1) % ring.size()];
        const auto it = own.find({a, b});
        loop.push_back({a, it == own.end() ? std::uint16_t{0} : it->second.second});
      }
      ordered.emplace_back(best, std::move(loop));
    }
    std::stable_sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (auto& [order, loop] : ordered) {
      for (std::size_t s = 0; s < old.uv.size(); ++s) {
        if (old.uv[s].empty()) continue;
        out.uv[s].resize(out.faces.size() + 1);
        if (f >= old.uv[s].size() || old.uv[s][f].empty()) continue;
        out.uv[s].back().emplace_back();
        for (const Corner c : loop) {
          const auto [l, i] = place_of[c.vertex];
          out.uv[s].back()[0].push_back(old.uv[s][f][l][i]);
        }
      }
      out.faces.push_back({{std::move(loop)}, face.tags, face.material});
    }
  }
  if (changed) keep_scope(shape, std::move(out));
  return {};
}

Result run_rectify(Shape& shape, const OperationInput&, Arguments arguments) {
  if (auto ok = wants_numbers(arguments); !ok) return ok;
  if (!shape.mesh) return {};
  const double sine = base::sin_cos(std::clamp(number(arguments, 0), 0.0, 45.0) * base::kRadiansPerDegree).sin;
  Mesh mesh = *shape.mesh;
  const Mesh old = mesh;
  for (const MeshFace& face : old.faces) {
    const Vector3 normal = face_normal(old, face);
    const int out = std::fabs(normal.y) >= std::max(std::fabs(normal.x), std::fabs(normal.z)) ? 1
                    : std::fabs(normal.z) >= std::fabs(normal.x)                              ? 2
                                                                                              : 0;
    const int a = out == 0 ? 1 : 0, b = out == 2 ? 1 : 2;
    for (const Loop& loop : face.loops) {
      const std::size_t n = loop.size();
      struct Line {
        Vector2 point, way;
      };
      std::vector<Line> lines;
      for (std::size_t i = 0; i < n; ++i) {
        const Vector3 p = old.vertices[loop[i].vertex], q = old.vertices[loop[(i + 1) % n].vertex];
        Line line{{(component(p, a) + component(q, a)) / 2, (component(p, b) + component(q, b)) / 2},
                  {component(q, a) - component(p, a), component(q, b) - component(p, b)}};
        const double size = std::sqrt(line.way.x * line.way.x + line.way.y * line.way.y);
        if (size > 0) line.way = {line.way.x / size, line.way.y / size};
        if (std::fabs(line.way.y) <= sine)
          line.way = {line.way.x < 0 ? -1.0 : 1.0, 0};
        else if (std::fabs(line.way.x) <= sine)
          line.way = {0, line.way.y < 0 ? -1.0 : 1.0};
        lines.push_back(line);
      }
      for (std::size_t i = 0; i < n; ++i) {
        const Line &in = lines[(i + n - 1) % n], &on = lines[i];
        const double det = in.way.x * on.way.y - in.way.y * on.way.x;
        Vector3& p = mesh.vertices[loop[i].vertex];
        const Vector2 here{component(p, a), component(p, b)};
        Vector2 to = here;
        if (std::fabs(det) > 1e-3) {
          const double t = ((on.point.x - in.point.x) * on.way.y - (on.point.y - in.point.y) * on.way.x) / det;
          to = {in.point.x + in.way.x * t, in.point.y + in.way.y * t};
        } else {  // the edges run on: onto the line between their middles
          const double t = (here.x - on.point.x) * on.way.x + (here.y - on.point.y) * on.way.y;
          to = {on.point.x + on.way.x * t, on.point.y + on.way.y * t};
        }
        // In the face's plane again.
        const double moved_a = to.x - here.x, moved_b = to.y - here.y;
        const double slope = component(normal, out);
        set_component(p, a, to.x);
        set_component(p, b, to.y);
        if (std::fabs(slope) > 1e-6)
          set_component(p, out,
                        component(p, out) - (component(normal, a) * moved_a + component(normal, b) * moved_b) / slope);
      }
    }
  }
  take_mesh(shape, std::move(mesh));
  return {};
}

Result run_footprint(Shape& shape, const OperationInput&, Arguments) {
  if (!shape.mesh) return {};
  const Mesh& old = *shape.mesh;
  // Seen from above, x right and -z up; the faces that look up cover what the mesh covers.
  std::vector<model::Polygon> polygons;
  const bool closed = is_closed(old);
  for (const MeshFace& face : old.faces) {
    const Vector3 normal = face_normal(old, face);
    if (std::fabs(normal.y) < 1e-6 || (closed && normal.y < 0)) continue;
    model::Polygon polygon;
    for (std::size_t l = 0; l < face.loops.size(); ++l) {
      model::Ring ring;
      for (const Corner c : face.loops[l])
        ring.points.push_back(model::snap(model::Point2{old.vertices[c.vertex].x, -old.vertices[c.vertex].z}));
      if (normal.y < 0) std::reverse(ring.points.begin(), ring.points.end());
      ring.nodes.assign(ring.points.size(), 0);
      if (l == 0)
        polygon.outer = std::move(ring);
      else
        polygon.holes.push_back(std::move(ring));
    }
    if (geometry::strictly_simple(polygon)) polygons.push_back(std::move(polygon));
  }
  constexpr double kLeastArea = 1e-4, kClearance = 1.0 / 256;  // m², m: slivers of rounding
  const auto united = geometry::unite(polygons, kLeastArea, kClearance);
  Mesh out;
  for (const model::Polygon& polygon : united.polygons) {
    MeshFace face;
    const auto add = [&](const model::Ring& ring) {
      face.loops.emplace_back();
      for (const model::Point2 p : ring.points) {
        // The vertex it was made of, where there is one: no rounding then.
        Vector3 place{p.x, 0, -p.y};
        for (const Vector3 v : old.vertices)
          if (model::snap(v.x) == p.x && model::snap(-v.z) == p.y) {
            place = {v.x, 0, v.z};
            break;
          }
        face.loops.back().push_back({static_cast<std::uint32_t>(out.vertices.size()), 0});
        out.vertices.push_back(place);
      }
    };
    add(polygon.outer);
    for (const auto& hole : polygon.holes) add(hole);
    // The first edge is the one in front: the greatest z, then the least x of its start.
    Loop& loop = face.loops[0];
    const auto key = [&](std::size_t i) {
      const Vector3 a = out.vertices[loop[i].vertex], b = out.vertices[loop[(i + 1) % loop.size()].vertex];
      return std::pair((a.z + b.z) / 2, -a.x);
    };
    std::size_t first = 0;
    for (std::size_t i = 1; i < loop.size(); ++i)
      if (key(i) > key(first)) first = i;
    std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(first), loop.end());
    out.faces.push_back(std::move(face));
  }
  take_mesh(shape, std::move(out));
  return {};
}

Result run_shading(Shape&, const OperationInput&, Arguments) { return {}; }

}  // namespace blockrand::grammar
