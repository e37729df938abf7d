#include "pipeline/footprints/repair/arcs.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pipeline/model/vector.h"

namespace blockrand::repair {

namespace {

using model::Point2;

constexpr double kLeastTurn = 0.069926811943510;    // tan 4 degrees. Below, facades of several walls bend by accident
constexpr double kLargestTurn = 0.839099631177280;  // tan 40 degrees. Octagons turn by 45
constexpr double kTurnRatio = 4;                    // largest to smallest turn (of its tangent)
constexpr double kChordRatio = 3;                   // longest to shortest chord
constexpr double kEndChordRatio = 6;                // the same for the chords at the ends
constexpr std::size_t kLeastEdges = 4;              // three turns: fewer are chamfers and bays
constexpr double kLeastRadius = 0.5, kLargestRadius = 60;  // m
constexpr double kHeightShare = 1.0 / 8;                   // of the curve's height that a corner may lie off the circle
constexpr double kLeastOff = 0.02, kLargestOff = 0.15;     // m. Bounds of that: OSM's grid; what mappers see

struct Circle {
  Point2 centre;
  double radius = 0;
};

/// Algebraic fit (Kasa 1976): least squares of |p - c|^2 - r^2, linear in c and r^2 - |c|^2.
std::optional<Circle> fit_circle(std::span<const Point2> points) {
  Point2 mean;
  for (const Point2 p : points) mean.x += p.x, mean.y += p.y;
  const double n = static_cast<double>(points.size());
  mean.x /= n, mean.y /= n;
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, z = 0;
  for (const Point2 p : points) {
    const double x = p.x - mean.x, y = p.y - mean.y, s = x * x + y * y;
    xx += x * x, xy += x * y, yy += y * y, xz += x * s, yz += y * s, z += s;
  }
  const double det = xx * yy - xy * xy;
  if (det <= 1e-12 * (xx + yy) * (xx + yy)) return std::nullopt;
  const double cx = (xz * yy - yz * xy) / (2 * det), cy = (yz * xx - xz * xy) / (2 * det);
  return Circle{{mean.x + cx, mean.y + cy}, std::sqrt(cx * cx + cy * cy + z / n)};
}

/// A stretch of edges that starts at edge `first`: its turns and chords are known to suit.
struct Fit {
  Circle circle;
  double off = 0;  // m, largest distance of a corner from the circle
};

class Ring {
 public:
  explicit Ring(std::span<const Point2> points) : points_(points), n_(points.size()) {
    turn_.resize(n_);
    chord_.resize(n_);
    for (std::size_t i = 0; i < n_; ++i) chord_[i] = distance(points[i], points[(i + 1) % n_]);
    for (std::size_t i = 0; i < n_; ++i) {
      const Point2 a = points[(i + n_ - 1) % n_], b = points[i], c = points[(i + 1) % n_];
      const double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - b.x, vy = c.y - b.y;
      const double dot = ux * vx + uy * vy, cross = ux * vy - uy * vx;
      const double tangent = dot > 0 ? cross / dot : 0;
      turn_[i] = std::fabs(tangent) >= kLeastTurn && std::fabs(tangent) <= kLargestTurn ? tangent : 0;
    }
  }

  std::vector<ArcRun> runs() {
    std::vector<ArcRun> out;
    // Stretches of corners that turn the same way, with the edges before and after them. Without a corner that does
    // not, the whole ring is one stretch, which starts at its longest chord (of equal ones, the one that lies lowest).
    std::size_t start = n_;
    for (std::size_t i = 0; i < n_ && start == n_; ++i)
      if (begins(i)) start = i;
    if (start == n_) {
      if (auto fit = fit_of(0, n_, true)) {
        out.push_back(run_of(0, n_, *fit));
        return out;
      }
      start = 0;
      for (std::size_t i = 1; i < n_; ++i)
        if (chord_[i] > chord_[start] || (chord_[i] == chord_[start] && points_[i] < points_[start])) start = i;
      collect(start, n_, out);
    } else {
      for (std::size_t i = 0; i < n_;) {
        std::size_t j = i + 1;
        while (j < n_ && !begins((start + j) % n_)) ++j;
        if (turn_[(start + i) % n_] != 0) {
          // The edge between a turn to the left and one to the right goes with the curve before it.
          const bool shared = turn_[(start + i + n_ - 1) % n_] != 0;
          collect(start + i + n_ - (shared ? 0 : 1), j - i + (shared ? 0 : 1), out);
        }
        i = j;
      }
    }
    for (ArcRun& run : out) run.first = static_cast<std::uint32_t>(run.first % n_);
    std::sort(out.begin(), out.end(), [](const ArcRun& a, const ArcRun& b) { return a.first < b.first; });
    return out;
  }

  bool promising() const {
    std::size_t turns = 0;
    for (const double t : turn_) turns += t != 0;
    return turns >= kLeastEdges - 1;
  }

