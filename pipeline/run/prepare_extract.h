// What is known of an extract before any tile runs: read, located, repaired, put into context, classified.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "importers/osm/extract_store.h"
#include "pipeline/base/memo.h"
#include "pipeline/base/progress.h"
#include "pipeline/context/context_extract.h"
#include "pipeline/context/vicinity_finder.h"
#include "pipeline/evidence/building_facts.h"
#include "pipeline/evidence/classify_extract.h"
#include "pipeline/footprints/area.h"
#include "pipeline/footprints/repair/kept_nodes.h"
#include "pipeline/footprints/repair_extract.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/georef/crs.h"
#include "pipeline/georef/projection.h"
#include "pipeline/georef/round_trip.h"
#include "pipeline/model/extract.h"
#include "pipeline/run/build.h"
#include "pipeline/run/region_facts.h"
#include "pipeline/run/tile_choice.h"
#include "styles/districts/rule_set.h"

namespace blockrand::run {

/// An extract and where on Earth it lies.
struct LocatedExtract {
  model::Extract extract;
  std::optional<footprints::Area> area;  ///< empty: no building has an outline
  RegionFacts facts;                     ///< without coverage, but for a tile alone
  georef::Crs crs;
  georef::RoundTrip round_trip;
  georef::Projection projection;
};

/// Reads the extract (of a tile alone: its window) and chooses its frame, or takes the pinned one.
/// \throws base::InputError  unreadable extract
/// \throws base::UsageError  a CRS that cannot be used here
/// \param store  where an area is read from; null: from the input
LocatedExtract locate_extract(const BuildOptions& options, const std::optional<TileChoice>& tile,
                              base::Progress& progress, const importers::osm::ExtractStore* store = nullptr);

/// Tiles of a range into which something comes that surroundings of houses are made of.
std::set<model::TileId> tiles_with_surroundings(const model::Extract& extract, const TileRange& range);

/// What the stages before the tiles found. Keeps no reference to the extract but in `kept`.
struct PreparedExtract {
  std::vector<footprints::Shard> shards;
  model::Report report;  ///< of cutting into shards
  repair::KeptNodes kept;
  footprints::RepairedExtract repaired;
  context::ContextExtract context;
  evidence::FactsExtract facts;
  evidence::TagFacts tags;
  std::unique_ptr<context::KeptLabels> labels;  ///< of quarters; null: tiles look at walls themselves
  evidence::StyleExtract styles;
};

/// Asked when all outlines are repaired. \returns  whether it moved buildings of the extract: they are repaired again
using CorrectPlaces = std::function<bool(std::span<const footprints::Shard>, const footprints::RepairedExtract&)>;

/// Cuts into shards, repairs, finds the context, measures, classifies; fills facts.coverage where no earlier build
/// pinned it. Tiles and coverage are those of the extract as mapped. \param located  stays where it is while the result is used
/// \param memo  what an earlier run left; null: nothing
PreparedExtract prepare_extract(LocatedExtract& located, const BuildOptions& options,
                                const std::optional<TileChoice>& tile, const classify::Tables& tables,
                                const districts::RuleSets& book, base::Progress& progress,
                                const CorrectPlaces& correct = {}, const base::Memo* memo = nullptr);

}  // namespace blockrand::run
