#include "styles/roofs/eaves_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "pipeline/geometry/planar_faces.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/model/vector.h"
#include "styles/roofs/roof_sides.h"
#include "styles/roofs/wing_ends.h"

namespace blockrand::roofs {

using model::Point2;
using model::Point3;
using model::Polygon;
using model::Ring;
using model::RoofEdge;

namespace {

constexpr double kSameWay = 0.97814760073380569;  ///< cosine of 12 degrees: edges of one facade
/// m. What an edge of a facade may come off the line from one end to the other: eaves stay level. A front that bends is
/// two.
constexpr double kDrift = 0.25;
constexpr double kTurns = 0.34202014332566871;  ///< sine of 20 degrees: lines that meet in a corner
constexpr double kLongestGap = 12;              ///< m along the outline between two edges of one facade: a wide bay
constexpr double kSameCorner = 0.10;            ///< m. Lines that meet so near a corner of the plan meet in it
constexpr double kChip = 0.6;                   ///< m. A shorter piece of wall makes no facade
/// m below the eaves to which a roof may come down over a bay: half a storey, so that the bay keeps its windows.
constexpr double kDeepestDrop = 1.4;
constexpr double kMostChange = 0.2;  ///< of the plan's area

// ---- facades of a ring

class RingFacades {
 public:
  RingFacades(const std::vector<PlanSide>& edges, std::size_t begin, std::size_t count, double depth)
      : edges_(edges), begin_(begin), count_(count), depth_(depth), lead_(count, count) {}

  /// False when no facade has several edges.
  bool find() {
    std::vector<std::size_t> order(count_);
    for (std::size_t i = 0; i < count_; ++i) order[i] = i;
    // By length, then by place: neither rounding nor the start of the ring decides.
    const auto key = [&](std::size_t e) {
      return std::tuple(-std::llround(edge(e).length * 100), std::min(edge(e).from, edge(e).to));
    };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
    bool any = false;
    for (const std::size_t e : order) {
      if (lead_[e] != count_) continue;
      lead_[e] = e;
      any = grow(e, 1) || any;
      any = grow(e, count_ - 1) || any;
    }
    // Chips of walls at corners belong to the neighbour that runs more their way.
    for (std::size_t e = 0; e < count_; ++e) {
      if (lead_[e] != e || edge(e).length > kChip) continue;
      const std::size_t before = lead_[(e + count_ - 1) % count_], after = lead_[(e + 1) % count_];
      if (before == e || after == e || before == after || edge(before).length <= kChip || edge(after).length <= kChip)
        continue;
      const double on = dot(edge(before).along(), edge(e).along()), ahead = dot(edge(after).along(), edge(e).along());
      if (std::fabs(cross(edge(before).along(), edge(after).along())) < kTurns) continue;  // a step
      lead_[e] = on >= ahead ? before : after;
      any = true;
    }
    return any;
  }

  struct Corner {
    Point2 at;
    std::size_t lead;  ///< of the facade that starts here, as an edge of the ring; count for a step of its own
    std::size_t before = 0, after = 0;  ///< facades on both sides of it
  };
  /// The corners between facades, in order.
  std::vector<Corner> corners() const {
    std::vector<Corner> out;
    for (std::size_t i = 0; i < count_; ++i) {
      const std::size_t before = lead_[(i + count_ - 1) % count_], after = lead_[i];
      if (before == after) continue;
      const PlanSide &a = edge(before), &b = edge(after);
      const Point2 here = edge(i).from;
      const double sine = cross(a.along(), b.along());
      if (std::fabs(sine) >= kTurns) {
        const double t = cross(b.from - a.from, b.along()) / sine;
        const Point2 meet{a.from.x + t * a.along().x, a.from.y + t * a.along().y};
        if (distance(meet, here) <= kSameCorner) {
          out.push_back({here, after, before, after});
          continue;
        }
        if (distance(meet, here) <= 2 * depth_) {
          out.push_back({meet, after, before, after});
          continue;
        }
      }
      // A step between two lines: each keeps its own.
      const Point2 from = foot(a, here), to = foot(b, here);
      out.push_back({from, distance(from, to) > kSameCorner ? count_ : after, before, after});
      if (distance(from, to) > kSameCorner) out.push_back({to, after, before, after});
    }
    return out;
  }

