// Boxes in plan, and which of them come near a place.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::geometry {

/// Axis-parallel box in metres; empty while minimum is above maximum.
struct PlanBox {
  model::Point2 minimum{1, 1}, maximum{0, 0};
  bool empty() const { return minimum.x > maximum.x; }
  void include(model::Point2 p);
  void include(const PlanBox& other);
  model::Point2 centre() const { return {(minimum.x + maximum.x) / 2, (minimum.y + maximum.y) / 2}; }
  /// True when the boxes are at most `distance` apart along both axes; false for empty ones.
  bool near(const PlanBox& other, double distance) const;
};

PlanBox box_of(std::span<const model::Point2> points);

/// Boxes by the cells of a fixed grid; read-only after construction. Made for streets and blocks: boxes of some 100 m.
class BoxIndex {
 public:
  BoxIndex() = default;
  explicit BoxIndex(std::vector<PlanBox> boxes) : boxes_(std::move(boxes)) {
    for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
      if (boxes_[i].empty()) continue;
      extent_.include(boxes_[i]);
      if (cells_of(boxes_[i]) > kManyCells) {
        large_.push_back(i);
        continue;
      }
      for_each_cell(boxes_[i], 0, [&](Cell c) { entries_.emplace_back(c, i); });
    }
    std::sort(entries_.begin(), entries_.end());
  }
  /// Ascending.
  std::vector<std::uint32_t> near(const PlanBox& box, double distance) const {
    std::vector<std::uint32_t> out;
    if (!box.near(extent_, distance)) return out;
    for (const std::uint32_t i : large_)
      if (boxes_[i].near(box, distance)) out.push_back(i);
    if (cells_of(box, distance) > kManyCells) {  // as cheap to ask every box
      out.clear();
      for (std::uint32_t i = 0; i < boxes_.size(); ++i)
        if (boxes_[i].near(box, distance)) out.push_back(i);
      return out;
    }
    for_each_cell(box, distance, [&](Cell c) {
      for (auto e = std::lower_bound(entries_.begin(), entries_.end(), std::pair(c, 0u));
           e != entries_.end() && e->first == c; ++e)
        if (boxes_[e->second].near(box, distance)) out.push_back(e->second);
    });
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }
  const PlanBox& box(std::uint32_t i) const { return boxes_[i]; }

 private:
  using Cell = std::pair<std::int32_t, std::int32_t>;
  static constexpr double kSize = 250;         // m
  static constexpr double kManyCells = 10000;  // a box over more stands in a list of its own
  static double cells_of(const PlanBox& box, double distance = 0) {
    return ((box.maximum.x - box.minimum.x + 2 * distance) / kSize + 1) *
           ((box.maximum.y - box.minimum.y + 2 * distance) / kSize + 1);
  }
  template <class Visit>
  static void for_each_cell(const PlanBox& box, double distance, Visit&& visit) {
    const auto cell = [](double v) { return static_cast<std::int32_t>(std::floor(v / kSize)); };
    for (std::int32_t x = cell(box.minimum.x - distance); x <= cell(box.maximum.x + distance); ++x)
      for (std::int32_t y = cell(box.minimum.y - distance); y <= cell(box.maximum.y + distance); ++y) visit(Cell{x, y});
  }
  std::vector<PlanBox> boxes_;
  PlanBox extent_;
  std::vector<std::uint32_t> large_;
  std::vector<std::pair<Cell, std::uint32_t>> entries_;
};

}  // namespace blockrand::geometry
