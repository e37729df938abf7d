#include "pipeline/geometry/triangulate.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace blockrand::geometry::triangulation {

using Epick = CGAL::Exact_predicates_inexact_constructions_kernel;

/// CGAL's predicates for points whose coordinates are whole numbers: rows of windows are full of points on one line and
/// on one circle, where CGAL's filters fail and its exact numbers are slow. The results are the same.
struct WholeNumberKernel : Epick {
  /// Coordinates below this keep all of the arithmetic below in 64 and 128 bits.
  static constexpr double kSmall = 536870912.0;  // 2^29: 524 km of the 1/1024 m grid
  template <class... Points>
  static bool small(const Points&... points) {
    return ((std::fabs(points.x()) < kSmall && std::fabs(points.y()) < kSmall) && ...);
  }
  static Grid2 between(const Point_2& from, const Point_2& to) {
    return {static_cast<std::int64_t>(to.x() - from.x()), static_cast<std::int64_t>(to.y() - from.y())};
  }
  static std::int64_t cross(Grid2 a, Grid2 b) { return a.x * b.y - a.y * b.x; }
  static std::int64_t square(Grid2 a) { return a.x * a.x + a.y * a.y; }

  struct Orientation_2 {
    using result_type = CGAL::Orientation;
    result_type operator()(const Point_2& p, const Point_2& q, const Point_2& r) const {
      if (!small(p, q, r)) return Epick().orientation_2_object()(p, q, r);
      const std::int64_t turn = cross(between(p, q), between(p, r));
      return static_cast<CGAL::Orientation>((turn > 0) - (turn < 0));
    }
  };
  struct Side_of_oriented_circle_2 {
    using result_type = CGAL::Oriented_side;
    result_type operator()(const Point_2& p, const Point_2& q, const Point_2& r, const Point_2& t) const {
      if (!small(p, q, r, t)) return Epick().side_of_oriented_circle_2_object()(p, q, r, t);
      const Grid2 a = between(t, p), b = between(t, q), c = between(t, r);
      const Int128 side = static_cast<Int128>(square(a)) * cross(b, c) + static_cast<Int128>(square(b)) * cross(c, a) +
                          static_cast<Int128>(square(c)) * cross(a, b);
      return static_cast<CGAL::Oriented_side>(sign(side));
    }
  };
  Orientation_2 orientation_2_object() const { return {}; }
  Side_of_oriented_circle_2 side_of_oriented_circle_2_object() const { return {}; }
};

}  // namespace blockrand::geometry::triangulation

/// Points are looked for as with CGAL's own kernel, which faces' order depends on.
template <>
struct CGAL::Triangulation_structural_filtering_traits<blockrand::geometry::triangulation::WholeNumberKernel> {
  using Use_structural_filtering_tag = CGAL::Tag_true;
};

