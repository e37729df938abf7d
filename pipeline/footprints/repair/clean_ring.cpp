#include "pipeline/footprints/repair/clean_ring.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include "pipeline/base/random.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"

namespace blockrand::repair {

namespace {

using model::Point2;
using model::Ring;

// A curve's corners: each turns by more than the roundness that rounding to OSM's grid gives a wall (a quarter of a
// degree), and less than 50 degrees; together by 30 degrees. Sines, so that no angle need be computed.
constexpr double kLeastTurn = 0.0044, kMostTurn = 0.766, kLeastCurve = 0.5;
constexpr std::size_t kLeastCurvePoints = 3;
// m. Dropped points of a curve lie outside its chords by more than rounding to the grid explains.
constexpr double kLeastBulge = 0.002;

double distance2_to_segment(Point2 p, Point2 a, Point2 b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  const double t = length2 > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0) : 0;
  return squared_distance(p, {a.x + t * dx, a.y + t * dy});
}

/// Do the legs from-a and from-b, which leave a tip (a point, or a short edge from `a` to `b`) for p and q, run back
/// over each other?
bool turns_back(Point2 p, Point2 a, Point2 b, Point2 q, double width2) {
  const double ux = p.x - a.x, uy = p.y - a.y, vx = q.x - b.x, vy = q.y - b.y;
  if (ux * vx + uy * vy <= 0) return false;  // the ring goes on, it does not turn back
  return ux * ux + uy * uy <= vx * vx + vy * vy ? distance2_to_segment(p, b, q) <= width2
                                                : distance2_to_segment(q, a, p) <= width2;
}

bool is_spike(Point2 p, Point2 tip, Point2 q, double width2) { return turns_back(p, tip, tip, q, width2); }

bool is_blunt_spike(Point2 p, Point2 a, Point2 b, Point2 q, double width2) {
  return squared_distance(a, b) <= width2 && turns_back(p, a, b, q, width2);
}

/// The ring as a circular list: erasing costs the same everywhere.
class Circle {
 public:
  explicit Circle(std::size_t n) : next_(n), previous_(n), alive_(n, true), size_(n) {
    for (std::size_t i = 0; i < n; ++i) next_[i] = i + 1 == n ? 0 : i + 1, previous_[i] = i == 0 ? n - 1 : i - 1;
  }
  std::size_t next(std::size_t i) const { return next_[i]; }
  std::size_t previous(std::size_t i) const { return previous_[i]; }
  std::size_t size() const { return size_; }
  bool alive(std::size_t i) const { return alive_[i]; }
  void erase(std::size_t i) {
    next_[previous_[i]] = next_[i];
    previous_[next_[i]] = previous_[i];
    alive_[i] = false;
    --size_;
  }
  Ring taken_from(const Ring& ring) const {
    Ring out;
    out.points.reserve(size_);
    out.nodes.reserve(size_);
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (alive_[i]) out.points.push_back(ring.points[i]), out.nodes.push_back(ring.nodes[i]);
    return out;
  }

 private:
  std::vector<std::size_t> next_, previous_;
  std::vector<bool> alive_;
  std::size_t size_;
};

void turn_to_start(Ring& ring, std::size_t start) {
  const auto by = static_cast<std::ptrdiff_t>(start);
  std::rotate(ring.points.begin(), ring.points.begin() + by, ring.points.end());
  std::rotate(ring.nodes.begin(), ring.nodes.begin() + by, ring.nodes.end());
}

bool is_clean(const Ring& ring, double duplicate2, double spike2) {
  const std::size_t n = ring.size();
  Point2 before = ring.points[n - 1], at = ring.points[0];
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 after = ring.points[i + 1 == n ? 0 : i + 1];
    if (squared_distance(at, after) <= duplicate2 || is_spike(before, at, after, spike2)) return false;
    if (n >= 4 && squared_distance(at, after) <= spike2) {
      const Point2 last = ring.points[i + 2 >= n ? i + 2 - n : i + 2];
      if (is_blunt_spike(before, at, after, last, spike2)) return false;
    }
    before = at;
    at = after;
  }
  return true;
}

/// How often the ring repeats itself.
int rounds_of(const Ring& ring) {
  const std::size_t n = ring.size();
  for (std::size_t period = 3; 2 * period <= n; ++period) {
    if (n % period != 0 || ring.points[period] != ring.points[0]) continue;
    bool repeats = true;
    for (std::size_t i = 0; i + period < n && repeats; ++i) repeats = ring.points[i] == ring.points[i + period];
    if (repeats) return static_cast<int>(n / period);
  }
  return 1;
}

