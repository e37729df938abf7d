#include "styles/roofs/overhangs.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"
#include "styles/roofs/roof_outline.h"

namespace blockrand::roofs {

using model::Point2;
using model::Point3;
using model::RoofEdge;
using model::RoofElementKind;
using model::SurfaceKind;

namespace {

constexpr double kRising = 0.0524;     ///< tan 3 degrees: a wall top steeper than this is a gable's
constexpr double kShortest = 0.02;     ///< m: an outer edge shorter than this is none
constexpr double kTouch = 0.003;       ///< m: what overlaps by less touches; three grid steps
constexpr double kSameLine = 0.02;     ///< sine: pieces that bend less continue each other
constexpr double kLeastAcross = 0.17;  ///< sine of 10 degrees: a cut along a line that runs nearer to the wall is none

bool rises(const TopSegment& top) { return std::fabs(top.to.z - top.from.z) > kRising * top.length(); }

/// The strip before one top segment.
struct Strip {
  TopSegment top;
  RoofElementKind kind = RoofElementKind::eaves;
  double asked = 0, reach = 0;          ///< m
  std::uint32_t before = 0, after = 0;  ///< neighbours in the ring
  bool step_after = false;              ///< an upright step lies between this one and the next
  Point2 start, end;                    ///< outer corners
  bool joined_after = false;            ///< shares its outer corner with the next one
  std::vector<Point2> outline() const { return {top.from.xy(), start, end, top.to.xy()}; }
};

/// Where a strip ends at an edge that has none: as a vector from the corner to the outer one, for a reach of 1 m.
/// \param along  away from the strip, along its wall
/// \param other  the other edge's direction, away from the corner
Point2 bare_end(Point2 outward, Point2 along, Point2 other) {
  const double reaches = dot(other, outward);
  // An inner corner: flush with the wall there where that leans over this strip; else square.
  if (reaches > kLeastAcross && dot(other, along) < 0) return {other.x / reaches, other.y / reaches};
  // An outer one: never beyond the other wall's line, which a neighbour may share, and never beyond the corner.
  if (reaches < -kLeastAcross && dot(other, along) > 0) return {other.x / reaches, other.y / reaches};
  return outward;
}

class Overhangs {
 public:
  Overhangs(const model::Polygon& plan, const Roof& roof, std::span<const OverhangRoom> rooms,
            const OverhangOptions& options)
      : plan_(plan), edges_(plan_edges(plan)), options_(options) {
    const auto tops = top_segments(plan, roof);
    rooms_.resize(edges_.size(), OverhangRoom{}.gutter_room);
    for (std::size_t i = 0; i < rooms.size() && i < rooms_.size(); ++i) rooms_[i] = rooms[i].gutter_room;
    std::set<std::uint32_t> gables;
    for (const TopSegment& top : tops)
      if (rises(top)) gables.insert(top.edge);
    for (std::size_t i = 0; i < tops.size();) {
      std::size_t end = i;
      while (end < tops.size() && tops[end].ring == tops[i].ring) ++end;
      for (std::size_t k = i; k < end; ++k) {
        Strip s;
        s.top = tops[k];
        s.before = static_cast<std::uint32_t>(k == i ? end - 1 : k - 1);
        s.after = static_cast<std::uint32_t>(k + 1 == end ? i : k + 1);
        s.step_after = tops[s.after].from != s.top.to;
        // Where a deck ends in a gable, its border is the gable's.
        const bool deck = s.top.surface >= 0 && gables.contains(s.top.edge) &&
                          is_level(roof.surfaces[static_cast<std::size_t>(s.top.surface)]);
        if (rises(s.top) || deck) s.kind = RoofElementKind::verge;
        const OverhangRoom room = rooms.empty() ? OverhangRoom{} : rooms[s.top.edge];
        if (room.edge != RoofEdge::party_wall && room.room > 0) {
          s.asked = s.kind == RoofElementKind::verge ? options.verge : options.eaves;
          const double steepness = std::fabs(dot(s.top.gradient, s.top.outward()));
          s.reach = std::min(s.asked, room.room);
          if (s.reach * steepness > options.most_drop) s.reach = options.most_drop / steepness;
          if (s.top.surface < 0 || s.reach < options.least) s.reach = 0;
        }
        strips_.push_back(s);
      }
      i = end;
    }
  }

