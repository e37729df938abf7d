// Does an image lie where its georeference says? All outlines of the map decide together.
#pragma once

#include <span>
#include <vector>

#include "pipeline/observation/image_windows.h"
#include "pipeline/observation/imagery.h"
#include "pipeline/observation/row_match.h"

namespace blockrand::observation {

/// m: displacements up to this are looked at; an image that is off by more fits nowhere.
inline constexpr double kFitReach = 25;

/// Fits one image. Each outline is searched within kFitReach, its scores in deviations of their own; the best within
/// 0.5, 1 or 2 m of a displacement counts for it, since every outline has its own error; their mean over all outlines is the
/// image's evidence. \param outlines  a sample of the map, in a fixed order; some may lie outside of the image
/// \param windows  of coarse pixels
ImageFit fit_image(std::span<const SearchedOutline> outlines, const ImageWindows& windows, int workers);

}  // namespace blockrand::observation
