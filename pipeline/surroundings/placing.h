// Things that are modelled once and placed: trees, lamps, benches.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/surroundings/ground_claims.h"
#include "pipeline/surroundings/ground_surfaces.h"

namespace blockrand::surroundings {

/// m between the trees of a row: avenues of German towns are planted at 6 to 12 m (FLL, Empfehlungen für Baumpflanzungen 1, 2015).
inline constexpr double kRowSpacing = 8;
/// m from the border of a wood or lawn that its trees keep.
inline constexpr double kBorderDistance = 2;

/// A thing with its place in plan; its height is that of the ground there.
struct PlannedObject {
  model::PlacedObject object;
  model::Point2 place;
};

/// What stands at a mapped point, or in the middle of an area: nothing where no shape is known for it.
std::optional<PlannedObject> object_at(const Catalogue& catalogue, std::string_view kind, model::OsmId id,
                                       model::Point2 place, const TagOf& tag, std::uint64_t seed);

/// The trees of a row, at equal distances of about kRowSpacing, one at each end.
std::vector<PlannedObject> row_of_trees(const Catalogue& catalogue, model::OsmId id,
                                        std::span<const model::Point2> line, const TagOf& tag, std::uint64_t seed);

/// Trees in surfaces whose label asks for them: at places of a grid that is fixed in the build CRS, moved at random, where they are
/// within the surface and away from its border. \param mapped  places of mapped trees: no other comes within a crown of them
std::vector<PlannedObject> scattered_trees(const Catalogue& catalogue, std::span<const SquareSurface> surfaces,
                                           const GroundClaims& claims, std::span<const model::Point2> mapped,
                                           const std::function<TagOf(model::OsmId)>& tags, std::uint64_t seed);

}  // namespace blockrand::surroundings
