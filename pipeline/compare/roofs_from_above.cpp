#include "pipeline/compare/roofs_from_above.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"

namespace blockrand::compare {

namespace {

using model::Point2;
using model::Point3;
using model::Polygon;

constexpr double kDegrees = 180 / std::numbers::pi;

/// Crossings to the left of p, odd inside.
bool odd_crossings(const std::vector<std::vector<Point2>>& rings, Point2 p) {
  bool inside = false;
  for (const auto& ring : rings)
    for (std::size_t i = 0, k = ring.size() - 1; i < ring.size(); k = i++) {
      const Point2 a = ring[i], b = ring[k];
      if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
    }
  return inside;
}

double outline_distance(const std::vector<Polygon>& plan, Point2 p) {
  double nearest = 1e9;
  const auto ring = [&](const model::Ring& r) {
    for (std::size_t i = 0; i < r.size(); ++i)
      nearest = std::min(nearest, geometry::distance_to_segment(p, r.points[i], r.points[(i + 1) % r.size()]));
  };
  for (const Polygon& polygon : plan) {
    ring(polygon.outer);
    for (const model::Ring& hole : polygon.holes) ring(hole);
  }
  return nearest;
}

bool within(const std::vector<Polygon>& plan, Point2 p) {
  return std::any_of(plan.begin(), plan.end(), [&](const Polygon& polygon) { return geometry::contains(polygon, p); });
}

std::vector<Point2> grid(const std::vector<Polygon>& a, const std::vector<Polygon>& b, double margin) {
  // From both plans alike, and from their own corner: neither which is which nor where the origin lies matters.
  Point2 low{1e12, 1e12}, high{-1e12, -1e12};
  double largest = 0;
  for (const std::vector<Polygon>* plan : {&a, &b}) {
    double area = 0;
    for (const Polygon& polygon : *plan) {
      area += geometry::area(polygon);
      for (const Point2 p : polygon.outer.points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
    }
    largest = std::max(largest, area);
  }
  const double step = std::max(0.5, std::sqrt(largest / 4000));
  std::vector<Point2> out;
  for (double y = low.y + step / 2; y <= high.y; y += step)
    for (double x = low.x + step / 2; x <= high.x; x += step) {
      const Point2 p{x, y};
      if (!within(a, p) || !within(b, p)) continue;
      if (margin > 0 && (outline_distance(a, p) < margin || outline_distance(b, p) < margin)) continue;
      out.push_back(p);
    }
  return out;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

}  // namespace

void RoofSurfaces::add(const std::vector<std::vector<Point3>>& rings) {
  if (rings.empty() || rings[0].size() < 3) return;
  // Newell's normal, relative to the centre: surveyed polygons are plane to centimetres only.
  Point3 n, c;
  for (const Point3& p : rings[0]) c = {c.x + p.x, c.y + p.y, c.z + p.z};
  const double count = static_cast<double>(rings[0].size());
  c = {c.x / count, c.y / count, c.z / count};
  for (std::size_t i = 0; i < rings[0].size(); ++i) {
    const Point3 &p = rings[0][i], &q = rings[0][(i + 1) % rings[0].size()];
    n.x += (p.y - c.y) * (q.z - c.z) - (p.z - c.z) * (q.y - c.y);
    n.y += (p.z - c.z) * (q.x - c.x) - (p.x - c.x) * (q.z - c.z);
    n.z += (p.x - c.x) * (q.y - c.y) - (p.y - c.y) * (q.x - c.x);
  }
  const double flat = std::sqrt(n.x * n.x + n.y * n.y);
  if (std::fabs(n.z) < 1e-6 || flat > kSteepest * std::fabs(n.z)) return;
  Face face;
  face.centre = c;
  face.uphill = {-n.x / n.z, -n.y / n.z};
  face.minimum = {1e12, 1e12};
  face.maximum = {-1e12, -1e12};
  for (const auto& ring : rings) {
    auto& plan = face.rings.emplace_back();
    for (const Point3& p : ring) {
      plan.push_back({p.x, p.y});
      face.minimum = {std::min(face.minimum.x, p.x), std::min(face.minimum.y, p.y)};
      face.maximum = {std::max(face.maximum.x, p.x), std::max(face.maximum.y, p.y)};
      highest_ = std::max(highest_, p.z);
    }
  }
  faces_.push_back(std::move(face));
}

std::optional<RoofSurfaces::Hit> RoofSurfaces::at(Point2 p) const {
  std::optional<Hit> best;
  for (const Face& f : faces_) {
    if (p.x < f.minimum.x || p.y < f.minimum.y || p.x > f.maximum.x || p.y > f.maximum.y) continue;
    const double z = f.centre.z + f.uphill.x * (p.x - f.centre.x) + f.uphill.y * (p.y - f.centre.y);
    if ((best && z <= best->z) || !odd_crossings(f.rings, p)) continue;
    best = Hit{z, f.uphill};
  }
  return best;
}

std::optional<RoofHeights> heights_of(const RoofSurfaces& roof, const std::vector<Polygon>& outline, double ground) {
  constexpr double kStep = 0.5, kInside = 0.3;  // m
  std::vector<double> eaves, all;
  std::size_t steps = 0;
  const auto walk = [&](const model::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring.points[i], b = ring.points[(i + 1) % ring.size()];
      const double l = distance(b, a);
      const Point2 in{-(b.y - a.y) / l, (b.x - a.x) / l};  // outer rings run counter-clockwise, holes clockwise
      for (double s = kStep / 2; s < l; s += kStep) {
        ++steps;
        const Point2 p{a.x + (b.x - a.x) * s / l, a.y + (b.y - a.y) * s / l};
        const auto hit = roof.at({p.x + kInside * in.x, p.y + kInside * in.y});
        if (!hit) continue;
        const double inwards = hit->uphill.x * in.x + hit->uphill.y * in.y, slope = length(hit->uphill);
        const double z = hit->z - kInside * inwards;
        all.push_back(z);
        if (slope < kFlatSlope || inwards >= std::numbers::sqrt2 / 2 * slope) eaves.push_back(z);
      }
    }
  };
  for (const Polygon& polygon : outline) {
    walk(polygon.outer);
    for (const model::Ring& hole : polygon.holes) walk(hole);
  }
  if (all.size() * 2 < steps || all.empty()) return std::nullopt;
  RoofHeights out;
  out.ridge = roof.highest() - ground;
  out.eaves = (eaves.empty() ? *std::min_element(all.begin(), all.end()) : median(std::move(eaves))) - ground;
  const auto points = grid(outline, outline, 0);
  std::size_t n = 0;
  for (const Point2 p : points)
    if (const auto hit = roof.at(p)) out.mean += hit->z - ground, ++n;
  if (n * 2 < points.size() || n == 0) return std::nullopt;
  out.mean /= static_cast<double>(n);
  out.cover = static_cast<double>(n) / static_cast<double>(points.size());
  return out;
}

std::vector<Point2> common_grid(const std::vector<Polygon>& a, const std::vector<Polygon>& b) {
  return grid(a, b, 0.5);
}

RoofPlanes form_of(const RoofSurfaces& roof, std::span<const Point2> points) {
  RoofPlanes out;
  std::array<std::vector<std::pair<double, double>>, 36> bins;  // azimuth, pitch
  double sum = 0, squares = 0, n = 0, sloped = 0;
  for (const Point2 p : points) {
    const auto hit = roof.at(p);
    if (!hit) continue;
    ++n;
    const double z = hit->z;
    sum += z;
    squares += z * z;
    const double slope = length(hit->uphill);
    if (slope < kFlatSlope) continue;
    ++sloped;
    double azimuth = base::atan2(-hit->uphill.x, -hit->uphill.y) * kDegrees;
    if (azimuth < 0) azimuth += 360;
    const double pitch = base::atan(slope) * kDegrees;
    out.pitch += pitch;
    bins[static_cast<std::size_t>(azimuth / 10) % 36].emplace_back(azimuth, pitch);
  }
  if (n == 0) return out;
  out.seen = n / static_cast<double>(points.size());
  out.sloped = sloped / n;
  out.spread = std::sqrt(std::max(0.0, squares / n - sum / n * (sum / n)));
  if (sloped > 0) out.pitch /= sloped;
  int with_two = 0;
  for (;;) {
    std::size_t best = 0, most = 0;
    for (std::size_t i = 0; i < 36; ++i) {
      const std::size_t here = bins[i].size() + bins[(i + 1) % 36].size() + bins[(i + 35) % 36].size();
      if (here > most) most = here, best = i;
    }
    if (static_cast<double>(most) < 0.08 * n || most == 0) break;
    double x = 0, y = 0;
    std::vector<double> pitches;
    for (const std::size_t i : {best, (best + 1) % 36, (best + 35) % 36}) {
      for (const auto& [azimuth, pitch] : bins[i]) {
        x += base::sin(azimuth / kDegrees);
        y += base::cos(azimuth / kDegrees);
        pitches.push_back(pitch);
      }
      bins[i].clear();
    }
    const double azimuth = base::atan2(x, y) * kDegrees;
    out.directions.push_back(azimuth < 0 ? azimuth + 360 : azimuth);
    std::sort(pitches.begin(), pitches.end());
    const std::size_t k = pitches.size();
    if (pitches[k - 1 - k / 7] - pitches[k / 7] > 15) ++with_two;
  }
  out.two_pitches = with_two >= 2;
  return out;
}

}  // namespace blockrand::compare
