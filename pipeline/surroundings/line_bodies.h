// Bodies along mapped lines: walls, fences, hedges, rails, decks of bridges.
#pragma once

#include <functional>
#include <vector>

#include "pipeline/model/surroundings.h"
#include "pipeline/surroundings/ground_claims.h"

namespace blockrand::surroundings {

/// m. Pieces of bodies are no longer: whether they are cut depends on the ground this far around.
inline constexpr double kLongest = 60;

/// The ground at a place in plan.
struct GroundAt {
  bool building = false;
  model::GroundClass ground = model::GroundClass::land;
  double height = 0;  ///< m above the height reference, of the surface that lies there
};
using GroundAtPlace = std::function<GroundAt(model::Point2)>;

/// The bodies of a thing, or of those of its segments whose middles `is_own` takes; none for things that have none.
///
/// * barrier=*: a strip as high and wide as tags say, else as usual for its kind, which follows the ground; open where a gate or a
///   street is one of its points; none within buildings.
/// * highway=*: lines between lanes, crossings that are marked.
/// * railway=*: two rails of the gauge.
/// * bridge=* of streets and railways: a deck between the grounds at both ends of the run of bridges that it belongs to, raised as
///   far as its layer, what it crosses and a slope of 6 % (railways: 2.5 %) allow where the ground below is not low already; with its
///   strips, and railings.
/// \param around  m, all places that `is_own` takes
/// \param terrain_height  m, of the ground wherever a run of bridges leads
std::vector<model::SurroundingBody> line_bodies(const SurroundingInputs& in, const ClaimFinder& claims,
                                                const Thing& thing, const std::function<bool(model::Point2)>& is_own,
                                                const geometry::PlanBox& around, const GroundAtPlace& ground,
                                                const std::function<double(model::Point2)>& terrain_height);

}  // namespace blockrand::surroundings
