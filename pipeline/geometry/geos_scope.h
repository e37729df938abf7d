// GEOS for the sources of this folder: a context, geometries that free themselves, polygons in and rings out. Included
// by sources alone: GEOS is seen by nobody else.
#pragma once

#include <geos_c.h>

#include <memory>
#include <span>
#include <vector>

#include "pipeline/model/polygon.h"

namespace blockrand::geometry::geos {

/// The thread's own: GEOS contexts are not shared between threads.
inline GEOSContextHandle_t context() {
  struct Context {
    GEOSContextHandle_t handle = GEOS_init_r();
    Context() = default;
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
    ~Context() { GEOS_finish_r(handle); }
  };
  thread_local const Context owned;
  return owned.handle;
}

struct Deleter {
  void operator()(GEOSGeometry* g) const { GEOSGeom_destroy_r(context(), g); }
};
/// Null where GEOS failed.
using Geometry = std::unique_ptr<GEOSGeometry, Deleter>;

/// A linear ring, relative to `origin`: small coordinates keep GEOS's own rounding far below the grid.
/// \param points  without the first one repeated; one or more
inline Geometry ring_of(std::span<const model::Point2> points, model::Point2 origin) {
  const auto n = static_cast<unsigned>(points.size());
  GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(context(), n + 1, 2);
  for (unsigned i = 0; i <= n; ++i)
    GEOSCoordSeq_setXY_r(context(), sequence, i, points[i % n].x - origin.x, points[i % n].y - origin.y);
  return Geometry(GEOSGeom_createLinearRing_r(context(), sequence));
}

/// Relative to `origin`. Holes of fewer than three points are left out.
inline Geometry polygon_of(const model::Polygon& polygon, model::Point2 origin) {
  std::vector<GEOSGeometry*> holes;
  for (const model::Ring& hole : polygon.holes)
    if (hole.size() >= 3) holes.push_back(ring_of(hole.points, origin).release());
  return Geometry(GEOSGeom_createPolygon_r(context(), ring_of(polygon.outer.points, origin).release(), holes.data(),
                                           static_cast<unsigned>(holes.size())));
}

/// The ring's points at their places, rounded to the grid; points that are one with the one before are left out.
inline model::Ring ring_from(const GEOSGeometry* ring, model::Point2 origin) {
  model::Ring out;
  const GEOSCoordSequence* sequence = GEOSGeom_getCoordSeq_r(context(), ring);
  unsigned n = 0;
  GEOSCoordSeq_getSize_r(context(), sequence, &n);
  for (unsigned i = 0; i + 1 < n; ++i) {
    double x = 0, y = 0;
    GEOSCoordSeq_getXY_r(context(), sequence, i, &x, &y);
    const model::Point2 p = model::snap(model::Point2{x + origin.x, y + origin.y});
    if (!out.points.empty() && out.points.back() == p) continue;
    out.points.push_back(p);
  }
  while (out.points.size() > 1 && out.points.back() == out.points.front()) out.points.pop_back();
  out.nodes.assign(out.points.size(), 0);
  return out;
}

/// STRUCTURE keeps overlaps inside and holes out; LINEWORK makes holes of what is enclosed twice
/// (docs/sources.md, Libraries 2).
inline Geometry made_valid(const GEOSGeometry* geometry, GEOSMakeValidMethods method) {
  GEOSMakeValidParams* parameters = GEOSMakeValidParams_create_r(context());
  GEOSMakeValidParams_setMethod_r(context(), parameters, method);
  GEOSMakeValidParams_setKeepCollapsed_r(context(), parameters, 0);
  Geometry out(GEOSMakeValidWithParams_r(context(), geometry, parameters));
  GEOSMakeValidParams_destroy_r(context(), parameters);
  return out;
}

}  // namespace blockrand::geometry::geos
