#include "pipeline/observation/eaves.h"

#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::observation {

namespace {

// Heights that only the lean needs: a wrong one moves the roof it predicts by a fifth of the error at most.
constexpr double kStorey = 3.1, kPlinth = 0.3;  ///< m
constexpr double kEavesShare = 0.85;            ///< of a tagged height, under a roof that nobody measured
constexpr double kLowestEaves = 2;              ///< m

/// m of wall that a building shares with others: it stands in a row.
constexpr double kInRow = 3;

/// m: in an image whose lean nobody knows, higher houses may be seen metres from where they stand.
constexpr double kHighWithoutLean = 9;

/// m, and how many: measured buildings of a like size that speak for one that nobody measured.
constexpr double kNeighbourReach = 120;
constexpr std::size_t kFewestNeighbours = 3;

/// m: by a building's own tags; nothing where nobody counted or measured.
std::optional<double> tagged_eaves(const model::MappedAttributes& a) {
  if (a.height) {
    if (a.roof_height) return std::max(kLowestEaves, static_cast<double>(*a.height - *a.roof_height));
    return std::max(kLowestEaves,
                    static_cast<double>(*a.height) * (a.roof_shape == model::RoofShape::flat ? 1 : kEavesShare));
  }
  if (a.storeys) return std::max(1.0, static_cast<double>(*a.storeys)) * kStorey + kPlinth;
  return std::nullopt;
}

}  // namespace

double usual_eaves(double area, bool in_row) {
  if (in_row) return area < 25 ? 3.4 : area < 60 ? 6.5 : area < 150 ? 9 : area < 400 ? 11 : 13;
  return area < 25 ? 2.5 : area < 60 ? 3.3 : area < 150 ? 5 : area < 400 ? 7 : 10;
}

double shadow_uncertainty(double clearness) {
  if (clearness < 0) return 0.8;
  return clearness < 0.06 ? 0.4 : clearness < 0.12 ? 0.2 : 0.12;
}

EavesHeights::EavesHeights(const model::Extract& extract, const footprints::FootprintStore& footprints)
    : footprints_(&footprints), area_(footprints.size(), 0), guess_(footprints.size(), 0), tagged_(footprints.size()) {
  for (std::uint32_t b = 0; b < footprints.size(); ++b) {
    if (footprints[b].box.empty()) continue;
    footprints.for_each_ring(
        b, [&](std::span<const model::Point2> ring, bool) { area_[b] += geometry::signed_area(ring); });
    guess_[b] = usual_eaves(area_[b], footprints[b].party_wall_length > kInRow);
    tagged_[b] = tagged_eaves(extract.buildings[footprints[b].lead].attributes);
  }
  spread(footprints, tagged_, unseen_, unseen_uncertainty_);
  forget_shadows();
}

bool EavesHeights::surely_low(std::uint32_t b) const {
  return tagged_[b].value_or(usual_eaves(area_[b], false)) <= kHighWithoutLean;
}

/// Those that were measured, then the median of measured buildings of a like size nearby, then the guess.
void EavesHeights::spread(const footprints::FootprintStore& footprints, std::span<const std::optional<double>> measured,
                          std::vector<double>& heights, std::vector<double>& uncertainty) const {
  std::vector<geometry::PlanBox> known(footprints.size());
  heights = guess_;
  uncertainty.assign(footprints.size(), kGuessedUncertainty);
  for (std::uint32_t b = 0; b < footprints.size(); ++b) {
    if (!measured[b]) continue;
    heights[b] = *measured[b], uncertainty[b] = kTaggedUncertainty;
    known[b] = footprints[b].box;
  }
  const geometry::BoxIndex index(std::move(known));
  for (std::uint32_t b = 0; b < footprints.size(); ++b) {
    if (measured[b] || footprints[b].box.empty()) continue;
    std::vector<double> like;
    for (const std::uint32_t other : index.near(footprints[b].box, kNeighbourReach))
      if (guess_[other] == guess_[b]) like.push_back(*measured[other]);
    if (like.size() < kFewestNeighbours) continue;
    const auto middle = like.begin() + static_cast<std::ptrdiff_t>(like.size() / 2);
    std::nth_element(like.begin(), middle, like.end());
    heights[b] = *middle, uncertainty[b] = kNeighbourUncertainty;
  }
}

void EavesHeights::take(const ShadowHeights& shadows) {
  std::vector<std::optional<double>> measured = tagged_;
  for (std::uint32_t b = 0; b < shadows.buildings.size(); ++b) {
    const ShadowHeight& seen = shadows.buildings[b];
    if (seen.height > 0 && !measured[b] && shadow_uncertainty(seen.shadow.clearness) <= kTaggedUncertainty)
      measured[b] = seen.height;
  }
  spread(*footprints_, measured, heights_, uncertainty_);
  for (std::uint32_t b = 0; b < shadows.buildings.size(); ++b) {
    const ShadowHeight& seen = shadows.buildings[b];
    if (seen.height <= 0) continue;
    // What is joined with the shadow: the tag; the guess, where the shadow itself spoke above; else the neighbours.
    const bool alone = measured[b] && !tagged_[b];
    const double usual = alone ? unseen_[b] : heights_[b], own = alone ? kGuessedUncertainty : uncertainty_[b];
    const double share = shadow_uncertainty(seen.shadow.clearness);
    const double a = 1 / (own * own), c = 1 / (share * share);
    heights_[b] = base::exp((a * base::log(usual) + c * base::log(seen.height)) / (a + c));
    uncertainty_[b] = 1 / std::sqrt(a + c);
  }
}

}  // namespace blockrand::observation
