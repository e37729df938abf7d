#include "pipeline/geometry/ring_pieces.h"

#include <algorithm>

#include "pipeline/geometry/geos_scope.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::geometry {
namespace {

/// Of corners: how far a mitre may reach, as a multiple of the distance.
constexpr double kMitreLimit = 5;

geos::Geometry polygon_of(std::span<const model::Point2> ring) {
  model::Polygon polygon;
  polygon.outer.points.assign(ring.begin(), ring.end());
  return geos::polygon_of(polygon, {});
}

std::vector<RingPoints> pieces_of(const GEOSGeometry* geometry, double least) {
  std::vector<RingPoints> out;
  const auto context = geos::context();
  for (int i = 0, n = geometry ? GEOSGetNumGeometries_r(context, geometry) : 0; i < n; ++i) {
    const GEOSGeometry* part = GEOSGetGeometryN_r(context, geometry, i);
    if (GEOSGeomTypeId_r(context, part) != GEOS_POLYGON) continue;
    RingPoints points = geos::ring_from(GEOSGetExteriorRing_r(context, part), {}).points;
    if (points.size() < 3) continue;
    if (signed_area(points) < 0) std::reverse(points.begin(), points.end());
    if (signed_area(points) >= least) out.push_back(std::move(points));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const RingPoints& a, const RingPoints& b) { return signed_area(a) > signed_area(b); });
  return out;
}

}  // namespace

std::vector<RingPoints> drawn_in(std::span<const model::Point2> ring, double distance, double least) {
  constexpr int kQuadrantSegments = 4;
  const geos::Geometry polygon = polygon_of(ring);
  const geos::Geometry inner(GEOSBufferWithStyle_r(geos::context(), polygon.get(), -distance, kQuadrantSegments,
                                                   GEOSBUF_CAP_FLAT, GEOSBUF_JOIN_MITRE, kMitreLimit));
  return pieces_of(inner.get(), least);
}

std::vector<RingPoints> common_pieces(std::span<const model::Point2> a, std::span<const model::Point2> b,
                                      double least) {
  const geos::Geometry first = polygon_of(a), second = polygon_of(b);
  const geos::Geometry common(GEOSIntersection_r(geos::context(), first.get(), second.get()));
  return pieces_of(common.get(), least);
}

}  // namespace blockrand::geometry