void remove_repeats(Ring& ring, const KeptNodes& kept, double duplicate2, RingCleaning& done) {
  Ring out;
  const auto merge = [&](Point2& point, std::int64_t& node, std::size_t i) {
    ++done.duplicates;
    if (kept.contains(node) || !kept.contains(ring.nodes[i])) return;
    point = ring.points[i];
    node = ring.nodes[i];
  };
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (!out.points.empty() && squared_distance(out.points.back(), ring.points[i]) <= duplicate2) {
      merge(out.points.back(), out.nodes.back(), i);
      continue;
    }
    out.points.push_back(ring.points[i]);
    out.nodes.push_back(ring.nodes[i]);
  }
  while (out.size() > 1 && squared_distance(out.points.front(), out.points.back()) <= duplicate2) {
    if (kept.contains(out.nodes.back()) && !kept.contains(out.nodes.front())) {
      out.points.front() = out.points.back();
      out.nodes.front() = out.nodes.back();
    }
    out.points.pop_back();
    out.nodes.pop_back();
    ++done.duplicates;
  }
  ring = std::move(out);
}

void remove_spikes(Ring& ring, const KeptNodes& kept, double duplicate2, double spike2, RingCleaning& done) {
  Circle circle(ring.size());
  const auto& p = ring.points;
  std::size_t calm = 0;
  for (std::size_t i = 0; circle.size() >= 3 && calm < circle.size();) {
    const std::size_t before = circle.previous(i), after = circle.next(i);
    if (squared_distance(p[i], p[after]) <= duplicate2) {
      // Removing a spike can bring its two ends together.
      circle.erase(kept.contains(ring.nodes[after]) && !kept.contains(ring.nodes[i]) ? i : after);
      ++done.duplicates;
    } else if (is_spike(p[before], p[i], p[after], spike2)) {
      circle.erase(i);
      ++done.spikes;
    } else if (circle.size() >= 4 && is_blunt_spike(p[before], p[i], p[after], p[circle.next(after)], spike2)) {
      circle.erase(after);
      circle.erase(i);
      ++done.spikes;
    } else {
      ++calm;
      i = after;
      continue;
    }
    // The neighbours have changed: look at the ring again from some corners earlier.
    calm = 0;
    i = circle.previous(before);
  }
  if (circle.size() < ring.size()) ring = circle.taken_from(ring);
}

// ---- straight walls -------------------------------------------------------------------------------------------------

/// For each point the way that the curve turns on which it lies: 1 left, -1 right, 0 on none.
std::vector<int> curve_turns(const Ring& ring) {
  const std::size_t n = ring.size();
  std::vector<double> turn(n);  // sine, 0 where the corner is no piece of a curve
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 a = ring.points[(i + n - 1) % n], b = ring.points[i], c = ring.points[(i + 1) % n];
    const double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - b.x, vy = c.y - b.y;
    const double dot = ux * vx + uy * vy;
    const double sine = (ux * vy - uy * vx) / std::sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy));
    turn[i] = dot > 0 && std::fabs(sine) >= kLeastTurn && std::fabs(sine) <= kMostTurn ? sine : 0;
  }
  const auto goes_on = [&](std::size_t i, std::size_t j) { return turn[i] * turn[j] > 0; };
  std::size_t start = 0;
  while (start < n && goes_on((start + n - 1) % n, start)) ++start;
  std::vector<int> curve(n, 0);
  if (start == n) {
    curve.assign(n, turn[0] > 0 ? 1 : -1);  // round as a whole
    return curve;
  }
  for (std::size_t first = 0; first < n;) {
    const auto at = [&](std::size_t k) { return (start + k) % n; };
    double sum = std::fabs(turn[at(first)]);
    std::size_t last = first + 1;
    for (; last < n && goes_on(at(last - 1), at(last)); ++last) sum += std::fabs(turn[at(last)]);
    if (last - first >= kLeastCurvePoints && sum >= kLeastCurve)
      for (std::size_t k = first; k < last; ++k) curve[at(k)] = turn[at(k)] > 0 ? 1 : -1;
    first = last;
  }
  return curve;
}

/// The points to keep, by index: those of `circle`, and those between them that bulge out with a curve.
std::vector<std::size_t> with_curve_points(const Ring& ring, const Circle& circle) {
  std::vector<std::size_t> kept;
  Ring simple;
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (circle.alive(i)) kept.push_back(i), simple.points.push_back(ring.points[i]);
  const std::vector<int> curve = curve_turns(simple);
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const std::size_t next = (k + 1) % kept.size();
    const Point2 a = ring.points[kept[k]], b = ring.points[kept[next]];
    const int way = curve[k] != 0 ? curve[k] : curve[next];
    const double length = std::sqrt(squared_distance(a, b));
    std::vector<std::size_t> between;
    bool bulges = way != 0;
    double most = 0;
    for (std::size_t i = (kept[k] + 1) % ring.size(); i != kept[next] && bulges; i = (i + 1) % ring.size()) {
      const Point2 p = ring.points[i];
      // Of a left turn the arc lies to the right of its chords.
      const double beside = way * ((b.y - a.y) * (p.x - a.x) - (b.x - a.x) * (p.y - a.y)) / length;
      bulges = beside > 0;
      most = std::max(most, beside);
      between.push_back(i);
    }
    out.push_back(kept[k]);
    if (bulges && most >= kLeastBulge) out.insert(out.end(), between.begin(), between.end());
  }
  return out;
}

