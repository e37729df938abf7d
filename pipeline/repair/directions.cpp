#include "pipeline/repair/directions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "pipeline/repair/arcs.h"

namespace blockrand::repair {

namespace {

using model::Point2;

constexpr double kLeastNoise = 0.004;     // m. OSM's grid of 11 mm has a standard deviation of 3 mm
constexpr double kLargestNoise = 0.16;    // m. Walls off by more than half a metre are no slips of a mapper's hand
constexpr double kFirstNoise = 0.03;      // m. What is assumed before anything is known: a careful mapper
constexpr double kDeviations = 3.2;       // 1 in 700 of walls that belong to a frame is left out
constexpr double kMergeDeviations = 3.0;  // the same for frames of neighbours: 1 in 370
constexpr double kLargestTurn = 0.3826834323650898;  // sin 22.5 degrees: beyond, a wall is nearer to a diagonal
constexpr double kObliqueSine = 0.08715574274765817; // sin 5 degrees: long walls farther off are meant oblique
constexpr double kObliqueFrom = 6, kObliqueLength = 8;  // m. From here on that begins to hold, and holds
constexpr double kMainShare = 0.4;        // of a building's wall length that its frame must explain
constexpr std::size_t kWingWalls = 3;     // a wing has at least this many walls of its own,
constexpr double kWingLength = 8;         // m, which are together at least this long
constexpr std::size_t kMostFrames = 3;    // of a building
constexpr double kTellingLength = 1.5;    // m. Shorter walls cannot deviate enough to tell of the noise
constexpr std::size_t kMostCandidates = 48;  // walls tried as the direction of a frame: the longest
constexpr double kBayTurn = 0.2079116908177593;  // sin 12 degrees: cheeks of bays deviate by more, both alike
constexpr double kBayCheek = 4;           // m. Longer ones are wings

double dot(Point2 a, Point2 b) { return a.x * b.x + a.y * b.y; }
double cross(Point2 a, Point2 b) { return a.x * b.y - a.y * b.x; }
Point2 minus(Point2 a, Point2 b) { return {a.x - b.x, a.y - b.y}; }
double norm(Point2 a) { return std::sqrt(dot(a, a)); }
Point2 unit(Point2 a) {
  const double n = norm(a);
  return n > 0 ? Point2{a.x / n, a.y / n} : Point2{1, 0};
}
/// The same direction modulo a quarter turn, with x > 0 and y >= 0.
Point2 first_quarter(Point2 u) {
  for (int k = 0; k < 3 && !(u.x > 0 && u.y >= 0); ++k) u = {u.y, -u.x};
  return u;
}
/// Sine of the angle from the nearer axis of `frame` to `v`, counter-clockwise; within +-sin 45 degrees.
double turn_off(Point2 frame, Point2 v) {
  const double c = dot(frame, v), s = cross(frame, v);
  if (std::fabs(s) <= std::fabs(c)) return c >= 0 ? s : -s;
  return s >= 0 ? -c : c;
}

struct Groups {
  std::vector<std::uint32_t> parent;
  explicit Groups(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0u); }
  std::uint32_t find(std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    parent[std::max(a, b)] = std::min(a, b);
  }
};

class Reader {
 public:
  Reader(const RowGraph& graph, std::span<const std::uint32_t> rings) : graph_(graph), rings_(rings) {
    for (const std::uint32_t r : rings) {
      const std::uint32_t b = graph.rings[r].building;
      if (out_.buildings.empty() || out_.buildings.back() != b) out_.buildings.push_back(b);
    }
    out_.main_frame.assign(out_.buildings.size(), kNoFrame);
    lines_of_.resize(out_.buildings.size());
  }

  RowDirections read() {
    split_rings();
    join_shared();
    fit_lines();
    mark_curves();
    for (std::uint32_t l = 0; l < out_.lines.size(); ++l)
      if (!out_.lines[l].free)
        for (const std::uint32_t b : out_.lines[l].buildings) lines_of_[b].push_back(l);
    estimate_noise();
    find_frames();
    merge_frames();
    give_directions();
    spare_bays();
    return std::move(out_);
  }

 private:
  struct Frame {
    std::uint32_t building;
    Point2 axis;
    double weight;  // m², of its lines
  };

