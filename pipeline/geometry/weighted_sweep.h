// The sweep of a weighted straight skeleton: planes rise over the edges of a polygon, corners move along their
// intersections until they meet. Of weighted_skeleton.cpp and the three sources that implement it; everybody else takes
// weighted_skeleton.h.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/moving_planes.h"
#include "pipeline/geometry/weighted_skeleton.h"

namespace blockrand::geometry::moving_planes {

using model::Point2;

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

/// Where a reflex corner may meet edges, the next place first. All corners together have as many as edges times reflex
/// corners: those of one corner wait here, and only the first of them among the events.
struct Splits {
  struct Place {
    double z = 0, error = 0;  ///< of its Meet
    std::int32_t plane = -1;
    std::uint32_t number = 0;  ///< of its Event
  };
  std::int32_t left = -1, right = -1;  ///< the corner's planes when the places were found
  std::vector<Place> heap;
};

/// One run of weighted_skeleton().
class Sweep {
 public:
  Sweep(const model::Polygon& polygon, std::span<const EdgeProfile> profiles, std::optional<double> deck,
        std::span<const CornerEaves> corner_eaves)
      : polygon_(polygon), profiles_(profiles), deck_(deck), corner_eaves_(corner_eaves) {}

  tl::expected<WeightedSkeleton, SkeletonFailure> run();

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
  static bool good(const EdgeProfile& profile);
  static bool good_height(double metres) {
    constexpr double kHighest = 2000;
    return metres > 0 && metres <= kHighest && to_grid(metres) > 0;
  }

  /// Which of two profiles on one line holds: the gentler one where they first differ, from below.
  static bool gentler(const EdgeProfile& p, const EdgeProfile& q);

  std::optional<SkeletonFailure> prepare();

  /// Puts two edges without length between the edges of a corner: the one that ends here, then one that runs as the edge
  /// that starts here, one that runs as the edge that ends here, and the one that starts here.
  bool add_corner_eaves(const CornerEaves& eaves);
  /// A sloping plane on the line of an upright one.
  std::int32_t plane_beside(std::int32_t upright, const CornerEaves& eaves);

  /// The plane of an edge, and those it turns into. Edges on one line with one profile share theirs.
  std::int32_t base_plane(Grid2 from, Grid2 to, const EdgeProfile& profile, std::uint32_t edge);
  void add_changes(std::int32_t number, double length, const EdgeProfile& profile, std::uint32_t edge);
  static bool on_line(const Plane& p, Grid2 at) {
    return static_cast<Int128>(p.a) * at.x + static_cast<Int128>(p.b) * at.y + (p.c >> kSpeedBits) == 0;
  }
  static bool same(const EdgeProfile& p, const EdgeProfile& q) {
    if (p.slope != q.slope || p.changes.size() != q.changes.size()) return false;
    for (std::size_t i = 0; i < p.changes.size(); ++i)
      if (p.changes[i].height != q.changes[i].height || p.changes[i].slope != q.changes[i].slope) return false;
    return true;
  }
  std::int32_t add(Plane p, std::uint32_t edge, std::uint32_t level);

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
  /// The same of splits of one corner.
  struct LaterSplit {
    const Planes* planes;
    std::int32_t left, right;
    bool operator()(const Splits::Place& s, const Splits::Place& t) const {
      const auto at = [&](const Splits::Place& p) { return Meet{{left, right, p.plane}, 0, 0, p.z, p.error}; };
      if (const int c = planes->compare_height(at(s), at(t))) return c > 0;
      return s.number > t.number;
    }
  };
  void push(Event event) {
    event.number = counter_++;
    push_numbered(event);
  }
  void push_numbered(const Event& event) {
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
  void push_changes(std::int64_t height);
  /// The horizontal plane at a height, as a Meet that stands for the height alone.
  Meet level(std::int64_t height);
  std::int32_t axis(int which);

  void push_collapse(std::int32_t from, std::int32_t to);
  void push_candidates(std::int32_t number);
  /// The next split of a reflex corner becomes an event.
  void push_next_split(std::int32_t number);

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

  void finish(std::int32_t number, std::uint32_t node);

  /// Cuts and rejoins all that meets in a point now. False when what meets there makes no sense.
  bool meet_at(const Meet& at);

  /// A new vertex between the edge that arrives with one strand and the one that leaves with another.
  void join(const Strand& arriving, const Strand& leaving, std::uint32_t node);

  /// Looks after new vertices: edges on one line, loops without area; then their next events.
  bool settle();

  /// Two edges on one line, running the same way, meet in a vertex: they become one edge.
  bool unite(std::int32_t number);
  bool fresh(std::int32_t v) const { return std::find(fresh_.begin(), fresh_.end(), v) != fresh_.end(); }

  /// All slopes that change at a height.
  void change(const Meet& at);
  std::uint32_t node_at(const Vertex& v, const Meet& height) {
    const auto m = planes_.meet(v.left, v.right, height.p[0]);
    if (!m) return v.node;  // folded ones vanish at their own height, before any change
    return node_of(*m);
  }

  /// The node at a point; one for all that happens there at that height.
  std::uint32_t node_of(const Meet& at);
  void drop_dead() {
    std::erase_if(active_, [&](std::int32_t v) { return !vertex(v).alive; });
  }

  /// The deck: what is left of the moving polygon.
  void stop(const Meet& at);

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

  tl::expected<WeightedSkeleton, SkeletonFailure> result();

  /// The segment that continues a face's boundary; where the face touches itself, the one that keeps the pieces apart.
  std::optional<std::size_t> following(std::size_t at, const std::vector<char>& used, std::size_t start) const;

  double twice_area(const std::vector<std::uint32_t>& loop) const;
  bool inside(const std::vector<std::uint32_t>& ring, const Meet& at) const;

  /// A plane that has flowed around something and met behind it has a loop that runs clockwise: a hole of another of
  /// its loops.
  void put_holes_in_faces(WeightedSkeleton& out) const;
  /// The face record that a piece belongs to: pieces come in the order of their records.
  std::uint32_t face_of(const WeightedSkeletonFace& face) const {
    const std::uint32_t a = face.loops[0][0], b = face.loops[0][1];
    for (const Segment& s : segments_)
      if (s.from == a && s.to == b) return s.face;
    return WeightedSkeletonFace::kDeck;
  }

  void add_decks(WeightedSkeleton& out) const;

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
  std::vector<Splits> splits_;  ///< by vertex
  std::vector<std::uint32_t> seen_, marks_;
  std::uint32_t stamp_ = 0, mark_ = 0, counter_ = 0;
  Meet now_;
};

}  // namespace blockrand::geometry::moving_planes
