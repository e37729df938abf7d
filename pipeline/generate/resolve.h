// Missing values, first version: every attribute of every building and part gets a value, a source and a reason.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "pipeline/context/tagged_neighbours.h"
#include "pipeline/generate/defaults.h"
#include "pipeline/generate/options.h"
#include "pipeline/model/region.h"

namespace blockrand::generate {

/// What resolve_attributes reads besides the region.
struct ResolveInputs {
  const Defaults& defaults;
  const context::TaggedNeighbours& neighbours;
  std::uint64_t seed = 1;
  /// Ground under a building: height above the build's reference, with its source.
  std::function<model::Sourced<double>(const model::Building&)> ground_height;
};

/// m. Of the storey behind a mansard's steep slopes, where floors are `storey_height` apart: attics are lower (styles.md 2.7:
/// the break lies 2.2 to 2.8 m above the floor).
double attic_height(double storey_height);

/// Which group's neighbours speak for a building whose use is `use` and whose footprint measures `area` m².
std::uint8_t neighbour_group(const Defaults& defaults, std::string_view use, double area);

/// Fills `attributes` of all buildings and parts. Per value, strongest first: the part's or building's own tag; what
/// follows from another tag; the outline's tag (for parts); the median or majority of at least `neighbour_minimum`
/// tagged neighbours; the defaults of the building's use; the defaults of all. Conventions: `MappedAttributes`.
///
/// Heights hang together: height = storeys x storey height + roof height. The roof's is that of roof:height, else
/// roof:angle, else roof:levels, else a usual pitch; the last two give way by up to a third to what tagged height and
/// storeys leave; where only `height` is tagged, storeys follow. Tags that contradict each other are reported
/// (docs/roofs.md, "Tags").
/// In rows ridges run from party wall to party wall (roof_sides.h): `edges` must be labelled before. Fills roof_plan and
/// roof_edges of the parts.
/// Reach: GenerateOptions::neighbour_reach.
void resolve_attributes(model::Region& region, const ResolveInputs& inputs, const GenerateOptions& options);

}  // namespace blockrand::generate
