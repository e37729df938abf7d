#include "pipeline/run/area_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "importers/osm/extract_store.h"
#include "pipeline/georef/tiles.h"
#include "styles/districts/read_rule_set.h"

namespace blockrand::run {
namespace {

using geometry::PlanBox;
using model::Point2;

PlanBox grown(PlanBox box, double by) {
  if (box.empty()) return box;
  box.minimum = {box.minimum.x - by, box.minimum.y - by};
  box.maximum = {box.maximum.x + by, box.maximum.y + by};
  return box;
}

/// m. What classification asks of the buildings beside a tile's (needed_for).
constexpr double kBeside = 5;
/// Cells to each side that make a building's town, and its own.
constexpr double kTownReach = 3 * context::kCellSize;

class Reaches {
 public:
  explicit Reaches(const ReachInputs& in) : in_(in), store_(in.prepared.repaired.footprints) {
    // What was read; an outline may lead kilometres out of it, and what is grown somewhat.
    constexpr double kMargin = 1000;  // m
    extent_ = cells_of(grown(projected_box(in.area.window, in.located.projection), kMargin));
    width_ = static_cast<std::size_t>(extent_.x1 - extent_.x0) + 1;
    const std::size_t count = extent_.empty() ? 0 : width_ * (static_cast<std::size_t>(extent_.y1 - extent_.y0) + 1);
    outlines_.resize(count), rows_.resize(count), blocks_.resize(count);
    const context::ContextExtract& context = in.prepared.context;
    for (const context::Block& block : context.blocks)
      block_boxes_.push_back(block.too_large ? PlanBox() : geometry::box_of(block.polygon.outer.points));
    const std::vector<PlanBox>& row_boxes = in.prepared.repaired.row_boxes;
    for (std::uint32_t b = 0; b < store_.size(); ++b) {
      const CellRange range = cells_of(store_[b].box);
      if (range.empty()) continue;
      const std::uint32_t block = context.block_of[b];
      const CellRange row = b < row_boxes.size() ? cells_of(row_boxes[b]) : CellRange();
      const CellRange here = common(range, extent_);
      for (std::int32_t y = here.y0; y <= here.y1; ++y)
        for (std::int32_t x = here.x0; x <= here.x1; ++x) {
          const std::size_t cell = at(x, y);
          outlines_[cell].include(range), rows_[cell].include(row);
          if (block == model::kNoIndex || block_boxes_[block].empty()) continue;
          std::vector<std::uint32_t>& its = blocks_[cell];
          if (std::ranges::find(its, block) == its.end()) its.push_back(block);
        }
    }
  }

  /// \param own  what lies in the tile, as mapped and as repaired
  TileReach reach(const model::TileId& tile, const PlanBox& own) {
    const classify::Tables& tables = in_.tables;
    const double heard = std::max({classify::kNearReach, tables.era_votes.reach, tables.storeys_votes.reach,
                                   tables.roof_votes.reach, tables.non_houses.equal_radius});
    // Nothing of a tile is heard further away than its area's window reaches (kHalo).
    constexpr double kFar = 8000;  // m
    PlanCells mine(common(extent_, cells_of(grown(own, kFar))));
    mine.include(own);
    // Tagged neighbours speak for houses without tags. What is measured of a house reads no tags but its own (features.h).
    PlanCells look = mine;
    touch(look, kBeside);
    // What must be classified and measured is what evidence::needed_for says of an area.
    PlanCells styled = mine;
    touch(styled, kBeside);
    for (int round = 0; round < std::max(1, tables.smoothing.rounds); ++round)
      touch(look, classify::kNearReach), touch(styled, classify::kNearReach);
    touch(look, heard);
    touch(look, kBeside);  // dated voters are compared with what touches them (Classifier::is_infill)
    // Figures of its blocks count storeys.
    PlanCells blocks = mine;
    add_blocks(blocks);
    look.include(blocks);
    PlanCells tagged = mine;
    add(rows_, tagged);
    touch(tagged, std::max(in_.neighbour_reach, context::kWallSegmentReach));
    look.include(tagged);

    PlanCells measured = styled;
    touch(measured, heard);
    touch(measured, kBeside);
    add_blocks(styled);
    measured.include(styled);
    measured.include(blocks);
    PlanCells far = measured;
    if (asks_town_) far.grow(kTownReach);
    // Features of houses: what stands around, and what that needs of its own surroundings.
    PlanCells near = std::move(measured);
    touch(near, classify::kNearReach);
    touch(near, context::kWallSegmentReach);
    near.include(look);
    PlanCells around(common(extent_, cells_of(grown(own, kFar))));
    if (in_.around) {
      const surroundings::SurroundingsReach heard_around = in_.around->reach(tile);
      for (const PlanBox& place : heard_around.things) around.include(place);
      near.include(around);
      for (const PlanBox& block : heard_around.blocks) near.include(block);
      add(outlines_, near);
    }
    far.include(near);
    add(rows_, near), add(rows_, far);
    CellRuns runs = near.runs();
    add_blocks(near);  // whose corners say which buildings stand at their streets
    return {std::move(runs), near.runs().box, far.runs(), look.runs(), around.runs()};
  }

