// The stages that run per tile: outlines and parts, edges, attributes, masses.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "pipeline/attributes/assign_extract.h"
#include "pipeline/attributes/defaults.h"
#include "pipeline/attributes/options.h"
#include "pipeline/attributes/resolve.h"
#include "pipeline/context/context_extract.h"
#include "pipeline/context/tagged_neighbours.h"
#include "pipeline/context/vicinity_finder.h"
#include "pipeline/evidence/style_values.h"
#include "pipeline/facades/grammar_library.h"
#include "pipeline/footprints/repair/kept_nodes.h"
#include "pipeline/footprints/repair/options.h"
#include "pipeline/footprints/repair_extract.h"
#include "pipeline/footprints/roof_lines.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/georef/projection.h"
#include "pipeline/masses/replace_buildings.h"
#include "pipeline/model/region.h"
#include "pipeline/observation/imagery.h"

namespace blockrand::run {

/// What all tiles read; outlives them, changes no more.
struct TileInputs {
  const model::Extract& extract;
  std::span<const footprints::Shard> shards;
  const georef::Projection& projection;
  const attributes::Defaults& defaults;
  const repair::KeptNodes& kept;
  const footprints::RepairedExtract& repaired;
  const context::ContextExtract& context;
  const context::VicinityFinder& vicinity;
  const footprints::RoofLineFinder& roof_lines;
  const footprints::BuildingNumbers& numbers;
  const context::TaggedNeighbours& neighbours;
  const attributes::DistrictAssigner& assigner;
  const attributes::Overrides& overrides;
  const masses::LandmarkModels& landmarks;
  const evidence::StyleInputs& styles;
  const observation::ImageryObservations* imagery = nullptr;  ///< null: no images
  bool explain = true;                                        ///< reasons are kept
  const repair::RepairOptions& repair;
  const attributes::GenerateOptions& generate;
  std::uint64_t seed = 1;
  int lod = 2;
  const facades::GrammarLibrary* grammars = nullptr;  ///< of LoD3
  bool has_terrain = false;
  /// Ground under a building, above the build's height reference.
  std::function<context::BuildingGround(const model::Building&)> ground;
  /// Nanoseconds, summed over all threads, that tiles spend on parts and facade edges: the rest of repair and context.
  std::atomic<std::int64_t>& context_time;
};

/// Everything about the buildings of a shard but its files. Safe for different shards at the same time.
model::Region run_tile(std::size_t shard, const TileInputs& inputs);

}  // namespace blockrand::run
