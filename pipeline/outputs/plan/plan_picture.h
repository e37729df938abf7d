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

/// What a sheet says of the build. It changes with the data, never with the clock.
struct PlanWords {
  std::string title;
  std::string about;  ///< one line: number of buildings, date, coordinate system
  std::string attribution, generator;
};

/// "1,234 buildings; data of 2020-01-05; ETRS89 / UTM zone 33N (EPSG:25833)".
/// \param data_time  ISO 8601; may be empty
std::string about_words(std::uint64_t buildings, std::string_view data_time, const georef::Crs& crs);

/// "Grid north is up; true north lies 0.9° to the left", at a place of the build.
std::string north_words(const georef::Projection& projection, model::Point2 place);

struct PlanSheet {
  std::string png;                   ///< the sheet as a file of its own, with title and legend; empty without buildings
  outputs::ReportPicture in_report;  ///< the map alone, smaller
  std::string note;                  ///< what the plan shows, where it is not the whole build; may be empty
};

/// Draws blocks, streets with their names, courtyards, buildings and their edges. A plan wider than 2 * kPlanReach shows the surroundings
/// of the middle of the densest tile only: on more, walls would be too thin to tell their colours.
/// \param tiles  the chosen ones, in tile order
/// \param projection  of the build: where true north lies
/// \param memo   where the sheet of an earlier run is found again; null: none
PlanSheet draw_plan(std::vector<picture::PlanTile> tiles, const context::ContextExtract& context,
                    const PlanChoice& choice, const georef::Projection& projection, const PlanWords& words,
                    const base::Memo* memo = nullptr);

}  // namespace blockrand::outputs
