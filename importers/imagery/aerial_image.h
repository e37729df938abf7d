// Aerial images from any raster that GDAL reads, as patches in the build's coordinates.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/georef/lon_lat.h"
#include "pipeline/georef/projection.h"

namespace blockrand::importers::imagery {

/// Where an image lies and what its giver says of it. Empty texts: the file is asked (TIFFTAG_DATETIME,
/// TIFFTAG_COPYRIGHT, ACQUISITIONDATETIME and the like), and if it is silent, nobody knows.
struct ImageSource {
  std::string path;         ///< a file, a .vrt, or one of GDAL's own names (/vsizip/...)
  std::string date;         ///< when it was taken: "2014", "2014-06" or "2014-06-21"
  std::string licence;      ///< "CC BY 4.0"
  std::string attribution;  ///< "Stadt Wien, data.wien.gv.at"
};

/// What an image says about itself. For build.json, `info` and the outputs it touched.
struct ImageDescription {
  ImageSource source;              ///< completed from the file's own metadata
  std::string crs_name, crs_code;  ///< horizontal; code "EPSG:31256" or empty
  std::string operation;           ///< PROJ's operation from WGS 84
  double accuracy_m = -1;          ///< of that operation; -1 unknown
  double pixel_m = 0;              ///< m on the ground, the longer side of a pixel in the middle of the image
  long long columns = 0, rows = 0;
  int bands = 0;          ///< of colour: 1 or 3
  bool infrared = false;  ///< a fourth band that is no alpha
  int bits = 8;           ///< of a sample as stored
  georef::GeoBox area;    ///< degrees; where it has pixels, nodata or not
};

/// m on the ground. Coarser images show no edge of a house.
inline constexpr double kCoarsestPixel = 1.0;

/// A rectangle of pixels in the build CRS, row by row from the north-west, x to the east.
/// Pixel (column, row) covers [west + column * size, ...) and (..., north - row * size].
struct Patch {
  double west = 0, north = 0;                  ///< m in the build CRS, whole multiples of `size`
  double size = 0;                             ///< m in the build CRS, side of a pixel
  int width = 0, height = 0;                   ///< pixels
  std::vector<std::uint8_t> red, green, blue;  ///< width * height each; grey images have three equal bands
  std::vector<std::uint8_t> infrared;          ///< as many, or empty
  std::vector<std::uint8_t> valid;  ///< 1 where the image has a pixel, 0 where not (nodata, mask, alpha, outside)
};

/// An aerial image, opened for reading.
///
/// Safe for const use from any number of threads. GDAL is read under a lock and its block cache held to a fixed size;
/// memory beside that is that of the patches asked for. A patch's bytes depend on the file, the place and the pixel size
/// alone: not on what was read before, nor on how a larger area is divided into patches.
class AerialImage {
 public:
  /// \throws base::InputError  with remedy: no such file, a directory, no raster, no band that is a colour (alpha alone),
  ///                           no georeference or one that is not finite, no CRS, a CRS that PROJ cannot reach from
  ///                           WGS 84, pixels larger than kCoarsestPixel on the ground
  explicit AerialImage(const ImageSource& source);
  ~AerialImage();
  AerialImage(AerialImage&&) noexcept;
  AerialImage& operator=(AerialImage&&) noexcept;

  const ImageDescription& describe() const;

  /// The pixels of a rectangle of the build's coordinates, given in pixels of `size` metres from the CRS's origin:
  /// columns to the east from `column`, rows to the south from `row` (the patch's west is column * size, its north
  /// -row * size). Read from the overview, or averaged to the resolution, that is nearest to `size` and not coarser,
  /// then interpolated bilinearly; sixteen-bit samples are stretched to eight by a range measured once on the whole
  /// image. A palette becomes its colours.
  /// \param projection  of the build
  /// \throws base::InputError  when the file can no longer be read
  Patch patch(const georef::Projection& projection, double size, long long column, long long row, int width,
              int height) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace blockrand::importers::imagery
