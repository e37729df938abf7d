// Which bands of a raster are colours, infrared or a mask, and how their samples become eight bits.
#pragma once

#include <gdal.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace blockrand::importers::imagery {

/// Values of a band that become 0 and 255.
struct Stretch {
  double low = 0, high = 255;
};

/// The bands of an open raster. Numbers count from 1; 0: there is none.
struct ImageBands {
  std::array<int, 3> colour{};  ///< red, green, blue; a grey image has the same three times
  int infrared = 0;
  bool grey = false;
  int bits = 8;                                      ///< of a sample
  bool whole_bytes = true;                           ///< samples are taken as they are
  Stretch stretch;                                   ///< one for all colours: their balance stays
  std::vector<std::array<std::uint8_t, 3>> palette;  ///< of an image with one band of indices; else empty
  std::vector<int> masked;                           ///< colour bands, each once, whose mask is not all valid
};

/// \param path  for messages
/// \throws base::InputError  no band that is a colour; samples that are complex numbers
ImageBands bands_of(GDALDatasetH dataset, const std::string& path);

}  // namespace blockrand::importers::imagery
