#include "pipeline/geometry/check_solid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "pipeline/geometry/polygon.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::geometry {

namespace {

using model::Face;
using model::Solid;
using model::SolidTriangles;

// ---- edges and vertices -------------------------------------------------------------------------------------------

struct HalfEdge {
  std::uint32_t from, to;
  std::uint32_t next;  ///< following half-edge of its loop
  std::uint32_t face;
};

/// Closedness, orientation, manifoldness and connectedness, from half-edges alone.
SolidCheck check_topology(const std::vector<HalfEdge>& half_edges, std::size_t face_count) {
  const auto count = static_cast<std::uint32_t>(half_edges.size());
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t h) {
    const HalfEdge& e = half_edges[h];
    return std::pair(std::min(e.from, e.to), std::max(e.from, e.to));
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return key(a) != key(b) ? key(a) < key(b) : a < b;
  });
  std::vector<std::uint32_t> twin(count);
  for (std::uint32_t i = 0; i < count;) {
    std::uint32_t j = i;
    while (j < count && key(order[j]) == key(order[i])) ++j;
    const HalfEdge& a = half_edges[order[i]];
    if (j - i == 1) return {SolidDefect::open_edge, a.from, a.to};
    if (j - i > 2) return {SolidDefect::non_manifold_edge, a.from, a.to};
    if (half_edges[order[i + 1]].from == a.from) return {SolidDefect::wrong_orientation, a.from, a.to};
    twin[order[i]] = order[i + 1];
    twin[order[i + 1]] = order[i];
    i = j;
  }
  // The half-edges that leave a vertex must form one fan: turning around it reaches all of them.
  std::uint32_t vertex_count = 0;
  for (const HalfEdge& e : half_edges) vertex_count = std::max(vertex_count, e.from + 1);
  std::vector<bool> fan_seen(vertex_count, false), visited(count, false);
  for (std::uint32_t h = 0; h < count; ++h) {
    if (visited[h]) continue;
    const std::uint32_t v = half_edges[h].from;
    if (fan_seen[v]) return {SolidDefect::non_manifold_vertex, v, -1};
    fan_seen[v] = true;
    for (std::uint32_t g = h; !visited[g]; g = half_edges[twin[g]].next) visited[g] = true;
  }
  // One shell: all faces are reachable over edges.
  std::vector<std::uint32_t> parent(face_count);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t f) {
    while (parent[f] != f) f = parent[f] = parent[parent[f]];
    return f;
  };
  for (std::uint32_t h = 0; h < count; ++h) {
    const std::uint32_t a = root(half_edges[h].face), b = root(half_edges[twin[h]].face);
    if (a != b) parent[std::max(a, b)] = std::min(a, b);
  }
  for (std::uint32_t f = 1; f < face_count; ++f)
    if (root(f) != root(0)) return {SolidDefect::not_connected, 0, f};
  return {};
}

// ---- triangles against triangles ----------------------------------------------------------------------------------

struct Corners {
  Grid3 p[3];
};

/// The projection that keeps a triangle's area largest.
enum class Axis { x, y, z };

Axis dominant_axis(const Corners& t) {
  const Grid3 u = t.p[1] - t.p[0], v = t.p[2] - t.p[0];
  const double nx = std::fabs(static_cast<double>(u.y) * static_cast<double>(v.z) -
                              static_cast<double>(u.z) * static_cast<double>(v.y));
  const double ny = std::fabs(static_cast<double>(u.z) * static_cast<double>(v.x) -
                              static_cast<double>(u.x) * static_cast<double>(v.z));
  const double nz = std::fabs(static_cast<double>(u.x) * static_cast<double>(v.y) -
                              static_cast<double>(u.y) * static_cast<double>(v.x));
  if (nz >= nx && nz >= ny) return Axis::z;
  return nx >= ny ? Axis::x : Axis::y;
}

Grid2 project(Grid3 p, Axis axis) {
  switch (axis) {
    case Axis::x: return {p.y, p.z};
    case Axis::y: return {p.z, p.x};
    default: return {p.x, p.y};
  }
}

