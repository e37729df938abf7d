#include "pipeline/observation/rows_off_alike.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

namespace blockrand::observation {

namespace {

using model::Point2;

/// Rows that are shown elsewhere: fewer may be off alike by chance; of all rows judged, and of those shown elsewhere: as many
/// are off alike, within m, where the image is shifted.
constexpr std::size_t kFewestAlike = 4;
constexpr double kMostMoved = 0.5, kMostAlike = 0.7, kAlike = 0.8;

double median(const std::map<std::uint32_t, Point2>& shifts, double Point2::*axis) {
  std::vector<double> values;
  for (const auto& [row, shift] : shifts) values.push_back(shift.*axis);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// To mm, as imagery.json has it.
double rounded(double value) { return std::round(value * 1000) / 1000 + 0.0; }

}  // namespace

void restate(OutlineReceipt& receipt, RowState state, std::string_view reason) {
  receipt.state = state, receipt.reason = std::string(reason), receipt.refined = {};
}

void doubt_rows_off_alike(std::uint32_t image, ImageryObservations& observations) {
  std::map<std::uint32_t, Point2> moved;
  std::set<std::uint32_t> judged;
  for (const OutlineReceipt& r : observations.outlines) {
    if (r.image != image || r.confidence <= 0) continue;
    judged.insert(r.row);
    if (r.state == RowState::corrected) moved.emplace(r.row, r.shift);
  }
  const auto of_all = static_cast<double>(judged.size()), rows = static_cast<double>(moved.size());
  if (moved.size() < kFewestAlike || rows < kMostMoved * of_all) return;
  const Point2 usual{median(moved, &Point2::x), median(moved, &Point2::y)};
  const auto alike = static_cast<double>(std::ranges::count_if(moved, [&](const auto& row) {
    const double x = row.second.x - usual.x, y = row.second.y - usual.y;
    return x * x + y * y <= kAlike * kAlike;
  }));
  if (alike < kMostAlike * rows) return;
  observations.images[image].alike = {rounded(usual.x), rounded(usual.y)};
  for (OutlineReceipt& r : observations.outlines)
    if (r.image == image && r.state == RowState::corrected)
      restate(r, RowState::undecided, "the image shows most rows off alike: it may be the image that is shifted");
}

}  // namespace blockrand::observation
