#include "pipeline/geometry/even_odd.h"

#include <geos_c.h>

#include <memory>

namespace blockrand::geometry {

namespace {

/// One GEOS context per thread: contexts are not shared between threads.
class Context {
 public:
  Context() : handle_(GEOS_init_r()) {}
  ~Context() { GEOS_finish_r(handle_); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  GEOSContextHandle_t get() const { return handle_; }

 private:
  GEOSContextHandle_t handle_;
};

GEOSContextHandle_t context() {
  thread_local Context c;
  return c.get();
}

struct Deleter {
  void operator()(GEOSGeometry* g) const { GEOSGeom_destroy_r(context(), g); }
};
using Geometry = std::unique_ptr<GEOSGeometry, Deleter>;

}  // namespace

double even_odd_area(const model::Ring& ring) {
  const auto n = static_cast<unsigned>(ring.size());
  if (n < 3) return 0;
  // Near the origin GEOS's rounding stays far below the grid.
  const model::Point2 origin = ring.points[0];
  GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(context(), n + 1, 2);
  for (unsigned i = 0; i <= n; ++i)
    GEOSCoordSeq_setXY_r(context(), sequence, i, ring.points[i % n].x - origin.x, ring.points[i % n].y - origin.y);
  const Geometry polygon(
      GEOSGeom_createPolygon_r(context(), GEOSGeom_createLinearRing_r(context(), sequence), nullptr, 0));
  // LINEWORK, the other method than the one that mends: it makes holes of what is enclosed twice.
  GEOSMakeValidParams* parameters = GEOSMakeValidParams_create_r(context());
  GEOSMakeValidParams_setMethod_r(context(), parameters, GEOS_MAKE_VALID_LINEWORK);
  const Geometry valid(GEOSMakeValidWithParams_r(context(), polygon.get(), parameters));
  GEOSMakeValidParams_destroy_r(context(), parameters);
  double area = 0;
  if (valid) GEOSArea_r(context(), valid.get(), &area);
  return area;
}

}  // namespace blockrand::geometry