bool segments_meet(Grid2 a, Grid2 b, Grid2 c, Grid2 d) {
  const int o1 = orientation(a, b, c), o2 = orientation(a, b, d);
  const int o3 = orientation(c, d, a), o4 = orientation(c, d, b);
  if (o1 * o2 < 0 && o3 * o4 < 0) return true;
  return on_segment(a, b, c) || on_segment(a, b, d) || on_segment(c, d, a) || on_segment(c, d, b);
}

bool in_triangle(const Grid2 (&t)[3], Grid2 p) {
  const int a = orientation(t[0], t[1], p), b = orientation(t[1], t[2], p), c = orientation(t[2], t[0], p);
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/// Does the closed segment pq meet the closed triangle?
bool segment_meets_triangle(Grid3 p, Grid3 q, const Corners& t) {
  const int sp = orientation(t.p[0], t.p[1], t.p[2], p), sq = orientation(t.p[0], t.p[1], t.p[2], q);
  if (sp * sq > 0) return false;
  if (sp == 0 && sq == 0) {
    const Axis axis = dominant_axis(t);
    const Grid2 flat[3] = {project(t.p[0], axis), project(t.p[1], axis), project(t.p[2], axis)};
    const Grid2 a = project(p, axis), b = project(q, axis);
    if (in_triangle(flat, a) || in_triangle(flat, b)) return true;
    for (int i = 0; i < 3; ++i)
      if (segments_meet(a, b, flat[i], flat[(i + 1) % 3])) return true;
    return false;
  }
  const int a = orientation(p, q, t.p[0], t.p[1]), b = orientation(p, q, t.p[1], t.p[2]);
  const int c = orientation(p, q, t.p[2], t.p[0]);
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/// Do two triangles share more than the vertices and edges they have in common by index?
bool triangles_conflict(const std::array<std::uint32_t, 3>& ia, const Corners& a,
                        const std::array<std::uint32_t, 3>& ib, const Corners& b) {
  int shared = 0;
  int only_a = -1, only_b = -1, common_a = -1, common_b = -1;
  for (int i = 0; i < 3; ++i) {
    bool found = false;
    for (int j = 0; j < 3; ++j)
      if (ia[i] == ib[j]) {
        found = true;
        common_a = i;
        common_b = j;
      }
    if (found)
      ++shared;
    else
      only_a = i;
  }
  if (shared == 3) return true;
  if (shared == 2) {
    for (int j = 0; j < 3; ++j)
      if (ib[j] != ia[0] && ib[j] != ia[1] && ib[j] != ia[2]) only_b = j;
    if (orientation(a.p[0], a.p[1], a.p[2], b.p[only_b]) != 0) return false;
    // Coplanar neighbours must lie on different sides of their common edge.
    const Axis axis = dominant_axis(a);
    const Grid2 e0 = project(a.p[(only_a + 1) % 3], axis), e1 = project(a.p[(only_a + 2) % 3], axis);
    return orientation(e0, e1, project(a.p[only_a], axis)) == orientation(e0, e1, project(b.p[only_b], axis));
  }
  // Corners that are not shared and lie strictly on one side of the other triangle's plane end the question; this is
  // how nearly all neighbouring walls are told apart.
  const auto apart = [](const std::array<std::uint32_t, 3>& ip, const Corners& plane,
                        const std::array<std::uint32_t, 3>& iq, const Corners& other) {
    int side = 0;
    for (int k = 0; k < 3; ++k) {
      if (iq[k] == ip[0] || iq[k] == ip[1] || iq[k] == ip[2]) continue;
      const int s = orientation(plane.p[0], plane.p[1], plane.p[2], other.p[k]);
      if (s == 0 || s == -side) return false;
      side = s;
    }
    return true;
  };
  if (apart(ia, a, ib, b) || apart(ib, b, ia, a)) return false;
  if (shared == 1) {
    return segment_meets_triangle(a.p[(common_a + 1) % 3], a.p[(common_a + 2) % 3], b) ||
           segment_meets_triangle(b.p[(common_b + 1) % 3], b.p[(common_b + 2) % 3], a);
  }
  for (int i = 0; i < 3; ++i) {
    if (segment_meets_triangle(a.p[i], a.p[(i + 1) % 3], b)) return true;
    if (segment_meets_triangle(b.p[i], b.p[(i + 1) % 3], a)) return true;
  }
  return false;
}

struct Box {
  std::int64_t min[3], max[3];
  std::uint32_t triangle;
};

/// Finds a conflicting pair by a sweep along x. Triangles of one face (by `face_of`) cannot conflict: they come from one
/// triangulation of a simple polygon.
SolidCheck check_intersections(std::span<const Grid3> vertices,
                               std::span<const std::array<std::uint32_t, 3>> triangles,
                               std::span<const std::uint32_t> face_of) {
  std::vector<Box> boxes(triangles.size());
  std::vector<Corners> corners(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) corners[t].p[i] = vertices[triangles[t][i]];
    const auto& p = corners[t].p;
    const auto [x0, x1] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [y0, y1] = std::minmax({p[0].y, p[1].y, p[2].y});
    const auto [z0, z1] = std::minmax({p[0].z, p[1].z, p[2].z});
    boxes[t] = {{x0, y0, z0}, {x1, y1, z1}, t};
  }
  std::sort(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) {
    return a.min[0] != b.min[0] ? a.min[0] < b.min[0] : a.triangle < b.triangle;
  });
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size() && boxes[j].min[0] <= boxes[i].max[0]; ++j) {
      const Box &a = boxes[i], &b = boxes[j];
      if (a.min[1] > b.max[1] || b.min[1] > a.max[1] || a.min[2] > b.max[2] || b.min[2] > a.max[2]) continue;
      if (face_of[a.triangle] == face_of[b.triangle]) continue;
      if (triangles_conflict(triangles[a.triangle], corners[a.triangle], triangles[b.triangle], corners[b.triangle]))
        return {SolidDefect::self_intersection, std::min(face_of[a.triangle], face_of[b.triangle]),
                std::max(face_of[a.triangle], face_of[b.triangle])};
    }
  }
  return {};
}

