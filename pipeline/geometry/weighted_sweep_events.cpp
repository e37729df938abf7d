// What happens while the planes rise: edges collapse, corners split edges, slopes change.
#include <algorithm>
#include <cmath>

#include "pipeline/geometry/weighted_sweep.h"

namespace blockrand::geometry::moving_planes {

tl::expected<WeightedSkeleton, SkeletonFailure> Sweep::run() {
  if (const auto failure = prepare()) return tl::unexpected(*failure);
  push_changes(-1);
  for (const std::int32_t v : active_) push_candidates(v);
  std::size_t left = 64 + 16 * vertices_.size() * vertices_.size();
  for (;;) {
    if (heap_.empty()) return tl::unexpected(SkeletonFailure::unbounded);
    if (left-- == 0) return tl::unexpected(SkeletonFailure::inconsistent);
    const Event event = pop();
    if (event.kind == Event::Kind::change) {
      if (event.other < 0) {
        stop(event.at);
        break;
      }
      change(event.at);
      continue;
    }
    const Vertex& v = vertex(event.vertex);
    if (!v.alive) {
      if (event.kind == Event::Kind::split) splits_[static_cast<std::size_t>(event.vertex)] = {};
      continue;
    }
    if (event.kind == Event::Kind::split) push_next_split(event.vertex);
    if (event.kind == Event::Kind::collapse && (!vertex(event.other).alive || v.next != event.other)) continue;
    now_ = event.at;
    if (!meet_at(event.at)) return tl::unexpected(SkeletonFailure::inconsistent);
    if (std::none_of(active_.begin(), active_.end(), [&](std::int32_t i) { return vertex(i).alive; })) break;
  }
  return result();
}

void Sweep::push_changes(std::int64_t height) {
  std::vector<std::int64_t> heights;
  for (const std::int32_t v : active_) {
    const Plane& p = planes_[vertex(v).right];
    if (p.next >= 0 && p.change > height) heights.push_back(p.change);
  }
  std::sort(heights.begin(), heights.end());
  heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
  for (const std::int64_t h : heights) push({level(h), Event::Kind::change, -1, 1, 0});
  if (deck_) push({level(to_grid(*deck_)), Event::Kind::change, -1, -1, 0});
}

Meet Sweep::level(std::int64_t height) {
  std::int32_t number = -1;
  for (const auto& [h, p] : levels_)
    if (h == height) number = p;
  if (number < 0) {
    Plane p;
    p.c = height;
    p.w = 1;
    p.round();
    number = static_cast<std::int32_t>(planes_.all.size());
    planes_.all.push_back(p);
    levels_.push_back({height, number});
  }
  // Two upright planes that cross anywhere make the height a point.
  return {{number, axis(0), axis(1)}, 0, 0, static_cast<double>(height), 0};
}

std::int32_t Sweep::axis(int which) {
  if (axes_[which] < 0) {
    Plane p;
    (which == 0 ? p.a : p.b) = 1;
    p.round();
    axes_[which] = static_cast<std::int32_t>(planes_.all.size());
    planes_.all.push_back(p);
  }
  return axes_[which];
}

void Sweep::push_collapse(std::int32_t from, std::int32_t to) {
  const Vertex &v = vertex(from), &w = vertex(to);
  // Eaves without length set out from one node and grow.
  if (v.node == w.node && v.node < corners_.size() && planes_[v.right].w != 0) return;
  if (const auto m = planes_.meet(v.left, v.right, w.right); m && planes_.compare_height(*m, now_) >= 0)
    push({*m, Event::Kind::collapse, from, to, 0});
}

void Sweep::push_candidates(std::int32_t number) {
  push_collapse(number, vertex(number).next);
  push_collapse(vertex(number).prev, number);
  if (!vertex(number).reflex) return;
  const std::int32_t left = vertex(number).left, right = vertex(number).right;
  const Meet& origin = nodes_[vertex(number).node];
  ++stamp_;
  seen_.resize(planes_.all.size(), 0);
  splits_.resize(vertices_.size());
  Splits& splits = splits_[static_cast<std::size_t>(number)];
  splits = {left, right, {}};
  for (const std::int32_t other : active_) {
    const std::int32_t k = vertex(other).right;
    if (!vertex(other).alive || k == left || k == right || seen_[static_cast<std::size_t>(k)] == stamp_) continue;
    seen_[static_cast<std::size_t>(k)] = stamp_;
    const auto m = planes_.meet(left, right, k);
    if (!m || planes_.compare_height(*m, now_) < 0) continue;
    if (!planes_.surely_beside(k, origin) && planes_.side(k, origin) == 0) continue;  // it has just left that edge
    splits.heap.push_back({m->z, m->error, k, counter_++});
  }
  std::make_heap(splits.heap.begin(), splits.heap.end(), LaterSplit{&planes_, left, right});
  push_next_split(number);
}

void Sweep::push_next_split(std::int32_t number) {
  Splits& splits = splits_[static_cast<std::size_t>(number)];
  if (splits.heap.empty()) return;
  std::pop_heap(splits.heap.begin(), splits.heap.end(), LaterSplit{&planes_, splits.left, splits.right});
  const Splits::Place next = splits.heap.back();
  splits.heap.pop_back();
  if (const auto m = planes_.meet(splits.left, splits.right, next.plane))
    push_numbered({*m, Event::Kind::split, number, next.plane, next.number});
}

void Sweep::finish(std::int32_t number, std::uint32_t node) {
  Vertex& v = vertex(number);
  v.alive = false;
  if (v.node == node) return;
  segments_.push_back({planes_[v.left].face, v.node, node});
  segments_.push_back({planes_[v.right].face, node, v.node});
}

bool Sweep::meet_at(const Meet& at) {
  std::vector<std::int32_t>&there = there_, &through = through_;
  there.clear();
  through.clear();
  std::size_t kept = 0;
  for (const std::int32_t i : active_) {
    const Vertex& v = vertex(i);
    if (!v.alive) continue;
    active_[kept++] = i;
    if (planes_.surely_beside(v.right, at) || planes_.side(v.right, at) != 0) continue;
    const int s = from_start(v, at);
    if (s == 0)
      there.push_back(i);
    else if (s > 0 && to_end(vertex(v.next), at) > 0)
      through.push_back(i);
  }
  active_.resize(kept);
  if (there.empty()) return true;
  ++mark_;
  marks_.resize(vertices_.size(), 0);
  const auto marked = [&](std::int32_t v) { return marks_[static_cast<std::size_t>(v)] == mark_; };
  for (const std::int32_t v : there) marks_[static_cast<std::size_t>(v)] = mark_;
  strands_.clear();
  bool changes = false;
  std::size_t in_chains = 0;
  for (const std::int32_t v : there) {
    if (marked(vertex(v).prev)) continue;
    std::int32_t last = v;
    ++in_chains;
    while (marked(vertex(last).next)) {
      last = vertex(last).next;
      ++in_chains;
      changes = true;
    }
    strands_.push_back({vertex(v).left, vertex(last).right, vertex(v).prev, vertex(last).next});
  }
  if (in_chains != there.size()) changes = true;  // whole loops end here
  for (const std::int32_t v : through) strands_.push_back({vertex(v).right, vertex(v).right, v, vertex(v).next});
  if (strands_.size() > 1) changes = true;
  if (!changes) return true;

  const std::uint32_t node = node_of(at);
  for (const std::int32_t v : there) finish(v, node);
  fresh_.clear();
  if (strands_.size() == 1) {
    join(strands_[0], strands_[0], node);
  } else if (strands_.size() > 1) {
    rays_.clear();
    for (std::uint32_t s = 0; s < strands_.size(); ++s) {
      const Plane &in = planes_[strands_[s].in], &out = planes_[strands_[s].out];
      rays_.push_back({-in.b, in.a, false, s});
      rays_.push_back({out.b, -out.a, true, s});
    }
    std::sort(rays_.begin(), rays_.end(), [](const Ray& p, const Ray& q) {
      const bool upper_p = p.dy > 0 || (p.dy == 0 && p.dx > 0), upper_q = q.dy > 0 || (q.dy == 0 && q.dx > 0);
      if (upper_p != upper_q) return upper_p;
      const Int128 cross = static_cast<Int128>(p.dx) * q.dy - static_cast<Int128>(p.dy) * q.dx;
      if (cross != 0) return cross > 0;
      if (p.out != q.out) return p.out;  // a sector without width lies between an edge that leaves and one that arrives
      return p.strand < q.strand;
    });
    // Every sector of the inside begins at an edge that leaves and ends, counter-clockwise, at one that arrives.
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (!rays_[i].out) continue;
      const Ray& end = rays_[(i + 1) % rays_.size()];
      if (end.out) return false;
      join(strands_[end.strand], strands_[rays_[i].strand], node);
    }
  }
  return settle();
}