  BuiltOverhangs take() {
    settle();
    BuiltOverhangs out;
    std::set<std::uint32_t> asked, shortened, bare, built;
    for (const Strip& s : strips_) {
      if (s.asked == 0) continue;
      asked.insert(s.top.edge);
      if (s.reach == 0)
        bare.insert(s.top.edge);
      else if (s.reach < s.asked - 1e-9)
        shortened.insert(s.top.edge);
    }
    for (const RoofElementKind kind : {RoofElementKind::eaves, RoofElementKind::verge}) {
      std::vector<PlanCell> cells;
      std::vector<std::uint32_t> strip_of;
      for (std::uint32_t i = 0; i < strips_.size(); ++i) {
        if (strips_[i].reach == 0 || strips_[i].kind != kind) continue;
        cells.push_back(cell(strips_[i]));
        strip_of.push_back(i);
      }
      CellBodies made = bodies_of_cells(cells, {SurfaceKind::roof, SurfaceKind::wall, SurfaceKind::outer_ceiling});
      for (model::Solid& solid : made.solids) out.elements.bodies.push_back({kind, std::move(solid), {}});
      for (const std::uint32_t lost : made.lost) {
        strips_[strip_of[lost]].reach = 0;
        bare.insert(strips_[strip_of[lost]].top.edge);
      }
    }
    for (const Strip& s : strips_)
      if (s.reach > 0) built.insert(s.top.edge);
    out.elements.asked = static_cast<int>(asked.size());
    for (const std::uint32_t edge : asked) {
      if (!built.contains(edge))
        ++out.elements.refused;
      else if (shortened.contains(edge) || bare.contains(edge))
        ++out.elements.shortened;
    }
    if (options_.before_eaves > 0) {
      out.eaves = eaves_lines();
      for (const PlanEdge& e : edges_) out.walls.emplace_back(e.from, e.to);
      for (const Strip& s : strips_) out.strips.push_back(s.reach > 0 ? s.outline() : std::vector<Point2>());
    }
    for (const Strip& s : strips_) {
      const Strip& next = strips_[s.after];
      if (s.reach == 0 || next.reach == 0 || !s.joined_after) continue;
      const double z = height(s, s.top.to, s.end), other = height(next, next.top.from, next.start);
      if (std::fabs(z - other) > kSameHeight) continue;
      out.corners.push_back({s.top.to,
                             {s.end.x, s.end.y, z},
                             s.top.along,
                             next.top.along,
                             std::hypot(s.end.x - s.start.x, s.end.y - s.start.y),
                             std::hypot(next.end.x - next.start.x, next.end.y - next.start.y)});
    }
    return out;
  }

 private:
  bool clear_of_all(const std::vector<Point2>& plan) const {
    for (const Strip& s : strips_)
      if (s.reach > 0 && convex_overlap(plan, s.outline(), kTouch)) return false;
    return true;
  }

