#include "pipeline/geometry/box_index.h"

#include <algorithm>
#include <cmath>

namespace blockrand::geometry {

void PlanBox::include(model::Point2 p) {
  if (empty()) {
    minimum = maximum = p;
    return;
  }
  minimum = {std::min(minimum.x, p.x), std::min(minimum.y, p.y)};
  maximum = {std::max(maximum.x, p.x), std::max(maximum.y, p.y)};
}

void PlanBox::include(const PlanBox& other) {
  if (other.empty()) return;
  include(other.minimum);
  include(other.maximum);
}

PlanBox box_of(std::span<const model::Point2> points) {
  PlanBox box;
  for (const model::Point2 p : points) box.include(p);
  return box;
}

bool PlanBox::near(const PlanBox& other, double distance) const {
  if (empty() || other.empty()) return false;
  return minimum.x <= other.maximum.x + distance && other.minimum.x <= maximum.x + distance &&
         minimum.y <= other.maximum.y + distance && other.minimum.y <= maximum.y + distance;
}

namespace {

/// A box over more cells stands in a list of its own; for a query over more it is as cheap to ask every box.
constexpr double kManyCells = 4096;

}  // namespace

std::int32_t BoxIndex::cell_of(double metres) const { return static_cast<std::int32_t>(std::floor(metres / cell_)); }

double BoxIndex::cells_of(const PlanBox& box, double distance) const {
  return ((box.maximum.x - box.minimum.x + 2 * distance) / cell_ + 1) *
         ((box.maximum.y - box.minimum.y + 2 * distance) / cell_ + 1);
}

BoxIndex::BoxIndex(std::vector<PlanBox> boxes, double cell) : boxes_(std::move(boxes)), cell_(cell) {
  for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
    const PlanBox& box = boxes_[i];
    if (box.empty()) continue;
    extent_.include(box);
    if (cells_of(box, 0) > kManyCells) {
      large_.push_back(i);
      continue;
    }
    for (std::int32_t x = cell_of(box.minimum.x); x <= cell_of(box.maximum.x); ++x)
      for (std::int32_t y = cell_of(box.minimum.y); y <= cell_of(box.maximum.y); ++y) entries_.push_back({x, y, i});
  }
  std::sort(entries_.begin(), entries_.end());
}

std::vector<std::uint32_t> BoxIndex::near(const PlanBox& box, double distance) const {
  std::vector<std::uint32_t> out;
  if (!box.near(extent_, distance)) return out;
  if (cells_of(box, distance) > kManyCells) {
    for (std::uint32_t i = 0; i < boxes_.size(); ++i)
      if (boxes_[i].near(box, distance)) out.push_back(i);
    return out;
  }
  const std::int32_t y0 = cell_of(box.minimum.y - distance), y1 = cell_of(box.maximum.y + distance);
  for (std::int32_t x = cell_of(box.minimum.x - distance); x <= cell_of(box.maximum.x + distance); ++x) {
    // Cells of one column are consecutive in the sorted order.
    auto entry = std::lower_bound(entries_.begin(), entries_.end(), Entry{x, y0, 0});
    for (; entry != entries_.end() && entry->x == x && entry->y <= y1; ++entry)
      if (boxes_[entry->box].near(box, distance)) out.push_back(entry->box);
  }
  for (const std::uint32_t i : large_)
    if (boxes_[i].near(box, distance)) out.push_back(i);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> BoxIndex::pairs(double distance) const {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
  for (std::uint32_t a = 0; a < boxes_.size(); ++a)
    for (const std::uint32_t b : near(boxes_[a], distance))
      if (a < b) out.emplace_back(a, b);
  return out;
}

}  // namespace blockrand::geometry
