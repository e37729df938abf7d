#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "pipeline/footprints/repair/parts_bodies.h"
#include "pipeline/footprints/repair/rings.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/model/vector.h"

namespace blockrand::repair {

namespace {

using model::Point2;
using model::Polygon;
using model::Ring;

constexpr double kShareOfWall = 1.0 / 3;  // corners nearer than this share of their walls: never both ends of one wall
constexpr double kMostBend = 0.1;         // m; a wall bends no farther to a corner that must not move
constexpr double kFromEnds = 0.05;        // m; a corner nearer to the end of a wall is that end's business
constexpr double kSecondTry = 0.25;       // of the distance

template <class Bodies, class Visit>
void for_each_ring(Bodies& bodies, Visit&& visit) {
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (auto& polygon : bodies[b].polygons) {
      visit(b, polygon.outer);
      for (auto& hole : polygon.holes) visit(b, hole);
    }
}

/// A place where one or more parts have a corner.
struct Place {
  Point2 point;
  std::int64_t node = 0;
  std::vector<std::size_t> bodies;                            ///< sorted
  double shortest = std::numeric_limits<double>::infinity();  ///< m, of the walls that end here
  bool fixed = false;                                         ///< a corner of the outline
};

std::vector<Place> places_of(const std::vector<PartBody>& bodies, std::span<const Polygon> outline) {
  std::vector<Place> places;
  for_each_ring(bodies, [&](std::size_t body, const Ring& ring) {
    const std::size_t n = ring.size();
    for (std::size_t i = 0; i < n; ++i) {
      const double shortest = std::min(distance(ring.points[i], ring.points[(i + 1) % n]),
                                       distance(ring.points[i], ring.points[(i + n - 1) % n]));
      places.push_back({ring.points[i], ring.nodes[i], {body}, shortest, false});
    }
  });
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return std::tie(a.point, a.bodies[0], a.node) < std::tie(b.point, b.bodies[0], b.node);
  });
  std::vector<Place> out;
  for (Place& p : places) {
    if (out.empty() || out.back().point != p.point) {
      out.push_back(std::move(p));
      continue;
    }
    Place& same = out.back();
    if (same.bodies.back() != p.bodies[0]) same.bodies.push_back(p.bodies[0]);
    same.shortest = std::min(same.shortest, p.shortest);
    if (same.node == 0) same.node = p.node;
  }
  std::vector<Point2> corners;
  for (const Polygon& p : outline) {
    corners.insert(corners.end(), p.outer.points.begin(), p.outer.points.end());
    for (const Ring& hole : p.holes) corners.insert(corners.end(), hole.points.begin(), hole.points.end());
  }
  std::sort(corners.begin(), corners.end());
  for (Place& p : out) p.fixed = std::binary_search(corners.begin(), corners.end(), p.point);
  return out;
}

bool common_body(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
  return std::any_of(a.begin(), a.end(), [&](std::size_t x) { return std::binary_search(b.begin(), b.end(), x); });
}

bool any_heights_meet(const std::vector<PartBody>& bodies, const std::vector<std::size_t>& a,
                      const std::vector<std::size_t>& b) {
  for (const std::size_t i : a)
    for (const std::size_t j : b)
      if (heights_meet(bodies[i].heights, bodies[j].heights)) return true;
  return false;
}

/// Where points go; sorted by where from.
using Moves = std::vector<std::pair<Point2, Point2>>;

void move_points(const Moves& moves, std::vector<PartBody>& bodies) {
  if (moves.empty()) return;
  for_each_ring(bodies, [&](std::size_t, Ring& ring) {
    for (Point2& p : ring.points) {
      const auto found =
          std::lower_bound(moves.begin(), moves.end(), p, [](const auto& m, Point2 q) { return m.first < q; });
      if (found != moves.end() && found->first == p) p = found->second;
    }
  });
}

/// Corners that are meant as one.
class Clusters {
 public:
  Clusters(const std::vector<Place>& places, double reach) : places_(places), reach_(reach), of_(places.size()) {
    std::iota(of_.begin(), of_.end(), std::size_t{0});
    members_.resize(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) members_[i] = {i};
  }

  /// False where the two cannot be one point.
  bool merge(std::size_t a, std::size_t b) {
    a = of_[a], b = of_[b];
    if (a == b) return false;
    for (const std::size_t i : members_[a])
      for (const std::size_t j : members_[b])
        if (common_body(places_[i].bodies, places_[j].bodies) || (places_[i].fixed && places_[j].fixed)) return false;
    std::vector<std::size_t> both;
    std::merge(members_[a].begin(), members_[a].end(), members_[b].begin(), members_[b].end(),
               std::back_inserter(both));
    const Point2 centre = target(both);
    for (const std::size_t i : both)
      if (distance(places_[i].point, centre) > reach_) return false;
    for (const std::size_t i : members_[b]) of_[i] = a;
    members_[a] = std::move(both);
    members_[b].clear();
    return true;
  }

  Moves moves() const {
    Moves out;
    for (const auto& members : members_) {
      if (members.size() < 2) continue;
      const Point2 centre = target(members);
      for (const std::size_t i : members)
        if (places_[i].point != centre) out.emplace_back(places_[i].point, centre);
    }
    std::sort(out.begin(), out.end());
    return out;
  }

 private:
  Point2 target(const std::vector<std::size_t>& members) const {
    Point2 sum;
    for (const std::size_t i : members) {
      if (places_[i].fixed) return places_[i].point;
      // Relative to the first: sums of large coordinates would lose the grid.
      sum.x += places_[i].point.x - places_[members[0]].point.x;
      sum.y += places_[i].point.y - places_[members[0]].point.y;
    }
    const double n = static_cast<double>(members.size());
    return model::snap(Point2{places_[members[0]].point.x + sum.x / n, places_[members[0]].point.y + sum.y / n});
  }

