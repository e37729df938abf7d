#include "pipeline/observation/lean.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

#include "pipeline/base/parallel.h"
#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/box_index.h"

namespace blockrand::observation {

namespace {

using model::Point2;

/// m between nodes, and how far their outlines lie at most.
constexpr double kNodeGrid = 100, kNodeReach = 150;
/// Lean in m per m of height that is looked for, and the step between cells of votes. 0.45 is the edge of a wide-angle
/// picture.
constexpr double kMostLean = 0.45, kLeanStep = 0.015;
/// m: a shift without lean.
constexpr double kMostShift = 3, kShiftStep = 0.1;
/// m: how well an outline's place is known.
constexpr double kPlaceError = 0.5;
/// Heights that a building may have instead of the one said, as its multiple, and how likely each is.
using Heights = std::array<std::pair<double, double>, 5>;
constexpr Heights kTaggedHeights{{{0.85, 0.15}, {0.93, 0.2}, {1, 0.3}, {1.08, 0.2}, {1.17, 0.15}}};
constexpr Heights kGuessedHeights{{{0.6, 0.15}, {0.8, 0.22}, {1, 0.26}, {1.25, 0.22}, {1.6, 0.15}}};
/// Outlines that a node must have.
constexpr std::size_t kFewest = 8;
/// Rounds in which every row is turned by an angle of its own, so that what agrees does so by chance.
constexpr int kChances = 5;
/// Deviations by which a node's votes must stand out of those by chance, and by how much of all votes out of those for no
/// lean at all.
constexpr double kSureDeviations = 2.5, kLeastGain = 0.05;
/// Of all votes: with fewer for a shift of all roofs it is the map's rows that are off.
constexpr double kLeastShiftSupport = 0.3;
/// Of an image's outlines: fewer in nodes that agree are chance.
constexpr double kLeastShare = 0.15;
/// Leans, and shifts in m, that are one; the rounds in which neighbours tell each other; what a neighbour that agrees adds
/// to the support, as its share; of the threshold, what is enough with such neighbours.
constexpr double kSameLean = 0.04, kSameShift = 0.4;
constexpr int kRounds = 4;
constexpr double kFriend = 0.2, kEnoughWithFriends = 0.6;
/// Nodes that are worked on at a time, at most.
constexpr std::size_t kInFlight = 64;
/// Nodes that decide on the image's shift, at most and at least: within a few streets chance makes any shift please; m: shifts that are looked for, and the step between them.
constexpr std::size_t kShiftNodes = 12, kFewestShiftNodes = 8;
constexpr double kFarthestShift = 3, kShiftsApart = 1;
/// Lean in m per m of height: cells of votes, of which the support alone counts.
constexpr double kCoarseLeanStep = 0.03;
/// The support with a shift must be more than that without any by this share, divided by the root of the number of rows: a few
/// rows that the map has elsewhere look like a shifted image. On synthetic images rows that were moved reach 1.1, images that
/// were moved 1.4 where there are 90 rows and more (docs/internal/RESULTS.md, "Aerial images").
constexpr double kClearShift = 1.3;
/// Where the image is shifted its roofs lean as well if that explains so much more than the shift alone.
constexpr double kLeansToo = 1.02;
/// Nodes that decide on the flight's height.
constexpr std::size_t kCurvatureNodes = 40;
/// 1/m: flights of 500 m and more, in steps in which 150 m and 12 m of height make 0.2 m.
constexpr double kCurvatureStep = 0.0001;
constexpr int kCurvatureSteps = 20, kCoarseCurvature = 4;  ///< each fourth first, then those beside the best of them

/// Cells of a line of votes, at most.
constexpr int kMostSide = 2 * 30 + 1;
static_assert(kMostLean / kLeanStep < 30.5 && kMostShift / kShiftStep < 30.5);

/// Votes for a vector.
class Votes {
 public:
  Votes(double most, double step)
      : step_(step),
        half_(static_cast<int>(std::lround(most / step))),
        cells_(static_cast<std::size_t>(side()) * static_cast<std::size_t>(side()), 0.0F) {
    assert(side() <= kMostSide);
  }

  void clear() { std::fill(cells_.begin(), cells_.end(), 0.0F), total_ = 0; }

