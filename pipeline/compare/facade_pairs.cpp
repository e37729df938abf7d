// Which facades of two models stand for each other, and which of their openings.
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "pipeline/base/portable_math.h"
#include "pipeline/compare/facade_agreement.h"
#include "pipeline/model/vector.h"

namespace blockrand::compare {
namespace {

long long rounded(double v) { return std::llround(v * 1e6); }

Point2 along(const Facade& f) {
  const double width = f.width();
  return {(f.right.x - f.left.x) / width, (f.right.y - f.left.y) / width};
}

/// The direction half way between two facades: both are seen alike in it, so that exchanging them changes nothing.
struct View {
  Point2 along;
  double cosine = 1;  ///< by which both are foreshortened

  View(const Facade& a, const Facade& b) {
    const Point2 u = compare::along(a), v = compare::along(b);
    const Point2 sum{u.x + v.x, u.y + v.y};
    const double length = std::sqrt(dot(sum, sum));
    along = {sum.x / length, sum.y / length};
    cosine = dot(along, u);
  }
  double place(const Facade& f, double x) const { return dot(along, f.left) + x * cosine; }
};

struct Candidate {
  std::size_t model = 0, reference = 0;
  double score = 0;
};

/// How two facades lie that look the same way.
struct Lie {
  double both = 0, width_a = 0, width_b = 0;  // m along: in common, and of each
  double distance = 0;                        // m across, in the middle of what they have in common
};
std::optional<Lie> lie_of(const Facade& a, const Facade& b, const FacadeOptions& options) {
  if (!(a.width() > 0) || !(b.width() > 0)) return std::nullopt;
  if (dot(along(a), along(b)) < base::cos(options.pair_angle)) return std::nullopt;
  const View view(a, b);
  const double left_a = view.place(a, 0), right_a = view.place(a, a.width());
  const double left_b = view.place(b, 0), right_b = view.place(b, b.width());
  const double left = std::max(left_a, left_b), right = std::min(right_a, right_b);
  const Point2 outwards{view.along.y, -view.along.x};
  const auto depth = [&](const Facade& f) {
    const double at = (0.5 * (left + right) - view.place(f, 0)) / view.cosine;
    const Point2 u = along(f);
    return dot(outwards, {f.left.x + at * u.x, f.left.y + at * u.y});
  };
  return Lie{right - left, right_a - left_a, right_b - left_b, std::fabs(depth(a) - depth(b))};
}

/// How much of both facades is one, in [0, 1]: overlap over union of their rectangles, less for those that lie apart.
/// Nothing for facades that cannot stand for each other.
double score_of(const Facade& a, const Facade& b, const FacadeOptions& options) {
  const auto lie = lie_of(a, b, options);
  if (!lie || lie->distance > options.pair_distance + 1e-9) return 0;
  const double height = std::min(a.top, b.top) - std::max(a.bottom, b.bottom);
  if (lie->both < options.pair_overlap * std::min(lie->width_a, lie->width_b) - 1e-9) return 0;
  if (height < options.pair_overlap * std::min(a.top - a.bottom, b.top - b.bottom) - 1e-9) return 0;
  const double both = lie->both * height;
  const double together = lie->width_a * (a.top - a.bottom) + lie->width_b * (b.top - b.bottom) - both;
  return both / together * (1 - 0.5 * lie->distance / options.pair_distance);
}

/// A key that is the same when the two facades are exchanged.
auto place_of(const Facade& a, const Facade& b) {
  const auto key = [](const Facade& f) {
    return std::tuple(rounded(f.left.x), rounded(f.left.y), rounded(f.bottom), rounded(f.right.x), rounded(f.right.y),
                      rounded(f.top));
  };
  return std::pair(std::min(key(a), key(b)), std::max(key(a), key(b)));
}

struct Rectangle {
  double left, right, bottom, top;
  double area() const { return (right - left) * (top - bottom); }
  auto key() const { return std::tuple(rounded(left), rounded(bottom), rounded(right), rounded(top)); }
};

double iou(const Rectangle& a, const Rectangle& b) {
  const double width = std::min(a.right, b.right) - std::max(a.left, b.left);
  const double height = std::min(a.top, b.top) - std::max(a.bottom, b.bottom);
  if (width <= 0 || height <= 0) return 0;
  return width * height / (a.area() + b.area() - width * height);
}

std::vector<std::pair<std::size_t, std::size_t>> match_openings(const Facade& model, const Facade& reference,
                                                                const FacadeOptions& options) {
  const View view(model, reference);
  const auto rectangles = [&](const Facade& f) {
    std::vector<Rectangle> out;
    for (const FacadeOpening& o : f.openings)
      out.push_back({view.place(f, o.left), view.place(f, o.right), o.bottom, o.top});
    return out;
  };
  const std::vector<Rectangle> a = rectangles(model), b = rectangles(reference);
  std::vector<std::tuple<double, std::size_t, std::size_t>> found;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < b.size(); ++k) {
      const double both = iou(a[i], b[k]);
      if (both >= options.match_iou - 1e-9) found.emplace_back(both, i, k);
    }
  }
  std::sort(found.begin(), found.end(), [&](const auto& x, const auto& y) {
    const auto key = [&](const auto& candidate) {
      const auto& [both, i, k] = candidate;
      return std::tuple(-rounded(both), std::min(a[i].key(), b[k].key()), std::max(a[i].key(), b[k].key()), i, k);
    };
    return key(x) < key(y);
  });
  std::vector<bool> taken_a(a.size(), false), taken_b(b.size(), false);
  std::vector<std::pair<std::size_t, std::size_t>> matches;
  for (const auto& [both, i, k] : found) {
    if (taken_a[i] || taken_b[k]) continue;
    taken_a[i] = taken_b[k] = true;
    matches.emplace_back(i, k);
  }
  std::sort(matches.begin(), matches.end());
  return matches;
}

}  // namespace

