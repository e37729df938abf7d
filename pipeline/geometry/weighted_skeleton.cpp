#include "pipeline/geometry/weighted_skeleton.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/moving_planes.h"

namespace blockrand::geometry {

namespace {

using model::Point2;

using namespace moving_planes;

struct Segment {
  std::uint32_t face, from, to;
};

/// A corner of the moving polygon.
struct Vertex {
  std::int32_t prev = -1, next = -1;
  std::int32_t left = -1, right = -1;  ///< planes of the edges that end and start here
  std::uint32_t node = 0;              ///< where it set out
  bool alive = true;
  bool reflex = false;
  bool folded = false;  ///< its edges run back on each other: it stays at its node, and vanishes at this height
};

struct Event {
  Meet at;
  enum class Kind : std::uint8_t { collapse, split, change } kind = Kind::collapse;
  std::int32_t vertex = -1, other = -1;  ///< collapse: the edge between two vertices; split: vertex and plane
  std::uint32_t number = 0;
};

class Sweep {
 public:
  Sweep(const model::Polygon& polygon, std::span<const EdgeProfile> profiles, std::optional<double> deck,
        std::span<const CornerEaves> corner_eaves)
      : polygon_(polygon), profiles_(profiles), deck_(deck), corner_eaves_(corner_eaves) {}

  tl::expected<WeightedSkeleton, SkeletonFailure> run() {
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
      if (!v.alive) continue;
      if (event.kind == Event::Kind::collapse && (!vertex(event.other).alive || v.next != event.other)) continue;
      now_ = event.at;
      if (!meet_at(event.at)) return tl::unexpected(SkeletonFailure::inconsistent);
      if (std::none_of(active_.begin(), active_.end(), [&](std::int32_t i) { return vertex(i).alive; })) break;
    }
    return result();
  }

 private:
  Vertex& vertex(std::int32_t v) { return vertices_[static_cast<std::size_t>(v)]; }
  const Vertex& vertex(std::int32_t v) const { return vertices_[static_cast<std::size_t>(v)]; }

  // ---- input

  /// The same inverse slope for all edges, in whole units: walls of whole lengths get speeds in exact proportion, so
  /// that regular plans have exactly simultaneous events.
  std::int64_t speed(double length, double slope) const {
    if (slope == kUpright) return 0;
    const double inverse = std::nearbyint(kSpeedUnit / slope);
    if (length == std::floor(length)) return static_cast<std::int64_t>(length) * static_cast<std::int64_t>(inverse);
    return static_cast<std::int64_t>(std::llrint(length * inverse));
  }
  static bool good(double slope) { return slope == kUpright || (slope >= kLeastSlope && slope <= kSteepestSlope); }
  static bool good(const EdgeProfile& profile) {
    if (!good(profile.slope)) return false;
    std::int64_t height = 0;
    for (const SlopeChange& c : profile.changes) {
      if (!good(c.slope) || !good_height(c.height) || to_grid(c.height) <= height) return false;
      height = to_grid(c.height);
    }
    return true;
  }
  static bool good_height(double metres) {
    constexpr double kHighest = 2000;
    return metres > 0 && metres <= kHighest && to_grid(metres) > 0;
  }