  /// The outer edges of the eaves, and of the same strips had they come farther out: where those stand in nothing's way.
  std::vector<EavesLine> eaves_lines() const {
    Overhangs wider = *this;
    const auto widen = [&](double by) {
      for (Strip& s : wider.strips_)
        if (s.reach > 0 && s.kind == RoofElementKind::eaves) s.reach += by;
      wider.join_all();
      // Corners that are cut square here are so there: whether a mitre is too long hangs on the larger reach.
      for (std::size_t i = 0; i < strips_.size(); ++i) {
        Strip &w = wider.strips_[i], &next = wider.strips_[w.after];
        if (strips_[i].joined_after || !w.joined_after) continue;
        w.joined_after = false;
        w.end = model::snap(strips_[i].end + w.top.outward() * (w.reach - strips_[i].reach));
        next.start = model::snap(strips_[w.after].start + next.top.outward() * (next.reach - strips_[w.after].reach));
      }
    };
    widen(options_.before_eaves + 2 * kTouch);  // what touches by rounding would overlap
    const std::set<std::uint32_t> in_the_way = wider.conflicts();
    widen(-2 * kTouch);
    std::vector<EavesLine> out;
    bool before_is_in = false;
    for (std::uint32_t i = 0; i < strips_.size(); ++i) {
      const Strip &s = strips_[i], &w = wider.strips_[i];
      // No water comes down to the high side of a lean-to.
      constexpr double kLeastFall = 0.02;
      const double falls = -dot(s.top.gradient, s.top.outward());
      bool is_in = falls > kLeastFall && s.reach > 0 && s.kind == RoofElementKind::eaves && !in_the_way.contains(i) &&
                   w.reach <= rooms_[s.top.edge];
      is_in = is_in && clear_of_all({s.start, w.start, w.end, s.end});
      if (!out.empty() && before_is_in) {
        // Slopes of two pitches come down to two heights.
        const double here = height(s, s.top.from, s.start);
        out.back().joined_after &= is_in && std::fabs(out.back().to.z - here) < kSameHeight;
      }
      before_is_in = is_in;
      if (!is_in) continue;
      const double a = height(s, s.top.from, s.start), b = height(s, s.top.to, s.end);
      out.push_back({{s.start.x, s.start.y, a},
                     {s.end.x, s.end.y, b},
                     w.start,
                     w.end,
                     s.top.from.xy(),
                     s.top.to.xy(),
                     s.top.along,
                     s.reach,
                     falls,
                     i,
                     s.joined_after && w.joined_after && s.after == i + 1});
    }
    return out;
  }

  static double height(const Strip& s, Point3 inner, Point2 outer) {
    return inner.z + dot(s.top.gradient, {outer.x - inner.x, outer.y - inner.y});
  }

  PlanCell cell(const Strip& s) const {
    const double t = options_.thickness;
    const Point3 a = s.top.from, b = s.top.to;
    const double za = height(s, a, s.start), zb = height(s, b, s.end);
    return {{{{a.xy(), a.z - t, a.z, false},
              {s.start, za - t, za, false},
              {s.end, zb - t, zb, false},
              {b.xy(), b.z - t, b.z, true}}}};
  }

  /// The outer corners between a strip and the next one.
  void join(Strip& s, Strip& next) const {
    s.joined_after = false;
    const Point2 corner = s.top.to.xy();
    const Point2 n = s.top.outward(), m = next.top.outward();
    const bool same_edge = s.top.edge == next.top.edge;
    if (s.reach == 0 || next.reach == 0) {
      const bool straight = same_edge || std::fabs(cross(s.top.along, next.top.along)) < kSameLine;
      if (s.reach > 0)
        s.end = model::snap(corner + (straight ? n : bare_end(n, s.top.along, next.top.along)) * s.reach);
      if (next.reach > 0) {
        const Point2 back{-next.top.along.x, -next.top.along.y}, other{-s.top.along.x, -s.top.along.y};
        next.start = model::snap(corner + (straight ? m : bare_end(m, back, other)) * next.reach);
      }
      return;
    }
    const double turn = cross(s.top.along, next.top.along), same_way = dot(s.top.along, next.top.along);
    if (std::fabs(turn) < kSameLine && same_way > 0) {
      Point2 ray{n.x + m.x, n.y + m.y};
      const double length = std::hypot(ray.x, ray.y);
      ray = {ray.x / length, ray.y / length};
      const Point2 bend{s.top.gradient.x - next.top.gradient.x, s.top.gradient.y - next.top.gradient.y};
      const double bends = std::hypot(bend.x, bend.y);
      if (!s.step_after && bends > kRising) {
        // Both planes go on to where they meet: a ridge keeps its direction.
        Point2 line{-bend.y / bends, bend.x / bends};
        if (dot(line, ray) < 0) line = {-line.x, -line.y};
        constexpr double kMostSkew = 0.7;  // cosine of 45 degrees
        if (dot(line, ray) > kMostSkew) ray = {line.x / dot(line, ray), line.y / dot(line, ray)};
      }
      s.end = model::snap(corner + ray * s.reach);
      next.start = model::snap(corner + ray * next.reach);
      s.joined_after = s.end == next.start && !s.step_after;
      return;
    }
    // Where the outer edges meet: corner + n * s.reach + along * way.
    if (std::fabs(turn) >= kSameLine) {
      const double way = (next.reach - s.reach * dot(n, m)) / dot(s.top.along, m);
      const Point2 meet = corner + n * s.reach + s.top.along * way;
      if (turn < 0 ||
          std::hypot(meet.x - corner.x, meet.y - corner.y) <= options_.longest_mitre * std::max(s.reach, next.reach)) {
        s.end = next.start = model::snap(meet);
        s.joined_after = true;
        return;
      }
    }
    s.end = model::snap(corner + n * s.reach);
    next.start = model::snap(corner + m * next.reach);
  }

