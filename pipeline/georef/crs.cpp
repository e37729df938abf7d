#include "pipeline/georef/crs.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

#include "pipeline/base/error.h"
#include "pipeline/georef/proj_handles.h"
#include "pipeline/georef/transform.h"

namespace blockrand::georef {
namespace {

/// Around Europe as choose_crs means it, from the Atlantic anticlockwise. Straight lines in degrees.
constexpr std::array<LonLat, 30> kEurope{{
    {-16.1, 35.93}, {-5.2, 35.93},  // Strait of Gibraltar
    {-1.0, 36.3},   {5.0, 37.8},   {9.5, 37.9},   {11.3, 37.3},  {11.5, 36.2},
    {12.0, 35.2},                                                                // Lampedusa in, Tunisia out
    {23.0, 34.3},   {34.9, 34.3},  {34.9, 35.8},  {32.0, 35.85},                 // Crete, Cyprus
    {28.4, 36.0},   {28.35, 36.5}, {27.5, 36.75}, {27.2, 37.3},  {27.06, 37.8},  // Rhodes, Kos, Samos
    {26.2, 38.2},   {26.2, 38.7},  {26.65, 39.0}, {26.5, 39.4},  {26.0, 40.6},   // Chios, Lesbos
    {26.6, 41.7},   {28.1, 41.95}, {40.2, 42.5},  {40.2, 84.7},                  // Thrace, Black Sea, eastern limit
    {-12.5, 84.7},  {-12.5, 60.0}, {-16.1, 60.0}, {-16.1, 36.0},                 // Iceland out
}};

int utm_zone(double lon, double lat) {
  int zone = static_cast<int>(std::floor((lon + 180) / 6)) + 1;
  zone = std::clamp(zone, 1, 60);
  if (lat >= 56 && lat < 64 && lon >= 3 && lon < 12) return 32;
  if (lat >= 72 && lat <= 84 && lon >= 0 && lon < 42) return lon < 9 ? 31 : lon < 21 ? 33 : lon < 33 ? 35 : 37;
  return zone;
}

/// \param extent  null: nobody knows yet
[[noreturn]] void refuse(const std::string& code, const std::string& why, const GeoBox* extent) {
  throw base::UsageError(
      "--crs " + code + " " + why + ". Use a projected system in metres, " +
      (extent != nullptr ? "for example " + choose_crs(extent->centre().lon, extent->centre().lat) + ", or"
                         : std::string("such as a UTM zone, or")) +
      " leave --crs out" + (extent != nullptr ? "" : ": the UTM zone of the extract is chosen then"));
}

/// "EPSG:25833" from what the user wrote; empty when it is no EPSG code.
std::string normal_code(std::string_view text) {
  constexpr std::string_view kAuthority = "EPSG:";
  if (text.size() > kAuthority.size() &&
      std::equal(kAuthority.begin(), kAuthority.end(), text.begin(),
                 [](char a, char b) { return a == static_cast<char>(std::toupper(static_cast<unsigned char>(b))); })) {
    text.remove_prefix(kAuthority.size());
  }
  const bool digits = !text.empty() && text.size() <= 6 &&
                      std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  return digits ? std::string(kAuthority) + std::string(text) : std::string();
}

/// Code and name of a CRS that a build can have. \param extent  for messages; null: nobody knows yet
Crs named_crs(const std::string& code, const GeoBox* extent) {
  Crs crs;
  crs.authority_code = normal_code(code);
  if (crs.authority_code.empty()) refuse(code, "is not an EPSG code", extent);
  const detail::Context context = detail::make_context();
  PJ_CONTEXT* c = context.get();
  const detail::Pj pj(
      detail::proj().proj_create_from_database(c, "EPSG", crs.authority_code.c_str() + 5, PJ_CATEGORY_CRS, 0, nullptr));
  if (!pj) refuse(code, "is unknown to PROJ's EPSG table", extent);
  crs.name = detail::text(detail::proj().proj_get_name(pj.get()));
  const std::string named = "(" + crs.name + ") ";
  if (detail::proj().proj_get_type(pj.get()) == PJ_TYPE_COMPOUND_CRS) {
    const detail::Pj flat(detail::proj().proj_crs_get_sub_crs(c, pj.get(), 0));
    const char* part = flat ? detail::proj().proj_get_id_code(flat.get(), 0) : nullptr;
    refuse(code,
           named + "carries a height system too; give its horizontal part" +
               (part != nullptr ? " EPSG:" + std::string(part) : std::string()),
           extent);
  }
  if (detail::proj().proj_get_type(pj.get()) != PJ_TYPE_PROJECTED_CRS)
    refuse(code, named + "is not a projected system", extent);
  const detail::Pj axes(detail::proj().proj_crs_get_coordinate_system(c, pj.get()));
  std::string directions;
  for (int i = 0; i < detail::proj().proj_cs_get_axis_count(c, axes.get()); ++i) {
    const char* direction = nullptr;
    const char* unit = nullptr;
    double metres = 0;
    detail::proj().proj_cs_get_axis_info(c, axes.get(), i, nullptr, nullptr, &direction, &metres, &unit, nullptr,
                                         nullptr);
    if (metres != 1.0) refuse(code, named + "counts in " + detail::text(unit) + ", not in metres", extent);
    directions += detail::text(direction) + ' ';
  }
  if (directions != "east north " && directions != "north east ") {
    refuse(code, named + "does not count to the east and north (its axes: " + directions + ")", extent);
  }
  return crs;
}

}  // namespace

bool in_etrs89_europe(double lon, double lat) {
  bool inside = false;
  for (std::size_t i = 0, j = kEurope.size() - 1; i < kEurope.size(); j = i++) {
    const LonLat a = kEurope[i], b = kEurope[j];
    if ((a.lat > lat) == (b.lat > lat)) continue;
    if (lon < a.lon + (lat - a.lat) / (b.lat - a.lat) * (b.lon - a.lon)) inside = !inside;
  }
  return inside;
}

std::string choose_crs(double lon, double lat) {
  const int zone = utm_zone(lon, lat);
  if (in_etrs89_europe(lon, lat) && zone >= 28 && zone <= 38) return "EPSG:" + std::to_string(25800 + zone);
  return "EPSG:" + std::to_string((lat < 0 ? 32700 : 32600) + zone);
}

void check_crs(const std::string& code) { named_crs(code, nullptr); }

Crs open_crs(const std::string& code, const GeoBox& extent) {
  Crs crs = named_crs(code, &extent);
  const std::string named = "(" + crs.name + ") ";
  try {
    const Transform transform("EPSG:4326", crs.authority_code, extent);
    crs.operation = transform.operation();
    crs.accuracy_m = transform.accuracy_m();
    crs.pipeline = transform.pipeline();
    const LonLat centre = extent.centre();
    const model::Point2 p = transform.forward({centre.lon, centre.lat});
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) refuse(code, named + "is not defined where the data lies", &extent);
  } catch (const base::UsageError& error) {
    if (std::string_view(error.what()).starts_with("--crs")) throw;
    throw base::UsageError("--crs " + code + " " + named + "cannot be used: " + error.what());
  }
  return crs;
}

}  // namespace blockrand::georef