/// Six times the volume in cubic grid units.
Int128 sixfold_volume(std::span<const Grid3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles) {
  Int128 sum = 0;
  if (triangles.empty()) return 0;
  const Grid3 o = vertices[triangles[0][0]];
  for (const auto& t : triangles) {
    const Grid3 a = vertices[t[0]] - o, b = vertices[t[1]] - o, c = vertices[t[2]] - o;
    sum += static_cast<Int128>(a.x) * (static_cast<Int128>(b.y) * c.z - static_cast<Int128>(b.z) * c.y) +
           static_cast<Int128>(a.y) * (static_cast<Int128>(b.z) * c.x - static_cast<Int128>(b.x) * c.z) +
           static_cast<Int128>(a.z) * (static_cast<Int128>(b.x) * c.y - static_cast<Int128>(b.y) * c.x);
  }
  return sum;
}

/// Largest distance of a face's vertices from the plane through their mean along Newell's normal, in metres.
double off_plane(const Solid& solid, const Face& face) {
  const auto outer = solid.indices_of(solid.loops_of(face)[0]);
  const model::Point3 o = solid.vertices[outer[0]];
  double nx = 0, ny = 0, nz = 0, mx = 0, my = 0, mz = 0;
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const model::Point3 p = solid.vertices[outer[i]], q = solid.vertices[outer[(i + 1) % outer.size()]];
    const double ax = p.x - o.x, ay = p.y - o.y, az = p.z - o.z, bx = q.x - o.x, by = q.y - o.y, bz = q.z - o.z;
    nx += ay * bz - az * by;
    ny += az * bx - ax * bz;
    nz += ax * by - ay * bx;
    mx += ax;
    my += ay;
    mz += az;
  }
  const double length = std::sqrt(nx * nx + ny * ny + nz * nz), n = static_cast<double>(outer.size());
  if (length == 0) return 0;
  double most = 0;
  for (const auto& loop : solid.loops_of(face))
    for (const std::uint32_t i : solid.indices_of(loop)) {
      const model::Point3 p = solid.vertices[i];
      const double d =
          ((p.x - o.x - mx / n) * nx + (p.y - o.y - my / n) * ny + (p.z - o.z - mz / n) * nz) / length;
      most = std::max(most, std::fabs(d));
    }
  return most;
}