  std::size_t lead(std::size_t i) const { return lead_[i]; }

 private:
  const PlanSide& edge(std::size_t i) const { return edges_[begin_ + i]; }
  static Point2 foot(const PlanSide& line, Point2 p) {
    const Point2 u = line.along();
    const double t = dot(p - line.from, u);
    return {line.from.x + t * u.x, line.from.y + t * u.y};
  }
  bool near(const PlanSide& line, Point2 p) const { return std::fabs(cross(line.along(), p - line.from)) <= depth_; }

  /// Takes edges into the facade of `lead`, one way round the ring (step 1 or count - 1).
  bool grow(std::size_t lead, std::size_t step) {
    const PlanSide line = edge(lead);
    bool any = false;
    std::size_t last = lead;
    for (;;) {
      double gap = 0;
      bool found = false;
      for (std::size_t e = (last + step) % count_; e != lead && lead_[e] == count_; e = (e + step) % count_) {
        if (!near(line, edge(e).from) || !near(line, edge(e).to)) break;
        const double way = dot(line.along(), edge(e).along());
        // It must lead on, not back past what the facade has.
        const Point2 end = step == 1 ? edge(e).to : edge(e).from, has = step == 1 ? edge(last).to : edge(last).from;
        const double on = dot(end - has, line.along()) * (step == 1 ? 1 : -1);
        const double drift = std::fabs(cross(line.along(), edge(e).to - edge(e).from));
        if (way >= kSameWay && drift <= kDrift && on > 0) {
          for (std::size_t f = (last + step) % count_;; f = (f + step) % count_) {
            lead_[f] = lead;
            if (f == e) break;
          }
          last = e;
          found = any = true;
          break;
        }
        gap += edge(e).length;
        if (gap > kLongestGap) break;
      }
      if (!found) return any;
    }
  }

  const std::vector<PlanSide>& edges_;
  std::size_t begin_, count_;
  double depth_;
  std::vector<std::size_t> lead_;  ///< of each edge: the longest one of its facade; count while it has none
};

/// What a facade is: a party wall when enough of it is (party_share_of()), else what most of it is.
RoofEdge kind_of(const std::vector<PlanSide>& edges, const std::vector<RoofEdge>& kinds, std::size_t begin,
                 const RingFacades& facades, std::size_t count, std::size_t lead) {
  std::array<double, 4> length{};
  double all = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (facades.lead(i) != lead) continue;
    if (dot(edges[begin + i].along(), edges[begin + lead].along()) < kSameWay) continue;  // a return
    length[static_cast<std::size_t>(kinds[begin + i])] += edges[begin + i].length;
    all += edges[begin + i].length;
  }
  constexpr auto kParty = static_cast<std::size_t>(RoofEdge::party_wall);
  if (length[kParty] >= party_share_of(edges[begin + lead], street_outlook(edges, kinds)) * all)
    return RoofEdge::party_wall;
  length[kParty] = 0;
  return static_cast<RoofEdge>(std::max_element(length.begin(), length.end()) - length.begin());
}

// ---- bringing a roof onto a plan

struct Plane {
  double a = 0, b = 0, c = 0;  ///< z = a (x - x0) + b (y - y0) + c
  Point2 origin;
  double z(Point2 p) const { return a * (p.x - origin.x) + b * (p.y - origin.y) + c; }
};

std::optional<Plane> plane_of(const std::vector<Point3>& loop) {
  const Point3 o = loop[0];
  double nx = 0, ny = 0, nz = 0, mx = 0, my = 0, mz = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Point3 p = loop[i], q = loop[(i + 1) % loop.size()];
    nx += (p.y - o.y) * (q.z - o.z) - (p.z - o.z) * (q.y - o.y);
    ny += (p.z - o.z) * (q.x - o.x) - (p.x - o.x) * (q.z - o.z);
    nz += (p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x);
    mx += p.x - o.x, my += p.y - o.y, mz += p.z - o.z;
  }
  if (nz <= 0) return std::nullopt;
  const double n = static_cast<double>(loop.size());
  return Plane{-nx / nz, -ny / nz, o.z + mz / n, {o.x + mx / n, o.y + my / n}};
}

