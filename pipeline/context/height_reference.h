// What the heights of a build are measured from, and how they reach the ellipsoid.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/georef/heights.h"
#include "pipeline/georef/lon_lat.h"

namespace blockrand::importers::elevation {
struct TerrainDescription;
}

namespace blockrand::context {

/// What `--terrain-height-reference` asks for; throws base::UsageError where it is none of "sea-level", "ellipsoid" and
/// the EPSG code of a vertical CRS.
struct AskedReference {
  enum class Kind { unsaid, sea_level, ellipsoid, vertical_crs } kind = Kind::unsaid;
  std::string vertical_code, vertical_name;  ///< of vertical_crs: "EPSG:7837"
  std::optional<double> metres_per_unit;     ///< of vertical_crs
};
AskedReference read_height_reference(const std::string& text);

/// What it means for people that nothing says how high the ground is: by how much the model will lie wrong on a globe, as
/// far as the geoid tells. \param place  degrees; the middle of the build
std::string ground_warning(const georef::LonLat& place);

/// What z means in all outputs.
struct HeightReference {
  std::string words;         ///< "heights above sea level"
  std::string vertical_crs;  ///< "EPSG:7837" where it holds for metres; else empty, and none is claimed
  std::string in_tiles;  ///< what 3D Tiles have, which want ellipsoidal heights: "…, raised to the ellipsoid by EGM96"
  std::optional<georef::Geoid>
      raised_by;            ///< z plus its undulation is the height above the ellipsoid; nothing: z itself
  std::string raised_from;  ///< vertical CRS that `raised_by` was made for; empty: none, or one that PROJ does not know
  std::vector<std::string> warnings;
};

/// \param terrain  null for none
/// \throws base::UsageError  where neither the raster nor `asked` says what its heights are above
HeightReference choose_height_reference(const importers::elevation::TerrainDescription* terrain,
                                        const AskedReference& asked, bool has_ground_height);

}  // namespace blockrand::context
