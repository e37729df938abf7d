// Heads of openings.
#include "styles/elements/opening_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"

namespace blockrand::elements {

using model::Point2;

namespace {

constexpr double kEquilateral = 0.8660254037844386;  // height of a triangle over its side: half the root of 3

}  // namespace

double head_rise(const OpeningShape& s) {
  switch (s.head) {
    case Head::straight:
      return 0;
    case Head::round:
      return s.width / 2;
    case Head::segmental:
    case Head::gabled:
      return s.width * s.rise;
    case Head::pointed:
      return s.width * kEquilateral;
    case Head::basket:
      return s.width / 3;
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
  } else if (s.head == Head::basket) {
    for (int k = 1, n = 2 * std::max(2, s.chords); k < n; ++k) {
      const auto turned = base::sin_cos(base::kPi * k / n);
      out.push_back(2 * k == n ? Point2{0, top}
                               : model::snap(Point2{half * turned.cos, spring + (top - spring) * turned.sin}));
    }
  } else if (s.head == Head::pointed) {
    const double rise = top - spring, radius = (half * half + rise * rise) / (2 * half);
    const double whole = base::atan2(rise, radius - half);  // from the springing to the point
    const int n = std::max(2, s.chords);
    const auto arc = [&](int k) {
      const auto turned = base::sin_cos(whole * k / n);
      return model::snap(Point2{half - radius + radius * turned.cos, spring + radius * turned.sin});
    };
    for (int k = 1; k < n; ++k) out.push_back(arc(k));
    out.push_back({0, top});
    for (int k = n - 1; k > 0; --k) out.push_back({-arc(k).x, arc(k).y});
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
