// The height of the ground in a square of the surroundings' grid: a surface of plane triangles that neighbouring squares share
// along their border.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "pipeline/geometry/box_index.h"
#include "pipeline/geometry/noded_lines.h"
#include "pipeline/model/point.h"

namespace blockrand::surroundings {

/// m; the ground is worked out in squares of this size, whose corners are multiples of it in the build CRS. A block is one to
/// four of them.
inline constexpr double kSquareSize = 125;
/// Of a side: triangles of terrain are 12.5 m long. With 7.8 m a town on a slope takes a third more bytes.
inline constexpr int kTerrainSteps = 10;

/// m above the build's height reference at a place; nothing where it is not known.
using HeightAt = std::function<std::optional<double>(model::Point2)>;

/// Column and row of a square: its corner is kSquareSize times that.
struct SquareIndex {
  std::int32_t x = 0, y = 0;
  friend auto operator<=>(const SquareIndex&, const SquareIndex&) = default;
};
SquareIndex square_of(model::Point2 place);
geometry::PlanBox box_of(SquareIndex square);

class SquareGround {
 public:
  /// \param height  asked at the corners of the triangles; empty: the ground is level
  /// \param level   m, where there is no terrain, and where it has no height
  SquareGround(SquareIndex square, const HeightAt& height, double level);

  bool is_level() const { return heights_.empty(); }
  /// m, on the 1/1024 m grid. The same for a place on the border of two squares. Places outside have the height of the nearest
  /// place within.
  double at(model::Point2 place) const;
  /// The sides of the triangles; none where the ground is level.
  std::vector<geometry::DividingLine> lines() const;

 private:
  double node(int column, int row) const {
    return heights_[static_cast<std::size_t>(row * (kTerrainSteps + 1) + column)];
  }
  SquareIndex square_;
  double level_ = 0;
  std::vector<double> heights_;  ///< rows from south to north
};

}  // namespace blockrand::surroundings
