// Boxes in plan, and which of them come near a place.
#pragma once

#include <cstdint>
#include <memory>
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

/// The one index of boxes, and of points as boxes without extent: which come near a place, and which near each other.
/// Boost.Geometry's packed R-tree; read-only after construction, safe to share between threads. It was measured against
/// sorted cells of a fixed grid (docs/internal/RESULTS.md, "Index of boxes").
class BoxIndex {
 public:
  BoxIndex();
  /// Empty boxes keep their number and are never found.
  explicit BoxIndex(std::vector<PlanBox> boxes);
  /// The boxes at most `distance` metres from `box` along both axes, ascending.
  std::vector<std::uint32_t> near(const PlanBox& box, double distance) const;
  /// All pairs a < b of boxes at most `distance` metres apart along both axes, ascending.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs(double distance) const;
  const PlanBox& box(std::uint32_t i) const { return boxes_[i]; }

 private:
  struct Tree;
  std::vector<PlanBox> boxes_;
  std::shared_ptr<const Tree> tree_;  ///< null: no box
};

}  // namespace blockrand::geometry
