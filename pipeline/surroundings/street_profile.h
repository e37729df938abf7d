// What lies side by side in a street, by its tags.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "pipeline/model/surroundings.h"
#include "pipeline/surroundings/catalogue.h"

namespace blockrand::surroundings {

/// A strip along a way, m to the right of it (negative: to the left), seen in the way's direction.
struct StreetStrip {
  model::GroundClass ground = model::GroundClass::carriageway;
  double left = 0, right = 0;  ///< its two sides, left < right
  model::SurroundingMaterial material = 0;
};

struct StreetProfile {
  std::vector<StreetStrip> strips;                     ///< from left to right, side by side, without gaps
  bool kerbed = false;                                 ///< its carriageway lies lower than what is beside it
  int lanes = 0;                                       ///< of the carriageway; 0: not told
  double carriageway_left = 0, carriageway_right = 0;  ///< of lanes for vehicles alone; equal where there are none
};

/// What lies in a way with `highway`. The way is the middle between the kerbs: mappers follow what they see from above.
/// From left to right: pavement, track for bicycles, parking, carriageway, parking, track, pavement. Lanes for bicycles are
/// a part of the carriageway; parking bays (street_side, lay_by, shoulder) lie beyond the line of the kerb; who parks on the
/// kerb parks on the pavement.
/// Widths: `width` (kerb to kerb, parking lanes and lanes for bicycles in it), else width:lanes, else lanes times the width
/// of a lane, else that of the class, less for one direction. Parking lanes (parking:*, parking:lane:*), lanes and tracks for
/// bicycles (cycleway*) and pavements (sidewalk*) where tagged; where no tag tells, pavements of the class in built-up land.
/// What is a way of its own (`separate`) is none of this one. footway=sidewalk is a pavement, footway=crossing a footway.
/// Widths out of bounds (0.3 to 60 m) count as untold.
/// \param built_up    houses stand around
/// \param keeps_left  vehicles keep to the left: tells where what has no side lies in a street of one direction
/// \return nothing for what is no ground: highway=construction, proposed, corridor, elevator, bus_stop …
std::optional<StreetProfile> street_profile(const TagOf& tag, bool built_up, const Catalogue& catalogue,
                                            bool keeps_left);

/// A length as tags have it ("3.5", "3,5 m", "350 cm", "12 ft", "7'6\""), m; nothing where it cannot be read, as ranges and
/// negative ones.
std::optional<double> length_of(std::string_view text);

}  // namespace blockrand::surroundings
