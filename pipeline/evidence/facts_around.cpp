#include "pipeline/evidence/facts_around.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"

namespace blockrand::evidence {

namespace {

using classify::Feature;
using classify::FeatureVector;
using classify::kNearReach;
using model::BuildingPosition;
using model::Point2;

constexpr double kWingRatio = 1.5;   ///< depth ratio from which a house has wings (docs/style_measures.md 2.2)
constexpr double kSameWidth = 0.75;  ///< m, and
constexpr double kSameArea = 0.10;   ///< of the area: houses that repeat each other
constexpr int kCircleCorners = 24;

float narrow(double v) { return static_cast<float>(v); }

/// m² of a circle that lie within a convex counter-clockwise ring; the whole circle where there is no ring.
double covered_circle(Point2 centre, double radius, std::span<const Point2> ring) {
  const double whole = 0.5 * kCircleCorners * radius * radius * base::sin(2 * base::kPi / kCircleCorners);
  if (ring.size() < 3) return whole;
  bool inside = true;
  for (std::size_t i = 0; i < ring.size() && inside; ++i) {
    const Point2 a = ring[i], d = ring[(i + 1) % ring.size()] - a;
    inside = cross(d, centre - a) >= radius * std::sqrt(dot(d, d));
  }
  if (inside) return whole;
  std::vector<Point2> shape, next;
  for (int k = 0; k < kCircleCorners; ++k) {
    const double turn = 2 * base::kPi * k / kCircleCorners;
    shape.push_back({centre.x + radius * base::cos(turn), centre.y + radius * base::sin(turn)});
  }
  for (std::size_t i = 0; i < ring.size() && !shape.empty(); ++i) {
    const Point2 a = ring[i], d = ring[(i + 1) % ring.size()] - a;
    next.clear();
    for (std::size_t k = 0; k < shape.size(); ++k) {
      const Point2 p = shape[k], q = shape[(k + 1) % shape.size()];
      const double sp = cross(d, p - a), sq = cross(d, q - a);
      if (sp >= 0) next.push_back(p);
      if ((sp >= 0) != (sq >= 0))
        next.push_back({p.x + (q.x - p.x) * sp / (sp - sq), p.y + (q.y - p.y) * sp / (sp - sq)});
    }
    shape.swap(next);
  }
  return shape.size() < 3 ? 0 : geometry::signed_area(shape);
}

/// m² from which the part of a circle within the data says anything: a tenth of it.
constexpr double kMinCircle = 0.1;

class Around {
 public:
  Around(const FactsExtract& facts, const footprints::FootprintStore& store, const context::ContextExtract& context,
         const PlaceIndex& houses, const PlaceIndex& small)
      : facts_(facts), store_(store), context_(context), houses_(houses), small_(small) {}

  /// What the buildings around say; the building's own features are known.
  void measure(std::uint32_t building, FeatureVector& f) {
    const BuildingPlace& own = facts_.places[building];
    houses_.near(own.place, kNearReach, near_);
    measure_near(building, f);
    measure_row(building, f);
    measure_street(own, f);
    if (facts_.places[building].street == 0) measure_gap(building, f);
  }

 private:
  float feature(std::uint32_t b, Feature f) const { return facts_.features[b][f]; }

  void median(Feature from, Feature to, std::uint32_t building, FeatureVector& f) {
    values_.clear();
    for (const std::uint32_t b : near_)
      if (b != building && facts_.features[b].has(from)) values_.push_back(static_cast<double>(feature(b, from)));
    if (!values_.empty()) f[to] = narrow(quantile(values_, 0.5));
  }