void Sweep::join(const Strand& arriving, const Strand& leaving, std::uint32_t node) {
  Vertex v;
  v.left = arriving.in;
  v.right = leaving.out;
  v.prev = arriving.before;
  v.next = leaving.after;
  v.node = node;
  const auto number = static_cast<std::int32_t>(vertices_.size());
  vertices_.push_back(v);
  vertex(v.prev).next = number;
  vertex(v.next).prev = number;
  active_.push_back(number);
  fresh_.push_back(number);
}

bool Sweep::settle() {
  for (std::size_t i = 0; i < fresh_.size(); ++i) {
    const std::int32_t number = fresh_[i];
    if (!vertex(number).alive) continue;
    const Plane &left = planes_[vertex(number).left], &right = planes_[vertex(number).right];
    const int t = turn(left, right);
    vertex(number).reflex = t < 0;
    vertex(number).folded = t == 0 && !same_way(left, right);
    if (t == 0 && same_way(left, right) && !unite(number)) return false;
  }
  for (const std::int32_t number : fresh_) {
    Vertex& v = vertex(number);
    if (!v.alive) continue;
    if (v.next == number) return false;
    if (vertex(v.next).next == number) {
      // Two edges are left, back on each other: a ridge.
      const std::uint32_t end = vertex(v.next).node;
      segments_.push_back({planes_[v.left].face, v.node, end});
      segments_.push_back({planes_[v.right].face, end, v.node});
      vertex(v.next).alive = false;
      v.alive = false;
    }
  }
  for (const std::int32_t number : fresh_)
    if (vertex(number).alive) push_candidates(number);
  for (const std::int32_t number : longer_)
    if (vertex(number).alive) push_collapse(number, vertex(number).next);
  longer_.clear();
  return true;
}

