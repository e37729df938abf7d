#include "pipeline/observation/image_quality.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace blockrand::observation {

namespace {

/// m about a house: its shadow, its garden.
constexpr double kAround = 10;
/// Of the pixels about a house: as many are darker than its darkest places.
constexpr double kDarkest = 0.03;
/// Of a window's pixels: where fewer are valid nothing is said; where as many are white it lies under a cloud.
constexpr double kMostlyValid = 0.5, kMostlyWhite = 0.9;
/// Levels of 255: white has as much of each band, and no band more than another by as much.
constexpr int kWhite = 195, kGrey = 18;

struct Window {
  bool seen = false, white = false;
  double dark = 0;
};

Window look(const Patch& patch) {
  std::array<std::size_t, 256> count{};
  std::size_t valid = 0, white = 0;
  for (std::size_t i = 0; i < patch.valid.size(); ++i) {
    if (!patch.valid[i]) continue;
    const int r = patch.red[i], g = patch.green[i], b = patch.blue[i];
    const int least = std::min({r, g, b}), most = std::max({r, g, b});
    ++valid, ++count[static_cast<std::size_t>(least)];
    white += least >= kWhite && most - least <= kGrey;
  }
  Window out;
  if (static_cast<double>(valid) < kMostlyValid * static_cast<double>(patch.valid.size()) || valid == 0) return out;
  out.seen = true;
  out.white = static_cast<double>(white) >= kMostlyWhite * static_cast<double>(valid);
  std::size_t below = 0;
  for (std::size_t level = 0; level < count.size(); ++level) {
    below += count[level];
    if (static_cast<double>(below) < kDarkest * static_cast<double>(valid)) continue;
    out.dark = static_cast<double>(level) / 255;
    break;
  }
  return out;
}

}  // namespace

ImageQuality measure_quality(std::span<const SearchedOutline> houses, const ImageWindows& windows) {
  ImageQuality out;
  std::vector<double> dark;
  std::uint64_t white = 0;
  for (const SearchedOutline& house : houses) {
    const Window window = look(windows.window(house.box, kAround));
    if (!window.seen) continue;
    ++out.houses;
    white += window.white;
    if (!window.white) dark.push_back(window.dark);
  }
  if (out.houses > 0) out.clouded = static_cast<double>(white) / static_cast<double>(out.houses);
  if (!dark.empty()) {
    const auto middle = dark.begin() + static_cast<std::ptrdiff_t>(dark.size() / 2);
    std::nth_element(dark.begin(), middle, dark.end());
    out.haze = *middle;
  }
  return out;
}

std::optional<std::uint32_t> last_second(const std::string& date) {
  int year = 0, month = 12, day = 31;
  const int read = std::sscanf(date.c_str(), "%4d-%2d-%2d", &year, &month, &day);
  if (read < 1 || year < 1970 || year > 2100 || month < 1 || month > 12 || day < 1 || day > 31) return std::nullopt;
  using namespace std::chrono;
  const year_month ym = std::chrono::year(year) / std::chrono::month(static_cast<unsigned>(month));
  const sys_days last =
      read < 3 ? sys_days(ym / std::chrono::last) : sys_days(ym / std::chrono::day(static_cast<unsigned>(day)));
  return static_cast<std::uint32_t>((last + days(1)).time_since_epoch().count() * 86400LL);
}

}  // namespace blockrand::observation
