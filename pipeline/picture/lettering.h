// Words in pictures: a fixed font of 5 by 7 pixels for legends.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/model/colour.h"
#include "pipeline/picture/image.h"

namespace blockrand::picture {

/// px that `text` takes at size 1: six a letter.
inline int text_width(std::string_view text) { return 6 * static_cast<int>(text.size()); }

/// Writes ASCII with its upper left corner at x, y; what is no ASCII becomes '?', what leaves the picture is cut off.
/// \param size  px of a dot: a line of text is 8 times as high
void write_text(Image& image, int x, int y, std::string_view text, model::Colour colour, int size = 1);

/// The picture with a legend below it: a square of each colour with its words, in as many columns as fit.
Image with_legend(const Image& image, const std::vector<std::pair<model::Colour, std::string>>& entries,
                  std::string_view title, model::Colour paper, int size = 2);

}  // namespace blockrand::picture
