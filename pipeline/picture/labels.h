// Where names stand on a map: along their lines, apart from each other.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/model/point.h"
#include "pipeline/picture/lettering.h"

namespace blockrand::picture {

/// A piece of a line with a name. Pieces of one name that end where another begins are one line.
struct NamedLine {
  std::string name;
  int rank = 0;  ///< how important it is: 0 is the first
  std::vector<model::Point2> points;
};

struct LabelOptions {
  double size = 16;                        ///< px an em, of the lowest rank
  std::vector<double> of_rank = {1.2, 1};  ///< times `size`; the last one is that of all ranks behind it
  double smaller = 0.8;                    ///< times that, where there is no room otherwise or much would be covered
  double apart = 900;                      ///< px between two labels of one name; 0: one label each
  double margin = 6;                       ///< px from the border of the picture
  double between = 3;                      ///< px between labels
  /// How much it harms to write on a pixel, 0 to 1; empty: not at all. Names move along their lines to where it harms least.
  std::function<double(int x, int y)> covers = {};
};

/// A name in one straight line.
struct Label {
  std::string text;
  model::Point2 middle;     ///< px, rows downwards: of the text's length, and half an x above its base line
  model::Point2 direction;  ///< of length 1; never upside down
  double size = 0;          ///< px an em
  double width = 0;         ///< px

  model::Point2 start() const;                   ///< of the base line
  std::array<model::Point2, 4> corners() const;  ///< of the box that the letters take
};

/// Whether two boxes (convex, corners in order) come nearer than `gap`, seen along their sides.
bool overlap(const std::array<model::Point2, 4>& a, const std::array<model::Point2, 4>& b, double gap = 0);

/// Places names where their lines run straight for as long as the name is: names of the first rank first, of these the longest
/// lines. What finds no room is left out; long lines are named again after `apart`.
///
/// Labels keep apart from each other, from `taken`, and within the picture. The result depends on the set of lines alone, not on
/// their order or direction.
/// \param lines  px from the upper left corner, rows downwards; what leaves the picture is not used
std::vector<Label> place_labels(std::span<const NamedLine> lines, int width, int height, const LabelOptions& options,
                                const Lettering& letters, std::span<const std::array<model::Point2, 4>> taken = {});

}  // namespace blockrand::picture
