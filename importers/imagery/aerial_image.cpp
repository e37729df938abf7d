#include "importers/imagery/aerial_image.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <system_error>
#include <utility>

#include "importers/imagery/image_bands.h"
#include "importers/imagery/pixel_blocks.h"
#include "pipeline/base/error.h"
#include "pipeline/gdal/gdal_scope.h"
#include "pipeline/georef/transform.h"

namespace blockrand::importers::imagery {
namespace {

constexpr GIntBig kMaxGdalCache = 64 << 20;  // bytes; GDAL's default is a twentieth of the machine

/// Pixels of a patch between places that are transformed one by one: positions between them are interpolated. At 0.2 m
/// that is 3 m, over which no projection bends by a hundredth of a pixel.
constexpr int kNode = 16;

/// Positions in the image are rounded to this fraction of a pixel, so that the last bits of a projection decide nothing.
constexpr int kFractions = 256;

/// m per degree: of a meridian, and of the equator. WGS 84, to a hundredth; for the size of pixels only.
constexpr double kMetresPerDegree = 111'320, kMetresPerDegreeNorth = 111'132;

/// Points along each side of an image whose places give its area.
constexpr int kAreaSteps = 16;

/// GDAL's confidence in per cent from which on an entry of EPSG is taken for what a .prj file describes.
constexpr int kSureMatch = 90;

using FromPixel = std::array<double, 6>;

model::Point2 at(const FromPixel& g, double column, double row) {
  return {g[0] + g[1] * column + g[2] * row, g[3] + g[4] * column + g[5] * row};
}

std::string metadata(GDALDatasetH dataset, const char* domain, const char* key) {
  const char* value = gdal::api().GDALGetMetadataItem(dataset, key, domain);
  return value != nullptr ? value : "";
}

/// "2014:06:21 10:02:11" and "2014-06-21T10:02:11Z" as "2014-06-21"; empty for what is no date.
std::string day_of(std::string text) {
  text.resize(std::min<std::size_t>(text.size(), 10));
  if (text.size() < 10) return "";
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (i == 4 || i == 7)
      text[i] = '-';
    else if (text[i] < '0' || text[i] > '9')
      return "";
  }
  return text.starts_with("0000") ? "" : text;
}

/// As WKT; empty for none.
std::string definition_of(OGRSpatialReferenceH reference) {
  if (reference == nullptr) return "";
  char* wkt = nullptr;
  static constexpr std::array<const char*, 2> kFormat{"FORMAT=WKT2_2019", nullptr};
  std::string text;
  if (gdal::api().OSRExportToWktEx(reference, &wkt, kFormat.data()) == OGRERR_NONE && wkt != nullptr) text = wkt;
  gdal::api().VSIFree(wkt);
  return text;
}

/// Of the .prj file beside an image, which GDAL reads for few formats only; empty where there is none.
std::string definition_beside(const std::string& path) {
  const std::string place = std::filesystem::path(path).replace_extension(".prj");
  VSIStatBufL status;
  if (gdal::api().VSIStatL(place.c_str(), &status) != 0) return "";
  char** lines = gdal::api().CSLLoad(place.c_str());
  OGRSpatialReferenceH reference = gdal::api().OSRNewSpatialReference(nullptr);
  std::string text;
  if (lines != nullptr && gdal::api().OSRImportFromESRI(reference, lines) == OGRERR_NONE) {
    int count = 0;
    int* confidences = nullptr;
    // The entry of EPSG that it means has the datum's transformations; ESRI's text has none.
    OGRSpatialReferenceH* matches = gdal::api().OSRFindMatches(reference, nullptr, &count, &confidences);
    text = definition_of(count > 0 && confidences[0] >= kSureMatch ? matches[0] : reference);
    gdal::api().OSRFreeSRSArray(matches);
    gdal::api().VSIFree(confidences);
  }
  gdal::api().CSLDestroy(lines);
  gdal::api().OSRDestroySpatialReference(reference);
  return text;
}

struct OpenImage {
  std::unique_ptr<void, gdal::CloseDataset> dataset;
  FromPixel from_pixel{}, to_pixel{};
  std::string definition;  // of the CRS
};

OpenImage open(const std::string& path) {
  const auto refuse = [&path](const std::string& what, const std::string& remedy) {
    throw base::InputError(path, "", what, remedy);
  };
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (!path.starts_with("/vsi") && !std::filesystem::exists(status))
    refuse("no such image", "Check the path given to --imagery");
  if (std::filesystem::is_directory(status))
    refuse("is a directory, not an image",
           "Name the images, or join them without copying: gdalbuildvrt images.vrt " + path + "/*.tif");
  gdal::register_drivers();
  if (gdal::api().GDALGetCacheMax64() > kMaxGdalCache) gdal::api().GDALSetCacheMax64(kMaxGdalCache);
  OpenImage image;
  image.dataset.reset(
      gdal::api().GDALOpenEx(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
  if (!image.dataset)
    refuse("is no image that GDAL can read" + gdal::GdalScope::last_words(),
           "Check with gdalinfo; the file may be damaged or of another kind");
  GDALDatasetH dataset = image.dataset.get();
  if (gdal::api().GDALGetRasterCount(dataset) < 1)
    refuse("has no bands", "Name one of its sub-datasets (gdalinfo lists them)");
  const bool placed =
      gdal::api().GDALGetGeoTransform(dataset, image.from_pixel.data()) == CE_None &&
      std::all_of(image.from_pixel.begin(), image.from_pixel.end(), [](double v) { return std::isfinite(v); }) &&
      gdal::api().GDALInvGeoTransform(image.from_pixel.data(), image.to_pixel.data()) != 0;
  if (!placed)
    refuse(
        "has no georeference",
        "Put a world file beside it or set one with gdal_edit.py -a_ullr; images with control points: gdalwarp first");
  image.definition = definition_of(gdal::api().GDALGetSpatialRef(dataset));
  if (image.definition.empty()) image.definition = definition_beside(path);
  if (image.definition.empty())
    refuse("has no coordinate reference system",
           "Set it with gdal_edit.py -a_srs EPSG:..., or put a .prj file beside it");
  return image;
}

}  // namespace

struct AerialImage::Impl {
  ImageDescription description;
  FromPixel to_pixel{};
  std::optional<georef::Transform> transform;  // WGS 84 to the image's CRS
  std::unique_ptr<PixelBlocks> blocks;

  /// Continuous position in the image: (0, 0) is the upper left corner.
  model::Point2 pixel_of(georef::LonLat place) const {
    const model::Point2 p = transform->forward({place.lon, place.lat});
    return at(to_pixel, p.x, p.y);
  }
};

AerialImage::AerialImage(const ImageSource& source) : impl_(std::make_unique<Impl>()) {
  const gdal::GdalScope scope;
  OpenImage image = open(source.path);
  GDALDatasetH dataset = image.dataset.get();
  ImageDescription& d = impl_->description;
  impl_->to_pixel = image.to_pixel;
  d.source = source;
  d.columns = gdal::api().GDALGetRasterXSize(dataset);
  d.rows = gdal::api().GDALGetRasterYSize(dataset);
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    throw base::InputError(source.path, "", what, remedy);
  };
  const auto columns = static_cast<double>(d.columns), rows = static_cast<double>(d.rows);
  georef::GeoBox area{180, 90, -180, -90};
  const auto measure_area = [&] {
    area = {180, 90, -180, -90};
    for (int i = 0; i <= kAreaSteps; ++i)
      for (int j = 0; j <= kAreaSteps; ++j) {
        if (i % kAreaSteps != 0 && j % kAreaSteps != 0) continue;
        const model::Point2 p =
            impl_->transform->inverse(at(image.from_pixel, columns * i / kAreaSteps, rows * j / kAreaSteps));
        area.west = std::min(area.west, p.x), area.east = std::max(area.east, p.x);
        area.south = std::min(area.south, p.y), area.north = std::max(area.north, p.y);
      }
    return area.west >= -180 && area.east <= 180 && area.south >= -90 && area.north <= 90 && area.west < area.east &&
           area.south < area.north;
  };
  try {
    // Which operation is best depends on the place, and the place is known through an operation: twice, then.
    impl_->transform.emplace("EPSG:4326", image.definition);
    if (!measure_area())
      refuse("lies nowhere on Earth by its georeference and coordinate reference system",
             "One of the two is wrong: compare gdalinfo with where the image should be");
    impl_->transform.emplace("EPSG:4326", image.definition, area);
    measure_area();
  } catch (const base::UsageError& error) {
    refuse("its coordinate reference system cannot be used: " + std::string(error.what()),
           "Reproject it: gdalwarp -t_srs EPSG:...");
  }
  d.area = area;

  const model::Point2 middle = at(image.from_pixel, columns / 2, rows / 2);
  const model::Point2 here = impl_->transform->inverse(middle);
  const auto length = [&](double column, double row) {
    const model::Point2 p = impl_->transform->inverse(at(image.from_pixel, columns / 2 + column, rows / 2 + row));
    constexpr double kDegree = 0.017453292519943295;
    return std::hypot((p.x - here.x) * kMetresPerDegree * std::cos(here.y * kDegree),
                      (p.y - here.y) * kMetresPerDegreeNorth);
  };
  d.pixel_m = std::max(length(1, 0), length(0, 1));
  if (!(d.pixel_m <= kCoarsestPixel))
    refuse(fmt::format("its pixels are {:.2f} m on the ground; edges of houses show in pixels of {:g} m and less",
                       d.pixel_m, kCoarsestPixel),
           "Use a finer image");

  const georef::CrsName name = georef::name_of_crs(image.definition);
  d.crs_name = name.name, d.crs_code = name.authority_code;
  d.operation = impl_->transform->operation();
  d.accuracy_m = impl_->transform->accuracy_m();
  const ImageBands bands = bands_of(dataset, source.path);
  d.bands = bands.grey ? 1 : 3;
  d.infrared = bands.infrared != 0;
  d.bits = bands.bits;
  if (d.source.date.empty()) d.source.date = day_of(metadata(dataset, "IMAGERY", "ACQUISITIONDATETIME"));
  if (d.source.date.empty()) d.source.date = day_of(metadata(dataset, nullptr, "TIFFTAG_DATETIME"));
  if (d.source.attribution.empty()) d.source.attribution = metadata(dataset, nullptr, "TIFFTAG_COPYRIGHT");
  impl_->blocks = std::make_unique<PixelBlocks>(std::move(image.dataset), bands, source.path);
}

AerialImage::~AerialImage() = default;
AerialImage::AerialImage(AerialImage&&) noexcept = default;
AerialImage& AerialImage::operator=(AerialImage&&) noexcept = default;

const ImageDescription& AerialImage::describe() const { return impl_->description; }

namespace {

/// Looks up pixels of one level, keeping the last block at hand.
class LevelReader {
 public:
  LevelReader(PixelBlocks& blocks, int level)
      : blocks_(blocks), level_(level), columns_(blocks.columns(level)), rows_(blocks.rows(level)) {}

