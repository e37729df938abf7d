// Is an image clear and young enough to be trusted: haze, clouds, date.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "pipeline/observation/image_windows.h"
#include "pipeline/observation/row_match.h"

namespace blockrand::observation {

struct ImageQuality {
  /// The darkest places around the median house, of white, [0, 1]: shadows and trees, which are nearly black in clear air
  /// (the dark channel of He, Sun, Tang, "Single image haze removal using dark channel prior", 2009).
  double haze = 0;
  double clouded = 0;  ///< share of the houses around which all is white, and even
  std::uint64_t houses = 0;
};

/// From here on an image is called hazy; of houses: partly clouded.
inline constexpr double kHazy = 0.33, kClouded = 0.03;
/// Houses that are needed to say so.
inline constexpr std::uint64_t kFewestForQuality = 5;

/// Looks around a sample of houses. \param windows  of coarse pixels
ImageQuality measure_quality(std::span<const SearchedOutline> houses, const ImageWindows& windows);

/// Seconds since 1970 at the end of "2014", "2014-06" or "2014-06-21"; nothing for any other text.
std::optional<std::uint32_t> last_second(const std::string& date);

}  // namespace blockrand::observation
