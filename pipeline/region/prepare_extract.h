// What is known of an extract before any tile runs: read, located, repaired, put into context, classified.
#pragma once

#include <optional>
#include <vector>

#include "pipeline/base/progress.h"
#include "pipeline/georef/crs.h"
#include "pipeline/georef/projection.h"
#include "pipeline/georef/round_trip.h"
#include "pipeline/model/extract.h"
#include "pipeline/region/area.h"
#include "pipeline/region/build.h"
#include "pipeline/region/building_facts.h"
#include "pipeline/region/classify_extract.h"
#include "pipeline/region/context_extract.h"
#include "pipeline/region/region_facts.h"
#include "pipeline/region/repair_extract.h"
#include "pipeline/region/shard.h"
#include "pipeline/region/tile_choice.h"
#include "pipeline/repair/kept_nodes.h"
#include "styles/districts/rule_set.h"

namespace blockrand::region {

/// An extract and where on Earth it lies.
struct LocatedExtract {
  model::Extract extract;
  std::optional<Area> area;  ///< empty: no building has an outline
  RegionFacts facts;         ///< without coverage, but for a tile alone
  georef::Crs crs;
  georef::RoundTrip round_trip;
  georef::Projection projection;
};

/// Reads the extract (of a tile alone: its window) and chooses its frame, or takes the pinned one.
/// \throws base::InputError  unreadable extract
/// \throws base::UsageError  a CRS that cannot be used here
LocatedExtract locate_extract(const BuildOptions& options, const std::optional<TileChoice>& tile,
                              base::Progress& progress);

/// What the stages before the tiles found. Keeps no reference to the extract but in `kept`.
struct PreparedExtract {
  std::vector<Shard> shards;
  model::Report report;  ///< of cutting into shards
  repair::KeptNodes kept;
  RepairedExtract repaired;
  ContextExtract context;
  FactsExtract facts;
  TagFacts tags;
  StyleExtract styles;
};

/// What may be assumed of the regions of a rule book's sets, parallel to them.
std::vector<classify::RegionPrior> region_priors(const styles::districts::RuleBook& book,
                                                 const classify::Tables& tables);

/// Classifies by what a rule book lets assume of its places; everything else that classification looks at is the same
/// for all books.
StyleExtract classify_by_book(const model::Extract& extract, const FootprintStore& footprints,
                              const FactsExtract& facts, const TagFacts& tags, const classify::Tables& tables,
                              const styles::districts::RuleBook& book, int workers, base::Progress& progress);

/// Cuts into shards, repairs, finds the context, measures, classifies; fills facts.coverage where no earlier build
/// pinned it. \param located  stays where it is while the result is used
PreparedExtract prepare_extract(LocatedExtract& located, const BuildOptions& options,
                                const std::optional<TileChoice>& tile, const classify::Tables& tables,
                                const styles::districts::RuleBook& book, base::Progress& progress);

}  // namespace blockrand::region
