// Plans: filled polygons and lines seen from above, north up, without steps at their borders.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/model/colour.h"
#include "pipeline/model/polygon.h"
#include "pipeline/picture/image.h"

namespace blockrand::picture {

/// m in the build CRS.
struct PlanBox {
  double min_x = 0, min_y = 0, max_x = 0, max_y = 0;
  double width() const { return max_x - min_x; }
  double height() const { return max_y - min_y; }
};

/// A sheet of paper that things are drawn on, one over the other.
///
/// A pixel's colour is mixed by how much of it is covered, exactly but for lines that overlap themselves. The same calls
/// give the same bytes on every x86-64. Memory: 3 bytes a pixel, and 8 bytes for each pixel of the largest box of what is drawn.
class Plan {
 public:
  /// \param pixels_per_metre  the picture is as large as the box needs
  /// \throws std::invalid_argument  an empty box, no scale, or more than 8192 pixels along a side
  Plan(const PlanBox& box, double pixels_per_metre, model::Colour paper = {255, 255, 255});
  /// On a picture. \param under  as large as a sheet of that box and scale
  /// \throws std::invalid_argument  as above, or a picture of another size
  Plan(const PlanBox& box, double pixels_per_metre, Image under);

  /// \param opacity  [0, 1]
  void fill(const model::Polygon& polygon, model::Colour colour, double opacity = 1);
  /// A line with round ends and corners.
  /// \param width   m
  /// \param closed  also from the last point to the first
  void stroke(std::span<const model::Point2> points, double width, model::Colour colour, bool closed = false);

  /// A bar of a round length, with that length, in the lower left corner.
  /// \param size  px an em of the words
  /// \returns that length, m
  double draw_scale_bar(double size = 14);
  /// px from the upper left corner, rows downwards.
  model::Point2 pixel_of(model::Point2 place) const {
    return {(place.x - box_.min_x) * scale_, (box_.max_y - place.y) * scale_};
  }

  double metres_per_pixel() const { return 1 / scale_; }
  const PlanBox& box() const { return box_; }
  const Image& image() const { return image_; }
  Image& image() { return image_; }  ///< to be written on

 private:
  /// Closed lines, one after the other.
  struct Contours {
    std::vector<model::Point2> points;  ///< m
    std::vector<std::size_t> ends;
    void end() { ends.push_back(points.size()); }
  };
  Contours& emptied() {
    contours_.points.clear();
    contours_.ends.clear();
    return contours_;
  }
  /// Nothing of what is within `margin` metres of these points is on the sheet.
  bool misses(std::span<const model::Point2> points, double margin) const;
  /// The contours are in pixels afterwards.
  void cover(Contours& contours, model::Colour colour, double opacity);

  PlanBox box_;
  double scale_;
  Image image_;
  Contours contours_;           ///< of what is drawn, kept for its memory
  std::vector<double> change_;  ///< likewise
};

/// The largest scale, pixels per metre, at which no side of the picture is longer than `pixels`.
double scale_for(const PlanBox& box, int pixels);

/// The longest of 1, 2, 5, 10, 20, ... m that is no longer than `most`; 1 where that is less.
double round_length(double most);
/// "50 m", "2 km".
std::string length_text(double metres);

}  // namespace blockrand::picture
