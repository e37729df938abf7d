#include "styles/masonry/course_cover.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace blockrand::masonry {
namespace {

/// m. Places nearer than that are one.
constexpr double kSame = 1e-5;
/// Share of a band's height where cut stones end: thinner edges break.
constexpr double kLeastReach = 0.2;

using Spans = std::vector<std::pair<double, double>>;

/// Heights between which a vertical line runs within a polygon.
Spans chords(std::span<const Point2> polygon, double x) {
  std::vector<double> at;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if ((a.x <= x) == (b.x <= x)) continue;
    at.push_back(a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x));
  }
  std::ranges::sort(at);
  Spans out;
  for (std::size_t i = 0; i + 1 < at.size(); i += 2) out.emplace_back(at[i], at[i + 1]);
  return out;
}

class Band {
 public:
  Band(const Outline& outline, std::span<const Outline> blocked, double low, double high)
      : outline_(outline), low_(low), high_(high) {
    for (const Outline& o : blocked) {
      const Box box = box_of(o);
      if (box.low < high && box.high > low) blocked_.push_back(&o);
    }
  }

  /// Where the share of free height begins or ceases to change evenly.
  std::vector<double> events(double from, double to) const {
    std::vector<double> out{from, to};
    const auto add = [&](std::span<const Point2> polygon) {
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        if (std::max(a.y, b.y) < low_ || std::min(a.y, b.y) > high_) continue;
        out.push_back(a.x);
        out.push_back(b.x);
        for (const double y : {low_, high_})
          if ((a.y < y) != (b.y < y)) out.push_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
      }
    };
    add(outline_);
    for (const Outline* o : blocked_) add(*o);
    std::ranges::sort(out);
    std::erase_if(out, [&](double x) { return x < from || x > to; });
    out.erase(std::unique(out.begin(), out.end(), [](double a, double b) { return b - a < kSame; }), out.end());
    return out;
  }

  double free_share(double x) const {
    Spans taken;
    for (const Outline* o : blocked_)
      for (const auto& span : chords(*o, x)) taken.push_back(span);
    std::ranges::sort(taken);
    double free = 0;
    for (auto [low, high] : chords(outline_, x)) {
      low = std::max(low, low_), high = std::min(high, high_);
      if (high <= low) continue;
      double done = low;
      for (const auto& [a, b] : taken) {
        if (b <= done || a >= high) continue;
        if (a > done) free += a - done;
        done = std::max(done, b);
      }
      if (high > done) free += high - done;
    }
    return free / (high_ - low_);
  }

 private:
  const Outline& outline_;
  std::vector<const Outline*> blocked_;
  double low_, high_;
};

/// A piece of the run over which the share changes evenly.
struct Piece {
  double from, to, share_from, share_to;
};

}  // namespace

std::vector<FreeRun> free_runs(const Outline& outline, std::span<const Outline> blocked, double from, double to,
                               double low, double high, double least) {
  const Band band(outline, blocked, low, high);
  const std::vector<double> at = band.events(from, to);
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    const double inside = std::min(kSame, (at[i + 1] - at[i]) / 4);
    const Piece whole{at[i], at[i + 1], band.free_share(at[i] + inside), band.free_share(at[i + 1] - inside)};
    // Cut where it passes one of the thresholds.
    std::vector<double> cuts{whole.from};
    for (const double share : {kLeastReach, least}) {
      const double a = whole.share_from - share, b = whole.share_to - share;
      if ((a < 0) != (b < 0) && std::fabs(b - a) > 1e-9)
        cuts.push_back(whole.from + (whole.to - whole.from) * a / (a - b));
    }
    cuts.push_back(whole.to);
    std::ranges::sort(cuts);
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
      const auto share = [&](double x) {
        return whole.share_from + (whole.share_to - whole.share_from) * (x - whole.from) / (whole.to - whole.from);
      };
      if (cuts[k + 1] > cuts[k]) pieces.push_back({cuts[k], cuts[k + 1], share(cuts[k]), share(cuts[k + 1])});
    }
  }
  const auto mean = [](const Piece& p) { return (p.share_from + p.share_to) / 2; };
  std::vector<FreeRun> out;
  for (std::size_t i = 0; i < pieces.size();) {
    if (mean(pieces[i]) < least) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end + 1 < pieces.size() && mean(pieces[end + 1]) >= least) ++end;
    std::size_t first = i, last = end;
    // Up to the next run: what lies between belongs to neither beyond its middle.
    while (first > 0 && mean(pieces[first - 1]) >= kLeastReach && mean(pieces[first - 1]) < least) --first;
    while (last + 1 < pieces.size() && mean(pieces[last + 1]) >= kLeastReach && mean(pieces[last + 1]) < least) ++last;
    FreeRun run{pieces[i].from, pieces[end].to, pieces[first].from, pieces[last].to, false};
    for (std::size_t k = first; k <= last; ++k)
      run.cut = run.cut || pieces[k].share_from < 1 - 1e-6 || pieces[k].share_to < 1 - 1e-6;
    if (!out.empty() && run.reach_left < out.back().reach_right) {
      const double middle =
          (std::max(run.reach_left, out.back().right) + std::min(out.back().reach_right, run.left)) / 2;
      run.reach_left = out.back().reach_right = middle;
    }
    out.push_back(run);
    i = end + 1;
  }
  return out;
}

}  // namespace blockrand::masonry