  void measure_near(std::uint32_t building, FeatureVector& f) {
    const Point2 place = facts_.places[building].place;
    const double circle = base::kPi * kNearReach * kNearReach;
    const double covered = covered_circle(place, kNearReach, context_.coverage) / circle;
    double n = 0, area = 0, squares = 0, party = 0, corners = 0, rear = 0, wings = 0, fronts = 0;
    for (const std::uint32_t b : near_) {
      if (b == building) continue;
      const FeatureVector& o = facts_.features[b];
      const double a = static_cast<double>(o[Feature::area]);
      ++n;
      area += a;
      squares += a * a;
      if (o.has(Feature::party_share)) party += static_cast<double>(o[Feature::party_share]);
      corners += static_cast<double>(o[Feature::corners]);
      const BuildingPosition p = facts_.places[b].position;
      if (p == BuildingPosition::rear_building || p == BuildingPosition::side_wing) ++rear;
      if (o.has(Feature::depth_ratio)) {
        ++fronts;
        if (static_cast<double>(o[Feature::depth_ratio]) >= kWingRatio) ++wings;
      }
    }
    if (covered >= kMinCircle) {
      const double own = facts_.places[building].house ? static_cast<double>(f[Feature::area]) : 0;
      f[Feature::around_count] = narrow(n / covered);
      f[Feature::around_built] = narrow((area + own) / circle / covered);
    }
    small_.near(place, kNearReach, others_);
    if (n > 0) {
      const double mean = area / n;
      f[Feature::around_spread] = narrow(std::sqrt(std::max(0.0, squares / n - mean * mean)) / mean);
      f[Feature::around_party_share] = narrow(party / n);
      f[Feature::around_corners] = narrow(corners / n);
      f[Feature::around_rear] = narrow(rear / n);
      f[Feature::around_small] = narrow(static_cast<double>(others_.size()) / n);
    }
    if (fronts > 0) f[Feature::around_depth_ratio] = narrow(wings / fronts);
    median(Feature::area, Feature::around_area, building, f);
    median(Feature::frontage, Feature::around_frontage, building, f);
    median(Feature::front_depth, Feature::around_depth, building, f);
    median(Feature::elongation, Feature::around_elongation, building, f);
  }

  /// Houses that touch within the reach, one through the other.
  void measure_row(std::uint32_t building, FeatureVector& f) {
    std::vector<std::uint32_t>& row = others_;
    row.assign(1, building);
    for (std::size_t i = 0; i < row.size(); ++i)
      for (const Contact& c : facts_.contacts_of(row[i]))
        if (std::binary_search(near_.begin(), near_.end(), c.other) &&
            std::find(row.begin(), row.end(), c.other) == row.end())
          row.push_back(c.other);
    std::sort(row.begin(), row.end());
    double area = 0;
    points_.clear();
    for (const std::uint32_t b : row) {
      area += static_cast<double>(feature(b, Feature::area));
      store_.for_each_ring(b, [&](std::span<const Point2> ring, bool hole) {
        if (!hole) points_.insert(points_.end(), ring.begin(), ring.end());
      });
    }
    f[Feature::row_count] = narrow(static_cast<double>(row.size()));
    f[Feature::row_area] = narrow(area);
    const std::vector<Point2> hull = context::coverage_of(points_);
    if (hull.size() >= 3) {
      const Point2 axis = geometry::long_axis(hull);
      const auto along = geometry::extent_along(hull, axis), across = geometry::extent_along(hull, {-axis.y, axis.x});
      const double length = along.maximum - along.minimum, breadth = across.maximum - across.minimum;
      f[Feature::row_length] = narrow(length);
      f[Feature::row_breadth] = narrow(breadth);
      if (length * breadth > 0) f[Feature::row_fill] = narrow(area / (length * breadth));
    }
    double alike = 0, touching = 0;
    for (const Contact& c : facts_.contacts_of(building)) {
      const FeatureVector& o = facts_.features[c.other];
      ++touching;
      const double a = static_cast<double>(f[Feature::area]), b = static_cast<double>(o[Feature::area]);
      const bool widths = f.has(Feature::frontage) && o.has(Feature::frontage);
      const double apart =
          widths ? std::fabs(static_cast<double>(f[Feature::frontage] - o[Feature::frontage])) : kSameWidth + 1;
      if (apart <= kSameWidth && std::fabs(a - b) <= kSameArea * std::max(a, b)) ++alike;
    }
    f[Feature::neighbours] = narrow(touching);
    if (touching > 0) f[Feature::row_alike] = narrow(alike / touching);
  }

