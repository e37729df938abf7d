#include "pipeline/context/vicinity_finder.h"

#include <algorithm>
#include <map>

#include "pipeline/context/wall_segments.h"

namespace blockrand::context {

std::unique_ptr<KeptLabels> KeptLabels::of(std::size_t buildings) {
  if (buildings > kMostBuildings) return nullptr;
  auto out = std::make_unique<KeptLabels>();
  out->labels_.resize(buildings);
  return out;
}

void KeptLabels::put(std::uint32_t number, const model::Building& building) {
  auto labels = std::make_unique<Labels>(Labels{building.edges, building.trees, building.situation});
  const std::lock_guard lock(mutex_);
  labels_[number] = std::move(labels);
}

bool KeptLabels::take(std::uint32_t number, model::Building& building) {
  std::unique_ptr<Labels> labels;
  {
    const std::lock_guard lock(mutex_);
    labels = std::move(labels_[number]);
  }
  if (!labels) return false;
  building.edges = std::move(labels->edges);
  building.trees = std::move(labels->trees);
  building.situation = std::move(labels->situation);
  return true;
}

VicinityFinder::VicinityFinder(const model::Extract& extract, const footprints::FootprintStore& footprints,
                               const ContextExtract& context, KeptLabels* kept, Labels use)
    : extract_(extract),
      footprints_(footprints),
      context_(context),
      kept_(kept),
      use_(use),
      buildings_(footprints::index_of(footprints)) {
  std::vector<geometry::PlanBox> boxes;
  for (const context::NetworkLine& line : context.lines) boxes.push_back(geometry::box_of(line.points));
  lines_ = geometry::BoxIndex(std::move(boxes));
  boxes.clear();
  for (const context::PassageWay& passage : context.passages) boxes.push_back(geometry::box_of(passage.points));
  passages_ = geometry::BoxIndex(std::move(boxes));
  boxes.clear();
  for (const context::SitePoint& point : context.points) boxes.push_back(geometry::box_of({&point.place, 1}));
  points_ = geometry::BoxIndex(std::move(boxes));
  boxes.clear();
  for (const context::Block& block : context.blocks)
    boxes.push_back(block.too_large ? geometry::PlanBox{} : geometry::box_of(block.polygon.outer.points));
  blocks_ = geometry::BoxIndex(std::move(boxes));
  boxes.clear();
  for (const ExtractCourtyard& yard : context.courtyards)
    boxes.push_back(geometry::box_of(yard.courtyard.polygon.outer.points));
  courtyards_ = geometry::BoxIndex(std::move(boxes));
}

void pack(const FoundVicinity& found, base::Packer& out) {
  out << found.footprints << found.lines << found.passages << found.points << found.addresses;
  for (Block block : found.blocks) {
    for (BlockBorder& border : block.borders) border.line = 0;  // numbers lines in this run
    out << block;
  }
  for (const BlockFigures& figures : found.figures) {
    out << static_cast<std::uint64_t>(figures.courtyards.size());
    for (Courtyard yard : figures.courtyards) {
      yard.buildings.clear();
      out << yard;
    }
  }
}

FoundVicinity VicinityFinder::vicinity_of(const geometry::PlanBox& box) const {
  constexpr double kReach = context::kWallSegmentReach;
  FoundVicinity found;
  for (const std::uint32_t n : buildings_.near(box, kReach)) {
    const model::Range tags = extract_.buildings[footprints_[n].lead].tags;
    found.addresses.push_back(context::building_address(extract_, footprints_[n].id, tags));
    for (model::Polygon& polygon : footprints_.polygons(n))
      found.footprints.push_back({footprints_[n].id, std::move(polygon), std::nullopt, footprints_[n].level.canopy});
  }
  std::erase_if(found.addresses, [](const auto& a) { return a.street.empty() && a.house_number.empty(); });
  std::sort(found.addresses.begin(), found.addresses.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  std::stable_sort(found.footprints.begin(), found.footprints.end(),
                   [](const context::Footprint& a, const context::Footprint& b) { return a.id < b.id; });
  for (const std::uint32_t i : lines_.near(box, kReach)) found.lines.push_back(context_.lines[i]);
  for (const std::uint32_t i : passages_.near(box, kReach)) found.passages.push_back(context_.passages[i]);
  for (const std::uint32_t i : points_.near(box, kReach)) found.points.push_back(context_.points[i]);

  std::map<std::uint32_t, std::size_t> place;  // of a block of the extract among those here
  for (const std::uint32_t b : blocks_.near(box, kReach)) {
    place[b] = found.blocks.size();
    found.blocks.push_back(context_.blocks[b]);
    found.figures.emplace_back();
  }
  // Courtyards that lie in no block stand with a block of no extent.
  place[model::kNoIndex] = found.blocks.size();
  found.blocks.emplace_back();
  found.figures.emplace_back();
  for (const std::uint32_t i : courtyards_.near(box, kReach)) {
    const ExtractCourtyard& yard = context_.courtyards[i];
    if (const auto block = place.find(yard.block); block != place.end())
      found.figures[block->second].courtyards.push_back(yard.courtyard);
  }
  return found;
}

namespace {

bool equal_rings(const model::Ring& a, const model::Ring& b) { return a.points == b.points && a.nodes == b.nodes; }

bool same_polygon(const model::Polygon& a, const model::Polygon& b) {
  return equal_rings(a.outer, b.outer) &&
         std::equal(a.holes.begin(), a.holes.end(), b.holes.begin(), b.holes.end(), equal_rings);
}

bool same_arc(const model::Arc& a, const model::Arc& b) {
  return a.polygon == b.polygon && a.ring == b.ring && a.first == b.first && a.count == b.count;
}

}  // namespace

bool VicinityFinder::is_as_stored(const model::Building& building, std::uint32_t number) const {
  const std::vector<model::Polygon> outline = footprints_.polygons(number);
  const std::vector<model::Arc> arcs = footprints_.arcs(number);
  return building.osm == footprints_[number].id &&
         std::equal(outline.begin(), outline.end(), building.outline.begin(), building.outline.end(), same_polygon) &&
         std::equal(arcs.begin(), arcs.end(), building.arcs.begin(), building.arcs.end(), same_arc) &&
         address_street(extract_, building.tags) ==
             address_street(extract_, extract_.buildings[footprints_[number].lead].tags);
}

void VicinityFinder::label_wall_segments(model::Region& region, std::span<const std::uint32_t> numbers) const {
  std::vector<model::Building*> open;
  std::vector<std::uint32_t> open_numbers;
  for (std::size_t i = 0; i < region.buildings.size(); ++i) {
    model::Building& building = region.buildings[i];
    if (kept_ && use_ == Labels::take && is_as_stored(building, numbers[i]) && kept_->take(numbers[i], building))
      continue;
    open.push_back(&building);
    open_numbers.push_back(numbers[i]);
  }
  if (open.empty()) return;
  geometry::PlanBox box;
  for (const std::uint32_t n : open_numbers) box.include(footprints_[n].box);
  if (box.empty()) return;
  const FoundVicinity found = vicinity_of(box);
  const context::VicinityIndex index({.footprints = found.footprints,
                                      .lines = found.lines,
                                      .blocks = found.blocks,
                                      .figures = found.figures,
                                      .passages = found.passages,
                                      .points = found.points,
                                      .addresses = found.addresses});
  for (std::size_t i = 0; i < open.size(); ++i) {
    context::label_wall_segments(*open[i], index, context::address_street(extract_, open[i]->tags));
    if (kept_ && use_ == Labels::fill) kept_->put(open_numbers[i], *open[i]);
  }
}

}  // namespace blockrand::context
