#include "styles/roofs/caps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/model/vector.h"
#include "styles/roofs/roof_outline.h"

namespace blockrand::roofs {

using geometry::Grid3;
using model::Point2;
using model::Point3;
using model::RoofElementKind;
using model::SurfaceKind;

namespace {

constexpr double kFalls = 0.0349;      ///< tan 2 degrees: a surface that falls less from a line is level
constexpr double kRising = 0.0524;     ///< tan 3 degrees: a line that rises more is a hip
constexpr double kTouch = 0.003;       ///< m: what overlaps by less touches
constexpr double kShortest = 0.02;     ///< m: a foot shorter than this is none
constexpr double kBluntest = 2.6;      ///< rad (150 degrees): beyond, an end is square instead of cut along an edge
constexpr double kSharpest = 0.17;     ///< rad (10 degrees): an end this pointed is none
constexpr double kLeastAcross = 0.17;  ///< sine of 10 degrees: an edge nearer to the line's direction cuts nothing
constexpr double kGoesOn = 0.01;       ///< sine: an overhang's corner this far off the line continues it

Point2 unit(Point2 v) {
  const double length = std::hypot(v.x, v.y);
  return {v.x / length, v.y / length};
}

/// Where a loop has an edge.
struct EdgeAt {
  std::uint32_t surface = 0, loop = 0, index = 0;
};
using Edge = std::pair<Grid3, Grid3>;

/// One side of a line: it runs from one end to the other with the surface on its left.
struct Half {
  EdgeAt at;
  RoofPlane plane;
  Point2 start_foot, end_foot;  ///< of the cap on this side, in plan
};

struct Line {
  Point3 from, to;
  bool capped = true;
  Half left, right;                        ///< `right` runs from `to` to `from`
  std::optional<Point2> cut_from, cut_to;  ///< where something stands on the line
  const OverhangCorner* beyond_from = nullptr;
  const OverhangCorner* beyond_to = nullptr;
};

class Caps {
 public:
  Caps(const Roof& roof, std::span<const OverhangCorner> corners, std::span<const std::vector<Point2>> keep_clear,
       const CapOptions& options)
      : roof_(roof), keep_clear_(keep_clear.begin(), keep_clear.end()), options_(options) {
    for (std::uint32_t s = 0; s < roof.surfaces.size(); ++s)
      for (std::uint32_t l = 0; l < roof.surfaces[s].loops.size(); ++l) {
        const auto& loop = roof.surfaces[s].loops[l];
        for (std::uint32_t i = 0; i < loop.size(); ++i)
          edges_[{geometry::to_grid(loop[i]), geometry::to_grid(loop[(i + 1) % loop.size()])}] = {s, l, i};
      }
    for (const OverhangCorner& c : corners) corners_[geometry::to_grid(c.inner)] = &c;
    for (const auto& [edge, at] : edges_) {
      if (!(edge.first < edge.second)) continue;
      const auto twin = edges_.find({edge.second, edge.first});
      if (twin == edges_.end()) continue;
      if (auto line = line_of(at, twin->second)) {
        ++asked_;
        cut(*line);
        line_at_[edge] = line_at_[{edge.second, edge.first}] = lines_.size();
        lines_.push_back(*line);
      }
    }
  }

  BuiltElements take() {
    do {
      for (Line& line : lines_)
        if (line.capped) place_feet(line);
    } while (drop_conflicts());
    BuiltElements out;
    out.asked = asked_;
    for (const RoofElementKind kind : {RoofElementKind::ridge_cap, RoofElementKind::hip_cap})
      for (Line& line : lines_) {
        const bool hip = std::fabs(line.to.z - line.from.z) > kRising * length_of(line);
        if (!line.capped || (kind == RoofElementKind::hip_cap) != hip) continue;
        CellBodies made = bodies_of_cells(cells(line), {SurfaceKind::roof, SurfaceKind::wall, SurfaceKind::closure});
        if (made.solids.size() == 1 && made.lost.empty()) {
          out.bodies.push_back({kind, std::move(made.solids[0]), {}});
          if (line.cut_from || line.cut_to) ++out.shortened;
        } else {
          line.capped = false;
        }
      }
    for (const Line& line : lines_) out.refused += !line.capped;
    return out;
  }

 private:
  static double length_of(const Line& l) { return std::hypot(l.to.x - l.from.x, l.to.y - l.from.y); }
  const std::vector<Point3>& loop_of(const EdgeAt& e) const { return roof_.surfaces[e.surface].loops[e.loop]; }

