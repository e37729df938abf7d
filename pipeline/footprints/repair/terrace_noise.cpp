#include "pipeline/footprints/repair/terrace_noise.h"

#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"

namespace blockrand::repair {

namespace {

constexpr double kHalfNormal = 0.7978845608028654;  // 2 / sqrt(2 pi): density at 0 of a normal's absolute value
constexpr double kHalfCauchy = 0.6366197723675814;  // 2 / pi: the same of a Cauchy distribution's
constexpr double kDiagonal = 0.7071067811865476;    // sin 45 degrees: no wall is farther off a frame
constexpr double kUsualShare = 0.75;                // of walls that belong to a frame, before a building is seen,
constexpr double kUsualWeight = 2;                  // which counts like so many walls
constexpr double kUsualSlight = 0.05;               // of these that are truly a little off, before a row is seen,
constexpr double kSlightWeight = 10;                // the same
constexpr double kSlightTurn = 0.0175;              // radians (1 degree): how far that is, standard deviation
constexpr double kObliqueTurn = 0.07;  // radians (4 degrees): half of the walls of no frame are about so far off
constexpr double kUsualNoise = 0.04;   // m, of mappers; more is rarer:
constexpr double kUsualSpread = 1.4;   // standard deviation of its logarithm
constexpr double kFewWalls = 2.5;      // the noise is raised by this over the walls that tell of it
constexpr double kLeastScale = 0.001;  // m. Truth on the 1/1024 m grid
constexpr int kRounds = 8;             // EM is near its end then

struct Fit {
  double scale = 0, telling = 0, likelihood = 0, slight = kUsualSlight;
  std::vector<double> share;
};

/// Density of a deviation that is all noise.
double density(double off, double scale) {
  const double z = off / scale, exponent = 0.5 * z * z;
  return exponent > 100 ? 0 : kHalfNormal / scale * base::exp(-exponent);
}
double slight_scale(double weight, double scale) {
  return std::sqrt(scale * scale + kSlightTurn * kSlightTurn * weight);
}
/// Of walls of no frame: half of them have any direction, half are nearly in the frame, since who builds obliquely does
/// so slightly more often than not.
double any_density(double off, double weight) {
  const double root = std::sqrt(weight), z = off / (kObliqueTurn * root);
  return (0.5 / kDiagonal + 0.5 * kHalfCauchy / (kObliqueTurn * (1 + z * z))) / root;
}

struct Shares {
  double exact, slight, any;
  double sum() const { return exact + slight + any; }
};
Shares shares(const Fit& fit, const Deviation& d) {
  const double share = fit.share[d.building];
  return {share * (1 - fit.slight) * density(d.off, fit.scale),
          share * fit.slight * density(d.off, slight_scale(d.weight, fit.scale)),
          (1 - share) * any_density(d.off, d.weight)};
}

Fit run(std::span<const Deviation> deviations, std::size_t buildings, std::size_t frames, double scale) {
  Fit fit;
  fit.scale = scale;
  fit.share.assign(buildings, kUsualShare);
  std::vector<double> belong(buildings), walls(buildings);
  for (int round = 0; round < kRounds; ++round) {
    std::fill(belong.begin(), belong.end(), kUsualShare * kUsualWeight);
    std::fill(walls.begin(), walls.end(), kUsualWeight);
    double exact = 0, squares = 0, slight = kUsualSlight * kSlightWeight, all_about = kSlightWeight;
    for (const Deviation& d : deviations) {
      const Shares s = shares(fit, d);
      const double sum = s.sum(), r = d.count * s.exact / sum, about = d.count * (1 - s.any / sum);
      belong[d.building] += about, walls[d.building] += d.count;
      slight += d.count * s.slight / sum, all_about += about;
      exact += r, squares += r * d.off * d.off;
    }
    // Every frame is fitted to the same walls.
    fit.telling = std::max(exact - static_cast<double>(frames), 0.5 * exact);
    if (fit.telling > 0) fit.scale = std::clamp(std::sqrt(squares / fit.telling), kLeastScale, kLargestNoise);
    fit.slight = slight / all_about;
    for (std::size_t b = 0; b < buildings; ++b) fit.share[b] = belong[b] / walls[b];
  }
  for (const Deviation& d : deviations) fit.likelihood += d.count * base::log(shares(fit, d).sum());
  // The frames were fitted, too: each is known the better the smaller the noise, which must not make a small one
  // likelier.
  fit.likelihood += static_cast<double>(frames) * base::log(fit.scale);
  // Careless mappers are rare; careful ones are not.
  const double careless = std::max(0.0, base::log(fit.scale / kUsualNoise) / kUsualSpread);
  fit.likelihood -= 0.5 * careless * careless;
  return fit;
}

}  // namespace

TerraceNoise fit_noise(std::span<const Deviation> deviations, std::size_t buildings, std::size_t frames, double noise) {
  if (deviations.empty()) return {kLeastNoise, std::vector<double>(buildings, kUsualShare), kUsualSlight, 0};
  Fit fit = run(deviations, buildings, frames, noise);
  const double raised = fit.scale * (1 + kFewWalls / std::max(fit.telling, 1.0));
  return {std::clamp(raised, kLeastNoise, kLargestNoise), std::move(fit.share), fit.slight, fit.likelihood};
}

double odds_of_frame(const TerraceNoise& row, std::size_t building, double weight) {
  const double share = row.share[building];
  return share * (1 - row.slight) * kHalfNormal / row.noise / ((1 - share) * any_density(0, weight));
}

}  // namespace blockrand::repair
