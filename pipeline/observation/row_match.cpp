#include "pipeline/observation/row_match.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "pipeline/model/vector.h"

namespace blockrand::observation {

namespace {

using model::Point2;

/// m: of the first search, and of the search around its best place.
constexpr double kStep = 0.25, kFineStep = 0.1;
constexpr int kFineHalf = 5;
/// Degrees between the turns that are tried first.
constexpr double kTurnStep = 1;
/// m: a peak so far from the best one is another place.
constexpr double kElsewhere = 1.25;
/// Of the walls by length: less is not enough to judge a row by.
constexpr double kMostMissing = 0.2;

/// A metre of the foot of a wall that the camera sees weighs so much beside a metre of the roof's edge: cars and bushes
/// stand before it.
constexpr double kFootWeight = 0.5;
/// m: with less of a lean the foot of a wall and the edge of its roof are one edge.
constexpr double kLeastLean = 0.8;
/// Cosine between a wall's normal and the way to the camera: others show no foot.
constexpr double kFacing = 0.3;
/// m: steps in which other heights of a building move its roof.
constexpr double kHeightStep = 0.25;
/// What a height costs that is off by its whole uncertainty, in scores.
constexpr double kHeightCost = 0.04;
/// m: farther no wrong height moves a roof.
constexpr double kMostByHeight = 3;
/// Where an outline stands as mapped, nearly any height may explain its roof: this multiple or part of the one said where
/// somebody counted or measured, and where nobody did, and m beside; what a height costs there.
constexpr double kTimesTagged = 1.35, kTimesGuessed = 2.5, kBeside = 1.5, kMappedCost = 0.001;
/// m: no eaves are lower.
constexpr double kLowest = 2;

/// Scores of one building: those of its roof's edge and of the feet of its walls.
struct OutlineScores {
  ScoreMap roof, foot;
  double weight() const { return roof.weight + kFootWeight * foot.weight; }
};

double length_of(Point2 v) { return std::sqrt(v.x * v.x + v.y * v.y); }

/// How far other heights may move a building's roof.
double height_reach(const SearchedOutline& o) {
  return std::min(kMostByHeight, length_of(o.per_metre) * o.height * o.uncertainty * 1.5);
}

/// The score of the roof with the outline as mapped and whatever height.
double as_mapped(const SearchedOutline& o, const ScoreMap& roof) {
  const double size = length_of(o.per_metre);
  if (size <= 0) return roof.at(0.0, 0.0);
  const double times = o.uncertainty > 0.3 ? kTimesGuessed : kTimesTagged, step = kHeightStep / size;
  double best = roof.at(0.0, 0.0);
  for (double h = std::max(kLowest, o.height / times - kBeside); h <= o.height * times + kBeside; h += step) {
    const double by = h - o.height, off = by / (o.height * o.uncertainty);
    best = std::max(best, roof.at(by * o.per_metre.x, by * o.per_metre.y) - kMappedCost * off * off);
  }
  return best;
}

/// A building, where its roof and the ground before it are searched in an image: made once for several turns.
class SearchedPlace {
 public:
  /// \param extra    m: how far beyond the displacements the roof is looked for
  /// \param by_turn  m: no wall moves farther by the turns that are tried
  SearchedPlace(const SearchedOutline& o, const ImageWindows& windows, const Displacements& grid, double extra,
                Point2 shift, Point2 lean, Point2 centre, double by_turn)
      : roof_(o, o.pieces, windows, {grid.step, grid.half + static_cast<int>(std::ceil(extra / grid.step))},
              {shift.x + lean.x, shift.y + lean.y}, centre, by_turn) {
    if (length_of({o.lean.x - o.ground.x, o.lean.y - o.ground.y}) <= kLeastLean) return;
    const double size = length_of(o.per_metre);
    std::vector<WallPiece> seen;
    for (const WallPiece& p : o.pieces)
      if (p.weight >= 1 && size > 0 && -(p.along.y * o.per_metre.x - p.along.x * o.per_metre.y) > kFacing * size)
        seen.push_back(p);
    if (!seen.empty())
      foot_.emplace(o, std::move(seen), windows, grid, Point2{shift.x + o.ground.x, shift.y + o.ground.y}, centre,
                    by_turn);
  }

  OutlineScores scores(base::SinCos angle, double contrast) const {
    OutlineScores scores;
    scores.roof = roof_.score(angle, contrast);
    if (foot_) scores.foot = foot_->score(angle, contrast);
    return scores;
  }

