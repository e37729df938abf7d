#include "pipeline/geometry/solid_overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace blockrand::geometry {

namespace {

using model::Point3;
using Triangle = std::array<std::uint32_t, 3>;

struct Box {
  double min[3], max[3];
  double overlap(const Box& o, int k) const { return std::min(max[k], o.max[k]) - std::max(min[k], o.min[k]); }
};

Box box_of(std::span<const Point3> points) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Box box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (const Point3& p : points) {
    const double at[3] = {p.x, p.y, p.z};
    for (int k = 0; k < 3; ++k) {
      box.min[k] = std::min(box.min[k], at[k]);
      box.max[k] = std::max(box.max[k], at[k]);
    }
  }
  return box;
}

/// A triangle as a height over its plan.
struct Sheet {
  double x[3], y[3];              // counter-clockwise in plan
  double x0, x1, y0, y1;          // box
  double z0, z1;                  // lowest and highest corner
  double at_z, slope_x, slope_y;  // height over the first corner, and slopes
  int sign;                       // +1: the solid begins here (it faces down), -1: it ends
  double height(double px, double py) const {
    // Of a sheet that stands nearly upright, slopes times rounding could lead anywhere.
    return std::clamp(at_z + slope_x * (px - x[0]) + slope_y * (py - y[0]), z0, z1);
  }
};

/// Upright triangles have no plan and add no volume. m²; the plan of a triangle of a millimetre has 1e-6.
constexpr double kLeastPlan = 1e-13;

std::vector<Sheet> sheets_of(const ClosedMesh& mesh, const Point3& origin, const Box& common) {
  std::vector<Sheet> out;
  for (const Triangle& t : mesh.triangles) {
    double x[3], y[3], z[3];
    for (int k = 0; k < 3; ++k) {
      const Point3& p = mesh.vertices[t[static_cast<std::size_t>(k)]];
      x[k] = p.x - origin.x;
      y[k] = p.y - origin.y;
      z[k] = p.z - origin.z;
    }
    const double ux = x[1] - x[0], uy = y[1] - y[0], uz = z[1] - z[0];
    const double vx = x[2] - x[0], vy = y[2] - y[0], vz = z[2] - z[0];
    const double twice = ux * vy - uy * vx;
    if (!(std::fabs(twice) > 2 * kLeastPlan)) continue;
    Sheet s;
    const bool up = twice > 0;
    for (int k = 0; k < 3; ++k) {
      const int from = up || k == 0 ? k : 3 - k;
      s.x[k] = x[from];
      s.y[k] = y[from];
    }
    const auto [x0, x1] = std::minmax({x[0], x[1], x[2]});
    const auto [y0, y1] = std::minmax({y[0], y[1], y[2]});
    const auto [z0, z1] = std::minmax({z[0], z[1], z[2]});
    s.x0 = x0, s.x1 = x1, s.y0 = y0, s.y1 = y1, s.z0 = z0, s.z1 = z1;
    if (x1 <= common.min[0] - origin.x || x0 >= common.max[0] - origin.x || y1 <= common.min[1] - origin.y ||
        y0 >= common.max[1] - origin.y)
      continue;
    s.at_z = z[0];
    s.slope_x = (uz * vy - vz * uy) / twice;
    s.slope_y = (ux * vz - vx * uz) / twice;
    s.sign = up ? -1 : 1;
    out.push_back(s);
  }
  std::sort(out.begin(), out.end(), [](const Sheet& a, const Sheet& b) {
    return a.x0 != b.x0 ? a.x0 < b.x0 : a.y0 != b.y0 ? a.y0 < b.y0 : a.z0 < b.z0;
  });
  return out;
}

/// A convex polygon in plan with two heights in each corner.
struct Corner {
  double x, y, a, b;
};
struct Patch {
  Corner at[12];  // three corners, and at most one more for each of the cuts: three sides, and one where heights cross
  int count = 0;
  void add(const Corner& c) {
    if (count < 12) at[count++] = c;
  }
};