  /// A bell (quadratic, so that no exponential is needed) of radius 2 * sigma.
  void add(Point2 at, double sigma, double weight) {
    total_ += weight;
    const double radius = 2 * sigma / step_, x = at.x / step_ + half_, y = at.y / step_ + half_;
    const int i0 = std::max(0, static_cast<int>(std::ceil(x - radius))),
              i1 = std::min(side() - 1, static_cast<int>(std::floor(x + radius)));
    const int j0 = std::max(0, static_cast<int>(std::ceil(y - radius))),
              j1 = std::min(side() - 1, static_cast<int>(std::floor(y + radius)));
    if (i0 > i1 || radius <= 0) return;
    // No branch within a line, and no square: the compiler works on several cells at a time.
    const auto count = static_cast<std::size_t>(i1 - i0 + 1);
    float across[kMostSide];
    const double inverse = 1 / (radius * radius);
    for (std::size_t i = 0; i < count; ++i) {
      const double d = i0 + static_cast<double>(i) - x;
      across[i] = static_cast<float>(1 - d * d * inverse);
    }
    const auto height = static_cast<float>(weight);
    for (int j = j0; j <= j1; ++j) {
      const auto down = static_cast<float>((j - y) * (j - y) * inverse);
      float* const line =
          cells_.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(side()) + static_cast<std::size_t>(i0);
      for (std::size_t i = 0; i < count; ++i) {
        const float rest = std::max(0.0F, across[i] - down);
        line[i] += height * rest * rest;
      }
    }
  }

  struct Winner {
    Point2 at;
    double support = 0, at_zero = 0;  ///< of the total
  };
  Winner winner() const { return winner_near({}, 2 * half_ * step_); }

  /// The best within a square about a place.
  Winner winner_near(Point2 place, double radius) const {
    const auto side = static_cast<std::size_t>(this->side());
    const auto range = [&](double v) {
      return std::pair(std::clamp(static_cast<int>(std::ceil((v - radius) / step_)) + half_, 0, this->side() - 1),
                       std::clamp(static_cast<int>(std::floor((v + radius) / step_)) + half_, 0, this->side() - 1));
    };
    const auto [i0, i1] = range(place.x);
    const auto [j0, j1] = range(place.y);
    std::size_t best = static_cast<std::size_t>(j0) * side + static_cast<std::size_t>(i0);
    for (int j = j0; j <= j1; ++j)
      for (int i = i0; i <= i1; ++i)
        if (const std::size_t c = static_cast<std::size_t>(j) * side + static_cast<std::size_t>(i);
            cells_[c] > cells_[best])
          best = c;
    const int bi = static_cast<int>(best % side), bj = static_cast<int>(best / side);
    double x = 0, y = 0, weight = 0;
    for (int j = std::max(0, bj - 1); j <= std::min(this->side() - 1, bj + 1); ++j)
      for (int i = std::max(0, bi - 1); i <= std::min(this->side() - 1, bi + 1); ++i) {
        const double w = std::max(
            0.0, static_cast<double>(cells_[static_cast<std::size_t>(j) * side + static_cast<std::size_t>(i)]) -
                     0.8 * static_cast<double>(cells_[best]));
        x += w * (i - half_), y += w * (j - half_), weight += w;
      }
    Winner won;
    if (total_ <= 0 || weight <= 0) return won;
    won.at = {x / weight * step_, y / weight * step_};
    won.support = static_cast<double>(cells_[best]) / total_;
    won.at_zero =
        static_cast<double>(cells_[static_cast<std::size_t>(half_) * side + static_cast<std::size_t>(half_)]) / total_;
    return won;
  }

