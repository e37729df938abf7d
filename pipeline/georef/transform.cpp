#include "pipeline/georef/transform.h"

#include <charconv>
#include <cmath>
#include <mutex>
#include <sstream>
#include <vector>

#include "pipeline/base/error.h"
#include "pipeline/georef/proj_handles.h"
#include "pipeline/georef/transverse_mercator.h"

namespace blockrand::georef {
namespace {

using detail::Context;
using detail::Pj;

/// Agreement that our series must reach with PROJ, on the ground.
constexpr double kSeriesToleranceMetres = 1e-6;
constexpr double kSeriesToleranceDegrees = 1e-11;  // about the same
constexpr int kSeriesSamples = 5;                  // along each side of the area

struct Worker {
  Context context;
  Pj operation;
};

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The projection's parameters when the pipeline is "degrees to radians, transverse Mercator" and nothing else.
std::optional<TransverseMercator::Parameters> transverse_mercator_of(const std::string& pipeline) {
  static constexpr std::string_view kPrefix =
      "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad +step +proj=";
  if (pipeline.compare(0, kPrefix.size(), kPrefix) != 0) return std::nullopt;
  std::istringstream words("+proj=" + pipeline.substr(kPrefix.size()));
  TransverseMercator::Parameters p;
  p.scale = 1, p.false_easting = 0;
  bool utm = false, known_projection = false, known_ellipsoid = false, south = false;
  double zone = 0;
  for (std::string word; words >> word;) {
    const auto equals = word.find('=');
    const std::string key = word.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : word.substr(equals + 1);
    const auto numeric = number(value);
    if (key == "+proj") {
      utm = value == "utm";
      known_projection = utm || value == "tmerc";
    } else if (key == "+ellps" && (value == "GRS80" || value == "WGS84")) {
      known_ellipsoid = true;
      p.inverse_flattening = value == "GRS80" ? 298.257222101 : 298.257223563;
    } else if (key == "+south") {
      south = true;
    } else if (key == "+zone" && numeric) {
      zone = *numeric;
    } else if (key == "+lat_0" && numeric) {
      p.latitude_of_origin = *numeric;
    } else if (key == "+lon_0" && numeric) {
      p.central_meridian = *numeric;
    } else if ((key == "+k" || key == "+k_0") && numeric) {
      p.scale = *numeric;
    } else if (key == "+x_0" && numeric) {
      p.false_easting = *numeric;
    } else if (key == "+y_0" && numeric) {
      p.false_northing = *numeric;
    } else {
      return std::nullopt;  // a step or parameter (units, +approx, a datum shift) that the series does not know
    }
  }
  if (!known_projection || !known_ellipsoid) return std::nullopt;
  if (utm) {
    if (zone < 1 || zone > 60) return std::nullopt;
    p.central_meridian = 6 * zone - 183;
    p.scale = 0.9996, p.false_easting = 500000, p.false_northing = south ? 1e7 : 0;
  }
  return p;
}

/// The horizontal part of a CRS, or nothing when PROJ does not know it.
Pj horizontal_crs(PJ_CONTEXT* context, const std::string& definition) {
  Pj crs(detail::proj().proj_create(context, definition.c_str()));
  if (crs && !detail::proj().proj_is_crs(crs.get())) return nullptr;
  if (crs && detail::proj().proj_get_type(crs.get()) == PJ_TYPE_COMPOUND_CRS) {
    crs = Pj(detail::proj().proj_crs_get_sub_crs(context, crs.get(), 0));
  }
  return crs;
}

std::string code_of(const PJ* crs) {
  const std::string authority = detail::text(detail::proj().proj_get_id_auth_name(crs, 0));
  return authority.empty() ? authority : authority + ":" + detail::text(detail::proj().proj_get_id_code(crs, 0));
}

std::string shorten(const std::string& definition) {
  return definition.size() > 60 ? definition.substr(0, 57) + "..." : definition;
}

Pj best_operation(PJ_CONTEXT* context, const PJ* from, const PJ* to, const std::optional<GeoBox>& area, bool ballpark) {
  detail::Factory factory(detail::proj().proj_create_operation_factory_context(context, nullptr));
  detail::proj().proj_operation_factory_context_set_allow_ballpark_transformations(context, factory.get(),
                                                                                   ballpark ? 1 : 0);
  detail::proj().proj_operation_factory_context_set_grid_availability_use(
      context, factory.get(), PROJ_GRID_AVAILABILITY_DISCARD_OPERATION_IF_MISSING_GRID);
  detail::proj().proj_operation_factory_context_set_spatial_criterion(context, factory.get(),
                                                                      PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
  if (area) {
    // PROJ 9.1 recurses without end on an area without width at +180: give every area some.
    constexpr double kLeast = 1e-6;  // degrees
    const double west = area->west >= 180 - kLeast ? 180 - 2 * kLeast : area->west;
    double east = area->east;
    if (east >= west && east - west < kLeast) east = west + kLeast;
    detail::proj().proj_operation_factory_context_set_area_of_interest(context, factory.get(), west, area->south, east,
                                                                       area->north);
  }
  detail::PjList list(detail::proj().proj_create_operations(context, from, to, factory.get()));
  for (int i = 0; list && i < detail::proj().proj_list_get_count(list.get()); ++i) {
    Pj operation(detail::proj().proj_list_get(context, list.get(), i));
    if (!operation || !detail::proj().proj_coordoperation_is_instantiable(context, operation.get())) continue;
    const bool is_ballpark =
        detail::proj().proj_coordoperation_has_ballpark_transformation(context, operation.get()) != 0;
    if (is_ballpark == ballpark) return operation;
  }
  return nullptr;
}

}  // namespace

struct Transform::Impl {
  std::string operation, pipeline;
  double accuracy = -1;
  bool identity = false;
  // A datum shift through earth-centred coordinates that forgets the height it causes (push/pop v_3) is not inverted by
  // its inverse: 1.3 mm are missing in Switzerland. One correction brings that to nanometres.
  bool drops_height = false;
  std::optional<TransverseMercator> series;