namespace blockrand::geometry {

namespace {

using Kernel = triangulation::WholeNumberKernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceInfoBase = CGAL::Triangulation_face_base_with_info_2<int, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel, FaceInfoBase>;
using DataStructure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<Kernel, DataStructure, CGAL::No_constraint_intersection_tag>;

constexpr int kUnvisited = -1;

/// Marks each face with how many walls separate it from the outside.
/// \param is_wall  of the edge opposite vertex i of a face
template <class IsWall>
void mark_nesting(Cdt& cdt, IsWall&& is_wall) {
  for (auto f = cdt.all_faces_begin(); f != cdt.all_faces_end(); ++f) f->info() = kUnvisited;
  std::vector<Cdt::Face_handle> layer{cdt.infinite_face()}, next_layer;
  for (int level = 0; !layer.empty(); ++level) {
    while (!layer.empty()) {
      const Cdt::Face_handle face = layer.back();
      layer.pop_back();
      if (face->info() != kUnvisited) continue;
      face->info() = level;
      for (int i = 0; i < 3; ++i) {
        const Cdt::Face_handle other = face->neighbor(i);
        if (other->info() != kUnvisited) continue;
        (is_wall(face, i) ? next_layer : layer).push_back(other);
      }
    }
    layer.swap(next_layer);
  }
}

/// Two triangles of a convex quadrilateral along the diagonal that leaves the larger smallest area; none when the
/// quadrilateral is not strictly convex.
std::optional<std::array<Triangle, 2>> split_convex(std::span<const Grid2> p, std::span<const std::uint32_t> q) {
  const auto twice_area = [&](std::size_t a, std::size_t b, std::size_t c) {
    const Grid2 u = p[q[b]] - p[q[a]], v = p[q[c]] - p[q[a]];
    return static_cast<Int128>(u.x) * v.y - static_cast<Int128>(u.y) * v.x;
  };
  const Int128 a = twice_area(0, 1, 2), b = twice_area(0, 2, 3), c = twice_area(1, 2, 3), d = twice_area(1, 3, 0);
  if (a <= 0 || b <= 0 || c <= 0 || d <= 0) return std::nullopt;
  if (std::min(a, b) >= std::min(c, d))
    return std::array<Triangle, 2>{Triangle{q[0], q[1], q[2]}, Triangle{q[0], q[2], q[3]}};
  return std::array<Triangle, 2>{Triangle{q[1], q[2], q[3]}, Triangle{q[1], q[3], q[0]}};
}

}  // namespace

std::optional<std::vector<Triangle>> triangulate(std::span<const Grid2> points,
                                                 std::span<const std::vector<std::uint32_t>> loops) {
  std::vector<Triangle> out;
  if (loops.size() == 1 && loops[0].size() == 3) {
    const auto& t = loops[0];
    if (orientation(points[t[0]], points[t[1]], points[t[2]]) <= 0) return std::nullopt;
    out.push_back({t[0], t[1], t[2]});
    return out;
  }
  if (loops.size() == 1 && loops[0].size() == 4) {
    if (const auto two = split_convex(points, loops[0])) {
      out.assign(two->begin(), two->end());
      return out;
    }
  }
  Cdt cdt;
  std::size_t expected = 0;
  // CGAL sees coordinates relative to the first point: small integers keep its filters fast and exact.
  const Grid2 origin = points[loops[0][0]];
  try {
    std::vector<Cdt::Vertex_handle> handles;
    for (const auto& loop : loops) {
      handles.clear();
      for (const std::uint32_t i : loop) {
        const Grid2 p = points[i] - origin;
        const auto handle = cdt.insert(Kernel::Point_2(static_cast<double>(p.x), static_cast<double>(p.y)),
                                       handles.empty() ? Cdt::Face_handle() : handles.back()->face());
        handle->info() = i;
        handles.push_back(handle);
      }
      expected += loop.size();
      if (cdt.number_of_vertices() != expected) return std::nullopt;  // a point is repeated
      for (std::size_t k = 0; k < handles.size(); ++k)
        cdt.insert_constraint(handles[k], handles[(k + 1) % handles.size()]);
    }
  } catch (const Cdt::Intersection_of_constraints_exception&) {
    return std::nullopt;
  }
  mark_nesting(cdt, [&](Cdt::Face_handle face, int i) { return cdt.is_constrained({face, i}); });
  for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f) {
    if (f->info() % 2 == 0) continue;
    out.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  }
  // Euler: n vertices in h + 1 loops give n + 2h - 2 triangles; anything else means that loops touch or nest wrongly.
  if (out.size() != expected + 2 * (loops.size() - 1) - 2) return std::nullopt;
  return out;
}

std::optional<std::vector<Triangle>> triangulate_touching(std::span<const Grid2> points,
                                                          std::span<const std::vector<std::uint32_t>> loops) {
  Cdt cdt;
  const Grid2 origin = points[loops[0][0]];
  std::vector<Cdt::Vertex_handle> handles;
  const auto vertex = [&](std::uint32_t i) {
    const Grid2 p = points[i] - origin;
    const auto handle = cdt.insert(Kernel::Point_2(static_cast<double>(p.x), static_cast<double>(p.y)),
                                   handles.empty() ? Cdt::Face_handle() : handles.back()->face());
    handle->info() = i;
    return handle;
  };
  try {
    for (const auto& loop : loops) {
      handles.clear();
      for (const std::uint32_t i : loop) handles.push_back(vertex(i));
      for (std::size_t k = 0; k < handles.size(); ++k)
        if (handles[k] != handles[(k + 1) % handles.size()])
          cdt.insert_constraint(handles[k], handles[(k + 1) % handles.size()]);
    }
  } catch (const Cdt::Intersection_of_constraints_exception&) {
    return std::nullopt;
  }
  mark_nesting(cdt, [&](Cdt::Face_handle face, int i) { return cdt.is_constrained({face, i}); });
  std::vector<Triangle> out;
  for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f)
    if (f->info() % 2 == 1) out.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  return out;
}

