// Planes and corners of the sweep, made of a polygon and the slopes of its edges.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/geometry/weighted_sweep.h"

namespace blockrand::geometry::moving_planes {

bool Sweep::good(const EdgeProfile& profile) {
  if (!good(profile.slope)) return false;
  std::int64_t height = 0;
  for (const SlopeChange& c : profile.changes) {
    if (!good(c.slope) || !good_height(c.height) || to_grid(c.height) <= height) return false;
    height = to_grid(c.height);
  }
  return true;
}

bool Sweep::gentler(const EdgeProfile& p, const EdgeProfile& q) {
  double slope_p = p.slope, slope_q = q.slope;
  std::size_t i = 0, k = 0;
  while (slope_p == slope_q && (i < p.changes.size() || k < q.changes.size())) {
    const double next_p = i < p.changes.size() ? p.changes[i].height : kUpright;
    const double next_q = k < q.changes.size() ? q.changes[k].height : kUpright;
    if (next_p <= next_q) slope_p = p.changes[i++].slope;
    if (next_q <= next_p) slope_q = q.changes[k++].slope;
  }
  return slope_p < slope_q;
}

std::optional<SkeletonFailure> Sweep::prepare() {
  corners_ = polygon_.outer.points;
  std::vector<std::size_t> first{0};
  for (const model::Ring& hole : polygon_.holes) {
    first.push_back(corners_.size());
    corners_.insert(corners_.end(), hole.points.begin(), hole.points.end());
  }
  first.push_back(corners_.size());
  const std::size_t n = corners_.size();
  if (n > kMostWeightedCorners || polygon_.outer.size() < 3) return SkeletonFailure::too_large;
  if (profiles_.size() != n) return SkeletonFailure::inconsistent;
  for (const EdgeProfile& p : profiles_)
    if (!good(p)) return SkeletonFailure::bad_slope;
  for (const CornerEaves& c : corner_eaves_)
    if (c.corner >= n || c.profile.slope == kUpright || !good(c.profile)) return SkeletonFailure::bad_slope;
  if (deck_ && !good_height(*deck_)) return SkeletonFailure::bad_slope;
  origin_ = corners_[0];
  const Grid2 o = to_grid(origin_);
  std::vector<Grid2> grid(n);
  for (std::size_t i = 0; i < n; ++i) {
    grid[i] = to_grid(corners_[i]) - o;
    if (std::max(std::llabs(grid[i].x), std::llabs(grid[i].y)) > static_cast<std::int64_t>(kWidestSkeleton * kSteps))
      return SkeletonFailure::too_large;
  }
  planes_.all.reserve(n + 1);
  planes_.all.push_back({});
  planes_.all[0].w = 1;  // the ground: z = 0
  planes_.all[0].round();
  merged_.resize(n);
  std::iota(merged_.begin(), merged_.end(), 0u);
  for (std::size_t r = 0; r + 1 < first.size(); ++r) {
    const std::size_t begin = first[r], end = first[r + 1], count = end - begin;
    // Corners that bend no wall are passed over.
    std::vector<std::size_t> kept;
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t before = kept.empty() ? (i == begin ? end - 1 : i - 1) : kept.back();
      if (orientation(grid[before], grid[i], grid[i + 1 < end ? i + 1 : begin]) != 0) kept.push_back(i);
    }
    if (kept.size() < 3) return SkeletonFailure::too_large;
    const auto first_vertex = static_cast<std::int32_t>(vertices_.size());
    const auto kept_count = static_cast<std::int32_t>(kept.size());
    for (std::int32_t k = 0; k < kept_count; ++k) {
      const std::size_t from = kept[static_cast<std::size_t>(k)],
                        to = kept[static_cast<std::size_t>((k + 1) % kept_count)];
      std::size_t lead = from;
      for (std::size_t i = from; i != to; i = begin + (i - begin + 1) % count) {
        if (gentler(profiles_[i], profiles_[lead])) lead = i;
        merged_[i] = static_cast<std::uint32_t>(from);
      }
      Vertex v;
      v.prev = first_vertex + (k + kept_count - 1) % kept_count;
      v.next = first_vertex + (k + 1) % kept_count;
      v.right = base_plane(grid[from], grid[to], profiles_[lead], static_cast<std::uint32_t>(from));
      v.node = static_cast<std::uint32_t>(from);
      vertices_.push_back(v);
    }
  }
  nodes_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    nodes_[i] = {{-1, -1, -1}, static_cast<double>(grid[i].x), static_cast<double>(grid[i].y), 0, 0};
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    Vertex& v = vertices_[i];
    v.left = vertex(v.prev).right;
    const int t = turn(planes_[v.left], planes_[v.right]);
    if (t == 0) return SkeletonFailure::inconsistent;  // a spike
    v.reflex = t < 0;
    Meet& m = nodes_[v.node];
    m.p[0] = v.left, m.p[1] = v.right, m.p[2] = 0;
    segments_.push_back({planes_[v.right].face, v.node, vertex(v.next).node});
    active_.push_back(static_cast<std::int32_t>(i));
  }
  for (const CornerEaves& c : corner_eaves_)
    if (!add_corner_eaves(c)) return SkeletonFailure::bad_slope;
  now_ = nodes_[vertices_[0].node];
  first_now_ = nodes_.size();
  return {};
}

