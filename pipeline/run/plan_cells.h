// Parts of the plane as sets of small squares: what a piece of work hears of is no rectangle, and boxes of boxes soon hold a town.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/geometry/box_index.h"

namespace blockrand::run {

/// m. Side of a square: about a house and its yard, so that what is added to each side is little beside the reaches.
inline constexpr double kReachCell = 50;

/// Squares by row, as they lie in the grid of the build CRS.
struct CellRuns {
  struct Run {
    std::int32_t y = 0, first = 0, last = 0;  ///< both count
  };
  std::vector<Run> runs;  ///< by row, then from west to east
  geometry::PlanBox box;  ///< m, around all

  /// Whether a square lies at most `distance` metres from the box, along both axes.
  bool near(const geometry::PlanBox& other, double distance) const;
  bool empty() const { return runs.empty(); }
};

/// Numbers of squares; the last ones count.
struct CellRange {
  std::int32_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;
  bool empty() const { return x0 > x1; }
  void include(const CellRange& other);
};
CellRange cells_of(const geometry::PlanBox& box);
CellRange common(const CellRange& a, const CellRange& b);

/// A set that grows.
class PlanCells {
 public:
  /// \param extent  what lies beyond is known by its box alone
  explicit PlanCells(const CellRange& extent);

  void include(const geometry::PlanBox& box);
  void include(const CellRange& range);
  void include(const PlanCells& other);
  /// To all sides along both axes. \param distance  m
  void grow(double distance);
  bool meets(const CellRange& range) const;
  /// Calls `visit(x, y)` for each square that lies in the extent.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::int32_t y = used_.y0; y <= used_.y1; ++y)
      for (std::int32_t x = used_.x0; x <= used_.x1; ++x)
        if (cells_[at(x, y)]) visit(x, y);
  }
  CellRuns runs() const;

 private:
  std::size_t at(std::int32_t x, std::int32_t y) const {
    return static_cast<std::size_t>(y - extent_.y0) * width_ + static_cast<std::size_t>(x - extent_.x0);
  }
  CellRange extent_, used_;  ///< used_: around all that are set
  std::size_t width_ = 0;
  std::vector<std::uint8_t> cells_;  ///< by row
  geometry::PlanBox box_;
};

}  // namespace blockrand::run