bool contains(const Roof::Surface& surface, Point2 p) {
  const auto inside = [&](const std::vector<Point3>& loop) {
    bool in = false;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point3 a = loop[i], b = loop[(i + 1) % loop.size()];
      if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) in = !in;
    }
    return in;
  };
  if (!inside(surface.loops[0])) return false;
  for (std::size_t h = 1; h < surface.loops.size(); ++h)
    if (inside(surface.loops[h])) return false;
  return true;
}

class Bringer {
 public:
  Bringer(const Roof& roof, const Polygon& eaves, const Polygon& plan)
      : roof_(roof), eaves_edges_(plan_sides(eaves)), plan_(plan), edges_(plan_sides(plan)) {}

  std::optional<Roof> run() {
    for (const Roof::Surface& s : roof_.surfaces) {
      if (s.upright) return std::nullopt;
      const auto plane = plane_of(s.loops[0]);
      if (!plane) return std::nullopt;
      planes_.push_back(*plane);
    }
    find_creases();
    for (const Border& b : border_)
      if (!on_eaves(b)) return std::nullopt;  // a wall stands there between two heights of the roof
    std::vector<geometry::DividingLine> lines = creases_as_lines();
    for (std::size_t e = 0; e < edges_.size(); ++e) lines.push_back({e, {edges_[e].from, edges_[e].to}, {}});
    Roof out;
    std::vector<std::vector<Point2>> on_wall(edges_.size());
    for (const geometry::Face& face : geometry::faces_of_lines(lines)) {
      const Point2 inner = geometry::inner_point(face.polygon);
      if (!geometry::contains(plan_, inner)) continue;
      const std::size_t s = surface_at(inner);
      if (s == roof_.surfaces.size()) return std::nullopt;
      Roof::Surface surface;
      std::size_t number = 0;
      double longest = 0;
      const auto add = [&](const Ring& ring) {
        std::vector<Point3> loop;
        for (std::size_t i = 0; i < ring.size(); ++i, ++number) {
          const Point2 p = ring.points[i], q = ring.points[(i + 1) % ring.size()];
          const auto z = height(p, s);
          if (!z) return false;
          loop.push_back({p.x, p.y, *z});
          const std::uint64_t line = face.edges[number].line;
          if (line >= edges_.size()) continue;
          on_wall[line].push_back(p);
          on_wall[line].push_back(q);
          const Point2 out_of = edges_[line].outwards();
          if (distance(p, q) > longest && -planes_[s].a * out_of.x - planes_[s].b * out_of.y > 0) {
            longest = distance(p, q);
            surface.edge = static_cast<std::int32_t>(line);
          }
        }
        surface.loops.push_back(std::move(loop));
        return true;
      };
      if (!add(face.polygon.outer)) return std::nullopt;
      for (const Ring& hole : face.polygon.holes)
        if (!add(hole)) return std::nullopt;
      out.surfaces.push_back(std::move(surface));
    }
    double eaves = heights_.empty() ? 0 : heights_.begin()->second;
    for (const auto& [from, to, surface] : border_) eaves = std::min(eaves, planes_[surface].z(from));
    for (const auto& [at, z] : heights_)
      if (z < eaves - kDeepestDrop) return std::nullopt;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      std::vector<Point2>& points = on_wall[e];
      const auto along = [&](Point2 p) { return dot(p - edges_[e].from, edges_[e].along()); };
      std::sort(points.begin(), points.end(),
                [&](Point2 a, Point2 b) { return along(a) != along(b) ? along(a) > along(b) : a < b; });
      points.erase(std::unique(points.begin(), points.end()), points.end());
      if (points.size() < 2 || points.front() != edges_[e].to || points.back() != edges_[e].from) return std::nullopt;
      out.wall_tops.emplace_back();
      for (const Point2 p : points) out.wall_tops.back().push_back({p.x, p.y, heights_.at(p)});
    }
    return out;
  }

 private:
  struct Crease {
    Point3 from, to;
    std::size_t left = 0, right = 0;  ///< surfaces
  };
  /// Where a crease comes to the border of the roof.
  struct End {
    Point2 at;
    std::size_t left = 0, right = 0;
    bool convex = true;  ///< a ridge or hip: the lower of the two planes is the roof
  };

  struct Border {
    Point2 from, to;
    std::size_t surface;
  };

  void find_creases() {
    std::map<std::pair<Point3, Point3>, std::size_t> arcs;
    for (std::size_t s = 0; s < roof_.surfaces.size(); ++s)
      for (const auto& loop : roof_.surfaces[s].loops)
        for (std::size_t i = 0; i < loop.size(); ++i) arcs[{loop[i], loop[(i + 1) % loop.size()]}] = s;
    std::map<Point3, int> border;
    for (const auto& [arc, s] : arcs) {
      const auto back = arcs.find({arc.second, arc.first});
      if (back == arcs.end()) {
        ++border[arc.first];
        border_.push_back({arc.first.xy(), arc.second.xy(), s});
      } else if (arc.first < arc.second) {
        creases_.push_back({arc.first, arc.second, s, back->second});
      }
    }
    for (const Crease& c : creases_)
      for (const bool at_end : {false, true}) {
        const Point3 p = at_end ? c.to : c.from, other = at_end ? c.from : c.to;
        if (!border.contains(p)) continue;
        // Beside the crease, on its left one's side, the left plane lies lower than the right one's on a ridge.
        const Point2 u = c.to.xy() - c.from.xy(), middle{(p.x + other.x) / 2, (p.y + other.y) / 2};
        const Point2 left{middle.x - u.y, middle.y + u.x};
        ends_.push_back({p.xy(), c.left, c.right, planes_[c.left].z(left) < planes_[c.right].z(left)});
      }
  }

  std::vector<geometry::DividingLine> creases_as_lines() const {
    constexpr double kBeyond = kDeepestBay + 0.5;  // m
    std::vector<geometry::DividingLine> out;
    std::uint64_t id = edges_.size();
    for (const Crease& c : creases_) {
      Point2 from = c.from.xy(), to = c.to.xy();
      const double length = distance(from, to);
      if (length <= 0) continue;
      const Point2 u{(to.x - from.x) / length, (to.y - from.y) / length};
      // A crease that comes alone to the border runs on through the wall, wherever that stands: its own end, a grid
      // step beside the wall, would be a second corner there. Corners of the plan, and common ends, stay.
      const auto runs_on = [&](Point2 p) {
        return std::count_if(ends_.begin(), ends_.end(), [&](const End& e) { return e.at == p; }) == 1 &&
               std::none_of(edges_.begin(), edges_.end(), [&](const PlanSide& e) { return e.from == p; });
      };
      geometry::DividingLine line{id++, {}, {}};
      line.points.push_back(runs_on(from) ? model::snap(Point2{from.x - kBeyond * u.x, from.y - kBeyond * u.y}) : from);
      line.points.push_back(runs_on(to) ? model::snap(Point2{to.x + kBeyond * u.x, to.y + kBeyond * u.y}) : to);
      out.push_back(std::move(line));
    }
    return out;
  }

  /// Does a piece of the roof's border lie on the edges of the plan that it was made for?
  bool on_eaves(const Border& b) const {
    constexpr double kOnEdge = 0.01;  // m
    const Point2 middle{(b.from.x + b.to.x) / 2, (b.from.y + b.to.y) / 2};
    return std::any_of(eaves_edges_.begin(), eaves_edges_.end(), [&](const PlanSide& e) {
      return geometry::distance_to_segment(middle, e.from, e.to) <= kOnEdge;
    });
  }

  /// The surface whose plane the roof has at a point, beyond its border as well.
  std::size_t surface_at(Point2 p) const {
    for (std::size_t s = 0; s < roof_.surfaces.size(); ++s)
      if (contains(roof_.surfaces[s], p)) return s;
    std::size_t found = roof_.surfaces.size();
    double nearest = 0;
    for (const Border& b : border_) {
      const double d = geometry::distance_to_segment(p, b.from, b.to);
      if (found == roof_.surfaces.size() || d < nearest) {
        nearest = d;
        found = b.surface;
      }
    }
    // Near the end of a crease the planes themselves decide: the way straight to the border may cross the crease.
    constexpr double kNear = 3.0;  // m
    double nearest_end = kNear;
    std::size_t decided = found;
    for (const End& e : ends_) {
      if ((e.left != found && e.right != found) || distance(e.at, p) >= nearest_end) continue;
      nearest_end = distance(e.at, p);
      const bool left_lower = planes_[e.left].z(p) < planes_[e.right].z(p);
      decided = left_lower == e.convex ? e.left : e.right;
    }
    return decided;
  }

  /// One height for each point, whichever surface asks first; none where surfaces do not meet.
  std::optional<double> height(Point2 p, std::size_t s) {
    constexpr double kMeets = 0.008;  // m: rounding of a point on steep planes; the checker allows 0.01
    const double z = model::snap(planes_[s].z(p));
    const auto [place, fresh] = heights_.try_emplace(p, z);
    if (!fresh && std::fabs(place->second - z) > kMeets) return std::nullopt;
    return place->second;
  }

  const Roof& roof_;
  std::vector<PlanSide> eaves_edges_;
  const Polygon& plan_;
  std::vector<PlanSide> edges_;
  std::vector<Plane> planes_;
  std::vector<Crease> creases_;
  std::vector<End> ends_;
  std::vector<Border> border_;
  std::map<Point2, double> heights_;
};

}  // namespace

