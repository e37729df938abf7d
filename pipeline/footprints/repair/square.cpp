#include "pipeline/footprints/repair/square.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "pipeline/base/portable_math.h"
#include "pipeline/footprints/repair/directions.h"
#include "pipeline/footprints/repair/ring_frames.h"
#include "pipeline/footprints/repair/square_system.h"
#include "pipeline/model/vector.h"

namespace blockrand::repair {

namespace {

using model::Point2;

constexpr double kStrong = 1e6;        // weight of what must hold, against 1 for what one footprint says
constexpr double kCurveStiffness = 4;  // weight of the differences of a curve's corners
constexpr double kRightCross = 0.5;    // sine of 30 degrees: two lines that meet flatter do not tell where they meet
constexpr double kRounding = 0.001;    // m. What rounding to the grid may add to a shift
constexpr double kShiftDeviations =
    4;                                 // corners that would move by more of their standard deviations contradict a wall
constexpr double kShiftFloor = 0.005;  // m, added to that
constexpr double kFixedOff = 0.0002;   // m. Fixed corners that a wall of given direction may miss
constexpr int kSoftRounds = 8;         // then only the bound of the options counts,
constexpr int kHardRounds = 8;         // then whole neighbourhoods are given up

/// Where a corner is: base + unknown[u0] g0 + unknown[u1] g1, with as many terms as it is free to move.
struct Place {
  Point2 base;
  std::uint32_t size = 0;
  std::uint32_t unknown[2] = {};
  Point2 g[2];
};

/// A wall line at a corner.
struct Incidence {
  std::uint32_t corner, line;
  friend auto operator<=>(const Incidence&, const Incidence&) = default;
};

/// One connected row.
class Squaring {
 public:
  Squaring(TerraceGraph& graph, std::span<const std::uint32_t> rings, const RepairOptions& options,
           std::vector<std::uint32_t>& local)
      : graph_(graph), options_(options), local_(local), told_(find_directions(graph, rings)) {
    for (const std::uint32_t r : rings)
      for (const std::uint32_t c : graph.rings[r].corners) corners_.push_back(c);
    std::sort(corners_.begin(), corners_.end());
    corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
    if (corners_.empty()) return;
    origin_ = graph.corners[corners_.front()].start;
    for (std::uint32_t i = 0; i < corners_.size(); ++i) {
      local_[corners_[i]] = i;
      const Corner& c = graph.corners[corners_[i]];
      start_.push_back(c.start - origin_);
      evidence_.push_back(corner_evidence(c) - origin_);
      weight_.push_back(corner_weight(c));
    }
    for (WallLine& l : told_.row.lines)
      for (std::uint32_t& c : l.corners) c = local_[c];
  }

  void run() {
    position_ = start_;
    for (int round = 0; round < kSoftRounds + kHardRounds; ++round) {
      if (!solve()) break;
      if (!release(round < kSoftRounds, false)) {
        write();
        return;
      }
    }
    while (solve())
      if (!release(false, true)) {
        write();
        return;
      }
    position_ = start_;
    for (WallLine& l : told_.row.lines) l.frame = kNoFrame;
    write();
  }

  void tell(std::vector<double>& direction) const {
    std::vector<bool> squared(told_.row.buildings.size(), false);
    for (const WallLine& l : told_.row.lines)
      for (const std::uint32_t b : l.buildings)
        if (l.frame != kNoFrame && l.frame == told_.main_frame[b]) squared[b] = true;
    for (std::size_t b = 0; b < squared.size(); ++b) {
      if (!squared[b]) continue;
      const Point2 axis = told_.frames[told_.main_frame[b]];
      const double degrees = base::atan2(axis.y, axis.x) * base::kDegreesPerRadian;
      direction[told_.row.buildings[b]] = degrees > 0 && degrees < 90 ? 90 - degrees : 0;
    }
  }

 private:
  Point2 normal(const WallLine& l) const { return axis_of(told_.frames[l.frame], !l.across); }

  void write() {
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      Corner& c = graph_.corners[corners_[i]];
      c.position = position_[i] == start_[i] ? c.start : position_[i] + origin_;
    }
  }

