#include "styles/roofs/roof_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"
#include "styles/roofs/eaves_lines.h"

namespace blockrand::roofs {

using model::Point2;
using model::Polygon;
using model::RoofEdge;

namespace {

constexpr double kStraight = 0.93969262078590838;     ///< cosine of 20 degrees: walls that bend less are one wall
constexpr double kOwnShare = 0.5, kRearShare = 0.75;  ///< of such a wall: what makes it a party wall
constexpr double kShortReturn = 2.0;                  ///< m. Between party walls: steps of a fire wall, light shafts
constexpr double kLooksAlong =
    0.68199836006249850;  ///< cosine of 47 degrees: walls at 45 are common, and decide nothing
constexpr double kOneWall =
    0.76604444311897804;                        ///< cosine of 40 degrees: a wall ends where a curve has turned by more
constexpr double kTurns = 0.86602540378443865;  ///< cosine of 30 degrees: streets that differ by more meet at a corner
constexpr double kLeastFront = 3.0;             ///< m. A shorter stretch on another street makes no corner house
constexpr double kLeastOpen = 0.1;              ///< of the outline: less open wall is a light shaft, no side for eaves
constexpr double kLeastBehind = 0.25;           ///< of an edge: eaves behind less of it are those of a light shaft
constexpr double kCoveredEnd = 0.3;             ///< of the plan's width: less party wall leaves an end free
constexpr double kNeighbour = 0.3;              ///< of a side: less is a corner or a shed, no neighbour
constexpr double kMostOfSide = 0.5;             ///< of the one long side that must be covered where the other is free
constexpr double kOblong = 2.0;                 ///< length by width: longer wings lean on a wall at their long side

/// Lengths are compared so that their last digits do not count.
std::int64_t centimetres(double metres) { return std::llround(metres * 100); }

/// First edge of each ring, and one past the last.
std::vector<std::size_t> ring_starts(const Polygon& plan) {
  std::vector<std::size_t> out{0, plan.outer.size()};
  for (const model::Ring& hole : plan.holes) out.push_back(out.back() + hole.size());
  return out;
}

class Finder {
 public:
  Finder(const Polygon& plan, const RoofRequest& request)
      : plan_(plan), request_(request), edges_(plan_sides(plan)), rings_(ring_starts(plan)) {}

  RoofSides sides(bool wants_gables) {
    RoofSides out;
    out.sides.assign(edges_.size(), RoofSide::eaves);
    // A mapper who writes `hipped` has seen hips: of The Hague's, 99 % of the slopes are there, those over party walls
    // too.
    const bool hips_are_mapped = request_.shape_is_mapped && request_.shape == model::RoofShape::hipped;
    if (request_.edges.size() == edges_.size() && !hips_are_mapped) find_party_walls();
    if (!any_party()) {
      if (wants_gables)
        for (const std::uint32_t e : wing_ends(plan_, request_)) out.sides[e] = RoofSide::gable;
      return out;
    }
    if (request_.axis_is_mapped && is_one_wing(plan_)) keep_party_walls_along(ridge_axis(plan_, request_));
    lay(wants_gables, out);
    if (request_.shape_is_mapped && (out.leans || !out.has(RoofSide::eaves))) {
      // Two slopes are mapped: one of them ends at a neighbour's wall.
      keep_party_walls_along(is_one_wing(plan_) ? ridge() : ridge_axis(plan_, request_));
      lay(wants_gables, out);
    }
    return out;
  }

  std::optional<Point2> axis() {
    if (request_.edges.size() == edges_.size()) find_party_walls();
    if (!any_party() || request_.axis_is_mapped || !is_one_wing(plan_)) return std::nullopt;
    return ridge();
  }

 private:
  bool any_party() const { return std::find(party_.begin(), party_.end(), 1) != party_.end(); }
  RoofEdge kind(std::size_t e) const { return request_.edges[e]; }