  /// Five bytes, or null beyond the image.
  const std::uint8_t* operator()(long long column, long long row) {
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return nullptr;
    const long long c = column / kBlockSide, r = row / kBlockSide;
    if (!block_ || c != block_column_ || r != block_row_) {
      block_ = blocks_.block(level_, c, r);
      block_column_ = c, block_row_ = r;
    }
    return block_->at(static_cast<int>(column % kBlockSide), static_cast<int>(row % kBlockSide));
  }

  /// The first of two by two pixels that lie in one block: the next stands five bytes farther, the lower ones kBlockLine.
  /// Null where they do not.
  const std::uint8_t* four(long long column, long long row) {
    if (column < 0 || row < 0 || column + 1 >= columns_ || row + 1 >= rows_) return nullptr;
    if (column % kBlockSide == kBlockSide - 1 || row % kBlockSide == kBlockSide - 1) return nullptr;
    return (*this)(column, row);
  }
  static constexpr std::size_t kBlockLine = 5UL * kBlockSide;

 private:
  PixelBlocks& blocks_;
  int level_;
  long long columns_, rows_;
  std::shared_ptr<const PixelBlock> block_;
  long long block_column_ = -1, block_row_ = -1;
};

long long floor_to(long long value, long long step) {
  return (value >= 0 ? value / step : -((-value + step - 1) / step)) * step;
}

/// Where the pixel centres of a patch lie in the image: exact at nodes of a grid that is fixed to the build's
/// coordinates, bilinear between.
class Positions {
 public:
  Positions(const std::function<model::Point2(double, double)>& exact, long long column, long long row, int width,
            int height)
      : first_column_(floor_to(column, kNode)), first_row_(floor_to(row, kNode)) {
    across_ = static_cast<int>((column + width - 1 - first_column_) / kNode) + 2;
    const int down = static_cast<int>((row + height - 1 - first_row_) / kNode) + 2;
    nodes_.reserve(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down));
    for (int j = 0; j < down; ++j)
      for (int i = 0; i < across_; ++i)
        nodes_.push_back(exact(static_cast<double>(first_column_ + i * kNode) + 0.5,
                               static_cast<double>(first_row_ + j * kNode) + 0.5));
  }
  model::Point2 of(long long column, long long row) const {
    const long long c = column - first_column_, r = row - first_row_;
    const double u = static_cast<double>(c % kNode) / kNode, v = static_cast<double>(r % kNode) / kNode;
    const std::size_t i =
        static_cast<std::size_t>(r / kNode) * static_cast<std::size_t>(across_) + static_cast<std::size_t>(c / kNode);
    const model::Point2 &a = nodes_[i], &b = nodes_[i + 1], &d = nodes_[i + static_cast<std::size_t>(across_)],
                        &e = nodes_[i + static_cast<std::size_t>(across_) + 1];
    return {(a.x * (1 - u) + b.x * u) * (1 - v) + (d.x * (1 - u) + e.x * u) * v,
            (a.y * (1 - u) + b.y * u) * (1 - v) + (d.y * (1 - u) + e.y * u) * v};
  }

