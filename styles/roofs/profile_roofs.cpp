// Roofs whose height depends on the way across the plan alone: lean-to, butterfly, sawtooth.
//
// Lines of equal way cut the plan into strips. What lies where is decided once, for each corner and each line, with a
// tolerance; all the rest is combinatorial: corners on a line and crossings of edges with it are sorted along the line,
// each knows on which sides of it the line runs inside the plan, and neighbours that agree are joined by a chord. Faces
// are traced from edges and chords by sectors around each point, without looking at coordinates again.
//
// A line that comes into trouble (touches a corner from one side only, passes a corner narrowly, runs out of step with
// itself) is tried again up to 3 cm beside its place; heights on it stay those of the profile.
//
// Refused: strips narrower than 0.1 m, steps lower than 0.01 m, and plans in which no such line is found.
#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "styles/roofs/shape_tables.h"

namespace blockrand::roofs {

using geometry::Grid2;
using model::Point2;
using model::Point3;
using model::Polygon;
using model::Ring;
using model::RoofShape;

namespace {

constexpr double kOnLine = 0.004;   // m. Nearer corners lie on the line; half of what faces may be off their plane.
constexpr double kClear = 0.003;    // m between a chord and all that it does not touch: the checker's 2 mm and rounding
constexpr double kComfort = 0.010;  // m. A line that passes a corner more narrowly looks for a better place.
constexpr double kShift = 0.008;    // m. Steps of that search, to both sides in turn.
constexpr int kMostShifts = 4;      // to each side; of 240,000 roofs on random plans none needed more
constexpr double kNarrowestStrip = 0.1;  // m. Leaves 4 cm where its two lines shift towards each other.
constexpr double kNarrowestPlan = 0.02;  // m. Such a wall takes no roof but a flat one.
constexpr double kLeastStep = 0.01;  // m. Lower upright steps, and roofs, would be narrower than rounding keeps apart.

/// A corner of the plan.
struct Corner {
  Point2 point;
  double across = 0;  ///< m from the plan's lowest side
  std::uint32_t previous = 0, next = 0;
};

/// Where a line meets the boundary. Directions around it: 0 along the line forwards, 1 above it, 2 backwards, 3 below.
struct Item {
  double along = 0;
  Point2 point;
  std::uint32_t corner = 0;  ///< the corner, or the corner at which the crossed edge begins
  bool crossing = false;
  int out = 0, in = 0;                       ///< directions in which the boundary leads on and from which it comes
  bool forwards = false, backwards = false;  ///< the line runs inside the plan there
};

/// A line of the profile in its place, with what it does to the plan.
struct Cut {
  double across = 0;
  std::vector<Item> items;                                      ///< in order along the line
  std::vector<std::pair<std::uint32_t, std::uint32_t>> chords;  ///< items, the first one backwards
  double gap = 0;                                               ///< m to the nearest corner that is not on the line
};

/// The plan as a profile sees it.
struct Frame {
  Point2 origin, up;
  std::vector<Corner> corners;
  std::vector<std::uint32_t> ring_starts;  ///< and the number of corners
  double width = 0;

