// The weighted skeleton's arithmetic: lines that move inwards as planes over the plan, points where three of them meet,
// and exact answers to what lies where and what comes first, behind a filter of doubles. For weighted_skeleton.cpp
// alone.
#pragma once

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/geometry/grid.h"

namespace blockrand::geometry::moving_planes {

// Exact values. Directions have at most 24 bits, speeds 62, constants 85; the largest product, a comparison along a
// line, has about 320.
using Exact = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<
    512, 512, boost::multiprecision::signed_magnitude, boost::multiprecision::unchecked, void>>;

/// Speeds are whole multiples of 2^-30 grid steps per step of height, for an edge of one step; all else follows
/// exactly.
inline constexpr int kSpeedBits = 30;
inline constexpr double kSpeedUnit = std::int64_t{1} << kSpeedBits;
inline constexpr double kSteps = model::kGridStepsPerMetre;
/// Relative error of one rounded operation, with room for the few that a bound leaves out.
inline constexpr double kEpsilon = 1.2e-16;

inline Exact exact(Int128 v) {
  const bool negative = v < 0;
  const auto magnitude = negative ? -static_cast<unsigned __int128>(v) : static_cast<unsigned __int128>(v);
  Exact out = static_cast<std::uint64_t>(magnitude >> 64);
  out <<= 64;
  out += static_cast<std::uint64_t>(magnitude);
  return negative ? Exact(-out) : out;
}

/// Where a moving line is at each height z: a x + b y + c - w z = 0, positive inside. (a, b) is the edge turned left.
/// All in grid steps; c and w are kept as multiples of 1 / kSpeedUnit.
struct Plane {
  std::int64_t a = 0, b = 0;
  Int128 c = 0;
  std::int64_t w = 0;
  double fa = 0, fb = 0, fc = 0, fw = 0;  ///< the same rounded
  double sum = 0;                         ///< of the sizes of fa, fb and fw
  std::uint32_t face = 0;
  std::int32_t next = -1;   ///< the plane after the next change of slope
  std::int64_t change = 0;  ///< steps: the height of that change

  void round() {
    fa = static_cast<double>(a);
    fb = static_cast<double>(b);
    fc = static_cast<double>(c) / kSpeedUnit;
    fw = static_cast<double>(w) / kSpeedUnit;
    sum = std::fabs(fa) + std::fabs(fb) + std::fabs(fw);
  }
};

/// +1 when the edge of q turns left against that of p, -1 right, 0 parallel.
inline int turn(const Plane& p, const Plane& q) {
  return sign(static_cast<Int128>(p.a) * q.b - static_cast<Int128>(p.b) * q.a);
}
inline bool same_way(const Plane& p, const Plane& q) {
  return static_cast<Int128>(p.a) * q.a + static_cast<Int128>(p.b) * q.b > 0;
}

/// The common point of three planes, named by them: exact, with a rounded place beside.
struct Meet {
  std::int32_t p[3] = {-1, -1, -1};
  double x = 0, y = 0, z = 0;  ///< steps
  double error = 0;            ///< steps: bound for each of the three
};

struct ExactPoint {
  Exact x, y, z, d;  ///< x / d and y / d in steps / kSpeedUnit, z / d in steps
};

inline double det(const double (&u)[3], const double (&v)[3], const double (&w)[3]) {
  return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) + u[2] * (v[0] * w[1] - v[1] * w[0]);
}
inline double permanent(const double (&u)[3], const double (&v)[3], const double (&w)[3]) {
  const auto m = [](double t) { return std::fabs(t); };
  return m(u[0]) * (m(v[1] * w[2]) + m(v[2] * w[1])) + m(u[1]) * (m(v[0] * w[2]) + m(v[2] * w[0])) +
         m(u[2]) * (m(v[0] * w[1]) + m(v[1] * w[0]));
}

class Planes {
 public:
  std::vector<Plane> all;
  const Plane& operator[](std::int32_t i) const { return all[static_cast<std::size_t>(i)]; }

  ExactPoint exact_point(const Meet& m) const {
    const Plane &p = (*this)[m.p[0]], &q = (*this)[m.p[1]], &r = (*this)[m.p[2]];
    // Minors of directions fit 128 bits.
    const Exact pc = exact(p.c), qc = exact(q.c), rc = exact(r.c);
    const Exact pq = exact(static_cast<Int128>(p.a) * q.b - static_cast<Int128>(q.a) * p.b);
    const Exact qr = exact(static_cast<Int128>(q.a) * r.b - static_cast<Int128>(r.a) * q.b);
    const Exact rp = exact(static_cast<Int128>(r.a) * p.b - static_cast<Int128>(p.a) * r.b);
    ExactPoint out;
    out.d = qr * p.w + rp * q.w + pq * r.w;
    out.z = qr * pc + rp * qc + pq * rc;
    const Exact wpq = exact(0) + pc * q.w - qc * p.w, wqr = qc * r.w - rc * q.w, wrp = rc * p.w - pc * r.w;
    // x = -det(c, b, w) / d, y = -det(a, c, w) / d; minors of (c, w) expanded along b and a.
    out.x = wqr * p.b + wrp * q.b + wpq * r.b;
    out.y = -(wqr * p.a + wrp * q.a + wpq * r.a);
    if (out.d < 0) {
      out.d = -out.d;
      out.x = -out.x;
      out.y = -out.y;
      out.z = -out.z;
    }
    return out;
  }

