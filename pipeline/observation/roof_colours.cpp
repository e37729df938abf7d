#include "pipeline/observation/roof_colours.h"

#include <algorithm>

#include "pipeline/base/portable_math.h"

namespace blockrand::observation {

namespace {

/// Pixels that are added to both counts: a colour that hardly occurs says nothing. Pixels of both kinds that are needed.
constexpr double kFew = 10;
constexpr std::uint64_t kFewestPixels = 2000;

/// Each count with a half of its neighbours' along every band: colours that are nearly the same are.
std::vector<std::uint64_t> spread_out(const std::vector<std::uint32_t>& counts, int side) {
  std::vector<std::uint64_t> from(counts.begin(), counts.end()), to(from.size());
  for (const int step : {1, side, side * side}) {
    for (int i = 0; i < static_cast<int>(from.size()); ++i) {
      const int place = i / step % side;
      const auto at = [&](int j) { return from[static_cast<std::size_t>(j)]; };
      to[static_cast<std::size_t>(i)] =
          2 * at(i) + (place > 0 ? at(i - step) : 0) + (place < side - 1 ? at(i + step) : 0);
    }
    from.swap(to);
  }
  return from;
}

}  // namespace

void RoofColours::learn(const Patch& patch, std::span<const std::uint8_t> kinds) {
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (!patch.valid[i] || kinds[i] < 1 || kinds[i] > 2) continue;
    ++(kinds[i] == 1 ? roofs_ : ground_)[cell(patch.red[i], patch.green[i], patch.blue[i])];
  }
}

void RoofColours::settle() {
  std::uint64_t roofs = 0, ground = 0;
  for (std::size_t i = 0; i < roofs_.size(); ++i) roofs += roofs_[i], ground += ground_[i];
  if (roofs < kFewestPixels || ground < kFewestPixels) return;
  const std::vector<std::uint64_t> r = spread_out(roofs_, kSide), g = spread_out(ground_, kSide);
  const double all_roofs = 64.0 * static_cast<double>(roofs), all_ground = 64.0 * static_cast<double>(ground);
  // The same doubt for both, whichever was counted more often.
  const double few_roofs = 64 * kFew * std::max(1.0, all_roofs / all_ground),
               few_ground = 64 * kFew * std::max(1.0, all_ground / all_roofs);
  table_.resize(r.size());
  for (std::size_t i = 0; i < r.size(); ++i) {
    const double by_roofs = (static_cast<double>(r[i]) + few_roofs) / all_roofs,
                 by_ground = (static_cast<double>(g[i]) + few_ground) / all_ground;
    table_[i] = static_cast<float>(std::clamp(base::log(by_roofs / by_ground), -kMostLikely, kMostLikely));
  }
}

}  // namespace blockrand::observation
