// The ground of one square as surfaces with heights.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "pipeline/model/surroundings.h"
#include "pipeline/surroundings/ground_claims.h"
#include "pipeline/surroundings/ground_height.h"

namespace blockrand::surroundings {

/// Ground of one label in a square, in plan and as it lies.
struct SquareSurface {
  std::uint32_t label = 0;  ///< into GroundClaims::labels
  std::vector<model::Polygon> plan;
  std::vector<std::array<model::Point2, 2>> borders;  ///< edges of `plan` beyond which lies another label
  model::GroundSurface surface;
};

/// The surfaces of a square, ascending by label; the land that nobody claims last, with a label behind those of the claims.
///
/// Surfaces and buildings cover the square and do not overlap in plan (partition_of). Their heights are those of the terrain and
/// their label's offset, or level where it has one (still water); where neighbours differ, an upright face closes the step, which belongs to the higher of both, or beside a
/// building to the ground.
/// \param land  the label of what nobody claims
std::vector<SquareSurface> ground_surfaces(SquareIndex square, const SquareGround& ground, const GroundClaims& claims,
                                           const GroundLabel& land);

/// Whether a polygon holds a place; its border counts as outside.
bool holds(const model::Polygon& polygon, model::Point2 place);
/// m from a place to the nearest of some edges; infinite without any.
double distance_to(std::span<const std::array<model::Point2, 2>> edges, model::Point2 place);

}  // namespace blockrand::surroundings
