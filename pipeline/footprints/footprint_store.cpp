#include "pipeline/footprints/footprint_store.h"

#include <algorithm>
#include <utility>

namespace blockrand::footprints {

void FootprintStore::set(std::uint32_t building, StoredFootprint footprint, std::span<const model::Polygon> polygons,
                         std::span<const model::Arc> arcs) {
  footprint.rings = {static_cast<std::uint32_t>(rings_.size()), 0};
  footprint.arcs = {static_cast<std::uint32_t>(arcs_.size()), static_cast<std::uint32_t>(arcs.size())};
  footprint.box = {};
  const auto add = [&](const model::Ring& ring, bool hole) {
    rings_.push_back({{static_cast<std::uint32_t>(points_.size()), static_cast<std::uint32_t>(ring.size())}, hole});
    points_.insert(points_.end(), ring.points.begin(), ring.points.end());
    nodes_.insert(nodes_.end(), ring.nodes.begin(), ring.nodes.end());
    ++footprint.rings.count;
  };
  for (const model::Polygon& polygon : polygons) {
    add(polygon.outer, false);
    for (const model::Point2 p : polygon.outer.points) footprint.box.include(p);
    for (const model::Ring& hole : polygon.holes) add(hole, true);
  }
  arcs_.insert(arcs_.end(), arcs.begin(), arcs.end());
  entries_[building] = footprint;
}

std::vector<model::Polygon> FootprintStore::polygons(std::uint32_t building) const {
  std::vector<model::Polygon> out;
  const model::Range r = entries_[building].rings;
  for (const StoredRing& stored : std::span(rings_).subspan(r.first, r.count)) {
    model::Ring ring;
    const auto points = std::span(points_).subspan(stored.points.first, stored.points.count);
    const auto nodes = std::span(nodes_).subspan(stored.points.first, stored.points.count);
    ring.points.assign(points.begin(), points.end());
    ring.nodes.assign(nodes.begin(), nodes.end());
    if (stored.hole)
      out.back().holes.push_back(std::move(ring));
    else
      out.push_back({std::move(ring), {}});
  }
  return out;
}

std::vector<model::Arc> FootprintStore::arcs(std::uint32_t building) const {
  const model::Range r = entries_[building].arcs;
  const auto found = std::span(arcs_).subspan(r.first, r.count);
  return {found.begin(), found.end()};
}

void FootprintStore::shrink_to_fit() {
  rings_.shrink_to_fit();
  points_.shrink_to_fit();
  nodes_.shrink_to_fit();
  arcs_.shrink_to_fit();
}

void FootprintStore::add_overlap(std::uint32_t building, double area) {
  entries_[building].record.overlap_left += area;
}

BoxIndex index_of(const FootprintStore& store) {
  std::vector<PlanBox> boxes;
  boxes.reserve(store.size());
  for (std::uint32_t b = 0; b < store.size(); ++b) boxes.push_back(store[b].box);
  return BoxIndex(std::move(boxes));
}

BuildingNumbers::BuildingNumbers(const FootprintStore& store) {
  numbers_.reserve(store.size());
  for (std::uint32_t i = 0; i < store.size(); ++i) numbers_.emplace_back(store[i].id, i);
  std::sort(numbers_.begin(), numbers_.end());
}

std::uint32_t BuildingNumbers::find(model::OsmId id) const {
  const auto place = std::lower_bound(numbers_.begin(), numbers_.end(), std::pair(id, 0u));
  return place != numbers_.end() && place->first == id ? place->second : model::kNoIndex;
}

}  // namespace blockrand::footprints
