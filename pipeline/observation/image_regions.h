// Parts of an image that have one colour each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/observation/image_windows.h"

namespace blockrand::observation {

/// One colour, connected.
struct ImageRegion {
  std::uint32_t first = 0, count = 0;   ///< into ImageRegions::pixels
  double red = 0, green = 0, blue = 0;  ///< mean levels
};

/// Two regions that lie at each other.
struct RegionBorder {
  std::uint32_t a = 0, b = 0;  ///< a < b
  std::uint32_t length = 0;    ///< pairs of neighbouring pixels
};

struct ImageRegions {
  std::vector<std::uint32_t> pixels;  ///< numbers of pixels of the patch, region by region, ascending in each
  std::vector<ImageRegion> regions;   ///< in the order of their first pixels
  std::vector<RegionBorder> borders;  ///< ascending by a, b
};

/// Grows regions: of all pairs of neighbours the most alike first, two regions become one when their mean colours are as
/// near as their sizes ask for (Nock, Nielsen, "Statistical region merging", 2004; with a threshold of levels instead of
/// their bound). What is smaller than `least` then goes to the neighbour that is most like it. Sums are integers: the
/// same for any order of reading.
/// \param open   of each pixel: 0 where none may grow
/// \param least  pixels; smaller regions that have no neighbour are left out
ImageRegions grow_regions(const Patch& patch, std::span<const std::uint8_t> open, std::uint32_t least);

}  // namespace blockrand::observation
