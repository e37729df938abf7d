#include "pipeline/footprints/repair/ground_overlaps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "pipeline/footprints/repair/rings.h"
#include "pipeline/geometry/footprint_overlap.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/slivers.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::repair {

namespace {

using geometry::kOnWall;
using model::IssueCode;
using model::Point2;
using model::Polygon;
using model::Ring;

/// Of a building's area: with so much of it inside another it lies within.
constexpr double kWithin = 0.9;
/// Of what a building had when it came: where both would lose more than max_loss (a house drawn twice, some metres off),
/// the weaker one may lose so much, if what is left is as large as the rest of an outline must be.
constexpr double kMostLoss = 0.8;
/// How often two buildings are tried: rounding of one cut can open another overlap, of grid steps only.
constexpr int kTrials = 3;

struct Box {
  double x0, y0, x1, y1;
  bool meets(const Box& o, double margin = 0) const {
    return x0 <= o.x1 + margin && o.x0 <= x1 + margin && y0 <= o.y1 + margin && o.y0 <= y1 + margin;
  }
};

Box box_of(const std::vector<Polygon>& polygons) {
  Box box{1e300, 1e300, -1e300, -1e300};
  for (const Polygon& p : polygons)
    for (const Point2 q : p.outer.points)
      box = {std::min(box.x0, q.x), std::min(box.y0, q.y), std::max(box.x1, q.x), std::max(box.y1, q.y)};
  return box;
}

double area_of(const std::vector<Polygon>& polygons) {
  double sum = 0;
  for (const Polygon& p : polygons) sum += geometry::area(p);
  return sum;
}

bool overlap(const std::vector<Polygon>& a, const std::vector<Polygon>& b) {
  for (const Polygon& p : a)
    for (const Polygon& q : b)
      if (geometry::interiors_meet(p, q)) return true;
  return false;
}

bool all_simple(const std::vector<Polygon>& polygons) {
  return std::all_of(polygons.begin(), polygons.end(),
                     [](const Polygon& p) { return geometry::strictly_simple(p) && geometry::rings_apart(p); });
}

template <class Visit>
void for_each_ring(const std::vector<Polygon>& polygons, Visit&& visit) {
  for (const Polygon& p : polygons) {
    visit(p.outer);
    for (const Ring& hole : p.holes) visit(hole);
  }
}

class Resolver {
 public:
  Resolver(TerraceRow& row, const RepairOptions& options, model::Report& report)
      : row_(row), options_(options), report_(report) {
    for (const TerraceBuilding& b : row.buildings) {
      boxes_.push_back(box_of(b.polygons));
      first_area_.push_back(area_of(b.polygons));
    }
  }

  void run() {
    for (std::uint32_t b = 0; b < row_.buildings.size(); ++b) trim(b);
    std::vector<Pair> pairs = all_pairs();
    for (int trial = 0; trial < kTrials && !pairs.empty(); ++trial) {
      std::sort(pairs.begin(), pairs.end());
      touched_.clear();
      for (const Pair& pair : pairs) {
        if (!overlap(polygons(pair.a), polygons(pair.b))) continue;
        const double area = geometry::common_area(polygons(pair.a), polygons(pair.b));
        if (!resolve(pair.a, pair.b, area)) kept_.emplace(pair.a, pair.b);
      }
      // New points can move a wall by a grid step, onto a third building.
      pairs.clear();
      std::sort(touched_.begin(), touched_.end());
      touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
      for (const std::uint32_t t : touched_) pairs_of(t, pairs);
    }
    tell();
  }

 private:
  struct Pair {
    double area;
    std::uint32_t a, b;  ///< a < b
    bool operator<(const Pair& o) const { return std::tie(o.area, a, b) < std::tie(area, o.a, o.b); }
  };

  const std::vector<Polygon>& polygons(std::uint32_t b) const { return row_.buildings[b].polygons; }