  /// Calls visit(first, count) for each run of edges of a ring that are one wall; edges are counted round the ring.
  template <class Visit>
  void for_each_wall(std::size_t begin, std::size_t end, Visit&& visit) const {
    const std::size_t n = end - begin;
    const auto bends = [&](std::size_t i) {  // between edge i and the next one
      return dot(edges_[begin + i].along(), edges_[begin + (i + 1) % n].along()) < kStraight;
    };
    std::size_t first = n;
    for (std::size_t i = 0; i < n && first == n; ++i)
      if (bends(i)) first = (i + 1) % n;
    if (first == n) first = 0;
    for (std::size_t done = 0; done < n;) {
      std::size_t count = 1;
      while (done + count < n && !bends((first + done + count - 1) % n) &&
             dot(edges_[begin + (first + done) % n].along(), edges_[begin + (first + done + count) % n].along()) >=
                 kOneWall)
        ++count;
      visit((first + done) % n, count);
      done += count;
    }
  }

  void find_party_walls() {
    party_.assign(edges_.size(), 0);
    const auto street = street_outlook(edges_, request_.edges);
    for (std::size_t r = 0; r + 1 < rings_.size(); ++r) {
      const std::size_t begin = rings_[r], n = rings_[r + 1] - begin;
      for_each_wall(begin, begin + n, [&](std::size_t first, std::size_t count) {
        double own = 0, all = 0;
        std::size_t longest = begin + first;
        for (std::size_t k = 0; k < count; ++k) {
          const std::size_t e = begin + (first + k) % n;
          if (edges_[e].length > edges_[longest].length) longest = e;
          all += edges_[e].length;
          if (kind(e) == RoofEdge::party_wall) own += edges_[e].length;
        }
        if (own < party_share_of(edges_[longest], street) * all) return;
        for (std::size_t k = 0; k < count; ++k) party_[begin + (first + k) % n] = 1;
      });
      join_returns(begin, n);
    }
  }

  /// Short chains of edges between two party walls of a ring.
  void join_returns(std::size_t begin, std::size_t n) {
    const std::vector<char> before(party_.begin() + static_cast<std::ptrdiff_t>(begin),
                                   party_.begin() + static_cast<std::ptrdiff_t>(begin + n));
    for (std::size_t i = 0; i < n; ++i) {
      if (!before[i] || before[(i + 1) % n]) continue;
      double length = 0;
      std::size_t count = 1;
      bool street = false;
      for (; count < n && !before[(i + count) % n]; ++count) {
        const std::size_t e = begin + (i + count) % n;
        length += edges_[e].length;
        street = street || kind(e) == RoofEdge::street;
      }
      if (street || length > kShortReturn) continue;
      for (std::size_t k = 1; k < count; ++k) party_[begin + (i + k) % n] = 1;
    }
  }

  void keep_party_walls_along(Point2 axis) {
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (party_[e] && std::fabs(dot(edges_[e].outwards(), axis)) < kLooksAlong) party_[e] = 0;
  }

  // ---- streets

  /// The longest street front, and whether another one runs elsewhere.
  struct Streets {
    std::optional<std::size_t> main;
    bool corner = false;
  };
  Streets streets() const {
    Streets out;
    const auto fronts = [&](auto&& visit) {
      for (std::size_t e = 0; e < edges_.size(); ++e)
        if (kind(e) == RoofEdge::street && !party_[e]) visit(e);
    };
    // The longest front, whose pieces count together; ties go to the longest piece, then to the least corner: rounding
    // and the start of a ring decide nothing.
    std::tuple<std::int64_t, std::int64_t, Point2> best;
    fronts([&](std::size_t e) {
      double length = 0;
      fronts([&](std::size_t f) {
        if (dot(edges_[e].along(), edges_[f].along()) >= kStraight) length += edges_[f].length;
      });
      const Point2 least = std::min(edges_[e].from, edges_[e].to);
      const std::tuple key(centimetres(length), centimetres(edges_[e].length), Point2{-least.x, -least.y});
      if (out.main && key <= best) return;
      best = key;
      out.main = e;
    });
    if (!out.main) return out;
    double other = 0;
    fronts([&](std::size_t e) {
      if (std::fabs(dot(edges_[e].along(), edges_[*out.main].along())) < kTurns) other += edges_[e].length;
    });
    out.corner = other >= kLeastFront;
    return out;
  }

  /// Do party walls look in directions that differ by more than what one row has?
  bool turning(Point2 axis) const {
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (party_[e] && edges_[e].length > kShortReturn && std::fabs(dot(edges_[e].outwards(), axis)) < kLooksAlong)
        return true;
    return false;
  }

