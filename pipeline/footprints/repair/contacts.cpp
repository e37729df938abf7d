#include "pipeline/footprints/repair/contacts.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "pipeline/geometry/segment_grid.h"

namespace blockrand::repair {

namespace {

using model::Point2;

/// m. Cells of the index of edges: about half an edge long.
constexpr double kCell = 8;
/// m. Walls that face each other across less than this are an alley whose corners stay apart.
constexpr double kWidestAlley = 1.6;
/// m. An alley as wide as this must stay open, whatever the noise of mapping.
constexpr double kNarrowestAlley = 0.8;
/// Standard deviations by which a wall's mean gap must stay below an alley's: one in 3,000 alleys of 0.8 m is taken for a
/// wall at the most.
constexpr double kAlleySigmas = 3.4;
/// m. The noise that alleys are kept open against: copies of a corner moved in discs of 0.3 m. What looks sloppier than
/// that is displaced, and a wider margin would leave its walls apart.
constexpr double kMostNoise = 0.212;
/// Sine of the largest angle between two edges that are one wall: 30 degrees, which noise of 0.3 m does to a wall of 1 m.
constexpr double kMostTurn = 0.5;
/// Standard deviations that noise turns a wall by at the most: two ends with a bounded error each.
constexpr double kTurnSigmas = 3.5;
/// Noise where nothing is known, m, per coordinate of the difference of two copies; and how many ends it weighs.
constexpr double kPriorNoise = 0.10;
constexpr double kTerracePriorWeight = 1, kBuildingPriorWeight = 2;

/// A pair of edges, before the noise of the row is known.
struct Candidate {
  Contact contact;
  double mean = 0;                ///< m, gap in the middle of what is common
  double mean_weight = 0;         ///< variance of `mean` for noise of variance 1 in each difference
  double cost = 0;                ///< m: sum of the gaps at both ends
  double from_e = 0, from_f = 0;  ///< m along each edge from its first vertex, where what is common begins
};

struct Unit {
  double x, y, length;
};

Unit unit(Point2 a, Point2 b) {
  const double x = b.x - a.x, y = b.y - a.y, length = std::sqrt(x * x + y * y);
  return {x / length, y / length, length};
}

class Search {
 public:
  Search(const TerraceVertices& vertices, const TerraceRow& row, const RepairOptions& options)
      : vertices_(vertices), row_(row), options_(options) {
    units_.reserve(vertices.size());
    for (std::uint32_t e = 0; e < vertices.size(); ++e)
      units_.push_back(unit(vertices.point[e], vertices.point[vertices.next(e)]));
  }

  Contacts run() {
    collect();
    estimate_noise();
    accept();
    std::sort(out_.apart.begin(), out_.apart.end());
    out_.apart.erase(std::unique(out_.apart.begin(), out_.apart.end()), out_.apart.end());
    return std::move(out_);
  }

 private:
  void collect() {
    std::vector<geometry::Segment> segments;
    segments.reserve(vertices_.size());
    for (std::uint32_t e = 0; e < vertices_.size(); ++e)
      segments.push_back({vertices_.point[e], vertices_.point[vertices_.next(e)]});
    const geometry::SegmentGrid grid(segments, kCell);
    std::vector<std::uint32_t> near;
    for (std::uint32_t e = 0; e < vertices_.size(); ++e) {
      const Point2 a = segments[e].a, b = segments[e].b;
      grid.near({std::min(a.x, b.x) - kWidestAlley, std::min(a.y, b.y) - kWidestAlley},
                {std::max(a.x, b.x) + kWidestAlley, std::max(a.y, b.y) + kWidestAlley}, near);
      for (const std::uint32_t f : near) {
        if (f <= e) continue;
        const std::uint32_t m = vertices_.building(e), n = vertices_.building(f);
        if (m != n && same_level(row_.buildings[m].level, row_.buildings[n].level)) look_at(e, f);
      }
    }
  }

  void look_at(std::uint32_t e, std::uint32_t f) {
    const Unit &u = units_[e], &v = units_[f];
    if (std::fabs(u.x * v.y - u.y * v.x) > kMostTurn) return;
    const bool opposed = u.x * v.x + u.y * v.y < 0;
    const double s = opposed ? -1 : 1;
    const Unit axis = unit({0, 0}, {u.x + s * v.x, u.y + s * v.y});
    const Point2 e0 = vertices_.point[e], e1 = vertices_.point[vertices_.next(e)];
    Point2 f0 = vertices_.point[f], f1 = vertices_.point[vertices_.next(f)];
    std::uint32_t low_f = f, high_f = vertices_.next(f);
    if (opposed) {
      std::swap(f0, f1);
      std::swap(low_f, high_f);
    }
    const auto along = [&](Point2 p) { return (p.x - e0.x) * axis.x + (p.y - e0.y) * axis.y; };
    const auto outward = [&](Point2 p) { return (p.x - e0.x) * axis.y - (p.y - e0.y) * axis.x; };
    const double te = along(e1), tf0 = along(f0), tf1 = along(f1);
    const double low = std::max(0.0, tf0), high = std::min(te, tf1);
    if (high - low < options_.min_overlap) return;
    const double oe = outward(e1), of0 = outward(f0), of1 = outward(f1);
    const auto gap = [&](double t) { return of0 + (of1 - of0) * (t - tf0) / (tf1 - tf0) - oe * t / te; };

    Candidate c;
    Contact& w = c.contact;
    w.e = e;
    w.f = f;
    w.opposed = opposed;
    w.length = high - low;
    w.low = {e, low_f, gap(low), tf0, 0 >= tf0};
    w.high = {vertices_.next(e), high_f, gap(high), tf1 - te, te <= tf1};
    c.mean = (w.low.gap + w.high.gap) / 2;
    const double middle = (low + high) / 2, pe = middle / te, pf = (middle - tf0) / (tf1 - tf0);
    c.mean_weight = ((1 - pe) * (1 - pe) + pe * pe + (1 - pf) * (1 - pf) + pf * pf) / 2;
    c.cost = std::fabs(w.low.gap) + std::fabs(w.high.gap);
    c.from_e = low;
    c.from_f = opposed ? tf1 - high : low - tf0;
    const double ends = std::max(std::fabs(w.low.gap), std::fabs(w.high.gap));
    if (std::fabs(c.mean) > options_.snap_distance || ends > options_.snap_reach) {
      // A house drawn deeper into its neighbour than noise explains is an overlap, to be given to one of them.
      if (opposed && c.mean > 0 && c.mean < kWidestAlley) keep_apart(w);
      return;
    }
    candidates_.push_back(c);
  }