  std::mutex mutex;
  std::vector<std::unique_ptr<Worker>> idle;  // guarded by mutex

  std::unique_ptr<Worker> borrow() {
    {
      const std::lock_guard lock(mutex);
      if (!idle.empty()) {
        auto worker = std::move(idle.back());
        idle.pop_back();
        return worker;
      }
    }
    auto worker = std::make_unique<Worker>();
    worker->context = detail::make_context();
    worker->operation = Pj(detail::proj().proj_create(worker->context.get(), pipeline.c_str()));
    if (!worker->operation) throw base::UsageError("PROJ cannot use its own operation \"" + pipeline + "\"");
    return worker;
  }

  model::Point2 through_proj(model::Point2 p, PJ_DIRECTION direction) {
    auto worker = borrow();
    PJ* pj = worker->operation.get();
    PJ_COORD out = detail::proj().proj_trans(pj, direction, detail::proj().proj_coord(p.x, p.y, 0, 0));
    if (drops_height && direction == PJ_INV && std::isfinite(out.xy.x)) {
      const PJ_COORD again = detail::proj().proj_trans(pj, PJ_FWD, detail::proj().proj_coord(out.xy.x, out.xy.y, 0, 0));
      const double dx = p.x - again.xy.x, dy = p.y - again.xy.y;
      out = detail::proj().proj_trans(pj, PJ_INV, detail::proj().proj_coord(p.x + dx, p.y + dy, 0, 0));
    }
    if (!std::isfinite(out.xy.x)) detail::proj().proj_errno_reset(pj);
    const std::lock_guard lock(mutex);
    idle.push_back(std::move(worker));
    return {out.xy.x, out.xy.y};
  }

  bool series_agrees(const GeoBox& box) {
    for (int i = 0; i < kSeriesSamples; ++i) {
      for (int j = 0; j < kSeriesSamples; ++j) {
        const LonLat p = box.at(i / (kSeriesSamples - 1.0), j / (kSeriesSamples - 1.0));
        const model::Point2 ours = series->forward(p), theirs = through_proj({p.lon, p.lat}, PJ_FWD);
        if (!(std::fabs(ours.x - theirs.x) <= kSeriesToleranceMetres) ||
            !(std::fabs(ours.y - theirs.y) <= kSeriesToleranceMetres)) {
          return false;
        }
        // Longitudes may come back a turn apart at the antimeridian, and mean nothing at a pole.
        const LonLat back = series->inverse(theirs);
        double lon_error = std::fabs(std::fmod(std::fabs(back.lon - p.lon), 360.0));
        if (lon_error > 180) lon_error = 360 - lon_error;
        if (std::fabs(p.lat) > 89.9) lon_error = 0;
        if (!(lon_error <= kSeriesToleranceDegrees * 10) || !(std::fabs(back.lat - p.lat) <= kSeriesToleranceDegrees)) {
          return false;
        }
      }
    }
    return true;
  }

