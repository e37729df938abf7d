// What ClaimFinder knows of single nodes and places.
#include <algorithm>
#include <cmath>

#include "pipeline/surroundings/ground_claims.h"

namespace blockrand::surroundings {

using model::Point2;

bool counts_in(SquareIndex square, const geometry::AreaClaim& claim, const GroundLabel& label) {
  if (!label.wide) return true;
  const Point2 middle = box_of(square).centre();
  for (const std::vector<Point2>& ring : claim.rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
      const double dx = b.x - a.x, dy = b.y - a.y, length = dx * dx + dy * dy;
      const double t =
          length > 0 ? std::clamp(((middle.x - a.x) * dx + (middle.y - a.y) * dy) / length, 0.0, 1.0) : 0.0;
      if (std::hypot(middle.x - a.x - t * dx, middle.y - a.y - t * dy) <= kWideReach) return true;
    }
  return false;
}

std::size_t ClaimFinder::streets_at(std::int64_t node) const {
  const auto [first, last] = std::ranges::equal_range(street_nodes_, node);
  return static_cast<std::size_t>(last - first);
}

CrossingMarking ClaimFinder::crossing_at(std::int64_t node) const {
  const auto at = std::ranges::lower_bound(crossings_, node, {}, &std::pair<std::int64_t, CrossingMarking>::first);
  return at != crossings_.end() && at->first == node ? at->second : CrossingMarking::none;
}

double ClaimFinder::opening_at(std::int64_t node, double street, double gate) const {
  if (streets_at(node) > 0) return street;
  return std::ranges::binary_search(gates_, node) ? gate : 0;
}

std::size_t ClaimFinder::tracks_at(std::int64_t node) const {
  const auto [first, last] = std::ranges::equal_range(track_nodes_, node);
  return static_cast<std::size_t>(last - first);
}

StreetControl ClaimFinder::control_at(std::int64_t node) const {
  const auto at = std::ranges::lower_bound(controls_, node, {}, &std::pair<std::int64_t, StreetControl>::first);
  return at != controls_.end() && at->first == node ? at->second : StreetControl{};
}

std::vector<std::uint32_t> ClaimFinder::wires_at(std::int64_t node) const {
  std::vector<std::uint32_t> out;
  for (auto at = std::ranges::lower_bound(wire_nodes_, std::pair(node, std::uint32_t{0}));
       at != wire_nodes_.end() && at->first == node; ++at)
    out.push_back(at->second);
  return out;
}

std::optional<std::uint32_t> ClaimFinder::feature_of_node(std::int64_t node) const {
  const model::OsmId id{model::OsmType::node, node};
  const auto& features = in_.extract.features;
  const auto at = std::ranges::lower_bound(features, id, {}, &model::Feature::id);
  if (at == features.end() || at->id != id) return std::nullopt;
  return static_cast<std::uint32_t>(at - features.begin());
}

const Thing* ClaimFinder::thing_of(model::OsmId id) const {
  const auto& features = in_.extract.features;
  const auto feature = std::ranges::lower_bound(features, id, {}, &model::Feature::id);
  if (feature == features.end() || feature->id != id) return nullptr;
  const auto index = static_cast<std::uint32_t>(feature - features.begin());
  const auto at = std::ranges::lower_bound(things_, index, {}, &Thing::feature);
  return at != things_.end() && at->feature == index ? &*at : nullptr;
}

std::vector<geometry::PlanBox> ClaimFinder::blocks_near(const geometry::PlanBox& box) const {
  std::vector<geometry::PlanBox> out;
  for (const std::uint32_t b : blocks_.near(box, 0)) out.push_back(blocks_.box(b));
  return out;
}

bool ClaimFinder::building_at(Point2 place) const {
  geometry::PlanBox at;
  at.include(place);
  for (const std::uint32_t number : in_.vicinity.buildings_near(at, 0)) {
    const footprints::StoredFootprint& stored = in_.footprints[number];
    if (stored.level.canopy || stored.level.low > 0 || stored.settled != model::ObjectState::pending) continue;
    geometry::AreaClaim claim;
    in_.footprints.for_each_ring(
        number, [&](std::span<const Point2> ring, bool) { claim.rings.emplace_back(ring.begin(), ring.end()); });
    if (geometry::claim_holds(claim, place)) return true;
  }
  return false;
}

}  // namespace blockrand::surroundings