/// The part of a patch where `value` is not negative.
template <class Value>
Patch cut(const Patch& patch, const Value& value) {
  Patch out;
  for (int i = 0; i < patch.count; ++i) {
    const Corner &p = patch.at[i], &q = patch.at[(i + 1) % patch.count];
    const double vp = value(p), vq = value(q);
    if (vp >= 0) out.add(p);
    if ((vp > 0 && vq < 0) || (vp < 0 && vq > 0)) {
      const double t = vp / (vp - vq);
      out.add({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.a + t * (q.a - p.a), p.b + t * (q.b - p.b)});
    }
  }
  return out;
}

/// The integral of a height over a patch.
template <class Height>
double integral(const Patch& patch, const Height& height) {
  double sum = 0;
  for (int i = 1; i + 1 < patch.count; ++i) {
    const Corner &p = patch.at[0], &q = patch.at[i], &r = patch.at[i + 1];
    const double twice = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    sum += twice / 6 * (height(p) + height(q) + height(r));
  }
  return sum;
}

/// The integral of the larger of two heights over the plan that two sheets have in common.
double integral_of_larger(const Sheet& a, const Sheet& b) {
  Patch patch;
  for (int k = 0; k < 3; ++k) patch.add({a.x[k], a.y[k], 0, 0});
  for (int k = 0; k < 3 && patch.count >= 3; ++k) {
    const double x = b.x[k], y = b.y[k], dx = b.x[(k + 1) % 3] - x, dy = b.y[(k + 1) % 3] - y;
    patch = cut(patch, [&](const Corner& c) { return dx * (c.y - y) - dy * (c.x - x); });
  }
  if (patch.count < 3) return 0;
  bool a_above = true, b_above = true;
  for (int i = 0; i < patch.count; ++i) {
    Corner& c = patch.at[i];
    c.a = a.height(c.x, c.y);
    c.b = b.height(c.x, c.y);
    a_above = a_above && c.a >= c.b;
    b_above = b_above && c.b >= c.a;
  }
  const auto height_a = [](const Corner& c) { return c.a; };
  const auto height_b = [](const Corner& c) { return c.b; };
  if (a_above) return integral(patch, height_a);
  if (b_above) return integral(patch, height_b);
  return integral(cut(patch, [](const Corner& c) { return c.a - c.b; }), height_a) +
         integral(cut(patch, [](const Corner& c) { return c.b - c.a; }), height_b);
}

// How much a wall counts whose triangles are slivers: rounding turns their normals. m, of the smallest height.
constexpr double kFullHeight = 0.02;
// Keeps walls that are all but parallel from moving a corner far. Relative to walls of weight 1.
constexpr double kSteadying = 1e-3;
// Tips sharper than this stay longer than they should: no corner moves more than so many times as far as its walls.
constexpr double kFarthest = 4;