  /// The line of an edge between two surfaces, where both fall from it.
  std::optional<Line> line_of(const EdgeAt& left, const EdgeAt& right) const {
    const auto &a = roof_.surfaces[left.surface], &b = roof_.surfaces[right.surface];
    if (a.upright || b.upright) return std::nullopt;
    Line line;
    const auto& loop = loop_of(left);
    line.from = loop[left.index];
    line.to = loop[(left.index + 1) % loop.size()];
    const double length = length_of(line);
    if (length < options_.least_length) return std::nullopt;
    const Point2 along = unit(line.to.xy() - line.from.xy()), inward{-along.y, along.x};
    line.left = {left, plane_of(a), {}, {}};
    line.right = {right, plane_of(b), {}, {}};
    const Point2 g = line.left.plane.gradient, h = line.right.plane.gradient;
    const double falls_left = -dot(g, inward), falls_right = dot(h, inward);
    if (falls_left < kFalls || falls_right < kFalls) return std::nullopt;
    const double lengths = std::sqrt((1 + dot(g, g)) * (1 + dot(h, h)));
    if ((1 + dot(g, h)) / lengths > base::cos(options_.least_bend)) return std::nullopt;
    const auto end = [&](Point3 p) -> const OverhangCorner* {
      const auto found = corners_.find(geometry::to_grid(p));
      if (found == corners_.end()) return nullptr;
      // The line must go on in its direction there, as planes that go on do.
      const Point2 beyond = found->second->outer.xy() - p.xy();
      const bool straight = std::fabs(cross(unit(beyond), along)) < kGoesOn;
      return straight ? found->second : nullptr;
    };
    line.beyond_from = end(line.from);
    line.beyond_to = end(line.to);
    return line;
  }

  /// Ends a line before what stands on it.
  void cut(Line& line) const {
    const Point2 from = line.from.xy(), along = unit(line.to.xy() - from);
    const double length = length_of(line), half = options_.width / 2 + kTouch;
    double start = 0, end = length;
    for (const auto& piece : keep_clear_) {
      // What of the piece lies in the cap's band, along the line.
      double first = 1e9, last = -1e9;
      for (std::size_t i = 0; i < piece.size(); ++i) {
        const Point2 p = piece[i] - from, q = piece[(i + 1) % piece.size()] - from;
        double u = 0, v = 1;
        const double lp = cross(along, p), lq = cross(along, q);
        for (const double side : {1.0, -1.0}) {
          const double a = half - side * lp, b = half - side * lq;  // within when not negative
          if (a < 0 && b < 0)
            u = 2;
          else if (a < 0)
            u = std::max(u, a / (a - b));
          else if (b < 0)
            v = std::min(v, a / (a - b));
        }
        if (u > v) continue;
        for (const double share : {u, v}) {
          const double s = dot(along, {p.x + share * (q.x - p.x), p.y + share * (q.y - p.y)});
          first = std::min(first, s);
          last = std::max(last, s);
        }
      }
      if (first >= end || last <= start) continue;
      // The longer one of both rests stays.
      if (first - start > end - last)
        end = first;
      else
        start = last;
    }
    if (end - start < options_.least_length) {
      line.capped = false;
      return;
    }
    if (start > kTouch) line.cut_from = from + along * start;
    if (end < length - kTouch) line.cut_to = from + along * end;
  }

  /// The foot of a cap at one end, on the left of the direction `along` away from the end `node`.
  /// \param next  the loop's next edge from the node, away from it; \param capped  it has a cap, too
  std::optional<Point2> foot(Point2 node, Point2 along, Point2 next, bool capped, bool turned) const {
    const double half = options_.width / 2;
    const Point2 side = turned ? Point2{along.y, -along.x} : Point2{-along.y, along.x};
    // The surface lies between the line and the next edge.
    double angle = base::atan2(turned ? -cross(along, next) : cross(along, next), dot(along, next));
    if (angle < 0) angle += 2 * 3.14159265358979323846;
    if (capped) {
      const double s = base::sin(angle / 2), c = base::cos(angle / 2);
      if (s < base::sin(kSharpest / 2)) return std::nullopt;
      return node + side * half + along * (half * c / s);
    }
    if (angle > kBluntest) return node + side * half;
    if (angle < kSharpest) return std::nullopt;
    return node + side * half + along * (half * base::cos(angle) / base::sin(angle));
  }

