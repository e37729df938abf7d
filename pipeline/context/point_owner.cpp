#include "pipeline/context/point_owner.h"

#include <algorithm>
#include <limits>

#include "pipeline/context/wall_contacts.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::context {

namespace {

using model::Point2;

/// A building that may own the point.
struct Candidate {
  model::OsmId id;
  bool canopy = false;
  bool is_corner = false;  ///< the point is a node of its outline
  double distance = 0;     ///< m from the outline; 0 within
  bool is_free = false;    ///< a wall that no neighbour covers is near
  int agreement = 0;       ///< of both addresses
};

template <class Visit>
void for_each_ring(const model::Polygon& polygon, Visit&& visit) {
  visit(polygon.outer);
  for (const model::Ring& hole : polygon.holes) visit(hole);
}

/// m from the outline; 0 within it.
double distance_to(const model::Polygon& polygon, Point2 p) {
  if (geometry::contains(polygon, p)) return 0;
  double least = std::numeric_limits<double>::infinity();
  for_each_ring(polygon, [&](const model::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      least = std::min(least, geometry::distance_to_segment(p, ring.points[i], ring.points[(i + 1) % ring.size()]));
  });
  return least;
}

/// Whether a piece of the footprint's walls within reach of `p` has no neighbour against it.
bool has_free_wall(const Footprint& footprint, Point2 p, const VicinityIndex& index,
                   const WallSegmentOptions& options) {
  for (const OutlineEdge& edge : edges_of({footprint.polygon})) {
    if (edge.length == 0 || geometry::distance_to_segment(p, edge.a, edge.b) > kEntranceReach) continue;
    double at = 0;
    const auto near = [&](double end) {
      return end - at > options.min_wall_segment &&
             geometry::distance_to_segment(p, edge.at(at), edge.at(end)) <= kEntranceReach;
    };
    for (const Contact& c : contacts_of(edge, footprint.id, footprint.canopy, index, options)) {
      if (near(c.start)) return true;
      at = c.end;
    }
    if (near(edge.length)) return true;
  }
  return false;
}

/// Whether `number` is one of a list: "5;7", "5, 7".
bool lists(std::string_view numbers, std::string_view number) {
  while (!numbers.empty()) {
    const std::size_t end = std::min(numbers.find_first_of(";,"), numbers.size());
    std::string_view one = numbers.substr(0, end);
    while (one.starts_with(' ')) one.remove_prefix(1);
    while (one.ends_with(' ')) one.remove_suffix(1);
    if (one == number) return true;
    numbers.remove_prefix(std::min(end + 1, numbers.size()));
  }
  return false;
}

/// 0: nothing agrees, or they contradict each other; 1: the street; 2: the number, no street told; 3: both.
int agreement_of(const SitePoint& point, const BuildingAddress& address) {
  const bool told = !point.street.empty() && !address.street.empty();
  if (told && point.street != address.street) return 0;
  if (!point.house_number.empty() && !address.house_number.empty())
    return lists(address.house_number, point.house_number) ? (told ? 3 : 2) : 0;
  return told ? 1 : 0;
}

int agreement_with(const SitePoint& point, model::OsmId building, const VicinityIndex& index) {
  const auto& all = index.all().addresses;
  const auto found = std::lower_bound(all.begin(), all.end(), building,
                                      [](const BuildingAddress& a, model::OsmId id) { return a.id < id; });
  return found != all.end() && found->id == building ? agreement_of(point, *found) : 0;
}

/// Drops the candidates that are worse than the best of them.
template <class Worse>
void keep_best(std::vector<Candidate>& candidates, Worse&& worse) {
  if (candidates.size() < 2) return;
  const auto best = *std::min_element(candidates.begin(), candidates.end(),
                                      [&](const Candidate& a, const Candidate& b) { return worse(b) > worse(a); });
  std::erase_if(candidates, [&](const Candidate& c) { return worse(c) > worse(best); });
}

/// One for each building, however many polygons it has.
std::vector<Candidate> candidates_of(const SitePoint& point, const VicinityIndex& index) {
  std::vector<Candidate> out;
  for (const std::uint32_t f : index.footprints_at(point.place, kEntranceReach)) {
    const Footprint& footprint = index.all().footprints[f];
    Candidate c{footprint.id, footprint.canopy, corner_of_node(footprint.polygon, point.id).has_value(), 0, false, 0};
    c.distance = c.is_corner ? 0 : distance_to(footprint.polygon, point.place);
    if (c.distance > kEntranceReach) continue;
    if (out.empty() || out.back().id != c.id) {
      out.push_back(c);
      continue;
    }
    out.back().is_corner = out.back().is_corner || c.is_corner;
    out.back().distance = std::min(out.back().distance, c.distance);
  }
  return out;
}

void look_for_free_walls(std::vector<Candidate>& candidates, const SitePoint& point, const VicinityIndex& index,
                         const WallSegmentOptions& options) {
  for (const std::uint32_t f : index.footprints_at(point.place, kEntranceReach)) {
    const Footprint& footprint = index.all().footprints[f];
    const Point2 place = corner_of_node(footprint.polygon, point.id).value_or(point.place);
    for (Candidate& c : candidates)
      if (c.id == footprint.id && !c.is_free) c.is_free = has_free_wall(footprint, place, index, options);
  }
}

}  // namespace

std::optional<Point2> corner_of_node(const model::Polygon& polygon, model::OsmId node) {
  std::optional<Point2> out;
  for_each_ring(polygon, [&](const model::Ring& ring) {
    for (std::size_t i = 0; i < ring.nodes.size() && !out; ++i)
      if (ring.nodes[i] == node.number) out = ring.points[i];
  });
  return out;
}

model::OsmId owner_of(const SitePoint& point, const VicinityIndex& index, const WallSegmentOptions& options) {
  std::vector<Candidate> candidates = candidates_of(point, index);
  keep_best(candidates, [](const Candidate& c) { return c.canopy ? 1 : 0; });
  keep_best(candidates, [](const Candidate& c) { return c.is_corner ? 0 : 1; });
  if (candidates.empty()) return {};
  double least = candidates[0].distance;
  for (const Candidate& c : candidates) least = std::min(least, c.distance);
  std::erase_if(candidates, [&](const Candidate& c) { return c.distance > least + kSameDistance; });
  if (candidates.size() == 1) return candidates[0].id;
  look_for_free_walls(candidates, point, index, options);
  for (Candidate& c : candidates) c.agreement = agreement_with(point, c.id, index);
  keep_best(candidates, [](const Candidate& c) { return c.is_free ? 0 : 1; });
  keep_best(candidates, [](const Candidate& c) { return -c.agreement; });
  return std::min_element(candidates.begin(), candidates.end(),
                          [](const Candidate& a, const Candidate& b) { return a.id < b.id; })
      ->id;
}

}  // namespace blockrand::context