  double across(Point2 p) const { return (p.x - origin.x) * up.x + (p.y - origin.y) * up.y; }
  double along(Point2 p) const { return (p.x - origin.x) * up.y - (p.y - origin.y) * up.x; }
};

Frame frame_of(const Polygon& plan, Point2 up) {
  Frame frame;
  frame.up = up;
  frame.origin = plan.outer.points[0];  // differences from a near point keep all digits far from the CRS's origin
  const auto add = [&](const Ring& ring) {
    const auto first = static_cast<std::uint32_t>(frame.corners.size()), n = static_cast<std::uint32_t>(ring.size());
    frame.ring_starts.push_back(first);
    for (std::uint32_t i = 0; i < n; ++i)
      frame.corners.push_back(
          {ring.points[i], frame.across(ring.points[i]), first + (i + n - 1) % n, first + (i + 1) % n});
  };
  add(plan.outer);
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const Corner& c : frame.corners) {
    lowest = std::min(lowest, c.across);
    highest = std::max(highest, c.across);
  }
  for (const Ring& hole : plan.holes) add(hole);
  frame.ring_starts.push_back(static_cast<std::uint32_t>(frame.corners.size()));
  for (Corner& c : frame.corners) c.across -= lowest;
  frame.width = highest - lowest;
  return frame;
}

bool cross(Grid2 a, Grid2 b, Grid2 c, Grid2 d) {
  return geometry::orientation(a, b, c) != geometry::orientation(a, b, d) &&
         geometry::orientation(c, d, a) != geometry::orientation(c, d, b);
}

/// Does the chord from p to q keep its distance from the piece of boundary from a to b? Common ends are allowed.
bool clear(Point2 p, Point2 q, Point2 a, Point2 b) {
  const bool starts = p == a || p == b, ends = q == a || q == b;
  if (starts && ends) return false;
  if (!starts && geometry::distance_to_segment(p, a, b) < kClear) return false;
  if (!ends && geometry::distance_to_segment(q, a, b) < kClear) return false;
  if (a != p && a != q && geometry::distance_to_segment(a, p, q) < kClear) return false;
  if (b != p && b != q && geometry::distance_to_segment(b, p, q) < kClear) return false;
  return starts || ends ||
         !cross(geometry::to_grid(p), geometry::to_grid(q), geometry::to_grid(a), geometry::to_grid(b));
}

/// The line at `across`, when the plan can be cut cleanly there.
std::optional<Cut> cut(const Frame& frame, double across) {
  Cut out{across, {}, {}, std::numeric_limits<double>::infinity()};
  const auto side = [&](std::uint32_t c) {
    const double d = frame.corners[c].across - across;
    return std::fabs(d) <= kOnLine ? 0 : d > 0 ? 1 : -1;
  };
  for (std::uint32_t c = 0; c < frame.corners.size(); ++c) {
    const Corner& corner = frame.corners[c];
    const int here = side(c), there = side(corner.next);
    if (here != 0) out.gap = std::min(out.gap, std::fabs(corner.across - across));
    if (here == 0) {
      const double along = frame.along(corner.point);
      const auto direction = [&](std::uint32_t other) {
        const int s = side(other);
        if (s != 0) return s > 0 ? 1 : 3;
        return frame.along(frame.corners[other].point) > along ? 0 : 2;
      };
      Item item{.along = along,
                .point = corner.point,
                .corner = c,
                .out = direction(corner.next),
                .in = direction(corner.previous)};
      if (item.out == item.in) {
        const bool convex = geometry::orientation(geometry::to_grid(frame.corners[corner.previous].point),
                                                  geometry::to_grid(corner.point),
                                                  geometry::to_grid(frame.corners[corner.next].point)) > 0;
        // A corner that points at the line from outside would be the only contact of two pieces, and below an upright
        // step they would touch in an edge; one that lies along the line is a needle.
        if (!convex || item.out == 0 || item.out == 2) return std::nullopt;
      } else {
        for (int d = (item.out + 1) % 4; d != item.in; d = (d + 1) % 4) {
          if (d == 0) item.forwards = true;
          if (d == 2) item.backwards = true;
        }
      }
      out.items.push_back(item);
    } else if (here * there < 0) {
      const Corner& next = frame.corners[corner.next];
      const double t = (across - corner.across) / (next.across - corner.across);
      const Point2 p = model::snap(Point2{corner.point.x + t * (next.point.x - corner.point.x),
                                          corner.point.y + t * (next.point.y - corner.point.y)});
      Item item{.along = frame.along(p),
                .point = p,
                .corner = c,
                .crossing = true,
                .out = there > 0 ? 1 : 3,
                .in = there > 0 ? 3 : 1};
      (there > 0 ? item.backwards : item.forwards) = true;
      out.items.push_back(item);
    }
  }
  std::sort(out.items.begin(), out.items.end(),
            [](const Item& a, const Item& b) { return a.along != b.along ? a.along < b.along : a.corner < b.corner; });
  bool inside = false;
  for (std::uint32_t i = 0; i < out.items.size(); ++i) {
    if (out.items[i].backwards != inside) return std::nullopt;
    if (inside) out.chords.emplace_back(i - 1, i);
    inside = out.items[i].forwards;
  }
  if (inside) return std::nullopt;

  // Whatever tolerance and rounding have done, chords must not come near what they do not touch.
  std::vector<const Item*> crossing_of(frame.corners.size(), nullptr);
  for (const Item& item : out.items)
    if (item.crossing) crossing_of[item.corner] = &item;
  constexpr double kNear = kOnLine + 2 * kClear;  // m from the line; edges farther off cannot come near a chord
  for (std::uint32_t c = 0; c < frame.corners.size(); ++c) {
    const Corner &a = frame.corners[c], &b = frame.corners[a.next];
    if (std::min(a.across, b.across) > across + kNear || std::max(a.across, b.across) < across - kNear) continue;
    for (const auto& [first, last] : out.chords) {
      const Point2 p = out.items[first].point, q = out.items[last].point;
      if (const Item* x = crossing_of[c]) {
        if (!clear(p, q, a.point, x->point) || !clear(p, q, x->point, b.point)) return std::nullopt;
      } else if (!clear(p, q, a.point, b.point)) {
        return std::nullopt;
      }
    }
  }
  return out;
}

/// The line at or near `across`: where it is asked if it passes no corner narrowly there, else the nearest place that
/// is as good, else the best one.
std::optional<Cut> cut_near(const Frame& frame, double across) {
  std::optional<Cut> best;
  for (int step = 0; step <= 2 * kMostShifts; ++step) {
    const int shift = (step + 1) / 2 * (step % 2 == 0 ? 1 : -1);
    auto found = cut(frame, across + shift * kShift);
    if (!found) continue;
    if (found->gap >= kComfort) return found;
    if (!best || found->gap > best->gap) best = std::move(found);
  }
  return best;
}

/// Part of the profile between two lines: heights at its ends, in metres above the eaves.
struct Strip {
  double from = 0, to = 0;
  double z_from = 0, z_to = 0;
  double z(double across) const { return z_from + (z_to - z_from) * (across - from) / (to - from); }
};

/// Plan corners and crossings, linked to the boundary, with the strips that meet there.
struct Vertex {
  Point2 point;
  double across = 0;
  std::int32_t line = -1;
  std::uint32_t previous = 0, next = 0;
  std::uint32_t out_strip = 0, in_strip = 0;
};

class Subdivision {
 public:
  Subdivision(const Frame& frame, std::span<const Cut> cuts, std::span<const Strip> strips)
      : frame_(frame), cuts_(cuts), strips_(strips) {}

