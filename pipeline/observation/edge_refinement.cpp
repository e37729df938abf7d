#include "pipeline/observation/edge_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "pipeline/base/portable_math.h"

namespace blockrand::observation {

namespace {

using model::Point2;

/// m: between the shifts that are tried, and between the samples along a wall.
constexpr double kStep = 0.1, kAlong = 0.2;
/// Steps of the strips on both sides of a wall, the line of the wall itself belongs to none: 0.1 to 0.4 m from it.
constexpr int kStrip = 4;
/// Levels of 255: a change of brightness of as much is half a clear edge. Larger than where rows are looked for
/// (observe_extract.cpp): there edges are to be found, here the middle of one.
constexpr double kContrast = 30;
/// m: pieces of a wall that are judged by themselves, so that a tree before one hides no other.
constexpr double kPiece = 4;
/// m: at both ends of walls from three times that on, where the neighbouring walls are seen.
constexpr double kEnd = 0.6;
/// Of a wall: with less of it in the image nothing is said of it.
constexpr double kLeastSeen = 0.7;
/// m: shorter walls are not looked for by themselves.
constexpr double kShortestSought = 2;
/// Of clearness, by metre of wall: what it costs to shift one, and to shift it by a metre more. Without gain nothing is shifted.
constexpr double kShiftCost = 0.06, kCostByMetre = 0.05;
/// m: by how much the place of a whole roof in the image may be off (its lean, its height, the place of its row): as likely as
/// not, and at most. In clearness, what it costs to be off by as much as is likely.
constexpr double kRoofOff = 0.25, kMostRoofOff = 0.6, kRoofOffCost = 0.015;
/// m: smaller shifts are errors of the search; and what is another edge.
constexpr double kLeastShift = 0.25, kElsewhere = 0.4;
/// m, and levels: strips that are compared with what lies between a wall and its edge; and a difference that is none.
constexpr double kBeside = 0.5, kSameColour = 8;
/// What the height of a roof explains: of how far the image shows its edge from the ground there, in a wall's direction. Eaves are
/// reckoned with, verges rise from there to the ridge.
constexpr double kByHeight = 0.6;
/// m: where the edge is seen so far inwards from the ground, the wall below it is seen as well, and its foot.
constexpr double kWallSeen = 0.2;
/// Of clearness, of one wall and on the average of all: smaller gains are none.
constexpr double kLeastGain = 0.06, kLeastGainOfAll = 0.02;
/// Walls are shifted from this confidence on: wrong ones had up to 0.74 (docs/internal/RESULTS.md, "Aerial images").
constexpr double kSureWall = 0.75;
/// Of the walls by length: where more are seen elsewhere, those are not the ones that are wrong. Cosine between the directions of
/// walls that are opposite to each other.
constexpr double kMostElsewhere = 0.5, kOpposite = -0.9;
/// m: with a wider rim, or where the image shows a roof farther from its ground, single walls are not sure of their places.
constexpr double kSureRim = 0.55, kMostLean = 1.5;
/// m: eaves reach so far out over all walls, copings lie so far within them; what it costs, in clearness, to be as much.
constexpr double kMostRim = 0.8, kRimCost = 0.03;

double rounded(double value, double steps) { return std::round(value * steps) / steps + 0.0; }

using Colour = std::array<float, 3>;

/// How clear the edge of walls is at each shift: clearness in [0, 1] by steps from the farthest inwards; empty: not seen.
struct Curve {
  int half = 0;
  std::vector<double> clear;
  std::vector<Colour> colours;  ///< levels, the mean of the lines there; kStrip more on both sides
  bool seen() const { return !clear.empty(); }
  /// \param shift  m, within the curve
  double at(double shift) const {
    const double x = std::clamp(shift / kStep + half, 0.0, 2.0 * half);
    const auto i = std::min(static_cast<std::size_t>(x), clear.size() - 2);
    const double u = x - static_cast<double>(i);
    return clear[i] * (1 - u) + clear[i + 1] * u;
  }
  /// The mean colour of the lines from one shift to another, in m.
  Colour between(double from, double to) const {
    const int last = static_cast<int>(colours.size()) - 1;
    const int begin = std::clamp(static_cast<int>(std::lround(from / kStep)) + half + kStrip, 0, last),
              end = std::clamp(static_cast<int>(std::lround(to / kStep)) + half + kStrip, begin, last);
    Colour sum{};
    for (int i = begin; i <= end; ++i)
      for (std::size_t n = 0; n < 3; ++n)
        sum[n] += colours[static_cast<std::size_t>(i)][n] / static_cast<float>(end - begin + 1);
    return sum;
  }
};

double difference(const Colour& a, const Colour& b) {
  float squares = 0;
  for (std::size_t n = 0; n < 3; ++n) squares += (a[n] - b[n]) * (a[n] - b[n]);
  return std::sqrt(static_cast<double>(squares));
}

/// What lies between a wall and its edge in the image belongs to the roof, if the edge is farther out, else to the ground.
/// \returns  from -1 (it looks like the other side) to 1
double fits_its_side(const Curve& curve, double off, double shift) {
  const double in = std::min(off, off + shift), out = std::max(off, off + shift);
  const Colour middle = curve.between(in + kStep, out - kStep),
               inside = curve.between(in - kBeside - kStep, in - kStep),
               outside = curve.between(out + kStep, out + kBeside + kStep);
  const double to_roof = difference(middle, inside), to_ground = difference(middle, outside);
  const double fit = (to_ground - to_roof) / (to_ground + to_roof + kSameColour);
  return shift > 0 ? fit : -fit;
}

/// The mean colours of lines parallel to a piece of a wall; false where the image does not show all of them.
bool line_colours(const Patch& patch, Point2 middle, Point2 along, double length, int half,
                  std::vector<Colour>& lines) {
  const int samples = std::max(2, static_cast<int>(std::lround(length / kAlong)));
  const double step = length / samples;
  const Point2 normal{along.y, -along.x};
  lines.assign(static_cast<std::size_t>(2 * half + 1), Colour{});
  const auto width = static_cast<std::size_t>(patch.width);
  for (int i = -half; i <= half; ++i) {
    Colour sum{};
    for (int j = 0; j < samples; ++j) {
      const double a = (j + 0.5 - samples / 2.0) * step;
      const double x = (middle.x + along.x * a + normal.x * i * kStep - patch.west) / patch.size - 0.5;
      const double y = (patch.north - middle.y - along.y * a - normal.y * i * kStep) / patch.size - 0.5;
      if (!(x >= 0 && y >= 0 && x < patch.width - 1 && y < patch.height - 1)) return false;
      const auto c = static_cast<std::size_t>(x), r = static_cast<std::size_t>(y);
      const std::size_t at = r * width + c, below = at + width;
      if (!patch.valid[at] || !patch.valid[at + 1] || !patch.valid[below] || !patch.valid[below + 1]) return false;
      const auto u = static_cast<float>(x - static_cast<double>(c)), v = static_cast<float>(y - static_cast<double>(r));
      const float w00 = (1 - u) * (1 - v), w10 = u * (1 - v), w01 = (1 - u) * v, w11 = u * v;
      const std::vector<std::uint8_t>* const bands[] = {&patch.red, &patch.green, &patch.blue};
      for (std::size_t n = 0; n < 3; ++n) {
        const std::vector<std::uint8_t>& b = *bands[n];
        sum[n] += w00 * static_cast<float>(b[at]) + w10 * static_cast<float>(b[at + 1]) +
                  w01 * static_cast<float>(b[below]) + w11 * static_cast<float>(b[below + 1]);
      }
    }
    for (float& s : sum) s /= static_cast<float>(samples);
    lines[static_cast<std::size_t>(i + half)] = sum;
  }
  return true;
}

/// Adds the clearness of a wall's pieces by their length. \returns  m of them that the image shows
double add_wall(const Wall& wall, Point2 lean, const Patch& patch, Curve& curve) {
  std::vector<double>& sums = curve.clear;
  const double end = wall.length >= 3 * kEnd ? kEnd : 0, length = wall.length - 2 * end;
  const int count = std::max(1, static_cast<int>(std::ceil(length / kPiece)));
  const int half = static_cast<int>(sums.size() / 2);
  std::vector<Colour> lines;
  double seen = 0;
  for (int k = 0; k < count; ++k) {
    const Point2 foot = wall.at(end + (k + 0.5) * length / count), middle{foot.x + lean.x, foot.y + lean.y};
    if (!line_colours(patch, middle, wall.along, length / count, half + kStrip, lines)) continue;
    seen += length / count;
    for (std::size_t i = 0; i < lines.size(); ++i)
      for (std::size_t n = 0; n < 3; ++n) curve.colours[i][n] += static_cast<float>(length / count) * lines[i][n];
    for (std::size_t i = 0; i < sums.size(); ++i) {
      float squares = 0;
      for (std::size_t n = 0; n < 3; ++n) {
        float change = 0;
        for (std::size_t s = 1; s <= kStrip; ++s) change += lines[i + kStrip + s][n] - lines[i + kStrip - s][n];
        squares += change * change;
      }
      const double change = std::sqrt(static_cast<double>(squares)) / kStrip;
      sums[i] += length / count * change / (change + kContrast);
    }
  }
  return seen;
}

/// Weights of a logistic regression (fit.py of tests/bench/imagery) on walls of one real image and of the synthetic ones of set `tuning`,
/// of houses with one or two walls shifted by known amounts; right are those that stand nearer to the truth by 0.05 m afterwards.
double confidence_of(const WallEvidence& e, Point2 lean) {
  const double sum = -1.91 - 2.49 * e.here + 1.58 * (e.there - e.second) + 0.37 * base::log(e.length) + 1.08 * e.side +
                     1.72 * e.others - 0.55 * std::sqrt(lean.x * lean.x + lean.y * lean.y);
  return 1 / (1 + base::exp(-sum));
}

class Refiner {
 public:
  Refiner(const RefinedBuilding& building, const ImageWindows& windows, double bound)
      : building_(building), bound_(bound), walls_(find_walls(building.rings, building.fixed)) {
    reach_ = bound_ + kMostRoofOff + kMostRim;
    if (!sought()) return;
    geometry::PlanBox box;
    for (const auto& ring : building.rings) box.include(geometry::box_of(ring));
    box.minimum.x += building.lean.x, box.minimum.y += building.lean.y;
    box.maximum.x += building.lean.x, box.maximum.y += building.lean.y;
    const Patch patch = windows.window(box, reach_ + (kStrip + 1) * kStep + 2 * windows.size());
    measure(patch);
  }