  void finish(const std::optional<GeoBox>& area) {
    identity = pipeline == "+proj=noop";
    drops_height = pipeline.find("+proj=push") != std::string::npos;
    auto worker = borrow();  // throws now rather than at the first point
    idle.push_back(std::move(worker));
    if (const auto parameters = transverse_mercator_of(pipeline)) {
      series.emplace(*parameters);
      const double lon = parameters->central_meridian;
      const GeoBox box = area.value_or(GeoBox{lon - 3, -80, lon + 3, 80});
      if (!series_agrees(box)) series.reset();
    }
  }
};

Transform::Transform(const std::string& from, const std::string& to, const std::optional<GeoBox>& area)
    : impl_(std::make_shared<Impl>()) {
  const Context context = detail::make_context();
  const Pj source = horizontal_crs(context.get(), from), target = horizontal_crs(context.get(), to);
  if (!source) throw base::UsageError("PROJ knows no coordinate reference system \"" + shorten(from) + "\"");
  if (!target) throw base::UsageError("PROJ knows no coordinate reference system \"" + shorten(to) + "\"");
  Pj operation = best_operation(context.get(), source.get(), target.get(), area, false);
  const std::string pair = shorten(from) + " to " + shorten(to);
  if (!operation) {
    const bool ballpark = best_operation(context.get(), source.get(), target.get(), area, true) != nullptr;
    throw base::UsageError(
        "PROJ has no operation of known accuracy from " + pair +
        (ballpark ? ", only a \"ballpark\" one that leaves out the datum shift and may be wrong by hundreds of metres"
                  : "") +
        ". Choose another coordinate reference system, or install the grid that this one needs (package proj-data)");
  }
  impl_->operation = detail::text(detail::proj().proj_get_name(operation.get()));
  impl_->accuracy = detail::proj().proj_get_type(operation.get()) == PJ_TYPE_CONVERSION
                        ? 0
                        : detail::proj().proj_coordoperation_get_accuracy(context.get(), operation.get());
  const Pj normal(detail::proj().proj_normalize_for_visualization(context.get(), operation.get()));
  const char* pipeline =
      normal ? detail::proj().proj_as_proj_string(context.get(), normal.get(), PJ_PROJ_5, nullptr) : nullptr;
  if (pipeline == nullptr) throw base::UsageError("PROJ cannot write its operation from " + pair + " as a pipeline");
  impl_->pipeline = pipeline;
  impl_->finish(area);
}

Transform Transform::from_pipeline(const std::string& pipeline, const std::optional<GeoBox>& area) {
  auto impl = std::make_shared<Impl>();
  impl->pipeline = pipeline;
  impl->finish(area);
  return Transform(std::move(impl));
}

model::Point2 Transform::forward(model::Point2 p) const {
  if (impl_->identity) return p;
  if (impl_->series) return impl_->series->forward({p.x, p.y});
  return impl_->through_proj(p, PJ_FWD);
}

model::Point2 Transform::inverse(model::Point2 p) const {
  if (impl_->identity) return p;
  if (impl_->series) {
    const LonLat g = impl_->series->inverse(p);
    return {g.lon, g.lat};
  }
  return impl_->through_proj(p, PJ_INV);
}

const std::string& Transform::operation() const { return impl_->operation; }
double Transform::accuracy_m() const { return impl_->accuracy; }
const std::string& Transform::pipeline() const { return impl_->pipeline; }
bool Transform::portable() const { return impl_->identity || impl_->series.has_value(); }

std::optional<double> Transform::own_scale(LonLat p) const {
  if (!impl_->series) return std::nullopt;
  return impl_->series->scale(p);
}

VerticalCrs vertical_crs_of(const std::string& definition) {
  const Context context = detail::make_context();
  VerticalCrs result;
  Pj crs(detail::proj().proj_create(context.get(), definition.c_str()));
  if (!crs) return result;
  const auto axis = [&](const PJ* of, int index, const char** direction, double* unit) {
    const Pj axes(detail::proj().proj_crs_get_coordinate_system(context.get(), of));
    return axes && detail::proj().proj_cs_get_axis_count(context.get(), axes.get()) > index &&
           detail::proj().proj_cs_get_axis_info(context.get(), axes.get(), index, nullptr, nullptr, direction, unit,
                                                nullptr, nullptr, nullptr) != 0;
  };
  const PJ_TYPE type = detail::proj().proj_get_type(crs.get());
  if (type == PJ_TYPE_GEOGRAPHIC_3D_CRS || type == PJ_TYPE_PROJECTED_CRS) {
    result.ellipsoidal = axis(crs.get(), 2, nullptr, &result.metres_per_unit);
    return result;
  }
  if (type == PJ_TYPE_COMPOUND_CRS) crs = Pj(detail::proj().proj_crs_get_sub_crs(context.get(), crs.get(), 1));
  if (!crs || detail::proj().proj_get_type(crs.get()) != PJ_TYPE_VERTICAL_CRS) return result;
  result.name = detail::text(detail::proj().proj_get_name(crs.get()));
  result.authority_code = code_of(crs.get());
  const char* direction = nullptr;
  if (axis(crs.get(), 0, &direction, &result.metres_per_unit)) result.downwards = detail::text(direction) == "down";
  return result;
}

CrsName name_of_crs(const std::string& definition) {
  const Context context = detail::make_context();
  const Pj crs = horizontal_crs(context.get(), definition);
  if (!crs) return {};
  return {detail::text(detail::proj().proj_get_name(crs.get())), code_of(crs.get())};
}

}  // namespace blockrand::georef