  void split_rings() {
    for (const std::uint32_t r : rings_) {
      const auto& wall = graph_.rings[r].wall;
      const auto n = static_cast<std::uint32_t>(wall.size());
      std::uint32_t start = n;
      for (std::uint32_t i = 0; i < n && start == n; ++i)
        if (wall[i] != wall[(i + n - 1) % n]) start = i;
      for (std::uint32_t i = 0; i < n;) {
        std::uint32_t j = i + 1;
        while (start < n && j < n && wall[(start + j) % n] == wall[(start + i) % n]) ++j;
        out_.walls.push_back({r, (start + i) % n, j - i, 0});
        i = j;
      }
    }
  }

  std::uint32_t corner(const RingWall& w, std::uint32_t k) const {
    const auto& corners = graph_.rings[w.ring].corners;
    return corners[(w.first + k) % corners.size()];
  }

  void join_shared() {
    Groups groups(out_.walls.size());
    if (rings_.size() > 1) {
      std::vector<std::array<std::uint32_t, 3>> edges;  // lower corner, higher corner, wall
      for (std::uint32_t w = 0; w < out_.walls.size(); ++w)
        for (std::uint32_t k = 0; k < out_.walls[w].count; ++k) {
          const std::uint32_t a = corner(out_.walls[w], k), b = corner(out_.walls[w], k + 1);
          edges.push_back({std::min(a, b), std::max(a, b), w});
        }
      std::sort(edges.begin(), edges.end());
      for (std::size_t e = 1; e < edges.size(); ++e)
        if (edges[e][0] == edges[e - 1][0] && edges[e][1] == edges[e - 1][1]) groups.join(edges[e - 1][2], edges[e][2]);
    }
    std::vector<std::uint32_t> line(out_.walls.size());
    std::uint32_t building = 0;
    for (std::uint32_t w = 0; w < out_.walls.size(); ++w) {
      while (out_.buildings[building] != graph_.rings[out_.walls[w].ring].building) ++building;
      const std::uint32_t root = groups.find(w);
      if (root == w) {
        line[w] = static_cast<std::uint32_t>(out_.lines.size());
        out_.lines.emplace_back();
      }
      out_.walls[w].line = line[root];
      WallLine& l = out_.lines[line[root]];
      for (std::uint32_t k = 0; k <= out_.walls[w].count; ++k) l.corners.push_back(corner(out_.walls[w], k));
      l.buildings.push_back(building);
    }
  }

  void fit_lines() {
    for (WallLine& l : out_.lines) {
      std::sort(l.buildings.begin(), l.buildings.end());
      l.buildings.erase(std::unique(l.buildings.begin(), l.buildings.end()), l.buildings.end());
      if (l.corners.size() == 2) {
        const Corner &a = graph_.corners[l.corners[0]], &b = graph_.corners[l.corners[1]];
        const Point2 d = minus(corner_evidence(b), corner_evidence(a));
        const double ka = corner_weight(a), kb = corner_weight(b);
        l.length = norm(d);
        l.along = unit(d);
        l.weight = ka * kb / (ka + kb) * l.length * l.length;
        continue;
      }
      fit_long_line(l);
    }
  }

  /// Weighted regression across the chord between its outermost corners.
  void fit_long_line(WallLine& l) {
    std::sort(l.corners.begin(), l.corners.end());
    l.corners.erase(std::unique(l.corners.begin(), l.corners.end()), l.corners.end());
    const auto start = [&](std::uint32_t c) { return graph_.corners[c].start; };
    const auto farthest = [&](std::uint32_t from) {
      std::uint32_t best = from;
      double most = -1;
      for (const std::uint32_t c : l.corners) {
        const Point2 d = minus(start(c), start(from));
        if (dot(d, d) > most) most = dot(d, d), best = c;
      }
      return best;
    };
    const std::uint32_t a = farthest(l.corners.front()), b = farthest(a);
    const Point2 e = unit(minus(start(b), start(a)));
    const Point2 origin = start(a);
    std::sort(l.corners.begin(), l.corners.end(), [&](std::uint32_t p, std::uint32_t q) {
      const double tp = dot(minus(start(p), origin), e), tq = dot(minus(start(q), origin), e);
      return tp != tq ? tp < tq : p < q;
    });
    l.length = dot(minus(start(b), origin), e);
    double k = 0, t = 0, r = 0;
    for (const std::uint32_t c : l.corners) {
      const double w = corner_weight(graph_.corners[c]);
      const Point2 d = minus(corner_evidence(graph_.corners[c]), origin);
      k += w, t += w * dot(d, e), r += w * cross(e, d);
    }
    t /= k, r /= k;
    double tt = 0, tr = 0;
    for (const std::uint32_t c : l.corners) {
      const double w = corner_weight(graph_.corners[c]);
      const Point2 d = minus(corner_evidence(graph_.corners[c]), origin);
      tt += w * (dot(d, e) - t) * (dot(d, e) - t), tr += w * (dot(d, e) - t) * (cross(e, d) - r);
    }
    const double slope = tt > 0 ? tr / tt : 0;
    l.along = unit({e.x - slope * e.y, e.y + slope * e.x});
    l.weight = tt;
  }