  RefinedOutline run() {
    if (!sought()) return left_alone("no wall of it is long enough and free to be looked for by itself");
    if (std::ranges::none_of(curves_, &Curve::seen)) return left_alone("the image does not show its walls");
    tabulate();
    pose_ = best_pose(curves_.size());
    find_candidates();
    if (too_many_) return left_alone("too many of its walls are seen beside the others");
    if (evidence_.empty()) return left_alone("no wall is clearly seen beside the others");
    take_surest();
    return conclude();
  }

 private:
  bool sought() const {
    for (std::size_t g = 0; g < walls_.movable.size(); ++g)
      if (walls_.movable[g] && walls_.lengths[g] >= kShortestSought) return true;
    return false;
  }

  void measure(const Patch& patch) {
    const int half = static_cast<int>(std::ceil(reach_ / kStep));
    curves_.resize(walls_.movable.size());
    directions_.resize(curves_.size());
    middles_.resize(curves_.size());
    std::vector<double> seen(curves_.size(), 0.0), longest(curves_.size(), 0.0);
    for (Curve& curve : curves_) {
      curve.half = half, curve.clear.assign(static_cast<std::size_t>(2 * half + 1), 0.0);
      curve.colours.assign(static_cast<std::size_t>(2 * (half + kStrip) + 1), Colour{});
    }
    for (const Wall& wall : walls_.walls) {
      seen[wall.group] += add_wall(wall, building_.seen, patch, curves_[wall.group]);
      if (wall.length <= longest[wall.group]) continue;
      longest[wall.group] = wall.length;
      directions_[wall.group] = wall.normal(), middles_[wall.group] = wall.at(wall.length / 2);
    }
    for (std::size_t g = 0; g < curves_.size(); ++g) {
      if (seen[g] <= 0 || seen[g] < kLeastSeen * (walls_.lengths[g] - 2 * kEnd)) curves_[g].clear.clear();
      for (double& c : curves_[g].clear) c /= seen[g];
      for (Colour& c : curves_[g].colours)
        for (float& level : c) level /= static_cast<float>(std::max(1e-9, seen[g]));
    }
  }

