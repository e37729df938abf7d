// Elements where they stand: whether there is anything to place, and the room that it takes.
#pragma once

#include <array>
#include <vector>

#include "pipeline/model/region.h"

namespace blockrand::outputs {

/// Whether the element has a face to show: one with an area once it is rounded to 0.1 mm. An empty reveal has none;
/// nothing stands for such an element in any format, and its opening's polygon is left to the solid.
bool has_shape(const model::Element& element);
/// The same of all elements of a region, by their numbers: for whoever goes through its placements.
std::vector<bool> with_shape(const model::Region& region);

/// The boxes of a region's elements, to be asked for those of placements.
class PlacedBoxes {
 public:
  explicit PlacedBoxes(const model::Region& region);

  /// Corners in the build CRS, m: the element's box turned by the placement. Null where the element has no shape.
  const std::array<model::Point3, 8>* corners(const model::Placement& placement);

 private:
  struct Box {
    bool there = false;
    model::Point3 min, max;  ///< m, in the element's frame
  };
  std::vector<Box> boxes_;  ///< by element
  std::array<model::Point3, 8> corners_;
};

}  // namespace blockrand::outputs