bool Sweep::unite(std::int32_t number) {
  const std::int32_t a = vertex(number).left, b = vertex(number).right;
  const std::int32_t before = vertex(number).prev, after = vertex(number).next;
  vertex(number).alive = false;
  if (before == number || before == after) return false;
  vertex(before).next = after;
  vertex(after).prev = before;
  longer_.push_back(before);
  if (a == b) return true;
  const int faster = planes_.compare_speed(planes_[a], planes_[b]);
  const std::uint32_t here = vertex(number).node;
  if (faster == 0) {
    // One plane under two names (profiles that differ further up): one face from here on.
    join_faces(planes_[a].face, planes_[b].face);
    vertex(after).left = a;
    return true;
  }
  // The steeper edge's far end turns to the other plane where it is now.
  const std::int32_t far = faster > 0 ? after : before;
  const std::int32_t winner = faster > 0 ? a : b, loser = faster > 0 ? b : a;
  std::uint32_t node = vertex(far).node;
  if (!vertex(far).folded) {
    const auto m = planes_.meet(faster > 0 ? vertex(far).right : vertex(far).left, a, b);
    if (!m) return false;
    // A vertex that has just been made stands at its node.
    if (!fresh(far) || planes_.along(a, nodes_[node], *m) != 0) node = node_of(*m);
  }
  const std::int32_t replaced = static_cast<std::int32_t>(vertices_.size());
  Vertex v = vertex(far);
  finish(far, node);
  v.alive = true;
  v.node = node;
  (faster > 0 ? v.left : v.right) = winner;
  vertices_.push_back(v);
  vertex(v.prev).next = replaced;
  vertex(v.next).prev = replaced;
  active_.push_back(replaced);
  fresh_.push_back(replaced);
  const auto [from, to] = faster > 0 ? std::pair(here, node) : std::pair(node, here);
  segments_.push_back({planes_[loser].face, to, from});
  segments_.push_back({planes_[winner].face, from, to});
  return true;
}