  /// How the image shows the roof beside its walls: displaced as a whole, and with a rim outside the walls or within them.
  struct Pose {
    Point2 roof;        ///< m
    double rim = 0;     ///< m, outwards
    double value = -1;  ///< the mean clearness of all walls, each at its best shift, less what all of this costs
  };

  /// m, that a wall which is mapped where it stands is seen farther out.
  double off(std::size_t g, const Pose& pose) const {
    return pose.rim + pose.roof.x * directions_[g].x + pose.roof.y * directions_[g].y;
  }
  double off(std::size_t g) const { return off(g, pose_); }

  /// The best shift of walls and how clear their edge is there, beside what shows them `off` m farther out.
  std::pair<double, double> best_shift(std::size_t g, double off) const {
    const int most = static_cast<int>(bound_ / kStep + 1e-9);
    std::pair<double, double> best{0, curves_[g].at(off)};
    for (int k = -most; k <= most; ++k)
      if (const double clear = curves_[g].at(k * kStep + off); clear > best.second) best = {k * kStep, clear};
    return best;
  }

  /// For every offset of a wall, in steps, how clear it is there or at its best shift, less what that costs.
  void tabulate() {
    const int most = static_cast<int>(std::lround((kMostRoofOff + kMostRim) / kStep)) + 1;
    tables_.resize(curves_.size());
    length_ = 0;
    for (std::size_t g = 0; g < curves_.size(); ++g) {
      if (!curves_[g].seen()) continue;
      length_ += walls_.lengths[g];
      tables_[g].unmoved.resize(static_cast<std::size_t>(2 * most + 1));
      tables_[g].best = tables_[g].unmoved;
      for (int k = -most; k <= most; ++k) {
        const double here = curves_[g].at(k * kStep);
        double best = here;
        if (walls_.movable[g]) {
          const auto [shift, there] = best_shift(g, k * kStep);
          best = std::max(best, there - kShiftCost - kCostByMetre * std::fabs(shift));
        }
        tables_[g].unmoved[static_cast<std::size_t>(k + most)] = here;
        tables_[g].best[static_cast<std::size_t>(k + most)] = best;
      }
    }
  }

