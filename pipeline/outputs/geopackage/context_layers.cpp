#include "pipeline/outputs/geopackage/context_layers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/outputs/buildings_here.h"

namespace blockrand::outputs {

namespace {

/// Names of the streets around a block, unnamed ones by their ids.
std::vector<std::string> streets_around(const context::Block& block, const std::vector<context::NetworkLine>& lines) {
  std::set<std::string> names;
  for (const context::BlockBorder& border : block.borders) {
    const context::NetworkLine& line = lines[border.line];
    if (context::is_street(line.kind)) names.insert(line.name.empty() ? line.id.text() : line.name);
  }
  return {names.begin(), names.end()};
}

outputs::BlockRow block_row(const context::Block& block, const context::BlockFigures& figures,
                            const std::vector<context::NetworkLine>& lines, std::int64_t courtyards) {
  outputs::BlockRow row;
  row.id = block.id;
  row.polygon = block.polygon;
  row.area = block.area;
  row.kind = context::kBlockKindNames[static_cast<std::size_t>(block.kind)];
  row.cut_by_extract_edge = block.cut_by_extract_edge;
  row.too_large = block.too_large;
  row.buildings = static_cast<std::int64_t>(figures.buildings.size());
  row.built_share = figures.built_share;
  row.tagged_share = figures.tagged_share;
  row.floor_area_ratio = figures.floor_area_ratio;
  row.closure = figures.closure;
  row.front_length = figures.front_length;
  row.courtyard_area = figures.courtyard_area;
  row.courtyards = courtyards;
  row.streets = streets_around(block, lines);
  return row;
}

outputs::CellRow cell_row(const context::CellIndex& cell, const context::CellSums& sums, double covered_share) {
  const context::CellFigures f = context::figures_of(sums, covered_share);
  outputs::CellRow row;
  row.id = cell.id();
  row.corner = cell.corner();
  row.size = context::kCellSize;
  row.buildings = f.buildings;
  row.covered_share = f.covered_share;
  row.density = f.density;
  row.built_share = f.built_share;
  row.tagged_share = f.tagged_share;
  row.storeys_mean = f.storeys_mean;
  row.storeys_spread = f.storeys_spread;
  row.floor_area_ratio = f.floor_area_ratio;
  row.party_wall_share = f.party_wall_share;
  row.dated_share = f.dated_share;
  row.year_mean = f.year_mean;
  row.year_spread = f.year_spread;
  row.footprint_quartile = f.footprint_quartile;
  row.footprint_median = f.footprint_median;
  row.footprint_upper_quartile = f.footprint_upper_quartile;
  return row;
}

}  // namespace

void write_context_layers(outputs::GeoPackageWriter& out, const context::ContextExtract& context,
                          const footprints::RepairedExtract& repaired, std::span<const footprints::Shard> shards,
                          const std::optional<model::TileId>& tile, const georef::Projection& projection) {
  const footprints::FootprintStore& store = repaired.footprints;
  const std::vector<bool> here = buildings_here(repaired, shards, tile);
  const auto any_here = [&](const std::vector<std::uint32_t>& buildings) {
    return !tile || std::any_of(buildings.begin(), buildings.end(), [&](std::uint32_t b) { return here[b]; });
  };
  std::map<std::uint32_t, std::int64_t> courtyards;
  std::set<std::uint32_t> named;  // blocks, by rows of courtyards and buildings
  for (std::uint32_t b = 0; b < store.size(); ++b)
    if (here[b] && context.block_of[b] != model::kNoIndex) named.insert(context.block_of[b]);
  for (const context::ExtractCourtyard& yard : context.courtyards) {
    ++courtyards[yard.block];
    if (any_here(yard.courtyard.buildings)) named.insert(yard.block);
  }
  const auto is_empty_and_here = [&](std::uint32_t b) {
    if (!tile || !context.figures[b].buildings.empty()) return false;
    const georef::LonLat corner = projection.inverse(context.blocks[b].polygon.outer.points.front());
    constexpr double kUnits = 1e7;
    return georef::tile_of({static_cast<std::int32_t>(std::lround(corner.lon * kUnits)),
                            static_cast<std::int32_t>(std::lround(corner.lat * kUnits))},
                           tile->level) == *tile;
  };
  for (std::uint32_t b = 0; b < context.blocks.size(); ++b)
    if (any_here(context.figures[b].buildings) || named.contains(b) || is_empty_and_here(b))
      out.add_block(block_row(context.blocks[b], context.figures[b], context.lines, courtyards[b]));
  for (const context::ExtractCourtyard& yard : context.courtyards) {
    if (!any_here(yard.courtyard.buildings)) continue;
    outputs::CourtyardRow row;
    row.id = yard.courtyard.id;
    if (yard.block != model::kNoIndex) row.block = context.blocks[yard.block].id;
    row.polygon = yard.courtyard.polygon;
    row.area = yard.courtyard.area;
    row.closed = yard.courtyard.closed;
    row.opening = yard.courtyard.opening;
    for (const std::uint32_t b : yard.courtyard.buildings) row.buildings.push_back(store[b].id);
    std::sort(row.buildings.begin(), row.buildings.end());
    out.add_courtyard(row);
  }
  std::set<context::CellIndex> cells;
  if (tile)
    for (std::uint32_t b = 0; b < store.size(); ++b)
      if (here[b] && !store[b].box.empty()) cells.insert(context::cell_of_building(store, b));
  for (const auto& [cell, sums] : context.cells)
    if (!tile || cells.contains(cell))
      out.add_cell(cell_row(cell, sums, context::covered_share(cell, context.coverage)));
}

void write_image_layer(GeoPackageWriter& out, const observation::ImageryObservations& seen,
                       const footprints::RepairedExtract& repaired, std::span<const footprints::Shard> shards,
                       const std::optional<model::TileId>& tile) {
  const std::vector<bool> here = buildings_here(repaired, shards, tile);
  auto before = seen.before.begin();
  for (std::uint32_t b = 0; b < seen.outlines.size(); ++b) {
    while (before != seen.before.end() && before->first < b) ++before;
    const observation::OutlineReceipt& receipt = seen.outlines[b];
    if (!here[b] || receipt.image >= seen.images.size()) continue;
    const bool moved = before != seen.before.end() && before->first == b;
    const SeenOutline outline{receipt, seen.images[receipt.image], seen.applied};
    out.add_footprint_before(
        {outline, repaired.footprints[b].id, moved ? before->second : repaired.footprints.polygons(b)});
  }
  for (const observation::UnmappedBuilding& u : seen.unmapped) out.add_unmapped({u, seen.images[u.image]});
}

}  // namespace blockrand::outputs
