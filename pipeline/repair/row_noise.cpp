#include "pipeline/repair/row_noise.h"

#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"

namespace blockrand::repair {

namespace {

constexpr double kFreedom = 3;           // of Student's t: tails as long as mappers' slips
constexpr double kDensity = 0.7351051938957227;  // 2 / (sqrt(3) pi / 2): of |t| at 0
constexpr double kToDeviation = 1.2;     // standard deviation of evenly disturbed corners by that t's scale
constexpr double kUsualShare = 0.75;     // of walls that belong to a frame, before a building is seen,
constexpr double kUsualWeight = 2;       // which counts like so many walls
constexpr double kFewWalls = 2.5;        // the noise is raised by this over the walls that tell of it
constexpr int kRounds = 8;               // EM is near its end then

struct Fit {
  double scale = 0, telling = 0, likelihood = 0;
  std::vector<double> share;
};

/// Density of a deviation under the frame.
double density(double off, double scale) {
  const double z = off / scale, q = 1 + z * z / kFreedom;
  return kDensity / (scale * q * q);
}

Fit run(std::span<const Deviation> deviations, std::size_t buildings, double scale) {
  Fit fit;
  fit.scale = scale;
  fit.share.assign(buildings, kUsualShare);
  std::vector<double> belong(buildings), count(buildings);
  for (int round = 0; round < kRounds; ++round) {
    std::fill(belong.begin(), belong.end(), kUsualShare * kUsualWeight);
    std::fill(count.begin(), count.end(), kUsualWeight);
    double weight = 0, squares = 0;
    for (const Deviation& d : deviations) {
      const double in = fit.share[d.building] * density(d.off, fit.scale), out = (1 - fit.share[d.building]) / d.range;
      const double r = in / (in + out), z = d.off / fit.scale;
      belong[d.building] += r, count[d.building] += 1;
      weight += r, squares += r * (kFreedom + 1) / (kFreedom + z * z) * d.off * d.off;
    }
    // Every frame is fitted to the same walls.
    const double freedom = std::max(weight - static_cast<double>(buildings), 0.5 * weight);
    fit.telling = freedom;
    if (freedom > 0) fit.scale = std::clamp(std::sqrt(squares / freedom), kLeastNoise / kToDeviation, kLargestNoise);
    for (std::size_t b = 0; b < buildings; ++b) fit.share[b] = belong[b] / count[b];
  }
  // The product of densities, its logarithm taken before it can overflow.
  double product = 1;
  std::size_t factors = 0;
  for (const Deviation& d : deviations) {
    product *= fit.share[d.building] * density(d.off, fit.scale) + (1 - fit.share[d.building]) / d.range;
    if (++factors % 32 == 0) fit.likelihood += base::log(product), product = 1;
  }
  fit.likelihood += base::log(product);
  return fit;
}

}  // namespace

RowNoise fit_noise(std::span<const Deviation> deviations, std::size_t buildings) {
  if (deviations.empty()) return {kLeastNoise, std::vector<double>(buildings, kUsualShare)};
  Fit low = run(deviations, buildings, 2 * kLeastNoise), high = run(deviations, buildings, kLargestNoise / 2);
  Fit& fit = low.likelihood > high.likelihood ? low : high;
  const double noise = fit.scale * kToDeviation * (1 + kFewWalls / std::max(fit.telling, 1.0));
  return {std::clamp(noise, kLeastNoise, kLargestNoise), std::move(fit.share)};
}

}  // namespace blockrand::repair
