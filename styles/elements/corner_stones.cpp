// Quoins (Eckquaderung), lesenes and pilasters: what marks the corners and the rhythm of a wall.
#include <algorithm>
#include <cmath>

#include "styles/elements/joinery.h"

namespace blockrand::elements {
namespace {

/// m. Margin and relief of bosses (docs/style_measures.md 2.5: margin 4 cm).
constexpr double kMargin = 0.04, kBoss = 0.015;

}  // namespace

Made make_quoin(const Request& r, Element& element) {
  const Values& v = r.values;
  const double out = v.number("projection"), joint = v.number("joint"), half = r.width / 2;
  const int count = std::max(1, static_cast<int>(std::lround(r.height / v.number("stone_height"))));
  const double step = r.height / count;
  if (step < joint + 0.05) return no_room("stones between so wide joints");
  MeshBuilder builder;
  for (int k = 0; k < count; ++k) {
    const double wide = k % 2 == 0 ? r.width : r.width * v.number("short");
    // The straight edge is the corner of the house; stones in the middle of a wall are toothed on both sides.
    const double left = v.is("corner", "left") ? -half : v.is("corner", "right") ? half - wide : -wide / 2;
    const double top = (k + 1) * step - (v.detail() == 0 ? 0 : joint);
    builder.box({left, k * step, -kApart}, {left + wide, top, out}, Part::surround);
    // The boss of the stone, within its margin.
    if (v.detail() == 2 && wide > 3 * kMargin && top - k * step > 3 * kMargin)
      builder.box({left + kMargin, k * step + kMargin, out - kApart},
                  {left + wide - kMargin, top - kMargin, out + kBoss}, Part::surround);
  }
  element.mesh = builder.take();
  return {};
}

Made make_pilaster(const Request& r, Element& element) {
  const Values& v = r.values;
  const double out = v.number("projection"), half = r.width / 2;
  const bool plain = v.is("order", "lesene");
  const double base = plain ? 0 : v.number("base_height"), capital = plain ? 0 : v.number("capital_height");
  if (r.height < base + capital + 0.5) return no_room("a shaft between base and capital");
  MeshBuilder builder;
  builder.box({-half, base > 0 ? base - kApart : 0, -kApart},
              {half, r.height - (capital > 0 ? capital - kApart : 0), out}, Part::surround);
  if (base > 0) {
    const bool flat = v.detail() == 0;
    builder.box({-half - 0.06, 0, -kApart}, {half + 0.06, flat ? base : base * 0.6, out + 0.05}, Part::surround);
    if (!flat)
      builder.box({-half - 0.03, base * 0.6 - kApart, -kApart}, {half + 0.03, base, out + 0.025}, Part::surround);
  }
  if (capital > 0) {
    const double top = r.height;
    if (v.detail() > 0)
      builder.box({-half - 0.02, top - capital, -kApart}, {half + 0.02, top - capital * 0.8, out + 0.02},
                  Part::surround);
    const double neck = v.detail() > 0 ? top - capital * 0.8 - kApart : top - capital;
    builder.box({-half - 0.01, neck, -kApart}, {half + 0.01, top - capital * 0.35, out + 0.01}, Part::surround);
    builder.box({-half - 0.07, top - capital * 0.35 - kApart, -kApart}, {half + 0.07, top, out + 0.06}, Part::surround);
  }
  element.mesh = builder.take();
  return {};
}

}  // namespace blockrand::elements