std::optional<EavesPlan> eaves_plan(const Polygon& plan, const std::vector<RoofEdge>& edges) {
  const std::vector<PlanSide> all = plan_sides(plan);
  const double depth = std::min(kDeepestBay, kBayShare * geometry::equivalent_width(plan));
  const bool known = edges.size() == all.size();
  EavesPlan out;
  bool any = false;
  std::size_t begin = 0;
  const auto add = [&](const Ring& ring, Ring& to) {
    const std::size_t n = ring.size();
    RingFacades facades(all, begin, n, depth);
    if (facades.find()) {
      any = true;
      for (const auto& corner : facades.corners()) {
        to.points.push_back(model::snap(corner.at));
        if (!known) continue;
        const auto kind = [&](std::size_t lead) { return kind_of(all, edges, begin, facades, n, lead); };
        // A step between two party walls is one.
        if (corner.lead == n)
          out.edges.push_back(kind(corner.before) == kind(corner.after) ? kind(corner.before) : RoofEdge::open);
        else
          out.edges.push_back(kind(corner.lead));
      }
      to.nodes.assign(to.points.size(), 0);
    } else {
      to = ring;
      if (known)
        out.edges.insert(out.edges.end(), edges.begin() + static_cast<std::ptrdiff_t>(begin),
                         edges.begin() + static_cast<std::ptrdiff_t>(begin + n));
    }
    begin += n;
    return to.points.size() >= 3;
  };
  if (!add(plan.outer, out.plan.outer)) return std::nullopt;
  for (const Ring& hole : plan.holes)
    if (!add(hole, out.plan.holes.emplace_back())) return std::nullopt;
  if (!any || !geometry::strictly_simple(out.plan)) return std::nullopt;
  const double before = geometry::area(plan), after = geometry::area(out.plan);
  if (after <= 0 || std::fabs(after - before) > kMostChange * before ||
      geometry::signed_area(out.plan.outer.points) <= 0)
    return std::nullopt;
  return out;
}

std::optional<Roof> onto_plan(const Roof& roof, const EavesPlan& eaves, const Polygon& plan) {
  return Bringer(roof, eaves.plan, plan).run();
}

}  // namespace blockrand::roofs
