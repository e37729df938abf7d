// Boxes in plan, and which of them come near a place.
#pragma once

#include <compare>
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

/// The one index of boxes, and of points as boxes without extent: which come near a place, and which near each other.
/// Boxes by the cells of a fixed grid; read-only after construction, safe to share between threads. Measured against an
/// R-tree in tests/bench/kernel_benchmark.cpp.
class BoxIndex {
 public:
  static constexpr double kStreetCell = 250;  ///< m, for streets and blocks: boxes of some 100 m
  static constexpr double kHouseCell = 64;    ///< m, two to four houses wide: few boxes lie in more than four cells

  BoxIndex() = default;
  /// Empty boxes keep their number and are never found.
  /// \param cell  m, positive; about the size of a usual box or query. What is found does not depend on it.
  explicit BoxIndex(std::vector<PlanBox> boxes, double cell = kStreetCell);
  /// The boxes at most `distance` metres from `box` along both axes, ascending.
  std::vector<std::uint32_t> near(const PlanBox& box, double distance) const;
  /// All pairs a < b of boxes at most `distance` metres apart along both axes, ascending.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs(double distance) const;
  const PlanBox& box(std::uint32_t i) const { return boxes_[i]; }

 private:
  struct Entry {
    std::int32_t x = 0, y = 0;  ///< cell
    std::uint32_t box = 0;
    friend auto operator<=>(const Entry&, const Entry&) = default;
  };
  std::int32_t cell_of(double metres) const;
  double cells_of(const PlanBox& box, double distance) const;

  std::vector<PlanBox> boxes_;
  double cell_ = kStreetCell;
  PlanBox extent_;
  std::vector<std::uint32_t> large_;  ///< boxes over so many cells that all queries ask for them
  std::vector<Entry> entries_;        ///< sorted
};

}  // namespace blockrand::geometry
