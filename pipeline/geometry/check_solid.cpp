#include "pipeline/geometry/check_solid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "pipeline/geometry/fold_test.h"
#include "pipeline/geometry/normal_deviation.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/ring_defects.h"
#include "pipeline/geometry/triangle_conflicts.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/model/vector.h"

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
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
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

// ---- faces --------------------------------------------------------------------------------------------------------

using Vector = model::Point3;

/// The plane of a face's outer loop: Newell's normal through the mean of its corners.
struct FacePlane {
  model::Point3 origin;  ///< the first corner
  Vector normal;         ///< of unit length; null where the loop has no area
  double offset = 0;     ///< m from the origin to the plane along the normal
  double height(const model::Point3& p) const { return dot(p - origin, normal) - offset; }
};

FacePlane plane_of(const Solid& solid, const Face& face) {
  const auto outer = solid.indices_of(solid.loops_of(face)[0]);
  FacePlane out;
  out.origin = solid.vertices[outer[0]];
  Vector n, mean, a;
  for (std::size_t i = 1; i <= outer.size(); ++i) {
    const Vector b = i < outer.size() ? solid.vertices[outer[i]] - out.origin : Vector{};
    n.x += a.y * b.z - a.z * b.y;
    n.y += a.z * b.x - a.x * b.z;
    n.z += a.x * b.y - a.y * b.x;
    mean.x += b.x;
    mean.y += b.y;
    mean.z += b.z;
    a = b;
  }
  const double size = length(n);
  if (size == 0) return out;
  out.normal = {n.x / size, n.y / size, n.z / size};
  out.offset = dot(mean, out.normal) / static_cast<double>(outer.size());
  return out;
}

/// Largest distance of a face's vertices from a plane, in metres.
double off_plane(const Solid& solid, const Face& face, const FacePlane& plane) {
  double most = 0;
  for (const auto& loop : solid.loops_of(face))
    for (const std::uint32_t i : solid.indices_of(loop))
      most = std::max(most, std::fabs(plane.height(solid.vertices[i])));
  return most;
}

/// Seen along its normal, a face's loops on a grid 64 times as fine as 1/1024 m.
constexpr double kEnlarge = 64;
// A tip narrower than rounding can move its sides is simple in one view and not in the next.
constexpr double kNarrowest = 2 / model::kGridStepsPerMetre * kEnlarge;

model::Polygon seen_along_normal(const Solid& solid, const Face& face, const FacePlane& plane) {
  const Vector n = plane.normal;
  // Two axes in the plane: the first across the coordinate that the normal has least of.
  Vector u;
  if (std::fabs(n.x) <= std::fabs(n.y) && std::fabs(n.x) <= std::fabs(n.z))
    u = {0, -n.z, n.y};
  else if (std::fabs(n.y) <= std::fabs(n.z))
    u = {n.z, 0, -n.x};
  else
    u = {-n.y, n.x, 0};
  const double size = length(u);
  u = {u.x / size, u.y / size, u.z / size};
  const Vector v = cross(n, u);
  const auto loops = solid.loops_of(face);
  model::Polygon flat;
  flat.holes.resize(loops.size() - 1);
  for (std::size_t l = 0; l < loops.size(); ++l) {
    model::Ring& ring = l == 0 ? flat.outer : flat.holes[l - 1];
    ring.points.reserve(loops[l].count);
    for (const std::uint32_t i : solid.indices_of(loops[l])) {
      const Vector p = solid.vertices[i] - plane.origin;
      ring.points.push_back(model::snap(model::Point2{kEnlarge * dot(p, u), kEnlarge * dot(p, v)}));
    }
  }
  return flat;
}

