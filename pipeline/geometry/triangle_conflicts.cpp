#include "pipeline/geometry/triangle_conflicts.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace blockrand::geometry {

namespace {

struct GridTriangle {
  Grid3 p[3];
};

/// The projection that keeps a triangle's area largest.
enum class Axis { x, y, z };

Axis dominant_axis(const GridTriangle& t) {
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
    case Axis::x:
      return {p.y, p.z};
    case Axis::y:
      return {p.z, p.x};
    case Axis::z:
      break;
  }
  return {p.x, p.y};
}

/// As orientation() of four points: within 1,024 m, where nearly all solids lie, 64 bits hold the determinant. Faces of a
/// house lie in common planes, where doubles would have to ask 128 bits.
int side(const Grid3& a, const Grid3& b, const Grid3& c, const Grid3& d) {
  const Grid3 u = a - d, v = b - d, w = c - d;
  constexpr std::int64_t kSmall = std::int64_t{1} << 20;  // steps: six products of three are below 2^63
  const auto folded = [](std::int64_t x) { return x ^ (x >> 63); };
  const std::int64_t all = folded(u.x) | folded(u.y) | folded(u.z) | folded(v.x) | folded(v.y) | folded(v.z) |
                           folded(w.x) | folded(w.y) | folded(w.z);
  if (all >= kSmall) return orientation(a, b, c, d);
  const std::int64_t value =
      u.x * (v.y * w.z - v.z * w.y) + u.y * (v.z * w.x - v.x * w.z) + u.z * (v.x * w.y - v.y * w.x);
  return (value > 0) - (value < 0);
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
bool segment_meets_triangle(Grid3 p, Grid3 q, const GridTriangle& t) {
  const int sp = side(t.p[0], t.p[1], t.p[2], p), sq = side(t.p[0], t.p[1], t.p[2], q);
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
  const int a = side(p, q, t.p[0], t.p[1]), b = side(p, q, t.p[1], t.p[2]);
  const int c = side(p, q, t.p[2], t.p[0]);
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/// Do two triangles share more than the vertices and edges they have in common by index?
bool triangles_conflict(const std::array<std::uint32_t, 3>& ia, const GridTriangle& a,
                        const std::array<std::uint32_t, 3>& ib, const GridTriangle& b) {
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
    if (side(a.p[0], a.p[1], a.p[2], b.p[only_b]) != 0) return false;
    // Coplanar neighbours must lie on different sides of their common edge.
    const Axis axis = dominant_axis(a);
    const Grid2 e0 = project(a.p[(only_a + 1) % 3], axis), e1 = project(a.p[(only_a + 2) % 3], axis);
    return orientation(e0, e1, project(a.p[only_a], axis)) == orientation(e0, e1, project(b.p[only_b], axis));
  }
  // GridTriangle that are not shared and lie strictly on one side of the other triangle's plane end the question; this
  // is how nearly all neighbouring walls are told apart.
  const auto apart = [](const std::array<std::uint32_t, 3>& ip, const GridTriangle& plane,
                        const std::array<std::uint32_t, 3>& iq, const GridTriangle& other) {
    int known = 0;
    for (int k = 0; k < 3; ++k) {
      if (iq[k] == ip[0] || iq[k] == ip[1] || iq[k] == ip[2]) continue;
      const int s = side(plane.p[0], plane.p[1], plane.p[2], other.p[k]);
      if (s == 0 || s == -known) return false;
      known = s;
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

}  // namespace

bool triangles_conflict(std::span<const Grid3> vertices, const std::array<std::uint32_t, 3>& a,
                        const std::array<std::uint32_t, 3>& b) {
  return triangles_conflict(a, GridTriangle{{vertices[a[0]], vertices[a[1]], vertices[a[2]]}}, b,
                            GridTriangle{{vertices[b[0]], vertices[b[1]], vertices[b[2]]}});
}

SolidCheck check_intersections(std::span<const Grid3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles,
                               std::span<const std::uint32_t> face_of) {
  std::vector<Box> boxes(triangles.size());
  std::vector<GridTriangle> corners(triangles.size());
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

}  // namespace blockrand::geometry