struct Flat {
  double deviation2 = 0;      ///< m², of the worst point that would lie beside the edge
  std::uint64_t shuffle = 0;  ///< breaks ties: long straight runs must not be eaten from one end, which costs squares
  Point2 point;
  std::size_t index = 0;
  /// For a heap whose top is the flattest.
  bool operator<(const Flat& o) const {
    return std::tie(o.deviation2, o.shuffle, o.point) < std::tie(deviation2, shuffle, point);
  }
};

std::uint64_t shuffled(Point2 p) {
  const geometry::Grid2 g = geometry::to_grid(p);
  return base::mix64(static_cast<std::uint64_t>(g.x) ^ base::mix64(static_cast<std::uint64_t>(g.y)));
}

}  // namespace

RingCleaning clean_ring(Ring& ring, const KeptNodes& kept, const RepairOptions& options) {
  RingCleaning done;
  const double duplicate2 = options.duplicate_distance * options.duplicate_distance;
  const double spike2 = options.spike_width * options.spike_width;
  const std::size_t n = ring.size();
  if (n == 0) return done;
  if (!is_clean(ring, duplicate2, spike2)) {
    // Chains of near points and spikes that share a point are eaten from the same end, wherever the ring starts.
    start_at_least_point(ring);
    std::size_t longest = 0;
    for (std::size_t i = 1; i < n; ++i)
      if (squared_distance(ring.points[i], ring.points[(i + 1) % n]) >
          squared_distance(ring.points[longest], ring.points[(longest + 1) % n]))
        longest = i;
    turn_to_start(ring, (longest + 1) % n);
    remove_repeats(ring, kept, duplicate2, done);
    remove_spikes(ring, kept, duplicate2, spike2, done);
  }
  done.rounds = rounds_of(ring);
  if (done.rounds > 1) {
    const std::size_t once = ring.size() / static_cast<std::size_t>(done.rounds);
    ring.points.resize(once);
    ring.nodes.resize(once);
  }
  return done;
}

std::optional<Ring> without_collinear_points(const Ring& ring, const KeptNodes& kept, const RepairOptions& options) {
  const std::size_t n = ring.size();
  if (n <= 3) return std::nullopt;
  const double most2 = options.collinear_distance * options.collinear_distance;
  const auto& p = ring.points;
  bool any = false;
  for (std::size_t i = 0; i < n && !any; ++i)
    any = distance2_to_segment(p[i], p[i == 0 ? n - 1 : i - 1], p[i + 1 == n ? 0 : i + 1]) <= most2 &&
          !kept.contains(ring.nodes[i]);
  if (!any) return std::nullopt;

  Circle circle(n);
  constexpr double kNever = -1;
  std::vector<double> deviation2(n, kNever);
  std::priority_queue<Flat> flattest;
  const auto measure = [&](std::size_t i) {
    if (kept.contains(ring.nodes[i])) return;
    const std::size_t first = circle.previous(i), last = circle.next(i);
    double worst = 0;
    // All points that lie beside the new edge, those dropped before included.
    for (std::size_t k = first + 1 == n ? 0 : first + 1; k != last && worst <= most2; k = k + 1 == n ? 0 : k + 1)
      worst = std::max(worst, distance2_to_segment(p[k], p[first], p[last]));
    deviation2[i] = worst;
    if (worst <= most2) flattest.push({worst, shuffled(p[i]), p[i], i});
  };
  for (std::size_t i = 0; i < n; ++i) measure(i);
  while (!flattest.empty() && circle.size() > 3) {
    const Flat flat = flattest.top();
    flattest.pop();
    if (!circle.alive(flat.index) || deviation2[flat.index] != flat.deviation2) continue;
    const std::size_t first = circle.previous(flat.index), last = circle.next(flat.index);
    circle.erase(flat.index);
    measure(first);
    measure(last);
  }
  const std::vector<std::size_t> stay = with_curve_points(ring, circle);
  if (stay.size() == n) return std::nullopt;
  Ring out;
  for (const std::size_t i : stay) out.points.push_back(p[i]), out.nodes.push_back(ring.nodes[i]);
  return out;
}

void start_at_least_point(Ring& ring) {
  const std::size_t n = ring.size();
  if (n == 0) return;
  std::size_t least = 0;
  for (std::size_t i = 1; i < n; ++i) {
    if (ring.points[i] > ring.points[least]) continue;
    if (ring.points[i] < ring.points[least]) {
      least = i;
      continue;
    }
    for (std::size_t k = 1; k < n; ++k) {
      const Point2 a = ring.points[(i + k) % n], b = ring.points[(least + k) % n];
      if (a == b) continue;
      if (a < b) least = i;
      break;
    }
  }
  if (least != 0) turn_to_start(ring, least);
}

}  // namespace blockrand::repair