/// A corner that lies nearer than kNarrowest to an edge that does not end there.
struct NarrowPlace {
  int corner_ring = -1, edge_ring = -1;
  double width = 0;  ///< m
  explicit operator bool() const { return corner_ring >= 0; }
};
NarrowPlace narrow_place(const model::Polygon& flat) {
  constexpr std::size_t kMostCorners = 500;  // the test is quadratic; larger inclined faces are lean-to roofs
  std::vector<const model::Ring*> rings{&flat.outer};
  std::size_t corners = flat.outer.size();
  for (const model::Ring& hole : flat.holes) {
    rings.push_back(&hole);
    corners += hole.size();
  }
  if (corners > kMostCorners) return {};
  for (std::size_t r = 0; r < rings.size(); ++r)
    for (std::size_t i = 0; i < rings[r]->size(); ++i) {
      const std::size_t j = (i + 1) % rings[r]->size();
      const model::Point2 a = rings[r]->points[i], b = rings[r]->points[j];
      const double x0 = std::min(a.x, b.x) - kNarrowest, x1 = std::max(a.x, b.x) + kNarrowest;
      const double y0 = std::min(a.y, b.y) - kNarrowest, y1 = std::max(a.y, b.y) + kNarrowest;
      for (std::size_t o = 0; o < rings.size(); ++o)
        for (std::size_t k = 0; k < rings[o]->size(); ++k) {
          const model::Point2 p = rings[o]->points[k];
          if (p.x < x0 || p.x > x1 || p.y < y0 || p.y > y1) continue;
          if (o == r && (k == i || k == j)) continue;
          if (const double d = distance_to_segment(p, a, b); d < kNarrowest)
            return {static_cast<int>(o), static_cast<int>(r), d / kEnlarge};
        }
    }
  return {};
}

bool horizontal(const FacePlane& plane) { return plane.normal.x == 0 && plane.normal.y == 0; }

/// Is a face a simple polygon with holes when looked at along its own normal? Readers project it so, while
/// triangulate() drops a coordinate; a face bent by rounding can be simple in one view and cross itself in the other.
bool simple_along_normal(const Solid& solid, const Face& face, const FacePlane& plane) {
  const auto loops = solid.loops_of(face);
  if (loops.size() == 1 && loops[0].count == 3) return true;  // the triangulation has shown that it has an area
  if (length(plane.normal) == 0) return false;
  const model::Polygon flat = seen_along_normal(solid, face, plane);
  // Horizontal faces are exempt from the test of narrow places: every view of them is exact.
  return strictly_simple(flat) && (horizontal(plane) || !narrow_place(flat));
}

enum class Drop { x, y, z };

/// The coordinate that a normal has most of.
Drop largest(const Vector& n) {
  const double x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
  return z >= x && z >= y ? Drop::z : x >= y ? Drop::x : Drop::y;
}
Grid2 without(Grid3 p, Drop drop) {
  if (drop == Drop::x) return {p.y, p.z};
  return drop == Drop::y ? Grid2{p.z, p.x} : Grid2{p.x, p.y};
}

/// Does a hole run round the same way as the outer loop?
std::int64_t turned_hole(const Solid& solid, const Face& face, const FacePlane& plane, std::span<const Grid3> grid) {
  const Drop drop = largest(plane.normal);
  const auto loops = solid.loops_of(face);
  const auto turns_left = [&](std::span<const std::uint32_t> loop) {
    Int128 twice = 0;
    const Grid2 o = without(grid[loop[0]], drop);
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
      const Grid2 u = without(grid[loop[i]], drop) - o, v = without(grid[loop[i + 1]], drop) - o;
      twice += static_cast<Int128>(u.x) * v.y - static_cast<Int128>(u.y) * v.x;
    }
    return twice > 0;
  };
  const bool outer = turns_left(solid.indices_of(loops[0]));
  for (std::size_t l = 1; l < loops.size(); ++l)
    if (turns_left(solid.indices_of(loops[l])) == outer) return static_cast<std::int64_t>(l);
  return 0;
}

/// The plane of three corners that lie far apart. Newell's normal of a loop that crosses itself may be that of a small
/// rest, tilted by rounding.
FacePlane widest_plane(const Solid& solid, const Face& face) {
  const auto outer = solid.indices_of(solid.loops_of(face)[0]);
  FacePlane out;
  out.origin = solid.vertices[outer[0]];
  Vector along, across;
  for (const std::uint32_t i : outer)
    if (const Vector d = solid.vertices[i] - out.origin; dot(d, d) > dot(along, along)) along = d;
  for (const std::uint32_t i : outer)
    if (const Vector n = cross(along, solid.vertices[i] - out.origin); dot(n, n) > dot(across, across)) across = n;
  if (const double size = length(across); size > 0) out.normal = {across.x / size, across.y / size, across.z / size};
  return out;
}

