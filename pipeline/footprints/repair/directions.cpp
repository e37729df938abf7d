#include "pipeline/footprints/repair/directions.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/base/portable_math.h"
#include "pipeline/footprints/repair/ring_frames.h"
#include "pipeline/footprints/repair/terrace_noise.h"

namespace blockrand::repair {

namespace {

using model::Point2;

constexpr double kUsualNoise = 0.02;                    // m, of careful mappers
constexpr double kDeviations = 3.2;                     // 1 in 700 of walls that belong to a frame is left out
constexpr double kDiagonal = 0.7071067811865476;        // sin 45 degrees: no wall is farther off a frame
constexpr double kLargestTurn = 0.3826834323650898;     // sin 22.5 degrees: beyond, a wall is nearer to a diagonal
constexpr double kObliqueSine = 0.08715574274765817;    // sin 5 degrees: long walls farther off are meant oblique
constexpr double kObliqueFrom = 6, kObliqueLength = 8;  // m. From here on that begins to hold, and holds
constexpr double kMainShare = 0.35;      // of a building's wall length that its frame must explain, beyond chance
constexpr double kWingWalls = 2.5;       // a wing has at least this many walls of its own, beyond chance,
constexpr double kWingLength = 8;        // m, which are together at least this long
constexpr std::size_t kMostFrames = 3;   // of a building
constexpr std::size_t kFamilyWalls = 4;  // walls that make a direction of the row, beyond chance,
constexpr double kFamilyDeviations =
    5;  // and by so many standard deviations of chance: the best of many directions is taken
constexpr std::size_t kMostFamilies = 4;         // of a row
constexpr double kTellingLength = 0.5;           // m. Shorter walls tell nothing of the noise
constexpr std::size_t kMostCandidates = 48;      // walls tried as the direction of a frame: the longest
constexpr int kMostRounds = 30;                  // of reweighted least squares,
constexpr double kStill = 1e-10;                 // which end at such a turn (radians)
constexpr double kBayTurn = 0.2079116908177593;  // sin 12 degrees: cheeks of bays deviate by more, both alike
constexpr double kBayCheek = 4;                  // m. Longer ones are wings

class Reader {
 public:
  explicit Reader(TerraceLines row) : lines_of_(row.buildings.size()) {
    out_.row = std::move(row);
    out_.main_frame.assign(lines_of_.size(), kNoFrame);
  }

  TerraceDirections read() {
    for (std::uint32_t l = 0; l < lines().size(); ++l)
      if (!lines()[l].free && lines()[l].length > 0)
        for (const std::uint32_t b : lines()[l].buildings) lines_of_[b].push_back({l, 0});
    estimate_noise();
    find_frames();
    find_families();
    count_all_frames();
    merge_frames();
    give_directions();
    spare_bays();
    return std::move(out_);
  }

 private:
  struct Member {
    std::uint32_t line;
    double limit;  // sine of the angle that it may be off its building's frame
  };
  std::vector<WallLine>& lines() { return out_.row.lines; }
  const std::vector<WallLine>& lines() const { return out_.row.lines; }

  /// Sine of how far a line may be off its building's frame: as long as it more likely belongs to it than not, and
  /// within kDeviations.
  double limit(const WallLine& l, std::size_t building) const {
    const double sigma = told_.noise / std::sqrt(l.weight);
    const double odds = odds_of_frame(told_, building, l.weight);
    if (odds <= 1) return 0;
    const double likely = std::sqrt(2 * base::log(odds));
    const double certain = std::clamp((l.length - kObliqueFrom) / (kObliqueLength - kObliqueFrom), 0.0, 1.0);
    const double oblique = kObliqueSine * std::max(1.0, kObliqueLength / l.length) - certain * sigma;
    return std::max(0.0, std::min({std::min(kDeviations, likely) * sigma, oblique, kLargestTurn}));
  }

