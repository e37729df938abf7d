// Repair of a whole extract, before any tile runs: rings of each outline, then rows of neighbours together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/base/memo.h"
#include "pipeline/base/progress.h"
#include "pipeline/footprints/footprint_store.h"
#include "pipeline/footprints/repair/kept_nodes.h"
#include "pipeline/footprints/repair/options.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/extract.h"

namespace blockrand::footprints {

/// What repair did to all outlines together. Lengths in metres, areas in square metres.
struct RepairTotals {
  std::uint64_t outlines = 0;                          ///< with an area
  std::uint64_t rows = 0;                              ///< of two buildings and more
  std::uint64_t at_cuts = 0;                           ///< buildings that a cut parted from a neighbour (REACH_CUT)
  std::uint64_t vertices = 0, moved = 0;               ///< of all outlines
  double mean_shift = 0, max_shift = 0;                ///< m, of the moved vertices
  double median_area_change = 0, max_area_change = 0;  ///< of the mapped area, of those whose area changed
  std::uint64_t area_changed = 0;                      ///< outlines whose area changed by more than a thousandth
  std::uint64_t shared_walls = 0, gaps_closed = 0, overlaps_resolved = 0;  ///< each counted once
  double party_wall_length = 0;                                            ///< m, each wall once
  std::uint64_t squared = 0;                                               ///< outlines with a main direction
  std::uint64_t overlaps_left = 0;  ///< outlines with a reported overlap that stays
  std::uint64_t arcs = 0;
};

/// The repaired outlines. The number of a building is its place in the shards, in their order.
struct RepairedExtract {
  FootprintStore footprints;
  std::vector<std::uint32_t> first;       ///< per shard: the number of its first building
  std::vector<std::uint64_t> rows_begun;  ///< per shard: rows of two buildings and more whose least building is in it
  std::vector<PlanBox>
      row_boxes;  ///< per building: what its row and its place in it depend on; empty without an outline
  std::vector<model::ReportRow> rows;  ///< sorted by object
  RepairTotals totals;
};

/// What repair did to some of the outlines: without `rows` and `at_cuts`, which no outline tells.
RepairTotals totals_of(std::span<const StoredFootprint> outlines);

/// Repairs every outline of the shards. Deterministic for any number of workers. A building's outline depends on data
/// within kMaxTerraceRowExtent of its row (terrace_rows.h).
/// \param memo  where rings and rows of an earlier run are found again; null: none
RepairedExtract repair_extract(const model::Extract& extract, std::span<const Shard> shards,
                               const georef::Projection& projection, const repair::KeptNodes& kept,
                               const repair::RepairOptions& options, int workers, base::Progress& progress,
                               const base::Memo* memo = nullptr);

}  // namespace blockrand::footprints
