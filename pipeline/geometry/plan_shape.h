// Areas in plan for measuring: common area, overlap, distance of outlines. Raw GEOS on the coordinates as they are: a
// validator that shares nothing with repair but how polygons are handed to GEOS.
#pragma once

#include <memory>
#include <vector>

#include "pipeline/model/polygon.h"

namespace blockrand::geometry {

/// An area in plan, held by GEOS. Square metres, metres.
class PlanShape {
 public:
  PlanShape() = default;
  /// The union of the polygons.
  explicit PlanShape(const std::vector<model::Polygon>& polygons);
  bool empty() const { return area_ <= 0; }
  double area() const { return area_; }
  model::Point2 centroid() const;
  double common_area(const PlanShape& other) const;
  /// The largest distance of one outline from the other, both ways (Hausdorff; outlines are walked in steps of at most
  /// 0.5 m); 0 where one is empty.
  double outline_distance(const PlanShape& other) const;
  PlanShape moved(model::Point2 by) const;
  PlanShape united(const PlanShape& other) const;

 private:
  std::shared_ptr<void> shape_;
  double area_ = 0;
};

}  // namespace blockrand::geometry
