// Few colours for small files. Internal to this folder.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/model/colour.h"
#include "pipeline/picture/image.h"

namespace blockrand::picture {

/// A picture as indices into at most 256 colours, rows from the top.
struct PaletteImage {
  std::vector<model::Colour> palette;
  std::vector<std::uint8_t> pixels;
};

/// The picture with at most `colours` colours (1 to 256): exact where it has no more, else its colours are split, again
/// and again where they vary most (after P. Heckbert, Color image quantization for frame buffer display, SIGGRAPH
/// 1982; at the mean instead of the median), and each becomes the mean of its group. No dithering: pictures of models
/// are areas, and noise makes large files.
PaletteImage reduce_colours(const Image& image, int colours);

}  // namespace blockrand::picture
