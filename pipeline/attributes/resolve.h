// Missing values, first version: every attribute of every building and part gets a value, a source and a reason.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/attributes/defaults.h"
#include "pipeline/attributes/options.h"
#include "pipeline/attributes/overrides.h"
#include "pipeline/context/ground.h"
#include "pipeline/context/tagged_neighbours.h"
#include "pipeline/model/region.h"
#include "styles/classify/catalogue.h"
#include "styles/districts/presets.h"

namespace blockrand::attributes {

/// What resolve_attributes reads besides the region.
struct ResolveInputs {
  const Defaults& defaults;
  const context::TaggedNeighbours& neighbours;
  std::uint64_t seed = 1;
  std::function<context::BuildingGround(const model::Building&)> ground;
  const Overrides* overrides = nullptr;  ///< already given to the extract (apply_overrides); null: none
  /// Of Building::inferred; may be null.
  const classify::Catalogue* catalogue = nullptr;
  /// Parallel to the region's buildings, null for most, or empty: the preset whose measures hold for one.
  std::span<const districts::Preset* const> presets = {};
};

/// m. Of the storey behind a mansard's steep slopes, where floors are `storey_height` apart: attics are lower
/// (docs/style_measures.md 2.7: the break lies 2.2 to 2.8 m above the floor).
double attic_height(double storey_height);

/// Which group's neighbours speak for a building whose use is `use` and whose footprint measures `area` m².
std::uint8_t neighbour_group(const Defaults& defaults, std::string_view use, double area);

/// Fills `attributes` of all buildings and parts. Per value, strongest first: the part's or building's own tag; what
/// follows from another tag; the outline's tag (for parts); for storeys and roof shapes what classification offers
/// (Building::inferred), where it offers nothing the median or majority of at least `neighbour_minimum` tagged
/// neighbours; what is usual for the likeliest sub-style, else for the building's use; the defaults of all. What the plan
/// or a tagged height rules out goes before the offers (Resolver::roof_shape, Resolver::divide_height in resolver.h).
/// Conventions: `MappedAttributes`.
///
/// Heights hang together: height = plinth + storeys x storey height + roof height. The plinth is what lies between the
/// lowest ground and the ground floor's level, which is the ground at the entrance, but at most one storey below the
/// highest ground under the building, so that no storey's ceiling lies below the terrain; all bodies of a building have
/// the same, but for parts that it would lift by more than a storey above the highest ground under them. A tagged height is measured from the lowest ground: the plinth gives way until storeys have kLowestStorey,
/// though not so far that the ground floor drowns; then storeys that nobody counted become fewer, and counted ones lower.
/// Where not even that leaves a storey above the terrain, the height is taken from the ground floor instead and reported
/// (VALUES_CONFLICT). Bodies with an underside of their own keep their tagged heights whatever the terrain. The roof's is that of roof:height, else
/// roof:angle, else roof:levels, else a usual pitch; the last two give way by up to a third to what tagged height and
/// storeys leave; where only `height` is tagged, storeys follow. Tags that contradict each other are reported
/// (docs/roofs.md, "Tags").
/// In rows ridges run from party wall to party wall (roof_sides.h): `edges` must be labelled before. Fills roof_plan and
/// roof_edges of the parts.
/// Reach: GenerateOptions::neighbour_reach.
void resolve_attributes(model::Region& region, const ResolveInputs& inputs, const GenerateOptions& options);

}  // namespace blockrand::attributes
