#include "pipeline/run/area_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
    houses_ = footprints::index_of(store_);
    rows_ = geometry::BoxIndex(in_.prepared.repaired.row_boxes);
    std::vector<PlanBox> boxes;
    for (const context::Block& block : in_.prepared.context.blocks)
      boxes.push_back(block.too_large ? PlanBox() : geometry::box_of(block.polygon.outer.points));
    blocks_ = geometry::BoxIndex(std::move(boxes));
  }

  /// \param own  what lies in the tile, as mapped and as repaired
  TileReach reach(const PlanBox& own) const {
    const classify::Tables& tables = in_.tables;
    PlanBox styled = touched(with_blocks(own), kBeside);
    for (int round = 0; round < std::max(1, tables.smoothing.rounds); ++round)
      styled = touched(styled, classify::kNearReach);
    const double heard = std::max({classify::kNearReach, tables.era_votes.reach, tables.storeys_votes.reach,
                                   tables.roof_votes.reach, tables.non_houses.equal_radius});
    PlanBox measured = touched(styled, heard);
    measured.include(with_blocks(styled));
    TileReach reach;
    // Tagged neighbours speak for houses without tags. Features of a house read no tags but its own (features.h).
    reach.look = measured;
    reach.look.include(grown(own, in_.neighbour_reach));
    reach.look = with_rows(reach.look);
    // Features of houses: what stands around, and what that needs of its own surroundings.
    reach.near = with_blocks(touched(touched(measured, classify::kNearReach), context::kWallSegmentReach));
    reach.near.include(reach.look);
    reach.far = asks_town_ ? grown(measured, kTownReach) : measured;
    reach.far.include(reach.near);
    reach.near = with_rows(reach.near), reach.far = with_rows(reach.far);
    return reach;
  }

 private:
  /// What reaches out of a box crosses one of its sides.
  template <class Take>
  static void crossing(const geometry::BoxIndex& index, const PlanBox& box, const Take& take) {
    if (box.empty()) return;
    const auto [x0, y0] = box.minimum;
    const auto [x1, y1] = box.maximum;
    for (const auto& [from, to] :
         {std::pair(Point2{x0, y0}, Point2{x1, y0}), std::pair(Point2{x0, y1}, Point2{x1, y1}),
          std::pair(Point2{x0, y0}, Point2{x0, y1}), std::pair(Point2{x1, y0}, Point2{x1, y1})}) {
      PlanBox side;
      side.include(from), side.include(to);
      for (const std::uint32_t i : index.near(side, 0)) take(i);
    }
  }

  /// The box grown, and the buildings that are touched then.
  PlanBox touched(const PlanBox& box, double distance) const {
    const PlanBox around = grown(box, distance);
    PlanBox out = around;
    crossing(houses_, around, [&](std::uint32_t b) { out.include(store_[b].box); });
    return out;
  }
  /// And the blocks of its buildings.
  PlanBox with_blocks(const PlanBox& box) const {
    PlanBox out = box;
    crossing(blocks_, box, [&](std::uint32_t block) {
      const std::vector<std::uint32_t>& buildings = in_.prepared.context.figures[block].buildings;
      if (std::ranges::any_of(buildings, [&](std::uint32_t b) { return store_[b].box.near(box, 0); }))
        out.include(blocks_.box(block));
    });
    return out;
  }
  /// And their rows.
  PlanBox with_rows(const PlanBox& box) const {
    PlanBox out = box;
    crossing(rows_, box, [&](std::uint32_t b) {
      if (store_[b].box.near(box, 0)) out.include(rows_.box(b));
    });
    return out;
  }

  const ReachInputs& in_;
  const bool asks_town_ = classify::any_asks(in_.tables, "town") || in_.book.ask_cells();
  const footprints::FootprintStore& store_;
  geometry::BoxIndex houses_, rows_, blocks_;  ///< blocks: empty boxes for those that are too large
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
  const Reaches reaches(inputs);
  AreaReach out;
  for (const auto& [tile, box] : own) out.emplace(tile, reaches.reach(box));
  return out;
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

PlanBox needed_around(const TileReach& reach, double rules) {
  PlanBox out = reach.far;
  out.include(grown(reach.near, std::max(kNetworkReach, rules)));
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