 private:
  struct Edges {
    Edges(const SearchedOutline& o, std::vector<WallPiece> walls, const ImageWindows& windows,
          const Displacements& wanted, Point2 by, Point2 about, double by_turn)
        : pieces(std::move(walls)), grid(wanted), centre(about + by), patch(window(o, windows, wanted, by, by_turn)) {
      for (WallPiece& piece : pieces) piece.middle.x += by.x, piece.middle.y += by.y;
    }
    static Patch window(const SearchedOutline& o, const ImageWindows& windows, const Displacements& grid, Point2 by,
                        double by_turn) {
      return windows.window({o.box.minimum + by, o.box.maximum + by}, score_margin(grid, windows.size()) + by_turn);
    }
    ScoreMap score(base::SinCos angle, double contrast) const {
      return score_outline(pieces, patch, grid, centre, angle, contrast);
    }
    std::vector<WallPiece> pieces;
    Displacements grid;
    Point2 centre;
    PatchSamples patch;
  };
  Edges roof_;
  std::optional<Edges> foot_;
};

template <class Visit>
void for_each(const Displacements& grid, Visit&& visit) {
  for (int j = -grid.half; j <= grid.half; ++j)
    for (int i = -grid.half; i <= grid.half; ++i)
      if (i * i + j * j <= grid.half * grid.half) visit(i, j);
}

struct Peak {
  int i = 0, j = 0;
  double score = 0;
};

Peak highest(const ScoreMap& map) {
  Peak best{0, 0, -1};
  for_each(map.grid, [&](int i, int j) {
    if (const double s = static_cast<double>(map.at(i, j)); s > best.score) best = {i, j, s};
  });
  return best;
}

/// The best local maximum away from `best`.
double second_peak(const ScoreMap& map, const Peak& best) {
  double second = 0;
  const double apart = kElsewhere / map.grid.step;
  for_each(map.grid, [&](int i, int j) {
    const double s = static_cast<double>(map.at(i, j));
    if (s <= second || (i - best.i) * (i - best.i) + (j - best.j) * (j - best.j) < apart * apart) return;
    for (int v = -1; v <= 1; ++v)
      for (int u = -1; u <= 1; ++u)
        if ((u != 0 || v != 0) && std::abs(i + u) <= map.grid.half && std::abs(j + v) <= map.grid.half &&
            static_cast<double>(map.at(i + u, j + v)) > s)
          return;
    second = s;
  });
  return second;
}

}  // namespace

/// The scores of a row for all displacements, each building with the height that suits it best.
class RowScores {
 public:
  RowScores(const SearchedRow& row, const ImageWindows& windows, const SearchBounds& bounds, double contrast)
      : map_(Displacements{kStep, static_cast<int>(std::lround(bounds.shift / kStep))}) {
    std::vector<double> total(map_.score.size(), 0.0);
    double weight = 0;
    for (const SearchedOutline& o : row.outlines) {
      const double reach = height_reach(o);
      const OutlineScores scores =
          SearchedPlace(o, windows, map_.grid, reach, {}, o.lean, row.centre, 0).scores({}, contrast);
      here_ +=
          scores.roof.weight * as_mapped(o, scores.roof) +
          (scores.foot.weight > 0 ? kFootWeight * scores.foot.weight * static_cast<double>(scores.foot.at(0, 0)) : 0);
      map_.weight += scores.roof.weight, map_.missing += scores.roof.missing;
      weight += scores.weight();
      std::size_t cell = 0;
      for (int j = -map_.grid.half; j <= map_.grid.half; ++j)
        for (int i = -map_.grid.half; i <= map_.grid.half; ++i, ++cell)
          total[cell] +=
              scores.roof.weight * best_height(o, scores.roof, i * kStep, j * kStep, reach).second +
              (scores.foot.weight > 0 ? kFootWeight * scores.foot.weight * static_cast<double>(scores.foot.at(i, j))
                                      : 0);
    }
    if (weight > 0) {
      here_ /= weight;
      for (std::size_t i = 0; i < total.size(); ++i) map_.score[i] = static_cast<float>(total[i] / weight);
    }
  }

  const ScoreMap& map() const { return map_; }
  /// With the outlines as mapped, and any height.
  double here() const { return here_; }

  /// m of height, and the score of the roof with it less what the height costs.
  static std::pair<double, double> best_height(const SearchedOutline& o, const ScoreMap& roof, double dx, double dy,
                                               double reach) {
    if (reach < kHeightStep) return {o.height, roof.at(dx, dy)};
    const double size = length_of(o.per_metre);
    const int steps = static_cast<int>(reach / kHeightStep);
    std::pair<double, double> best{o.height, -1};
    for (int k = -steps; k <= steps; ++k) {
      const double by = k * kHeightStep / size;  // m of height
      if (o.height + by < 2) continue;
      const double off = by / (o.height * o.uncertainty);
      const double score = roof.at(dx + by * o.per_metre.x, dy + by * o.per_metre.y) - kHeightCost * off * off;
      if (score > best.second) best = {o.height + by, score};
    }
    return best;
  }