  /// Empty when the lines' decisions do not fit together.
  std::optional<Roof> roof() {
    place_vertices();
    if (!link_half_edges()) return std::nullopt;
    Roof out;
    if (!trace_faces(out)) return std::nullopt;
    raise_steps(out);
    raise_walls(out);
    return out;
  }

 private:
  Point3 point(std::uint32_t vertex, std::uint32_t strip) const {
    const Vertex& v = vertices_[vertex];
    const Strip& s = strips_[strip];
    // On a line only its own height counts, so that both of its sides have the same.
    double z = 0;
    if (v.line < 0)
      z = s.z(v.across);
    else
      z = static_cast<std::uint32_t>(v.line) == strip ? s.z_to : s.z_from;
    return {v.point.x, v.point.y, z};
  }

  void place_vertices() {
    const auto corners = static_cast<std::uint32_t>(frame_.corners.size());
    for (const Corner& c : frame_.corners) {
      std::uint32_t strip = 0;
      while (strip < cuts_.size() && cuts_[strip].across < c.across) ++strip;
      vertices_.push_back({.point = c.point,
                           .across = c.across,
                           .previous = c.previous,
                           .next = c.next,
                           .out_strip = strip,
                           .in_strip = strip});
    }
    crossings_.resize(corners);
    for (std::uint32_t k = 0; k < cuts_.size(); ++k) {
      std::vector<std::uint32_t> vertex_of;
      for (const Item& item : cuts_[k].items) {
        std::uint32_t v = item.corner;
        if (item.crossing) {
          v = static_cast<std::uint32_t>(vertices_.size());
          vertices_.push_back({.point = item.point, .across = cuts_[k].across});
          crossings_[item.corner].push_back(v);
        }
        Vertex& vertex = vertices_[v];
        vertex.line = static_cast<std::int32_t>(k);
        // Left of the line's direction is above it.
        vertex.out_strip = item.out <= 1 ? k + 1 : k;
        vertex.in_strip = item.in == 1 || item.in == 2 ? k + 1 : k;
        vertex_of.push_back(v);
      }
      for (const auto& [first, last] : cuts_[k].chords) chords_.push_back({vertex_of[first], vertex_of[last], k});
    }
    for (std::uint32_t c = 0; c < corners; ++c) {
      auto& on_edge = crossings_[c];
      const std::uint32_t end = frame_.corners[c].next;
      if (frame_.corners[end].across < frame_.corners[c].across) std::reverse(on_edge.begin(), on_edge.end());
      std::uint32_t from = c;
      for (const std::uint32_t v : on_edge) {
        vertices_[from].next = v;
        vertices_[v].previous = from;
        from = v;
      }
      vertices_[from].next = end;
      vertices_[end].previous = from;
    }
  }