  void measure_street(const BuildingPlace& own, FeatureVector& f) {
    if (own.street == 0) return;
    values_.clear();
    for (const std::uint32_t b : near_)
      if (facts_.places[b].street == own.street && facts_.features[b].has(Feature::street_distance))
        values_.push_back(static_cast<double>(feature(b, Feature::street_distance)));
    if (!values_.empty()) f[Feature::street_width] = narrow(2 * quantile(values_, 0.5));
  }

  void measure_gap(std::uint32_t building, FeatureVector& f) {
    std::vector<Point2>& own = points_;
    own.clear();
    store_.for_each_ring(building,
                         [&](std::span<const Point2> ring, bool) { own.insert(own.end(), ring.begin(), ring.end()); });
    double best = kNearReach;
    for (const std::uint32_t b : near_) {
      if (b == building || facts_.places[b].street == 0 || !store_[b].box.near(store_[building].box, best)) continue;
      store_.for_each_ring(b, [&](std::span<const Point2> ring, bool) {
        for (std::size_t i = 0; i < ring.size(); ++i)
          for (const Point2 p : own)
            best = std::min(best, geometry::distance_to_segment(p, ring[i], ring[(i + 1) % ring.size()]));
      });
    }
    if (best < kNearReach) f[Feature::front_gap] = narrow(best);
  }

  const FactsExtract& facts_;
  const footprints::FootprintStore& store_;
  const context::ContextExtract& context_;
  const PlaceIndex& houses_;
  const PlaceIndex& small_;
  std::vector<std::uint32_t> near_, others_;
  std::vector<double> values_;
  std::vector<Point2> points_;
};

}  // namespace

double quantile(std::vector<double>& values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

std::vector<FeatureVector> measured_around(const AroundInputs& in, std::size_t first, std::size_t last) {
  Around finder(in.facts, in.store, in.context, in.houses, in.small);
  const auto& own = in.facts.features;
  std::vector<FeatureVector> run(own.begin() + static_cast<std::ptrdiff_t>(first),
                                 own.begin() + static_cast<std::ptrdiff_t>(last));
  for (std::size_t k = 0; k < run.size(); ++k)
    if (run[k].has(Feature::area)) finder.measure(static_cast<std::uint32_t>(first + k), run[k]);
  return run;
}

void pack_around(const AroundInputs& in, std::size_t first, std::size_t last, base::Packer& out) {
  const FactsExtract& facts = in.facts;
  const footprints::FootprintStore& store = in.store;
  const auto pack_one = [&](std::uint32_t b) {
    const BuildingPlace& place = facts.places[b];
    out << store[b].id << facts.features[b] << place.place << place.street << place.position << place.house
        << store[b].box;
    store.for_each_ring(b, [&](std::span<const Point2> ring, bool hole) { out << hole << ring; });
    out << place.contacts.count;
    for (const Contact& c : facts.contacts_of(b)) out << store[c.other].id << c.length;
  };
  out << in.context.coverage;
  geometry::PlanBox box;
  for (std::size_t b = first; b < last; ++b) {
    pack_one(static_cast<std::uint32_t>(b));
    if (facts.features[b].has(Feature::area)) box.include(facts.places[b].place);
  }
  if (box.empty()) return;
  std::set<std::uint32_t> heard;
  for (const PlaceIndex* index : {&in.houses, &in.small})
    for (const std::uint32_t b : index->around(box, kNearReach)) heard.insert(b);
  out << static_cast<std::uint64_t>(heard.size());
  for (const std::uint32_t b : heard)
    if (b < first || b >= last) pack_one(b);
}

}  // namespace blockrand::evidence
