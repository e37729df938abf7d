#include "pipeline/geometry/plan_shape.h"

#include <stdexcept>

#include "pipeline/geometry/geos_scope.h"

namespace blockrand::geometry {

namespace {

using geos::context;
using model::Point2;

using Shape = std::shared_ptr<void>;

Shape held(GEOSGeometry* geometry) {
  if (!geometry) throw std::runtime_error("GEOS failed");
  return {geometry, [](void* g) { GEOSGeom_destroy_r(context(), static_cast<GEOSGeometry*>(g)); }};
}

const GEOSGeometry* raw(const Shape& shape) { return static_cast<const GEOSGeometry*>(shape.get()); }

double area_of(const Shape& shape) {
  double area = 0;
  if (!GEOSArea_r(context(), raw(shape), &area)) throw std::runtime_error("GEOS: no area");
  return area;
}

}  // namespace

PlanShape::PlanShape(const std::vector<model::Polygon>& polygons) {
  std::vector<GEOSGeometry*> parts;
  for (const model::Polygon& p : polygons) parts.push_back(geos::polygon_of(p, {}).release());
  const Shape all = held(GEOSGeom_createCollection_r(context(), GEOS_GEOMETRYCOLLECTION, parts.data(),
                                                     static_cast<unsigned>(parts.size())));
  shape_ = held(GEOSUnaryUnion_r(context(), raw(all)));
  area_ = area_of(shape_);
}

Point2 PlanShape::centroid() const {
  const Shape point = held(GEOSGetCentroid_r(context(), raw(shape_)));
  Point2 p;
  GEOSGeomGetX_r(context(), raw(point), &p.x);
  GEOSGeomGetY_r(context(), raw(point), &p.y);
  return p;
}

double PlanShape::common_area(const PlanShape& other) const {
  if (empty() || other.empty()) return 0;
  return area_of(held(GEOSIntersection_r(context(), raw(shape_), raw(other.shape_))));
}

double PlanShape::outline_distance(const PlanShape& other) const {
  if (empty() || other.empty()) return 0;
  // GEOS measures from points of the lines; between corners they are walked in steps.
  constexpr double kStep = 0.5;  // m
  const auto walked = [](const Shape& shape) {
    const Shape outline = held(GEOSBoundary_r(context(), raw(shape)));
    return held(GEOSDensify_r(context(), raw(outline), kStep));
  };
  const Shape a = walked(shape_), b = walked(other.shape_);
  double distance = 0;
  if (!GEOSHausdorffDistance_r(context(), raw(a), raw(b), &distance)) throw std::runtime_error("GEOS: no distance");
  return distance;
}

PlanShape PlanShape::moved(Point2 by) const {
  PlanShape out;
  if (empty()) return out;
  const auto move = [](double* x, double* y, void* by_ptr) {
    *x += static_cast<const Point2*>(by_ptr)->x;
    *y += static_cast<const Point2*>(by_ptr)->y;
    return 1;
  };
  out.shape_ = held(GEOSGeom_transformXY_r(context(), raw(shape_), move, &by));
  out.area_ = area_;
  return out;
}

PlanShape PlanShape::united(const PlanShape& other) const {
  if (empty()) return other;
  if (other.empty()) return *this;
  PlanShape out;
  out.shape_ = held(GEOSUnion_r(context(), raw(shape_), raw(other.shape_)));
  out.area_ = area_of(out.shape_);
  return out;
}

}  // namespace blockrand::geometry