  /// Which of two profiles on one line holds: the gentler one where they first differ, from below.
  static bool gentler(const EdgeProfile& p, const EdgeProfile& q) {
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

  std::optional<SkeletonFailure> prepare() {
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

  /// Puts two edges without length between the edges of a corner: the one that ends here, then one that runs as the edge
  /// that starts here, one that runs as the edge that ends here, and the one that starts here.
  bool add_corner_eaves(const CornerEaves& eaves) {
    const auto found =
        std::find_if(active_.begin(), active_.end(), [&](std::int32_t v) { return vertex(v).node == eaves.corner; });
    if (found == active_.end()) return false;
    const std::int32_t first = *found;
    const std::int32_t before = vertex(first).left, after = vertex(first).right, next = vertex(first).next;
    const auto stays_upright = [&](std::int32_t p) { return planes_[p].w == 0 && planes_[p].next < 0; };
    if (vertex(first).reflex || !stays_upright(before) || !stays_upright(after)) return false;
    const std::int32_t outwards = plane_beside(after, eaves), back = plane_beside(before, eaves);
    const auto middle = static_cast<std::int32_t>(vertices_.size()), last = middle + 1;
    vertices_.push_back({first, last, outwards, back, eaves.corner, true, true, false});
    vertices_.push_back({middle, next, back, after, eaves.corner, true, false, false});
    vertex(first).right = outwards;
    vertex(first).next = middle;
    vertex(next).prev = last;
    active_.push_back(middle);
    active_.push_back(last);
    return true;
  }
  /// A sloping plane on the line of an upright one.
  std::int32_t plane_beside(std::int32_t upright, const CornerEaves& eaves) {
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

  /// The plane of an edge, and those it turns into. Edges on one line with one profile share theirs.
  std::int32_t base_plane(Grid2 from, Grid2 to, const EdgeProfile& profile, std::uint32_t edge) {
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
  void add_changes(std::int32_t number, double length, const EdgeProfile& profile, std::uint32_t edge) {
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
  static bool on_line(const Plane& p, Grid2 at) {
    return static_cast<Int128>(p.a) * at.x + static_cast<Int128>(p.b) * at.y + (p.c >> kSpeedBits) == 0;
  }
  static bool same(const EdgeProfile& p, const EdgeProfile& q) {
    if (p.slope != q.slope || p.changes.size() != q.changes.size()) return false;
    for (std::size_t i = 0; i < p.changes.size(); ++i)
      if (p.changes[i].height != q.changes[i].height || p.changes[i].slope != q.changes[i].slope) return false;
    return true;
  }
  std::int32_t add(Plane p, std::uint32_t edge, std::uint32_t level) {
    p.face = static_cast<std::uint32_t>(faces_.size());
    p.round();
    faces_.push_back({edge, level, p.w == 0, p.face, static_cast<std::int32_t>(planes_.all.size())});
    planes_.all.push_back(p);
    return static_cast<std::int32_t>(planes_.all.size()) - 1;
  }

  // ---- events

  struct Later {
    const Planes* planes;
    bool operator()(const Event& s, const Event& t) const {
      if (const int c = planes->compare_height(s.at, t.at)) return c > 0;
      const bool sc = s.kind == Event::Kind::change, tc = t.kind == Event::Kind::change;
      if (sc != tc) return sc;  // what meets at the height of a change, meets before it
      if (sc && (s.other < 0) != (t.other < 0)) return s.other < 0;
      return s.number > t.number;
    }
  };
  void push(Event event) {
    event.number = counter_++;
    heap_.push_back(event);
    std::push_heap(heap_.begin(), heap_.end(), Later{&planes_});
  }
  Event pop() {
    std::pop_heap(heap_.begin(), heap_.end(), Later{&planes_});
    Event e = heap_.back();
    heap_.pop_back();
    return e;
  }

  /// Changes of slope above `height` (steps), and the deck.
  void push_changes(std::int64_t height) {
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
  /// The horizontal plane at a height, as a Meet that stands for the height alone.
  Meet level(std::int64_t height) {
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
  std::int32_t axis(int which) {
    if (axes_[which] < 0) {
      Plane p;
      (which == 0 ? p.a : p.b) = 1;
      p.round();
      axes_[which] = static_cast<std::int32_t>(planes_.all.size());
      planes_.all.push_back(p);
    }
    return axes_[which];
  }

  void push_collapse(std::int32_t from, std::int32_t to) {
    const Vertex &v = vertex(from), &w = vertex(to);
    // Eaves without length set out from one node and grow.
    if (v.node == w.node && v.node < corners_.size() && planes_[v.right].w != 0) return;
    if (const auto m = planes_.meet(v.left, v.right, w.right); m && planes_.compare_height(*m, now_) >= 0)
      push({*m, Event::Kind::collapse, from, to, 0});
  }
  void push_candidates(std::int32_t number) {
    push_collapse(number, vertex(number).next);
    push_collapse(vertex(number).prev, number);
    if (!vertex(number).reflex) return;
    const std::int32_t left = vertex(number).left, right = vertex(number).right;
    const Meet& origin = nodes_[vertex(number).node];
    ++stamp_;
    seen_.resize(planes_.all.size(), 0);
    for (const std::int32_t other : active_) {
      const std::int32_t k = vertex(other).right;
      if (!vertex(other).alive || k == left || k == right || seen_[static_cast<std::size_t>(k)] == stamp_) continue;
      seen_[static_cast<std::size_t>(k)] = stamp_;
      const auto m = planes_.meet(left, right, k);
      if (!m || planes_.compare_height(*m, now_) < 0) continue;
      if (planes_.side(k, origin) == 0) continue;  // it has just left that edge
      push({*m, Event::Kind::split, number, k, 0});
    }
  }

  /// Where a point on the line of the edge that starts at v lies against that start: +1 beyond, 0 at it, -1 before.
  int from_start(const Vertex& v, const Meet& m) const {
    if (v.folded) return planes_.along(v.right, nodes_[v.node], m);
    const int s = planes_.side(v.left, m);
    return v.reflex ? -s : s;
  }
  /// ... and against the end w of its edge: +1 before it.
  int to_end(const Vertex& w, const Meet& m) const {
    if (w.folded) return planes_.along(w.left, m, nodes_[w.node]);
    const int s = planes_.side(w.right, m);
    return w.reflex ? -s : s;
  }

  /// What runs through the point: an edge, or a chain of vertices that meet there.
  struct Strand {
    std::int32_t in, out;        ///< planes of the edges that arrive and leave
    std::int32_t before, after;  ///< the vertices at their other ends
  };
  struct Ray {
    std::int64_t dx, dy;
    bool out;
    std::uint32_t strand;
  };

  void finish(std::int32_t number, std::uint32_t node) {
    Vertex& v = vertex(number);
    v.alive = false;
    if (v.node == node) return;
    segments_.push_back({planes_[v.left].face, v.node, node});
    segments_.push_back({planes_[v.right].face, node, v.node});
  }

  /// Cuts and rejoins all that meets in a point now. False when what meets there makes no sense.
  bool meet_at(const Meet& at) {
    std::vector<std::int32_t>&there = there_, &through = through_;
    there.clear();
    through.clear();
    std::size_t kept = 0;
    for (const std::int32_t i : active_) {
      const Vertex& v = vertex(i);
      if (!v.alive) continue;
      active_[kept++] = i;
      if (planes_.side(v.right, at) != 0) continue;
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
        if (p.out != q.out)
          return p.out;  // a sector without width lies between an edge that leaves and one that arrives
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

  /// A new vertex between the edge that arrives with one strand and the one that leaves with another.
  void join(const Strand& arriving, const Strand& leaving, std::uint32_t node) {
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

  /// Looks after new vertices: edges on one line, loops without area; then their next events.
  bool settle() {
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

  /// Two edges on one line, running the same way, meet in a vertex: they become one edge.
  bool unite(std::int32_t number) {
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
  bool fresh(std::int32_t v) const { return std::find(fresh_.begin(), fresh_.end(), v) != fresh_.end(); }

  /// All slopes that change at a height.
  void change(const Meet& at) {
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
  std::uint32_t node_at(const Vertex& v, const Meet& height) {
    const auto m = planes_.meet(v.left, v.right, height.p[0]);
    if (!m) return v.node;  // folded ones vanish at their own height, before any change
    return node_of(*m);
  }

  /// The node at a point; one for all that happens there at that height.
  std::uint32_t node_of(const Meet& at) {
    while (first_now_ < nodes_.size() && planes_.compare_height(nodes_[first_now_], at) != 0) ++first_now_;
    for (std::size_t i = first_now_; i < nodes_.size(); ++i) {
      const Meet& m = nodes_[i];
      if (planes_.side(m.p[0], at) == 0 && planes_.side(m.p[1], at) == 0 && planes_.side(m.p[2], at) == 0)
        return static_cast<std::uint32_t>(i);
    }
    nodes_.push_back(at);
    return static_cast<std::uint32_t>(nodes_.size()) - 1;
  }
  void drop_dead() {
    std::erase_if(active_, [&](std::int32_t v) { return !vertex(v).alive; });
  }

  /// The deck: what is left of the moving polygon.
  void stop(const Meet& at) {
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

  // ---- output

  struct FaceRecord {
    std::uint32_t edge, level;
    bool upright;
    std::uint32_t root;  ///< faces that became one
    std::int32_t plane;
  };
  std::uint32_t root(std::uint32_t face) {
    while (faces_[face].root != face) face = faces_[face].root;
    return face;
  }
  void join_faces(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    faces_[std::max(a, b)].root = std::min(a, b);
  }

  tl::expected<WeightedSkeleton, SkeletonFailure> result() {
    WeightedSkeleton out;
    out.merged = merged_;
    out.nodes.reserve(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Meet& m = nodes_[i];
      out.nodes.push_back(
          i < corners_.size()
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

  /// The segment that continues a face's boundary; where the face touches itself, the one that keeps the pieces apart.
  std::optional<std::size_t> following(std::size_t at, const std::vector<char>& used, std::size_t start) const {
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

  double twice_area(const std::vector<std::uint32_t>& loop) const {
    double sum = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Meet &p = nodes_[loop[i]], &q = nodes_[loop[(i + 1) % loop.size()]], &o = nodes_[loop[0]];
      sum += (p.x - o.x) * (q.y - o.y) - (q.x - o.x) * (p.y - o.y);
    }
    return sum;
  }
  bool inside(const std::vector<std::uint32_t>& ring, const Meet& at) const {
    bool in = false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Meet &p = nodes_[ring[i]], &q = nodes_[ring[(i + 1) % ring.size()]];
      if ((p.y > at.y) != (q.y > at.y) && at.x < p.x + (at.y - p.y) / (q.y - p.y) * (q.x - p.x)) in = !in;
    }
    return in;
  }

  /// A plane that has flowed around something and met behind it has a loop that runs clockwise: a hole of another of
  /// its loops.
  void put_holes_in_faces(WeightedSkeleton& out) const {
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
  /// The face record that a piece belongs to: pieces come in the order of their records.
  std::uint32_t face_of(const WeightedSkeletonFace& face) const {
    const std::uint32_t a = face.loops[0][0], b = face.loops[0][1];
    for (const Segment& s : segments_)
      if (s.from == a && s.to == b) return s.face;
    return WeightedSkeletonFace::kDeck;
  }

  void add_decks(WeightedSkeleton& out) const {
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

  const model::Polygon& polygon_;
  std::span<const EdgeProfile> profiles_;
  std::optional<double> deck_;
  std::span<const CornerEaves> corner_eaves_;
  std::vector<Point2> corners_;
  Point2 origin_;
  Planes planes_;
  struct BasePlane {
    std::uint32_t edge;
    std::int32_t number;
    const EdgeProfile* profile;
  };
  std::vector<BasePlane> base_planes_;
  std::vector<std::pair<std::int64_t, std::int32_t>> levels_;
  std::int32_t axes_[2] = {-1, -1};
  std::vector<std::uint32_t> merged_;
  std::vector<Vertex> vertices_;
  std::vector<std::int32_t> active_, there_, through_;
  std::vector<std::int32_t> fresh_;   ///< vertices made by the event at hand
  std::vector<std::int32_t> longer_;  ///< starts of edges that became one with the next
  std::vector<Strand> strands_;
  std::vector<Ray> rays_;
  std::vector<Meet> nodes_;
  std::size_t first_now_ = 0;  ///< the first node at the height of the last event
  std::vector<Segment> segments_;
  std::vector<FaceRecord> faces_;
  std::vector<std::vector<std::uint32_t>> deck_loops_;
  std::vector<Event> heap_;
  std::vector<std::uint32_t> seen_, marks_;
  std::uint32_t stamp_ = 0, mark_ = 0, counter_ = 0;
  Meet now_;
};

}  // namespace

double WeightedSkeleton::height() const {
  double most = 0;
  for (const WeightedSkeletonNode& n : nodes) most = std::max(most, n.height);
  return most;
}

std::string_view name(SkeletonFailure failure) {
  constexpr std::string_view names[] = {"too large", "bad slope", "unbounded", "inconsistent"};
  return names[static_cast<int>(failure)];
}

tl::expected<WeightedSkeleton, SkeletonFailure> weighted_skeleton(const model::Polygon& polygon,
                                                                  std::span<const EdgeProfile> profiles,
                                                                  std::optional<double> deck,
                                                                  std::span<const CornerEaves> corners) {
  return Sweep(polygon, profiles, deck, corners).run();
}

}  // namespace blockrand::geometry
