#include "pipeline/geometry/segment_grid.h"

#include <algorithm>
#include <cmath>

namespace blockrand::geometry {

namespace {

/// m. Segments and boxes are grown by it: far above the rounding of the interpolation below, and no less than a grid
/// step.
constexpr double kSlack = 1.0 / model::kGridStepsPerMetre;

}  // namespace

std::int32_t SegmentGrid::cell_of(double metres) const { return static_cast<std::int32_t>(std::floor(metres / cell_)); }

SegmentGrid::SegmentGrid(std::span<const Segment> segments, double cell) : cell_(cell) {
  for (std::uint32_t i = 0; i < segments.size(); ++i) {
    const Segment& s = segments[i];
    const model::Point2 a = std::min(s.a, s.b), b = std::max(s.a, s.b);  // from west to east
    const std::int32_t first = cell_of(a.x - kSlack), last = cell_of(b.x + kSlack);
    for (std::int32_t x = first; x <= last; ++x) {
      const double slope = b.x > a.x ? (b.y - a.y) / (b.x - a.x) : 0;
      const double west = std::clamp(x * cell_ - kSlack, a.x, b.x),
                   east = std::clamp((x + 1) * cell_ + kSlack, a.x, b.x);
      const double from = b.x > a.x ? a.y + (west - a.x) * slope : a.y,
                   to = b.x > a.x ? a.y + (east - a.x) * slope : b.y;
      const std::int32_t low = cell_of(std::min(from, to) - kSlack), high = cell_of(std::max(from, to) + kSlack);
      for (std::int32_t y = low; y <= high; ++y) entries_.push_back({x, y, i});
    }
  }
  std::sort(entries_.begin(), entries_.end());
}

void SegmentGrid::near(model::Point2 minimum, model::Point2 maximum, std::vector<std::uint32_t>& out) const {
  out.clear();
  const std::int32_t low = cell_of(minimum.y - kSlack), high = cell_of(maximum.y + kSlack);
  for (std::int32_t x = cell_of(minimum.x - kSlack); x <= cell_of(maximum.x + kSlack); ++x) {
    // The cells of a column follow each other in the sorted order.
    auto entry = std::lower_bound(entries_.begin(), entries_.end(), Entry{x, low, 0});
    for (; entry != entries_.end() && entry->x == x && entry->y <= high; ++entry) out.push_back(entry->segment);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
}

}  // namespace blockrand::geometry