  void join_all() {
    for (std::uint32_t i = 0; i < strips_.size(); ++i) {
      // `join` works on two strips at once; a ring of one strip has no other.
      if (strips_[i].after != i) join(strips_[i], strips_[strips_[i].after]);
    }
  }

  /// Is this strip no strip: turned over, or within the building?
  bool spoilt(const Strip& s) const {
    if (dot({s.end.x - s.start.x, s.end.y - s.start.y}, s.top.along) < kShortest) return true;
    const auto outline = s.outline();
    const auto [low, high] = box(s);
    for (const PlanEdge& e : edges_) {
      if (std::max(e.from.x, e.to.x) < low.x || std::min(e.from.x, e.to.x) > high.x ||
          std::max(e.from.y, e.to.y) < low.y || std::min(e.from.y, e.to.y) > high.y)
        continue;
      if (segment_enters(outline, e.from, e.to, kTouch)) return true;
    }
    // A gable that goes on over lower parts of the roof, beyond its plan edge.
    return geometry::contains(plan_, {(s.top.from.x + s.top.to.x + s.start.x + s.end.x) / 4,
                                      (s.top.from.y + s.top.to.y + s.start.y + s.end.y) / 4});
  }

  static std::pair<Point2, Point2> box(const Strip& s) {
    const auto [x0, x1] = std::minmax({s.top.from.x, s.top.to.x, s.start.x, s.end.x});
    const auto [y0, y1] = std::minmax({s.top.from.y, s.top.to.y, s.start.y, s.end.y});
    return {{x0, y0}, {x1, y1}};
  }

  std::set<std::uint32_t> conflicts() const {
    std::set<std::uint32_t> out;
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < strips_.size(); ++i)
      if (strips_[i].reach > 0) order.push_back(i);
    for (const std::uint32_t i : order)
      if (spoilt(strips_[i])) out.insert(i);
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t k) {
      return std::pair(box(strips_[i]).first.x, i) < std::pair(box(strips_[k]).first.x, k);
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Strip& s = strips_[order[i]];
      const auto [low, high] = box(s);
      for (std::size_t k = i + 1; k < order.size(); ++k) {
        const Strip& t = strips_[order[k]];
        const auto [other_low, other_high] = box(t);
        if (other_low.x > high.x) break;
        if (other_low.y > high.y || other_high.y < low.y || out.contains(order[i]) || out.contains(order[k])) continue;
        if (convex_overlap(s.outline(), t.outline(), kTouch)) {
          out.insert(order[i]);
          out.insert(order[k]);
        }
      }
    }
    return out;
  }

  /// Halves what is in the way of something else until nothing is.
  void settle() {
    for (;;) {
      join_all();
      const auto bad = conflicts();
      if (bad.empty()) return;
      std::set<std::pair<std::uint32_t, RoofElementKind>> halved;
      for (const std::uint32_t i : bad) halved.insert({strips_[i].top.edge, strips_[i].kind});
      for (Strip& s : strips_) {
        if (s.reach == 0 || !halved.contains({s.top.edge, s.kind})) continue;
        s.reach /= 2;
        if (s.reach < options_.least) s.reach = 0;
      }
    }
  }

  const model::Polygon& plan_;
  std::vector<PlanEdge> edges_;
  std::vector<double> rooms_;  ///< m before each plan edge, for gutters
  std::vector<Strip> strips_;
  OverhangOptions options_;
};

}  // namespace

BuiltOverhangs overhangs(const model::Polygon& plan, const Roof& roof, std::span<const OverhangRoom> rooms,
                         const OverhangOptions& options) {
  return Overhangs(plan, roof, rooms, options).take();
}

}  // namespace blockrand::roofs