  /// The direction that most length of the lines agrees with: the line with the highest score under `kernel`, a
  /// function of (member, sine off) in [0, 1], then improved by reweighted least squares.
  template <class Kernel>
  Point2 mode(const std::vector<Member>& members, const Kernel& kernel) {
    candidates_.clear();
    for (const Member& m : members) candidates_.push_back(m.line);
    if (candidates_.size() > kMostCandidates) {
      std::stable_sort(candidates_.begin(), candidates_.end(),
                       [&](std::uint32_t a, std::uint32_t b) { return lines()[a].length > lines()[b].length; });
      candidates_.resize(kMostCandidates);
    }
    Point2 best{1, 0};
    double best_score = -1;
    for (const std::uint32_t c : candidates_) {
      const Point2 axis = lines()[c].along;
      double score = 0;
      for (const Member& m : members)
        score += lines()[m.line].length * kernel(m, turn_off(axis, lines()[m.line].along));
      if (score > best_score) best_score = score, best = axis;
    }
    for (int round = 0; round < kMostRounds; ++round) {
      double weight = 0, turn = 0;
      for (const Member& m : members) {
        const double off = turn_off(best, lines()[m.line].along), w = lines()[m.line].weight * kernel(m, off);
        weight += w, turn += w * off;
      }
      if (weight <= 0) break;
      turn /= weight;
      best = turned(best, turn);
      if (std::fabs(turn) < kStill) break;
    }
    return first_quarter(best);
  }

  /// Frames and noise tell each other: found in turn, once from what a careful mapper does and once from what a
  /// careless one does. The likelier end counts.
  void estimate_noise() {
    TerraceNoise best;
    for (const double start : {kLeastNoise, kUsualNoise, kLargestNoise / 2}) {
      TerraceNoise told = noise_from(start);
      if (best.share.empty() || told.likelihood > best.likelihood) best = std::move(told);
    }
    told_ = std::move(best);
    out_.noise = told_.noise;
    set_limits();
  }

  void set_limits() {
    for (std::uint32_t b = 0; b < lines_of_.size(); ++b)
      for (Member& m : lines_of_[b]) m.limit = limit(lines()[m.line], b);
  }

  /// Walls of a wing or an oblique lot belong to a frame, too: the noise is told again, with all frames.
  void count_all_frames() {
    std::vector<std::vector<Point2>> axes(lines_of_.size());
    for (const Frame& f : frames_) axes[f.building].push_back(f.axis);
    if (std::all_of(axes.begin(), axes.end(), [](const auto& a) { return a.size() < 2; })) return;
    std::vector<Deviation> off;
    std::size_t frames = frames_.size();
    for (const auto& [begin, end] : families_) frames -= end - begin - 1;
    for (std::uint32_t b = 0; b < lines_of_.size(); ++b)
      for (const Member& m : lines_of_[b]) {
        const WallLine& line = lines()[m.line];
        double least = kDiagonal;
        for (const Point2 axis : axes[b]) least = std::min(least, std::fabs(turn_off(axis, line.along)));
        if (line.length >= kTellingLength) off.push_back(deviation(line, least, b));
      }
    const TerraceNoise all = fit_noise(off, lines_of_.size(), frames, told_.noise);
    told_.noise = std::max(told_.noise, all.noise);
    told_.share = all.share;
    out_.noise = told_.noise;
    set_limits();
  }
  static Deviation deviation(const WallLine& line, double sine, std::uint32_t building) {
    const double scale = std::sqrt(line.weight);
    return {std::fabs(sine) * scale, line.weight, 1 / static_cast<double>(line.buildings.size()), building};
  }

  /// Tukey's biweight: nothing beyond the limit counts.
  static double tukey(const Member& m, double sine) {
    const double z = sine * sine, most = m.limit * m.limit;
    return z < most ? (1 - z / most) * (1 - z / most) : 0.0;
  }

