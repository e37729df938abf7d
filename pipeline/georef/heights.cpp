#include "pipeline/georef/heights.h"

#include <cmath>
#include <mutex>

#include "pipeline/georef/proj_handles.h"
#include "pipeline/georef/transform.h"
#include "pipeline/model/point.h"

namespace blockrand::georef {

namespace {

struct Operation {
  detail::Pj pj;  ///< longitude and latitude in degrees, height
  double accuracy = -1;
};

/// The best operation whose grids are installed; null where there is none but "ballpark" ones.
Operation best_operation(PJ_CONTEXT* c, const std::string& from, const std::string& to) {
  const detail::Pj source(detail::proj().proj_create(c, from.c_str())),
      target(detail::proj().proj_create(c, to.c_str()));
  if (!source || !target) return {};
  const detail::Factory factory(detail::proj().proj_create_operation_factory_context(c, nullptr));
  detail::proj().proj_operation_factory_context_set_allow_ballpark_transformations(c, factory.get(), 0);
  detail::proj().proj_operation_factory_context_set_grid_availability_use(
      c, factory.get(), PROJ_GRID_AVAILABILITY_DISCARD_OPERATION_IF_MISSING_GRID);
  detail::proj().proj_operation_factory_context_set_spatial_criterion(c, factory.get(),
                                                                      PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
  const detail::PjList list(detail::proj().proj_create_operations(c, source.get(), target.get(), factory.get()));
  for (int i = 0; list && i < detail::proj().proj_list_get_count(list.get()); ++i) {
    const detail::Pj candidate(detail::proj().proj_list_get(c, list.get(), i));
    if (!candidate || detail::proj().proj_coordoperation_has_ballpark_transformation(c, candidate.get())) continue;
    if (!detail::proj().proj_coordoperation_is_instantiable(c, candidate.get())) continue;
    Operation found{detail::Pj(detail::proj().proj_normalize_for_visualization(c, candidate.get())),
                    detail::proj().proj_coordoperation_get_accuracy(c, candidate.get())};
    if (found.pj) return found;
  }
  return {};
}

std::string number_of(const std::string& code) { return code.substr(code.find(':') + 1); }

/// Height that comes out for height 0, in the target's unit.
std::optional<double> shift_at(const Operation& operation, double lon_deg, double lat_deg) {
  const PJ_COORD out =
      detail::proj().proj_trans(operation.pj.get(), PJ_FWD, detail::proj().proj_coord(lon_deg, lat_deg, 0, 0));
  if (std::isfinite(out.xyz.z)) return out.xyz.z;
  detail::proj().proj_errno_reset(operation.pj.get());
  return std::nullopt;
}

}  // namespace

struct Geoid::Impl {
  std::mutex mutex;  // one PROJ object for all: undulations are asked once per tile
  detail::Context context = detail::make_context();
  Operation from_ellipsoid;
  Operation levels;  ///< of a CRS that EGM96 stands in for, to EVRF2000
  bool stands_in = false;
  std::string words;
  double metres_per_unit = 1;
};

Geoid::Geoid(const std::string& vertical_crs) : impl_(std::make_shared<Impl>()) {
  PJ_CONTEXT* c = impl_->context.get();
  const auto raised = [&](const std::string& code) {
    return best_operation(c, "EPSG:4979", "EPSG:4326+" + number_of(code));
  };
  const VerticalCrs about = vertical_crs.empty() ? VerticalCrs{} : vertical_crs_of(vertical_crs);
  if (!about.authority_code.empty()) impl_->from_ellipsoid = raised(about.authority_code);
  if (impl_->from_ellipsoid.pj) {
    impl_->metres_per_unit = about.metres_per_unit;
    impl_->words = about.authority_code == kEgm96 ? "EGM96" : "PROJ (" + about.name + ")";
    return;
  }
  impl_->stands_in = vertical_crs != kEgm96;
  impl_->from_ellipsoid = raised(kEgm96);
  impl_->words = "EGM96";
  if (!impl_->stands_in) return;
  impl_->words += " in place of " + (about.name.empty() ? "a height system that PROJ does not know" : about.name);
  // Shifts are asked for in metres: those between height systems in other units are left out.
  if (!about.authority_code.empty() && about.metres_per_unit == 1)
    impl_->levels =
        best_operation(c, "EPSG:4258+" + number_of(about.authority_code), "EPSG:4258+" + number_of(kEuropeanLevels));
  impl_->words += impl_->levels.pj
                      ? ", after PROJ's shift to EVRF2000 (to about half a metre)"
                      : ", for which PROJ has no grid (zero levels differ by a metre or two, some by far more)";
}

bool Geoid::available() const { return impl_->from_ellipsoid.pj != nullptr; }
bool Geoid::stands_in() const { return impl_->stands_in; }
const std::string& Geoid::words() const { return impl_->words; }
double Geoid::accuracy_m() const { return impl_->stands_in ? -1 : impl_->from_ellipsoid.accuracy; }

std::string Geoid::remedy() {
  return "PROJ's EGM96 grid (egm96_15.gtx) is not installed: install the package proj-data, or give heights above the "
         "ellipsoid";
}

std::optional<double> Geoid::undulation(double lon_deg, double lat_deg) const {
  if (!available()) return std::nullopt;
  const std::lock_guard lock(impl_->mutex);
  const std::optional<double> below = shift_at(impl_->from_ellipsoid, lon_deg, lat_deg);
  if (!below) return std::nullopt;
  double up = -*below * impl_->metres_per_unit;
  if (impl_->levels.pj) up += shift_at(impl_->levels, lon_deg, lat_deg).value_or(0);
  return model::snap(up);
}

}  // namespace blockrand::georef
