// How far the work on a tile looked: which changes of a map can make it another one (ARCHITECTURE.md, law 4).
#pragma once

#include <array>
#include <functional>
#include <map>
#include <span>

#include "pipeline/geometry/box_index.h"
#include "pipeline/georef/projection.h"
#include "pipeline/run/plan_cells.h"
#include "pipeline/run/prepare_extract.h"
#include "pipeline/surroundings/surroundings.h"

namespace blockrand::run {

/// In the build CRS.
struct TileReach {
  CellRuns near;  ///< what is measured, classified and built there counts: its blocks, its rows, its features
  geometry::PlanBox blocks;  ///< m, around `near` and the blocks of the buildings there
  CellRuns far;   ///< and, where something asks for them, outlines of what stands in the district cells around
  CellRuns look;  ///< of values of tags that say how a building looks: storeys, roofs, years (ChangedObject::look_only)
  CellRuns
      around;  ///< of what stands around houses (ChangedObject::is_surrounding); `near` has it as well, and blocks that come there
};

/// Areas of a coarser level are looked into as a whole: what their tiles hear of would take more room than it is worth.
inline constexpr int kCoarsestReaches = 9;

using AreaReach = std::map<model::TileId, TileReach>;

/// m beyond TileReach::near that a street, a railway or a water can make itself felt: as far as a block reaches, and a row of houses more.
inline constexpr double kNetworkReach = 1100;

struct ReachInputs {
  const LocatedExtract& located;
  const PreparedExtract& prepared;
  const classify::Tables& tables;
  const districts::RuleSets& book;
  const TileChoice& area;
  double neighbour_reach = 0;                                ///< m, GenerateOptions
  const surroundings::SurroundingsFinder* around = nullptr;  ///< null: no surroundings
};

/// Of the wanted tiles of the area, with or without buildings.
/// \param tiles  in any order
AreaReach reaches_of(const ReachInputs& inputs, std::span<const model::TileId> tiles);

/// Whether a district rule asks for something near by what tags say of the look of buildings.
bool rules_ask_look(const districts::RuleSets& book);

/// m: how far district rules look at most for what is no building.
double rules_reach(const districts::RuleSets& book);

bool holds(const geometry::PlanBox& outer, const geometry::PlanBox& inner);
geometry::PlanBox common(const geometry::PlanBox& a, const geometry::PlanBox& b);

/// What must be read for the work on a tile with this reach. \param rules  m, how far district rules look at most
/// \param other_network  streets or the like changed there: blocks may reach further than before
geometry::PlanBox needed_around(const TileReach& reach, double rules, bool other_network);

/// The largest box in metres that lies within a window of degrees, about; empty where there is none.
geometry::PlanBox within_window(const std::array<double, 4>& window, const georef::Projection& projection);
/// The smallest window that holds the box, about, and a margin for what sides of windows are bent in the projection.
std::array<double, 4> window_around(const geometry::PlanBox& box, const georef::Projection& projection);
/// The box in metres around a box of degrees.
geometry::PlanBox projected_box(const std::array<double, 4>& degrees, const georef::Projection& projection);

}  // namespace blockrand::run
