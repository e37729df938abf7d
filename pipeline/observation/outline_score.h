// How well an outline lies on the edges of an image, for every displacement of it.
#pragma once

#include <span>
#include <vector>

#include "pipeline/base/portable_math.h"
#include "pipeline/model/polygon.h"
#include "pipeline/observation/image_windows.h"

namespace blockrand::observation {

/// A straight piece of a wall.
struct WallPiece {
  model::Point2 middle;  ///< m
  model::Point2 along;   ///< unit vector
  double length = 0;     ///< m
  double weight = 1;     ///< of a metre of it
};

/// m: longer walls are cut, so that a wall that is only in part on an edge counts in part.
inline constexpr double kPieceLength = 4;

/// The pieces of a ring's edges, in its order; edges under 0.4 m show no direction and are left out.
/// \param weight_of  of the edge from a ring's point i
void add_pieces(std::span<const model::Point2> ring, std::span<const double> weight_of, std::vector<WallPiece>& pieces);

/// Displacements on a square grid: (i * step, j * step) for |i|, |j| <= half, those within half * step of (0, 0).
struct Displacements {
  double step = 0.25;  ///< m
  int half = 20;
  int side() const { return 2 * half + 1; }
  double reach() const { return half * step; }
};

/// One number for each displacement.
struct ScoreMap {
  Displacements grid;
  std::vector<float> score;  ///< side * side, row by row from the south; of the corners beyond the reach 0
  double weight = 0;         ///< m of wall, by weight, that the image shows
  double missing = 0;        ///< as much that it does not show

  ScoreMap() = default;
  explicit ScoreMap(Displacements g)
      : grid(g), score(static_cast<std::size_t>(g.side()) * static_cast<std::size_t>(g.side()), 0.0F) {}
  float at(int i, int j) const {
    return score[static_cast<std::size_t>(j + grid.half) * static_cast<std::size_t>(grid.side()) +
                 static_cast<std::size_t>(i + grid.half)];
  }
  /// Bilinear; 0 beyond the grid. \param dx, dy  m
  double at(double dx, double dy) const;
};

/// The bands of a pixel, and 1 where the image does not show it. Four numbers that g++ and clang keep in one register: the
/// same sums on any x86-64.
typedef float Sample __attribute__((vector_size(16)));

/// A patch's pixels side by side: made once for all that is scored on it.
struct PatchSamples {
  PatchSamples(const Patch& patch);      // NOLINT(google-explicit-constructor): any patch is one
  double west = 0, north = 0, size = 0;  ///< as Patch has them
  int width = 0, height = 0;
  std::vector<Sample> pixels;  ///< width * height
};

/// m around the box of pieces that a patch must hold for score_outline(). \param pixel  m, of the patch
double score_margin(const Displacements& grid, double pixel);

/// For each displacement d the mean over the walls, by length and weight, of x / (x + contrast). x is the change of
/// brightness across the wall at its place moved by d: the difference between strips of half a metre on both sides,
/// averaged along the piece before its size is taken (texture cancels, an edge does not), the root of the sum of its
/// squares over the bands. In [0, 1].
/// \param turn      about `centre`, counter-clockwise, before the displacement
/// \param contrast  levels of 255
ScoreMap score_outline(std::span<const WallPiece> pieces, const PatchSamples& patch, const Displacements& grid,
                       model::Point2 centre, base::SinCos turn, double contrast);

}  // namespace blockrand::observation