  /// The party wall that is longest.
  Point2 main_party_wall() const {
    std::size_t best = edges_.size();
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (party_[e] && (best == edges_.size() || edges_[e].length > edges_[best].length + 0.01)) best = e;
    return edges_[best].outwards();
  }

  Point2 ridge() const {
    if (request_.axis_is_mapped) return ridge_axis(plan_, request_);
    const Streets s = streets();
    if (s.corner) return main_party_wall();
    if (s.main) return edges_[*s.main].along();
    if (const auto between = ridge_between(plan_, edges_, party_)) return *between;
    return ridge_axis(plan_, request_);
  }

  // ---- the sides

  void lay(bool wants_gables, RoofSides& out) const {
    std::fill(out.sides.begin(), out.sides.end(), RoofSide::eaves);
    out.corner.reset();
    out.leans = false;
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (party_[e]) out.sides[e] = RoofSide::party;
    if (wants_gables) {
      if (is_one_wing(plan_))
        end_one_wing(out);
      else
        for (const std::uint32_t e : wing_ends(plan_, request_)) make_gable(e, out);
      // A plan without eaves has too many gables.
      if (!out.has(RoofSide::eaves))
        for (RoofSide& s : out.sides)
          if (s == RoofSide::gable) s = RoofSide::eaves;
    }
    find_lean_sides(out);
  }

  void make_gable(std::uint32_t e, RoofSides& out) const {
    if (out.sides[e] != RoofSide::eaves) return;
    if (kind(e) == RoofEdge::street && !request_.shape_is_mapped && !request_.axis_is_mapped) return;
    out.sides[e] = RoofSide::gable;
  }

  void end_one_wing(RoofSides& out) const {
    const Point2 axis = ridge();
    const geometry::Extent across = geometry::extent_along(plan_.outer.points, {-axis.y, axis.x});
    const double width = across.maximum - across.minimum;
    const bool turns = !request_.axis_is_mapped && streets().corner && turning(axis);
    for (const double way : {1.0, -1.0}) {
      const Point2 towards{way * axis.x, way * axis.y};
      double covered = 0;
      for (std::size_t e = 0; e < edges_.size(); ++e)
        if (party_[e] && dot(edges_[e].outwards(), towards) >= kLooksAlong) covered += edges_[e].length;
      if (covered < kCoveredEnd * width && turns) continue;
      for (const std::uint32_t e : ends_towards(plan_, edges_, towards)) {
        // What the end's best edge is, where no edge looks that way, may be the side of a triangle; short ones are the
        // sides of a bay.
        if (dot(edges_[e].outwards(), towards) < kLooksAlong) continue;
        if (edges_[e].length < std::min(kShortReturn, kCoveredEnd * width)) continue;
        make_gable(e, out);
      }
    }
  }

  /// The first edge that a way into the plan meets.
  std::optional<std::size_t> opposite(std::size_t e, double share) const {
    const PlanSide& from = edges_[e];
    const Point2 in = -from.outwards();
    const Point2 p{from.from.x + share * (from.to.x - from.from.x), from.from.y + share * (from.to.y - from.from.y)};
    std::optional<std::size_t> found;
    double nearest = 0;
    for (std::size_t f = 0; f < edges_.size(); ++f) {
      if (f == e) continue;
      const PlanSide& other = edges_[f];
      const Point2 a{other.from.x - p.x, other.from.y - p.y}, b{other.to.x - p.x, other.to.y - p.y};
      const double ca = in.x * a.y - in.y * a.x, cb = in.x * b.y - in.y * b.x;
      if ((ca > 0) == (cb > 0)) continue;
      const double t = ca / (ca - cb);
      const double way = (a.x + t * (b.x - a.x)) * in.x + (a.y + t * (b.y - a.y)) * in.y;
      if (way <= 0 || (found && way >= nearest)) continue;
      nearest = way;
      found = f;
    }
    return found;
  }