 private:
  int side() const { return 2 * half_ + 1; }
  double step_;
  int half_;
  std::vector<float> cells_;
  double total_ = 0;
};

/// Radians: its multiples lie evenly about the circle.
constexpr double kGoldenAngle = 2.399963229728653;

/// \param lean  else votes are for a shift
/// \param chance  else 0: every row's sightings are turned by an angle that hangs on it and on this number
/// \param shift  m, of the whole image: what is left of a sighting without it is lean
void cast(Votes& votes, std::span<const SightedOutline> all, std::span<const std::uint32_t> chosen, Point2 node,
          double curvature, bool lean, Point2 shift, unsigned chance = 0) {
  votes.clear();
  for (const std::uint32_t n : chosen) {
    const SightedOutline& o = all[n];
    const base::SinCos turn = chance == 0 ? base::SinCos{} : base::sin_cos(kGoldenAngle * (o.row * 7 + 1) * chance);
    for (Sighting s : o.sightings) {
      if (s.weight <= 0) continue;
      s.at.x -= shift.x, s.at.y -= shift.y;
      s.at = {s.at.x * turn.cos - s.at.y * turn.sin, s.at.x * turn.sin + s.at.y * turn.cos};
      if (!lean) {
        votes.add(s.at, kPlaceError, s.weight * o.weight);
        continue;
      }
      for (const auto& [factor, share] : o.guessed ? kGuessedHeights : kTaggedHeights) {
        const double h = o.height * factor;
        // Of low buildings any lean is likely: they say little.
        votes.add({s.at.x / h - curvature * (o.place.x - node.x), s.at.y / h - curvature * (o.place.y - node.y)},
                  kPlaceError / h, o.weight * s.weight * share * std::min(1.0, h / 8));
      }
    }
  }
}

/// A place of the image and its outlines.
struct Neighbourhood {
  Point2 node;
  double weight = 0;
  std::vector<std::uint32_t> outlines;
};

std::size_t rows_in(std::span<const SightedOutline> all, std::span<const Neighbourhood> places) {
  std::vector<std::uint32_t> rows;
  for (const Neighbourhood& place : places)
    for (const std::uint32_t n : place.outlines) rows.push_back(all[n].row);
  std::sort(rows.begin(), rows.end());
  return static_cast<std::size_t>(std::unique(rows.begin(), rows.end()) - rows.begin());
}

/// The shift of a whole image, in m: with it low and high roofs agree best on how they lean. Nothing that is not clear.
Point2 image_shift(std::span<const SightedOutline> all, std::span<const Neighbourhood> places, int workers) {
  if (places.size() < kFewestShiftNodes) return {};
  constexpr int kSteps = static_cast<int>(kFarthestShift / kShiftsApart), kSide = 2 * kSteps + 1;
  const auto at = [](int i, int j) { return static_cast<std::size_t>((j + kSteps) * kSide + i + kSteps); };
  std::vector<double> support(static_cast<std::size_t>(kSide * kSide), 0.0);
  std::vector<std::vector<double>> own(places.size(), support);
  base::ordered_parallel(
      places.size(), workers, places.size(),
      [&](std::size_t n) {
        Votes votes(kMostLean, kCoarseLeanStep);
        for (int j = -kSteps; j <= kSteps; ++j)
          for (int i = -kSteps; i <= kSteps; ++i) {
            if (i * i + j * j > kSteps * kSteps + 1) continue;
            cast(votes, all, places[n].outlines, places[n].node, 0, true, {i * kShiftsApart, j * kShiftsApart});
            own[n][at(i, j)] = places[n].weight * votes.winner().support;
          }
      },
      [&](std::size_t n) {
        for (std::size_t k = 0; k < support.size(); ++k) support[k] += own[n][k];
      });
  int best_i = 0, best_j = 0;
  for (int j = -kSteps + 1; j < kSteps; ++j)
    for (int i = -kSteps + 1; i < kSteps; ++i)
      if (support[at(i, j)] > support[at(best_i, best_j)]) best_i = i, best_j = j;
  const double here = support[at(best_i, best_j)];
  const double rows = static_cast<double>(rows_in(all, places));
  if (!(here > (1 + kClearShift / std::sqrt(std::max(1.0, rows))) * support[at(0, 0)])) return {};
  // The votes are wide: between the steps by a parabola. Beyond the rim nothing was looked for.
  const auto top = [&](double before, double after) {
    const double bend = 2 * here - before - after;
    return before > 0 && after > 0 && bend > 0 ? std::clamp((after - before) / 2 / bend, -0.5, 0.5) : 0;
  };
  return {(best_i + top(support[at(best_i - 1, best_j)], support[at(best_i + 1, best_j)])) * kShiftsApart,
          (best_j + top(support[at(best_i, best_j - 1)], support[at(best_i, best_j + 1)])) * kShiftsApart};
}

/// \param lean  else votes are for a shift
Votes::Winner vote(Votes& votes, std::span<const SightedOutline> all, std::span<const std::uint32_t> chosen,
                   Point2 node, double curvature, bool lean, Point2 shift) {
  cast(votes, all, chosen, node, curvature, lean, shift);
  return votes.winner();
}

std::pair<long long, long long> cell_of(Point2 p) {
  return {static_cast<long long>(std::floor(p.x / kNodeGrid)), static_cast<long long>(std::floor(p.y / kNodeGrid))};
}

Point2 middle_of(std::pair<long long, long long> cell) {
  return {(static_cast<double>(cell.first) + 0.5) * kNodeGrid, (static_cast<double>(cell.second) + 0.5) * kNodeGrid};
}

}  // namespace

std::array<Sighting, kMostSightings> sightings_of(const ScoreMap& map) {
  std::array<Sighting, kMostSightings> out{};
  const Displacements& g = map.grid;
  double sum = 0, squares = 0, count = 0;
  const auto inside = [&](int i, int j) { return i * i + j * j <= g.half * g.half; };
  for (int j = -g.half; j <= g.half; ++j)
    for (int i = -g.half; i <= g.half; ++i)
      if (inside(i, j)) {
        const double s = static_cast<double>(map.at(i, j));
        sum += s, squares += s * s, count += 1;
      }
  const double mean = sum / count, deviation = std::sqrt(std::max(1e-9, squares / count - mean * mean));
  for (int j = -g.half + 1; j < g.half; ++j)
    for (int i = -g.half + 1; i < g.half; ++i) {
      if (!inside(i, j)) continue;
      const float s = map.at(i, j);
      const double z = (static_cast<double>(s) - mean) / deviation;
      if (z < 1.5 || z <= out.back().weight) continue;
      bool peak = true;
      for (int v = -1; v <= 1 && peak; ++v)
        for (int u = -1; u <= 1 && peak; ++u)
          peak = (u == 0 && v == 0) || map.at(i + u, j + v) < s ||
                 (map.at(i + u, j + v) == s && (v > 0 || (v == 0 && u > 0)));
      if (!peak) continue;
      out.back() = {{i * g.step, j * g.step}, z};
      for (std::size_t k = out.size() - 1; k > 0 && out[k].weight > out[k - 1].weight; --k)
        std::swap(out[k], out[k - 1]);
    }
  // A peak counts by how near it comes to the best one.
  const double best = out.front().weight;
  double total = 0;
  for (Sighting& s : out) {
    const double share = best > 0 ? std::max(0.0, (s.weight / best - 0.6) / 0.4) : 0;
    s.weight = share * share, total += s.weight;
  }
  for (Sighting& s : out) s.weight = total > 0 ? s.weight / total : 0;
  return out;
}

LeanField::LeanField(std::span<const SightedOutline> outlines, int workers) {
  std::vector<geometry::PlanBox> places(outlines.size());
  std::map<std::pair<long long, long long>, std::uint32_t> cells;  // outlines in each
  for (std::size_t n = 0; n < outlines.size(); ++n) {
    if (outlines[n].sightings[0].weight <= 0) continue;
    places[n] = {outlines[n].place, outlines[n].place};
    ++cells[cell_of(outlines[n].place)];
  }
  const geometry::BoxIndex index(places);
  const auto around = [&](std::pair<long long, long long> cell) {
    const Point2 node = middle_of(cell);
    std::vector<std::uint32_t> near = index.near({node, node}, kNodeReach);
    std::erase_if(near, [&](std::uint32_t n) {
      const double dx = outlines[n].place.x - node.x, dy = outlines[n].place.y - node.y;
      return dx * dx + dy * dy > kNodeReach * kNodeReach;
    });
    return near;
  };
  // The nodes with most outlines, spread over the image, decide what kind of image it is.
  std::vector<std::pair<std::uint32_t, std::pair<long long, long long>>> fullest;
  for (const auto& [cell, count] : cells) fullest.emplace_back(count, cell);
  std::sort(fullest.begin(), fullest.end(),
            [](const auto& a, const auto& b) { return a.first != b.first ? a.first > b.first : a.second < b.second; });
  if (fullest.size() > kCurvatureNodes) fullest.resize(kCurvatureNodes);

  Votes shifts(kMostShift, kShiftStep);
  std::vector<std::vector<std::uint32_t>> near;
  std::vector<Neighbourhood> judges;
  for (const auto& [count, cell] : fullest) {
    near.push_back(around(cell));
    if (judges.size() < kShiftNodes) judges.push_back({middle_of(cell), static_cast<double>(count), near.back()});
  }
  shift_ = image_shift(outlines, judges, workers);
  double best = -1, shift_support = 0, weight = 0;
  const auto try_curvature = [&](int steps) {
    if (steps < 0 || steps > kCurvatureSteps) return;
    std::vector<double> supports(fullest.size());
    double support = 0;
    base::ordered_parallel(
        fullest.size(), workers, fullest.size(),
        [&](std::size_t n) {
          Votes votes(kMostLean, kLeanStep);
          supports[n] =
              vote(votes, outlines, near[n], middle_of(fullest[n].second), steps * kCurvatureStep, true, shift_)
                  .support;
        },
        [&](std::size_t n) { support += fullest[n].first * supports[n]; });
    if (support > best) best = support, curvature_ = steps * kCurvatureStep;
  };
  for (int steps = 0; steps <= kCurvatureSteps; steps += kCoarseCurvature) try_curvature(steps);
  const int coarse = static_cast<int>(std::lround(curvature_ / kCurvatureStep));
  for (int by = 1; by < kCoarseCurvature; ++by) try_curvature(coarse - by), try_curvature(coarse + by);
  for (std::size_t n = 0; n < fullest.size(); ++n) {
    shift_support +=
        fullest[n].first * vote(shifts, outlines, near[n], middle_of(fullest[n].second), 0, false, {}).support;
    weight += fullest[n].first;
  }
  if (weight <= 0) return;
  const bool shifted = shift_.x != 0 || shift_.y != 0;
  leans_ = best >= (shifted ? kLeansToo : 1) * shift_support;
  if (!leans_) curvature_ = 0, shift_ = {};

  const auto empty = [this] { return leans_ ? Votes(kMostLean, kLeanStep) : Votes(kMostShift, kShiftStep); };
  struct Candidate {
    Node node;
    std::vector<std::uint32_t> near;
    double threshold = 0, outlines = 0, gain = 0;
    std::array<double, kChances> chance{};
    bool sure = false;
  };
  std::map<std::pair<long long, long long>, Candidate> candidates;
  std::vector<Candidate> tried;
  for (const auto& [cell, count] : cells) {
    tried.emplace_back();
    tried.back().node.cell = cell, tried.back().outlines = static_cast<double>(count);
  }
  double total = 0, agreed = 0, sure = 0, squares = 0;
  std::size_t samples = 0;
  base::ordered_parallel(
      tried.size(), workers, kInFlight,
      [&](std::size_t n) {
        Candidate& c = tried[n];
        c.near = around(c.node.cell);
        if (c.near.size() < kFewest) return;
        Votes votes = empty();
        const Point2 middle = middle_of(c.node.cell);
        const Votes::Winner won = vote(votes, outlines, c.near, middle, curvature_, leans_, shift_);
        c.node.k = won.at, c.node.support = won.support, c.gain = won.support - won.at_zero;
        for (unsigned chance = 1; chance <= kChances; ++chance) {
          cast(votes, outlines, c.near, middle, curvature_, leans_, shift_, chance);
          c.chance[chance - 1] = votes.winner().support;
        }
      },
      [&](std::size_t n) {
        Candidate& c = tried[n];
        if (c.near.size() < kFewest) return;
        double chances = 0;
        for (const double by_chance : c.chance) chances += by_chance;
        c.threshold = chances / kChances;
        for (const double by_chance : c.chance)
          if (c.threshold > 0) {
            squares += (by_chance / c.threshold - 1) * (by_chance / c.threshold - 1);
            ++samples;
          }
        total += c.outlines, agreed += c.outlines * c.node.support;
        const auto cell = c.node.cell;
        candidates.emplace(cell, std::move(c));
      });
  const double deviation =
      samples > 0 ? std::sqrt(squares / static_cast<double>(samples) * kChances / (kChances - 1)) : 0;
  for (auto& [cell, c] : candidates) {
    c.threshold *= 1 + kSureDeviations * deviation;
    if (!leans_) c.threshold = std::max(c.threshold, kLeastShiftSupport);
    c.sure = c.node.support >= c.threshold && c.gain >= kLeastGain;
    sure += c.sure ? c.outlines : 0;
  }
  support_ = total > 0 ? agreed / total : 0;
  if (sure < kLeastShare * total) return;
  // Neighbours within one picture tell each other what their own votes leave open.
  for (int round = 0; round < kRounds; ++round) {
    const auto before = candidates;
    const auto hear = [&](const std::pair<long long, long long> cell, Candidate& c) {
      std::vector<Point2> told;
      for (long long v = -1; v <= 1; ++v)
        for (long long u = -1; u <= 1; ++u) {
          const auto other = before.find({cell.first + u, cell.second + v});
          if ((u == 0 && v == 0) || other == before.end() || !other->second.sure) continue;
          told.push_back({other->second.node.k.x - curvature_ * static_cast<double>(u) * kNodeGrid,
                          other->second.node.k.y - curvature_ * static_cast<double>(v) * kNodeGrid});
        }
      if (told.empty()) return;
      Votes votes = empty();
      cast(votes, outlines, c.near, middle_of(cell), curvature_, leans_, shift_);
      const auto alike = [&](Point2 a, Point2 b) {
        const double limit = leans_ ? kSameLean : kSameShift;
        return std::fabs(a.x - b.x) <= limit && std::fabs(a.y - b.y) <= limit;
      };
      const auto friends = [&](Point2 k) {
        return static_cast<double>(std::count_if(told.begin(), told.end(), [&](Point2 t) { return alike(t, k); }));
      };
      Votes::Winner best = votes.winner();
      double most = best.support * (1 + kFriend * friends(best.at));
      for (const Point2 t : told) {
        const Votes::Winner here = votes.winner_near(t, leans_ ? kSameLean : kSameShift);
        if (const double value = here.support * (1 + kFriend * friends(here.at)); value > most)
          most = value, best = here;
      }
      c.node.k = best.at, c.node.support = best.support;
      c.sure =
          best.support >= c.threshold || (friends(best.at) > 0 && best.support >= kEnoughWithFriends * c.threshold);
    };
    std::vector<std::pair<const std::pair<long long, long long>, Candidate>*> all;
    for (auto& candidate : candidates) all.push_back(&candidate);
    base::ordered_parallel(
        all.size(), workers, kInFlight, [&](std::size_t n) { hear(all[n]->first, all[n]->second); },
        [](std::size_t) {});
  }
  for (const auto& [cell, c] : candidates) {
    if (!c.sure) continue;
    nodes_.push_back(c.node);
  }
}

std::optional<Point2> LeanField::at(Point2 place, double height) const {
  if (!found()) return Point2{};
  const std::optional<Point2> k = told(place);
  if (!k) return std::nullopt;
  return leans_ ? Point2{shift_.x + k->x * height, shift_.y + k->y * height} : *k;
}

std::optional<Point2> LeanField::per_metre(Point2 place) const { return leans_ ? told(place) : Point2{}; }

std::optional<Point2> LeanField::told(Point2 place) const {
  if (nodes_.empty()) return Point2{};
  // Of the nodes around the place those that know, by nearness.
  double x = 0, y = 0, weight = 0;
  const auto [ci, cj] = cell_of({place.x - kNodeGrid / 2, place.y - kNodeGrid / 2});
  for (long long j = cj; j <= cj + 1; ++j)
    for (long long i = ci; i <= ci + 1; ++i) {
      const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), Node{{i, j}, {}, 0});
      if (found == nodes_.end() || found->cell != std::pair(i, j)) continue;
      const Point2 node = middle_of(found->cell);
      const double u = std::max(0.0, 1 - std::fabs(place.x - node.x) / kNodeGrid),
                   v = std::max(0.0, 1 - std::fabs(place.y - node.y) / kNodeGrid);
      const double w = u * v * found->support;
      x += w * (found->k.x + curvature_ * (place.x - node.x)), y += w * (found->k.y + curvature_ * (place.y - node.y));
      weight += w;
    }
  if (weight > 0) return Point2{x / weight, y / weight};
  return std::nullopt;
}

}  // namespace blockrand::observation
