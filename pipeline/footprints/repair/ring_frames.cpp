#include "pipeline/footprints/repair/ring_frames.h"

#include <algorithm>

namespace blockrand::repair {

namespace {

using model::Point2;

constexpr double kMergeDeviations = 3.0;  // 1 in 370 of frames that are one stays apart

/// Of two frames: by how many standard deviations they differ, squared.
double difference(const Frame& a, const Frame& b, double noise) {
  const double off = turn_off(a.axis, b.axis);
  return off * off / (noise * noise * (1 / a.weight + 1 / b.weight));
}

}  // namespace

Point2 first_quarter(Point2 u) {
  for (int k = 0; k < 3 && !(u.x > 0 && u.y >= 0); ++k) u = {u.y, -u.x};
  return u;
}

double turn_off(Point2 frame, Point2 v) {
  const double c = dot(frame, v), s = cross(frame, v);
  if (std::fabs(s) <= std::fabs(c)) return c >= 0 ? s : -s;
  return s >= 0 ? -c : c;
}

FrameGroups group_frames(const std::vector<Frame>& frames, std::vector<std::uint32_t> leader,
                         const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs, double noise) {
  std::vector<Frame> merged = frames;
  for (std::uint32_t f = 0; f < frames.size(); ++f)
    if (leader[f] != f) merged[leader[f]].weight += frames[f].weight;
  const auto find = [&](std::uint32_t i) {
    while (leader[i] != i) i = leader[i] = leader[leader[i]];
    return i;
  };
  struct Step {
    double difference;
    std::uint32_t a, b;
    bool operator<(const Step& o) const {
      return difference != o.difference ? difference < o.difference : std::pair(a, b) < std::pair(o.a, o.b);
    }
  };
  std::vector<Step> steps;
  // In every round a group is merged at most once, so that groups grow evenly: one long chain would drift along a bent
  // row.
  for (bool again = true; again;) {
    again = false;
    steps.clear();
    for (const auto& [f, g] : pairs) {
      const std::uint32_t a = find(f), b = find(g);
      if (a == b) continue;
      const double d = difference(merged[a], merged[b], noise);
      if (d <= kMergeDeviations * kMergeDeviations) steps.push_back({d, std::min(a, b), std::max(a, b)});
    }
    std::sort(steps.begin(), steps.end());
    std::vector<bool> touched(merged.size(), false);
    for (const Step& s : steps) {
      if (touched[s.a] || touched[s.b]) continue;
      touched[s.a] = touched[s.b] = true;
      Frame &a = merged[s.a], &b = merged[s.b];
      Point2 other = b.axis;  // or a quarter turn from it
      while (dot(a.axis, other) < std::fabs(cross(a.axis, other))) other = {other.y, -other.x};
      a.axis =
          first_quarter(unit({a.weight * a.axis.x + b.weight * other.x, a.weight * a.axis.y + b.weight * other.y}));
      a.weight += b.weight;
      leader[s.b] = s.a;
      again = true;
    }
  }
  FrameGroups out;
  for (std::uint32_t f = 0; f < frames.size(); ++f) out.group.push_back(find(f));
  for (const Frame& f : merged) out.axes.push_back(f.axis);
  return out;
}

}  // namespace blockrand::repair
