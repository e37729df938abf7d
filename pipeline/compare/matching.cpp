#include "pipeline/compare/matching.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "pipeline/compare/read_city.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/geometry/plan_shape.h"

namespace blockrand::compare {

namespace {

using geometry::BoxIndex;
using geometry::PlanBox;
using geometry::PlanShape;

PlanBox moved(PlanBox box, Point2 by) {
  if (box.empty()) return box;
  box.minimum = {box.minimum.x + by.x, box.minimum.y + by.y};
  box.maximum = {box.maximum.x + by.x, box.maximum.y + by.y};
  return box;
}

std::vector<PlanBox> boxes_of(const City& city) {
  std::vector<PlanBox> boxes;
  for (const Building& b : city.buildings) boxes.push_back(b.footprint.empty() ? PlanBox{} : plan_box(b));
  return boxes;
}

/// Footprints of both models, and which boxes of the model come near one of the reference's.
class Plans {
 public:
  Plans(const City& model, const City& reference)
      : model_boxes_(boxes_of(model)), reference_boxes_(boxes_of(reference)), index_(model_boxes_) {
    for (const Building& b : model.buildings) model_.emplace_back(b.footprint);
    for (const Building& b : reference.buildings) reference_.emplace_back(b.footprint);
  }
  struct Pair {
    std::uint32_t model, reference;
    double common;  ///< m²
  };
  /// All pairs with an area in common, by the reference's building, then the model's.
  std::vector<Pair> overlaps(Point2 shift) const {
    std::vector<Pair> out;
    for (std::uint32_t r = 0; r < reference_.size(); ++r) {
      if (reference_[r].empty()) continue;
      for (const std::uint32_t m : index_.near(moved(reference_boxes_[r], shift), 0)) {
        const double common = model_[m].moved({-shift.x, -shift.y}).common_area(reference_[r]);
        if (common > 0) out.push_back({m, r, common});
      }
    }
    return out;
  }
  /// Intersection over union.
  double overlap_of(const Pair& p) const {
    return p.common / (model_[p.model].area() + reference_[p.reference].area() - p.common);
  }
  /// Mean over the reference's buildings of the best overlap with one of the model's: how well the models fit.
  double fit(Point2 shift) const {
    std::vector<double> best(reference_.size(), 0);
    for (const Pair& p : overlaps(shift)) best[p.reference] = std::max(best[p.reference], overlap_of(p));
    double sum = 0;
    for (const double b : best) sum += b;
    return best.empty() ? 0 : sum / static_cast<double>(best.size());
  }
  double model_area(std::uint32_t i) const { return model_[i].area(); }
  double reference_area(std::uint32_t i) const { return reference_[i].area(); }
  /// Whether a match of one building each is certain.
  bool alike(const Match& m, Point2 shift, const MatchOptions& options) const {
    const double common = model_[m.model[0]].moved({-shift.x, -shift.y}).common_area(reference_[m.reference[0]]);
    return overlap_of({m.model[0], m.reference[0], common}) > options.certain_overlap;
  }
  std::size_t models() const { return model_.size(); }
  std::size_t references() const { return reference_.size(); }

  /// The shift from reference to model that most pairs of about the same size agree on, the shorter of two; nothing
  /// where fewer than `least` do.
  std::optional<Point2> vote(double reach, std::size_t least) const {
    constexpr double kSameSize = 1.15;
    std::map<std::pair<int, int>, std::vector<Point2>> votes;
    for (std::uint32_t r = 0; r < reference_.size(); ++r) {
      if (reference_[r].empty()) continue;
      const Point2 c = reference_[r].centroid();
      for (const std::uint32_t m : index_.near(reference_boxes_[r], reach)) {
        const double ratio = model_[m].area() / reference_[r].area();
        if (ratio > kSameSize || ratio * kSameSize < 1) continue;
        const Point2 d = model_[m].centroid();
        const Point2 by{d.x - c.x, d.y - c.y};
        if (by.x * by.x + by.y * by.y > reach * reach) continue;
        votes[{static_cast<int>(std::lround(by.x)), static_cast<int>(std::lround(by.y))}].push_back(by);
      }
    }
    // A shift lies on the border of cells as often as in the middle: 3 x 3 of them vote together.
    Point2 best;
    std::size_t most = 0;
    for (const auto& [cell, unused] : votes) {
      std::size_t n = 0;
      Point2 sum;
      for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y) {
          const auto near = votes.find({cell.first + x, cell.second + y});
          if (near == votes.end()) continue;
          n += near->second.size();
          for (const Point2 p : near->second) sum = {sum.x + p.x, sum.y + p.y};
        }
      const Point2 mean{sum.x / static_cast<double>(n), sum.y / static_cast<double>(n)};
      const auto far = [](Point2 p) { return p.x * p.x + p.y * p.y; };
      if (n < most || (n == most && far(mean) >= far(best))) continue;
      most = n;
      best = mean;
    }
    if (most < least) return std::nullopt;
    return best;
  }

