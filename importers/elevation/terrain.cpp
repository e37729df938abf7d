#include "importers/elevation/terrain.h"

#include <ogr_srs_api.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <list>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "importers/elevation/bilinear.h"
#include "pipeline/base/error.h"
#include "pipeline/gdal/gdal_scope.h"
#include "pipeline/georef/transform.h"

namespace blockrand::importers::elevation {
namespace {

constexpr int kBlockSize = 256;  // pixels along each side
constexpr std::size_t kBlockBytes = sizeof(double) * kBlockSize * kBlockSize;
constexpr std::size_t kMaxBlocks = (32U << 20) / kBlockBytes;
constexpr GIntBig kMaxGdalCache = 32 << 20;  // bytes; GDAL's default is a twentieth of the machine

/// Pixel positions are rounded to this fraction, so that the last bits of a projection decide nothing.
constexpr double kPixelSteps = 65536;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

using Block = std::vector<double>;  // row by row, kMissing where there is no value

/// Position in the raster: column and row, pixel centres at whole numbers.
struct Pixel {
  double column = 0, row = 0;
  bool finite() const { return std::isfinite(column) && std::isfinite(row); }
};

/// Lowest down to the grid, highest up to it. What is a step but for the last bits of a sum is that step.
std::optional<GroundRange> rounded(const Extremes& extremes) {
  if (!extremes.known()) return std::nullopt;
  constexpr double kSteps = 1024;  // to the metre
  constexpr double kSlack = 1e-4;  // steps
  return GroundRange{std::floor(extremes.lowest * kSteps + kSlack) / kSteps,
                     std::ceil(extremes.highest * kSteps - kSlack) / kSteps};
}

std::optional<double> metres_of(std::string unit) {
  std::transform(unit.begin(), unit.end(), unit.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (unit == "m" || unit == "metre" || unit == "meter" || unit == "metres" || unit == "meters") return 1.0;
  if (unit == "cm" || unit == "centimetre" || unit == "centimeter") return 0.01;
  if (unit == "dm" || unit == "decimetre" || unit == "decimeter") return 0.1;
  if (unit == "ft" || unit == "foot" || unit == "feet") return 0.3048;
  if (unit == "us-ft" || unit == "ftus" || unit == "us survey foot" || unit == "foot_us") return 1200.0 / 3937.0;
  return std::nullopt;
}

}  // namespace

struct Terrain::Impl {
  TerrainDescription description;
  std::array<double, 6> to_pixel{};  // from CRS coordinates
  std::optional<georef::Transform> transform;
  bool geographic = false;
  double middle = 0;  // longitude of a raster in degrees; half a turn to each side of it covers rasters of 0 to 360 too
  double factor = 1, shift = 0;  // stored value to metres
  long long columns = 0, rows = 0;

  // GDAL's datasets are for one thread at a time.
  std::mutex reading;
  PlausibleHeights plausible;
  std::optional<Implausible> implausible;
  std::unique_ptr<void, gdal::CloseDataset> dataset;
  GDALRasterBandH band = nullptr;
  GDALRasterBandH mask = nullptr;

  std::mutex caching;
  struct Entry {
    std::shared_ptr<const Block> block;
    std::list<std::uint64_t>::iterator place;
  };
  std::unordered_map<std::uint64_t, Entry> blocks;
  std::list<std::uint64_t> recent;  // newest first

  std::shared_ptr<const Block> read(long long block_column, long long block_row);
  std::shared_ptr<const Block> block_at(long long block_column, long long block_row);
  Pixel pixel_of(georef::LonLat place) const;
  std::vector<Pixel> pixels_of(std::span<const georef::LonLat> places) const;
  template <typename Reader>
  void walk(Reader& read, Pixel a, Pixel b, Extremes& extremes) const;
  template <typename Reader>
  void scan(Reader& read, std::span<const std::vector<Pixel>> rings, Extremes& extremes) const;
};

namespace {

/// Looks up pixels, keeping the last block at hand.
template <typename Source>
class PixelReader {
 public:
  explicit PixelReader(Source& source) : source_(source) {}

