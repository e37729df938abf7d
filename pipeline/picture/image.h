// A finished picture.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/colour.h"

namespace blockrand::picture {

/// 8-bit sRGB, rows from the top, three bytes a pixel.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  const std::uint8_t* pixel(int x, int y) const {
    return &rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * 3];
  }
  friend bool operator==(const Image&, const Image&) = default;
};

/// The picture as a PNG file: 8-bit RGB marked as sRGB, no time chunk, the same bytes each time (with the same libdeflate).
/// \throws std::runtime_error  the image has no pixels, or its buffer does not fit its size
std::string png(const Image& image);

/// The picture with at most `colours` colours (2 to 256) as a PNG file with a palette: a quarter of the bytes where the
/// picture is made of areas. Deterministic as png().
/// \throws std::runtime_error  as png()
std::string palette_png(const Image& image, int colours = 64);

/// Reads a PNG file of any kind; transparency is left out.
/// \throws std::runtime_error  the bytes are no PNG, damaged, or of more than 100 million pixels
Image read_png(std::string_view bytes);

/// The pixels of an image from a column and row on; what lies beyond it is left out. May be empty.
Image cut(const Image& image, int column, int row, int width, int height);

/// An image of one colour.
Image blank(int width, int height, model::Colour colour);
/// Puts a picture on another, its upper left corner at a column and a row; what lies beyond is left out.
void put(Image& on, const Image& picture, int column, int row);

}  // namespace blockrand::picture
