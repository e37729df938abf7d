// The coordinate reference system of a build: chosen from its place, or given and checked.
#pragma once

#include <string>

#include "pipeline/georef/lon_lat.h"

namespace blockrand::georef {

/// A projected CRS in metres, with the one operation that leads to it from WGS 84. Written to build.json and pinned
/// there.
struct Crs {
  std::string authority_code;  ///< "EPSG:25833"
  std::string name;            ///< "ETRS89 / UTM zone 33N"
  std::string operation;       ///< PROJ's name of the operation from WGS 84
  double accuracy_m = -1;      ///< metres, as PROJ states it; 0 without a change of datum, -1 unknown
  std::string pipeline;  ///< the operation as a PROJ pipeline, longitude and latitude in degrees to easting, northing
};

/// The CRS for a build around a place: ETRS89 / UTM (EPSG:258zz) in Europe, WGS 84 / UTM (EPSG:326zz, 327zz) elsewhere.
///
/// Europe is a polygon drawn around the states that use ETRS89 and the European plate up to 40.2 E (the extent that
/// EPSG gives ETRS89): without Iceland (on two plates), Turkey, North Africa, the Canaries. Zones 28 to 38 exist. UTM's
/// own exceptions hold: 32 for south-west Norway, 31/33/35/37 for Svalbard. Beyond 84 N and 80 S the UTM zone is used
/// too: the projection stays exact there. \param lon, lat  degrees; the centre of the extent
std::string choose_crs(double lon, double lat);

/// Whether choose_crs counts the place as Europe.
bool in_etrs89_europe(double lon, double lat);

/// What of open_crs can be said before anybody knows where the build lies.
///
/// \throws base::UsageError  it is no EPSG code, unknown, not projected, not in metres, or not counted east and north
void check_crs(const std::string& code);

/// Reads `--crs`: "EPSG:25833", "epsg:25833" or "25833".
///
/// \param extent  where the build lies, degrees: chooses among PROJ's operations
/// \throws base::UsageError with a remedy when it is no EPSG code, unknown, not projected, not in metres, not counted
/// east
///         and north, or when PROJ has only a "ballpark" operation to it
Crs open_crs(const std::string& code, const GeoBox& extent);

}  // namespace blockrand::georef