  /// Lines of one direction that meet in a corner are one line: `whole_[l]` is the least of them.
  void join_lines() {
    at_.clear();
    for (std::uint32_t l = 0; l < told_.row.lines.size(); ++l)
      if (told_.row.lines[l].frame != kNoFrame)
        for (const std::uint32_t c : told_.row.lines[l].corners) at_.push_back({c, l});
    std::sort(at_.begin(), at_.end());
    at_first_.assign(corners_.size() + 1, 0);
    for (const Incidence& i : at_) ++at_first_[i.corner + 1];
    for (std::size_t c = 0; c < corners_.size(); ++c) at_first_[c + 1] += at_first_[c];
    whole_.resize(told_.row.lines.size());
    std::iota(whole_.begin(), whole_.end(), 0u);
    const auto find = [&](std::uint32_t i) {
      while (whole_[i] != i) i = whole_[i] = whole_[whole_[i]];
      return i;
    };
    for (std::size_t c = 0; c < corners_.size(); ++c)
      for (std::uint32_t i = at_first_[c]; i < at_first_[c + 1]; ++i)
        for (std::uint32_t j = i + 1; j < at_first_[c + 1]; ++j) {
          const WallLine &a = told_.row.lines[at_[i].line], &b = told_.row.lines[at_[j].line];
          if (a.frame != b.frame || a.across != b.across) continue;
          const std::uint32_t p = find(at_[i].line), q = find(at_[j].line);
          whole_[std::max(p, q)] = std::min(p, q);
        }
    for (std::uint32_t l = 0; l < whole_.size(); ++l) whole_[l] = find(l);
  }

  /// Walls of given direction through two fixed corners that do not have it lose it. True when there was one.
  bool release_fixed() {
    bool any = false;
    for (WallLine& l : told_.row.lines) {
      if (l.frame == kNoFrame) continue;
      const Point2 n = normal(l);
      double low = 1e300, high = -1e300;
      for (const std::uint32_t c : l.corners)
        if (graph_.corners[corners_[c]].fixed)
          low = std::min(low, dot(n, start_[c])), high = std::max(high, dot(n, start_[c]));
      if (high - low > kFixedOff) l.frame = kNoFrame, any = true;
    }
    return any;
  }

  void place_corners() {
    unknowns_ = 0;
    line_unknown_.assign(told_.row.lines.size(), kNoFrame);
    for (std::uint32_t l = 0; l < told_.row.lines.size(); ++l)
      if (told_.row.lines[l].frame != kNoFrame && whole_[l] == l) line_unknown_[l] = unknowns_++;
    line_unknowns_ = unknowns_;
    for (std::uint32_t l = 0; l < told_.row.lines.size(); ++l) line_unknown_[l] = line_unknown_[whole_[l]];
    places_.assign(corners_.size(), {});
    pair_.assign(corners_.size(), {kNoFrame, kNoFrame});
    for (std::uint32_t c = 0; c < corners_.size(); ++c) {
      Place& p = places_[c];
      if (graph_.corners[corners_[c]].fixed) {
        p.base = start_[c];
        continue;
      }
      // The two lines that meet most nearly at a right angle; one, where all are about parallel.
      std::uint32_t first = kNoFrame, second = kNoFrame;
      double best = kRightCross;
      for (std::uint32_t i = at_first_[c]; i < at_first_[c + 1]; ++i) {
        const WallLine& a = told_.row.lines[at_[i].line];
        if (first == kNoFrame || (second == kNoFrame && a.weight > told_.row.lines[first].weight)) first = at_[i].line;
        for (std::uint32_t j = i + 1; j < at_first_[c + 1]; ++j) {
          const Point2 m = normal(told_.row.lines[at_[j].line]), n = normal(a);
          const double cross = std::fabs(n.x * m.y - n.y * m.x);
          if (cross > best) best = cross, first = at_[i].line, second = at_[j].line;
        }
      }
      pair_[c] = {first, second};
      if (first == kNoFrame) {
        p.size = 2;
        p.unknown[0] = unknowns_++, p.unknown[1] = unknowns_++;
        p.g[0] = {1, 0}, p.g[1] = {0, 1};
      } else if (second == kNoFrame) {
        const Point2 n = normal(told_.row.lines[first]);
        p.size = 2;
        p.unknown[0] = line_unknown_[first], p.unknown[1] = unknowns_++;
        p.g[0] = n, p.g[1] = {-n.y, n.x};
      } else {
        const Point2 n = normal(told_.row.lines[first]), m = normal(told_.row.lines[second]);
        const double det = n.x * m.y - n.y * m.x;
        p.size = 2;
        p.unknown[0] = line_unknown_[first], p.unknown[1] = line_unknown_[second];
        p.g[0] = {m.y / det, -m.x / det}, p.g[1] = {-n.y / det, n.x / det};
      }
    }
  }

  /// Adds factor * direction . corner to the equation.
  void add(Equation& e, std::uint32_t corner, Point2 direction) const {
    const Place& p = places_[corner];
    e.value -= dot(direction, p.base);
    for (std::uint32_t k = 0; k < p.size; ++k) {
      const double f = dot(direction, p.g[k]);
      if (f != 0) e.add(p.unknown[k], f);
    }
  }

