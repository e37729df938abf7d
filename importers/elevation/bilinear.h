// The surface between four pixel centres, and its extremes along straight lines.
#pragma once

#include <cmath>
#include <limits>

namespace blockrand::importers::elevation {

/// Lowest and highest of what was added, m.
struct Extremes {
  double lowest = std::numeric_limits<double>::infinity(), highest = -std::numeric_limits<double>::infinity();
  bool known() const { return lowest <= highest; }
  void add(double height) {  // both are false for NaN
    if (height < lowest) lowest = height;
    if (height > highest) highest = height;
  }
};

/// Heights at the corners (u, v) = (0, 0), (1, 0), (0, 1), (1, 1), m; NaN where there is no value.
struct Cell {
  double z00 = 0, z10 = 0, z01 = 0, z11 = 0;
};

struct CellPoint {
  double u = 0, v = 0;  ///< in [0, 1]
};

/// Adds the extremes along the straight line from `a` to `b` inside of a cell.
///
/// The height is the mean of the known corners with bilinear weights; where all four are known, the bilinear value.
/// Along a line that is a quotient of two quadratics, whose derivative vanishes at the roots of one more. Heights there
/// and at the ends are taken. Nothing is added where no corner with a weight is known.
void widen(Extremes& extremes, const Cell& cell, CellPoint a, CellPoint b);

}  // namespace blockrand::importers::elevation
