// Gable houses by weights, for tests that want many: front and roof (docs/sources.md, Holtmeier 5.5).
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string_view>

#include "pipeline/base/random.h"
#include "styles/roofs/gables.h"

namespace blockrand::roofs {

/// How often what is drawn (docs/sources.md, Holtmeier 5.5, [P] there).
struct GableWeights {
  double attic = 0.2;                                       ///< share of all houses with a gable to the street
  double stepped = 0.5, curved = 0.5;                       ///< of the others
  double gabled = 0.5, half_hipped = 0.25, mansard = 0.25;  ///< roofs behind those; behind an attic a hip
  double pediment = 0.5;                                    ///< share of attics that have one [P]
};

/// A gable house: the front and the roof behind it.
struct DrawnGable {
  GableOptions gable;
  model::RoofShape roof = model::RoofShape::gabled;
};

/// Index of the weight that a number in [0, 1) falls on.
inline std::size_t pick(double unit, std::initializer_list<double> weights) {
  double sum = 0;
  for (const double w : weights) sum += w;
  double rest = unit * sum;
  std::size_t i = 0;
  for (const double w : weights) {
    if (rest < w) return i;
    rest -= w;
    ++i;
  }
  return weights.size() - 1;
}

/// Draws a gable for a roof that is known. Empty where none may stand before it.
inline std::optional<GableOptions> draw_gable(std::uint64_t seed, std::uint64_t object, model::RoofShape roof,
                                              const GableWeights& weights = {}) {
  const auto unit = [&](std::string_view choice) { return base::random_unit(seed, object, choice); };
  GableOptions out;
  if (may_stand_before(GableForm::attic, roof)) {
    out.form = GableForm::attic;
    if (unit("gable pediment") < weights.pediment) out.pediment = 0.6;
    return out;
  }
  if (!may_stand_before(GableForm::stepped, roof)) return std::nullopt;
  out.form = pick(unit("gable form"), {weights.stepped, weights.curved}) == 0 ? GableForm::stepped : GableForm::curved;
  out.steps = 3 + static_cast<int>(base::random_bits(seed, object, "gable steps") % 3);
  out.curves = 1 + static_cast<int>(base::random_bits(seed, object, "gable curves") % 2);
  return out;
}

/// Draws both; every choice is keyed by (seed, object, its name).
inline DrawnGable draw_gable_house(std::uint64_t seed, std::uint64_t object, const GableWeights& weights = {}) {
  const auto unit = [&](std::string_view choice) { return base::random_unit(seed, object, choice); };
  DrawnGable out;
  if (unit("gable or attic") < weights.attic) {
    out.roof = model::RoofShape::hipped;
  } else {
    constexpr model::RoofShape shapes[] = {model::RoofShape::gabled, model::RoofShape::half_hipped,
                                           model::RoofShape::mansard};
    out.roof = shapes[pick(unit("roof behind a gable"), {weights.gabled, weights.half_hipped, weights.mansard})];
  }
  out.gable = *draw_gable(seed, object, out.roof, weights);
  return out;
}

}  // namespace blockrand::roofs
