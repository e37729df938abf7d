// The report's plan: the neighbourhood from above, each wall in the colour of what it faces.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/base/memo.h"
#include "pipeline/context/context_extract.h"
#include "pipeline/outputs/report/pictures.h"
#include "pipeline/outputs/report/report_facts.h"
#include "pipeline/picture/building_plan.h"

namespace blockrand::outputs {

inline constexpr double kPlanReach = 900;  ///< m

/// What the plan will show, decided before any tile runs, so that only those tiles keep their outlines.
struct PlanChoice {
  std::vector<bool> chosen;  ///< parallel to the shards
  bool whole = true;         ///< every tile is chosen
  model::Point2 middle;      ///< of the densest tile, m
};

/// Chooses every tile that may come into the plan around the densest one.
PlanChoice choose_plan(std::span<const footprints::Shard> shards, const georef::Projection& projection,
                       const PicturePlan& pictures);

struct PlanSheet {
  std::string png;                   ///< the sheet as a file of its own, to look at closely; empty without buildings
  outputs::ReportPicture in_report;  ///< the same, smaller
  std::string note;                  ///< what the plan shows, where it is not the whole build; may be empty
};

/// Draws blocks, streets, courtyards, buildings and their edges. A plan wider than 2 * kPlanReach shows the surroundings
/// of the middle of the densest tile only: on more, walls would be too thin to tell their colours.
/// \param tiles  the chosen ones, in tile order
/// \param memo   where the sheet of an earlier run is found again; null: none
PlanSheet draw_plan(std::vector<picture::PlanTile> tiles, const context::ContextExtract& context,
                    const PlanChoice& choice, const base::Memo* memo = nullptr);

}  // namespace blockrand::outputs
