// Rendered pictures of a match. Internal to this folder.
#pragma once

#include <string>

#include "pipeline/compare/comparison_report.h"
#include "pipeline/model/colour.h"

namespace blockrand::compare {

/// PNG files, all of one size and from one camera; empty where a side has no surface.
struct MatchPictures {
  std::string reference, model;
  std::string reference_heat, model_heat;  ///< coloured by the distance to the other side
  int width = 0, height = 0;               ///< pixels
};

/// Both sides, each on its own ground, seen from in front of the reference's largest facade that has openings (from the
/// south where there is none).
MatchPictures draw_pictures(const Comparison& comparison, const MatchResult& match, const DistanceQuery& distances,
                            const ReportOptions& options);

/// Yellow to dark red with falling lightness (C. Brewer's YlOrRd): told apart by the colour-blind and in grey print.
/// \param share  of the range of the scale; [0, 1], clamped
model::Colour heat_colour(double share);
inline constexpr model::Colour kHeatLeftOut{205, 208, 212};  ///< of faces that are left out

// Colours of the lit pictures, for the legend.
inline constexpr model::Colour kPictureWall{232, 220, 196}, kPictureRoof{186, 96, 72}, kPictureOther{176, 170, 160},
    kPictureLeftOut{222, 222, 224}, kPictureWindow{58, 84, 112}, kPictureDoor{112, 74, 46};

}  // namespace blockrand::compare
