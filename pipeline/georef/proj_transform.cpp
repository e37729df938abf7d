#include "pipeline/georef/proj_transform.h"

#include <cmath>

#include "pipeline/base/error.h"
#include "pipeline/georef/proj_handles.h"

namespace blockrand::georef {

using detail::Context;
using detail::Pj;

struct ProjTransform::State {
  Context context = detail::make_context();
  Pj operation;
  Pj cartesian{detail::proj().proj_create(
      context.get(), "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad +step +proj=cart +ellps=WGS84")};
  bool corrects = false;  ///< going there and back does not come home

  PJ_COORD transform(PJ* pj, PJ_DIRECTION direction, double x, double y, double z) {
    const PJ_COORD out = detail::proj().proj_trans(pj, direction, detail::proj().proj_coord(x, y, z, 0));
    if (!std::isfinite(out.xyz.x)) detail::proj().proj_errno_reset(pj);
    return out;
  }
};

ProjTransform::ProjTransform(const std::string& crs, const GeoBox& area) : state_(std::make_unique<State>()) {
  PJ_CONTEXT* context = state_->context.get();
  const std::unique_ptr<PJ_AREA, void (*)(PJ_AREA*)> box(detail::proj().proj_area_create(),
                                                         detail::proj().proj_area_destroy);
  // PROJ 9.1 recurses without end on an area without width at +180.
  constexpr double kLeast = 1e-6;  // degrees
  const double west = area.west >= 180 - kLeast ? 180 - 2 * kLeast : area.west;
  const double east = area.east >= west && area.east - west < kLeast ? west + kLeast : area.east;
  detail::proj().proj_area_set_bbox(box.get(), west, area.south, east, area.north);
  const Pj either(detail::proj().proj_create_crs_to_crs(context, "EPSG:4326", crs.c_str(), box.get()));
  if (either) state_->operation = Pj(detail::proj().proj_normalize_for_visualization(context, either.get()));
  if (!state_->operation || !state_->cartesian) throw base::UsageError("PROJ knows no operation from WGS 84 to " + crs);
  state_->corrects = true;
}

ProjTransform::ProjTransform(const std::string& pipeline) : state_(std::make_unique<State>()) {
  state_->operation = Pj(detail::proj().proj_create(state_->context.get(), pipeline.c_str()));
  if (!state_->operation || !state_->cartesian)
    throw base::UsageError("PROJ cannot use the operation \"" + pipeline + "\"");
  state_->corrects = pipeline.find("+proj=push") != std::string::npos;
}

ProjTransform::~ProjTransform() = default;
ProjTransform::ProjTransform(ProjTransform&&) noexcept = default;
ProjTransform& ProjTransform::operator=(ProjTransform&&) noexcept = default;

model::Point2 ProjTransform::forward(LonLat p) {
  const PJ_COORD out = state_->transform(state_->operation.get(), PJ_FWD, p.lon, p.lat, 0);
  return {out.xy.x, out.xy.y};
}

LonLat ProjTransform::inverse(model::Point2 p) {
  PJ_COORD out = state_->transform(state_->operation.get(), PJ_INV, p.x, p.y, 0);
  if (state_->corrects && std::isfinite(out.xy.x)) {
    const model::Point2 again = forward({out.xy.x, out.xy.y});
    out = state_->transform(state_->operation.get(), PJ_INV, 2 * p.x - again.x, 2 * p.y - again.y, 0);
  }
  return {out.xy.x, out.xy.y};
}

Geodetic ProjTransform::to_geodetic(const model::Point3& ecef) {
  const PJ_COORD out = state_->transform(state_->cartesian.get(), PJ_INV, ecef.x, ecef.y, ecef.z);
  return {out.xyz.x, out.xyz.y, out.xyz.z};
}

model::Point3 ProjTransform::to_ecef(const Geodetic& place) {
  const PJ_COORD out = state_->transform(state_->cartesian.get(), PJ_FWD, place.lon, place.lat, place.height);
  return {out.xyz.x, out.xyz.y, out.xyz.z};
}

}  // namespace blockrand::georef
