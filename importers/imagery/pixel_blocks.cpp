#include "importers/imagery/pixel_blocks.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "pipeline/base/error.h"

namespace blockrand::importers::imagery {
namespace {

constexpr std::size_t kBlockBytes = 5UL * kBlockSide * kBlockSide;
constexpr std::size_t kMaxBlocks = (64U << 20) / kBlockBytes;

/// A mean of masks (0 to 255) from which on a pixel counts: half of what it covers is known.
constexpr int kHalfKnown = 128;

}  // namespace

PixelBlocks::PixelBlocks(std::unique_ptr<void, gdal::CloseDataset> dataset, ImageBands bands, std::string path)
    : dataset_(std::move(dataset)),
      bands_(std::move(bands)),
      path_(std::move(path)),
      columns_(gdal::api().GDALGetRasterXSize(dataset_.get())),
      rows_(gdal::api().GDALGetRasterYSize(dataset_.get())) {}

std::shared_ptr<const PixelBlock> PixelBlocks::read(int level, long long column, long long row) {
  auto block = std::make_shared<PixelBlock>();
  block->samples.assign(kBlockBytes, 0);
  const int width = static_cast<int>(std::min<long long>(kBlockSide, columns(level) - column * kBlockSide));
  const int height = static_cast<int>(std::min<long long>(kBlockSide, rows(level) - row * kBlockSide));
  if (width <= 0 || height <= 0) return block;
  const int x = static_cast<int>((column * kBlockSide) << level), y = static_cast<int>((row * kBlockSide) << level);
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  GDALRasterIOExtraArg how;
  INIT_RASTERIO_EXTRA_ARG(how);
  // Indices of a palette have no mean.
  how.eResampleAlg = bands_.palette.empty() && level > 0 ? GRIORA_Average : GRIORA_NearestNeighbour;
  const std::lock_guard lock(reading_);
  const gdal::GdalScope scope;
  const auto take = [&](GDALRasterBandH band, void* out, GDALDataType type) {
    if (gdal::api().GDALRasterIOEx(band, GF_Read, x, y, width << level, height << level, out, width, height, type, 0, 0,
                                   &how) >= CE_Failure)
      throw base::InputError(path_, "pixel " + std::to_string(x) + "," + std::to_string(y),
                             "the image cannot be read" + gdal::GdalScope::last_words(),
                             "The file is damaged or was cut short; fetch it again");
  };
  const auto each = [&](auto&& visit) {
    for (int r = 0; r < height; ++r)
      for (int c = 0; c < width; ++c)
        visit(static_cast<std::size_t>(r) * static_cast<std::size_t>(width) + static_cast<std::size_t>(c),
              block->samples.data() + 5 * (static_cast<std::size_t>(r) * kBlockSide + static_cast<std::size_t>(c)));
  };
  each([](std::size_t, std::uint8_t* sample) { sample[4] = 1; });

  std::vector<std::uint8_t> bytes(pixels);
  std::vector<double> values;
  const auto take_band = [&](int number, std::size_t slot) {
    GDALRasterBandH band = gdal::api().GDALGetRasterBand(dataset_.get(), number);
    if (bands_.whole_bytes) {
      take(band, bytes.data(), GDT_Byte);
      each([&](std::size_t i, std::uint8_t* sample) { sample[slot] = bytes[i]; });
      return;
    }
    values.resize(pixels);
    take(band, values.data(), GDT_Float64);
    const double scale = 255 / (bands_.stretch.high - bands_.stretch.low);
    each([&](std::size_t i, std::uint8_t* sample) {
      if (!std::isfinite(values[i]))
        sample[4] = 0;
      else
        sample[slot] =
            static_cast<std::uint8_t>(std::lround(std::clamp((values[i] - bands_.stretch.low) * scale, 0.0, 255.0)));
    });
  };
  take_band(bands_.colour[0], 0);
  if (!bands_.palette.empty()) {
    each([&](std::size_t, std::uint8_t* sample) {
      const std::uint8_t index = sample[0];
      if (index < bands_.palette.size())
        std::copy_n(bands_.palette[index].begin(), 3, sample);
      else
        sample[4] = 0;
    });
  } else if (bands_.grey) {
    each([](std::size_t, std::uint8_t* sample) { sample[1] = sample[2] = sample[0]; });
  } else {
    take_band(bands_.colour[1], 1);
    take_band(bands_.colour[2], 2);
  }
  if (bands_.infrared != 0) take_band(bands_.infrared, 3);

  // A pixel is unknown where every colour is: black roofs have bands that equal a nodata of 0.
  if (!bands_.masked.empty()) {
    std::vector<std::uint8_t> known(pixels, 0);
    for (const int number : bands_.masked) {
      take(gdal::api().GDALGetMaskBand(gdal::api().GDALGetRasterBand(dataset_.get(), number)), bytes.data(), GDT_Byte);
      for (std::size_t i = 0; i < pixels; ++i) known[i] = known[i] != 0 || bytes[i] >= kHalfKnown ? 1 : 0;
    }
    each([&](std::size_t i, std::uint8_t* sample) {
      if (known[i] == 0) sample[4] = 0;
    });
  }
  return block;
}

std::shared_ptr<const PixelBlock> PixelBlocks::block(int level, long long column, long long row) {
  const std::uint64_t key = static_cast<std::uint64_t>(level) << 58 | static_cast<std::uint64_t>(row) << 29 |
                            static_cast<std::uint64_t>(column);
  {
    const std::lock_guard lock(caching_);
    if (const auto found = blocks_.find(key); found != blocks_.end()) {
      recent_.splice(recent_.begin(), recent_, found->second.place);
      return found->second.block;
    }
  }
  // Two threads may read the same block; that costs time, not correctness.
  auto block = read(level, column, row);
  const std::lock_guard lock(caching_);
  if (blocks_.find(key) == blocks_.end()) {
    recent_.push_front(key);
    blocks_[key] = {block, recent_.begin()};
    if (blocks_.size() > kMaxBlocks) {
      blocks_.erase(recent_.back());
      recent_.pop_back();
    }
  }
  return block;
}

}  // namespace blockrand::importers::imagery