  void mark_curves() {
    std::vector<Point2> points;
    for (std::size_t w = 0; w < out_.walls.size();) {
      std::size_t end = w;
      points.clear();
      for (; end < out_.walls.size() && out_.walls[end].ring == out_.walls[w].ring; ++end)
        points.push_back(graph_.corners[corner(out_.walls[end], 0)].start);
      for (const ArcRun& run : find_arc_runs(points))
        for (std::uint32_t k = 0; k < run.count; ++k)
          out_.lines[out_.walls[w + (run.first + k) % points.size()].line].free = true;
      w = end;
    }
  }

  /// Sine of the angle that a line may be off a frame.
  double limit(const WallLine& l) const {
    const double sigma = out_.noise / std::sqrt(l.weight);
    const double certain = std::clamp((l.length - kObliqueFrom) / (kObliqueLength - kObliqueFrom), 0.0, 1.0);
    const double oblique = l.length < kObliqueLength
                               ? (kObliqueSine * kObliqueLength / std::max(l.length, 1e-3)) - certain * sigma
                               : kObliqueSine - sigma;
    return std::min({kDeviations * sigma, oblique, kLargestTurn});
  }

  /// The direction that most length of the lines agrees with: the line with the highest score under `kernel`, a function
  /// of (line, sine off) in [0, 1], then improved by reweighted least squares.
  template <class Kernel>
  Point2 mode(const std::vector<std::uint32_t>& lines, const Kernel& kernel) {
    candidates_ = lines;
    if (candidates_.size() > kMostCandidates) {
      std::stable_sort(candidates_.begin(), candidates_.end(),
                       [&](std::uint32_t a, std::uint32_t b) { return out_.lines[a].length > out_.lines[b].length; });
      candidates_.resize(kMostCandidates);
    }
    Point2 best{1, 0};
    double best_score = -1;
    for (const std::uint32_t c : candidates_) {
      const Point2 axis = out_.lines[c].along;
      double score = 0;
      for (const std::uint32_t l : lines) {
        const WallLine& line = out_.lines[l];
        score += line.length * kernel(line, turn_off(axis, line.along));
      }
      if (score > best_score) best_score = score, best = axis;
    }
    for (int round = 0; round < 8; ++round) {
      double weight = 0, turn = 0;
      for (const std::uint32_t l : lines) {
        const WallLine& line = out_.lines[l];
        const double off = turn_off(best, line.along), w = line.weight * kernel(line, off);
        weight += w, turn += w * off;
      }
      if (weight <= 0) break;
      turn /= weight;
      best = unit({best.x - turn * best.y, best.y + turn * best.x});
      if (std::fabs(turn) < 1e-9) break;
    }
    return first_quarter(best);
  }