  /// m of an edge behind which eaves look the other way.
  double eaves_behind(std::size_t e, const RoofSides& out) const {
    const PlanSide& from = edges_[e];
    const Point2 along = from.along(), in = -from.outwards();
    double length = 0;
    for (std::size_t f = 0; f < edges_.size(); ++f) {
      if (f == e || out.sides[f] == RoofSide::party || out.sides[f] == RoofSide::gable) continue;
      const PlanSide& other = edges_[f];
      if (dot(other.outwards(), in) < kLooksAlong) continue;
      const auto place = [&](Point2 p) {
        return Point2{dot({p.x - from.from.x, p.y - from.from.y}, along),
                      dot({p.x - from.from.x, p.y - from.from.y}, in)};
      };
      const Point2 a = place(other.from), b = place(other.to);
      constexpr double kBehind = 0.05;  // m
      const double overlap = std::min(std::max(a.x, b.x), from.length) - std::max(std::min(a.x, b.x), 0.0);
      if (overlap > kBehind && std::max(a.y, b.y) > kBehind) length += overlap;
    }
    return length;
  }

  /// The hip over the end of a wing: eaves on both its sides look away from each other, and it is no longer than a
  /// wing's end is.
  bool is_hip(std::size_t e, const RoofSides& out) const {
    std::size_t begin = 0, n = plan_.outer.size();
    for (std::size_t r = 0; r + 1 < rings_.size(); ++r)
      if (e >= rings_[r] && e < rings_[r + 1]) begin = rings_[r], n = rings_[r + 1] - begin;
    const std::size_t before = begin + (e - begin + n - 1) % n, after = begin + (e - begin + 1) % n;
    if (out.sides[before] != RoofSide::eaves || out.sides[after] != RoofSide::eaves) return false;
    if (dot(edges_[before].outwards(), edges_[after].outwards()) > -kLooksAlong) return false;
    constexpr double kHipLength = 1.5;  // of its neighbours'
    return edges_[e].length <= kHipLength * std::min(edges_[before].length, edges_[after].length);
  }

  void find_lean_sides(RoofSides& out) const {
    const Streets s = streets();
    // A corner house's yard may be small; elsewhere a light shaft makes no second slope.
    const double least_behind = s.corner ? 0 : kLeastBehind;
    std::vector<char> lean(edges_.size(), 0);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (out.sides[e] != RoofSide::eaves || is_hip(e, out)) continue;
      int party = 0;
      for (const double share : {0.25, 0.5, 0.75}) {
        const auto met = opposite(e, share);
        party += met && out.sides[*met] == RoofSide::party &&
                 dot(edges_[*met].outwards(), edges_[e].outwards()) < -kLooksAlong;
      }
      lean[e] = party >= 2 && eaves_behind(e, out) <= least_behind * edges_[e].length;
    }
    if (s.corner && fronts_lean(lean, out)) {
      out.corner = yard_corner(out);
      if (out.corner) return;  // the fronts face the yard's eaves now
    }
    bool all = true;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (out.sides[e] != RoofSide::eaves) continue;
      if (lean[e])
        out.sides[e] = RoofSide::lean;
      else if (edges_[e].length > kShortReturn)
        all = false;
    }
    out.leans = all && out.has(RoofSide::lean);
  }

  /// Do the slopes of (nearly) all fronts rise to party walls?
  bool fronts_lean(const std::vector<char>& lean, const RoofSides& out) const {
    double all = 0, leaning = 0;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (kind(e) != RoofEdge::street || out.sides[e] != RoofSide::eaves) continue;
      all += edges_[e].length;
      if (lean[e]) leaning += edges_[e].length;
    }
    constexpr double kNearlyAll = 0.75;
    return all > 0 && leaning >= kNearlyAll * all;
  }

  /// The corner between two party walls of the outer ring that lies farthest from the street fronts.
  std::optional<std::uint32_t> yard_corner(const RoofSides& out) const {
    std::optional<std::uint32_t> best;
    double most = 0;
    const std::size_t n = plan_.outer.size();
    for (std::size_t i = 0; i < n; ++i) {
      const PlanSide &before = edges_[(i + n - 1) % n], &after = edges_[i];
      if (out.sides[(i + n - 1) % n] != RoofSide::party || out.sides[i] != RoofSide::party) continue;
      const Point2 u = before.along(), v = after.along();
      if (u.x * v.y - u.y * v.x < kLooksAlong) continue;  // convex, from 45 to 135 degrees
      double nearest = -1;
      for (std::size_t e = 0; e < edges_.size(); ++e) {
        if (kind(e) != RoofEdge::street || out.sides[e] != RoofSide::eaves) continue;
        const double d = geometry::distance_to_segment(after.from, edges_[e].from, edges_[e].to);
        if (nearest < 0 || d < nearest) nearest = d;
      }
      if (nearest > most + 0.01) {
        most = nearest;
        best = static_cast<std::uint32_t>(i);
      }
    }
    return best;
  }

  const Polygon& plan_;
  const RoofRequest& request_;
  std::vector<PlanSide> edges_;
  std::vector<std::size_t> rings_;
  std::vector<char> party_;
};

}  // namespace

