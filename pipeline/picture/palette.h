// Few colours for small files.
#pragma once

#include <array>
#include <cstdint>
#include <string>
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

/// As palette_png(), of a picture that has its palette. \param level  of deflate (base/deflate.h)
std::string png(int width, const PaletteImage& image, int level);

/// Few colours for pictures that are drawn piece by piece: chosen from some of them, looked up for all. Colours are told apart by their
/// upper six bits, so that nearly equal ones count as one; each is the mean of its group.
class Palette {
 public:
  /// Counts the colours of a picture. \param weight  of each of its pixels
  void count(const Image& image, std::uint32_t weight = 1);
  /// Chooses at most `most` colours, 2 to 256, as reduce_colours() does.
  void choose(int most);

  const std::vector<model::Colour>& colours() const { return colours_; }
  /// Appends the colours of some rows. Of those that were not counted, the nearest.
  void append(const Image& rows, std::vector<std::uint8_t>& pixels);

 private:
  static constexpr std::size_t kBins = 1 << 18;
  static std::size_t bin_of(const std::uint8_t* rgb) {
    return static_cast<std::size_t>(rgb[0] >> 2) << 12 | static_cast<std::size_t>(rgb[1] >> 2) << 6 |
           static_cast<std::size_t>(rgb[2] >> 2);
  }
  struct Bin {
    std::uint64_t count = 0;
    std::array<std::uint64_t, 3> sum{};
  };
  std::vector<Bin> bins_;
  std::vector<std::uint16_t> index_;  ///< of a bin: its colour + 1; 0: not looked for yet
  std::vector<model::Colour> colours_;
};

}  // namespace blockrand::picture
