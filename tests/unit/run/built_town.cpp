#include "tests/unit/run/built_town.h"

#include <algorithm>
#include <optional>

#include "importers/osm/read_extract.h"
#include "pipeline/attributes/assign_extract.h"
#include "pipeline/attributes/rule_sets.h"
#include "pipeline/attributes/tagged_buildings.h"
#include "pipeline/base/parallel.h"
#include "pipeline/context/blocks.h"
#include "pipeline/context/context_extract.h"
#include "pipeline/context/vicinity_finder.h"
#include "pipeline/evidence/classify_extract.h"
#include "pipeline/evidence/region_priors.h"
#include "pipeline/evidence/style_values.h"
#include "pipeline/footprints/area.h"
#include "pipeline/footprints/load.h"
#include "pipeline/georef/crs.h"
#include "pipeline/run/prepare_extract.h"
#include "pipeline/run/tile_stages.h"

namespace blockrand::run::test {

namespace {

std::vector<footprints::Shard> shards_of(const model::Extract& extract) {
  model::Report report;
  return footprints::make_shards(extract, report);
}

georef::Projection projection_of(const model::Extract& extract) {
  const footprints::Area area = footprints::area_of(extract).value();
  return {georef::open_crs(georef::choose_crs(area.centre.lon, area.centre.lat), area.box), area.box};
}

}  // namespace

const attributes::GenerateOptions& usual_generation() {
  static const attributes::GenerateOptions options;
  return options;
}

struct BuiltTown::State {
  base::Progress progress;
  repair::RepairOptions repair;
  int workers = base::worker_count(0);
  model::Extract extract;
  georef::Projection projection;
  attributes::Defaults defaults = attributes::read_defaults(std::string(BLOCKRAND_SOURCE_DIR) + "/configs");
  std::vector<footprints::Shard> shards;
  repair::KeptNodes kept;
  footprints::RepairedExtract repaired;
  context::ContextExtract context;
  context::VicinityFinder vicinity;
  footprints::RoofLineFinder roof_lines;
  footprints::BuildingNumbers numbers;
  context::TaggedNeighbours neighbours;
  classify::Tables tables = classify::Tables::read(std::string(BLOCKRAND_SOURCE_DIR) + "/configs");
  attributes::ReadRuleSets rules = attributes::read_rule_sets(std::string(BLOCKRAND_SOURCE_DIR) + "/configs", "");
  attributes::Overrides overrides;
  masses::LandmarkModels landmarks;
  evidence::FactsExtract facts;
  evidence::TagFacts tags;
  evidence::StyleExtract style_extract;
  evidence::StyleInputs style_inputs{facts, tags, style_extract, tables};
  std::optional<attributes::DistrictAssigner> assigner;

  explicit State(const std::filesystem::path& file)
      : extract(importers::osm::read_extract(file.string())),
        projection(projection_of(extract)),
        shards(shards_of(extract)),
        kept(extract),
        repaired(footprints::repair_extract(extract, shards, projection, kept, repair, workers, progress)),
        context(context::context_extract(extract, repaired.footprints,
                                         context::coverage_of(footprints::building_places(extract, projection)),
                                         projection, workers, progress)),
        vicinity(extract, repaired.footprints, context),
        roof_lines(extract, projection),
        numbers(repaired.footprints),
        neighbours(attributes::tagged_buildings(extract, defaults, projection), usual_generation().neighbour_reach),
        facts(evidence::facts_extract(extract, repaired.footprints, repaired.first, context, vicinity, workers,
                                      progress)),
        tags(evidence::tag_facts(extract, repaired.footprints, context, tables, projection, facts)),
        style_extract(classified()) {
    assigner.emplace(rules.book, attributes::AssignInputs{.extract = extract,
                                                          .footprints = repaired.footprints,
                                                          .context = context,
                                                          .styles = style_extract,
                                                          .projection = projection,
                                                          .defaults = defaults,
                                                          .neighbours = neighbours,
                                                          .overrides = &overrides,
                                                          .pinned = {}});
  }

  /// With the priors of its region, as a build does.
  evidence::StyleExtract classified() {
    return evidence::classify_extract(facts, tags, tables,
                                      evidence::prior_by_place(extract, repaired.footprints, rules.book, tables), {},
                                      workers, progress);
  }
};

BuiltTown::BuiltTown(const std::filesystem::path& file) : state_(std::make_unique<State>(file)) {}
BuiltTown::~BuiltTown() = default;

const model::Extract& BuiltTown::extract() const { return state_->extract; }
const footprints::FootprintStore& BuiltTown::footprints() const { return state_->repaired.footprints; }
const georef::Projection& BuiltTown::projection() const { return state_->projection; }
const attributes::Defaults& BuiltTown::defaults() const { return state_->defaults; }
const std::vector<footprints::Shard>& BuiltTown::shards() const { return state_->shards; }

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
                          .vicinity = s.vicinity,
                          .roof_lines = s.roof_lines,
                          .numbers = s.numbers,
                          .neighbours = s.neighbours,
                          .assigner = *s.assigner,
                          .overrides = s.overrides,
                          .landmarks = s.landmarks,
                          .styles = s.style_inputs,
                          .repair = s.repair,
                          .generate = usual_generation(),
                          .lod = lod,
                          .ground = [](const model::Building&) { return context::BuildingGround{}; },
                          .context_time = time});
}

}  // namespace blockrand::run::test
