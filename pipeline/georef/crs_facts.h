// What PROJ's database says about a coordinate reference system that a foreign file names.
#pragma once

#include <optional>
#include <string>

#include "pipeline/georef/lon_lat.h"

namespace blockrand::georef {

/// The horizontal part of a CRS.
struct CrsFacts {
  std::string name;            ///< "ETRS89 / UTM zone 33N"
  std::string authority_code;  ///< "EPSG:25833"; empty when the definition has no code
  bool geographic = false;     ///< degrees (or another angle) instead of lengths
  bool projected = false;
  /// The authority counts north (latitude) first and east (longitude) second. Software and files often do not.
  bool north_first = false;
  double metres_per_unit = 1;  ///< of a projected CRS; 1 for any other
  std::optional<GeoBox> area;  ///< area of use, degrees; nothing where the database has none
  std::string vertical_code;   ///< of a compound CRS, "EPSG:5783"; empty when there is none or it has no code
};

/// Nothing where PROJ knows no CRS of that definition. \param definition  "EPSG:25833", a compound "EPSG:25832+5783",
/// WKT, PROJ JSON, an OGC urn, or a name ("ETRS89 / UTM zone 33N")
std::optional<CrsFacts> crs_facts(const std::string& definition);

}  // namespace blockrand::georef