  TerraceNoise noise_from(double noise) {
    std::vector<Deviation> off;
    TerraceNoise told;
    for (int round = 0; round < 2; ++round) {
      // Heavy tails: it is not known yet which walls belong to a frame.
      const double width = 2 * noise;
      const auto cauchy = [&](const Member& m, double sine) {
        const double z = sine / width;
        return 1 / (1 + z * z * lines()[m.line].weight);
      };
      off.clear();
      for (std::uint32_t b = 0; b < lines_of_.size(); ++b) {
        if (lines_of_[b].empty()) continue;
        const Point2 axis = mode(lines_of_[b], cauchy);
        for (const Member& m : lines_of_[b]) {
          const WallLine& line = lines()[m.line];
          if (line.length < kTellingLength) continue;
          off.push_back(deviation(line, turn_off(axis, line.along), b));
        }
      }
      told = fit_noise(off, lines_of_.size(), lines_of_.size(), noise);
      noise = told.noise;
    }
    return told;
  }

  void find_frames() {
    std::vector<Member> left, next;
    for (std::uint32_t b = 0; b < lines_of_.size(); ++b) {
      left = lines_of_[b];
      for (std::size_t k = 0; k < kMostFrames && left.size() >= 2; ++k) {
        const Point2 axis = mode(left, tukey);
        double length = 0, weight = 0, along = 0, across = 0, all_length = 0, beyond_chance = 0, lucky_length = 0;
        std::size_t count = 0;
        next.clear();
        for (const Member& m : left) {
          const WallLine& line = lines()[m.line];
          const double chance = m.limit / kDiagonal;  // for a wall of any direction to be in the frame
          all_length += line.length, lucky_length += chance * line.length;
          if (std::fabs(turn_off(axis, line.along)) > m.limit) {
            next.push_back(m);
            continue;
          }
          ++count, length += line.length, weight += line.weight, beyond_chance += 1 - chance;
          (std::fabs(dot(axis, line.along)) > std::fabs(cross(axis, line.along)) ? along : across) += line.length;
        }
        const bool strong = k == 0 ? count >= 2 && length - lucky_length >= kMainShare * (all_length - lucky_length)
                                   : beyond_chance >= kWingWalls && length >= kWingLength && along > 0 && across > 0;
        if (!strong) break;
        if (k == 0) out_.main_frame[b] = static_cast<std::uint32_t>(frames_.size());
        frames_.push_back({b, axis, weight});
        std::swap(left, next);
      }
      for (const Member& m : left) left_.push_back(m);
    }
  }

  /// Directions that many walls of the row have, but no building enough of: party walls of lots that lie obliquely to
  /// their street. Every building with such a wall gets the direction as a frame; they are merged from the beginning.
  void find_families() {
    std::sort(left_.begin(), left_.end(),
              [](const Member& a, const Member& b) { return a.line != b.line ? a.line < b.line : a.limit < b.limit; });
    left_.erase(
        std::unique(left_.begin(), left_.end(), [](const Member& a, const Member& b) { return a.line == b.line; }),
        left_.end());
    std::vector<Member> next;
    for (std::size_t k = 0; k < kMostFamilies && left_.size() >= kFamilyWalls; ++k) {
      const Point2 axis = mode(left_, tukey);
      double beyond_chance = 0, lucky = 0, spread = 0;
      std::vector<std::pair<std::uint32_t, double>> of_building;  // and the weight of a line
      next.clear();
      for (const Member& m : left_) {
        const WallLine& line = lines()[m.line];
        const double chance = m.limit / kDiagonal;
        lucky += chance, spread += chance * (1 - chance);
        if (std::fabs(turn_off(axis, line.along)) > m.limit) {
          next.push_back(m);
          continue;
        }
        beyond_chance += 1 - chance;
        for (const std::uint32_t b : line.buildings) of_building.emplace_back(b, line.weight);
      }
      const double surplus =
          static_cast<double>(left_.size() - next.size()) - lucky - kFamilyDeviations * std::sqrt(spread);
      if (beyond_chance < kFamilyWalls || surplus < 0) break;
      std::sort(of_building.begin(), of_building.end());
      const auto first = static_cast<std::uint32_t>(frames_.size());
      for (std::size_t i = 0; i < of_building.size(); ++i) {
        if (i > 0 && of_building[i].first == of_building[i - 1].first)
          frames_.back().weight += of_building[i].second;
        else
          frames_.push_back({of_building[i].first, axis, of_building[i].second});
      }
      families_.emplace_back(first, static_cast<std::uint32_t>(frames_.size()));
      std::swap(left_, next);
    }
  }

