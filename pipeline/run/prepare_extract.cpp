#include "pipeline/run/prepare_extract.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "importers/osm/read_extract.h"
#include "pipeline/base/error.h"
#include "pipeline/base/heap.h"
#include "pipeline/base/parallel.h"
#include "pipeline/evidence/region_priors.h"
#include "pipeline/footprints/load.h"
#include "pipeline/georef/tiles.h"

namespace blockrand::run {

namespace {

/// A coordinate system that was asked for may be made for another place: lengths and areas would be wrong, heights would not.
/// UTM stays within 0.001 in its zone.
constexpr double kToldScale = 0.002, kRefusedScale = 0.05;

void check_scale(const georef::Projection& projection, const georef::Crs& crs, georef::LonLat centre,
                 base::Progress& progress) {
  const double scale = projection.grid_scale(centre.lon, centre.lat), off = std::fabs(scale - 1);
  if (!(off > kToldScale)) return;
  const std::string what = fmt::format("{}: a metre here is {:.3f} m long in it", crs.authority_code, scale);
  const std::string better = georef::choose_crs(centre.lon, centre.lat);
  if (off > kRefusedScale)
    throw base::UsageError(
        fmt::format("{}, so that houses would be {:.0f} % too {} for their heights. Leave out --crs, or take {}", what,
                    100 * off, scale > 1 ? "wide" : "narrow", better));
  progress.warn(fmt::format("{}: lengths are {:.1f} % off. {} fits better", what, 100 * off, better));
}

/// Tiles without buildings between those that have some, as far as something is mapped in them: the surroundings need no house.
/// \param asked  the one tile that is built, which is there in any case
void add_empty_tiles(const LocatedExtract& located, const std::optional<TileChoice>& asked,
                     std::vector<footprints::Shard>& shards) {
  std::set<model::TileId> known;
  for (const footprints::Shard& shard : shards) known.insert(shard.tile);
  const auto add = [&](const model::TileId& tile) {
    if (known.insert(tile).second) shards.push_back({tile, {}});
  };
  if (asked && !asked->is_area()) {
    add(asked->id);
  } else if (asked) {
    const auto bounds = tiles_in(georef::bounds(asked->id), asked->tile_level);
    if (const std::optional<TileRange> range = common(asked->region, bounds))
      for (const model::TileId& tile : tiles_with_surroundings(located.extract, *range))
        if (georef::contains(asked->id, tile)) add(tile);
  } else if (located.area) {
    for (const model::TileId& tile :
         tiles_with_surroundings(located.extract, tiles_in(located.facts.box, footprints::kTileLevel)))
      add(tile);
  }
  std::ranges::sort(shards, {}, &footprints::Shard::tile);
}

}  // namespace

std::set<model::TileId> tiles_with_surroundings(const model::Extract& extract, const TileRange& range) {
  std::set<model::TileId> out;
  const int level = range.low.level;
  using enum model::FeatureKind;
  for (const model::Feature& feature : extract.features) {
    if (!feature.is(street) && !feature.is(land_use) && !feature.is(water) && !feature.is(railway) &&
        !feature.is(tree) && !feature.is(barrier) && !feature.is(surrounding))
      continue;
    for (const model::MappedRing& ring : extract.rings_of(feature.rings)) {
      // All tiles that the box of a segment meets.
      std::optional<model::TileId> before;
      for (const model::Location at : extract.vertices_of(ring)) {
        const model::TileId tile = georef::tile_of(at, level), from = before.value_or(tile);
        const auto [low_x, high_x] = std::minmax(from.x, tile.x);
        const auto [low_y, high_y] = std::minmax(from.y, tile.y);
        if (const auto both = common(range, {{level, low_x, low_y}, {level, high_x, high_y}}))
          for (std::uint32_t y = both->low.y; y <= both->high.y; ++y)
            for (std::uint32_t x = both->low.x; x <= both->high.x; ++x) out.insert({level, x, y});
        before = tile;
      }
    }
  }
  return out;
}

LocatedExtract locate_extract(const BuildOptions& options, const std::optional<TileChoice>& tile,
                              base::Progress& progress, const importers::osm::ExtractStore* store) {
  constexpr std::uint64_t kScale = 1000;
  progress.begin("read", kScale);
  importers::osm::ReadOptions read_options;
  // Of each pass the progress says half of what is left: how many there will be, nobody knows before.
  double done = 0, left = 1;
  std::string pass;
  read_options.progress = [&](std::string_view name, double fraction) {
    if (name != pass) {
      if (!pass.empty()) done += left / 2, left /= 2;
      pass = name;
    }
    progress.advance_to(static_cast<std::uint64_t>((done + fraction * left / 2) * static_cast<double>(kScale)));
  };
  read_options.surroundings = options.surroundings.any();
  read_options.bbox = tile ? tile->window : options.bbox;
  if (tile) read_options.parts = tile->parts, read_options.touching = true;
  model::Extract extract = store && tile ? store->read(read_options, tile->placeless)
                                         : importers::osm::read_extract(options.input, read_options);
  if (!options.input_told.empty()) extract.file = options.input_told;
  base::give_memory_back();  // libosmium's buffers go back to the system before tiles need the room

  progress.begin("locate");
  const std::optional<footprints::Area> area = footprints::area_of(extract);
  // An area of a region may have no building, but streets.
  if (!area && !(store && options.surroundings.any()))
    progress.warn(fmt::format("{}: no building with an outline{}; the outputs are valid but empty", told_input(options),
                              options.bbox || tile ? " in the given place" : ""));
  RegionFacts facts;
  if (tile) {
    facts = tile->facts;
  } else {
    if (area) facts = {"", area->box, area->centre, {}, {}, {}};
    // Nothing lies anywhere: PROJ could not say how good the asked one is there.
    facts.crs = options.crs.empty() || !area ? georef::choose_crs(facts.centre.lon, facts.centre.lat) : options.crs;
  }
  const georef::GeoBox box = facts.box;
  const georef::Crs crs = georef::open_crs(facts.crs, box);
  georef::Projection projection(crs, box);
  const georef::RoundTrip round_trip = georef::measure_round_trip(projection, box);
  if (!round_trip.ok())
    throw base::UsageError(fmt::format(
        "{}: positions do not come back within 1 mm here (error {:.4f} m, {} of {} sample points undefined). "
        "Choose another --crs, or leave it out",
        crs.authority_code, round_trip.projection_m, round_trip.undefined, round_trip.points));
  if (!options.crs.empty() && area) check_scale(projection, crs, facts.centre, progress);
  return {std::move(extract), area, std::move(facts), crs, round_trip, std::move(projection)};
}

PreparedExtract prepare_extract(LocatedExtract& located, const BuildOptions& options,
                                const std::optional<TileChoice>& tile, const classify::Tables& tables,
                                const districts::RuleSets& book, base::Progress& progress, const CorrectPlaces& correct,
                                const base::Memo* memo) {
  const int workers = base::worker_count(options.jobs);
  const model::Extract& extract = located.extract;
  model::Report report;
  std::vector<footprints::Shard> shards =
      footprints::make_shards(extract, report, tile ? tile->tile_level : footprints::kTileLevel);
  if (options.surroundings.any()) add_empty_tiles(located, tile, shards);
  repair::KeptNodes kept(extract);
  footprints::RepairedExtract repaired =
      footprints::repair_extract(extract, shards, located.projection, kept, options.repair, workers, progress, memo);
  base::give_memory_back();
  if (!tile) {
    const std::vector<model::Point2> places = footprints::building_places(extract, located.projection);
    located.facts.coverage = context::coverage_of(places);
  }
  if (correct && correct(shards, repaired)) {
    repaired =
        footprints::repair_extract(extract, shards, located.projection, kept, options.repair, workers, progress, memo);
    base::give_memory_back();
  }
  const context::UseOfTags use_of = [&](const std::function<std::string_view(std::string_view)>& tag) {
    const auto category = tables.ground_floor.category(tag);
    return category ? std::string_view(tables.ground_floor.categories[*category].name) : std::string_view();
  };
  context::ContextExtract context = context::context_extract(extract, repaired.footprints, located.facts.coverage,
                                                             located.projection, workers, progress, use_of, memo);
  base::give_memory_back();
  evidence::Needed needed;  // of a tile or an area: those around it matter as far as they are heard
  if (tile) {
    std::vector<std::uint32_t> asked;
    for (const std::size_t shard : shards_to_build(shards, tile))
      for (std::uint32_t i = 0; i < shards[shard].seeds.size(); ++i) asked.push_back(repaired.first[shard] + i);
    needed = evidence::needed_for(asked, repaired.footprints, context, tables);
  }
  std::unique_ptr<context::KeptLabels> labels = context::KeptLabels::of(repaired.footprints.size());
  evidence::FactsExtract facts =
      evidence::facts_extract(extract, repaired.footprints, repaired.first, context,
                              context::VicinityFinder(extract, repaired.footprints, context, labels.get(),
                                                      context::VicinityFinder::Labels::fill),
                              workers, progress, memo, needed);
  evidence::TagFacts tags =
      evidence::tag_facts(extract, repaired.footprints, context, tables, located.projection, facts);
  base::give_memory_back();
  evidence::StyleExtract styles = evidence::classify_extract(
      facts, tags, tables, evidence::prior_by_place(extract, repaired.footprints, book, tables), {}, workers, progress,
      needed);
  return {.shards = std::move(shards),
          .report = std::move(report),
          .kept = std::move(kept),
          .repaired = std::move(repaired),
          .context = std::move(context),
          .facts = std::move(facts),
          .tags = std::move(tags),
          .labels = std::move(labels),
          .styles = std::move(styles)};
}

}  // namespace blockrand::run
