#include "pipeline/run/plan_cells.h"

#include <algorithm>
#include <cmath>

namespace blockrand::run {
namespace {

using geometry::PlanBox;

/// Far beyond any projected place; what is no number counts as that.
constexpr double kFarthest = 1e9;
std::int32_t cell_at(double metres) {
  if (!(metres > -kFarthest)) metres = -kFarthest;
  return static_cast<std::int32_t>(std::floor(std::min(metres, kFarthest) / kReachCell));
}

}  // namespace

void CellRange::include(const CellRange& other) {
  if (other.empty()) return;
  if (empty()) {
    *this = other;
    return;
  }
  x0 = std::min(x0, other.x0), y0 = std::min(y0, other.y0), x1 = std::max(x1, other.x1), y1 = std::max(y1, other.y1);
}

CellRange cells_of(const PlanBox& box) {
  if (box.empty()) return {};
  return {cell_at(box.minimum.x), cell_at(box.minimum.y), cell_at(box.maximum.x), cell_at(box.maximum.y)};
}

CellRange common(const CellRange& a, const CellRange& b) {
  if (a.empty() || b.empty()) return {};
  const CellRange both{std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
  return both.y0 > both.y1 ? CellRange() : both;
}

bool CellRuns::near(const PlanBox& other, double distance) const {
  if (!box.near(other, distance)) return false;
  PlanBox around = other;
  around.minimum = {around.minimum.x - distance, around.minimum.y - distance};
  around.maximum = {around.maximum.x + distance, around.maximum.y + distance};
  const CellRange range = cells_of(around);
  const auto low = std::ranges::lower_bound(runs, range.y0, {}, &Run::y);
  for (auto run = low; run != runs.end() && run->y <= range.y1; ++run)
    if (run->first <= range.x1 && run->last >= range.x0) return true;
  return false;
}

PlanCells::PlanCells(const CellRange& extent) : extent_(extent) {
  if (extent.empty()) return;
  width_ = static_cast<std::size_t>(extent.x1 - extent.x0) + 1;
  cells_.assign(width_ * (static_cast<std::size_t>(extent.y1 - extent.y0) + 1), 0);
}

void PlanCells::include(const PlanBox& box) { include(cells_of(box)); }

void PlanCells::include(const CellRange& range) {
  if (range.empty()) return;
  PlanBox box;
  box.minimum = {range.x0 * kReachCell, range.y0 * kReachCell};
  box.maximum = {(range.x1 + 1) * kReachCell, (range.y1 + 1) * kReachCell};
  box_.include(box);
  const CellRange here = common(range, extent_);
  if (here.empty()) return;
  for (std::int32_t y = here.y0; y <= here.y1; ++y)
    std::fill_n(cells_.begin() + static_cast<std::ptrdiff_t>(at(here.x0, y)), here.x1 - here.x0 + 1, std::uint8_t{1});
  used_.include(here);
}

void PlanCells::include(const PlanCells& other) {
  box_.include(other.box_);
  if (other.used_.empty()) return;
  other.for_each([&](std::int32_t x, std::int32_t y) { cells_[at(x, y)] = 1; });
  used_.include(other.used_);
}

void PlanCells::grow(double distance) {
  if (box_.empty() || distance <= 0) return;
  const auto by = static_cast<std::int32_t>(std::ceil(distance / kReachCell));
  box_.minimum = {box_.minimum.x - by * kReachCell, box_.minimum.y - by * kReachCell};
  box_.maximum = {box_.maximum.x + by * kReachCell, box_.maximum.y + by * kReachCell};
  if (used_.empty()) return;
  const CellRange wide = common({used_.x0 - by, used_.y0 - by, used_.x1 + by, used_.y1 + by}, extent_);
  // Along rows: from each square to `by` beyond it on both sides.
  const std::size_t columns = static_cast<std::size_t>(wide.x1 - wide.x0) + 1;
  std::vector<std::uint8_t> along(columns * (static_cast<std::size_t>(used_.y1 - used_.y0) + 1), 0);
  const auto place = [&](std::int32_t x, std::int32_t y) {
    return static_cast<std::size_t>(y - used_.y0) * columns + static_cast<std::size_t>(x - wide.x0);
  };
  for (std::int32_t y = used_.y0; y <= used_.y1; ++y)
    for (std::int32_t x = used_.x0; x <= used_.x1; ++x) {
      if (!cells_[at(x, y)]) continue;
      std::int32_t end = x;
      while (end < used_.x1 && cells_[at(end + 1, y)]) ++end;
      const std::int32_t from = std::max(x - by, wide.x0), to = std::min(end + by, wide.x1);
      std::fill_n(along.begin() + static_cast<std::ptrdiff_t>(place(from, y)), to - from + 1, std::uint8_t{1});
      x = end;
    }
  // Then across them: how many of the rows that reach a square hold it.
  std::vector<std::int32_t> count(columns, 0);
  for (std::int32_t y = wide.y0 - by; y <= wide.y1; ++y) {
    const auto add = [&](std::int32_t row, std::int32_t sign) {
      if (row < used_.y0 || row > used_.y1) return;
      for (std::size_t c = 0; c < columns; ++c)
        count[c] += sign * along[place(wide.x0 + static_cast<std::int32_t>(c), row)];
    };
    add(y + by, 1);
    add(y - by - 1, -1);
    if (y < wide.y0) continue;
    for (std::size_t c = 0; c < columns; ++c)
      if (count[c] > 0) cells_[at(wide.x0 + static_cast<std::int32_t>(c), y)] = 1;
  }
  used_ = wide;
}

bool PlanCells::meets(const CellRange& range) const {
  const CellRange here = common(range, extent_);
  if (here.empty()) return false;
  for (std::int32_t y = here.y0; y <= here.y1; ++y)
    for (std::int32_t x = here.x0; x <= here.x1; ++x)
      if (cells_[at(x, y)]) return true;
  return false;
}

CellRuns PlanCells::runs() const {
  CellRuns out;
  out.box = box_;
  for (std::int32_t y = used_.y0; y <= used_.y1; ++y)
    for (std::int32_t x = used_.x0; x <= used_.x1; ++x) {
      if (!cells_[at(x, y)]) continue;
      std::int32_t end = x;
      while (end < used_.x1 && cells_[at(end + 1, y)]) ++end;
      out.runs.push_back({y, x, end});
      x = end;
    }
  return out;
}

}  // namespace blockrand::run
