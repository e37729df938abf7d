// The ground of a tile as a mesh of cells that pictures are laid on.
#pragma once

#include <cstddef>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::model {

/// A square of the ground, x to the east and y to the north in the build CRS, in rows of cells of equal size. Squares lie side by
/// side in a grid that is fixed in the CRS; neighbours have the same points along their border.
struct GroundSquare {
  Point2 corner;  ///< m, the south-western one
  /// m above the build's height reference, of the corners of cells: (cells + 1)² of them, in rows from south to north
  std::vector<double> heights;
};

/// The squares whose middles lie in a tile, by rows from the south.
struct GroundMesh {
  double square = 0;  ///< m, side of a square
  int cells = 0;      ///< along each side of a square
  std::vector<GroundSquare> squares;

  /// Corner of a cell; columns and rows from 0 to `cells`.
  Point3 at(const GroundSquare& s, int column, int row) const {
    const double cell = square / cells;
    return {s.corner.x + column * cell, s.corner.y + row * cell,
            s.heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(cells + 1) +
                      static_cast<std::size_t>(column)]};
  }
};

}  // namespace blockrand::model