  void hold_to_evidence() {
    for (std::uint32_t c = 0; c < corners_.size(); ++c) {
      const auto [first, second] = pair_[c];
      for (std::uint32_t i = at_first_[c]; i < at_first_[c + 1]; ++i) {
        const std::uint32_t l = at_[i].line, u = line_unknown_[l];
        if (places_[c].size > 0 &&
            ((first != kNoFrame && u == line_unknown_[first]) || (second != kNoFrame && u == line_unknown_[second])))
          continue;
        Equation e;  // the corner lies on this line, too
        e.weight = kStrong;
        add(e, c, normal(told_.row.lines[l]));
        e.add(u, -1);
        equations_.push_back(e);
      }
      if (places_[c].size == 0) continue;
      // In the axes of its lines: what depends on one line alone then ties it to no other.
      Point2 x{1, 0}, y{0, 1};
      if (first != kNoFrame) x = normal(told_.row.lines[first]), y = {-x.y, x.x};
      if (second != kNoFrame && told_.row.lines[first].frame == told_.row.lines[second].frame)
        y = normal(told_.row.lines[second]);
      for (const Point2 d : {x, y}) {
        Equation e;
        e.weight = weight_[c];
        e.value = dot(d, evidence_[c]);
        if (first != kNoFrame && d == x) {
          e.add(places_[c].unknown[0], 1);
        } else if (second != kNoFrame && d == y && told_.row.lines[first].frame == told_.row.lines[second].frame) {
          e.add(places_[c].unknown[1], 1);
        } else {
          add(e, c, d);
        }
        equations_.push_back(e);
      }
    }
  }

  /// Pieces of a wall without a direction stay in line, corners of a curve together. True when there is a wall of
  /// pieces.
  bool hold_shapes() {
    bool pieces = false;
    for (const RingWall& w : told_.row.walls) {
      const WallLine& line = told_.row.lines[w.line];
      if (line.frame != kNoFrame) continue;
      const auto& ring = graph_.rings[w.ring].corners;
      const auto corner = [&](std::uint32_t k) { return local_[ring[(w.first + k) % ring.size()]]; };
      const std::uint32_t a = corner(0), b = corner(w.count);
      if (line.free) {
        for (const Point2 d : {Point2{1, 0}, Point2{0, 1}}) {
          Equation e;
          e.weight = kCurveStiffness;
          e.value = dot(d, evidence_[b] - evidence_[a]);
          add(e, b, d), add(e, a, {-d.x, -d.y});
          equations_.push_back(e);
        }
      }
      const Point2 chord = position_[b] - position_[a];
      const double length = model::length(chord);
      if (length <= 0) continue;
      const Point2 n{-chord.y / length, chord.x / length};
      for (std::uint32_t k = 1; k < w.count; ++k) {
        const std::uint32_t c = corner(k);
        const double t = dot(position_[c] - position_[a], chord) / (length * length);
        Equation e;
        e.weight = kStrong;
        add(e, c, n), add(e, a, (t - 1) * n), add(e, b, -t * n);
        equations_.push_back(e);
        pieces = true;
      }
    }
    return pieces;
  }

  /// False when no wall has a direction (any more): everything stays at its start.
  bool solve() {
    while (release_fixed()) {
    }
    join_lines();
    if (at_.empty()) return false;
    place_corners();
    position_ = start_;
    for (int pass = 0; pass < 3; ++pass) {
      equations_.clear();
      hold_to_evidence();
      const bool pieces = hold_shapes();
      solution_ = solve_least_squares(equations_, unknowns_);
      for (std::uint32_t c = 0; c < corners_.size(); ++c) {
        const Place& p = places_[c];
        // Groups are named by their least unknown, and lines come first.
        const bool held =
            p.size > 0 && std::min(solution_.group[p.unknown[0]], solution_.group[p.unknown[1]]) < line_unknowns_;
        if (!held) {
          position_[c] = start_[c];
          continue;
        }
        position_[c] = p.base;
        for (std::uint32_t k = 0; k < p.size; ++k)
          position_[c] = position_[c] + solution_.unknown[p.unknown[k]] * p.g[k];
      }
      if (!pieces) break;  // the only equations that depend on where corners are
    }
    return true;
  }