void Sweep::change(const Meet& at) {
  now_ = at;
  const std::int64_t height = static_cast<std::int64_t>(at.z);
  drop_dead();
  const auto changes = [&](std::int32_t p) { return planes_[p].next >= 0 && planes_[p].change == height; };
  std::vector<std::uint32_t> node(vertices_.size());
  for (const std::int32_t i : active_) {
    const Vertex& v = vertex(i);
    node[static_cast<std::size_t>(i)] = v.node;
    if (!changes(v.left) && !changes(v.right)) continue;
    node[static_cast<std::size_t>(i)] = node_at(v, at);
  }
  for (const std::int32_t i : active_) {
    Vertex& v = vertex(i);
    if (changes(v.right)) {
      const std::uint32_t from = node[static_cast<std::size_t>(i)], to = node[static_cast<std::size_t>(v.next)];
      segments_.push_back({planes_[v.right].face, to, from});
      segments_.push_back({planes_[planes_[v.right].next].face, from, to});
    }
    if (node[static_cast<std::size_t>(i)] == v.node) continue;
    finish(i, node[static_cast<std::size_t>(i)]);
    v.alive = true;
    v.node = node[static_cast<std::size_t>(i)];
  }
  for (const std::int32_t i : active_) {
    Vertex& v = vertex(i);
    if (changes(v.left)) v.left = planes_[v.left].next;
    if (changes(v.right)) v.right = planes_[v.right].next;
  }
  heap_.clear();
  push_changes(height);
  for (const std::int32_t i : active_) push_candidates(i);
}

std::uint32_t Sweep::node_of(const Meet& at) {
  while (first_now_ < nodes_.size() && planes_.compare_height(nodes_[first_now_], at) != 0) ++first_now_;
  for (std::size_t i = first_now_; i < nodes_.size(); ++i) {
    const Meet& m = nodes_[i];
    if (planes_.side(m.p[0], at) == 0 && planes_.side(m.p[1], at) == 0 && planes_.side(m.p[2], at) == 0)
      return static_cast<std::uint32_t>(i);
  }
  nodes_.push_back(at);
  return static_cast<std::uint32_t>(nodes_.size()) - 1;
}

void Sweep::stop(const Meet& at) {
  drop_dead();
  std::vector<std::uint32_t> node(vertices_.size());
  for (const std::int32_t i : active_) node[static_cast<std::size_t>(i)] = node_at(vertex(i), at);
  ++mark_;
  marks_.resize(vertices_.size(), 0);
  for (const std::int32_t i : active_) {
    const Vertex& v = vertex(i);
    segments_.push_back(
        {planes_[v.right].face, node[static_cast<std::size_t>(v.next)], node[static_cast<std::size_t>(i)]});
    finish(i, node[static_cast<std::size_t>(i)]);
    if (marks_[static_cast<std::size_t>(i)] == mark_) continue;
    std::vector<std::uint32_t> loop;
    for (std::int32_t w = i; marks_[static_cast<std::size_t>(w)] != mark_; w = vertex(w).next) {
      marks_[static_cast<std::size_t>(w)] = mark_;
      loop.push_back(node[static_cast<std::size_t>(w)]);
    }
    deck_loops_.push_back(std::move(loop));
  }
  active_.clear();
}

}  // namespace blockrand::geometry::moving_planes