  /// What all walls have in common is no fault of one of them: the roof's place, its lean and height being known so well only,
  /// and its rim. Of all poses the one that shows the walls most clearly with the fewest shifts.
  /// \param kept  walls that may not be shifted; groups: none
  Pose best_pose(std::size_t kept) const {
    const int roofs = static_cast<int>(kMostRoofOff / kStep + 0.5), rims = static_cast<int>(kMostRim / kStep + 0.5);
    const double doubt = std::sqrt(building_.doubt.x * building_.doubt.x + building_.doubt.y * building_.doubt.y);
    const Point2 lean = doubt > 0 ? Point2{building_.doubt.x / doubt, building_.doubt.y / doubt} : Point2{1, 0};
    Pose best;
    for (int j = -roofs; j <= roofs; ++j)
      for (int i = -roofs; i <= roofs; ++i) {
        if (i * i + j * j > roofs * roofs) continue;
        const Point2 roof{i * kStep, j * kStep};
        const double along = roof.x * lean.x + roof.y * lean.y, across = roof.x * lean.y - roof.y * lean.x;
        const double cost = kRoofOffCost * (along * along / (kRoofOff * kRoofOff + doubt * doubt) +
                                            across * across / (kRoofOff * kRoofOff));
        for (int k = -rims; k <= rims; ++k) {
          Pose pose{roof, k * kStep, 0};
          double sum = 0;
          for (std::size_t g = 0; g < curves_.size(); ++g) {
            if (!curves_[g].seen()) continue;
            const std::vector<double>& table = g == kept ? tables_[g].unmoved : tables_[g].best;
            const auto at = static_cast<std::ptrdiff_t>(table.size() / 2) + std::lround(off(g, pose) / kStep);
            sum += walls_.lengths[g] *
                   table[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, std::ssize(table) - 1))];
          }
          const double share = pose.rim / kMostRim;
          pose.value = sum / length_ - cost - kRimCost * share * share;
          if (pose.value > best.value + 1e-9) best = pose;
        }
      }
    return best;
  }