  /// Half-edges: the boundary's by the vertex where they start, then each chord forwards (above it) and back (below
  /// it).
  bool link_half_edges() {
    const auto n = static_cast<std::uint32_t>(vertices_.size());
    const std::size_t count = n + 2 * chords_.size();
    next_.resize(count);
    start_.resize(count);
    strip_.resize(count);
    for (std::uint32_t v = 0; v < n; ++v) {
      start_[v] = v;
      strip_[v] = vertices_[v].out_strip;
      next_[vertices_[v].previous] = v;
      if (vertices_[v].in_strip != vertices_[vertices_[v].previous].out_strip) return false;
    }
    std::vector<bool> taken(n, false);
    for (std::uint32_t c = 0; c < chords_.size(); ++c) {
      const auto& [first, last, line] = chords_[c];
      if (taken[first] || taken[last]) return false;  // cut() leaves no point with two chords
      taken[first] = taken[last] = true;
      const std::uint32_t forwards = n + 2 * c, back = forwards + 1;
      start_[forwards] = first;
      start_[back] = last;
      strip_[forwards] = line + 1;
      strip_[back] = line;
      next_[back] = first;
      next_[vertices_[first].previous] = forwards;
      next_[forwards] = last;
      next_[vertices_[last].previous] = back;
    }
    return true;
  }

  bool trace_faces(Roof& roof) const {
    struct Hole {
      std::vector<Point3> loop;
      std::uint32_t strip;
    };
    std::vector<Hole> holes;
    std::vector<std::uint32_t> strip_of;
    std::vector<std::vector<Point2>> outlines;
    std::vector<bool> visited(next_.size(), false);
    for (std::uint32_t h = 0; h < next_.size(); ++h) {
      if (visited[h]) continue;
      std::vector<Point3> loop;
      std::vector<Point2> flat;
      for (std::uint32_t g = h; !visited[g]; g = next_[g]) {
        visited[g] = true;
        if (strip_[g] != strip_[h]) return false;
        loop.push_back(point(start_[g], strip_[g]));
        flat.push_back(loop.back().xy());
      }
      if (loop.size() < 3) return false;
      if (geometry::signed_area(flat) > 0) {
        roof.surfaces.push_back({-1, {std::move(loop)}});
        outlines.push_back(std::move(flat));
        strip_of.push_back(strip_[h]);
      } else {
        holes.push_back({std::move(loop), strip_[h]});
      }
    }
    for (Hole& hole : holes) {
      std::size_t f = 0;
      while (f < outlines.size() && !(strip_of[f] == hole.strip && geometry::contains(outlines[f], hole.loop[0].xy())))
        ++f;
      if (f == outlines.size()) return false;
      roof.surfaces[f].loops.push_back(std::move(hole.loop));
    }
    return true;
  }

  void raise_steps(Roof& roof) const {
    for (const auto& [first, last, line] : chords_) {
      const Point3 first_below = point(first, line), first_above = point(first, line + 1);
      const Point3 last_below = point(last, line), last_above = point(last, line + 1);
      if (first_below.z == first_above.z) continue;
      Roof::Surface surface;
      surface.upright = true;
      if (first_above.z < first_below.z)
        surface.loops = {{last_above, first_above, first_below, last_below}};
      else
        surface.loops = {{first_below, last_below, last_above, first_above}};
      roof.surfaces.push_back(std::move(surface));
    }
  }

