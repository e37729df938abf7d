// What stands on the roofs of LoD3: chimneys and roof windows, as bodies of their own.
#pragma once

#include <cstdint>

#include "pipeline/attributes/defaults.h"
#include "pipeline/masses/built_mass.h"
#include "pipeline/model/region.h"

namespace blockrand::facades {

struct RoofInstallationOptions {
  std::uint64_t seed = 0;
};

/// How many chimneys a house of that class, era and frontage has (docs/style_measures.md §2.7: frontage / 6 for houses
/// with a stove in every room; detached houses one). Own choices, since no source counts them: houses of 1919 to 1945
/// have central stoves, one stack for 12 m; later pitched roofs one for 18 m and flat ones none, since their heating
/// leaves through shafts without a stack.
/// \param frontage  m
/// \param lot       in [0, 1): the building's own draw; detached houses of after 1945 have one in 85 of 100 cases
///                  (docs/style_measures.md §6, `detached.roof`)
int wanted_chimneys(const model::Attributes& attributes, model::BuildingPosition position, bool flat, double frontage,
                    double lot);

/// Fills `lod3.roof_installations` of every part of the region's owned buildings that has LoD3.
///
/// Residential houses and old houses of shops and offices get chimneys, on the largest of their bodies that is not half
/// covered by higher ones; roof windows go into slopes above an attic storey (roof_storeys), and into rear slopes of
/// one old house in three, whose loft was converted (own choice). Measures are drawn per building within
/// docs/style_measures.md §2.7, keyed by its id and the seed. Every body is checked; one that fails its check, or
/// stands where another body of the building is, is left out. LoD2 and the LoD3 envelope are not touched.
/// \param masses  of the same region: the roofs that its LoD2 solids have
void add_roof_installations(model::Region& region, const masses::BuiltMasses& masses,
                            const attributes::Defaults& defaults, const RoofInstallationOptions& options);

}  // namespace blockrand::facades
