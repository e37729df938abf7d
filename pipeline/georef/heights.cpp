#include "pipeline/georef/heights.h"

#include <cmath>
#include <mutex>

#include "pipeline/georef/proj_handles.h"
#include "pipeline/model/point.h"

namespace blockrand::georef {

struct Geoid::Impl {
  std::mutex mutex;  // one PROJ object for all: undulations are asked once per tile
  detail::Context context = detail::make_context();
  detail::Pj operation;
  std::string name;
};

Geoid::Geoid() : impl_(std::make_shared<Impl>()) {
  PJ_CONTEXT* c = impl_->context.get();
  const detail::Pj ellipsoidal(proj_create(c, "EPSG:4979")), geoidal(proj_create(c, "EPSG:4326+5773"));
  if (!ellipsoidal || !geoidal) return;
  const detail::Factory factory(proj_create_operation_factory_context(c, nullptr));
  proj_operation_factory_context_set_allow_ballpark_transformations(c, factory.get(), 0);
  proj_operation_factory_context_set_grid_availability_use(c, factory.get(),
                                                           PROJ_GRID_AVAILABILITY_DISCARD_OPERATION_IF_MISSING_GRID);
  proj_operation_factory_context_set_spatial_criterion(c, factory.get(), PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
  const detail::PjList list(proj_create_operations(c, ellipsoidal.get(), geoidal.get(), factory.get()));
  for (int i = 0; list && i < proj_list_get_count(list.get()); ++i) {
    const detail::Pj candidate(proj_list_get(c, list.get(), i));
    if (!candidate || proj_coordoperation_has_ballpark_transformation(c, candidate.get())) continue;
    if (!proj_coordoperation_is_instantiable(c, candidate.get())) continue;
    impl_->operation = detail::Pj(proj_normalize_for_visualization(c, candidate.get()));
    impl_->name = detail::text(proj_get_name(candidate.get()));
    if (impl_->operation) return;
  }
}

bool Geoid::available() const { return impl_->operation != nullptr; }
const std::string& Geoid::operation() const { return impl_->name; }

std::string Geoid::remedy() {
  return "PROJ's EGM96 grid (egm96_15.gtx) is not installed: install the package proj-data, or give heights above the "
         "ellipsoid";
}

std::optional<double> Geoid::undulation(double lon_deg, double lat_deg) const {
  if (!available()) return std::nullopt;
  const std::lock_guard lock(impl_->mutex);
  const PJ_COORD out = proj_trans(impl_->operation.get(), PJ_FWD, proj_coord(lon_deg, lat_deg, 0, 0));
  if (!std::isfinite(out.xyz.z)) {
    proj_errno_reset(impl_->operation.get());
    return std::nullopt;
  }
  return model::snap(-out.xyz.z);
}

std::optional<double> geoid_undulation(double lon_deg, double lat_deg) {
  static const Geoid geoid;  // immutable, costs 10 ms to make
  return geoid.undulation(lon_deg, lat_deg);
}

}  // namespace blockrand::georef