  void estimate_noise() {
    out_.noise = kFirstNoise;
    std::vector<double> off;
    for (int round = 0; round < 3; ++round) {
      const double width = 2 * out_.noise;
      // Heavy tails: nothing is known yet about which walls belong to a frame.
      const auto cauchy = [&](const WallLine& l, double sine) {
        const double z = sine * std::sqrt(l.weight) / width;
        return 1 / (1 + z * z);
      };
      off.clear();
      double freedom = 0;
      for (const auto& lines : lines_of_) {
        if (lines.empty()) continue;
        const Point2 axis = mode(lines, cauchy);
        freedom -= 1;
        for (const std::uint32_t l : lines) {
          const WallLine& line = out_.lines[l];
          if (line.length < kTellingLength) continue;
          off.push_back(std::fabs(turn_off(axis, line.along)) * std::sqrt(line.weight));
          freedom += 1 / static_cast<double>(line.buildings.size());
        }
      }
      if (off.empty()) return;
      const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
      std::nth_element(off.begin(), middle, off.end());
      const double estimate = 1.4826 * (1 + 5 / std::max(freedom, 1.0)) * *middle;
      out_.noise = std::clamp(estimate, kLeastNoise, kLargestNoise);
    }
  }

  void find_frames() {
    const auto tukey = [&](const WallLine& l, double sine) {
      const double z = sine / limit(l);
      return z * z < 1 ? (1 - z * z) * (1 - z * z) : 0.0;
    };
    std::vector<std::uint32_t> left, next;
    for (std::uint32_t b = 0; b < lines_of_.size(); ++b) {
      double total = 0;
      for (const std::uint32_t l : lines_of_[b]) total += out_.lines[l].length;
      left = lines_of_[b];
      for (std::size_t k = 0; k < kMostFrames && left.size() >= 2; ++k) {
        const Point2 axis = mode(left, tukey);
        double length = 0, weight = 0, along = 0, across = 0;
        std::size_t count = 0;
        next.clear();
        for (const std::uint32_t l : left) {
          const WallLine& line = out_.lines[l];
          if (std::fabs(turn_off(axis, line.along)) > limit(line)) {
            next.push_back(l);
            continue;
          }
          ++count, length += line.length, weight += line.weight;
          (std::fabs(dot(axis, line.along)) > std::fabs(cross(axis, line.along)) ? along : across) += line.length;
        }
        const bool strong = k == 0 ? count >= 2 && length >= kMainShare * total
                                   : count >= kWingWalls && length >= kWingLength && along > 0 && across > 0;
        if (!strong) break;
        if (k == 0) out_.main_frame[b] = static_cast<std::uint32_t>(frames_.size());
        frames_.push_back({b, axis, weight});
        std::swap(left, next);
      }
    }
  }

  /// Of two frames: by how many standard deviations they differ, squared.
  double difference(const Frame& a, const Frame& b) const {
    const double off = turn_off(a.axis, b.axis);
    return off * off / (out_.noise * out_.noise * (1 / a.weight + 1 / b.weight));
  }

  void merge_frames() {
    Groups groups(frames_.size());
    std::vector<Frame> merged = frames_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    std::vector<std::uint32_t> first(lines_of_.size() + 1, static_cast<std::uint32_t>(frames_.size()));
    for (std::size_t f = frames_.size(); f-- > 0;) first[frames_[f].building] = static_cast<std::uint32_t>(f);
    for (const WallLine& l : out_.lines)
      for (std::size_t i = 0; i < l.buildings.size(); ++i)
        for (std::size_t j = i + 1; j < l.buildings.size(); ++j)
          for (std::uint32_t f = first[l.buildings[i]]; f < frames_.size() && frames_[f].building == l.buildings[i]; ++f)
            for (std::uint32_t g = first[l.buildings[j]]; g < frames_.size() && frames_[g].building == l.buildings[j]; ++g)
              pairs.emplace_back(f, g);
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    struct Step {
      double difference;
      std::uint32_t a, b;
      bool operator<(const Step& o) const {
        return difference != o.difference ? difference < o.difference : std::pair(a, b) < std::pair(o.a, o.b);
      }
    };
    std::vector<Step> steps;
    // In every round the more alike half of the pairs is merged, so that groups grow evenly: a single long chain would
    // drift along a bent row.
    for (bool again = true; again;) {
      again = false;
      steps.clear();
      for (const auto& [f, g] : pairs) {
        const std::uint32_t a = groups.find(f), b = groups.find(g);
        if (a == b) continue;
        const double d = difference(merged[a], merged[b]);
        if (d <= kMergeDeviations * kMergeDeviations) steps.push_back({d, std::min(a, b), std::max(a, b)});
      }
      std::sort(steps.begin(), steps.end());
      std::vector<bool> touched(frames_.size(), false);
      for (const Step& s : steps) {
        if (touched[s.a] || touched[s.b]) continue;
        touched[s.a] = touched[s.b] = true;
        Frame &a = merged[s.a], &b = merged[s.b];
        const double turn = turn_off(a.axis, b.axis) * b.weight / (a.weight + b.weight);
        a.axis = first_quarter(unit({a.axis.x - turn * a.axis.y, a.axis.y + turn * a.axis.x}));
        a.weight += b.weight;
        groups.join(s.a, s.b);
        again = true;
      }
    }
    group_.resize(frames_.size());
    for (std::uint32_t f = 0; f < frames_.size(); ++f) group_[f] = groups.find(f);
    for (const Frame& f : merged) out_.frames.push_back(f.axis);
    for (std::uint32_t& f : out_.main_frame)
      if (f != kNoFrame) f = group_[f];
  }

