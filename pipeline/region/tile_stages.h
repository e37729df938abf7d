// The stages that run per tile: outlines and parts, edges, attributes, masses.
#pragma once

#include <cstddef>
#include <atomic>
#include <cstdint>
#include <functional>
#include <span>

#include "pipeline/context/tagged_neighbours.h"
#include "pipeline/generate/defaults.h"
#include "pipeline/generate/grammar_book.h"
#include "pipeline/generate/options.h"
#include "pipeline/generate/resolve.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/region.h"
#include "pipeline/region/assign_extract.h"
#include "pipeline/region/context_extract.h"
#include "pipeline/region/repair_extract.h"
#include "pipeline/region/roof_lines.h"
#include "pipeline/region/shard.h"
#include "pipeline/region/style_values.h"
#include "pipeline/region/surroundings.h"
#include "pipeline/repair/kept_nodes.h"
#include "pipeline/repair/options.h"

namespace blockrand::region {

/// Numbers of buildings (places in the shards) by OSM id.
class BuildingNumbers {
 public:
  explicit BuildingNumbers(const FootprintStore& store);
  /// kNoIndex where there is none.
  std::uint32_t find(model::OsmId id) const;

 private:
  std::vector<std::pair<model::OsmId, std::uint32_t>> numbers_;  ///< sorted
};

/// What all tiles read; outlives them, changes no more.
struct TileInputs {
  const model::Extract& extract;
  std::span<const Shard> shards;
  const georef::Projection& projection;
  const generate::Defaults& defaults;
  const repair::KeptNodes& kept;
  const RepairedExtract& repaired;
  const ContextExtract& context;
  const SurroundingsFinder& surroundings;
  const RoofLineFinder& roof_lines;
  const BuildingNumbers& numbers;
  const context::TaggedNeighbours& neighbours;
  const DistrictAssigner& assigner;
  const generate::Overrides& overrides;
  const StyleInputs& styles;
  bool explain = true;  ///< reasons are kept
  const repair::RepairOptions& repair;
  const generate::GenerateOptions& generate;
  std::uint64_t seed = 1;
  int lod = 2;
  const generate::GrammarBook* grammars = nullptr;  ///< of LoD3
  bool has_terrain = false;
  /// Ground under a building, above the build's height reference.
  std::function<generate::BuildingGround(const model::Building&)> ground;
  /// Nanoseconds, summed over all threads, that tiles spend on parts and facade edges: the rest of repair and context.
  std::atomic<std::int64_t>& context_time;
};

/// Everything about the buildings of a shard but its files. Safe for different shards at the same time.
model::Region run_tile(std::size_t shard, const TileInputs& inputs);

}  // namespace blockrand::region
