// Words in pictures, in one font that is part of the program.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/colour.h"
#include "pipeline/model/point.h"
#include "pipeline/picture/image.h"

namespace blockrand::picture {

struct TextStyle {
  double size = 16;  ///< px an em; capitals are kCapitals of it high
  model::Colour colour{30, 30, 30};
  double halo = 0;  ///< px of the halo's colour around the letters
  model::Colour halo_colour{255, 255, 255};
};

/// Of an em: the height of capitals and of an x, and how far letters reach above and below their line.
inline constexpr double kCapitals = 0.729, kSmallLetters = 0.547, kAscent = 0.93, kDescent = 0.24;

/// Writes with DejaVu Sans Condensed, laid out and rasterised by FreeType.
///
/// The same words give the same bytes on every x86-64 with the same FreeType: no font of the system is looked for, outlines are
/// not fitted to pixels (no hinting), and coverage is computed in whole numbers. Text is UTF-8; bytes that are not become U+FFFD,
/// and a character that the font lacks a box. Latin, Greek, Cyrillic, Armenian and Georgian read as they should; scripts that
/// join letters or run from right to left (Arabic) are set letter by letter from left to right, and Chinese, Japanese, Korean,
/// Thai and Indian ones are boxes. Pairs of letters are kerned.
///
/// One thread at a time; opening one takes a tenth of a millisecond.
class Lettering {
 public:
  Lettering();
  ~Lettering();
  Lettering(Lettering&&) noexcept;
  Lettering& operator=(Lettering&&) noexcept;

  /// px from the start of the text to where a next letter would stand.
  double width(std::string_view text, double size) const;

  /// Writes a line of text; what leaves the picture is cut off.
  /// \param at         px from the upper left corner of the picture: where the base line begins
  /// \param direction  of the base line, px, rows downwards; of length 1
  void write(Image& image, model::Point2 at, std::string_view text, const TextStyle& style,
             model::Point2 direction = {1, 0}) const;

  /// The text, or as much of its beginning as fits with an ellipsis.
  std::string fitted(std::string_view text, double size, double width) const;

  /// The text in lines that fit, broken at spaces; a word that is too long stands alone and reaches beyond.
  std::vector<std::string> lines(std::string_view text, double size, double width) const;

  /// The font has a letter for every character but spaces and marks that show nothing.
  bool can_write(std::string_view text) const;

 private:
  struct Face;
  std::unique_ptr<Face> face_;
};

/// Writes whose data a picture shows, small, on a pale ground in its lower right corner; all of it, in several lines where one
/// is too long. A picture of less than 40 px is left as it is.
/// \returns the corners of that ground, px from the upper left corner of the picture
std::array<model::Point2, 4> sign(Image& image, std::string_view words);

}  // namespace blockrand::picture