  void add_pair(std::uint32_t a, std::uint32_t b, std::vector<Pair>& out) const {
    if (a > b) std::swap(a, b);
    if (kept_.contains({a, b}) || !boxes_[a].meets(boxes_[b])) return;
    if (!same_level(row_.buildings[a].level, row_.buildings[b].level)) return;
    if (overlap(polygons(a), polygons(b))) out.push_back({geometry::common_area(polygons(a), polygons(b)), a, b});
  }

  std::vector<Pair> all_pairs() const {
    std::vector<std::uint32_t> order(boxes_.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return std::tie(boxes_[a].x0, a) < std::tie(boxes_[b].x0, b); });
    std::vector<Pair> out;
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t j = i + 1; j < order.size() && boxes_[order[j]].x0 <= boxes_[order[i]].x1; ++j)
        add_pair(order[i], order[j], out);
    return out;
  }

  /// Overlaps of a touched building; pairs of two touched ones come once.
  void pairs_of(std::uint32_t b, std::vector<Pair>& out) const {
    for (std::uint32_t o = 0; o < boxes_.size(); ++o)
      if (o != b && (o < b || !std::binary_search(touched_.begin(), touched_.end(), o))) add_pair(b, o, out);
  }

  /// True when a wins its overlap with b by the rules 2 to 5.
  bool stronger(std::uint32_t a, std::uint32_t b) const {
    const TerraceBuilding &p = row_.buildings[a], &q = row_.buildings[b];
    if (p.has_parts != q.has_parts) return p.has_parts;
    if (p.tags != q.tags) return p.tags > q.tags;
    if (first_area_[a] != first_area_[b]) return first_area_[a] < first_area_[b];
    return p.id < q.id;
  }

  bool resolve(std::uint32_t a, std::uint32_t b, double area) {
    const double area_a = area_of(polygons(a)), area_b = area_of(polygons(b));
    std::uint32_t winner = stronger(a, b) ? a : b, loser = winner == a ? b : a;
    const bool nested = area >= kWithin * std::min(area_a, area_b);
    if (nested) {
      if (area_a != area_b) winner = area_a < area_b ? a : b;
      loser = winner == a ? b : a;
      if (nested_.emplace(winner, loser).second && area >= options_.min_overlap_area)
        report_.add(row_.buildings[winner].id, IssueCode::nested_building,
                    "within " + row_.buildings[loser].id.text() + ", " + square_metres(area));
    }
    if (nested) return cut(loser, winner, area, 1, true);
    return cut(loser, winner, area, options_.max_loss, false) || cut(winner, loser, area, options_.max_loss, false) ||
           cut(loser, winner, area, kMostLoss, true);
  }

  /// Walls that moved onto each other (a wedge drawn along a neighbour's wall) leave slivers, too.
  void trim(std::uint32_t b) {
    if (geometry::cut_slivers(row_.buildings[b].polygons, options_.spike_width) > 0) share_points(b, boxes_[b]);
  }

  /// Takes from the loser what the winner has.
  /// \param most    of what the loser came with: so much it may lose
  /// \param around  what is left must be as large as the rest of an outline that its parts leave free
  bool cut(std::uint32_t loser, std::uint32_t winner, double area, double most, bool around) {
    TerraceBuilding& building = row_.buildings[loser];
    const double before = area_of(building.polygons);
    if (before - area < (1 - most) * first_area_[loser]) return false;
    geometry::ValidPolygons rest =
        geometry::difference(building.polygons, polygons(winner), options_.min_piece_area, options_.ring_clearance);
    if (rest.polygons.empty()) return false;
    if (!rest.squares.empty() && cut_corners(row_.buildings[winner].polygons, rest.squares, options_)) {
      touched_.push_back(winner);
      rest =
          geometry::difference(building.polygons, polygons(winner), options_.min_piece_area, options_.ring_clearance);
    }
    const double noise = rest.dropped_area + drop_strips(rest.polygons, building.polygons.size(), around);
    if (rest.polygons.empty() || noise > options_.max_area_change * before) return false;
    const bool had_slivers = geometry::cut_slivers(rest.polygons, options_.spike_width) > 0;
    weld(building.polygons, polygons(winner), rest.polygons);
    restore_nodes(building.polygons, rest.polygons);
    building.polygons = std::move(rest.polygons);
    if (area >= options_.min_overlap_area)
      report_.add(building.id, IssueCode::overlap_resolved,
                  "to " + row_.buildings[winner].id.text() + ", " + square_metres(area));
    ++building.record.overlaps_resolved;
    boxes_[loser] = box_of(building.polygons);
    touched_.push_back(loser);
    share_points(loser, had_slivers ? boxes_[loser] : boxes_[winner]);
    return true;
  }

  /// Removes what a cut leaves beside the winner and nobody meant; returns how much that was, in m². Either the
  /// rule of outlines and parts holds, or pieces that the cut split off must be wider than the noise of walls.
  double drop_strips(std::vector<Polygon>& pieces, std::size_t before, bool around) const {
    if (!around && pieces.size() <= before) return 0;
    double sum = 0;
    std::erase_if(pieces, [&](const Polygon& p) {
      const double area = geometry::area(p), width = geometry::equivalent_width(p);
      const bool strip = around ? area < options_.parts_free_area || width < options_.parts_free_width
                                : width < options_.snap_distance;
      if (strip) sum += area;
      return strip;
    });
    return sum;
  }

  /// New points a grid step beside a corner of the winner are that corner: the wall between them would be no longer
  /// than what rounding moves them.
  static void weld(const std::vector<Polygon>& was, const std::vector<Polygon>& winner, std::vector<Polygon>& now) {
    std::vector<Point2> old, corners;
    for_each_ring(was, [&](const Ring& r) { old.insert(old.end(), r.points.begin(), r.points.end()); });
    for_each_ring(winner, [&](const Ring& r) { corners.insert(corners.end(), r.points.begin(), r.points.end()); });
    std::sort(old.begin(), old.end());
    std::sort(corners.begin(), corners.end());
    const auto weld_ring = [&](Ring& ring) {
      for (Point2& p : ring.points)
        if (!std::binary_search(old.begin(), old.end(), p)) p = nearest(corners, p);
      for (std::size_t i = 0; i < ring.size() && ring.size() > 3;) {
        if (ring.points[i] != ring.points[(i + 1) % ring.size()]) {
          ++i;
          continue;
        }
        ring.points.erase(ring.points.begin() + static_cast<std::ptrdiff_t>(i));
        ring.nodes.erase(ring.nodes.begin() + static_cast<std::ptrdiff_t>(i));
      }
    };
    for (Polygon& p : now) {
      Polygon welded = p;
      weld_ring(welded.outer);
      for (Ring& hole : welded.holes) weld_ring(hole);
      if (geometry::strictly_simple(welded) && geometry::rings_apart(welded) && well_wound(welded))
        p = std::move(welded);
    }
  }

  /// Of sorted corners the one nearest to p, if that is on the same place but for rounding; else p.
  static Point2 nearest(const std::vector<Point2>& corners, Point2 p) {
    Point2 best = p;
    double least = kOnWall;
    for (auto c = std::lower_bound(corners.begin(), corners.end(), Point2{p.x - kOnWall, -1e300});
         c != corners.end() && c->x <= p.x + kOnWall; ++c) {
      const double distance = geometry::distance_to_segment(p, *c, *c);
      if (distance >= least) continue;
      least = distance;
      best = *c;
    }
    return best;
  }

  /// Points that were the loser's keep their node; those of the cut are made by repair.
  static void restore_nodes(const std::vector<Polygon>& was, std::vector<Polygon>& now) {
    std::map<Point2, std::int64_t> nodes;
    for_each_ring(was, [&](const Ring& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i) nodes.emplace(ring.points[i], ring.nodes[i]);
    });
    for (Polygon& p : now) {
      const auto restore = [&](Ring& ring) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
          const auto found = nodes.find(ring.points[i]);
          ring.nodes[i] = found == nodes.end() ? 0 : found->second;
        }
      };
      restore(p.outer);
      for (Ring& hole : p.holes) restore(hole);
    }
  }

  /// Puts the building's points that lie on walls of others into those walls, as far as they lie in a box (where it was
  /// cut).
  void share_points(std::uint32_t b, Box where) {
    std::vector<Point2> points;
    Box box{1e300, 1e300, -1e300, -1e300};
    for_each_ring(polygons(b), [&](const Ring& ring) {
      for (const Point2 p : ring.points) {
        if (!where.meets({p.x, p.y, p.x, p.y}, kOnWall)) continue;
        points.push_back(p);
        box = {std::min(box.x0, p.x), std::min(box.y0, p.y), std::max(box.x1, p.x), std::max(box.y1, p.y)};
      }
    });
    std::sort(points.begin(), points.end());
    for (std::uint32_t o = 0; o < boxes_.size(); ++o) {
      if (o == b || !boxes_[o].meets(box, kOnWall)) continue;
      if (!same_level(row_.buildings[o].level, row_.buildings[b].level)) continue;
      std::vector<Polygon> with_points = polygons(o);
      bool changed = false;
      for (Polygon& p : with_points) {
        changed = put_in(points, p.outer) || changed;
        for (Ring& hole : p.holes) changed = put_in(points, hole) || changed;
      }
      if (!changed || !all_simple(with_points)) continue;
      row_.buildings[o].polygons = std::move(with_points);
      boxes_[o] = box_of(polygons(o));
      touched_.push_back(o);
    }
  }

  static bool put_in(const std::vector<Point2>& points, Ring& ring) {
    Ring out;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring.points[i], b = ring.points[(i + 1) % ring.size()];
      out.points.push_back(a);
      out.nodes.push_back(ring.nodes[i]);
      const double dx = b.x - a.x, dy = b.y - a.y;
      std::vector<std::pair<double, Point2>> feet;
      const auto from = std::lower_bound(points.begin(), points.end(), Point2{std::min(a.x, b.x) - kOnWall, -1e300});
      for (auto p = from; p != points.end() && p->x <= std::max(a.x, b.x) + kOnWall; ++p) {
        const double along = (p->x - a.x) * dx + (p->y - a.y) * dy;
        if (along <= 0 || along >= dx * dx + dy * dy) continue;
        if (*p == a || *p == b || geometry::distance_to_segment(*p, a, b) > kOnWall) continue;
        feet.emplace_back(along, *p);
      }
      std::sort(feet.begin(), feet.end());
      for (const auto& [along, p] : feet) {
        if (out.points.back() == p) continue;
        out.points.push_back(p);
        out.nodes.push_back(0);
      }
    }
    if (out.size() == ring.size()) return false;
    ring = std::move(out);
    return true;
  }

  void tell() {
    for (const auto& [a, b] : kept_) {
      // Other cuts may have taken some of it.
      const double area = geometry::common_area(polygons(a), polygons(b));
      for (const auto& [one, other] : {std::pair(a, b), std::pair(b, a)}) {
        row_.buildings[one].record.overlap_left += area;
        if (area >= options_.min_overlap_area)
          report_.add(row_.buildings[one].id, IssueCode::overlap_kept,
                      "with " + row_.buildings[other].id.text() + ", " + square_metres(area));
      }
    }
  }

  TerraceRow& row_;
  const RepairOptions& options_;
  model::Report& report_;
  std::vector<Box> boxes_;
  std::vector<double> first_area_;                          ///< m², before anything was given away
  std::set<std::pair<std::uint32_t, std::uint32_t>> kept_;  ///< overlaps that stay
  std::map<std::uint32_t, std::uint32_t> nested_;           ///< who lies within whom
  std::vector<std::uint32_t> touched_;                      ///< by the cuts of this trial
};

}  // namespace

void resolve_overlaps(TerraceRow& row, const RepairOptions& options, model::Report& report) {
  for (TerraceBuilding& b : row.buildings) {
    b.record.overlaps_resolved = 0;
    b.record.overlap_left = 0;
  }
  Resolver(row, options, report).run();
}

}  // namespace blockrand::repair