std::optional<std::vector<Triangle>> triangulate_with_lines(std::span<const Grid2> points,
                                                            std::span<const std::vector<std::uint32_t>> loops,
                                                            std::span<const std::array<std::uint32_t, 2>> lines) {
  Cdt cdt;
  cdt.infinite_vertex()->info() = ~std::uint32_t{0};  // no index; walls are told by the indices of their ends
  std::vector<Cdt::Vertex_handle> handles(points.size());
  std::size_t used = 0;
  const Grid2 origin = points[loops[0][0]];
  const auto vertex = [&](std::uint32_t i) {
    if (handles[i] != Cdt::Vertex_handle()) return handles[i];
    const Grid2 p = points[i] - origin;
    handles[i] = cdt.insert(Kernel::Point_2(static_cast<double>(p.x), static_cast<double>(p.y)));
    handles[i]->info() = i;
    ++used;
    return handles[i];
  };
  std::set<std::pair<std::uint32_t, std::uint32_t>> walls;
  for (const auto& loop : loops)
    for (std::size_t k = 0; k < loop.size(); ++k) walls.insert(std::minmax(loop[k], loop[(k + 1) % loop.size()]));
  try {
    for (const auto& loop : loops)
      for (const std::uint32_t i : loop) vertex(i);
    for (const auto& line : lines)
      for (const std::uint32_t i : line) vertex(i);
    if (cdt.number_of_vertices() != used) return std::nullopt;  // two points at one place
    for (const auto& [a, b] : walls) cdt.insert_constraint(vertex(a), vertex(b));
    for (const auto& line : lines)
      if (line[0] != line[1]) cdt.insert_constraint(vertex(line[0]), vertex(line[1]));
  } catch (const Cdt::Intersection_of_constraints_exception&) {
    return std::nullopt;
  }
  // CGAL cuts a constraint that runs through a point without a word.
  for (const auto& [a, b] : walls)
    if (!cdt.is_edge(vertex(a), vertex(b))) return std::nullopt;
  for (const auto& line : lines)
    if (line[0] != line[1] && !cdt.is_edge(vertex(line[0]), vertex(line[1]))) return std::nullopt;
  mark_nesting(cdt, [&](Cdt::Face_handle face, int i) {
    return walls.contains(std::minmax(face->vertex(Cdt::cw(i))->info(), face->vertex(Cdt::ccw(i))->info()));
  });
  std::vector<Triangle> out;
  for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f)
    if (f->info() % 2 == 1) out.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  return out;
}

bool same_face(const model::Solid& before, const model::Solid& after, std::size_t face) {
  if (face >= before.faces.size() || face >= after.faces.size()) return false;
  const auto was = before.loops_of(before.faces[face]), is = after.loops_of(after.faces[face]);
  return std::equal(was.begin(), was.end(), is.begin(), is.end(), [&](const auto& a, const auto& b) {
    const auto p = before.indices_of(a), q = after.indices_of(b);
    return std::equal(p.begin(), p.end(), q.begin(), q.end());
  });
}

std::optional<model::SolidTriangles> triangulate(const model::Solid& solid) { return triangulate(solid, {}, {}); }

namespace {

/// How a face is seen from outside along the largest component of its normal, so that counter-clockwise stays
/// counter-clockwise.
class View {
 public:
  /// Of the normal of a loop, exact. \return nothing where it has no area
  template <class At>
  static std::optional<View> of_loop(std::size_t count, At&& at) {
    Int128 nx = 0, ny = 0, nz = 0;
    const Grid3 origin = at(0);
    Grid3 a{};
    for (std::size_t k = 1; k <= count; ++k) {
      const Grid3 b = k == count ? Grid3{} : at(k) - origin;
      nx += static_cast<Int128>(a.y) * b.z - static_cast<Int128>(a.z) * b.y;
      ny += static_cast<Int128>(a.z) * b.x - static_cast<Int128>(a.x) * b.z;
      nz += static_cast<Int128>(a.x) * b.y - static_cast<Int128>(a.y) * b.x;
      a = b;
    }
    const auto magnitude = [](Int128 v) { return v < 0 ? -v : v; };
    if (nx == 0 && ny == 0 && nz == 0) return std::nullopt;
    if (magnitude(nz) >= magnitude(nx) && magnitude(nz) >= magnitude(ny)) return View(Drop::z, nz > 0);
    if (magnitude(nx) >= magnitude(ny)) return View(Drop::x, nx > 0);
    return View(Drop::y, ny > 0);
  }
  Grid2 operator()(Grid3 p) const {
    switch (drop_) {
      case Drop::z:
        return before_ ? Grid2{p.x, p.y} : Grid2{p.y, p.x};
      case Drop::x:
        return before_ ? Grid2{p.y, p.z} : Grid2{p.z, p.y};
      case Drop::y:
        break;
    }
    return before_ ? Grid2{p.z, p.x} : Grid2{p.x, p.z};
  }