  /// Metres, or kMissing; requires a pixel of the raster.
  double operator()(long long column, long long row) {
    const long long block_column = column / kBlockSize, block_row = row / kBlockSize;
    if (!block_ || block_column != block_column_ || block_row != block_row_) {
      block_ = source_.block_at(block_column, block_row);
      block_column_ = block_column, block_row_ = block_row;
    }
    return (*block_)[static_cast<std::size_t>((row % kBlockSize) * kBlockSize + column % kBlockSize)];
  }

 private:
  Source& source_;
  std::shared_ptr<const Block> block_;
  long long block_column_ = -1, block_row_ = -1;
};

}  // namespace

std::shared_ptr<const Block> Terrain::Impl::read(long long block_column, long long block_row) {
  const int x = static_cast<int>(block_column * kBlockSize), y = static_cast<int>(block_row * kBlockSize);
  const int width = static_cast<int>(std::min<long long>(kBlockSize, columns - x));
  const int height = static_cast<int>(std::min<long long>(kBlockSize, rows - y));
  auto block = std::make_shared<Block>(static_cast<std::size_t>(kBlockSize) * kBlockSize, kMissing);
  std::vector<std::uint8_t> valid(block->size(), 255);
  const std::lock_guard lock(reading);
  const gdal::GdalScope scope;
  CPLErr error = gdal::api().GDALRasterIO(band, GF_Read, x, y, width, height, block->data(), width, height, GDT_Float64,
                                          0, kBlockSize * static_cast<int>(sizeof(double)));
  if (error < CE_Failure && mask != nullptr) {
    error = gdal::api().GDALRasterIO(mask, GF_Read, x, y, width, height, valid.data(), width, height, GDT_Byte, 0,
                                     kBlockSize);
  }
  if (error >= CE_Failure) {
    throw base::InputError(description.path, "pixel " + std::to_string(x) + "," + std::to_string(y),
                           "the terrain raster cannot be read" + gdal::GdalScope::last_words(),
                           "The file is damaged or was cut short; fetch it again");
  }
  for (std::size_t i = 0; i < block->size(); ++i) {
    double& value = (*block)[i];
    value = valid[i] == 0 || !std::isfinite(value) ? kMissing : value * factor + shift;
    if (value < plausible.lowest || value > plausible.highest) {
      const auto pixel = static_cast<long long>(i);
      const long long column = x + pixel % kBlockSize, row = y + pixel / kBlockSize;
      if (!implausible || std::pair(row, column) < std::pair(implausible->row, implausible->column))
        implausible = {column, row, value};
      value = kMissing;
    }
  }
  return block;
}

std::shared_ptr<const Block> Terrain::Impl::block_at(long long block_column, long long block_row) {
  const std::uint64_t key = static_cast<std::uint64_t>(block_row) << 32 | static_cast<std::uint64_t>(block_column);
  {
    const std::lock_guard lock(caching);
    if (const auto found = blocks.find(key); found != blocks.end()) {
      recent.splice(recent.begin(), recent, found->second.place);
      return found->second.block;
    }
  }
  // Two threads may read the same block; that costs time, not correctness.
  auto block = read(block_column, block_row);
  const std::lock_guard lock(caching);
  if (blocks.find(key) == blocks.end()) {
    recent.push_front(key);
    blocks[key] = {block, recent.begin()};
    if (blocks.size() > kMaxBlocks) {
      blocks.erase(recent.back());
      recent.pop_back();
    }
  }
  return block;
}

Pixel Terrain::Impl::pixel_of(georef::LonLat place) const {
  model::Point2 p = transform->forward({place.lon, place.lat});
  if (geographic && p.x < middle - 180) p.x += 360;
  if (geographic && p.x > middle + 180) p.x -= 360;
  const auto rounded = [](double value) { return std::nearbyint(value * kPixelSteps) / kPixelSteps; };
  return {rounded(to_pixel[0] + to_pixel[1] * p.x + to_pixel[2] * p.y - 0.5),
          rounded(to_pixel[3] + to_pixel[4] * p.x + to_pixel[5] * p.y - 0.5)};
}

std::vector<Pixel> Terrain::Impl::pixels_of(std::span<const georef::LonLat> places) const {
  std::vector<Pixel> pixels;
  pixels.reserve(places.size());
  for (const georef::LonLat& place : places) pixels.push_back(pixel_of(place));
  return pixels;
}

/// The ground along a straight line, cell by cell. Beyond the outermost centres their value goes on to the raster's
/// edge.
template <typename Reader>
void Terrain::Impl::walk(Reader& read, Pixel a, Pixel b, Extremes& extremes) const {
  if (!a.finite() || !b.finite()) return;
  const double last_column = static_cast<double>(columns) - 1, last_row = static_cast<double>(rows) - 1;
  std::vector<double> cuts{0, 1};
  // Where the line leaves a cell or the raster.
  const auto cut_at = [&cuts](double from, double to, double last) {
    if (from == to) return;
    const double low = std::min(from, to), high = std::max(from, to);
    const auto cut = [&](double place) {
      if (place > low && place < high) cuts.push_back(std::clamp((place - from) / (to - from), 0.0, 1.0));
    };
    cut(-0.5);
    for (double k = std::max(0.0, std::floor(low)); k <= std::min(last, high); k += 1) cut(k);
    cut(last + 0.5);
  };
  cut_at(a.column, b.column, last_column);
  cut_at(a.row, b.row, last_row);
  std::sort(cuts.begin(), cuts.end());
  const auto at = [&](double t) { return Pixel{a.column + t * (b.column - a.column), a.row + t * (b.row - a.row)}; };
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    if (cuts[i] == cuts[i - 1]) continue;
    const Pixel middle = at(0.5 * (cuts[i - 1] + cuts[i]));
    if (middle.column < -0.5 || middle.row < -0.5 || middle.column > last_column + 0.5 || middle.row > last_row + 0.5)
      continue;
    const double column = std::floor(middle.column), row = std::floor(middle.row);
    const auto value = [&](double c, double r) {
      return read(static_cast<long long>(std::clamp(c, 0.0, last_column)),
                  static_cast<long long>(std::clamp(r, 0.0, last_row)));
    };
    const Cell cell{value(column, row), value(column + 1, row), value(column, row + 1), value(column + 1, row + 1)};
    const auto inside = [&](Pixel p) {
      return CellPoint{std::clamp(p.column - column, 0.0, 1.0), std::clamp(p.row - row, 0.0, 1.0)};
    };
    widen(extremes, cell, inside(at(cuts[i - 1])), inside(at(cuts[i])));
  }
}

/// The pixel centres inside: row by row, between the places where the rings cross it.
template <typename Reader>
void Terrain::Impl::scan(Reader& read, std::span<const std::vector<Pixel>> rings, Extremes& extremes) const {
  const double last_column = static_cast<double>(columns) - 1;
  double top = static_cast<double>(rows), bottom = -1;
  for (const std::vector<Pixel>& ring : rings) {
    if (ring.size() < 3) return;
    for (const Pixel& p : ring) {
      if (!p.finite()) return;
      top = std::min(top, p.row), bottom = std::max(bottom, p.row);
    }
  }
  const auto first = static_cast<long long>(std::max(0.0, std::ceil(top)));
  const auto last = static_cast<long long>(std::min(static_cast<double>(rows) - 1, std::floor(bottom)));
  std::vector<double> crossings;
  for (long long row = first; row <= last; ++row) {
    const auto y = static_cast<double>(row);
    crossings.clear();
    for (const std::vector<Pixel>& ring : rings) {
      for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        const Pixel& a = ring[i];
        const Pixel& b = ring[j];
        if ((a.row > y) == (b.row > y)) continue;
        crossings.push_back(a.column + (y - a.row) / (b.row - a.row) * (b.column - a.column));
      }
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
      const auto from = static_cast<long long>(std::clamp(std::ceil(crossings[k]), 0.0, last_column + 1));
      const auto to = static_cast<long long>(std::clamp(std::floor(crossings[k + 1]), -1.0, last_column));
      for (long long column = from; column <= to; ++column) extremes.add(read(column, row));
    }
  }
}