SolidCheck told(const RingsDefect& rings, std::uint32_t face) {
  const int ring = rings.second >= 0 ? rings.second : rings.first;
  return {rings.defect, face, ring};
}

/// What is wrong with a face that some test refused.
SolidCheck classify_face(const Solid& solid, std::uint32_t number, std::span<const Grid3> grid,
                         const SolidCheckOptions& options) {
  const Face& face = solid.faces[number];
  FacePlane plane = plane_of(solid, face);
  if (const double off = off_plane(solid, face, plane); length(plane.normal) == 0 || off > options.planarity) {
    plane = widest_plane(solid, face);
    if (length(plane.normal) == 0) return {SolidDefect::ring_crosses, number, 0};
    if (off_plane(solid, face, plane) > options.planarity) return {SolidDefect::not_planar, number, -1, off};
  }
  std::vector<std::vector<Grid2>> rings;
  for (const auto& loop : solid.loops_of(face)) {
    auto& ring = rings.emplace_back();
    for (const std::uint32_t i : solid.indices_of(loop)) ring.push_back(without(grid[i], largest(plane.normal)));
  }
  if (const RingsDefect d = find_rings_defect(rings); d.defect != SolidDefect::none) return told(d, number);
  const model::Polygon flat = seen_along_normal(solid, face, plane);
  rings.clear();
  const auto add = [&](const model::Ring& seen) {
    auto& ring = rings.emplace_back();
    for (const model::Point2 p : seen.points) ring.push_back(to_grid(p));
  };
  add(flat.outer);
  for (const model::Ring& hole : flat.holes) add(hole);
  RingsDefect d = find_rings_defect(rings);
  // Points of the grid that fall together in a view are no points that are the same.
  if (d.defect == SolidDefect::same_points) d.defect = SolidDefect::ring_crosses;
  if (d.defect != SolidDefect::none) return told(d, number);
  if (const NarrowPlace at = narrow_place(flat))
    return {at.corner_ring == at.edge_ring ? SolidDefect::ring_crosses : SolidDefect::rings_meet, number,
            std::max(at.corner_ring, at.edge_ring), at.width};
  return {};
}

/// The rules of a polygon but how far it folds and how its holes turn.
bool is_flat_and_simple(const Solid& solid, const Face& face, const FacePlane& plane, bool triangulated,
                        const SolidCheckOptions& options) {
  return triangulated && off_plane(solid, face, plane) <= options.planarity && simple_along_normal(solid, face, plane);
}

std::span<const std::array<std::uint32_t, 3>> triangles_of(const SolidTriangles& triangles, std::uint32_t face) {
  return std::span(triangles.triangles)
      .subspan(triangles.first[face], triangles.first[face + 1] - triangles.first[face]);
}

/// Rings and polygons: 1xx and 2xx. Every loop has three vertices that exist.
SolidCheck check_faces(const Solid& solid, const SolidTriangles& triangles, std::span<const Grid3> grid,
                       const SolidCheckOptions& options) {
  if (triangles.first.size() != solid.faces.size() + 1) {
    for (std::uint32_t f = 0; f < solid.faces.size(); ++f)
      if (const SolidCheck c = classify_face(solid, f, grid, options); !c.valid()) return c;
    return {SolidDefect::ring_crosses};  // the triangulation knows better
  }
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
    const Face& face = solid.faces[f];
    const FacePlane plane = plane_of(solid, face);
    if (!is_flat_and_simple(solid, face, plane, triangles.first[f] != triangles.first[f + 1], options)) {
      const SolidCheck c = classify_face(solid, f, grid, options);
      return c.valid() ? SolidCheck{SolidDefect::ring_crosses, f} : c;
    }
    if (folds_more_than(solid, face, triangles_of(triangles, f), options.normal_deviation))
      return {SolidDefect::folded, f, -1, normal_deviation(solid, face)};
    if (face.loop_count > 1)
      if (const std::int64_t hole = turned_hole(solid, face, plane, grid)) return {SolidDefect::hole_turned, f, hole};
  }
  return {};
}

/// Two vertices at one place, where there are such.
SolidCheck doubled_place(std::span<const Grid3> vertices) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return vertices[a] != vertices[b] ? vertices[a] < vertices[b] : a < b;
  });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (vertices[order[i]] == vertices[order[i - 1]]) return {SolidDefect::non_manifold_vertex, order[i - 1], order[i]};
  return {};
}