 private:
  std::size_t at(std::int32_t x, std::int32_t y) const {
    return static_cast<std::size_t>(y - extent_.y0) * width_ + static_cast<std::size_t>(x - extent_.x0);
  }
  /// What reaches out of each square.
  void add(const std::vector<CellRange>& ranges, PlanCells& cells) const {
    std::vector<CellRange> more;
    cells.for_each([&](std::int32_t x, std::int32_t y) {
      const CellRange& range = ranges[at(x, y)];
      if (!range.empty() && (range.x0 != range.x1 || range.y0 != range.y1)) more.push_back(range);
    });
    for (const CellRange& range : more) cells.include(range);
  }
  /// Grown, and the buildings that are touched then.
  void touch(PlanCells& cells, double distance) const {
    cells.grow(distance);
    add(outlines_, cells);
  }
  /// The blocks of its buildings.
  void add_blocks(PlanCells& cells) {
    std::vector<std::uint32_t> found;
    cells.for_each([&](std::int32_t x, std::int32_t y) {
      const std::vector<std::uint32_t>& here = blocks_[at(x, y)];
      found.insert(found.end(), here.begin(), here.end());
    });
    std::ranges::sort(found);
    const auto twice = std::ranges::unique(found);
    found.erase(twice.begin(), twice.end());
    for (const std::uint32_t block : found) cells.include(block_boxes_[block]);
  }