 private:
  std::vector<PlanBox> model_boxes_, reference_boxes_;
  BoxIndex index_;
  std::vector<PlanShape> model_, reference_;
};

/// Sets that grow together.
class Groups {
 public:
  explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[std::max(find(a), find(b))] = std::min(find(a), find(b)); }

 private:
  std::vector<std::size_t> parent_;
};

std::vector<Match> matches_at(const Plans& plans, Point2 shift, const MatchOptions& options) {
  const std::size_t n = plans.references();
  Groups groups(n + plans.models());
  std::vector<bool> linked(n + plans.models(), false);
  const std::vector<Plans::Pair> pairs = plans.overlaps(shift);
  const auto share = [&](const Plans::Pair& p) {
    return p.common / std::min(plans.model_area(p.model), plans.reference_area(p.reference));
  };
  const auto link = [&](const Plans::Pair& p) {
    groups.join(p.reference, n + p.model);
    linked[p.reference] = linked[n + p.model] = true;
  };
  // The same house in both models is certain. What else has much in common with one of a certain pair joins it where it
  // is the smaller (an annex drawn apart), and not where it is the larger: a garage under six houses makes no block of
  // them.
  std::vector<bool> certain(n + plans.models(), false);
  for (const Plans::Pair& p : pairs)
    if (plans.overlap_of(p) > options.certain_overlap) {
      link(p);
      certain[p.reference] = certain[n + p.model] = true;
    }
  for (const Plans::Pair& p : pairs) {
    if (share(p) <= options.link_share) continue;
    const bool model_is_larger = plans.model_area(p.model) > plans.reference_area(p.reference);
    if (model_is_larger ? certain[p.reference] : certain[n + p.model]) continue;
    link(p);
  }
  // Each of the rest, and its best partner.
  std::map<std::size_t, const Plans::Pair*> best;
  for (const Plans::Pair& p : pairs)
    for (const std::size_t i : {static_cast<std::size_t>(p.reference), n + p.model}) {
      const double own = i < n ? plans.reference_area(p.reference) : plans.model_area(p.model);
      if (linked[i] || p.common < options.rest_share * own) continue;
      const Plans::Pair*& b = best[i];
      if (!b || p.common > b->common) b = &p;
    }
  for (const auto& [i, p] : best) link(*p);
  std::vector<Match> all(n);  // by the least building of the reference
  for (std::size_t i = 0; i < linked.size(); ++i) {
    if (!linked[i]) continue;
    Match& match = all[groups.find(i)];
    if (i < n)
      match.reference.push_back(static_cast<std::uint32_t>(i));
    else
      match.model.push_back(static_cast<std::uint32_t>(i - n));
  }
  std::erase_if(all, [](const Match& m) { return m.model.empty() || m.reference.empty(); });
  return all;
}

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

double spread_of(const std::vector<double>& values, double median) {
  std::vector<double> away;
  for (const double v : values) away.push_back(std::fabs(v - median));
  return median_of(std::move(away));
}

/// Centroid of footprints together, by area.
Point2 centroid_of(const City& city, const std::vector<std::uint32_t>& buildings) {
  std::vector<model::Polygon> all;
  for (const std::uint32_t b : buildings)
    all.insert(all.end(), city.buildings[b].footprint.begin(), city.buildings[b].footprint.end());
  return geometry::PlanShape(all).centroid();
}

}  // namespace

