// Roof windows: flat boxes on a slope.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "styles/roofs/element_layout.h"

namespace blockrand::roofs {

/// Measures of a roof window: a frame that stands out of the tiles, with a pane set into it.
struct RoofWindowParameters {
  double width = 0.78;   ///< m, over the frame. 0.78 x 1.18 is the usual one of loft conversions
                         ///< (docs/style_measures.md §2.7).
  double height = 1.18;  ///< m up the slope, over the frame
  double raised = 0.06;  ///< m from the plane of the roof to the face of the frame: over battens and tiles (own choice)
  double frame = 0.08;   ///< m that the frame shows around the pane (own choice)
  double reveal = 0.02;  ///< m from the face of the frame down to the pane (own choice)
  double gap = 0.003;    ///< m from the plane of the roof to the underside, as of chimneys (ChimneyParameters::gap)
};

/// Looks of its faces: material and colour; kinds are set.
struct RoofWindowMaterials {
  model::Face frame, pane;
};

/// Its outline about the middle of its lower edge, for lay_out(); empty when the measures make no body: sides under 0.2
/// m, a frame that leaves no pane, a pane below the underside.
std::vector<model::Point2> roof_window_outline(const RoofWindowParameters& parameters);

/// A roof window whose underside lies `gap` over the plane: 11 faces (underside, four sides, frame, four reveals, pane). Its
/// faces are of kind roof, the underside closure. occupy() the plane with it before the next.
/// Empty when the plane takes no elements (takes_elements) or it does not fit there with its distances.
/// \param place  middle of the lower edge of the frame
std::optional<model::RoofInstallation> roof_window(const RoofSlope& plane, const RoofWindowParameters& parameters,
                                                   model::Point2 place, const RoofWindowMaterials& materials = {},
                                                   const ElementDistances& distances = {});

}  // namespace blockrand::roofs