 private:
  ScoreMap map_;
  double here_ = 0;
};

double height_doubt(const SearchedRow& row) {
  Point2 sum;
  double length = 0;
  for (const SearchedOutline& o : row.outlines) {
    double own = 0;
    for (const WallPiece& p : o.pieces) own += p.length;
    const double doubt = own * o.height * o.uncertainty;
    sum.x += doubt * o.per_metre.x, sum.y += doubt * o.per_metre.y;
    length += own;
  }
  return length > 0 ? length_of(sum) / length : 0;
}

RowMatch match_row(const SearchedRow& row, const ImageWindows& windows, const SearchBounds& bounds, double contrast) {
  RowMatch match;
  const RowScores scores(row, windows, bounds, contrast);
  const ScoreMap& map = scores.map();
  const Displacements wide = map.grid;
  match.weight = map.weight;
  match.height_doubt = height_doubt(row);
  if (map.weight <= 0 || map.missing > kMostMissing * (map.weight + map.missing)) return match;
  match.seen = true;
  double sum = 0, squares = 0, count = 0;
  for_each(wide, [&](int i, int j) {
    const double s = static_cast<double>(map.at(i, j));
    sum += s, squares += s * s, count += 1;
  });
  match.mean = sum / count;
  match.deviation = std::sqrt(std::max(0.0, squares / count - match.mean * match.mean));
  match.here = scores.here();
  const Peak coarse = highest(map);
  match.second = second_peak(map, coarse);

  // Around that place, with the heights that suit it: turns, and finer displacements.
  const Displacements fine{kFineStep, kFineHalf};
  const Point2 start{coarse.i * kStep, coarse.j * kStep};
  std::vector<Point2> leans;
  for (const SearchedOutline& o : row.outlines) {
    const double reach = height_reach(o);
    double height = o.height;
    if (reach >= kHeightStep) {
      const OutlineScores near =
          SearchedPlace(o, windows, Displacements{kStep, 0}, reach, start, o.lean, row.centre, 0).scores({}, contrast);
      height = RowScores::best_height(o, near.roof, 0, 0, reach).first;
    }
    match.heights.push_back(height);
    leans.push_back({o.lean.x + (height - o.height) * o.per_metre.x, o.lean.y + (height - o.height) * o.per_metre.y});
  }
  const double steepest =
      row.radius > 0 ? std::min(bounds.turn, bounds.at_end / row.radius * base::kDegreesPerRadian) : 0;
  // Of each building its part of the image is taken once for several turns, and not kept: rows may be long.
  match.best = -1;
  const auto try_turns = [&](std::span<const double> turns) {
    std::vector<base::SinCos> angles;
    double steepest_of = 0;
    for (const double turn : turns) {
      angles.push_back(base::sin_cos(turn * base::kRadiansPerDegree));
      steepest_of = std::max(steepest_of, std::fabs(angles.back().sin));
    }
    ScoreMap sum(fine);
    std::vector<std::vector<double>> totals(turns.size(), std::vector<double>(sum.score.size(), 0.0));
    std::vector<double> weights(turns.size(), 0.0);
    for (std::size_t n = 0; n < row.outlines.size(); ++n) {
      const SearchedPlace place(row.outlines[n], windows, fine, 0, start, leans[n], row.centre,
                                row.radius * steepest_of + 1);
      for (std::size_t k = 0; k < turns.size(); ++k) {
        const OutlineScores near = place.scores(angles[k], contrast);
        weights[k] += near.weight();
        for (std::size_t i = 0; i < sum.score.size(); ++i)
          totals[k][i] +=
              near.roof.weight * static_cast<double>(near.roof.score[i]) +
              (near.foot.weight > 0 ? kFootWeight * near.foot.weight * static_cast<double>(near.foot.score[i]) : 0);
      }
    }
    for (std::size_t k = 0; k < turns.size(); ++k) {
      for (std::size_t i = 0; i < sum.score.size(); ++i)
        sum.score[i] = weights[k] > 0 ? static_cast<float>(totals[k][i] / weights[k]) : 0.0F;
      const Peak peak = highest(sum);
      if (peak.score <= match.best) continue;
      match.best = peak.score;
      match.turn = turns[k];
      match.shift = {start.x + peak.i * kFineStep, start.y + peak.j * kFineStep};
    }
  };
  // Whole steps first, 0, -1, 1, -2 ..., then half a step to both sides of the best.
  std::vector<double> turns;
  for (int k = 0; k <= 2 * static_cast<int>(steepest / kTurnStep); ++k)
    turns.push_back((k % 2 == 0 ? k / 2 : -(k + 1) / 2) * kTurnStep);
  try_turns(turns);
  turns = {match.turn - kTurnStep / 2, match.turn + kTurnStep / 2};
  std::erase_if(turns, [&](double turn) { return std::fabs(turn) > steepest; });
  if (!turns.empty()) try_turns(turns);
  return match;
}

}  // namespace blockrand::observation