 private:
  enum class Drop { x, y, z };
  View(Drop drop, bool before) : drop_(drop), before_(before) {}
  Drop drop_;
  bool before_;
};

/// Two triangles of a quadrangle that is strictly convex in its view: what most faces are.
std::optional<std::array<Triangle, 2>> two_triangles(std::span<const Grid3> points,
                                                     std::span<const std::uint32_t> loop) {
  const auto view = View::of_loop(4, [&](std::size_t k) { return points[loop[k]]; });
  if (!view) return std::nullopt;
  std::array<Grid2, 4> flat;
  for (std::size_t k = 0; k < 4; ++k) flat[k] = (*view)(points[loop[k]]);
  auto two = split_convex(flat, std::array<std::uint32_t, 4>{0, 1, 2, 3});
  if (two)
    for (Triangle& t : *two)
      for (std::uint32_t& i : t) i = loop[i];
  return two;
}

}  // namespace

std::optional<std::vector<Triangle>> triangulate(std::span<const Grid3> points,
                                                 std::span<const std::vector<std::uint32_t>> loops) {
  const auto view = View::of_loop(loops[0].size(), [&](std::size_t k) { return points[loops[0][k]]; });
  if (!view) return std::nullopt;
  // Only the polygon's own points are projected: it may be one of thousands of a solid.
  std::vector<Grid2> flat;
  std::vector<std::uint32_t> number;
  std::vector<std::vector<std::uint32_t>> own(loops.size());
  for (std::size_t l = 0; l < loops.size(); ++l)
    for (const std::uint32_t i : loops[l]) {
      own[l].push_back(static_cast<std::uint32_t>(flat.size()));
      number.push_back(i);
      flat.push_back((*view)(points[i]));
    }
  auto out = triangulate(flat, own);
  if (out)
    for (Triangle& t : *out)
      for (std::uint32_t& i : t) i = number[i];
  return out;
}

std::optional<model::SolidTriangles> triangulate(
    const model::Solid& solid, const model::Solid& before, const model::SolidTriangles& known,
    std::span<const std::pair<std::uint32_t, std::vector<Triangle>>> ready) {
  model::SolidTriangles out;
  out.first.reserve(solid.faces.size() + 1);
  out.triangles.reserve(2 * solid.faces.size());
  std::vector<Grid3> grid(solid.vertices.size());
  for (std::size_t i = 0; i < grid.size(); ++i) grid[i] = to_grid(solid.vertices[i]);
  std::vector<std::vector<std::uint32_t>> loops;
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    const model::Face& face = solid.faces[f];
    out.first.push_back(static_cast<std::uint32_t>(out.triangles.size()));
    if (f + 1 < known.first.size() && same_face(before, solid, f)) {
      out.triangles.insert(out.triangles.end(), known.triangles.begin() + known.first[f],
                           known.triangles.begin() + known.first[f + 1]);
      continue;
    }
    while (!ready.empty() && ready.front().first < f) ready = ready.subspan(1);
    if (!ready.empty() && ready.front().first == f) {
      out.triangles.insert(out.triangles.end(), ready.front().second.begin(), ready.front().second.end());
      continue;
    }
    const auto face_loops = solid.loops_of(face);
    if (face_loops.size() == 1 && face_loops[0].count == 4)
      if (const auto two = two_triangles(grid, solid.indices_of(face_loops[0]))) {
        out.triangles.insert(out.triangles.end(), two->begin(), two->end());
        continue;
      }
    loops.resize(face_loops.size());
    for (std::size_t l = 0; l < face_loops.size(); ++l) {
      const auto indices = solid.indices_of(face_loops[l]);
      loops[l].assign(indices.begin(), indices.end());
      if (loops[l].size() < 3) return std::nullopt;
    }
    const auto triangles = triangulate(std::span<const Grid3>(grid), loops);
    if (!triangles) return std::nullopt;
    out.triangles.insert(out.triangles.end(), triangles->begin(), triangles->end());
  }
  out.first.push_back(static_cast<std::uint32_t>(out.triangles.size()));
  return out;
}

}  // namespace blockrand::geometry
