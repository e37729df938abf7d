// Ground heights from any raster that GDAL reads.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "pipeline/georef/lon_lat.h"
#include "pipeline/model/point.h"

namespace blockrand::importers::elevation {

/// What a terrain raster says about itself. For build.json and `info`.
struct TerrainDescription {
  std::string path;
  std::string crs_name, crs_code;            ///< horizontal; code "EPSG:31256" or empty
  std::string vertical_name, vertical_code;  ///< empty when the raster names no height system
  std::string operation;                     ///< PROJ's operation from WGS 84
  double accuracy_m = -1;                    ///< of that operation; -1 unknown
  double pixel_width = 0, pixel_height = 0;  ///< in units of the CRS (metres or degrees), always positive
  long long columns = 0, rows = 0;
  std::optional<double> nodata;
};

/// A terrain raster (its first band), opened for reading.
///
/// Safe for const use from any number of threads: GDAL is read under a lock into blocks of 256 x 256 pixels, of which
/// at most 32 MB are kept (GDAL's own cache is held to the same size). Results do not depend on what the cache holds.
/// Nodata, masked and NaN pixels count as missing; the band's scale, offset and unit are applied.
class Terrain {
 public:
  /// \throws base::InputError  with remedy: no such file, a directory, no raster, no band, no georeference, no CRS, a
  /// CRS
  ///                           that PROJ cannot reach from WGS 84, a unit that is no length
  explicit Terrain(const std::string& path);
  ~Terrain();
  Terrain(Terrain&&) noexcept;
  Terrain& operator=(Terrain&&) noexcept;

  /// Lowest ground under a ring, metres in the raster's height system, rounded to 1/1024 m.
  ///
  /// The minimum over the pixels whose centre lies in the ring (even-odd) and the bilinear values at its vertices; of a
  /// single location: its bilinear value. Bilinear means between the four nearest pixel centres that have a value, and
  /// towards the raster's edge the nearest ones. Nothing when the ring has no pixel and no vertex on ground that is
  /// known (the caller reports TERRAIN_MISSING). \throws base::InputError when the file can no longer be read
  std::optional<double> minimum_under(std::span<const model::Location> ring) const;

  const TerrainDescription& describe() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace blockrand::importers::elevation
