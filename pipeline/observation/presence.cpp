#include "pipeline/observation/presence.h"

#include <algorithm>

#include "pipeline/base/portable_math.h"

namespace blockrand::observation {

namespace {

/// Levels of 255: a cloud, snow, or a roof of white foil.
constexpr int kWhite = 195, kGrey = 18;

bool is_white(const model::Colour& c) {
  return std::min({c.r, c.g, c.b}) >= kWhite && std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b}) <= kGrey;
}

}  // namespace

double gone_probability(const OutlineReceipt& receipt, const RoofView& roof, double shadow_clearness) {
  if (receipt.image == OutlineReceipt::kNoImage || receipt.deviation <= 0 || roof.pixels == 0 ||
      roof.image != receipt.image || (roof.colour && is_white(*roof.colour)))
    return 0;
  // Weights of a logistic regression (fit.py of tests/bench/imagery) on houses of Kampala and of synthetic images, and on
  // copies of them that were put where none stands (ghosts.py).
  const double sum = 3.39 + 4.27 * roof.green - 9.46 * receipt.after +
                     0.40 * std::min(4.5, (receipt.after - receipt.mean) / receipt.deviation) - 3.99 * receipt.mean -
                     3.76 * std::max(0.0, shadow_clearness) + 3.08 * std::min(0.6, roof.spread) -
                     (roof.form == RoofForm::pitched ? 0.96 : 0.0);
  return 1 / (1 + base::exp(-sum));
}

}  // namespace blockrand::observation