bool Sweep::add_corner_eaves(const CornerEaves& eaves) {
  const auto found =
      std::find_if(active_.begin(), active_.end(), [&](std::int32_t v) { return vertex(v).node == eaves.corner; });
  if (found == active_.end()) return false;
  const std::int32_t first = *found;
  const std::int32_t before = vertex(first).left, after = vertex(first).right, next = vertex(first).next;
  const auto stays_upright = [&](std::int32_t p) { return planes_[p].w == 0 && planes_[p].next < 0; };
  if (vertex(first).reflex || !stays_upright(before) || !stays_upright(after)) return false;
  const std::int32_t outwards = plane_beside(after, eaves), back = plane_beside(before, eaves);
  const auto middle = static_cast<std::int32_t>(vertices_.size()), last = middle + 1;
  vertices_.push_back(
      {.prev = first, .next = last, .left = outwards, .right = back, .node = eaves.corner, .reflex = true});
  vertices_.push_back({.prev = middle, .next = next, .left = back, .right = after, .node = eaves.corner});
  vertex(first).right = outwards;
  vertex(first).next = middle;
  vertex(next).prev = last;
  active_.push_back(middle);
  active_.push_back(last);
  return true;
}

std::int32_t Sweep::plane_beside(std::int32_t upright, const CornerEaves& eaves) {
  const Plane& u = planes_[upright];
  const double length = std::sqrt(static_cast<double>(u.a * u.a + u.b * u.b));
  Plane p;
  p.a = u.a;
  p.b = u.b;
  p.c = u.c;
  p.w = speed(length, eaves.profile.slope);
  const std::int32_t number = add(p, WeightedSkeletonFace::kCorner, 0);
  add_changes(number, length, eaves.profile, WeightedSkeletonFace::kCorner);
  return number;
}

std::int32_t Sweep::base_plane(Grid2 from, Grid2 to, const EdgeProfile& profile, std::uint32_t edge) {
  const std::int64_t dx = to.x - from.x, dy = to.y - from.y;
  const double length = std::sqrt(static_cast<double>(dx * dx + dy * dy));
  Plane p;
  p.a = -dy;
  p.b = dx;
  p.c = -(static_cast<Int128>(p.a) * from.x + static_cast<Int128>(p.b) * from.y) * (Int128{1} << kSpeedBits);
  p.w = speed(length, profile.slope);
  for (const auto& [other, number, its_profile] : base_planes_) {
    const Plane& q = planes_[number];
    if (turn(p, q) == 0 && same_way(p, q) && on_line(q, from) && same(*its_profile, profile)) {
      return number;
    }
  }
  const auto number = add(p, edge, 0);
  base_planes_.push_back({edge, number, &profile});
  add_changes(number, length, profile, edge);
  return number;
}

void Sweep::add_changes(std::int32_t number, double length, const EdgeProfile& profile, std::uint32_t edge) {
  std::int32_t last = number;
  for (std::size_t c = 0; c < profile.changes.size(); ++c) {
    const std::int64_t height = to_grid(profile.changes[c].height);
    Plane q = planes_[last];
    const std::int64_t w = speed(length, profile.changes[c].slope);
    q.c += static_cast<Int128>(w - q.w) * height;
    q.w = w;
    q.next = -1;
    q.change = 0;
    const std::int32_t next = add(q, edge, static_cast<std::uint32_t>(c) + 1);
    planes_.all[static_cast<std::size_t>(last)].next = next;
    planes_.all[static_cast<std::size_t>(last)].change = height;
    last = next;
  }
}

std::int32_t Sweep::add(Plane p, std::uint32_t edge, std::uint32_t level) {
  p.face = static_cast<std::uint32_t>(faces_.size());
  p.round();
  faces_.push_back({edge, level, p.w == 0, p.face, static_cast<std::int32_t>(planes_.all.size())});
  planes_.all.push_back(p);
  return static_cast<std::int32_t>(planes_.all.size()) - 1;
}

}  // namespace blockrand::geometry::moving_planes