/// Is a face a simple polygon with holes when looked at along its own normal? Readers project it so, while
/// triangulate() drops a coordinate; a face bent by rounding can be simple in one view and cross itself in the other.
bool simple_along_normal(const Solid& solid, const Face& face) {
  const auto loops = solid.loops_of(face);
  const auto outer = solid.indices_of(loops[0]);
  if (loops.size() == 1 && outer.size() == 3) return true;  // the triangulation has shown that it has an area
  const model::Point3 o = solid.vertices[outer[0]];
  double nx = 0, ny = 0, nz = 0;
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const model::Point3 p = solid.vertices[outer[i]], q = solid.vertices[outer[(i + 1) % outer.size()]];
    const double ax = p.x - o.x, ay = p.y - o.y, az = p.z - o.z, bx = q.x - o.x, by = q.y - o.y, bz = q.z - o.z;
    nx += ay * bz - az * by;
    ny += az * bx - ax * bz;
    nz += ax * by - ay * bx;
  }
  const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
  if (length == 0) return false;
  nx /= length, ny /= length, nz /= length;
  // Two axes in the plane: the first across the coordinate that the normal has least of.
  double ux = 0, uy = 0, uz = 0;
  if (std::fabs(nx) <= std::fabs(ny) && std::fabs(nx) <= std::fabs(nz))
    uy = -nz, uz = ny;
  else if (std::fabs(ny) <= std::fabs(nz))
    ux = nz, uz = -nx;
  else
    ux = -ny, uy = nx;
  const double size = std::sqrt(ux * ux + uy * uy + uz * uz);
  ux /= size, uy /= size, uz /= size;
  const double vx = ny * uz - nz * uy, vy = nz * ux - nx * uz, vz = nx * uy - ny * ux;
  // strictly_simple() works on the 1/1024 m grid: enlarged 64 times, the projection keeps a hundredth of a millimetre.
  constexpr double kEnlarge = 64;
  model::Polygon flat;
  for (std::size_t l = 0; l < loops.size(); ++l) {
    model::Ring ring;
    for (const std::uint32_t i : solid.indices_of(loops[l])) {
      const model::Point3 p = solid.vertices[i];
      const double x = p.x - o.x, y = p.y - o.y, z = p.z - o.z;
      ring.points.push_back(model::snap(model::Point2{kEnlarge * (x * ux + y * uy + z * uz), kEnlarge * (x * vx + y * vy + z * vz)}));
    }
    if (l == 0)
      flat.outer = std::move(ring);
    else
      flat.holes.push_back(std::move(ring));
  }
  if (!strictly_simple(flat)) return false;
  // A tip narrower than rounding can move its sides is simple in one view and not in the next. Horizontal faces are
  // exempt: every view of them is exact.
  if (nx == 0 && ny == 0) return true;
  constexpr double kNarrowest = 2 / model::kGridStepsPerMetre * kEnlarge;
  constexpr std::size_t kMostCorners = 500;  // the test is quadratic; larger inclined faces are lean-to roofs
  std::vector<const model::Ring*> rings{&flat.outer};
  std::size_t corners = flat.outer.size();
  for (const model::Ring& hole : flat.holes) {
    rings.push_back(&hole);
    corners += hole.size();
  }
  if (corners > kMostCorners) return true;
  for (const model::Ring* ring : rings)
    for (std::size_t i = 0; i < ring->size(); ++i) {
      const std::size_t j = (i + 1) % ring->size();
      for (const model::Ring* other : rings)
        for (std::size_t k = 0; k < other->size(); ++k) {
          if (other == ring && (k == i || k == j)) continue;
          if (distance_to_segment(other->points[k], ring->points[i], ring->points[j]) < kNarrowest) return false;
        }
    }
  return true;
}

SolidCheck check_places(std::span<const Grid3> vertices) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return vertices[a] != vertices[b] ? vertices[a] < vertices[b] : a < b;
  });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (vertices[order[i]] == vertices[order[i - 1]])
      return {SolidDefect::repeated_vertex, order[i - 1], order[i]};
  return {};
}

}  // namespace

std::string_view name(SolidDefect defect) {
  constexpr std::string_view names[] = {"none",         "empty",      "bad index",         "short loop",
                                        "repeated vertex", "invalid face", "not planar",   "open edge",
                                        "wrong orientation", "non-manifold edge", "non-manifold vertex",
                                        "not connected", "inside out", "self-intersection"};
  return names[static_cast<int>(defect)];
}

