#include "pipeline/footprints/footprint_store.h"

#include <algorithm>
#include <cmath>

namespace blockrand::footprints {

namespace {

constexpr double kCell = 64;  // m, two to four houses wide: few boxes lie in more than four cells

/// A building over more cells stands in a list of its own.
constexpr std::int64_t kManyCells = 4096;

std::int32_t cell_of(double metres) { return static_cast<std::int32_t>(std::floor(metres / kCell)); }

std::int64_t cells_of(const PlanBox& box) {
  const std::int64_t columns = cell_of(box.maximum.x) - cell_of(box.minimum.x) + 1,
                     rows = cell_of(box.maximum.y) - cell_of(box.minimum.y) + 1;
  return columns * rows;
}

}  // namespace

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

void FootprintStore::add_overlap(std::uint32_t building, double area) { entries_[building].record.overlap_left += area; }

FootprintIndex::FootprintIndex(const FootprintStore& store) : store_(store) {
  for (std::uint32_t b = 0; b < store.size(); ++b) {
    const PlanBox& box = store[b].box;
    if (box.empty()) continue;
    if (cells_of(box) > kManyCells) {
      large_.push_back(b);
      continue;
    }
    for (std::int32_t x = cell_of(box.minimum.x); x <= cell_of(box.maximum.x); ++x)
      for (std::int32_t y = cell_of(box.minimum.y); y <= cell_of(box.maximum.y); ++y) entries_.push_back({x, y, b});
  }
  std::sort(entries_.begin(), entries_.end());
}

std::vector<std::uint32_t> FootprintIndex::near(const PlanBox& box, double distance) const {
  std::vector<std::uint32_t> out;
  if (box.empty()) return out;
  const std::int32_t y0 = cell_of(box.minimum.y - distance), y1 = cell_of(box.maximum.y + distance);
  for (std::int32_t x = cell_of(box.minimum.x - distance); x <= cell_of(box.maximum.x + distance); ++x) {
    auto entry = std::lower_bound(entries_.begin(), entries_.end(), Entry{x, y0, 0});
    for (; entry != entries_.end() && entry->x == x && entry->y <= y1; ++entry)
      if (store_[entry->building].box.near(box, distance)) out.push_back(entry->building);
  }
  for (const std::uint32_t b : large_)
    if (store_[b].box.near(box, distance)) out.push_back(b);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> FootprintIndex::pairs(double distance) const {
  // Boxes that are near each other share a cell, or lie in cells that touch: the lower one's cell and its neighbours to
  // the north and east, and the diagonals, are asked.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
  constexpr std::pair<std::int32_t, std::int32_t> kSteps[] = {{0, 1}, {1, -1}, {1, 0}, {1, 1}};
  const auto add = [&](std::uint32_t a, std::uint32_t b) {
    if (a != b && store_[a].box.near(store_[b].box, distance)) out.emplace_back(std::min(a, b), std::max(a, b));
  };
  for (auto first = entries_.begin(); first != entries_.end();) {
    auto last = first;
    for (; last != entries_.end() && last->x == first->x && last->y == first->y; ++last)
      for (auto e = first; e != last; ++e) add(e->building, last->building);
    for (const auto& [dx, dy] : kSteps) {
      auto other = std::lower_bound(last, entries_.end(), Entry{first->x + dx, first->y + dy, 0});
      for (; other != entries_.end() && other->x == first->x + dx && other->y == first->y + dy; ++other)
        for (auto e = first; e != last; ++e) add(e->building, other->building);
    }
    first = last;
  }
  for (const std::uint32_t large : large_)
    for (const std::uint32_t b : near(store_[large].box, distance)) add(large, b);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
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