 private:
  long long first_column_, first_row_;
  int across_ = 0;
  std::vector<model::Point2> nodes_;
};

}  // namespace

Patch AerialImage::patch(const georef::Projection& projection, double size, long long column, long long row, int width,
                         int height) const {
  Patch out;
  out.size = size;
  out.west = static_cast<double>(column) * size, out.north = -static_cast<double>(row) * size;
  out.width = width, out.height = height;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  out.red.assign(pixels, 0), out.green.assign(pixels, 0), out.blue.assign(pixels, 0), out.valid.assign(pixels, 0);
  if (impl_->description.infrared) out.infrared.assign(pixels, 0);

  // The coarsest level that is not coarser than what is asked for.
  int level = 0;
  while (impl_->description.pixel_m * static_cast<double>(2LL << level) <= size && level < 20) ++level;
  const double scale = static_cast<double>(1LL << level);
  LevelReader read(*impl_->blocks, level);
  const Positions positions(
      [&](double c, double r) {
        return impl_->pixel_of(projection.inverse({c * size, -r * size}));
      },
      column, row, width, height);
  std::size_t i = 0;
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c, ++i) {
      const model::Point2 p = positions.of(column + c, row + r);
      if (!(std::fabs(p.x) < 1e9 && std::fabs(p.y) < 1e9)) continue;
      // In fractions of a pixel of the level, counted from the centre of its first.
      const long long x = std::llrint((p.x / scale - 0.5) * kFractions),
                      y = std::llrint((p.y / scale - 0.5) * kFractions);
      const long long x0 = floor_to(x, kFractions), y0 = floor_to(y, kFractions);
      const unsigned u = static_cast<unsigned>(x - x0), v = static_cast<unsigned>(y - y0);
      const std::array<unsigned, 4> weights{(kFractions - u) * (kFractions - v), u * (kFractions - v),
                                            (kFractions - u) * v, u * v};
      std::array<unsigned, 4> sum{};
      bool valid = true;
      const auto add = [&](unsigned weight, const std::uint8_t* sample) {
        if (weight == 0) return;
        valid = valid && sample != nullptr && sample[4] != 0;
        for (unsigned b = 0; b < 4 && valid; ++b) sum[b] += weight * sample[b];
      };
      const long long pixel = x0 / kFractions, line = y0 / kFractions;
      if (const std::uint8_t* const at = read.four(pixel, line)) {
        add(weights[0], at), add(weights[1], at + 5);
        add(weights[2], at + LevelReader::kBlockLine), add(weights[3], at + LevelReader::kBlockLine + 5);
      } else {
        for (unsigned k = 0; k < 4 && valid; ++k)
          if (weights[k] != 0) add(weights[k], read(pixel + (k & 1), line + (k >> 1)));
      }
      if (!valid) continue;
      const auto byte = [](unsigned s) {
        return static_cast<std::uint8_t>((s + kFractions * kFractions / 2) / (kFractions * kFractions));
      };
      out.red[i] = byte(sum[0]), out.green[i] = byte(sum[1]), out.blue[i] = byte(sum[2]), out.valid[i] = 1;
      if (!out.infrared.empty()) out.infrared[i] = byte(sum[3]);
    }
  }
  return out;
}

}  // namespace blockrand::importers::imagery
