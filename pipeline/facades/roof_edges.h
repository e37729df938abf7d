// What stands on the edges of LoD3's roofs: eaves and verges, caps on ridges and hips, parapets, fire walls.
#pragma once

#include <functional>
#include <vector>

#include "pipeline/attributes/defaults.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/masses/built_mass.h"
#include "pipeline/model/region.h"

namespace blockrand::facades {

/// The outlines of all buildings but one that come within a distance (m) of a box along both axes; in other tiles as well.
using OutlinesNear =
    std::function<std::vector<model::Polygon>(const geometry::PlanBox& box, double distance, model::OsmId but)>;

/// Adds to `lod3.roof_installations` of every body of the region's owned buildings that has LoD3 and is no canopy, after
/// add_roof_installations, whose chimneys they keep clear of.
///
/// * Eaves where a wall ends level, verges where its end rises: 0.3 m on old houses and 0.4 m on others, verges half of that
///   (docs/gables_and_edges.md); on small outbuildings half of both. None on party walls, before other buildings, and where a cornice
///   of the facade ends the wall.
/// * Caps along ridges and hips of tiled and slated roofs.
/// * Parapets around level roofs of houses of after 1919 and of all that are no houses of people.
/// * Ornamental gables where rules for roofs order them (BuiltMass::gable), before all walls on streets behind which a roof rises, or,
///   attics, does not. Chimneys, eaves, verges, parapets and caps give way to them.
/// * Fire walls on old houses' party walls where the neighbour's eaves are two metres and more lower.
///
/// Bodies of one part keep out of each other and of their part by construction; those of buildings in several parts are held against
/// all of them, and left out where they meet (ROOF_ELEMENT_LEFT_OUT).
/// \param masses  of the same region: the roofs that its LoD2 solids have
void add_roof_edges(model::Region& region, const masses::BuiltMasses& masses, const attributes::Defaults& defaults,
                    const OutlinesNear& outlines_near);

}  // namespace blockrand::facades
