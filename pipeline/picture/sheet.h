// A map as a sheet of paper that explains itself: title, legend, scale, north, and whose data it shows.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pipeline/model/colour.h"
#include "pipeline/picture/image.h"

namespace blockrand::picture {

enum class LegendSign : std::uint8_t { area, line, thin_line };

struct LegendEntry {
  model::Colour colour;
  std::string words;
  LegendSign sign = LegendSign::area;
};

struct SheetText {
  std::string title;                     ///< made smaller where it is too long, then cut with an ellipsis
  std::vector<std::string> below_title;  ///< a paragraph each, in lines as they fit
  std::vector<LegendEntry> legend;       ///< in this order, column by column
  double metres_per_pixel = 0;           ///< of the map, for a scale bar; 0: none
  /// Of grid north: "Grid north is up; true north lies 0.9° to the right". Empty: no arrow.
  std::string north;
  std::string attribution;  ///< all of it is written, in lines as they fit
  std::string generator;
};

inline constexpr int kLeastSheet = 1200;  ///< px

/// Where a map, its frame and the words above and below stand. As wide as the map and its margins, kLeastSheet at least. Words are a
/// fixed share of the width, so that they can be read when the whole sheet is looked at, small as it may be.
class Sheet {
 public:
  /// \param map_width, map_height  px
  /// \param text                   outlives this
  Sheet(int map_width, int map_height, const SheetText& text);
  ~Sheet();
  Sheet(const Sheet&) = delete;
  Sheet& operator=(const Sheet&) = delete;

  int width() const;     ///< px
  int height() const;    ///< px
  int map_left() const;  ///< px from the left
  int map_top() const;   ///< px from above

  /// Draws frame and words on some rows of the sheet, which may be all of it. \param first  of the sheet: the topmost of `rows`
  void draw(Image& rows, int first) const;

 private:
  class Layout;
  std::unique_ptr<Layout> layout_;
};

/// A sheet with its map.
Image sheet(const Image& map, const SheetText& text, model::Colour paper);

}  // namespace blockrand::picture
