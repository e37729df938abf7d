#include "pipeline/georef/tile_frame.h"

#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "pipeline/georef/tiles.h"

namespace blockrand::georef {
namespace {

constexpr int kNodes = 5;              // degree + 1
constexpr int kCheckPoints = 12;       // along each side; even, so that few fall on Chebyshev points
constexpr double kCheckHeight = 1000;  // m; higher than any building and most offsets between tiles and ground

/// Monomial coefficients of the Chebyshev polynomials T0 to T4.
constexpr double kChebyshev[kNodes][kNodes] = {
    {1, 0, 0, 0, 0}, {0, 1, 0, 0, 0}, {-1, 0, 2, 0, 0}, {0, -3, 0, 4, 0}, {1, 0, -8, 0, 8}};

}  // namespace

TileFrame::TileFrame(const Projection& projection, const model::TileId& tile, double origin_height)
    : projection_(projection), frame_({centre(tile).lon, centre(tile).lat, origin_height}) {
  // The tile's outline in the CRS: its sides are curves, so that corners alone would not bound it.
  const GeoBox box = bounds(tile);
  constexpr int kSteps = 4;
  double west = INFINITY, east = -INFINITY, south = INFINITY, north = -INFINITY;
  bool defined = true;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const LonLat g = box.at(static_cast<double>(i) / kSteps, static_cast<double>(j) / kSteps);
      const model::Point2 p = projection_.forward(g.lon, g.lat);
      defined = defined && std::isfinite(p.x) && std::isfinite(p.y);
      west = std::min(west, p.x), east = std::max(east, p.x);
      south = std::min(south, p.y), north = std::max(north, p.y);
    }
  }
  if (!defined) {
    exact_ = true;
    return;
  }
  const double margin = kMargin * std::max(1.0, projection_.grid_scale(frame_.origin().lon, frame_.origin().lat));
  centre_x_ = 0.5 * (west + east), half_x_ = 0.5 * (east - west) + margin;
  centre_y_ = 0.5 * (south + north), half_y_ = 0.5 * (north - south) + margin;
  fit();
  max_error_ = measure();
  if (!(max_error_ <= kMaxError)) {
    exact_ = true;
    max_error_ = 0;
  }
}

TileFrame::Vector6 TileFrame::exact_at(double x, double y) const {
  const LonLat g = projection_.inverse({x, y});
  const model::Point3 p = frame_.to_local(g.lon, g.lat, 0);
  const base::SinCos lon = base::sin_cos(g.lon * base::kRadiansPerDegree);
  const base::SinCos lat = base::sin_cos(g.lat * base::kRadiansPerDegree);
  const model::Point3 n = frame_.rotate_to_local({lat.cos * lon.cos, lat.cos * lon.sin, lat.sin});
  return {p.x, p.y, p.z, n.x, n.y, n.z};
}

void TileFrame::fit() {
  double node[kNodes];
  for (int k = 0; k < kNodes; ++k) node[k] = base::cos((k + 0.5) * base::kPi / kNodes);
  double value[kNodes][kNodes];  // value[m][k] = T_m(node_k)
  for (int m = 0; m < kNodes; ++m) {
    for (int k = 0; k < kNodes; ++k) value[m][k] = base::cos(m * (k + 0.5) * base::kPi / kNodes);
  }
  Vector6 sample[kNodes][kNodes];
  for (int k = 0; k < kNodes; ++k) {
    for (int l = 0; l < kNodes; ++l) {
      sample[k][l] = exact_at(centre_x_ + half_x_ * node[k], centre_y_ + half_y_ * node[l]);
    }
  }
  double monomial[kNodes][kNodes][6] = {};  // of u^i v^j
  for (int m = 0; m < kNodes; ++m) {
    for (int n = 0; m + n <= kDegree; ++n) {  // the rest is far below the error and is measured with it
      for (std::size_t c = 0; c < 6; ++c) {
        double sum = 0;
        for (int k = 0; k < kNodes; ++k) {
          for (int l = 0; l < kNodes; ++l) sum += sample[k][l][c] * value[m][k] * value[n][l];
        }
        const double coefficient = sum * (m == 0 ? 1.0 : 2.0) * (n == 0 ? 1.0 : 2.0) / (kNodes * kNodes);
        for (int i = 0; i <= m; ++i) {
          for (int j = 0; j <= n; ++j) monomial[i][j][c] += coefficient * kChebyshev[m][i] * kChebyshev[n][j];
        }
      }
    }
  }
  std::size_t term = 0;
  for (int j = 0; j <= kDegree; ++j) {
    for (int i = 0; i + j <= kDegree; ++i, ++term) {
      for (std::size_t c = 0; c < 6; ++c) terms_[term][c] = monomial[i][j][c];
    }
  }
}

model::Point3 TileFrame::evaluate(double u, double v, double height) const {
  Vector6 sum{};
  std::size_t term = kTerms;
  for (int j = kDegree; j >= 0; --j) {  // Horner in v of Horner in u
    Vector6 row{};
    for (int i = kDegree - j; i >= 0; --i) {
      --term;
      for (std::size_t c = 0; c < 6; ++c) row[c] = row[c] * u + terms_[term][c];
    }
    for (std::size_t c = 0; c < 6; ++c) sum[c] = sum[c] * v + row[c];
  }
  return {sum[0] + height * sum[3], sum[1] + height * sum[4], sum[2] + height * sum[5]};
}

double TileFrame::measure() const {
  double worst = 0;
  for (int i = 0; i < kCheckPoints; ++i) {
    for (int j = 0; j < kCheckPoints; ++j) {
      const double u = 2.0 * i / (kCheckPoints - 1) - 1, v = 2.0 * j / (kCheckPoints - 1) - 1;
      const Vector6 e = exact_at(centre_x_ + half_x_ * u, centre_y_ + half_y_ * v);
      for (const double height : {0.0, kCheckHeight}) {
        const model::Point3 p = evaluate(u, v, height);
        const double dx = p.x - (e[0] + height * e[3]), dy = p.y - (e[1] + height * e[4]),
                     dz = p.z - (e[2] + height * e[5]);
        const double error = std::sqrt(dx * dx + dy * dy + dz * dz);
        if (!(error <= worst)) worst = error;  // NaN wins
      }
    }
  }
  return worst;
}

model::Point3 TileFrame::to_local(const model::Point3& p) const {
  const double u = (p.x - centre_x_) / half_x_, v = (p.y - centre_y_) / half_y_;
  if (exact_ || !(std::fabs(u) <= 1) || !(std::fabs(v) <= 1)) return to_local_exact(p);
  return evaluate(u, v, p.z);
}

model::Point3 TileFrame::to_local_exact(const model::Point3& p) const {
  const LonLat g = projection_.inverse(p.xy());
  return frame_.to_local(g.lon, g.lat, p.z);
}

}  // namespace blockrand::georef