  const ReachInputs& in_;
  const bool asks_town_ = classify::any_asks(in_.tables, "town") || in_.book.ask_cells();
  const footprints::FootprintStore& store_;
  CellRange extent_;
  std::size_t width_ = 0;
  std::vector<CellRange> outlines_, rows_;          ///< by square: around the outlines that touch it; around their rows
  std::vector<std::vector<std::uint32_t>> blocks_;  ///< of these outlines
  std::vector<PlanBox> block_boxes_;                ///< empty for those that are too large
};

}  // namespace

AreaReach reaches_of(const ReachInputs& inputs, std::span<const model::TileId> tiles) {
  const model::Extract& extract = inputs.located.extract;
  const georef::Projection& projection = inputs.located.projection;
  std::map<model::TileId, PlanBox> own;
  for (const model::TileId& tile : tiles) {
    const georef::GeoBox box = georef::bounds(tile);
    own[tile] = projected_box({box.west, box.south, box.east, box.north}, projection);
  }
  const auto include = [&](PlanBox& box, const model::MappedBuilding& b) {
    for (const model::MappedRing& ring : extract.rings_of(b.rings))
      for (const model::Location v : extract.vertices_of(ring))
        if (const Point2 p = projection.forward(v); std::isfinite(p.x) && std::isfinite(p.y)) box.include(p);
  };
  const auto& shards = inputs.prepared.shards;
  for (std::size_t s = 0; s < shards.size(); ++s) {
    const auto found = own.find(shards[s].tile);
    if (found == own.end()) continue;
    for (std::size_t i = 0; i < shards[s].seeds.size(); ++i) {
      const footprints::Seed& seed = shards[s].seeds[i];
      found->second.include(inputs.prepared.repaired.footprints[inputs.prepared.repaired.first[s] + i].box);
      if (seed.outline != model::kNoIndex) include(found->second, extract.buildings[seed.outline]);
      for (const std::uint32_t part : seed.parts) include(found->second, extract.buildings[part]);
    }
  }
  // What is decided before the tiles, and empty blocks.
  for (const model::MappedBuilding& b : extract.buildings) {
    const std::optional<model::Location> place = b.rings.count > 0 ? footprints::box_centre(extract, b) : b.place;
    if (!place) continue;
    const auto found = own.find(georef::tile_of(*place, footprints::kTileLevel));
    if (found != own.end()) include(found->second, b);
  }
  const context::ContextExtract& c = inputs.prepared.context;
  for (std::uint32_t b = 0; b < c.blocks.size(); ++b) {
    if (c.blocks[b].too_large || !c.figures[b].buildings.empty()) continue;
    const georef::LonLat corner = projection.inverse(c.blocks[b].polygon.outer.points.front());
    constexpr double kUnits = 1e7;
    const auto found = own.find(georef::tile_of({static_cast<std::int32_t>(std::lround(corner.lon * kUnits)),
                                                 static_cast<std::int32_t>(std::lround(corner.lat * kUnits))},
                                                footprints::kTileLevel));
    if (found != own.end()) found->second.include(geometry::box_of(c.blocks[b].polygon.outer.points));
  }
  Reaches reaches(inputs);
  AreaReach out;
  for (const auto& [tile, box] : own) out.emplace(tile, reaches.reach(tile, box));
  return out;
}

bool rules_ask_look(const districts::RuleSets& book) {
  for (const districts::RuleSet& set : book.sets)
    for (const districts::PlaceQuery& query : set.queries)
      if (query.kind == districts::PlaceQuery::Kind::near && importers::osm::tells_look(query.feature.key)) return true;
  return false;
}

double rules_reach(const districts::RuleSets& book) {
  double most = 0;
  for (const districts::RuleSet& set : book.sets)
    for (const districts::PlaceQuery& query : set.queries) most = std::max(most, query.distance);
  return std::min(most, districts::kMaxNear);  // what reaches further is told to areas
}

bool holds(const PlanBox& outer, const PlanBox& inner) {
  return inner.empty() || (!outer.empty() && outer.minimum.x <= inner.minimum.x && outer.minimum.y <= inner.minimum.y &&
                           outer.maximum.x >= inner.maximum.x && outer.maximum.y >= inner.maximum.y);
}

PlanBox common(const PlanBox& a, const PlanBox& b) {
  if (a.empty() || b.empty()) return {};
  PlanBox box;
  box.minimum = {std::max(a.minimum.x, b.minimum.x), std::max(a.minimum.y, b.minimum.y)};
  box.maximum = {std::min(a.maximum.x, b.maximum.x), std::min(a.maximum.y, b.maximum.y)};
  return box.minimum.y > box.maximum.y ? PlanBox() : box;
}

PlanBox needed_around(const TileReach& reach, double rules, bool other_network) {
  // Streets around blocks lie on their edge.
  constexpr double kAroundBlocks = 200;  // m
  // Rules look from the tile's own buildings, around which TileReach::near reaches at least so far (Reaches::reach).
  constexpr double kLeastNear = 3 * classify::kNearReach;  // m
  PlanBox out = reach.far.box;
  out.include(grown(reach.blocks, std::max(other_network ? kNetworkReach : kAroundBlocks, rules - kLeastNear)));
  return out;
}

PlanBox within_window(const std::array<double, 4>& window, const georef::Projection& projection) {
  const auto& [west, south, east, north] = window;
  constexpr double kFar = std::numeric_limits<double>::max();
  double x0 = -kFar, y0 = -kFar, x1 = kFar, y1 = kFar;
  constexpr int kSteps = 16;
  for (int i = 0; i <= kSteps; ++i) {
    const double lon = west + (east - west) * i / kSteps, lat = south + (north - south) * i / kSteps;
    x0 = std::max(x0, projection.forward(west, lat).x), x1 = std::min(x1, projection.forward(east, lat).x);
    y0 = std::max(y0, projection.forward(lon, south).y), y1 = std::min(y1, projection.forward(lon, north).y);
  }
  PlanBox box;
  box.minimum = {x0, y0}, box.maximum = {x1, y1};
  return box.minimum.y > box.maximum.y ? PlanBox() : box;
}

std::array<double, 4> window_around(const PlanBox& box, const georef::Projection& projection) {
  std::array<double, 4> out{180, 90, -180, -90};
  constexpr double kMargin = 50;  // m: sides are bent by less over some kilometres
  const PlanBox b = grown(box, kMargin);
  constexpr int kSteps = 8;
  for (int i = 0; i <= kSteps; ++i)
    for (int k = 0; k <= kSteps; ++k) {
      const georef::LonLat at = projection.inverse(Point2{b.minimum.x + (b.maximum.x - b.minimum.x) * i / kSteps,
                                                          b.minimum.y + (b.maximum.y - b.minimum.y) * k / kSteps});
      out = {std::min(out[0], at.lon), std::min(out[1], at.lat), std::max(out[2], at.lon), std::max(out[3], at.lat)};
    }
  return out;
}

PlanBox projected_box(const std::array<double, 4>& degrees, const georef::Projection& projection) {
  PlanBox box;
  constexpr int kSteps = 4;
  for (int i = 0; i <= kSteps; ++i)
    for (int k = 0; k <= kSteps; ++k) {
      const Point2 p = projection.forward(degrees[0] + (degrees[2] - degrees[0]) * i / kSteps,
                                          degrees[1] + (degrees[3] - degrees[1]) * k / kSteps);
      if (std::isfinite(p.x) && std::isfinite(p.y)) box.include(p);
    }
  return box;
}

}  // namespace blockrand::run
