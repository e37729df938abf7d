// Dormers and cross gables of LoD3: what the rules of a preset order, put on the roof that LoD2 has, and the fronts that get
// windows.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/masses/built_mass.h"
#include "pipeline/model/building.h"
#include "styles/grammar/language/value.h"
#include "styles/roofs/cross_gables.h"
#include "styles/roofs/dormers.h"
#include "styles/roofs/gables.h"

namespace blockrand::facades {

/// m. Farther out no eaves or verge can be ordered: what stands before a house is looked for within it.
inline constexpr double kMostOverhang = 0.6;

/// Where elements stand: on slopes that begin above street fronts, on all others, or on both.
enum class RoofSide : std::uint8_t { street, rear, both };

/// What shall stand on a roof: the attributes of the rules for roofs (configs/grammars/roofscape.cga; docs/roof_elements.md has
/// the table).
struct RoofOrders {
  std::optional<roofs::DormerParameters> dormers;
  RoofSide dormer_side = RoofSide::both;
  int dormer_count = 0;  ///< on a slope; 0: one for each axis that has room
  int dormer_every = 1;  ///< stand on every first, second ... window axis
  std::optional<roofs::CrossGableParameters> cross_gables;
  RoofSide cross_gable_side = RoofSide::street;
  int cross_gable_count = 1;                 ///< on a slope; 0: as many as fit
  std::optional<roofs::GableOptions> gable;  ///< before gables and attics that look on a street
  roofs::ElementDistances distances;
  masses::RoofEdgeOrders edges;
  bool any() const { return dormers || cross_gables; }
};

/// Reads the values that the rules came to. \param complaints  gets what is out of range or unknown, one sentence each; what
/// it is about is not built
RoofOrders read_roof_orders(std::span<const std::pair<std::string, grammar::Value>> values,
                            std::vector<std::string>& complaints);

/// Middles of windows along the wall of a plan edge.
struct WindowAxes {
  std::int32_t edge = -1;
  std::vector<model::Point2> places;
};

using model::RoofFront;

/// A body's envelope with its roof's elements.
struct FurnishedRoof {
  roofs::Roof roof;
  model::Solid solid;
  model::SolidTriangles triangles;
  std::vector<RoofFront> fronts;
  int dormers = 0, cross_gables = 0;  ///< that stand there
  int left_out = 0;                   ///< that fitted on their slope and spoil the solid or stand in another body
};

/// Puts on a roof what is ordered: cross gables first, then dormers, each on the window axes below where there are some. Slopes
/// that take none (15 to 80 degrees; distances of roofs::ElementDistances) get none; that is no failure.
/// \param body   has LoD2; faces of the new solid begin with its faces, in their order
/// \param edges  one per plan edge
/// \return none where nothing is built
std::optional<FurnishedRoof> furnish_roof(const model::Building& building, const model::BuildingPart& body,
                                          const masses::BuiltMass& mass, std::span<const model::RoofEdge> edges,
                                          std::span<const WindowAxes> axes, const RoofOrders& orders);

}  // namespace blockrand::facades