std::vector<std::uint32_t> RoofSides::which(RoofSide side) const {
  std::vector<std::uint32_t> out;
  for (std::uint32_t e = 0; e < sides.size(); ++e)
    if (sides[e] == side) out.push_back(e);
  return out;
}

bool RoofSides::has(RoofSide side) const { return std::find(sides.begin(), sides.end(), side) != sides.end(); }

std::optional<Point2> street_outlook(const std::vector<PlanSide>& edges, const std::vector<RoofEdge>& kinds) {
  if (kinds.size() != edges.size()) return std::nullopt;
  std::optional<std::size_t> longest;
  const auto key = [&](std::size_t e) {
    const Point2 least = std::min(edges[e].from, edges[e].to);
    return std::tuple(centimetres(edges[e].length), Point2{-least.x, -least.y});
  };
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (kinds[e] == RoofEdge::street && (!longest || key(e) > key(*longest))) longest = e;
  return longest ? std::optional(edges[*longest].outwards()) : std::nullopt;
}

double party_share_of(const PlanSide& facade, std::optional<Point2> street) {
  return street && dot(facade.outwards(), *street) < -kLooksAlong ? kRearShare : kOwnShare;
}

std::optional<Point2> ridge_between(const Polygon& plan, const std::vector<PlanSide>& edges,
                                    const std::vector<char>& party) {
  const Point2 axis = geometry::long_axis(plan.outer.points), side{-axis.y, axis.x};
  const auto extent = [&](Point2 direction) {
    const auto e = geometry::extent_along(plan.outer.points, direction);
    return e.maximum - e.minimum;
  };
  const double length = extent(axis), width = extent(side);
  if (width <= 0) return std::nullopt;
  // Covered length of the long sides that look left and right of the axis, and of the short sides behind and ahead.
  std::array<double, 2> long_sides{}, short_sides{};
  bool any = false;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!party[e]) continue;
    any = true;
    const double along = dot(edges[e].along(), axis), across = dot(edges[e].along(), side);
    if (std::fabs(along) > std::fabs(across))
      long_sides[along > 0] += std::fabs(along) * edges[e].length;
    else
      short_sides[across > 0] += std::fabs(across) * edges[e].length;
  }
  if (!any) return std::nullopt;
  if (std::max(short_sides[0], short_sides[1]) > kNeighbour * width) return axis;
  const auto [less, more] = std::minmax(long_sides[0], long_sides[1]);
  if (less > kNeighbour * length || (more > kMostOfSide * length && length <= kOblong * width)) return side;
  return axis;
}

std::optional<Point2> row_axis(const Polygon& plan, const RoofRequest& request) {
  if (request.along_eaves_lines) {
    if (const auto eaves = eaves_plan(plan, request.edges)) {
      RoofRequest whole = request;
      whole.edges = eaves->edges;
      return Finder(eaves->plan, whole).axis();
    }
  }
  return Finder(plan, request).axis();
}

bool is_enclosed(const Polygon& plan, const std::vector<RoofEdge>& edges) {
  const std::vector<PlanSide> all = plan_sides(plan);
  if (edges.size() != all.size()) return false;
  double open = 0, whole = 0;
  for (std::size_t e = 0; e < all.size(); ++e) {
    whole += all[e].length;
    if (edges[e] == RoofEdge::party_wall) continue;
    if (edges[e] == RoofEdge::street) return false;
    open += all[e].length;
  }
  return open <= kShortReturn || open <= kLeastOpen * whole;
}

RoofSides roof_sides(const Polygon& plan, const RoofRequest& request, bool wants_gables) {
  return Finder(plan, request).sides(wants_gables);
}

}  // namespace blockrand::roofs
