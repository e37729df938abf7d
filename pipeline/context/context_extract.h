// Context of a whole extract, after repair and before any tile runs: street network, blocks, courtyards, district cells.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/base/memo.h"
#include "pipeline/base/progress.h"
#include "pipeline/context/address_points.h"
#include "pipeline/context/block_figures.h"
#include "pipeline/context/blocks.h"
#include "pipeline/context/cells.h"
#include "pipeline/context/courtyards.h"
#include "pipeline/context/street_network.h"
#include "pipeline/footprints/footprint_store.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/extract.h"

namespace blockrand::context {

/// A courtyard with the numbers of its buildings.
struct ExtractCourtyard {
  std::uint32_t block = model::kNoIndex;  ///< where it lies in one that is whole and not too large
  context::Courtyard courtyard;           ///< `buildings` are numbers in the store
};

/// Read-only once made, safe to share between threads. Numbers of buildings are those of the FootprintStore.
struct ContextExtract {
  std::vector<context::NetworkLine> lines;
  std::vector<context::PassageWay> passages;
  std::vector<context::SitePoint> points;
  std::vector<context::Block> blocks;
  std::vector<context::BlockFigures> figures;  ///< parallel to blocks; without courtyards, which stand below
  std::vector<ExtractCourtyard> courtyards;    ///< by id
  std::vector<std::uint32_t> block_of;  ///< per building: the block it belongs to, or kNoIndex. Blocks that are too
                                        ///< large count as none: what reads a part of the extract cannot find them
  context::Cells cells;  ///< of what stands on the ground, as in blocks: no canopies, nothing that floats
  std::vector<model::Point2> coverage;  ///< as given: how much of a cell the data covers (context::covered_share)
};

/// \param coverage  of the extract (context::coverage_of), made once and pinned
/// \param use_of  what shops and amenities are (context::site_points)
/// \param memo  where figures of blocks of an earlier run are found again; null: none
/// Deterministic for any number of workers. The value of a block, a courtyard, a cell depends on data within
/// BlockOptions::max_extent of it, and on the repair of the buildings in it.
ContextExtract context_extract(const model::Extract& extract, const footprints::FootprintStore& footprints,
                               std::span<const model::Point2> coverage, const georef::Projection& projection,
                               int workers, base::Progress& progress, const context::UseOfTags& use_of = {},
                               const base::Memo* memo = nullptr);

/// The middle of the largest polygon of a building's outline, which must not be empty.
model::Point2 place_of(const footprints::FootprintStore& footprints, std::uint32_t building);
/// The district cell of a building: that of the largest polygon of its outline, which must not be empty.
context::CellIndex cell_of_building(const footprints::FootprintStore& footprints, std::uint32_t building);

}  // namespace blockrand::context
