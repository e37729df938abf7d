#include "importers/imagery/image_bands.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "pipeline/base/error.h"
#include "pipeline/gdal/gdal_scope.h"

namespace blockrand::importers::imagery {
namespace {

/// Pixels along each side of the sample by which a range of values is measured.
constexpr int kSampleSide = 512;

/// Shares of a sample that are darker than black and brighter than white: glints and defects, not the scene.
constexpr double kDarkest = 0.005, kBrightest = 0.995;

[[noreturn]] void refuse(const std::string& path, const std::string& what, const std::string& remedy) {
  throw base::InputError(path, "", what, remedy);
}

/// The values between which nearly all of a sample lies.
Stretch measure(GDALDatasetH dataset, std::span<const int> bands, const std::string& path) {
  const int columns = gdal::api().GDALGetRasterXSize(dataset), rows = gdal::api().GDALGetRasterYSize(dataset);
  const int width = std::min(columns, kSampleSide), height = std::min(rows, kSampleSide);
  std::vector<double> all;
  std::vector<double> values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::vector<std::uint8_t> valid(values.size());
  for (const int number : bands) {
    GDALRasterBandH band = gdal::api().GDALGetRasterBand(dataset, number);
    const CPLErr read =
        gdal::api().GDALRasterIO(band, GF_Read, 0, 0, columns, rows, values.data(), width, height, GDT_Float64, 0, 0);
    const CPLErr masked = gdal::api().GDALRasterIO(gdal::api().GDALGetMaskBand(band), GF_Read, 0, 0, columns, rows,
                                                   valid.data(), width, height, GDT_Byte, 0, 0);
    if (read >= CE_Failure || masked >= CE_Failure)
      refuse(path, "the image cannot be read" + gdal::GdalScope::last_words(),
             "The file is damaged or was cut short; fetch it again");
    for (std::size_t i = 0; i < values.size(); ++i)
      if (valid[i] != 0 && std::isfinite(values[i])) all.push_back(values[i]);
  }
  if (all.empty()) return {0, 1};
  const auto at = [&](double share) {
    const auto place = all.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(all.size() - 1));
    std::nth_element(all.begin(), place, all.end());
    return *place;
  };
  const Stretch range{at(kDarkest), at(kBrightest)};
  return range.high > range.low ? range : Stretch{range.low, range.low + 1};
}

std::vector<std::array<std::uint8_t, 3>> palette_of(GDALColorTableH table) {
  std::vector<std::array<std::uint8_t, 3>> colours(static_cast<std::size_t>(gdal::api().GDALGetColorEntryCount(table)));
  for (std::size_t i = 0; i < colours.size(); ++i) {
    GDALColorEntry entry{};
    if (gdal::api().GDALGetColorEntryAsRGB(table, static_cast<int>(i), &entry) == 0) continue;
    const auto byte = [](short c) { return static_cast<std::uint8_t>(std::clamp<int>(c, 0, 255)); };
    colours[i] = {byte(entry.c1), byte(entry.c2), byte(entry.c3)};
  }
  return colours;
}

}  // namespace

ImageBands bands_of(GDALDatasetH dataset, const std::string& path) {
  ImageBands out;
  std::vector<int> others;  // neither red, green and blue by name nor a mask
  const int count = gdal::api().GDALGetRasterCount(dataset);
  for (int b = 1; b <= count; ++b) {
    const GDALColorInterp meaning =
        gdal::api().GDALGetRasterColorInterpretation(gdal::api().GDALGetRasterBand(dataset, b));
    if (meaning == GCI_RedBand)
      out.colour[0] = b;
    else if (meaning == GCI_GreenBand)
      out.colour[1] = b;
    else if (meaning == GCI_BlueBand)
      out.colour[2] = b;
    else if (meaning != GCI_AlphaBand)
      others.push_back(b);
  }
  const bool named = out.colour[0] != 0 && out.colour[1] != 0 && out.colour[2] != 0;
  if (!named) {
    others.clear();
    for (int b = 1; b <= count; ++b)
      if (gdal::api().GDALGetRasterColorInterpretation(gdal::api().GDALGetRasterBand(dataset, b)) != GCI_AlphaBand)
        others.push_back(b);
    if (others.empty())
      refuse(path, "has no band of colours",
             "An image needs a grey band or red, green and blue; gdalinfo lists its bands");
    out.grey = others.size() < 3;
    for (std::size_t c = 0; c < 3; ++c) out.colour[c] = out.grey ? others[0] : others[c];
    others.erase(others.begin(), others.begin() + (out.grey ? static_cast<std::ptrdiff_t>(others.size()) : 3));
  }
  if (!others.empty()) out.infrared = others.front();

  GDALRasterBandH first = gdal::api().GDALGetRasterBand(dataset, out.colour[0]);
  const GDALDataType type = gdal::api().GDALGetRasterDataType(first);
  if (gdal::api().GDALDataTypeIsComplex(type) != 0)
    refuse(path, "has complex numbers as samples: radar, not an image", "Name an image of visible light");
  out.bits = gdal::api().GDALGetDataTypeSizeBits(type);
  out.whole_bytes = type == GDT_Byte;
  if (out.grey && gdal::api().GDALGetRasterColorTable(first) != nullptr) {
    out.palette = palette_of(gdal::api().GDALGetRasterColorTable(first));
    out.grey = false;
    if (!out.whole_bytes)
      refuse(path, "has a palette of more than 256 colours", "Convert it: gdal_translate -expand rgb");
  }
  std::vector<int> bands(out.colour.begin(), out.colour.end());
  bands.erase(std::unique(bands.begin(), bands.end()), bands.end());
  for (const int b : bands)
    if ((gdal::api().GDALGetMaskFlags(gdal::api().GDALGetRasterBand(dataset, b)) & GMF_ALL_VALID) == 0)
      out.masked.push_back(b);
  if (!out.whole_bytes) out.stretch = measure(dataset, bands, path);
  return out;
}

}  // namespace blockrand::importers::imagery