  void raise_walls(Roof& roof) const {
    // Where an upright piece begins at a corner, its foot lies on the side of the higher one of the two walls.
    const auto foot = [&](std::uint32_t v, std::uint32_t own, std::uint32_t other) -> std::optional<Point3> {
      const Point3 p = point(v, other);
      if (own == other || p.z >= point(v, own).z) return std::nullopt;
      return p;
    };
    for (std::uint32_t c = 0; c < frame_.corners.size(); ++c) {
      const std::uint32_t end = frame_.corners[c].next;
      const Vertex &a = vertices_[c], &b = vertices_[end];
      std::vector<Point3> top;
      if (const auto p = foot(end, b.in_strip, b.out_strip)) top.push_back(*p);
      top.push_back(point(end, b.in_strip));
      for (auto x = crossings_[c].rbegin(); x != crossings_[c].rend(); ++x) {
        const Point3 after = point(*x, vertices_[*x].out_strip), before = point(*x, vertices_[*x].in_strip);
        top.push_back(after);
        if (before != after) top.push_back(before);
      }
      top.push_back(point(c, a.out_strip));
      if (const auto p = foot(c, a.out_strip, a.in_strip)) top.push_back(*p);
      roof.wall_tops.push_back(std::move(top));
    }
  }

  struct Chord {
    std::uint32_t first, last, line;
  };

  const Frame& frame_;
  std::span<const Cut> cuts_;
  std::span<const Strip> strips_;
  std::vector<Vertex> vertices_;
  std::vector<std::vector<std::uint32_t>> crossings_;  ///< per plan edge, from its start
  std::vector<Chord> chords_;
  std::vector<std::uint32_t> next_, start_, strip_;  ///< per half-edge
};

}  // namespace

std::vector<ProfilePoint> profile_points(RoofShape shape, double width_across) {
  const auto* across = model::constructed_as<model::ProfileRoof>(shape);
  if (!across) return {};
  using enum model::CrossProfile;
  switch (across->profile) {
    case skillion:
      return {{0, 0}, {1, 1}};
    case saltbox:
      return {{0, 0}, {0.6, 1}, {1, 1}};
    case butterfly:
      return {{0, 1}, {0.5, 0}, {1, 1}};
    case gabled_height_moved:
      return {{0, 0}, {0.5, 0.7}, {0.5, 1}, {1, 0.3}};
    case sawtooth: {
      constexpr double kToothWidth = 5;  // m, docs/roofs.md
      const int teeth = std::max(2, static_cast<int>(std::lround(width_across / kToothWidth)));
      std::vector<ProfilePoint> points;
      for (int i = 0; i < teeth; ++i) {
        points.push_back({static_cast<double>(i) / teeth, 0});
        points.push_back({static_cast<double>(i + 1) / teeth, 1});
      }
      return points;
    }
  }
  return {};
}

std::optional<Roof> profile_roof(const Polygon& plan, RoofMeasures measures, Point2 up,
                                 std::span<const ProfilePoint> profile) {
  if (plan.outer.size() < 3 || profile.size() < 2 || measures.height < kLeastStep) return std::nullopt;
  const Frame frame = frame_of(plan, up);
  if (frame.width < kNarrowestPlan) return std::nullopt;

  std::vector<Strip> strips;
  const auto z = [&](double share) { return measures.eaves + measures.height * share; };
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const ProfilePoint &a = profile[i], &b = profile[i + 1];
    if (a.at == b.at) continue;
    const Strip strip{a.at * frame.width, b.at * frame.width, z(a.height), z(b.height)};
    if (!strips.empty()) {
      const double step = std::fabs(strip.z_from - strips.back().z_to);
      if (step != 0 && step < kLeastStep) return std::nullopt;
    }
    strips.push_back(strip);
  }
  if (strips.size() > 1)
    for (const Strip& strip : strips)
      if (strip.to - strip.from < kNarrowestStrip) return std::nullopt;
  std::vector<Cut> cuts;
  for (std::size_t k = 0; k + 1 < strips.size(); ++k) {
    auto found = cut_near(frame, strips[k].to);
    if (!found) return std::nullopt;
    strips[k].to = strips[k + 1].from = found->across;
    cuts.push_back(std::move(*found));
  }
  return Subdivision(frame, cuts, strips).roof();
}

}  // namespace blockrand::roofs
