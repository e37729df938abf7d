#include "styles/roofs/dormer_bodies.h"

#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"

namespace blockrand::roofs {

using model::Point2;
using model::Point3;

namespace {

/// Share of a ridge's way back that its hip may take. On steep slopes the way is short: the hip becomes steeper than
/// the sides.
constexpr double kMostHip = 0.6;

double tangent(double degrees) { return base::tan(degrees * base::kRadiansPerDegree); }

/// The head from right to left, front ends of the lines that run back.
std::vector<Point3> head_of(const DormerBodyMeasures& m) {
  const double half = m.width / 2, wall = m.wall_height;
  switch (m.kind) {
    case DormerKind::gabled:
      return {{half, 0, wall}, {0, 0, wall + half * tangent(m.roof_pitch)}, {-half, 0, wall}};
    case DormerKind::segmental: {
      // A circle through both ends and the crown; chords of equal angle.
      const double radius = (half * half + m.rise * m.rise) / (2 * m.rise);
      const double reach = m.rise >= half ? base::kPi / 2 : base::asin(half / radius);
      std::vector<Point3> out;
      for (int i = 0; i <= m.chords; ++i) {
        const auto [sin, cos] = base::sin_cos(reach * (1 - 2.0 * i / m.chords));
        out.push_back({radius * sin, 0, wall + m.rise - radius * (1 - cos)});
      }
      out.front() = {half, 0, wall};
      out.back() = {-half, 0, wall};
      return out;
    }
    case DormerKind::eyebrow: {
      // One wave of a cosine: level at both ends and in the middle.
      std::vector<Point3> out;
      for (int i = 0; i <= m.chords; ++i) {
        const double share = static_cast<double>(i) / m.chords;
        out.push_back({half - m.width * share, 0, wall * (1 - base::cos(2 * base::kPi * share)) / 2});
      }
      out.front().z = out.back().z = 0;
      return out;
    }
    case DormerKind::hipped:
    case DormerKind::shed:
    case DormerKind::flat:
      break;
  }
  return {{half, 0, wall}, {-half, 0, wall}};
}

}  // namespace

std::optional<DormerBody> dormer_body(const DormerBodyMeasures& m, double rise) {
  const bool pitched = m.kind == DormerKind::gabled || m.kind == DormerKind::hipped;
  const bool runs_up = m.kind == DormerKind::shed || m.kind == DormerKind::eyebrow;
  const bool arc = m.kind == DormerKind::segmental || m.kind == DormerKind::eyebrow;
  const double half = m.width / 2, wall = m.wall_height;
  if (!(m.width >= 2 * kLeastPart) || !(wall >= 0) || !(rise > 0)) return std::nullopt;
  if (pitched && !(m.roof_pitch > 0 && m.roof_pitch <= kSteepestDormerRoof)) return std::nullopt;
  if (runs_up && !(m.roof_pitch >= 0 && tangent(m.roof_pitch + kLeastFall) <= rise)) return std::nullopt;
  if (arc && (m.chords < 2 || m.chords > kMostChords)) return std::nullopt;
  if (m.kind == DormerKind::segmental && !(m.rise >= kLeastPart && m.rise <= half)) return std::nullopt;
  if (m.kind == DormerKind::eyebrow && (m.chords < 4 || wall < 2 * kLeastPart)) return std::nullopt;
  // Cheeks are there as a whole or not at all; a shed or flat roof without them is none.
  if (m.kind != DormerKind::eyebrow && wall < kLeastPart && (wall > 0 || !pitched)) return std::nullopt;

  const double back = runs_up ? tangent(m.roof_pitch) : 0;  // rise of the lines that run back
  DormerBody out;
  out.head = head_of(m);
  const auto swallowed = [&](const Point3& front) {
    const double y = front.z / (rise - back);
    return Point3{front.x, y, y * rise};
  };
  const Point3 right{half, 0, 0}, left{-half, 0, 0};
  std::vector<Point3> ends;  // of the lines, at the slope, right to left
  for (const Point3& p : out.head) ends.push_back(swallowed(p));
  if (wall > 0 && m.kind != DormerKind::eyebrow) {
    out.faces.push_back({{right, ends.front(), out.head.front()}, true});
    out.faces.push_back({{left, out.head.back(), ends.back()}, true});
  }
  const auto add = [&](std::vector<Point3> loop) {
    std::vector<Point3> clean;  // a line of no length starts where the slope swallows it
    for (const Point3& p : loop)
      if (clean.empty() || clean.back() != p) clean.push_back(p);
    if (clean.back() == clean.front()) clean.pop_back();
    out.faces.push_back({std::move(clean), false});
  };
  if (m.kind == DormerKind::hipped) {
    const double top = wall + half * tangent(m.roof_pitch);
    const Point3 ridge = swallowed({0, 0, top}), peak{0, std::min(half, kMostHip * ridge.y), top};
    if (peak.y < kLeastPart || ridge.y < peak.y + kLeastPart) return std::nullopt;
    add({out.head.front(), peak, out.head.back()});
    add({out.head.front(), ends.front(), ridge, peak});
    add({out.head.back(), peak, ridge, ends.back()});
    ends.insert(ends.begin() + 1, ridge);
    out.highest = top;
  } else {
    for (std::size_t i = 0; i + 1 < out.head.size(); ++i) add({out.head[i], ends[i], ends[i + 1], out.head[i + 1]});
    for (const Point3& p : ends) out.highest = std::max(out.highest, p.z);
  }
  out.outline.push_back(left);
  for (auto p = ends.rbegin(); p != ends.rend(); ++p)
    if (*p != out.outline.back()) out.outline.push_back(*p);
  if (out.outline.back() != right) out.outline.push_back(right);
  return out;
}

std::vector<Point2> outline_in_plane(const DormerBody& shape, const RoofSlope& plane) {
  std::vector<Point2> out;
  for (auto p = shape.outline.rbegin(); p != shape.outline.rend(); ++p)
    out.push_back({p->x, p->y * plane.slope_length});
  // Its outline runs clockwise from left to right; turned round, it starts at the right end and goes over the back.
  return out;
}

std::vector<Point2> hull(std::vector<Point2> points) {
  std::sort(points.begin(), points.end());
  std::vector<Point2> out;
  for (int side = 0; side < 2; ++side) {
    const std::size_t base = out.size();
    for (const Point2 p : points) {
      while (out.size() >= base + 2) {
        const Point2 a = out[out.size() - 2], b = out.back();
        if ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 0) break;
        out.pop_back();
      }
      out.push_back(p);
    }
    out.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return out;
}

}  // namespace blockrand::roofs
