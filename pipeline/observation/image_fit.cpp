#include "pipeline/observation/image_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/base/parallel.h"

namespace blockrand::observation {

namespace {

/// m between displacements.
constexpr double kStep = 0.5;
/// m: how far an outline's own error may lead away from the image's. With little of it repeating estates stand out of
/// themselves; with much of it maps that are drawn badly fit.
constexpr std::array<double, 3> kOwnErrors{0.5, 1, 2};
constexpr double kOwnError = kOwnErrors.back();
/// m: about the best place.
constexpr double kHill = 4;
/// m: an image whose best shift is larger does not fit.
constexpr double kLargestShift = 4.5;
/// m: from here on a displacement belongs to another place.
constexpr double kElsewhere = 9;
/// Outlines that must be seen before anything is said.
constexpr std::uint64_t kFewest = 5;
/// Student's t of the best place against the best one elsewhere. Wrong images of tests/bench/imagery reach 1.3, right ones 1.9.
constexpr double kSureMargin = 1.6;
/// Levels of 255, as score_outline() has it.
constexpr double kContrast = 12;
/// Of an outline's walls: more of them beyond the image's edge make its scores uneven.
constexpr double kMostMissing = 0.6;

/// Variance of an outline's scores over all displacements: with less of it the image is blank there.
constexpr double kBlank = 1e-8;

/// The largest value within `radius` cells of each.
void spread(std::vector<float>& values, int side, int radius) {
  std::vector<float> rows(values.size());
  const auto at = [side](int i, int j) {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(side) + static_cast<std::size_t>(i);
  };
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      float most = -1e9F;
      for (int k = std::max(0, i - radius); k <= std::min(side - 1, i + radius); ++k)
        most = std::max(most, values[at(k, j)]);
      rows[at(i, j)] = most;
    }
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      float most = -1e9F;
      for (int k = std::max(0, j - radius); k <= std::min(side - 1, j + radius); ++k)
        most = std::max(most, rows[at(i, k)]);
      values[at(i, j)] = most;
    }
}

bool seen(const ScoreMap& map) { return map.weight > 0 && map.missing <= kMostMissing * map.weight; }

/// What the scores of all outlines say together, each outline free to be off by `radius` cells.
struct Evidence {
  Evidence(const Displacements& grid, int cells) : grid_(grid), radius(cells), sum_(ScoreMap(grid).score.size(), 0.0) {}

  void add(std::vector<float> scores) {
    spread(scores, grid_.side(), radius);
    for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += static_cast<double>(scores[i]);
  }

  /// The best displacement, how far it stands out of those elsewhere, and how surely of the best of them.
  void conclude(ImageFit& fit, std::span<const ScoreMap> maps) const {
    // The rim of the disc has neighbours on one side alone.
    const double reach = kFitReach - kOwnError;
    double best = -1e9, total = 0, squares = 0, count = 0, next = -1e9;
    int best_i = 0, best_j = 0, next_i = 0, next_j = 0;
    for_each(reach, [&](int i, int j) {
      if (at(i, j) > best) best = at(i, j), best_i = i, best_j = j;
    });
    for_each(reach, [&](int i, int j) {
      if (inside(i - best_i, j - best_j, kElsewhere)) return;
      const double s = at(i, j);
      total += s, squares += s * s, count += 1;
      if (s > next) next = s, next_i = i, next_j = j;
    });
    const double mean = total / count, deviation = std::sqrt(std::max(1e-12, squares / count - mean * mean));
    // The middle of the hill: spreading leaves a plateau.
    double x = 0, y = 0, weight = 0;
    for_each(reach, [&](int i, int j) {
      if (!inside(i - best_i, j - best_j, kHill)) return;
      const double w = std::max(0.0, at(i, j) - (best + mean) / 2);
      x += w * i, y += w * j, weight += w;
    });
    fit.shift = weight > 0 ? model::Point2{x / weight * kStep, y / weight * kStep}
                           : model::Point2{best_i * kStep, best_j * kStep};
    fit.score = (best - mean) / deviation;
    // Student's t of the differences, outline by outline: an estate that repeats itself is as good nearly everywhere else,
    // but each of its odd houses knows better.
    double differences = 0, their_squares = 0, outlines = 0;
    for (const ScoreMap& map : maps) {
      if (!seen(map)) continue;
      const double d = around(map, best_i, best_j) - around(map, next_i, next_j);
      differences += d, their_squares += d * d, outlines += 1;
    }
    const double mean_difference = differences / outlines;
    fit.margin =
        mean_difference /
        std::sqrt(std::max(1e-12, (their_squares / outlines - mean_difference * mean_difference) / (outlines - 1)));
  }

 private:
  double around(const ScoreMap& map, int i, int j) const {
    double most = -1e9;
    for (int v = std::max(j - radius, -grid_.half); v <= std::min(j + radius, grid_.half); ++v)
      for (int u = std::max(i - radius, -grid_.half); u <= std::min(i + radius, grid_.half); ++u)
        most = std::max(most, static_cast<double>(map.at(u, v)));
    return most;
  }
  static bool inside(int i, int j, double reach) { return (i * i + j * j) * kStep * kStep <= reach * reach; }
  template <class Visit>
  void for_each(double reach, Visit&& visit) const {
    for (int j = -grid_.half; j <= grid_.half; ++j)
      for (int i = -grid_.half; i <= grid_.half; ++i)
        if (inside(i, j, reach)) visit(i, j);
  }
  double at(int i, int j) const {
    return sum_[static_cast<std::size_t>(j + grid_.half) * static_cast<std::size_t>(grid_.side()) +
                static_cast<std::size_t>(i + grid_.half)];
  }
  Displacements grid_;

