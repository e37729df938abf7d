#include "pipeline/geometry/line_area.h"

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/geos_scope.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::geometry {
namespace {

using model::Point2;
using model::Polygon;

/// Segments of a quarter of a circle: kerbs of bends are within 4 % of the width.
constexpr int kQuadrantSegments = 3;
/// m². What rounding leaves of less is no ground.
constexpr double kLeastArea = 1e-3;

void add_polygons(const GEOSGeometry* geometry, Point2 origin, std::vector<Polygon>& out) {
  const auto handle = geos::context();
  const int n = GEOSGetNumGeometries_r(handle, geometry);
  for (int i = 0; i < n; ++i) {
    const GEOSGeometry* part = GEOSGetGeometryN_r(handle, geometry, i);
    if (GEOSGeomTypeId_r(handle, part) != GEOS_POLYGON || GEOSisEmpty_r(handle, part) == 1) continue;
    Polygon polygon;
    polygon.outer = geos::ring_from(GEOSGetExteriorRing_r(handle, part), origin);
    if (polygon.outer.size() < 3 || std::fabs(signed_area(polygon.outer.points)) < kLeastArea) continue;
    const int holes = GEOSGetNumInteriorRings_r(handle, part);
    for (int h = 0; h < holes; ++h) {
      model::Ring hole = geos::ring_from(GEOSGetInteriorRingN_r(handle, part, h), origin);
      if (hole.size() >= 3 && std::fabs(signed_area(hole.points)) >= kLeastArea)
        polygon.holes.push_back(std::move(hole));
    }
    out.push_back(std::move(polygon));
  }
}

/// \param width  m; negative: to the right alone
geos::Geometry buffered(const GEOSGeometry* line, double width, bool one_side) {
  GEOSBufferParams* parameters = GEOSBufferParams_create_r(geos::context());
  GEOSBufferParams_setEndCapStyle_r(geos::context(), parameters, GEOSBUF_CAP_FLAT);
  GEOSBufferParams_setJoinStyle_r(geos::context(), parameters, GEOSBUF_JOIN_ROUND);
  GEOSBufferParams_setQuadrantSegments_r(geos::context(), parameters, kQuadrantSegments);
  GEOSBufferParams_setSingleSided_r(geos::context(), parameters, one_side ? 1 : 0);
  geos::Geometry out(GEOSBufferWithParams_r(geos::context(), line, parameters, width));
  GEOSBufferParams_destroy_r(geos::context(), parameters);
  return out;
}

/// A disc of as many corners as bends have.
Polygon disc(Point2 centre, double radius) {
  constexpr double kHalf = 0.5, kCosine = 0.86602540378443865;  // of 60 and 30 degrees
  constexpr double kUnit[12][2] = {
      {1, 0},  {kCosine, kHalf},   {kHalf, kCosine},   {0, 1},  {-kHalf, kCosine}, {-kCosine, kHalf},
      {-1, 0}, {-kCosine, -kHalf}, {-kHalf, -kCosine}, {0, -1}, {kHalf, -kCosine}, {kCosine, -kHalf}};
  Polygon out;
  for (const auto& u : kUnit)
    out.outer.points.push_back(model::snap(Point2{centre.x + radius * u[0], centre.y + radius * u[1]}));
  out.outer.nodes.assign(out.outer.points.size(), 0);
  return out;
}

}  // namespace

std::vector<Polygon> line_area(std::span<const Point2> line, double left, double right, LineEnd start, LineEnd end) {
  std::vector<Point2> points;
  for (const Point2 p : line)
    if (points.empty() || points.back() != p) points.push_back(p);
  std::vector<Polygon> out;
  if (points.size() < 2) return out;
  const Point2 origin = points.front();
  GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(geos::context(), static_cast<unsigned>(points.size()), 2);
  for (unsigned i = 0; i < points.size(); ++i)
    GEOSCoordSeq_setXY_r(geos::context(), sequence, i, points[i].x - origin.x, points[i].y - origin.y);
  const geos::Geometry string(GEOSGeom_createLineString_r(geos::context(), sequence));
  if (!string) return out;
  const double both = std::min(left, right);
  if (both > 0)
    if (const geos::Geometry area = buffered(string.get(), both, false)) add_polygons(area.get(), origin, out);
  if (left != right)
    if (const geos::Geometry area = buffered(string.get(), left > right ? left : -right, true))
      add_polygons(area.get(), origin, out);
  if (points.front() == points.back()) return out;
  // Where the sides differ, an end is as round as the narrower one: a disc of the wider would reach across.
  const double radius = both > 0 ? both : 0;
  if (radius > 0 && start == LineEnd::round) out.push_back(disc(points.front(), radius));
  if (radius > 0 && end == LineEnd::round) out.push_back(disc(points.back(), radius));
  return out;
}

}  // namespace blockrand::geometry
