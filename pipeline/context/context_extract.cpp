#include "pipeline/context/context_extract.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "pipeline/base/memo.h"
#include "pipeline/base/parallel.h"
#include "pipeline/footprints/terrace_rows.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::context {

namespace {

using context::Block;
using context::BlockFigures;
using context::Courtyard;
using context::Footprint;
using context::NetworkLine;
using model::Extract;
using model::Point2;

/// m. Blocks are measured in batches of a square of this size: some hundred buildings.
constexpr double kBatchCell = 1000;
/// m beyond a block's box: buildings that reach into it from outside do so with their boxes.
constexpr double kBeside = 1;

std::optional<double> tagged_storeys(const Extract& extract, const footprints::StoredFootprint& f) {
  const auto& storeys = extract.buildings[f.lead].attributes.storeys;
  return storeys ? std::optional<double>(static_cast<double>(*storeys)) : std::nullopt;
}

/// Canopies are no built land: one walks below them.
bool is_built_land(const footprints::StoredFootprint& f) {
  return !f.box.empty() && !f.level.canopy && f.level.low <= 0;
}

void append_footprints(const Extract& extract, const footprints::FootprintStore& store, std::uint32_t building,
                       std::vector<Footprint>& out, std::vector<std::uint32_t>& numbers) {
  for (model::Polygon& polygon : store.polygons(building)) {
    out.push_back({store[building].id, std::move(polygon), tagged_storeys(extract, store[building]),
                   store[building].level.canopy});
    numbers.push_back(building);
  }
}

/// Numbers of buildings for indices of footprints, each once, ascending.
void renumber(std::vector<std::uint32_t>& indices, const std::vector<std::uint32_t>& numbers) {
  for (std::uint32_t& i : indices) i = numbers[i];
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

/// Figures of all blocks, batch by batch.
void measure_all(const Extract& extract, const footprints::FootprintStore& store, const geometry::BoxIndex& index,
                 const geometry::BoxIndex& lines, int workers, const base::Memo* memo, ContextExtract& out) {
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::uint32_t>> cells;
  std::vector<geometry::PlanBox> boxes;
  for (std::uint32_t b = 0; b < out.blocks.size(); ++b) {
    boxes.push_back(geometry::box_of(out.blocks[b].polygon.outer.points));
    if (out.blocks[b].too_large) continue;
    const Point2 c = boxes.back().centre();
    cells[{static_cast<std::int64_t>(std::floor(c.x / kBatchCell)),
           static_cast<std::int64_t>(std::floor(c.y / kBatchCell))}]
        .push_back(b);
  }
  std::vector<std::vector<std::uint32_t>> batches;
  for (auto& [cell, blocks] : cells) batches.push_back(std::move(blocks));

  out.figures.resize(out.blocks.size());
  const std::size_t in_flight = static_cast<std::size_t>(workers) * 2 + 2;
  std::vector<std::vector<BlockFigures>> slots(in_flight);
  const auto work = [&](std::size_t i) {
    std::vector<Block> blocks;
    geometry::PlanBox box;
    for (const std::uint32_t b : batches[i]) {
      blocks.push_back(out.blocks[b]);
      for (BlockBorder& border : blocks.back().borders) border.line = 0;  // numbers lines in this run
      box.include(boxes[b]);
    }
    std::vector<Footprint> footprints;
    std::vector<std::uint32_t> numbers;
    for (const std::uint32_t b : index.near(box, kBeside))
      if (is_built_land(store[b])) append_footprints(extract, store, b, footprints, numbers);
    std::vector<NetworkLine> near;
    for (const std::uint32_t l : lines.near(box, kBeside)) near.push_back(out.lines[l]);
    auto figures = base::remembered<std::vector<BlockFigures>>(
        memo, "blocks", [&](base::Packer& packer) { packer << blocks << footprints << near; },
        [&] { return context::measure_blocks(blocks, footprints, near); });
    for (BlockFigures& f : figures) {
      for (Courtyard& yard : f.courtyards) renumber(yard.buildings, numbers);
      renumber(f.buildings, numbers);
    }
    slots[i % in_flight] = std::move(figures);
  };
  const auto consume = [&](std::size_t i) {
    std::vector<BlockFigures> figures = std::move(slots[i % in_flight]);
    for (std::size_t k = 0; k < batches[i].size(); ++k) {
      const std::uint32_t b = batches[i][k];
      for (Courtyard& yard : figures[k].courtyards) out.courtyards.push_back({b, std::move(yard)});
      figures[k].courtyards.clear();
      for (const std::uint32_t building : figures[k].buildings) out.block_of[building] = b;
      out.figures[b] = std::move(figures[k]);
    }
  };
  base::ordered_parallel(batches.size(), workers, in_flight, work, consume);
}

/// Courtyards among buildings in no block: at the rim of the data, in the open country. Groups of buildings around one
/// courtyard are no farther from each other than its widest opening. A building of several polygons may belong to no block
/// while its polygons stand in some: what blocks have found there is not found again.
void find_loose_courtyards(const Extract& extract, const footprints::FootprintStore& store,
                           const geometry::BoxIndex& lines, int workers, ContextExtract& out) {
  footprints::FootprintStore loose(store.size());
  for (std::uint32_t b = 0; b < store.size(); ++b)
    if (out.block_of[b] == model::kNoIndex && is_built_land(store[b])) loose.set(b, store[b], store.polygons(b));
  std::vector<footprints::TerraceRowPlan> groups =
      footprints::find_terrace_rows(loose, context::CourtyardOptions{}.max_opening);
  // A single building has courtyards, too.
  const std::size_t in_flight = static_cast<std::size_t>(workers) * 64;
  std::vector<std::vector<Courtyard>> slots(in_flight);
  const auto work = [&](std::size_t i) {
    std::vector<Footprint> footprints;
    std::vector<std::uint32_t> numbers;
    geometry::PlanBox box;
    for (const std::uint32_t b : groups[i].buildings) {
      append_footprints(extract, store, b, footprints, numbers);
      box.include(store[b].box);
    }
    // A convex plan without a hole encloses nothing.
    if (footprints.size() == 1 && footprints.front().polygon.holes.empty() &&
        footprints.front().polygon.outer.size() <= 4) {
      slots[i % in_flight].clear();
      return;
    }
    std::vector<context::Polyline> streets;
    for (const std::uint32_t l : lines.near(box, kBeside))
      if (context::is_street(out.lines[l].kind) && !out.lines[l].tunnel) streets.push_back(out.lines[l].points);
    std::vector<Courtyard> yards = context::find_courtyards(footprints, streets);
    for (Courtyard& yard : yards) renumber(yard.buildings, numbers);
    slots[i % in_flight] = std::move(yards);
  };
  std::set<std::string> known;
  for (const ExtractCourtyard& yard : out.courtyards) known.insert(yard.courtyard.id);
  const auto consume = [&](std::size_t i) {
    for (Courtyard& yard : slots[i % in_flight])
      if (!known.contains(yard.id)) out.courtyards.push_back({model::kNoIndex, std::move(yard)});
    slots[i % in_flight].clear();
  };
  base::ordered_parallel(groups.size(), workers, in_flight, work, consume);
}

/// Of the largest polygon.
Point2 place_of(const std::vector<model::Polygon>& polygons) {
  const auto largest = std::max_element(polygons.begin(), polygons.end(), [](const auto& a, const auto& b) {
    return geometry::area(a) < geometry::area(b);
  });
  return context::cell_place(*largest);
}

context::Cells district_cells(const Extract& extract, const footprints::FootprintStore& store) {
  std::vector<context::CellBuilding> buildings;
  for (std::uint32_t b = 0; b < store.size(); ++b) {
    const footprints::StoredFootprint& f = store[b];
    if (!is_built_land(f)) continue;
    context::CellBuilding c;
    const std::vector<model::Polygon> polygons = store.polygons(b);
    for (const model::Polygon& polygon : polygons) {
      c.area += geometry::area(polygon);
      c.wall_length += geometry::perimeter(polygon);
    }
    c.place = place_of(polygons);
    c.party_wall_length = f.party_wall_length;
    c.storeys = tagged_storeys(extract, f);
    if (const auto& built = extract.buildings[f.lead].attributes.built) c.year = built->years.middle();
    buildings.push_back(c);
  }
  return context::cells_of(buildings);
}

}  // namespace

Point2 place_of(const footprints::FootprintStore& footprints, std::uint32_t building) {
  return place_of(footprints.polygons(building));
}

context::CellIndex cell_of_building(const footprints::FootprintStore& footprints, std::uint32_t building) {
  return context::cell_of(place_of(footprints, building));
}

ContextExtract context_extract(const Extract& extract, const footprints::FootprintStore& footprints,
                               std::span<const Point2> coverage, const georef::Projection& projection, int workers,
                               base::Progress& progress, const context::UseOfTags& use_of, const base::Memo* memo) {
  progress.begin("context", 4);
  ContextExtract out;
  const context::Project project = [&](model::Location l) { return projection.forward(l); };
  out.lines = context::network_lines(extract, project);
  out.passages = context::passage_ways(extract, project);
  out.points = context::site_points(extract, project, use_of);
  out.blocks = context::find_blocks(out.lines, coverage);
  progress.advance_to(1);
  out.block_of.assign(footprints.size(), model::kNoIndex);
  std::vector<geometry::PlanBox> line_boxes;
  for (const NetworkLine& line : out.lines) line_boxes.push_back(geometry::box_of(line.points));
  const geometry::BoxIndex lines(std::move(line_boxes));
  const geometry::BoxIndex index = footprints::index_of(footprints);
  measure_all(extract, footprints, index, lines, workers, memo, out);
  progress.advance_to(3);
  find_loose_courtyards(extract, footprints, lines, workers, out);
  // A building that stands in two blocks has its courtyards in both: the one of the lower id keeps them.
  const auto key = [&](const ExtractCourtyard& yard) {
    const bool in_block = yard.block != model::kNoIndex;
    return std::tuple(std::string_view(yard.courtyard.id), !in_block,
                      in_block ? std::string_view(out.blocks[yard.block].id) : std::string_view());
  };
  std::sort(out.courtyards.begin(), out.courtyards.end(),
            [&](const ExtractCourtyard& a, const ExtractCourtyard& b) { return key(a) < key(b); });
  const auto last = std::unique(
      out.courtyards.begin(), out.courtyards.end(),
      [](const ExtractCourtyard& a, const ExtractCourtyard& b) { return a.courtyard.id == b.courtyard.id; });
  out.courtyards.erase(last, out.courtyards.end());
  out.cells = district_cells(extract, footprints);
  out.coverage.assign(coverage.begin(), coverage.end());
  return out;
}

}  // namespace blockrand::context