  void place_feet(Line& line) {
    const Point2 along = unit(line.to.xy() - line.from.xy());
    // A cap that is wider than the overhang's edge ends at the wall.
    const auto too_wide = [&](const OverhangCorner* c) {
      if (!c) return false;
      const auto beyond = [&](Point2 edge, double length) {
        return length * std::fabs(cross(edge, along)) < options_.width / 2;
      };
      return beyond(c->before, c->length_before) || beyond(c->after, c->length_after);
    };
    if (too_wide(line.beyond_from)) line.beyond_from = nullptr;
    if (too_wide(line.beyond_to)) line.beyond_to = nullptr;
    const auto feet = [&](Half& half, Point3 start, Point3 end, Point2 way, const std::optional<Point2>& cut_start,
                          const std::optional<Point2>& cut_end) {
      const auto& loop = loop_of(half.at);
      const std::size_t n = loop.size(), i = half.at.index;
      const Point3 before = loop[(i + n - 1) % n], after = loop[(i + 2) % n];
      const auto capped = [&](Point3 p, Point3 q) {
        const auto found = line_at_.find({geometry::to_grid(p), geometry::to_grid(q)});
        return found != line_at_.end() && lines_[found->second].capped;
      };
      const Point2 side{-way.y, way.x};
      const auto at = [&](Point3 node, Point2 away, Point3 other, bool turned) -> std::optional<Point2> {
        const Point2 next = other.xy() - node.xy();
        if (next.x == 0 && next.y == 0) return node.xy() + side * (options_.width / 2);
        return foot(node.xy(), away, unit(next), capped(node, other), turned);
      };
      const auto first = cut_start ? *cut_start + side * (options_.width / 2) : at(start, way, before, false);
      const auto last = cut_end ? *cut_end + side * (options_.width / 2) : at(end, {-way.x, -way.y}, after, true);
      if (!first || !last) return false;
      half.start_foot = *first;
      half.end_foot = *last;
      return true;
    };
    if (!feet(line.left, line.from, line.to, along, line.cut_from, line.cut_to) ||
        !feet(line.right, line.to, line.from, {-along.x, -along.y}, line.cut_to, line.cut_from))
      line.capped = false;
  }

  Point2 start_of(const Line& l) const { return l.cut_from ? *l.cut_from : l.from.xy(); }
  Point2 end_of(const Line& l) const { return l.cut_to ? *l.cut_to : l.to.xy(); }

  /// What one half covers, counter-clockwise.
  std::vector<Point2> outline(const Line& l, bool left) const {
    if (left) return {start_of(l), end_of(l), l.left.end_foot, l.left.start_foot};
    return {end_of(l), start_of(l), l.right.end_foot, l.right.start_foot};
  }

  /// The same, on to the edge of the overhang and cut along it.
  std::vector<Point2> extended(const Line& l, bool left) const {
    auto o = outline(l, left);
    const Point2 way = unit(o[1] - o[0]), across{-way.y, way.x};
    const auto extend = [&](const OverhangCorner* c, bool at_start) {
      if (!c) return;
      // Seen outwards, a ring runs from right to left: what leaves the corner lies on the left.
      const Point2 edge = at_start ? c->before : c->after;
      const double along_edge = dot(edge, across);
      if (std::fabs(along_edge) < kLeastAcross) return;
      const Point2 tip = c->outer.xy();
      o[at_start ? 0 : 1] = tip;
      o[at_start ? 3 : 2] = tip + edge * (options_.width / 2 / along_edge);
    };
    const bool cut_start = left ? l.cut_from.has_value() : l.cut_to.has_value(),
               cut_end = left ? l.cut_to.has_value() : l.cut_from.has_value();
    if (!cut_start) extend(left ? l.beyond_from : l.beyond_to, true);
    if (!cut_end) extend(left ? l.beyond_to : l.beyond_from, false);
    return o;
  }