  /// None when the planes have no single common point.
  std::optional<Meet> meet(std::int32_t i, std::int32_t j, std::int32_t k) const {
    const Plane &p = (*this)[i], &q = (*this)[j], &r = (*this)[k];
    const double a[3] = {p.fa, q.fa, r.fa}, b[3] = {p.fb, q.fb, r.fb}, c[3] = {p.fc, q.fc, r.fc},
                 w[3] = {p.fw, q.fw, r.fw};
    Meet m;
    m.p[0] = i, m.p[1] = j, m.p[2] = k;
    const double d = det(a, b, w), d_error = 12 * kEpsilon * permanent(a, b, w);
    if (std::fabs(d) > 4 * d_error) {
      const double least = std::fabs(d) - d_error;
      m.x = -det(c, b, w) / d;
      m.y = -det(a, c, w) / d;
      m.z = det(a, b, c) / d;
      const double size = std::max({std::fabs(m.x), std::fabs(m.y), std::fabs(m.z)});
      const double e = 12 * kEpsilon * std::max({permanent(c, b, w), permanent(a, c, w), permanent(a, b, c)});
      m.error = (e + size * d_error) / least + 2 * kEpsilon * size;
      constexpr double kGoodEnough = 1e-5;  // steps, 10 nm
      if (m.error < kGoodEnough) return m;
    }
    const ExactPoint point = exact_point(m);
    if (point.d == 0) return std::nullopt;
    const double divisor = point.d.convert_to<double>();
    m.x = point.x.convert_to<double>() / divisor / kSpeedUnit;
    m.y = point.y.convert_to<double>() / divisor / kSpeedUnit;
    m.z = point.z.convert_to<double>() / divisor;
    // Conversions add up limb by limb: a few roundings for each of numerator and divisor.
    m.error = 10 * kEpsilon * std::max({std::fabs(m.x), std::fabs(m.y), std::fabs(m.z)});
    return m;
  }

  /// Sign of the difference of heights.
  int compare_height(const Meet& s, const Meet& t) const {
    if (s.z - t.z > s.error + t.error) return 1;
    if (t.z - s.z > s.error + t.error) return -1;
    if (s.p[0] == t.p[0] && s.p[1] == t.p[1] && s.p[2] == t.p[2]) return 0;
    const ExactPoint u = exact_point(s), v = exact_point(t);
    const Exact left = u.z * v.d, right = v.z * u.d;
    return left < right ? -1 : right < left ? 1 : 0;
  }

  /// On which side of plane k the point lies: +1 where k has not been yet at that height.
  int side(std::int32_t k, const Meet& m) const {
    if (k == m.p[0] || k == m.p[1] || k == m.p[2]) return 0;
    const Plane& p = (*this)[k];
    const double tx = p.fa * m.x, ty = p.fb * m.y, tz = p.fw * m.z;
    const double value = tx + ty + p.fc - tz;
    const double bound = (std::fabs(p.fa) + std::fabs(p.fb) + std::fabs(p.fw)) * m.error +
                         8 * kEpsilon * (std::fabs(tx) + std::fabs(ty) + std::fabs(p.fc) + std::fabs(tz));
    if (value > bound) return 1;
    if (value < -bound) return -1;
    const ExactPoint u = exact_point(m);
    const Exact f = u.x * p.a + u.y * p.b + u.d * exact(p.c) - u.z * p.w;
    return f < 0 ? -1 : f == 0 ? 0 : 1;
  }

  /// True only where side() is not 0: its filter with a wider bound, which costs less where many planes are asked.
  bool surely_beside(std::int32_t k, const Meet& m) const {
    const Plane& p = (*this)[k];
    const double size = std::max({std::fabs(m.x), std::fabs(m.y), std::fabs(m.z)});
    const double bound = p.sum * (m.error + 16 * kEpsilon * size) + 16 * kEpsilon * std::fabs(p.fc);
    return std::fabs(p.fa * m.x + p.fb * m.y + p.fc - p.fw * m.z) > bound;
  }

  /// Sign of the way from s to t along the direction of plane k's edge.
  int along(std::int32_t k, const Meet& s, const Meet& t) const {
    const Plane& p = (*this)[k];
    const double value = p.fb * (t.x - s.x) - p.fa * (t.y - s.y);
    const double bound =
        (std::fabs(p.fa) + std::fabs(p.fb)) *
        (s.error + t.error + 4 * kEpsilon * (std::fabs(s.x) + std::fabs(s.y) + std::fabs(t.x) + std::fabs(t.y)));
    if (value > bound) return 1;
    if (value < -bound) return -1;
    const ExactPoint u = exact_point(s), v = exact_point(t);
    const Exact f = (v.x * u.d - u.x * v.d) * p.b - (v.y * u.d - u.y * v.d) * p.a;
    return f < 0 ? -1 : f == 0 ? 0 : 1;
  }

  /// Does p's edge move faster than q's, which has its direction? Ties: 0.
  int compare_speed(const Plane& p, const Plane& q) const {
    const auto squared = [](std::int64_t v) { return exact(static_cast<Int128>(v)) * v; };
    const Exact left = squared(p.w) * (squared(q.a) + squared(q.b)),
                right = squared(q.w) * (squared(p.a) + squared(p.b));
    return left < right ? -1 : right < left ? 1 : 0;
  }
};

}  // namespace blockrand::geometry::moving_planes