  void keep_apart(const Contact& w) {
    for (const Contact::End& end : {w.low, w.high}) {
      if (std::fabs(end.along) > kWidestAlley || vertices_.point[end.of_e] == vertices_.point[end.of_f]) continue;
      out_.apart.emplace_back(std::min(end.of_e, end.of_f), std::max(end.of_e, end.of_f));
    }
  }

  struct Sum {
    double squares = 0, count = 0;
    double with_prior(double variance, double weight) const { return (squares + weight * variance) / (count + weight); }
  };

  void estimate_noise() {
    Sum& row = row_noise_;
    std::vector<Sum> buildings(row_.buildings.size());
    for (const Candidate& c : candidates_) {
      if (!c.contact.opposed) continue;
      for (const Contact::End& end : {c.contact.low, c.contact.high}) {
        if (vertices_.point[end.of_e] == vertices_.point[end.of_f]) continue;
        const double square = end.gap * end.gap;
        for (Sum* s :
             {&row, &buildings[vertices_.building(c.contact.e)], &buildings[vertices_.building(c.contact.f)]}) {
          s->squares += square;
          s->count += 1;
        }
      }
    }
    const double of_row = row.with_prior(kPriorNoise * kPriorNoise, kTerracePriorWeight);
    out_.noise.reserve(buildings.size());
    for (const Sum& s : buildings) out_.noise.push_back(std::sqrt(s.with_prior(of_row, kBuildingPriorWeight)));
  }

  /// m. The largest mean gap of a wall. The wall's own gap is no evidence of noise here (a pair of houses drawn exactly,
  /// but apart, is not sloppy); that its ends differ is.
  double widest_gap(const Candidate& c) const {
    Sum others = row_noise_;
    const Contact& w = c.contact;
    for (const Contact::End& end : {w.low, w.high}) {
      if (!w.opposed || vertices_.point[end.of_e] == vertices_.point[end.of_f]) continue;
      others.squares -= end.gap * end.gap;
      others.count -= 1;
    }
    others.squares = std::max(0.0, others.squares) + (w.high.gap - w.low.gap) * (w.high.gap - w.low.gap) / 2;
    others.count += 1;
    const double noise =
        std::min(kMostNoise, std::sqrt(others.with_prior(kPriorNoise * kPriorNoise, kTerracePriorWeight)));
    return std::min(options_.snap_distance, kNarrowestAlley - kAlleySigmas * noise * std::sqrt(c.mean_weight));
  }

  void accept() {
    const auto ends = [&](const Candidate& c) {
      return std::tuple(vertices_.point[c.contact.e], vertices_.point[vertices_.next(c.contact.e)],
                        vertices_.point[c.contact.f], vertices_.point[vertices_.next(c.contact.f)]);
    };
    std::sort(candidates_.begin(), candidates_.end(), [&](const Candidate& a, const Candidate& b) {
      if (a.contact.opposed != b.contact.opposed) return a.contact.opposed;
      if (a.cost != b.cost) return a.cost < b.cost;
      if (a.contact.length != b.contact.length) return a.contact.length > b.contact.length;
      return ends(a) < ends(b);
    });
    struct Claim {
      double from, to;
    };
    std::vector<std::vector<Claim>> claims(vertices_.size());
    const auto claimed = [&](std::uint32_t edge, double from, double to) {
      const double spare = std::min(options_.snap_reach, (to - from) / 2);
      return std::any_of(claims[edge].begin(), claims[edge].end(),
                         [&](const Claim& c) { return std::min(c.to, to) - std::max(c.from, from) > spare; });
    };
    for (const Candidate& c : candidates_) {
      const Contact& w = c.contact;
      const double noise = std::max(out_.noise[vertices_.building(w.e)], out_.noise[vertices_.building(w.f)]);
      const double widest = widest_gap(c);
      const double turn = std::fabs(w.high.gap - w.low.gap);
      if (c.mean > widest || turn > options_.snap_angle * w.length + kTurnSigmas * noise * std::sqrt(2.0) ||
          claimed(w.e, c.from_e, c.from_e + w.length) || claimed(w.f, c.from_f, c.from_f + w.length)) {
        if (w.opposed && c.mean > widest) keep_apart(w);
        continue;
      }
      claims[w.e].push_back({c.from_e, c.from_e + w.length});
      claims[w.f].push_back({c.from_f, c.from_f + w.length});
      out_.walls.push_back(w);
    }
  }

  const TerraceVertices& vertices_;
  const TerraceRow& row_;
  const RepairOptions& options_;
  std::vector<Unit> units_;
  std::vector<Candidate> candidates_;
  Sum row_noise_;
  Contacts out_;
};

}  // namespace

Contacts find_contacts(const TerraceVertices& vertices, const TerraceRow& row, const RepairOptions& options) {
  return Search(vertices, row, options).run();
}

}  // namespace blockrand::repair