  bool drop_conflicts() {
    std::set<std::size_t> bad, back;
    bool changed = false;
    std::map<std::uint32_t, std::vector<std::pair<std::size_t, bool>>> by_surface;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (!lines_[i].capped) continue;
      for (const bool left : {true, false}) {
        const Half& half = left ? lines_[i].left : lines_[i].right;
        by_surface[half.at.surface].push_back({i, left});
        const auto o = outline(lines_[i], left);
        const Point2 way = unit(o[1] - o[0]);
        if (dot(o[2] - o[3], way) < kShortest) {
          bad.insert(i);
          continue;
        }
        for (const auto& loop : roof_.surfaces[half.at.surface].loops)
          for (std::size_t k = 0; k < loop.size(); ++k)
            if (segment_enters(o, loop[k].xy(), loop[(k + 1) % loop.size()].xy(), kTouch)) bad.insert(i);
      }
    }
    // Where an oblique end comes into something's place, a square one may not.
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      Line& l = lines_[i];
      if (!l.capped || bad.contains(i)) continue;
      for (const auto& piece : keep_clear_) {
        if (!convex_overlap(extended(l, true), piece, kTouch) && !convex_overlap(extended(l, false), piece, kTouch))
          continue;
        if (l.cut_from && l.cut_to) {
          bad.insert(i);
        } else {
          if (!l.cut_from) l.cut_from = l.from.xy();
          if (!l.cut_to) l.cut_to = l.to.xy();
          changed = true;
        }
        break;
      }
    }
    for (const auto& [surface, halves] : by_surface)
      for (std::size_t i = 0; i < halves.size(); ++i)
        for (std::size_t k = i + 1; k < halves.size(); ++k)
          if (!bad.contains(halves[i].first) && !bad.contains(halves[k].first)) {
            const auto [one, one_left] = halves[i];
            const auto [other, other_left] = halves[k];
            if (!convex_overlap(extended(lines_[one], one_left), extended(lines_[other], other_left), kTouch)) continue;
            if (!convex_overlap(outline(lines_[one], one_left), outline(lines_[other], other_left), kTouch)) {
              back.insert({one, other});
              continue;
            }
            // The shorter one gives way.
            const bool first = length_of(lines_[halves[i].first]) < length_of(lines_[halves[k].first]);
            bad.insert(first ? halves[i].first : halves[k].first);
          }
    changed = changed || !back.empty();
    for (const std::size_t i : back) lines_[i].beyond_from = lines_[i].beyond_to = nullptr;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (bad.contains(i)) lines_[i].capped = false;
      if (!lines_[i].capped && counted_.insert(i).second) changed = true;
    }
    return changed;
  }

  /// Height of the cap above the roof at a share of the way from ridge (0) to foot (1) that falls by `fall` on it.
  double rise(double share, double fall) const {
    if (share >= 1) return 0;
    if (options_.profile == CapProfile::triangular) return options_.height * (1 - share);
    const double whole = options_.height + fall;  // of the arc, crown to foot
    return options_.height - whole * (1 - std::sqrt(1 - share * share)) + fall * share;
  }

  std::vector<PlanCell> cells(const Line& line) const {
    std::vector<PlanCell> out;
    const int pieces = options_.profile == CapProfile::triangular ? 1 : std::max(1, options_.segments);
    const Point2 along = unit(line.to.xy() - line.from.xy());
    const double rises = (line.to.z - line.from.z) / length_of(line);
    const auto ridge = [&](Point2 p) { return line.from.z + rises * dot(p - line.from.xy(), along); };
    const auto side = [&](const Half& half, bool left) {
      const auto o = extended(line, left);
      const Point2 way = unit(o[1] - o[0]), across{-way.y, way.x};
      const double fall = -dot(half.plane.gradient, across) * options_.width / 2;
      const auto corner = [&](bool at_start, double share) {
        const Point2 node = o[at_start ? 0 : 1], foot = o[at_start ? 3 : 2];
        const Point2 p = model::snap(Point2{node.x + share * (foot.x - node.x), node.y + share * (foot.y - node.y)});
        const Point2 way_on = p - node;
        const double under = ridge(node) + dot(half.plane.gradient, way_on);
        return PlanCell::Corner{p, under, under + rise(share, fall), false};
      };
      for (int i = 0; i < pieces; ++i) {
        // Equal angles of the arc.
        const auto share = [&](int k) {
          return pieces == 1 || k == 0 || k == pieces ? static_cast<double>(k) / pieces
                                                      : base::sin(k * 3.14159265358979323846 / 2 / pieces);
        };
        out.push_back({{{corner(true, share(i)), corner(false, share(i)), corner(false, share(i + 1)),
                         corner(true, share(i + 1))}}});
      }
    };
    side(line.left, true);
    side(line.right, false);
    return out;
  }

  const Roof& roof_;
  std::vector<std::vector<Point2>> keep_clear_;
  CapOptions options_;
  std::map<Edge, EdgeAt> edges_;
  std::map<Grid3, const OverhangCorner*> corners_;
  std::vector<Line> lines_;
  std::map<Edge, std::size_t> line_at_;
  std::set<std::size_t> counted_;
  int asked_ = 0;
};

}  // namespace

BuiltElements ridge_and_hip_caps(const Roof& roof, std::span<const OverhangCorner> corners,
                                 std::span<const std::vector<Point2>> keep_clear, const CapOptions& options) {
  return Caps(roof, corners, keep_clear, options).take();
}

}  // namespace blockrand::roofs