std::vector<Match> match_buildings(const City& model, const City& reference, Point2 shift,
                                   const MatchOptions& options) {
  return matches_at(Plans(model, reference), shift, options);
}

Registration register_models(const City& model, const City& reference, bool absolute, const MatchOptions& options) {
  // A vote counts where the models hardly fit as they lie: rows of equal houses agree on the next house as well as on
  // their own, and two houses agree on anything.
  constexpr double kClearlyBetter = 2;
  constexpr std::size_t kLeastVotes = 5;
  constexpr int kRounds = 10;
  constexpr double kSettled = 0.001;  // m
  const Plans plans(model, reference);
  Registration out;
  Point2 shift;
  const auto guess = plans.vote(options.largest_offset, kLeastVotes);
  if (guess && plans.fit(*guess) > kClearlyBetter * plans.fit({})) shift = *guess;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Match> matches = matches_at(plans, shift, options);
    std::vector<double> east, north, up;
    for (const bool single : {true, false}) {
      for (const Match& m : matches) {
        if (single && (m.model.size() != 1 || m.reference.size() != 1 || !plans.alike(m, shift, options))) continue;
        const Point2 a = centroid_of(model, m.model), b = centroid_of(reference, m.reference);
        east.push_back(a.x - b.x);
        north.push_back(a.y - b.y);
        if (absolute) {
          const auto lowest = [](const City& city, const std::vector<std::uint32_t>& buildings) {
            double z = 1e300;
            for (const std::uint32_t i : buildings) z = std::min(z, city.buildings[i].ground);
            return z;
          };
          up.push_back(lowest(model, m.model) - lowest(reference, m.reference));
        }
      }
      if (!east.empty()) break;
    }
    out = {};
    if (east.empty()) return out;
    out.matches = east.size();
    out.east = median_of(east);
    out.north = median_of(north);
    out.east_spread = spread_of(east, out.east);
    out.north_spread = spread_of(north, out.north);
    if (!up.empty()) {
      out.up = median_of(up);
      out.up_spread = spread_of(up, *out.up);
    }
    const bool settled = std::fabs(out.east - shift.x) < kSettled && std::fabs(out.north - shift.y) < kSettled;
    shift = {out.east, out.north};
    if (settled) break;
  }
  return out;
}

std::vector<double> covered_shares(const City& city, const std::vector<std::uint32_t>& buildings, const City& other,
                                   Point2 shift) {
  const BoxIndex index(boxes_of(other));
  std::vector<double> out;
  for (const std::uint32_t i : buildings) {
    const Building& b = city.buildings[i];
    std::vector<model::Polygon> around;
    if (!b.footprint.empty())
      for (const std::uint32_t k : index.near(moved(plan_box(b), shift), 0))
        around.insert(around.end(), other.buildings[k].footprint.begin(), other.buildings[k].footprint.end());
    const PlanShape shape(b.footprint);
    out.push_back(around.empty() ? 0 : shape.moved(shift).common_area(PlanShape(around)) / shape.area());
  }
  return out;
}

void move(City& city, Point3 by) {
  const auto rings = [&](Rings3& r) {
    for (auto& ring : r)
      for (Point3& p : ring) p = {p.x + by.x, p.y + by.y, p.z + by.z};
  };
  for (Building& b : city.buildings) {
    for (model::Polygon& polygon : b.footprint) {
      const auto shift = [&](model::Ring& ring) {
        for (Point2& p : ring.points) p = {p.x + by.x, p.y + by.y};
      };
      shift(polygon.outer);
      for (model::Ring& hole : polygon.holes) shift(hole);
    }
    b.ground += by.z;
    for (Face& f : b.faces) rings(f.rings);
    for (Opening& o : b.openings)
      for (Rings3& r : o.polygons) rings(r);
    for (Shell& s : b.shells)
      for (Rings3& r : s.polygons) rings(r);
  }
}

}  // namespace blockrand::compare
