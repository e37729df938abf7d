// Quoins (Eckquaderung), lesenes and pilasters: what marks the corners and the rhythm of a wall.
#include <algorithm>
#include <cmath>

#include "styles/elements/joinery.h"

namespace blockrand::elements {

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
    builder.box({left, k * step, -kApart}, {left + wide, (k + 1) * step - joint, out}, Part::surround);
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
  builder.box({-half, base > 0 ? base - kApart : 0, -kApart}, {half, r.height - (capital > 0 ? capital - kApart : 0), out},
              Part::surround);
  if (base > 0) {
    builder.box({-half - 0.06, 0, -kApart}, {half + 0.06, base * 0.6, out + 0.05}, Part::surround);
    builder.box({-half - 0.03, base * 0.6 - kApart, -kApart}, {half + 0.03, base, out + 0.025}, Part::surround);
  }
  if (capital > 0) {
    const double top = r.height;
    builder.box({-half - 0.02, top - capital, -kApart}, {half + 0.02, top - capital * 0.8, out + 0.02}, Part::surround);
    builder.box({-half - 0.01, top - capital * 0.8 - kApart, -kApart}, {half + 0.01, top - capital * 0.35, out + 0.01},
                Part::surround);
    builder.box({-half - 0.07, top - capital * 0.35 - kApart, -kApart}, {half + 0.07, top, out + 0.06}, Part::surround);
  }
  element.mesh = builder.take();
  return {};
}

}  // namespace blockrand::elements
