// Heads of openings.
#include "styles/elements/opening_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"

namespace blockrand::elements {

using model::Point2;

double head_rise(const OpeningShape& s) {
  switch (s.head) {
    case Head::straight:
      return 0;
    case Head::round:
      return s.width / 2;
    case Head::segmental:
    case Head::gabled:
      return s.width * s.rise;
  }
  return 0;
}

tl::expected<Outline, std::string> outline_of(const OpeningShape& s) {
  const double half = model::snap(s.width / 2), top = model::snap(s.height), spring = model::snap(springing(s));
  if (spring < kLeastJamb)
    return tl::unexpected(fmt::format(
        "the head is {:.2f} m high and leaves no straight jamb below it: the opening wants at least {:.2f} m",
        head_rise(s), head_rise(s) + kLeastJamb));
  Outline out{{-half, 0}, {half, 0}, {half, spring}};
  if (s.head == Head::gabled) {
    out.push_back({0, top});
  } else if (s.head != Head::straight) {
    const double rise = top - spring;
    const double radius = (half * half + rise * rise) / (2 * rise), middle = top - radius;
    const int chords = std::max(2, s.head == Head::round ? 2 * s.chords : s.chords);
    const double from = base::atan2(half, spring - middle);  // from upright
    for (int k = 1; k < chords; ++k) {
      const auto turned = base::sin_cos(from * (1 - 2.0 * k / chords));
      const Point2 p = model::snap(Point2{radius * turned.sin, middle + radius * turned.cos});
      out.push_back(2 * k == chords ? Point2{0, top} : p);
    }
  }
  out.push_back({-half, spring});
  return out;
}

}  // namespace blockrand::elements