 public:
  int radius;

 private:
  std::vector<double> sum_;
};

double length_of(model::Point2 v) { return std::sqrt(v.x * v.x + v.y * v.y); }

/// Where a parabola through three values at -1, 0, 1 is highest, [-0.5, 0.5]; the middle one is the largest.
double parabola_top(double before, double here, double after) {
  const double bend = 2 * here - before - after;
  return bend > 0 ? std::clamp((after - before) / 2 / bend, -0.5, 0.5) : 0;
}

/// The displacement near `about` where the outlines' scores, none of them free to be off, are highest in sum: finer than what
/// their spread scores say.
model::Point2 sharpest(std::span<const ScoreMap> maps, const Displacements& grid, model::Point2 about) {
  const int half = static_cast<int>(std::lround(kOwnError / kStep)), side = 2 * half + 3;
  const int i0 = static_cast<int>(std::lround(about.x / kStep)), j0 = static_cast<int>(std::lround(about.y / kStep));
  std::vector<double> sum(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0.0);
  const auto at = [&](int i, int j) -> double& {
    return sum[static_cast<std::size_t>(j + half + 1) * static_cast<std::size_t>(side) +
               static_cast<std::size_t>(i + half + 1)];
  };
  for (const ScoreMap& map : maps) {
    if (!seen(map)) continue;
    for (int j = -half - 1; j <= half + 1; ++j)
      for (int i = -half - 1; i <= half + 1; ++i)
        if (std::max(std::abs(i0 + i), std::abs(j0 + j)) <= grid.half)
          at(i, j) += static_cast<double>(map.at(i0 + i, j0 + j));
  }
  int best_i = 0, best_j = 0;
  for (int j = -half; j <= half; ++j)
    for (int i = -half; i <= half; ++i)
      if (at(i, j) > at(best_i, best_j)) best_i = i, best_j = j;
  const double here = at(best_i, best_j);
  return {(i0 + best_i + parabola_top(at(best_i - 1, best_j), here, at(best_i + 1, best_j))) * kStep,
          (j0 + best_j + parabola_top(at(best_i, best_j - 1), here, at(best_i, best_j + 1))) * kStep};
}

}  // namespace

ImageFit fit_image(std::span<const SearchedOutline> outlines, const ImageWindows& windows, int workers) {
  const Displacements grid{kStep, static_cast<int>(std::lround(kFitReach / kStep))};
  std::vector<ScoreMap> maps(outlines.size());
  std::vector<Evidence> evidence;
  for (const double error : kOwnErrors) evidence.emplace_back(grid, static_cast<int>(std::lround(error / kStep)));
  ImageFit fit;
  base::ordered_parallel(
      outlines.size(), workers, static_cast<std::size_t>(workers) * 4,
      [&](std::size_t n) {
        const SearchedOutline& o = outlines[n];
        const Patch patch = windows.window(o.box, score_margin(grid, windows.size()));
        maps[n] = score_outline(o.pieces, patch, grid, o.box.centre(), {}, kContrast);
        if (!seen(maps[n])) return;
        // In deviations of its own: a house among much else says as much as one on a lawn.
        double total = 0, squares = 0, count = 0;
        for (int j = -grid.half; j <= grid.half; ++j)
          for (int i = -grid.half; i <= grid.half; ++i)
            if (i * i + j * j <= grid.half * grid.half) {
              const double s = static_cast<double>(maps[n].at(i, j));
              total += s, squares += s * s, count += 1;
            }
        const double mean = total / count, variance = squares / count - mean * mean;
        if (variance < kBlank) {  // nothing is to be seen there
          maps[n].weight = 0;
          return;
        }
        const double deviation = std::sqrt(variance);
        for (float& s : maps[n].score) s = static_cast<float>((static_cast<double>(s) - mean) / deviation);
      },
      [&](std::size_t n) {
        if (seen(maps[n])) {
          ++fit.outlines;
          for (Evidence& e : evidence) e.add(maps[n].score);
        }
      });
  if (fit.outlines < kFewest) {
    fit.why = fmt::format("it shows edges around {} outlines; {} are needed to judge its place", fit.outlines, kFewest);
    return fit;
  }
  // Of all errors that outlines may have, those with which the best place stands out most.
  fit.margin = -1;
  for (const Evidence& e : evidence) {
    ImageFit one = fit;
    e.conclude(one, maps);
    if (one.margin > fit.margin) fit = one;
  }
  fit.shift = sharpest(maps, grid, fit.shift);
  const double off = length_of(fit.shift);
  fit.state = off <= kLargestShift && fit.margin >= kSureMargin ? ImageState::used : ImageState::misfit;
  fit.why = fmt::format(
      "best shift {:.1f} m with {} outlines: {:.1f} deviations above other places, t of {:.1f} against the next", off,
      fit.outlines, fit.score, fit.margin);
  return fit;
}

}  // namespace blockrand::observation
