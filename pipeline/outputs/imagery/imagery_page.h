// imagery.html: what the images changed.
#pragma once

#include <string>
#include <vector>

#include "pipeline/outputs/imagery/overlay.h"

namespace blockrand::outputs {

/// So many corrections have a picture on the page, the largest first.
inline constexpr std::size_t kPicturedCorrections = 20;
/// And so many candidates for unmapped buildings, the likeliest first.
inline constexpr std::size_t kPicturedCandidates = 12;

/// \param overlays  pictures of tiles beside the page: "imagery/15_1_2.png"
std::string imagery_page(const OverlayInputs& in, const std::vector<std::string>& overlays);

}  // namespace blockrand::outputs