  bool too_far(std::uint32_t c, bool soft) const {
    const Corner& corner = graph_.corners[corners_[c]];
    if (soft && length(position_[c] - evidence_[c]) >
                    kShiftDeviations * told_.noise / std::sqrt(std::min(weight_[c], 4.0)) + kShiftFloor)
      return position_[c] != start_[c];
    const auto far_from = [&](Point2 p) {
      const double allowed = std::max(options_.max_shift - kRounding, length(corner.start - p));
      return length(position_[c] + origin_ - p) > allowed + 1e-9;
    };
    if (corner.said.empty()) return far_from(corner.start);
    return std::any_of(corner.said.begin(), corner.said.end(), far_from);
  }

  /// The line through corner c, but not through `without`, that is farthest from what is said of c; kNoFrame for none.
  std::uint32_t worst_line(std::uint32_t c, std::uint32_t without, double& most) const {
    std::uint32_t worst = kNoFrame;
    for (std::uint32_t i = at_first_[c]; i < at_first_[c + 1]; ++i) {
      const WallLine& l = told_.row.lines[at_[i].line];
      if (std::find(l.corners.begin(), l.corners.end(), without) != l.corners.end()) continue;
      const double off = std::fabs(dot(normal(l), position_[c] - evidence_[c]));
      if (off > most) most = off, worst = at_[i].line;
    }
    return worst;
  }

  /// Takes their direction from the lines that move a corner too far or turn an edge back; with `all`, from all lines
  /// that are tied to such a corner. False when there was nothing to do.
  bool release(bool soft, bool all) {
    std::vector<std::uint32_t> lines;
    std::vector<bool> groups(all ? unknowns_ : 0, false);
    const auto give_up = [&](std::uint32_t c) {
      for (std::uint32_t k = 0; all && k < places_[c].size; ++k) groups[solution_.group[places_[c].unknown[k]]] = true;
    };
    bool any = false;
    for (std::uint32_t c = 0; c < corners_.size(); ++c) {
      if (!too_far(c, soft)) continue;
      any = true;
      give_up(c);
      double most = -1;
      const std::uint32_t worst = worst_line(c, kNoFrame, most);
      if (worst == kNoFrame) continue;
      // With the pieces of one direction that it is joined with here.
      for (std::uint32_t i = at_first_[c]; i < at_first_[c + 1]; ++i)
        if (whole_[at_[i].line] == whole_[worst]) lines.push_back(at_[i].line);
    }
    for (const RingWall& w : told_.row.walls) {
      const auto& ring = graph_.rings[w.ring].corners;
      for (std::uint32_t k = 0; k < w.count; ++k) {
        const std::uint32_t a = local_[ring[(w.first + k) % ring.size()]],
                            b = local_[ring[(w.first + k + 1) % ring.size()]];
        if (dot(position_[b] - position_[a], start_[b] - start_[a]) > 0 || start_[a] == start_[b]) continue;
        any = true;
        give_up(a), give_up(b);
        double most = -1;
        std::uint32_t worst = worst_line(a, b, most);
        const std::uint32_t other = worst_line(b, a, most);
        if (other != kNoFrame) worst = other;
        if (worst != kNoFrame) lines.push_back(worst);
      }
    }
    if (all)
      for (std::uint32_t l = 0; l < told_.row.lines.size(); ++l)
        if (told_.row.lines[l].frame != kNoFrame && groups[solution_.group[line_unknown_[l]]]) lines.push_back(l);
    for (const std::uint32_t l : lines) told_.row.lines[l].frame = kNoFrame;
    // Too far, but no line to blame: a corner that others pull. The last resort takes the whole group.
    return any && (all ? !lines.empty() : true);
  }

  TerraceGraph& graph_;
  const RepairOptions& options_;
  std::vector<std::uint32_t>& local_;  // per corner of the graph: index into corners_
  TerraceDirections told_;             // lines' corners are indices into corners_
  std::vector<std::uint32_t> corners_;
  Point2 origin_;
  std::vector<Point2> start_, evidence_, position_;  // m, relative to origin_
  std::vector<double> weight_;
  std::vector<Incidence> at_;  // lines with a direction, by corner
  std::vector<std::uint32_t> at_first_;
  std::vector<std::uint32_t> whole_, line_unknown_;
  std::vector<Place> places_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pair_;  // per corner: the lines that place it
  std::uint32_t unknowns_ = 0, line_unknowns_ = 0;
  std::vector<Equation> equations_;
  Solution solution_;
};

}  // namespace

void square_terrace_row(TerraceGraph& graph, const TerraceRow& row, const RepairOptions& options,
                        std::vector<double>& direction) {
  direction.assign(row.buildings.size(), -1);
  std::vector<std::uint32_t> local(graph.corners.size(), 0);
  for (const auto& rings : connected_rings(graph, row.buildings.size())) {
    Squaring squaring(graph, rings, options, local);
    squaring.run();
    squaring.tell(direction);
  }
}

}  // namespace blockrand::repair
