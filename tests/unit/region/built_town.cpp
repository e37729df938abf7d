#include "tests/unit/region/built_town.h"

#include <algorithm>

#include "importers/osm/read_extract.h"
#include "pipeline/base/parallel.h"
#include "pipeline/context/blocks.h"
#include "pipeline/georef/crs.h"
#include "pipeline/region/area.h"
#include "pipeline/region/context_extract.h"
#include "pipeline/region/load.h"
#include "pipeline/region/surroundings.h"
#include "pipeline/region/tile_stages.h"

namespace blockrand::region::test {

namespace {

std::vector<Shard> shards_of(const model::Extract& extract) {
  model::Report report;
  return make_shards(extract, report);
}

georef::Projection projection_of(const model::Extract& extract) {
  const Area area = area_of(extract).value();
  return {georef::open_crs(georef::choose_crs(area.centre.lon, area.centre.lat), area.box), area.box};
}

}  // namespace

const generate::GenerateOptions& usual_generation() {
  static const generate::GenerateOptions options;
  return options;
}

struct BuiltTown::State {
  base::Progress progress;
  repair::RepairOptions repair;
  int workers = base::worker_count(0);
  model::Extract extract;
  georef::Projection projection;
  generate::Defaults defaults = generate::read_defaults(std::string(BLOCKRAND_SOURCE_DIR) + "/configs");
  std::vector<Shard> shards;
  repair::KeptNodes kept;
  RepairedExtract repaired;
  ContextExtract context;
  SurroundingsFinder surroundings;
  RoofLineFinder roof_lines;
  BuildingNumbers numbers;
  context::TaggedNeighbours neighbours;

  explicit State(const std::filesystem::path& file)
      : extract(importers::osm::read_extract(file.string())),
        projection(projection_of(extract)),
        shards(shards_of(extract)),
        kept(extract),
        repaired(repair_extract(extract, shards, projection, kept, repair, workers, progress)),
        context(context_extract(extract, repaired.footprints,
                                context::coverage_of(building_places(extract, projection)), projection, workers,
                                progress)),
        surroundings(extract, repaired.footprints, context),
        roof_lines(extract, projection),
        numbers(repaired.footprints),
        neighbours(tagged_buildings(extract, defaults, projection), usual_generation().neighbour_reach) {}
};

BuiltTown::BuiltTown(const std::filesystem::path& file) : state_(std::make_unique<State>(file)) {}
BuiltTown::~BuiltTown() = default;

const model::Extract& BuiltTown::extract() const { return state_->extract; }
const FootprintStore& BuiltTown::footprints() const { return state_->repaired.footprints; }
const georef::Projection& BuiltTown::projection() const { return state_->projection; }
const generate::Defaults& BuiltTown::defaults() const { return state_->defaults; }
const std::vector<Shard>& BuiltTown::shards() const { return state_->shards; }

std::size_t BuiltTown::shard_of(std::uint32_t building) const {
  const auto& first = state_->repaired.first;
  return static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), building) - first.begin()) - 1;
}

model::Region BuiltTown::tile(std::size_t shard, int lod) const {
  std::atomic<std::int64_t> time = 0;
  const State& s = *state_;
  return run_tile(shard, {.extract = s.extract,
                          .shards = s.shards,
                          .projection = s.projection,
                          .defaults = s.defaults,
                          .kept = s.kept,
                          .repaired = s.repaired,
                          .context = s.context,
                          .surroundings = s.surroundings,
                          .roof_lines = s.roof_lines,
                          .numbers = s.numbers,
                          .neighbours = s.neighbours,
                          .repair = s.repair,
                          .generate = usual_generation(),
                          .lod = lod,
                          .ground = [](const model::Building&) { return generate::BuildingGround{}; },
                          .context_time = time});
}

}  // namespace blockrand::region::test