/// Rings that have a place twice: in a row, or else.
SolidCheck check_repetitions(const Solid& solid, std::span<const Grid3> grid) {
  std::vector<Grid3> places;
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
    const auto loops = solid.loops_of(solid.faces[f]);
    for (std::size_t l = 0; l < loops.size(); ++l) {
      const auto indices = solid.indices_of(loops[l]);
      const auto ring = static_cast<std::int64_t>(l);
      places.clear();
      for (const std::uint32_t i : indices) places.push_back(grid[i]);
      for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i] == places[(i + 1) % places.size()]) return {SolidDefect::same_points, f, ring};
      std::sort(places.begin(), places.end());
      if (std::adjacent_find(places.begin(), places.end()) != places.end()) return {SolidDefect::ring_crosses, f, ring};
    }
  }
  return {};
}

}  // namespace

namespace {
constexpr double kDegree = 0.017453292519943295;  // rad
}

std::string SolidCheck::text() const {
  std::string out = code() > 0 ? std::to_string(code()) + ' ' : std::string();
  out += name(defect);
  if (first >= 0) out += " at " + std::to_string(first);
  if (second >= 0) out += " and " + std::to_string(second);
  if (measure > 0)
    out += ", " + (defect == SolidDefect::folded ? std::to_string(measure / kDegree) + " degrees"
                                                 : std::to_string(measure) + " m");
  return out;
}

namespace {

/// Edges of all loops; their defects 101, 102, 104 by index.
SolidCheck walk_loops(const Solid& solid, std::vector<HalfEdge>& half_edges) {
  if (solid.faces.empty()) return {SolidDefect::empty};
  half_edges.reserve(solid.indices.size());
  std::vector<std::uint32_t> seen_in(solid.vertices.size(), 0);
  std::uint32_t loop_number = 0;
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
    std::int64_t number = 0;
    if (solid.faces[f].loop_count == 0) return {SolidDefect::too_few_points, f};
    for (const auto& loop : solid.loops_of(solid.faces[f])) {
      ++loop_number;
      const auto indices = solid.indices_of(loop);
      if (indices.size() < 3) return {SolidDefect::too_few_points, f, number};
      const auto first = static_cast<std::uint32_t>(half_edges.size());
      const auto n = static_cast<std::uint32_t>(indices.size());
      bool repeated = false;
      for (std::uint32_t i = 0; i < n; ++i) {
        if (indices[i] >= solid.vertices.size()) return {SolidDefect::bad_index, f, number};
        repeated = repeated || seen_in[indices[i]] == loop_number;
        seen_in[indices[i]] = loop_number;
        half_edges.push_back({indices[i], indices[(i + 1) % n], first + (i + 1) % n, f});
      }
      if (repeated) {
        for (std::uint32_t i = 0; i < n; ++i)
          if (indices[i] == indices[(i + 1) % n]) return {SolidDefect::same_points, f, number};
        return {SolidDefect::ring_crosses, f, number};
      }
      ++number;
    }
  }
  return {};
}

std::vector<Grid3> on_grid(const Solid& solid) {
  std::vector<Grid3> grid(solid.vertices.size());
  const Grid3 origin = grid.empty() ? Grid3{} : to_grid(solid.vertices[0]);
  for (std::size_t i = 0; i < grid.size(); ++i) grid[i] = to_grid(solid.vertices[i]) - origin;
  return grid;
}

/// The shell: 3xx and 405, once polygons are sound.
SolidCheck check_shell(std::span<const Grid3> grid, std::span<const std::array<std::uint32_t, 3>> triangles,
                       std::span<const std::uint32_t> face_of, const std::vector<HalfEdge>& half_edges,
                       std::size_t face_count, const SolidCheck& doubled) {
  if (face_count < 4) return {SolidDefect::too_few_faces};
  if (const SolidCheck c = check_topology(half_edges, face_count); !c.valid()) return c;
  if (!doubled.valid()) return doubled;
  const bool outwards = sixfold_volume(grid, triangles) > 0;
  if (const SolidCheck c = check_intersections(grid, triangles, face_of); !c.valid()) return c;
  return outwards ? SolidCheck{} : SolidCheck{SolidDefect::inside_out};
}