  void give_directions() {
    std::vector<std::vector<std::uint32_t>> of_building(lines_of_.size());
    for (std::uint32_t f = 0; f < frames_.size(); ++f) of_building[frames_[f].building].push_back(group_[f]);
    for (WallLine& l : out_.lines) {
      if (l.free || l.length <= 0) continue;
      double least = limit(l);
      for (const std::uint32_t b : l.buildings)
        for (const std::uint32_t f : of_building[b]) {
          const Point2 axis = out_.frames[f];
          const double off = std::fabs(turn_off(axis, l.along));
          if (off > least || (off == least && l.frame != kNoFrame)) continue;
          least = off;
          l.frame = f;
          l.across = std::fabs(dot(axis, l.along)) < std::fabs(cross(axis, l.along));
        }
    }
  }

  /// Cheeks of a bay: two short walls, one wall apart, off by alike angles to opposite sides. A pair of slips of the
  /// mouse would rarely be so alike.
  void spare_bays() {
    std::vector<std::uint32_t> cheeks;
    for (std::size_t w = 0; w < out_.walls.size();) {
      std::size_t end = w;
      while (end < out_.walls.size() && out_.walls[end].ring == out_.walls[w].ring) ++end;
      const std::size_t n = end - w;
      for (std::size_t i = 0; n > 4 && i < n; ++i) {
        const std::uint32_t a = out_.walls[w + i].line, m = out_.walls[w + (i + 1) % n].line,
                            b = out_.walls[w + (i + 2) % n].line;
        const WallLine &la = out_.lines[a], &lm = out_.lines[m], &lb = out_.lines[b];
        if (la.frame == kNoFrame || lb.frame != la.frame || lm.frame != la.frame || la.across != lb.across) continue;
        if (la.length > kBayCheek || lb.length > kBayCheek) continue;
        const double p = turn_off(out_.frames[la.frame], la.along), q = turn_off(out_.frames[lb.frame], lb.along);
        const double low = std::min(std::fabs(p), std::fabs(q)), high = std::max(std::fabs(p), std::fabs(q));
        if (p * q < 0 && low > kBayTurn && high < 2 * low) cheeks.push_back(a), cheeks.push_back(b);
      }
      w = end;
    }
    for (const std::uint32_t l : cheeks) out_.lines[l].frame = kNoFrame;
  }

  const RowGraph& graph_;
  std::span<const std::uint32_t> rings_;
  RowDirections out_;
  std::vector<std::vector<std::uint32_t>> lines_of_;  // per building
  std::vector<Frame> frames_;                         // by building
  std::vector<std::uint32_t> group_;                  // per frame: which frame stands for it
  std::vector<std::uint32_t> candidates_;
};

}  // namespace

double corner_weight(const Corner& corner) {
  return corner.said.empty() ? 0.25 : static_cast<double>(corner.said.size());
}

Point2 corner_evidence(const Corner& corner) {
  if (corner.said.size() < 2) return corner.said.empty() ? corner.start : corner.said.front();
  Point2 mean;
  for (const Point2 p : corner.said) mean.x += p.x - corner.start.x, mean.y += p.y - corner.start.y;
  const double n = static_cast<double>(corner.said.size());
  return {corner.start.x + mean.x / n, corner.start.y + mean.y / n};
}

RowDirections find_directions(const RowGraph& graph, std::span<const std::uint32_t> rings) {
  return Reader(graph, rings).read();
}

}  // namespace blockrand::repair