  void merge_frames() {
    std::vector<std::uint32_t> leader(frames_.size());
    std::iota(leader.begin(), leader.end(), 0u);
    for (const auto& [begin, end] : families_) std::fill(leader.begin() + begin, leader.begin() + end, begin);
    std::vector<std::vector<std::uint32_t>> of_building(lines_of_.size());
    for (std::uint32_t f = 0; f < frames_.size(); ++f) of_building[frames_[f].building].push_back(f);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (const WallLine& l : lines())
      for (std::size_t i = 0; i < l.buildings.size(); ++i)
        for (std::size_t j = i + 1; j < l.buildings.size(); ++j)
          for (const std::uint32_t f : of_building[l.buildings[i]])
            for (const std::uint32_t g : of_building[l.buildings[j]]) pairs.emplace_back(f, g);
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    FrameGroups groups = group_frames(frames_, std::move(leader), pairs, out_.noise);
    group_ = std::move(groups.group);
    out_.frames = std::move(groups.axes);
    for (std::uint32_t& f : out_.main_frame)
      if (f != kNoFrame) f = group_[f];
  }

  void give_directions() {
    std::vector<double> least(lines().size(), 1);
    for (std::uint32_t f = 0; f < frames_.size(); ++f) {
      const std::uint32_t g = group_[f];
      const Point2 axis = out_.frames[g];
      for (const Member& m : lines_of_[frames_[f].building]) {
        WallLine& l = lines()[m.line];
        const double off = std::fabs(turn_off(axis, l.along));
        if (off > m.limit || off >= least[m.line]) continue;
        least[m.line] = off;
        l.frame = g;
        l.across = std::fabs(dot(axis, l.along)) < std::fabs(cross(axis, l.along));
      }
    }
  }

  /// Cheeks of a bay: two short walls, one wall apart, off by alike angles to opposite sides. A pair of slips of the
  /// mouse would rarely be so alike.
  void spare_bays() {
    std::vector<std::uint32_t> cheeks;
    for (std::size_t w = 0; w < out_.row.walls.size();) {
      std::size_t end = w;
      while (end < out_.row.walls.size() && out_.row.walls[end].ring == out_.row.walls[w].ring) ++end;
      const std::size_t n = end - w;
      for (std::size_t i = 0; n > 4 && i < n; ++i) {
        const std::uint32_t a = out_.row.walls[w + i].line, m = out_.row.walls[w + (i + 1) % n].line,
                            b = out_.row.walls[w + (i + 2) % n].line;
        const WallLine &la = out_.row.lines[a], &lm = out_.row.lines[m], &lb = out_.row.lines[b];
        if (la.frame == kNoFrame || lb.frame != la.frame || lm.frame != la.frame || la.across != lb.across) continue;
        if (la.length > kBayCheek || lb.length > kBayCheek) continue;
        const double p = turn_off(out_.frames[la.frame], la.along), q = turn_off(out_.frames[lb.frame], lb.along);
        const double low = std::min(std::fabs(p), std::fabs(q)), high = std::max(std::fabs(p), std::fabs(q));
        if (p * q < 0 && low > kBayTurn && high < 2 * low) cheeks.push_back(a), cheeks.push_back(b);
      }
      w = end;
    }
    for (const std::uint32_t l : cheeks) out_.row.lines[l].frame = kNoFrame;
  }

  TerraceDirections out_;
  TerraceNoise told_;
  std::vector<std::vector<Member>> lines_of_;                      // per building
  std::vector<Frame> frames_;                                      // by building; then of families, by building
  std::vector<Member> left_;                                       // lines of no building's frame
  std::vector<std::pair<std::uint32_t, std::uint32_t>> families_;  // frames that are one: first, end
  std::vector<std::uint32_t> group_;                               // per frame: which frame stands for it
  std::vector<std::uint32_t> candidates_;
};

}  // namespace

TerraceDirections find_directions(const TerraceGraph& graph, std::span<const std::uint32_t> rings) {
  return Reader(terrace_lines(graph, rings)).read();
}

}  // namespace blockrand::repair