std::vector<FacadePair> pair_facades(std::span<const Facade> model, std::span<const Facade> reference,
                                     const FacadeOptions& options) {
  std::vector<Candidate> candidates;
  for (std::size_t m = 0; m < model.size(); ++m)
    for (std::size_t r = 0; r < reference.size(); ++r)
      if (const double score = score_of(model[m], reference[r], options); score > 0)
        candidates.push_back({m, r, score});
  std::sort(candidates.begin(), candidates.end(), [&](const Candidate& a, const Candidate& b) {
    const auto key = [&](const Candidate& c) {
      return std::tuple(-rounded(c.score), place_of(model[c.model], reference[c.reference]), c.model, c.reference);
    };
    return key(a) < key(b);
  });
  std::vector<std::size_t> of_model(model.size(), FacadePair::kNone), of_reference(reference.size(), FacadePair::kNone);
  for (const Candidate& c : candidates) {
    if (of_model[c.model] != FacadePair::kNone || of_reference[c.reference] != FacadePair::kNone) continue;
    of_model[c.model] = c.reference;
    of_reference[c.reference] = c.model;
  }
  const auto by_area = [](std::span<const Facade> facades, const std::vector<std::size_t>& partners, bool with) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < facades.size(); ++i)
      if ((partners[i] != FacadePair::kNone) == with) out.push_back(i);
    std::sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(-rounded(facades[a].area), a) < std::pair(-rounded(facades[b].area), b);
    });
    return out;
  };
  std::vector<FacadePair> pairs;
  for (const std::size_t r : by_area(reference, of_reference, true))
    pairs.push_back(
        {of_reference[r], r, match_openings(model[of_reference[r]], reference[r], options), reference[r].left_out()});
  for (const std::size_t r : by_area(reference, of_reference, false))
    pairs.push_back({FacadePair::kNone, r, {}, reference[r].left_out()});
  for (const std::size_t m : by_area(model, of_model, false))
    pairs.push_back({m, FacadePair::kNone, {}, model[m].is_covered() && model[m].openings.empty()});
  return pairs;
}

FacadeComparison compare_facades(const City& model, std::span<const std::uint32_t> model_buildings, double model_zero,
                                 const City& reference, std::span<const std::uint32_t> reference_buildings,
                                 double reference_zero, const FacadeOptions& options) {
  FacadeComparison out;
  out.model = facades_of(model, model_buildings, model_zero, options, &out.model_loose);
  out.reference = facades_of(reference, reference_buildings, reference_zero, options, &out.reference_loose);
  out.pairs = pair_facades(out.model, out.reference, options);
  return out;
}

}  // namespace blockrand::compare