 private:
  /// True when the corner turns otherwise than the one before.
  bool begins(std::size_t i) const {
    const double t = turn_[i], before = turn_[(i + n_ - 1) % n_];
    return (t > 0) != (before > 0) || (t < 0) != (before < 0);
  }

  Point2 at(std::size_t i) const { return points_[i % n_]; }

  /// The circle of edges first .. first + count - 1, if they are a curve.
  std::optional<Fit> fit_of(std::size_t first, std::size_t count, bool whole) const {
    if (count < kLeastEdges) return std::nullopt;
    double shortest = 1e300, longest = 0, least = 1e300, largest = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const double c = chord_[(first + k) % n_];
      longest = std::max(longest, c);
      if (whole || (k > 0 && k + 1 < count)) shortest = std::min(shortest, c);
    }
    const double ends = std::min(chord_[first % n_], chord_[(first + count - 1) % n_]);
    if (longest > kChordRatio * shortest || longest > kEndChordRatio * ends) return std::nullopt;
    for (std::size_t k = whole ? 0 : 1; k < count; ++k) {
      const double t = turn_[(first + k) % n_];
      if (t == 0 || (t > 0) != (turn_[(first + 1) % n_] > 0)) return std::nullopt;
      least = std::min(least, std::fabs(t)), largest = std::max(largest, std::fabs(t));
    }
    if (largest > kTurnRatio * least) return std::nullopt;
    scratch_.clear();
    for (std::size_t k = 0; k < count + (whole ? 0 : 1); ++k) scratch_.push_back(at(first + k));
    const auto circle = fit_circle(scratch_);
    if (!circle || circle->radius < kLeastRadius || circle->radius > kLargestRadius) return std::nullopt;
    double height = 2 * circle->radius, off = 0;
    if (!whole) {
      const Point2 a = scratch_.front(), b = scratch_.back();
      const double length = distance(a, b);
      height = 0;
      for (const Point2 p : scratch_) {
        const double cross = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
        // Curves beyond three quarters of a circle have their ends close together: any measure of height will do.
        height = std::max(height, length > circle->radius ? std::fabs(cross) / length : distance(a, p));
      }
    }
    const double allowed = std::clamp(kHeightShare * height, kLeastOff, kLargestOff);
    for (const Point2 p : scratch_) off = std::max(off, std::fabs(distance(p, circle->centre) - circle->radius));
    if (off > allowed) return std::nullopt;
    return Fit{*circle, off};
  }

  ArcRun run_of(std::size_t first, std::size_t count, const Fit& fit) const {
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count), fit.circle.centre, fit.circle.radius,
            turn_[(first + 1) % n_] > 0};
  }

  /// Curves among edges first .. first + count - 1, longest first; whose inner corners all turn alike.
  void collect(std::size_t first, std::size_t count, std::vector<ArcRun>& out) const {
    // Long chains are looked at in windows: the cost stays bounded, and no curve of a building has more chords.
    constexpr std::size_t kLongest = 128;
    for (std::size_t length = std::min(count, kLongest); length >= kLeastEdges; --length) {
      std::optional<Fit> best;
      std::size_t best_first = 0;
      for (std::size_t s = first; s + length <= first + count; ++s) {
        const auto fit = fit_of(s, length, false);
        if (fit && (!best || fit->off < best->off)) best = fit, best_first = s;
      }
      if (!best) continue;
      out.push_back(run_of(best_first, length, *best));
      collect(first, best_first - first, out);
      collect(best_first + length, first + count - best_first - length, out);
      return;
    }
  }

  std::span<const Point2> points_;
  std::size_t n_;
  std::vector<double> turn_;   // tangent of the turn at corner i, left positive; 0 where it suits no curve
  std::vector<double> chord_;  // m, edge i
  mutable std::vector<Point2> scratch_;
};

}  // namespace

std::vector<ArcRun> find_arc_runs(std::span<const Point2> ring) {
  if (ring.size() < kLeastEdges + 1) return {};
  Ring chords(ring);
  return chords.promising() ? chords.runs() : std::vector<ArcRun>{};
}

std::vector<model::Arc> find_arcs(const std::vector<model::Polygon>& polygons) {
  std::vector<model::Arc> out;
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    for (std::size_t r = 0; r <= polygons[p].holes.size(); ++r) {
      const model::Ring& ring = r == 0 ? polygons[p].outer : polygons[p].holes[r - 1];
      for (const ArcRun& run : find_arc_runs(ring.points))
        out.push_back({.polygon = static_cast<std::uint32_t>(p),
                       .ring = static_cast<std::uint32_t>(r),
                       .first = run.first,
                       .count = run.count,
                       .centre = run.centre,
                       .radius = run.radius,
                       .convex = run.left});
    }
  }
  return out;
}

}  // namespace blockrand::repair
