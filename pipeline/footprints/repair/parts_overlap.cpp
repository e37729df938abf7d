#include <algorithm>
#include <limits>
#include <string>
#include <tuple>

#include "pipeline/footprints/repair/parts_bodies.h"
#include "pipeline/footprints/repair/rings.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/slivers.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::repair {

namespace {

using model::IssueCode;
using model::Point2;
using model::Polygon;

constexpr double kStoreyHeight = 3.0;    // m; only to compare storeys with metres
constexpr double kSameKindMargin = 0.1;  // m; heights are mapped in tenths
constexpr double kMixedMargin = 1.5;     // m; half a storey: real ones are 2.5 to 4.5 m high
constexpr double kLeastPartWidth = 0.3;  // m; what is left of a part and narrower is the noise of two drawn walls
constexpr double kLeastPartArea = 0.5;   // m²; smaller than the smallest chimney or turret that somebody maps

geometry::PlanBox box_of(const std::vector<Polygon>& polygons) {
  geometry::PlanBox box;
  for (const Polygon& p : polygons) box.include(geometry::box_of(p.outer.points));
  return box;
}

bool may_overlap(const geometry::PlanBox& a, const geometry::PlanBox& b, double area) {
  const double w = std::min(a.maximum.x, b.maximum.x) - std::max(a.minimum.x, b.minimum.x);
  const double h = std::min(a.maximum.y, b.maximum.y) - std::max(a.minimum.y, b.minimum.y);
  return w > 0 && h > 0 && w * h > area;
}

double area_of(const std::vector<Polygon>& polygons) {
  double sum = 0;
  for (const Polygon& p : polygons) sum += geometry::area(p);
  return sum;
}

/// Cuts off the corners of what is taken where the rest would touch itself: the rest keeps a wall's width of its own
/// ground there and needs none of a third one's.
void cut_corners(std::span<const Polygon> squares, const std::vector<PartBody*>& takers, const RepairOptions& options) {
  for (PartBody* taker : takers) {
    if (geometry::common_area(taker->polygons, squares) <= 0) continue;
    std::vector<Polygon> cut =
        geometry::difference(taker->polygons, squares, options.min_piece_area, options.ring_clearance).polygons;
    if (cut.size() != taker->polygons.size() || area_of(cut) < area_of(taker->polygons) - options.min_overlap_area)
      continue;
    restore_nodes(cut, taker->polygons);
    taker->polygons = std::move(cut);
  }
}

std::vector<Polygon> polygons_of(const std::vector<PartBody*>& bodies) {
  std::vector<Polygon> out;
  for (const PartBody* body : bodies) out.insert(out.end(), body->polygons.begin(), body->polygons.end());
  return out;
}

/// What is worth a part of what is left, without slivers and with its nodes.
std::vector<Polygon> tidied(std::vector<Polygon> rest, std::span<const Polygon> plan, std::span<const Polygon> taken,
                            const RepairOptions& options) {
  std::erase_if(rest, [](const Polygon& p) { return geometry::equivalent_width(p) < kLeastPartWidth; });
  geometry::cut_slivers(rest, options.spike_width);
  restore_nodes(rest, plan);
  restore_nodes(rest, taken);
  return rest;
}

}  // namespace

HeightSpan height_span(const model::MappedAttributes& part, bool canopy, const model::MappedAttributes& building) {
  HeightSpan span;
  if (part.min_height) {
    span.low = *part.min_height;
  } else if (part.min_storey) {
    span.low = *part.min_storey * kStoreyHeight;
    span.low_counted = true;
  } else {
    span.slab = canopy;
  }
  const auto top = [&](const model::MappedAttributes& a) {
    if (a.height) {
      span.high = *a.height;
      return true;
    }
    if (!a.storeys) return false;
    span.high = *a.storeys * kStoreyHeight;
    span.high_counted = true;
    return true;
  };
  // A top at or below the underside says nothing; whatever it was meant to be, the part stands up to somewhere.
  const bool known = (top(part) && span.high > span.low) || (top(building) && span.high > span.low);
  if (!known) {
    span.high = std::numeric_limits<double>::infinity();
    span.high_counted = false;
  }
  return span;
}

bool heights_meet(const HeightSpan& a, const HeightSpan& b) {
  if (a.slab != b.slab) return false;
  const bool low_of_a = a.low > b.low, high_of_a = a.high < b.high;
  const double low = low_of_a ? a.low : b.low, high = high_of_a ? a.high : b.high;
  const bool low_counted = low_of_a ? a.low_counted : b.low_counted;
  const bool high_counted = high_of_a ? a.high_counted : b.high_counted;
  // The ground is the ground in metres and in storeys.
  const bool one_kind = low == 0 || low_counted == high_counted;
  return high - low > (one_kind ? kSameKindMargin : kMixedMargin);
}

bool worth_a_part(const Polygon& polygon) {
  return geometry::area(polygon) >= kLeastPartArea && geometry::equivalent_width(polygon) >= kLeastPartWidth;
}

std::vector<Polygon> plan_without(std::span<const Polygon> plan, std::span<const Polygon> taken,
                                  const RepairOptions& options) {
  return tidied(geometry::difference(plan, taken, kLeastPartArea, options.ring_clearance).polygons, plan, taken,
                options);
}

void resolve_part_overlaps(std::vector<PartBody>& bodies, const RepairOptions& options, model::Report& report) {
  if (bodies.size() < 2) return;
  struct Entry {
    double area;
    model::OsmId osm;
    std::size_t body;
    geometry::PlanBox box;
  };
  std::vector<Entry> order;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    order.push_back({area_of(bodies[i].polygons), bodies[i].osm, i, box_of(bodies[i].polygons)});
  std::sort(order.begin(), order.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.area, a.osm, a.body) < std::tie(b.area, b.osm, b.body);
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    PartBody& weak = bodies[order[i].body];
    std::vector<PartBody*> takers;
    std::string names;
    for (std::size_t k = 0; k < i; ++k) {
      PartBody& strong = bodies[order[k].body];
      if (!may_overlap(order[i].box, order[k].box, options.min_overlap_area)) continue;
      if (!heights_meet(weak.heights, strong.heights)) continue;
      if (geometry::common_area(weak.polygons, strong.polygons) <= options.min_overlap_area) continue;
      names += (takers.empty() ? "" : ", ") + strong.osm.text();
      takers.push_back(&strong);
    }
    if (takers.empty()) continue;
    const std::vector<Polygon> taken = polygons_of(takers);
    const double overlap = geometry::common_area(weak.polygons, taken);
    geometry::ValidPolygons left = geometry::difference(weak.polygons, taken, kLeastPartArea, options.ring_clearance);
    std::vector<Polygon> rest = tidied(std::move(left.polygons), weak.polygons, taken, options);
    if (rest.empty()) continue;  // separate_parts decides and tells
    if (!left.squares.empty()) {
      cut_corners(left.squares, takers, options);
      rest = plan_without(weak.polygons, polygons_of(takers), options);
    }
    weak.polygons = std::move(rest);
    report.add(weak.osm, IssueCode::parts_overlap, square_metres(overlap) + " given to " + names);
  }
}

}  // namespace blockrand::repair
