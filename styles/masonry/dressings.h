// Stones round openings: arches, lintels, sills; and what they take away from the field. Internal.
#pragma once

#include <vector>

#include "styles/masonry/masonry.h"
#include "styles/masonry/plane.h"

namespace blockrand::masonry {

/// An opening's outline read as jambs and head; from the head's right end to its left.
struct OpeningShape {
  Box box;
  Outline head;           ///< points of the head, counter-clockwise: from the top of the right jamb to that of the left
  bool straight = false;  ///< head is level
  bool flat_foot = false;  ///< stands on a level edge
};
OpeningShape shape_of(const Outline& opening);

/// A curve with its outward directions: joints of arches lie along them. Circles keep their centre, pointed arches one of each half,
/// other curves (basket arches) turn from edge to edge.
class HeadCurve {
 public:
  explicit HeadCurve(const Outline& points);
  double length() const { return along_.back(); }
  Point2 at(double s) const;
  Point2 outward(double s) const;
  /// The curve's own points strictly between two places.
  Outline between(double from, double to) const;

 private:
  Outline points_;
  std::vector<double> along_;     ///< m from the first point
  std::vector<Point2> outwards_;  ///< of each point
  struct Arc {
    double from = 0, to = 0;
    Point2 centre;
  };
  std::vector<Arc> arcs_;
};

/// What stands round the openings of a wall.
struct Dressings {
  std::vector<Stone> stones;
  std::vector<Outline> blocked;  ///< the openings and what the stones take up, with their joints: the field ends there
  std::size_t undressed = 0;
};
Dressings dress(const WallToLay& wall, const Masonry& masonry);

}  // namespace blockrand::masonry