  const std::vector<Place>& places_;
  double reach_;
  std::vector<std::size_t> of_;
  std::vector<std::vector<std::size_t>> members_;  ///< sorted
};

int join_corners(std::vector<PartBody>& bodies, std::span<const Polygon> outline, double reach) {
  const std::vector<Place> places = places_of(bodies, outline);
  struct Pair {
    double distance;
    std::size_t a, b;
  };
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < places.size(); ++a)
    for (std::size_t b = a + 1; b < places.size() && places[b].point.x - places[a].point.x <= reach; ++b) {
      const Place &p = places[a], &q = places[b];
      const double d = distance(p.point, q.point);
      if (d > std::min(reach, kShareOfWall * std::min(p.shortest, q.shortest))) continue;
      if (common_body(p.bodies, q.bodies) || !any_heights_meet(bodies, p.bodies, q.bodies)) continue;
      pairs.push_back({d, a, b});
    }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) {
    return std::tie(p.distance, p.a, p.b) < std::tie(q.distance, q.a, q.b);
  });
  Clusters clusters(places, reach);
  int joined = 0;
  for (const Pair& p : pairs) joined += clusters.merge(p.a, p.b);
  move_points(clusters.moves(), bodies);
  return joined;
}

/// A corner to be put into a wall.
struct Insertion {
  Ring* ring;
  std::size_t edge;
  double along;
  Point2 point;
  std::int64_t node;
};

/// The wall of a body nearest to a point.
struct NearestWall {
  Ring* ring = nullptr;
  std::size_t edge = 0;
  double along = 0, distance = std::numeric_limits<double>::infinity();
  Point2 foot;
};

NearestWall nearest_wall(PartBody& body, Point2 p) {
  NearestWall best;
  const auto look = [&](Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring.points[i], b = ring.points[(i + 1) % ring.size()];
      const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
      const double t = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0);
      const Point2 foot{a.x + t * dx, a.y + t * dy};
      if (const double d = distance(p, foot); d < best.distance) best = {&ring, i, t, d, foot};
    }
  };
  for (Polygon& polygon : body.polygons) {
    look(polygon.outer);
    for (Ring& hole : polygon.holes) look(hole);
  }
  return best;
}

int join_walls(std::vector<PartBody>& bodies, std::span<const Polygon> outline, double reach) {
  std::vector<Insertion> insertions;
  Moves moves;
  for (const Place& place : places_of(bodies, outline)) {
    const double limit = std::min(reach, kShareOfWall * place.shortest);
    struct Candidate {
      NearestWall wall;
      std::size_t body;
    };
    std::vector<Candidate> candidates;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (std::binary_search(place.bodies.begin(), place.bodies.end(), b)) continue;
      if (!any_heights_meet(bodies, place.bodies, {b})) continue;
      const NearestWall wall = nearest_wall(bodies[b], place.point);
      if (wall.distance > limit) continue;
      const Point2 from = wall.ring->points[wall.edge], to = wall.ring->points[(wall.edge + 1) % wall.ring->size()];
      if (distance(wall.foot, from) < kFromEnds || distance(wall.foot, to) < kFromEnds) continue;
      candidates.push_back({wall, b});
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.wall.distance < b.wall.distance; });
    Point2 now = place.point;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const NearestWall& wall = candidates[k].wall;
      if (k == 0 && !place.fixed)
        now = model::snap(wall.foot);
      else if (wall.distance > kMostBend)
        continue;
      insertions.push_back({wall.ring, wall.edge, wall.along, now, place.node});
    }
    if (now != place.point) moves.emplace_back(place.point, now);
  }
  move_points(moves, bodies);  // in the order of places: sorted
  // From the last point of a ring to the first, so that places of edges stay right.
  std::sort(insertions.begin(), insertions.end(), [](const Insertion& a, const Insertion& b) {
    return std::tie(a.edge, a.along, a.point) > std::tie(b.edge, b.along, b.point);
  });
  for (const Insertion& i : insertions) {
    const auto at = static_cast<std::ptrdiff_t>(i.edge) + 1;
    i.ring->points.insert(i.ring->points.begin() + at, i.point);
    i.ring->nodes.insert(i.ring->nodes.begin() + at, i.node);
  }
  return static_cast<int>(insertions.size());
}

bool sound(const std::vector<PartBody>& before, const std::vector<PartBody>& after, const RepairOptions& options) {
  for (std::size_t b = 0; b < after.size(); ++b) {
    double area_before = 0, area_after = 0;
    for (const Polygon& p : before[b].polygons) area_before += geometry::area(p);
    for (const Polygon& p : after[b].polygons) {
      if (!geometry::strictly_simple(p) || !geometry::rings_apart(p) || !well_wound(p)) return false;
      area_after += geometry::area(p);
    }
    if (std::fabs(area_after - area_before) > options.max_area_change * area_before) return false;
  }
  return true;
}

}  // namespace

int share_part_walls(std::vector<PartBody>& bodies, std::span<const Polygon> outline, const RepairOptions& options) {
  if (bodies.size() < 2) return 0;
  for (const double share : {1.0, kSecondTry}) {
    const double reach = share * options.snap_distance;
    std::vector<PartBody> trial = bodies;
    const int joined = join_corners(trial, outline, reach) + join_walls(trial, outline, reach);
    if (joined == 0) return 0;
    if (!sound(bodies, trial, options)) continue;
    bodies = std::move(trial);
    return joined;
  }
  return 0;
}

}  // namespace blockrand::repair
