// Ground heights from any raster that GDAL reads.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/georef/lon_lat.h"

namespace blockrand::importers::elevation {

/// What a terrain raster says about itself. For build.json and `info`.
struct TerrainDescription {
  std::string path;
  std::string crs_name, crs_code;            ///< horizontal; code "EPSG:31256" or empty
  std::string vertical_name, vertical_code;  ///< empty when the raster names no height system
  bool ellipsoidal = false;                  ///< its CRS has three dimensions: heights above the ellipsoid
  std::string operation;                     ///< PROJ's operation from WGS 84
  double accuracy_m = -1;                    ///< of that operation; -1 unknown
  double pixel_width = 0, pixel_height = 0;  ///< in units of the CRS (metres or degrees), always positive
  long long columns = 0, rows = 0;
  std::optional<double> nodata;
};

/// m in the raster's height system; the lowest rounded down to 1/1024 m, the highest up.
struct GroundRange {
  double lowest = 0, highest = 0;
};

/// m, in whatever height system: land lies between the shore of the Dead Sea (-440) and Everest (8,849); mines and geoids
/// have room. What lies beyond is no height but a mark for "unknown" that the file does not declare.
struct PlausibleHeights {
  double lowest = -1000, highest = 10000;
};

/// A terrain raster (its first band), opened for reading.
///
/// Safe for const use from any number of threads: GDAL is read under a lock into blocks of 256 x 256 pixels, of which
/// at most 32 MB are kept (GDAL's own cache is held to the same size). Results do not depend on what the cache holds.
/// Nodata, masked, NaN and implausible pixels count as missing; the band's scale, offset and unit are applied.
class Terrain {
 public:
  /// \param metres_per_unit  of the values where the band names no unit; else that of the raster's vertical CRS, or 1
  /// \throws base::InputError  with remedy: no such file, a directory, no raster, no band, no georeference, no CRS, a
  ///                           CRS that PROJ cannot reach from WGS 84, a unit that is no length
  /// \param plausible        what is beyond counts as missing
  explicit Terrain(const std::string& path, std::optional<double> metres_per_unit = {},
                   PlausibleHeights plausible = {});
  ~Terrain();
  Terrain(Terrain&&) noexcept;
  Terrain& operator=(Terrain&&) noexcept;

  /// Ground under a polygon: its rings, outer and holes in any order (even-odd: courtyards do not count), each without
  /// its first point again at the end.
  ///
  /// Exact for the surface that is bilinear between the four nearest pixel centres that have a value and goes on flat
  /// from the outermost centres to the raster's edge: such a surface has no extremes inside of a cell, so that those of
  /// the pixel centres inside and those along the rings (widen) are all. Rings are straight between their points in the
  /// raster's coordinates; positions are rounded to 1/65536 of a pixel. What lies on no known ground is left out.
  /// \returns  nothing where all of it does (the caller reports TERRAIN_MISSING)
  /// \throws base::InputError  when the file can no longer be read
  std::optional<GroundRange> range_under(std::span<const std::vector<georef::LonLat>> rings) const;

  /// Ground along a line, or at a single point; otherwise as range_under.
  std::optional<GroundRange> range_along(std::span<const georef::LonLat> line) const;

  const TerrainDescription& describe() const;

  /// A pixel whose value is beyond PlausibleHeights.
  struct Implausible {
    long long column = 0, row = 0;
    double metres = 0;
  };
  /// The first of those, by row and column, in all that was read so far. They count as missing.
  std::optional<Implausible> implausible() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace blockrand::importers::elevation