std::string SolidCheck::text() const {
  std::string out(name(defect));
  if (first >= 0) out += " at " + std::to_string(first);
  if (second >= 0) out += " and " + std::to_string(second);
  if (measure > 0) out += ", " + std::to_string(measure) + " m";
  return out;
}

SolidCheck check_solid(const Solid& solid, const SolidTriangles& triangles, const SolidCheckOptions& options) {
  if (solid.faces.empty()) return {SolidDefect::empty};
  std::vector<HalfEdge> half_edges;
  half_edges.reserve(solid.indices.size());
  std::vector<std::uint32_t> seen_in(solid.vertices.size(), 0);
  std::uint32_t loop_number = 0;
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
    for (const auto& loop : solid.loops_of(solid.faces[f])) {
      ++loop_number;
      const auto indices = solid.indices_of(loop);
      if (indices.size() < 3) return {SolidDefect::short_loop, f};
      const auto first = static_cast<std::uint32_t>(half_edges.size());
      const auto n = static_cast<std::uint32_t>(indices.size());
      for (std::uint32_t i = 0; i < n; ++i) {
        if (indices[i] >= solid.vertices.size()) return {SolidDefect::bad_index, f, indices[i]};
        if (seen_in[indices[i]] == loop_number) return {SolidDefect::repeated_vertex, f, indices[i]};
        seen_in[indices[i]] = loop_number;
        half_edges.push_back({indices[i], indices[(i + 1) % n], first + (i + 1) % n, f});
      }
    }
  }
  std::vector<Grid3> grid(solid.vertices.size());
  const Grid3 origin = grid.empty() ? Grid3{} : to_grid(solid.vertices[0]);
  for (std::size_t i = 0; i < grid.size(); ++i) grid[i] = to_grid(solid.vertices[i]) - origin;
  if (const SolidCheck c = check_places(grid); !c.valid()) return c;
  if (const SolidCheck c = check_topology(half_edges, solid.faces.size()); !c.valid()) return c;
  if (triangles.first.size() != solid.faces.size() + 1) return {SolidDefect::invalid_face};
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
    if (triangles.first[f] == triangles.first[f + 1]) return {SolidDefect::invalid_face, f};
    if (const double off = off_plane(solid, solid.faces[f]); off > options.planarity)
      return {SolidDefect::not_planar, f, -1, off};
    if (!simple_along_normal(solid, solid.faces[f])) return {SolidDefect::invalid_face, f};
  }
  if (sixfold_volume(grid, triangles.triangles) <= 0) return {SolidDefect::inside_out};
  std::vector<std::uint32_t> face_of(triangles.triangles.size());
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f)
    std::fill(face_of.begin() + triangles.first[f], face_of.begin() + triangles.first[f + 1], f);
  return check_intersections(grid, triangles.triangles, face_of);
}

SolidCheck check_mesh(std::span<const Grid3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles) {
  if (triangles.empty()) return {SolidDefect::empty};
  std::vector<HalfEdge> half_edges;
  std::vector<std::uint32_t> face_of(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    face_of[t] = t;
    const auto& v = triangles[t];
    for (const std::uint32_t i : v)
      if (i >= vertices.size()) return {SolidDefect::bad_index, t, i};
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) return {SolidDefect::repeated_vertex, t};
    for (std::uint32_t i = 0; i < 3; ++i) half_edges.push_back({v[i], v[(i + 1) % 3], 3 * t + (i + 1) % 3, t});
  }
  if (const SolidCheck c = check_places(vertices); !c.valid()) return c;
  if (const SolidCheck c = check_topology(half_edges, triangles.size()); !c.valid()) return c;
  if (sixfold_volume(vertices, triangles) <= 0) return {SolidDefect::inside_out};
  return check_intersections(vertices, triangles, face_of);
}

double volume(const Solid& solid, const SolidTriangles& triangles) {
  if (solid.vertices.empty()) return 0;
  std::vector<Grid3> grid(solid.vertices.size());
  for (std::size_t i = 0; i < grid.size(); ++i) grid[i] = to_grid(solid.vertices[i]);
  const double steps = model::kGridStepsPerMetre;
  return static_cast<double>(sixfold_volume(grid, triangles.triangles)) / (6 * steps * steps * steps);
}

}  // namespace blockrand::geometry
