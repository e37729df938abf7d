#include "pipeline/observation/courtyard_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/observation/mapped_ground.h"
#include "pipeline/observation/outline_score.h"

namespace blockrand::observation {

namespace {

using model::Point2;
using model::Polygon;

/// m: so far from the hole's ring neither its ground nor the roof is looked at: gutters, walls, errors of the map; how far the
/// roof around is looked at.
constexpr double kEdge = 0.7, kRoofAround = 5;
/// Of a hole: it must be seen, and no other building may stand on more of it.
constexpr double kMostlyFree = 0.6;
constexpr std::size_t kFewest = 60;
/// Levels of a cell of the histograms.
constexpr int kCell = 24, kCells = 256 / kCell + 1;
/// m: displacements at which the ring's edge is looked for.
constexpr double kStep = 0.25;
constexpr int kHalf = 6;
/// Levels of 255, as score_outline() has it.
constexpr double kContrast = 12;
constexpr double kDark = 25;

struct Colours {
  std::vector<double> brightness;
  std::vector<std::uint32_t> histogram = std::vector<std::uint32_t>(kCells * kCells * kCells, 0);
  std::size_t leaves = 0;
  void add(const Patch& p, std::size_t i) {
    const int red = p.red[i], green = p.green[i], blue = p.blue[i];
    brightness.push_back((2.0 * red + 5.0 * green + blue) / 8);
    ++histogram[static_cast<std::size_t>((red / kCell * kCells + green / kCell) * kCells + blue / kCell)];
    // As roof_view.cpp has it.
    leaves += 2 * green - red - blue > 0.05 * (red + green + blue) && green > 1.1 * blue && green >= red;
  }
  /// \param share  of its pixels that are darker
  double quantile(double share) {
    const auto at =
        brightness.begin() + std::min(static_cast<std::ptrdiff_t>(share * static_cast<double>(brightness.size())),
                                      static_cast<std::ptrdiff_t>(brightness.size()) - 1);
    std::nth_element(brightness.begin(), at, brightness.end());
    return *at;
  }
};

/// Bhattacharyya, "On a measure of divergence between two statistical populations" (1943).
double alike(const Colours& a, const Colours& b) {
  double sum = 0;
  const double n = static_cast<double>(a.brightness.size()) * static_cast<double>(b.brightness.size());
  for (std::size_t i = 0; i < a.histogram.size(); ++i)
    if (a.histogram[i] > 0 && b.histogram[i] > 0)
      sum += std::sqrt(static_cast<double>(a.histogram[i]) * static_cast<double>(b.histogram[i]) / n);
  return sum;
}

void fill(const Patch& patch, std::span<const Polygon> polygons, std::vector<std::uint8_t>& filled) {
  for (const Polygon& polygon : polygons) {
    std::vector<std::span<const Point2>> rings{polygon.outer.points};
    for (const model::Ring& hole : polygon.holes) rings.emplace_back(hole.points);
    fill_rings(patch, rings, {}, filled);
  }
}

double to_ring(std::span<const Point2> ring, Point2 p) {
  double least = 1e300;
  for (std::size_t i = 0; i < ring.size(); ++i)
    least = std::min(least, geometry::distance_to_segment(p, ring[i], ring[(i + 1) % ring.size()]));
  return least;
}

std::optional<CourtyardView> look(std::span<const Point2> hole, std::span<const Polygon> plan,
                                  std::span<const Polygon> others, const ImageWindows& windows) {
  CourtyardView view;
  view.area = std::round(10 * std::fabs(geometry::signed_area(hole))) / 10;
  const Patch patch = windows.window(geometry::box_of(hole), kRoofAround + 1);
  std::vector<std::uint8_t> within(patch.valid.size(), 0), roof = within, other = within;
  const std::array<std::span<const Point2>, 1> rings{hole};
  fill_rings(patch, rings, {}, within);
  fill(patch, plan, roof);
  fill(patch, others, other);
  Colours inside, around;
  std::size_t all = 0, free = 0;
  for (int r = 0; r < patch.height; ++r)
    for (int c = 0; c < patch.width; ++c) {
      const auto i = static_cast<std::size_t>(r) * static_cast<std::size_t>(patch.width) + static_cast<std::size_t>(c);
      if (!within[i] && !roof[i]) continue;
      const double distance =
          to_ring(hole, {patch.west + (c + 0.5) * patch.size, patch.north - (r + 0.5) * patch.size});
      if (distance < kEdge || (!within[i] && distance > kRoofAround)) continue;
      all += within[i];
      if (!patch.valid[i] || other[i]) continue;
      free += within[i];
      (within[i] ? inside : around).add(patch, i);
    }
  if (free < kFewest || around.brightness.size() < kFewest ||
      static_cast<double>(free) < kMostlyFree * static_cast<double>(all))
    return std::nullopt;
  std::vector<WallPiece> pieces;
  const std::vector<double> weights(hole.size(), 1.0);
  add_pieces(hole, weights, pieces);
  const ScoreMap map = score_outline(pieces, patch, {kStep, kHalf}, geometry::box_of(hole).centre(), {}, kContrast);
  if (map.weight <= 0) return std::nullopt;
  CourtyardEvidence& e = view.evidence;
  double sum = 0;
  int count = 0;
  for (int j = -kHalf; j <= kHalf; ++j)
    for (int i = -kHalf; i <= kHalf; ++i) {
      if (i * i + j * j > kHalf * kHalf) continue;
      const auto score = static_cast<double>(map.at(i, j));
      sum += score, ++count;
      if (i * i + j * j <= 4) e.edge = std::max(e.edge, score);
    }
  e.around = sum / count;
  const double light = around.quantile(0.8), twentieth = around.quantile(0.05);
  e.alike = alike(inside, around);
  e.level = std::fabs(inside.quantile(0.8) - light) / (light + kDark);
  const auto n = static_cast<double>(inside.brightness.size());
  e.dark = static_cast<double>(std::ranges::count_if(inside.brightness, [&](double b) { return b < twentieth; })) / n;
  e.green = static_cast<double>(inside.leaves) / n;
  view.built_over = std::round(100 * built_over_probability(e)) / 100;
  if (view.built_over >= kSureBuiltOver) view.state = CourtyardState::built_over;
  if (1 - view.built_over >= kSureOpen) view.state = CourtyardState::open;
  return view;
}

}  // namespace

double built_over_probability(const CourtyardEvidence& e) {
  // Weights of a logistic regression (fit.py of tests/bench/imagery) on holes that holes.py cut into roofs of synthetic
  // images and on real courtyards, as many of each.
  const double sum = -2.42 + 6.86 * e.alike - 3.86 * std::min(1.0, e.level) - 6.36 * e.dark - 1.92 * e.green -
                     1.86 * (e.edge - e.around);
  return 1 / (1 + base::exp(-sum));
}

std::vector<CourtyardView> look_at_courtyards(std::span<const Polygon> plan, std::span<const Polygon> others,
                                              const ImageWindows& windows) {
  std::vector<CourtyardView> out;
  for (const Polygon& polygon : plan)
    for (const model::Ring& hole : polygon.holes) {
      if (std::fabs(geometry::signed_area(hole.points)) < kLeastCourtyard) continue;
      if (const std::optional<CourtyardView> view = look(hole.points, plan, others, windows)) out.push_back(*view);
    }
  return out;
}

}  // namespace blockrand::observation