SolidCheck check_sound_loops(const Solid& solid, const SolidTriangles& triangles,
                             const std::vector<HalfEdge>& half_edges, const SolidCheckOptions& options) {
  const std::vector<Grid3> grid = on_grid(solid);
  const SolidCheck doubled = doubled_place(grid);
  if (!doubled.valid())
    if (const SolidCheck c = check_repetitions(solid, grid); !c.valid()) return c;
  if (const SolidCheck c = check_faces(solid, triangles, grid, options); !c.valid()) return c;
  std::vector<std::uint32_t> face_of(triangles.triangles.size());
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f)
    std::fill(face_of.begin() + triangles.first[f], face_of.begin() + triangles.first[f + 1], f);
  return check_shell(grid, triangles.triangles, face_of, half_edges, solid.faces.size(), doubled);
}

}  // namespace

SolidCheck check_solid(const Solid& solid, const SolidTriangles& triangles, const SolidCheckOptions& options) {
  std::vector<HalfEdge> half_edges;
  if (const SolidCheck c = walk_loops(solid, half_edges); !c.valid()) return c;
  return check_sound_loops(solid, triangles, half_edges, options);
}

SolidCheck check_solid(const Solid& solid) {
  std::vector<HalfEdge> half_edges;
  if (const SolidCheck c = walk_loops(solid, half_edges); !c.valid()) return c;
  const auto triangles = triangulate(solid);
  return check_sound_loops(solid, triangles ? *triangles : SolidTriangles{}, half_edges, {});
}

bool sound_polygon(const Solid& solid, std::uint32_t number, std::span<const std::array<std::uint32_t, 3>> triangles,
                   std::span<const Grid3> vertices, const SolidCheckOptions& options) {
  const Face& face = solid.faces[number];
  const FacePlane plane = plane_of(solid, face);
  return is_flat_and_simple(solid, face, plane, !triangles.empty(), options) &&
         !folds_more_than(solid, face, triangles, options.normal_deviation) &&
         (face.loop_count == 1 || turned_hole(solid, face, plane, vertices) == 0);
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
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) return {SolidDefect::same_points, t};
    for (std::uint32_t i = 0; i < 3; ++i) half_edges.push_back({v[i], v[(i + 1) % 3], 3 * t + (i + 1) % 3, t});
  }
  return check_shell(vertices, triangles, face_of, half_edges, triangles.size(), doubled_place(vertices));
}

SolidCheck check_polygon(std::span<const std::vector<model::Point3>> rings) {
  Solid solid;
  Face face;
  face.loop_count = static_cast<std::uint32_t>(rings.size());
  for (const auto& ring : rings) {
    solid.loops.push_back({static_cast<std::uint32_t>(solid.indices.size()), static_cast<std::uint32_t>(ring.size())});
    for (const model::Point3& p : ring) {
      solid.indices.push_back(static_cast<std::uint32_t>(solid.vertices.size()));
      solid.vertices.push_back(model::snap(p));
    }
  }
  solid.faces.push_back(face);
  std::vector<HalfEdge> half_edges;
  if (const SolidCheck c = walk_loops(solid, half_edges); !c.valid()) return c;
  const std::vector<Grid3> grid = on_grid(solid);
  if (!doubled_place(grid).valid()) return check_repetitions(solid, grid);
  const auto triangles = triangulate(solid);
  const SolidCheck c = check_faces(solid, triangles ? *triangles : SolidTriangles{}, grid, {});
  const bool narrow = c.measure > 0 && (c.defect == SolidDefect::ring_crosses || c.defect == SolidDefect::rings_meet);
  return narrow ? SolidCheck{} : c;  // that rule is ours, for what a grid rounds
}

double volume(const Solid& solid, const SolidTriangles& triangles) {
  if (solid.vertices.empty()) return 0;
  std::vector<Grid3> grid(solid.vertices.size());
  for (std::size_t i = 0; i < grid.size(); ++i) grid[i] = to_grid(solid.vertices[i]);
  const double steps = model::kGridStepsPerMetre;
  return static_cast<double>(sixfold_volume(grid, triangles.triangles)) / (6 * steps * steps * steps);
}

}  // namespace blockrand::geometry