  /// A wall beside the pose: its best shift, and how clear it is near where it stands and there. An edge within 0.2 m is its own.
  struct Seen {
    double shift = 0, here = 0, there = 0;
    bool elsewhere() const { return std::fabs(shift) >= kLeastShift && there - here >= kLeastGain; }
  };
  Seen seen(std::size_t g) const {
    const double off = this->off(g);
    Seen out;
    for (int k = -2; k <= 2; ++k) out.here = std::max(out.here, curves_[g].at(off + k * kStep));
    std::tie(out.shift, out.there) = best_shift(g, off);
    return out;
  }

  /// Walls that are clearly seen elsewhere, and by nothing else than that they stand there.
  void find_candidates() {
    if (std::fabs(pose_.rim) > kSureRim) return;
    if (building_.lean.x * building_.lean.x + building_.lean.y * building_.lean.y > kMostLean * kMostLean) return;
    std::vector<Seen> walls(curves_.size());
    double elsewhere = 0;
    for (std::size_t g = 0; g < curves_.size(); ++g) {
      if (!curves_[g].seen()) continue;
      walls[g] = seen(g);
      if (walls[g].elsewhere()) elsewhere += walls_.lengths[g];
    }
    too_many_ = elsewhere > kMostElsewhere * length_;
    if (too_many_) return;
    for (std::uint32_t g = 0; g < curves_.size(); ++g) {
      if (!walls_.movable[g] || !walls[g].elsewhere() || walls_.lengths[g] < kShortestSought) continue;
      // Between the steps: the top of the parabola through the best and its neighbours.
      const double off = this->off(g), at = walls[g].shift, there = walls[g].there,
                   left = curves_[g].at(at - kStep + off), right = curves_[g].at(at + kStep + off),
                   bend = left - 2 * there + right;
      if (!(bend < 0 && left <= there && right <= there)) continue;  // it comes out clearer beyond the bound
      const double shift = at + kStep * (left - right) / (2 * bend);
      if (std::fabs(shift) > bound_ - kStep / 2 || explained(g, shift, walls)) continue;
      evidence_.push_back(evidence_of(g, shift, walls));
      groups_.push_back(g);
    }
  }

  /// Another height of the roof, the foot of the wall, or a rim that only walls across have, shows the edge there as well.
  bool explained(std::size_t g, double shift, const std::vector<Seen>& walls) const {
    const double lean = lean_outwards(g);
    if (std::fabs(shift) < kLeastShift + kByHeight * std::fabs(lean) || (lean < -kWallSeen && shift > 0)) return true;
    for (std::size_t other = 0; other < walls.size(); ++other) {
      const double facing = directions_[g].x * directions_[other].x + directions_[g].y * directions_[other].y;
      if (facing < kOpposite && walls[other].elsewhere() && (walls[other].shift > 0) == (shift > 0)) return true;
    }
    return false;
  }

  double lean_outwards(std::size_t g) const {
    return building_.lean.x * directions_[g].x + building_.lean.y * directions_[g].y;
  }

