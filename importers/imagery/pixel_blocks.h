// Blocks of an open image's pixels, decimated by powers of two, as bytes; the last ones are kept.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "importers/imagery/image_bands.h"
#include "pipeline/gdal/gdal_scope.h"

namespace blockrand::importers::imagery {

/// Pixels along each side of a block, at its level.
inline constexpr int kBlockSide = 256;

/// A square of pixels; those beyond the image are not valid. Red, green, blue, infrared (0 without), 1 where valid.
struct PixelBlock {
  std::vector<std::uint8_t> samples;  ///< kBlockSide * kBlockSide * 5, row by row
  const std::uint8_t* at(int column, int row) const {
    return samples.data() + 5 * (static_cast<std::size_t>(row) * kBlockSide + static_cast<std::size_t>(column));
  }
};

/// Level k has one pixel for each 2^k x 2^k of the image, their mean; what is left over at the right and lower edge is
/// left out. A block's bytes depend on its place alone. Safe from any thread.
class PixelBlocks {
 public:
  /// \param dataset  open; closed with this
  PixelBlocks(std::unique_ptr<void, gdal::CloseDataset> dataset, ImageBands bands, std::string path);

  /// Pixels of the image at a level.
  long long columns(int level) const { return columns_ >> level; }
  long long rows(int level) const { return rows_ >> level; }

  /// \throws base::InputError  the file cannot be read any more
  std::shared_ptr<const PixelBlock> block(int level, long long column, long long row);

 private:
  std::shared_ptr<const PixelBlock> read(int level, long long column, long long row);

  std::unique_ptr<void, gdal::CloseDataset> dataset_;
  ImageBands bands_;
  std::string path_;
  long long columns_ = 0, rows_ = 0;
  std::mutex reading_, caching_;
  struct Entry {
    std::shared_ptr<const PixelBlock> block;
    std::list<std::uint64_t>::iterator place;
  };
  std::unordered_map<std::uint64_t, Entry> blocks_;
  std::list<std::uint64_t> recent_;  // newest first
};

}  // namespace blockrand::importers::imagery
