// How high the edges of roofs are, as far as the lean of images needs it: by tags, shadows, neighbours, or a guess.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/footprints/footprint_store.h"
#include "pipeline/model/extract.h"
#include "pipeline/observation/shadow_heights.h"

namespace blockrand::observation {

/// Shares of a height: storeys are 2.6 to 4 m high; like houses stand together; sizes of plans say little.
inline constexpr double kTaggedUncertainty = 0.2, kNeighbourUncertainty = 0.35, kGuessedUncertainty = 0.5;

/// By how much of it a height may be off that a shadow of this clearness tells (ShadowLength::clearness): half the
/// distance between the quartiles on the synthetic images of set `tuning` (tests/bench/imagery), and a little more.
double shadow_uncertainty(double clearness);

/// m: a guess by the area of a plan in m2 and whether it stands in a row: sheds, small houses, houses, blocks.
/// Medians of tagged storeys (docs/internal/RESULTS.md, "Aerial images"). No two are equal: they are classes as well.
double usual_eaves(double area, bool in_row);

/// Eaves above ground, in m, and by how much of it each may be off. By building number; none is read from attributes,
/// which are resolved later.
class EavesHeights {
 public:
  EavesHeights() = default;
  EavesHeights(const model::Extract& extract, const footprints::FootprintStore& footprints);

  double height(std::uint32_t b) const { return heights_[b]; }
  std::span<const double> heights() const { return heights_; }
  double uncertainty(std::uint32_t b) const { return uncertainty_[b]; }
  bool is_tagged(std::uint32_t b) const { return tagged_[b].has_value(); }
  /// Without what shadows tell.
  std::span<const double> unseen_heights() const { return unseen_; }
  std::span<const double> unseen_uncertainty() const { return unseen_uncertainty_; }
  /// Low enough to be seen where it stands though nobody knows the image's lean: it is tagged so, or its plan is that of
  /// a low house. Rows are left out of this, being high in some towns and low in others.
  bool surely_low(std::uint32_t b) const;

  /// What the shadows of one image tell, instead of those of the image before. Heights of a building's own sources are
  /// joined as their geometric mean by how sure they are; neighbours of a like size speak where it has none of its own.
  void take(const ShadowHeights& shadows);
  void forget_shadows() { heights_ = unseen_, uncertainty_ = unseen_uncertainty_; }

 private:
  void spread(const footprints::FootprintStore& footprints, std::span<const std::optional<double>> measured,
              std::vector<double>& heights, std::vector<double>& uncertainty) const;

  const footprints::FootprintStore* footprints_ = nullptr;
  std::vector<double> area_;   ///< m2
  std::vector<double> guess_;  ///< m
  std::vector<std::optional<double>> tagged_;
  std::vector<double> unseen_, unseen_uncertainty_, heights_, uncertainty_;
};

}  // namespace blockrand::observation