Terrain::Terrain(const std::string& path, std::optional<double> metres_per_unit, PlausibleHeights plausible)
    : impl_(std::make_unique<Impl>()) {
  Impl& impl = *impl_;
  impl.plausible = plausible;
  impl.description.path = path;
  const auto refuse = [&path](const std::string& what, const std::string& remedy) {
    throw base::InputError(path, "", what, remedy);
  };
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  // GDAL's own names (/vsizip/..., connection strings) are no files here and are left to GDAL.
  const bool virtual_file = path.starts_with("/vsi");
  if (!virtual_file && !std::filesystem::exists(status)) {
    refuse("no such terrain raster", "Check the path given to --terrain");
  }
  if (std::filesystem::is_directory(status)) {
    refuse("is a directory, not a terrain raster",
           "Name one raster file; several tiles can be joined without copying: gdalbuildvrt terrain.vrt " + path +
               "/*.tif");
  }
  gdal::register_drivers();
  if (gdal::api().GDALGetCacheMax64() > kMaxGdalCache) gdal::api().GDALSetCacheMax64(kMaxGdalCache);
  const gdal::GdalScope scope;
  impl.dataset.reset(
      gdal::api().GDALOpenEx(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
  if (!impl.dataset) {
    refuse("is no raster that GDAL can read" + gdal::GdalScope::last_words(),
           "Check with gdalinfo; the file may be damaged or of another kind");
  }
  GDALDatasetH dataset = impl.dataset.get();
  if (gdal::api().GDALGetRasterCount(dataset) < 1) {
    refuse("has no raster band", "Name one of its sub-datasets (gdalinfo lists them)");
  }
  impl.band = gdal::api().GDALGetRasterBand(dataset, 1);
  if ((gdal::api().GDALGetMaskFlags(impl.band) & GMF_ALL_VALID) == 0)
    impl.mask = gdal::api().GDALGetMaskBand(impl.band);
  impl.columns = gdal::api().GDALGetRasterXSize(dataset);
  impl.rows = gdal::api().GDALGetRasterYSize(dataset);

  std::array<double, 6> from_pixel{};
  if (gdal::api().GDALGetGeoTransform(dataset, from_pixel.data()) != CE_None ||
      gdal::api().GDALInvGeoTransform(from_pixel.data(), impl.to_pixel.data()) == 0) {
    refuse("has no georeference",
           "Put a world file beside it or set one with gdal_edit.py -a_ullr; rasters with control "
           "points: gdalwarp first");
  }
  char* wkt = nullptr;
  static constexpr std::array<const char*, 2> kFormat{"FORMAT=WKT2_2019", nullptr};
  const OGRSpatialReferenceH reference = gdal::api().GDALGetSpatialRef(dataset);
  if (reference == nullptr || gdal::api().OSRExportToWktEx(reference, &wkt, kFormat.data()) != OGRERR_NONE ||
      wkt == nullptr || *wkt == '\0') {
    gdal::api().VSIFree(wkt);
    refuse("has no coordinate reference system",
           "Set it with gdal_edit.py -a_srs EPSG:..., or put a .prj file beside it");
  }
  const std::string definition = wkt;
  gdal::api().VSIFree(wkt);
  impl.geographic = gdal::api().OSRIsGeographic(reference) != 0;

  const auto corner = [&](double column, double row) {
    return model::Point2{from_pixel[0] + from_pixel[1] * column + from_pixel[2] * row,
                         from_pixel[3] + from_pixel[4] * column + from_pixel[5] * row};
  };
  const auto columns = static_cast<double>(impl.columns), rows = static_cast<double>(impl.rows);
  const std::array<model::Point2, 4> corners{corner(0, 0), corner(columns, 0), corner(columns, rows), corner(0, rows)};
  if (impl.geographic) impl.middle = corner(0.5 * columns, 0.5 * rows).x;
  try {
    // Which operation is best depends on the place, and the place is known through an operation: twice, then.
    impl.transform.emplace("EPSG:4326", definition);
    georef::GeoBox area{180, 90, -180, -90};
    for (const model::Point2& p : corners) {
      const model::Point2 g = impl.transform->inverse(p);
      area.west = std::min(area.west, g.x), area.east = std::max(area.east, g.x);
      area.south = std::min(area.south, g.y), area.north = std::max(area.north, g.y);
    }
    const bool sensible = area.west >= -180 && area.east <= 180 && area.south >= -90 && area.north <= 90 &&
                          area.west <= area.east && area.south <= area.north;
    if (sensible) impl.transform.emplace("EPSG:4326", definition, area);
  } catch (const base::UsageError& error) {
    refuse("its coordinate reference system cannot be used: " + std::string(error.what()),
           "Reproject it: gdalwarp -t_srs EPSG:... ");
  }

  const georef::CrsName name = georef::name_of_crs(definition);
  const georef::VerticalCrs vertical = georef::vertical_crs_of(definition);
  TerrainDescription& d = impl.description;
  d.crs_name = name.name, d.crs_code = name.authority_code;
  d.vertical_name = vertical.name, d.vertical_code = vertical.authority_code;
  d.ellipsoidal = vertical.ellipsoidal;
  d.operation = impl.transform->operation();
  d.accuracy_m = impl.transform->accuracy_m();
  d.pixel_width = std::sqrt(from_pixel[1] * from_pixel[1] + from_pixel[4] * from_pixel[4]);
  d.pixel_height = std::sqrt(from_pixel[2] * from_pixel[2] + from_pixel[5] * from_pixel[5]);
  d.columns = impl.columns, d.rows = impl.rows;
  int has = 0;
  const double nodata = gdal::api().GDALGetRasterNoDataValue(impl.band, &has);
  if (has != 0) d.nodata = nodata;

  const std::string unit = gdal::api().GDALGetRasterUnitType(impl.band);
  const auto metres =
      unit.empty() ? std::optional(metres_per_unit.value_or(vertical.metres_per_unit)) : metres_of(unit);
  if (!metres) {
    refuse("counts heights in \"" + unit + "\", which is no unit of length known here",
           "Set it with gdal_edit.py -units metre when the values are metres");
  }
  impl.factor = gdal::api().GDALGetRasterScale(impl.band, &has) * *metres;
  impl.shift = gdal::api().GDALGetRasterOffset(impl.band, &has) * *metres;
}

Terrain::~Terrain() = default;
Terrain::Terrain(Terrain&&) noexcept = default;
Terrain& Terrain::operator=(Terrain&&) noexcept = default;

const TerrainDescription& Terrain::describe() const { return impl_->description; }

std::optional<Terrain::Implausible> Terrain::implausible() const {
  const std::lock_guard lock(impl_->reading);
  return impl_->implausible;
}

std::optional<GroundRange> Terrain::range_along(std::span<const georef::LonLat> line) const {
  Impl& impl = *impl_;
  PixelReader read(impl);
  Extremes extremes;
  const std::vector<Pixel> pixels = impl.pixels_of(line);
  if (pixels.size() == 1) impl.walk(read, pixels[0], pixels[0], extremes);
  for (std::size_t i = 1; i < pixels.size(); ++i) impl.walk(read, pixels[i - 1], pixels[i], extremes);
  return rounded(extremes);
}

std::optional<GroundRange> Terrain::range_under(std::span<const std::vector<georef::LonLat>> rings) const {
  Impl& impl = *impl_;
  PixelReader read(impl);
  Extremes extremes;
  std::vector<std::vector<Pixel>> pixels;
  for (const std::vector<georef::LonLat>& ring : rings) {
    pixels.push_back(impl.pixels_of(ring));
    const std::vector<Pixel>& p = pixels.back();
    for (std::size_t i = 0, j = p.size() - 1; i < p.size(); j = i++) impl.walk(read, p[j], p[i], extremes);
  }
  impl.scan(read, pixels, extremes);
  return rounded(extremes);
}

}  // namespace blockrand::importers::elevation
