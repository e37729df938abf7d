// The way of many points from the build CRS into a tile's east-north-up frame, without a projection for each.
#pragma once

#include <array>

#include "pipeline/georef/frames.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/region.h"

namespace blockrand::georef {

/// East-north-up frame of a tile with a polynomial for the way into it.
///
/// Position and ellipsoid normal at height 0 are polynomials of total degree 4 in (x, y), interpolated at 5 x 5
/// Chebyshev points of the tile plus 1 km; height moves a point along the normal. The error is measured on a grid of
/// other points against the exact way; where it exceeds kMaxError (tiles of tens of kilometres, steps in a datum grid),
/// and for points outside of that area, the exact way is taken. Deterministic bit for bit when Projection::portable().
class TileFrame {
 public:
  static constexpr double kMaxError = 1e-4;  ///< m; a tenth of the millimetre that ARCHITECTURE.md, law 8 promises
  static constexpr double kMargin = 1000;    ///< m around the tile that the polynomial covers

  /// \param tile            the origin is its centre
  /// \param origin_height   metres above the ellipsoid
  TileFrame(const Projection& projection, const model::TileId& tile, double origin_height = 0);

  /// East-north-up metres of a point of the build CRS; `z` is its height above the ellipsoid (the caller adds the
  /// offset).
  model::Point3 to_local(const model::Point3& p) const;

  /// The same through inverse projection and earth-centred coordinates.
  model::Point3 to_local_exact(const model::Point3& p) const;

  const EnuFrame& frame() const { return frame_; }
  double max_error_m() const { return max_error_; }  ///< measured at heights 0 and 1000 m; 0 when exact
  bool exact() const { return exact_; }              ///< whether every point takes the exact way

 private:
  static constexpr int kDegree = 4;
  static constexpr int kTerms = (kDegree + 1) * (kDegree + 2) / 2;
  using Vector6 = std::array<double, 6>;  // position at height 0, then normal

  Vector6 exact_at(double x, double y) const;
  void fit();
  double measure() const;
  model::Point3 evaluate(double u, double v, double height) const;

  Projection projection_;
  EnuFrame frame_;
  double centre_x_ = 0, centre_y_ = 0, half_x_ = 1, half_y_ = 1;
  std::array<Vector6, kTerms> terms_{};  // by power of v, then of u: (j = 0: i = 0..4), (j = 1: i = 0..3), ...
  double max_error_ = 0;
  bool exact_ = false;
};

}  // namespace blockrand::georef