  WallEvidence evidence_of(std::size_t g, double shift, const std::vector<Seen>& walls) const {
    const Curve& curve = curves_[g];
    const double off = this->off(g);
    WallEvidence e;
    e.at = {rounded(middles_[g].x, 1000), rounded(middles_[g].y, 1000)};
    e.normal = {rounded(directions_[g].x, 10000), rounded(directions_[g].y, 10000)};
    e.shift = rounded(shift, 1000), e.here = walls[g].here, e.there = walls[g].there, e.length = walls_.lengths[g];
    e.rim = pose_.rim, e.lean = lean_outwards(g), e.side = fits_its_side(curve, off, shift);
    e.margin = (pose_.value - best_pose(g).value) * length_ / e.length;
    const int most = static_cast<int>(bound_ / kStep + 1e-9);
    for (int k = -most; k <= most; ++k) {
      const double clear = curve.at(k * kStep + off);
      e.usual += clear / (2 * most + 1);
      if (std::fabs(k * kStep - shift) >= kElsewhere) e.second = std::max(e.second, clear);
    }
    const double length = length_ - e.length;
    for (std::size_t other = 0; other < walls.size(); ++other)
      if (other != g && curves_[other].seen() && length > 0) {
        e.others += walls_.lengths[other] * walls[other].here / length;
        if (walls[other].there - walls[other].here < kLeastGain) e.steady += walls_.lengths[other] / length;
      }
    e.confidence = rounded(confidence_of(e, building_.lean), 1000);
    return e;
  }

  /// The surest first; one that would spoil the outline stays.
  void take_surest() {
    std::vector<std::size_t> order(evidence_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(
        order, [&](std::size_t a, std::size_t b) { return evidence_[a].confidence > evidence_[b].confidence; });
    shifts_.assign(walls_.movable.size(), 0.0);
    for (const std::size_t i : order) {
      WallEvidence& e = evidence_[i];
      if (e.confidence < kSureWall) continue;
      shifts_[groups_[i]] = e.shift;
      Rings outline = shifted_outline(building_.rings, walls_, shifts_, kMostCornerShift * bound_);
      if (outline.empty()) {
        shifts_[groups_[i]] = 0, spoils_ = true;
        continue;
      }
      outline_ = std::move(outline), e.taken = true;
    }
  }

  RefinedOutline conclude() {
    RefinedOutline out;
    double length = 0;
    for (std::size_t g = 0; g < curves_.size(); ++g) {
      if (!curves_[g].seen()) continue;
      const double off = this->off(g);
      length += walls_.lengths[g];
      out.before += walls_.lengths[g] * curves_[g].at(off);
      out.after += walls_.lengths[g] * curves_[g].at(off + shifts_[g]);
    }
    out.before = rounded(out.before / length, 10000), out.after = rounded(out.after / length, 10000);
    out.evidence = evidence_;
    out.confidence = 1;
    for (const WallEvidence& e : evidence_)
      if (e.taken)
        ++out.walls, out.largest = std::max(out.largest, std::fabs(e.shift)),
                     out.confidence = std::min(out.confidence, e.confidence);
    out.state = RefinementState::left_alone;
    if (out.walls == 0) {
      out.confidence = 0;
      for (const WallEvidence& e : evidence_) out.confidence = std::max(out.confidence, e.confidence);
      out.reason = spoils_ ? "its outline would not stay clean" : "the edges of its walls do not say it clearly";
    } else if (out.after - out.before < kLeastGainOfAll) {
      out.reason = "its walls stand nearly as well where they are";
    } else {
      out.state = RefinementState::refined;
      out.to = outline_;
    }
    return out;
  }

  RefinedOutline left_alone(std::string_view reason) const {
    RefinedOutline out;
    out.state = RefinementState::left_alone, out.reason = reason, out.evidence = evidence_;
    return out;
  }

  const RefinedBuilding& building_;
  double bound_;
  Walls walls_;
  double reach_ = 0;   ///< m, of the curves
  double length_ = 0;  ///< m, of all walls that are seen
  Pose pose_;
  std::vector<Curve> curves_;  ///< by group, as the next two
  std::vector<Point2> directions_, middles_;
  struct Table {
    std::vector<double> unmoved, best;
  };
  std::vector<Table> tables_;  ///< by group
  std::vector<WallEvidence> evidence_;
  std::vector<std::uint32_t> groups_;  ///< of the evidence
  std::vector<double> shifts_;         ///< m, by group
  Rings outline_;
  bool spoils_ = false, too_many_ = false;
};

}  // namespace

RefinedOutline refine_edges(const RefinedBuilding& building, const ImageWindows& windows, double bound) {
  return Refiner(building, windows, bound).run();
}

}  // namespace blockrand::observation
