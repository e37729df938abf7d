// The faces that the moving corners leave behind, put together to loops.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/weighted_sweep.h"

namespace blockrand::geometry::moving_planes {

tl::expected<WeightedSkeleton, SkeletonFailure> Sweep::result() {
  WeightedSkeleton out;
  out.merged = merged_;
  out.nodes.reserve(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Meet& m = nodes_[i];
    out.nodes.push_back(i < corners_.size()
                            ? WeightedSkeletonNode{corners_[i], 0}
                            : WeightedSkeletonNode{{origin_.x + m.x / kSteps, origin_.y + m.y / kSteps}, m.z / kSteps});
  }
  for (Segment& s : segments_) s.face = root(s.face);
  std::sort(segments_.begin(), segments_.end(), [](const Segment& p, const Segment& q) {
    return p.face != q.face ? p.face < q.face : p.from != q.from ? p.from < q.from : p.to < q.to;
  });
  std::vector<char> used(segments_.size(), 0);
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    if (used[i]) continue;
    WeightedSkeletonFace face;
    const FaceRecord& record = faces_[segments_[i].face];
    face.edge = record.edge;
    face.level = record.level;
    face.upright = record.upright;
    std::vector<std::uint32_t> loop;
    std::size_t at = i;
    while (!used[at]) {
      used[at] = 1;
      loop.push_back(segments_[at].from);
      const auto next = following(at, used, i);
      if (!next) return tl::unexpected(SkeletonFailure::inconsistent);
      at = *next;
    }
    if (at != i) return tl::unexpected(SkeletonFailure::inconsistent);
    // Of several edges on one line, the first that this piece rises from.
    std::optional<std::uint32_t> base;
    for (std::size_t k = 0; k < loop.size(); ++k)
      if (loop[k] < corners_.size() && loop[(k + 1) % loop.size()] < corners_.size() && (!base || loop[k] < *base))
        base = loop[k];
    if (base) face.edge = *base;
    face.loops.push_back(std::move(loop));
    out.faces.push_back(std::move(face));
  }
  put_holes_in_faces(out);
  add_decks(out);
  return out;
}

std::optional<std::size_t> Sweep::following(std::size_t at, const std::vector<char>& used, std::size_t start) const {
  const Segment& s = segments_[at];
  const auto begin = std::lower_bound(
      segments_.begin(), segments_.end(), Segment{s.face, s.to, 0},
      [](const Segment& p, const Segment& q) { return p.face != q.face ? p.face < q.face : p.from < q.from; });
  std::optional<std::size_t> best;
  double best_angle = 0;
  const auto place = [&](std::uint32_t n) -> Point2 {
    const Meet& m = nodes_[n];
    if (!faces_[s.face].upright) return {m.x, m.y};
    const Plane& p = planes_[faces_[s.face].plane];
    const double length = std::sqrt(p.fa * p.fa + p.fb * p.fb);
    return {(p.fb * m.x - p.fa * m.y) / length, m.z};
  };
  const auto angle = [&](std::uint32_t a, std::uint32_t b) {
    const Point2 u = place(a), v = place(b);
    return base::atan2(v.y - u.y, v.x - u.x);
  };
  for (auto next = begin; next != segments_.end() && next->face == s.face && next->from == s.to; ++next) {
    const auto number = static_cast<std::size_t>(next - segments_.begin());
    if (used[number] && number != start) continue;
    const bool only =
        (std::next(next) == segments_.end() || std::next(next)->face != s.face || std::next(next)->from != s.to) &&
        !best;
    if (only) return number;
    // How far clockwise from the way back.
    constexpr double kTurn = 6.283185307179586;
    double a = angle(s.to, s.from) - angle(s.to, next->to);
    while (a <= 1e-12) a += kTurn;
    if (!best || a < best_angle) {
      best = number;
      best_angle = a;
    }
  }
  return best;
}

double Sweep::twice_area(const std::vector<std::uint32_t>& loop) const {
  double sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Meet &p = nodes_[loop[i]], &q = nodes_[loop[(i + 1) % loop.size()]], &o = nodes_[loop[0]];
    sum += (p.x - o.x) * (q.y - o.y) - (q.x - o.x) * (p.y - o.y);
  }
  return sum;
}

bool Sweep::inside(const std::vector<std::uint32_t>& ring, const Meet& at) const {
  bool in = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Meet &p = nodes_[ring[i]], &q = nodes_[ring[(i + 1) % ring.size()]];
    if ((p.y > at.y) != (q.y > at.y) && at.x < p.x + (at.y - p.y) / (q.y - p.y) * (q.x - p.x)) in = !in;
  }
  return in;
}

void Sweep::put_holes_in_faces(WeightedSkeleton& out) const {
  constexpr double kLeastHole = 1;  // square steps; below it is the rounding of a loop without area
  for (std::size_t h = 0; h < out.faces.size();) {
    WeightedSkeletonFace& hole = out.faces[h];
    bool moved = false;
    if (!hole.upright && twice_area(hole.loops[0]) < -kLeastHole)
      for (WeightedSkeletonFace& face : out.faces) {
        if (&face == &hole || face.upright || face.level != hole.level || face_of(face) != face_of(hole)) continue;
        if (twice_area(face.loops[0]) <= 0 || !inside(face.loops[0], nodes_[hole.loops[0][0]])) continue;
        face.loops.push_back(std::move(hole.loops[0]));
        moved = true;
        break;
      }
    if (moved)
      out.faces.erase(out.faces.begin() + static_cast<std::ptrdiff_t>(h));
    else
      ++h;
  }
}

void Sweep::add_decks(WeightedSkeleton& out) const {
  std::vector<std::size_t> decks;
  for (const auto& loop : deck_loops_) {
    if (twice_area(loop) <= 0) continue;
    WeightedSkeletonFace face;
    face.edge = WeightedSkeletonFace::kDeck;
    face.loops.push_back(loop);
    decks.push_back(out.faces.size());
    out.faces.push_back(std::move(face));
  }
  for (const auto& loop : deck_loops_) {
    if (twice_area(loop) > 0) continue;
    // The deck around a hole: loops do not cross, so one corner decides.
    for (const std::size_t d : decks) {
      if (!inside(out.faces[d].loops[0], nodes_[loop[0]])) continue;
      out.faces[d].loops.push_back(loop);
      break;
    }
  }
}

}  // namespace blockrand::geometry::moving_planes
