#include "pipeline/run/tile_stages.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <utility>

#include "pipeline/attributes/resolve.h"
#include "pipeline/context/wall_segments.h"
#include "pipeline/facades/facades.h"
#include "pipeline/facades/requirements.h"
#include "pipeline/facades/roof_edges.h"
#include "pipeline/facades/roof_installations.h"
#include "pipeline/footprints/load.h"
#include "pipeline/footprints/repair/parts.h"
#include "pipeline/footprints/repair/rings.h"
#include "pipeline/masses/mass.h"
#include "pipeline/masses/part_overlaps.h"
#include "pipeline/observation/seen_roofs.h"

namespace blockrand::run {

namespace {

using model::Building;
using model::Region;

/// The rows of repair about one object, which came before the tile.
void copy_rows(const std::vector<model::ReportRow>& rows, model::OsmId id, model::Report& report) {
  const auto [first, last] = std::equal_range(rows.begin(), rows.end(), model::ReportRow{id, {}, {}},
                                              [](const auto& a, const auto& b) { return a.object < b.object; });
  report.rows.insert(report.rows.end(), first, last);
}

/// Buildings with their repaired outlines, parts and attributes. \param numbers  of the shard's seeds, in their order
Region prepare(const footprints::Shard& shard, std::span<const std::uint32_t> numbers, const TileInputs& in) {
  Region region = footprints::load_region(in.extract, shard, in.projection);
  for (const attributes::Material& m : in.defaults.materials) region.materials.push_back(m.material_class);
  for (std::size_t i = 0; i < region.buildings.size(); ++i) {
    Building& building = region.buildings[i];
    const footprints::StoredFootprint& stored = in.repaired.footprints[numbers[i]];
    std::vector<model::Polygon> before;
    if (building.has_mapped_parts && !building.rings.rings.empty()) {
      model::Report heard;
      before = repair::repair_rings(std::move(building.rings), building.osm, in.kept, in.repair, heard).polygons;
    }
    building.rings = {};
    building.outline = in.repaired.footprints.polygons(numbers[i]);
    building.arcs = in.repaired.footprints.arcs(numbers[i]);
    building.repaired = stored.record;
    building.failure = stored.failure;
    if (before.empty()) before = building.outline;
    copy_rows(in.repaired.rows, building.osm, region.report);
    building.settled = stored.settled;
    building.related = stored.related;
    if (building.settled != model::ObjectState::pending) {
      for (const model::BuildingPart& part : building.parts)
        if (part.mapped_index != building.mapped_index)
          region.settled_parts.push_back({part.mapped_index, building.settled, building.related});
      building.parts.clear();
      continue;
    }
    repair::fit_parts(building, before, in.kept, in.repair, region.part_failures, region.settled_parts, region.report);
  }
  in.roof_lines.fit(region);
  return region;
}

/// The tile's buildings with all attributes but those of their style; as well of neighbours beside it.
/// \param explain  what spoke for each style is kept
Region resolve_buildings(const footprints::Shard& shard, std::span<const std::uint32_t> numbers, const TileInputs& in,
                         bool explain) {
  const auto start = std::chrono::steady_clock::now();
  Region region = prepare(shard, numbers, in);
  in.vicinity.label_wall_segments(region, numbers);  // party walls turn ridges, and with them heights
  in.context_time += std::chrono::nanoseconds(std::chrono::steady_clock::now() - start).count();
  evidence::put_styles(region, numbers, in.styles, explain);
  if (in.imagery) observation::put_seen_roofs(region, numbers, *in.imagery);
  const auto presets = attributes::presets_with_measures(region, numbers, in.assigner);
  attributes::resolve_attributes(region,
                                 {.defaults = in.defaults,
                                  .neighbours = in.neighbours,
                                  .seed = in.seed,
                                  .ground = in.ground,
                                  .overrides = &in.overrides,
                                  .catalogue = &in.styles.tables.catalogue,
                                  .presets = presets},
                                 in.generate);
  return region;
}

/// m above the height reference up to which a building's outer walls reach.
double wall_top(const Building& building) {
  const model::Attributes& a = building.attributes;
  return a.ground_height.value + std::max(0.0, a.height.value - a.roof_height.value);
}

/// m: how much of a common wall two buildings cover for each other. On a slope neither begins where the other does.
double common_height(const Building& a, const Building& b) {
  const double base = std::max(a.attributes.ground_height.value, b.attributes.ground_height.value);
  return std::max(0.0, std::min(wall_top(a), wall_top(b)) - base);
}

/// Fills in what neighbours cover of party walls. Neighbours in other tiles are resolved again, from the same data.
void cover_party_walls(Region& region, const TileInputs& in) {
  std::set<model::OsmId> missing;
  const auto find = [](Region& r, model::OsmId id) -> const Building* {
    const auto place = std::lower_bound(r.buildings.begin(), r.buildings.end(), id,
                                        [](const Building& b, model::OsmId wanted) { return b.osm < wanted; });
    return place != r.buildings.end() && place->osm == id ? &*place : nullptr;
  };
  for (const Building& building : region.buildings)
    for (const model::WallSegment& edge : building.edges)
      if (edge.kind == model::WallSegmentKind::party_wall && edge.neighbour.number != 0 &&
          find(region, edge.neighbour) == nullptr)
        missing.insert(edge.neighbour);
  footprints::Shard beside;
  beside.tile = region.tile;
  std::vector<std::uint32_t> numbers;
  for (const model::OsmId id : missing) {
    const std::uint32_t number = in.numbers.find(id);
    if (number == model::kNoIndex) continue;
    const auto after = std::upper_bound(in.repaired.first.begin(), in.repaired.first.end(), number);
    const auto shard = static_cast<std::size_t>(after - in.repaired.first.begin()) - 1;
    beside.seeds.push_back(in.shards[shard].seeds[number - in.repaired.first[shard]]);
    numbers.push_back(number);
  }
  Region halo;
  if (!beside.seeds.empty()) halo = resolve_buildings(beside, numbers, in, false);
  for (Building& building : region.buildings)
    for (model::WallSegment& edge : building.edges) {
      if (edge.kind != model::WallSegmentKind::party_wall || edge.neighbour.number == 0) continue;
      const Building* other = find(region, edge.neighbour);
      if (other == nullptr) other = find(halo, edge.neighbour);
      if (other != nullptr) edge.covered_height = static_cast<float>(common_height(building, *other));
    }
}

}  // namespace

Region run_tile(std::size_t shard, const TileInputs& in) {
  std::vector<std::uint32_t> numbers(in.shards[shard].seeds.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = in.repaired.first[shard] + static_cast<std::uint32_t>(i);
  Region region = resolve_buildings(in.shards[shard], numbers, in, in.explain);
  evidence::put_style_attributes(region, numbers, in.styles);
  attributes::assign_region(region, numbers, in.assigner);
  attributes::mark_overrides(region, in.overrides, &in.styles.tables.catalogue);
  if (in.has_terrain)
    for (const Building& b : region.buildings)
      if (b.attributes.ground_height.source != model::Source::terrain)
        region.report.add(b.osm, model::IssueCode::terrain_missing);
  cover_party_walls(region, in);
  if (in.lod >= 2) masses::join_replaced(region, in.landmarks);
  masses::BuiltMasses built = masses::build_masses(region, in.defaults, in.generate, std::min(in.lod, 2));
  if (in.lod >= 2) masses::replace_buildings(region, in.landmarks);
  if (in.lod >= 3 && in.grammars) {
    facades::build_facades(region, *in.grammars, in.defaults, {in.seed}, &built);
    facades::add_roof_installations(region, built, in.defaults, {in.seed});
    facades::add_roof_edges(
        region, built, in.defaults, [&](const geometry::PlanBox& box, double distance, model::OsmId but) {
          std::vector<model::Polygon> outlines;
          for (const std::uint32_t number : in.vicinity.buildings_near(box, distance))
            if (in.repaired.footprints[number].id != but)
              std::ranges::move(in.repaired.footprints.polygons(number), std::back_inserter(outlines));
          return outlines;
        });
  }
  if (in.lod >= 3 && in.grammars) facades::check_requirements(region, built, in.assigner.book().presets);
  masses::tell_part_overlaps(region);
  return region;
}

}  // namespace blockrand::run
