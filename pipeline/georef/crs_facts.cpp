#include "pipeline/georef/crs_facts.h"

#include "pipeline/georef/proj_handles.h"
#include "pipeline/georef/transform.h"

namespace blockrand::georef {
namespace {

bool is_geographic(PJ_TYPE type) {
  return type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS || type == PJ_TYPE_GEOGRAPHIC_CRS;
}

}  // namespace

std::optional<CrsFacts> crs_facts(const std::string& definition) {
  const detail::Context context = detail::make_context();
  PJ_CONTEXT* c = context.get();
  detail::Pj crs(detail::proj().proj_create(c, definition.c_str()));
  if (!crs || !detail::proj().proj_is_crs(crs.get())) return std::nullopt;
  CrsFacts facts;
  if (detail::proj().proj_get_type(crs.get()) == PJ_TYPE_COMPOUND_CRS) {
    facts.vertical_code = vertical_crs_of(definition).authority_code;
    crs = detail::Pj(detail::proj().proj_crs_get_sub_crs(c, crs.get(), 0));
    if (!crs) return std::nullopt;
  }
  PJ_TYPE type = detail::proj().proj_get_type(crs.get());
  if (type == PJ_TYPE_BOUND_CRS) {
    const detail::Pj base(detail::proj().proj_get_source_crs(c, crs.get()));
    if (base) type = detail::proj().proj_get_type(base.get());
  }
  facts.geographic = is_geographic(type);
  facts.projected = type == PJ_TYPE_PROJECTED_CRS;
  if (!facts.geographic && !facts.projected) return std::nullopt;  // vertical, geocentric, engineering
  facts.name = detail::text(detail::proj().proj_get_name(crs.get()));
  const std::string authority = detail::text(detail::proj().proj_get_id_auth_name(crs.get(), 0));
  if (!authority.empty())
    facts.authority_code = authority + ":" + detail::text(detail::proj().proj_get_id_code(crs.get(), 0));
  const detail::Pj axes(detail::proj().proj_crs_get_coordinate_system(c, crs.get()));
  const char* direction = nullptr;
  double unit = 1;
  if (axes && detail::proj().proj_cs_get_axis_info(c, axes.get(), 0, nullptr, nullptr, &direction, &unit, nullptr,
                                                   nullptr, nullptr)) {
    facts.north_first = detail::text(direction) == "north" || detail::text(direction) == "south";
    if (facts.projected && unit > 0) facts.metres_per_unit = unit;
  }
  GeoBox area;
  // PROJ gives -1000 where it knows no area.
  if (detail::proj().proj_get_area_of_use(c, crs.get(), &area.west, &area.south, &area.east, &area.north, nullptr) &&
      area.west >= -180 && area.south >= -90) {
    facts.area = area;
  }
  return facts;
}

}  // namespace blockrand::georef