/// The vertices with every wall moved inwards by `by`: each corner goes where the planes around it meet.
std::vector<Point3> shrunk(const ClosedMesh& mesh, double by) {
  struct Normals {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0, x = 0, y = 0, z = 0;
  };
  std::vector<Normals> sums(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    const Point3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const double wx = vx - ux, wy = vy - uy, wz = vz - uz;
    double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const double size = std::sqrt(nx * nx + ny * ny + nz * nz);
    const double longest =
        std::sqrt(std::max({ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz, wx * wx + wy * wy + wz * wz}));
    if (!(size > 0)) continue;
    nx /= size, ny /= size, nz /= size;
    const double w = std::min(1.0, size / longest / kFullHeight);
    for (const std::uint32_t i : t) {
      Normals& s = sums[i];
      s.xx += w * nx * nx, s.xy += w * nx * ny, s.xz += w * nx * nz;
      s.yy += w * ny * ny, s.yz += w * ny * nz, s.zz += w * nz * nz;
      s.x += w * nx, s.y += w * ny, s.z += w * nz;
    }
  }
  std::vector<Point3> out(mesh.vertices.begin(), mesh.vertices.end());
  for (std::size_t i = 0; i < out.size(); ++i) {
    Normals s = sums[i];
    s.xx += kSteadying, s.yy += kSteadying, s.zz += kSteadying;
    // Least squares of normal · step = -1 by Cramer's rule; the matrix is symmetric and positive.
    const double c00 = s.yy * s.zz - s.yz * s.yz, c01 = s.xz * s.yz - s.xy * s.zz, c02 = s.xy * s.yz - s.xz * s.yy;
    const double c11 = s.xx * s.zz - s.xz * s.xz, c12 = s.xy * s.xz - s.xx * s.yz, c22 = s.xx * s.yy - s.xy * s.xy;
    const double determinant = s.xx * c00 + s.xy * c01 + s.xz * c02;
    double x = -(c00 * s.x + c01 * s.y + c02 * s.z) / determinant;
    double y = -(c01 * s.x + c11 * s.y + c12 * s.z) / determinant;
    double z = -(c02 * s.x + c12 * s.y + c22 * s.z) / determinant;
    const double far = std::sqrt(x * x + y * y + z * z);
    const double scale = by * (far > kFarthest ? kFarthest / far : 1);
    out[i] = {out[i].x + scale * x, out[i].y + scale * y, out[i].z + scale * z};
  }
  return out;
}

}  // namespace

double common_volume(const ClosedMesh& a, const ClosedMesh& b) {
  if (a.triangles.empty() || b.triangles.empty()) return 0;
  const Box box_a = box_of(a.vertices), box_b = box_of(b.vertices);
  Box common;
  for (int k = 0; k < 3; ++k) {
    if (!(box_a.overlap(box_b, k) > 0)) return 0;
    common.min[k] = std::max(box_a.min[k], box_b.min[k]);
    common.max[k] = std::min(box_a.max[k], box_b.max[k]);
  }
  // Over a point of the plan, a solid is the sum of steps: up by one where it begins, down where it ends. The length
  // that both have in common there is the integral of the product of both sums, which is the sum over pairs of steps of
  // minus the larger height, with the sign of both. So the volume is a sum over pairs of triangles.
  const Point3 origin{common.min[0], common.min[1], common.min[2]};
  const std::vector<Sheet> sheets_a = sheets_of(a, origin, common), sheets_b = sheets_of(b, origin, common);
  double widest = 0, sum = 0;
  for (const Sheet& s : sheets_b) widest = std::max(widest, s.x1 - s.x0);
  for (const Sheet& s : sheets_a) {
    auto t = std::lower_bound(sheets_b.begin(), sheets_b.end(), s.x0 - widest,
                              [](const Sheet& sheet, double x) { return sheet.x0 < x; });
    for (; t != sheets_b.end() && t->x0 < s.x1; ++t)
      if (t->x1 > s.x0 && t->y0 < s.y1 && s.y0 < t->y1) sum -= s.sign * t->sign * integral_of_larger(s, *t);
  }
  return std::max(sum, 0.0);
}

bool interiors_meet(const ClosedMesh& a, const ClosedMesh& b) { return common_volume(a, b) > kLeastCommonVolume; }

SolidOverlap overlap_of(const ClosedMesh& a, const ClosedMesh& b, const OverlapOptions& options) {
  if (a.triangles.empty() || b.triangles.empty()) return {};
  const Box box_a = box_of(a.vertices), box_b = box_of(b.vertices);
  for (int k = 0; k < 3; ++k)
    if (!(box_a.overlap(box_b, k) > options.depth)) return {};
  const std::vector<Point3> inner_a = shrunk(a, options.depth / 2), inner_b = shrunk(b, options.depth / 2);
  SolidOverlap out;
  out.volume = common_volume({inner_a, a.triangles}, {inner_b, b.triangles});
  out.overlap = out.volume > options.volume;
  return out;
}

}  // namespace blockrand::geometry
