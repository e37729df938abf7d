#include "pipeline/footprints/repair/rings.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
#include <string>

#include "pipeline/footprints/repair/clean_ring.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/geometry/even_odd.h"
#include "pipeline/geometry/footprint_overlap.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::repair {

namespace {

using model::IssueCode;
using model::Point2;
using model::Polygon;
using model::Ring;

/// Pieces of a scribble that stay.
constexpr std::size_t kMostPieces = 32;

/// What happened to the rings of one object.
struct Mending {
  RingCleaning cleaning;
  int collinear = 0;
  bool changed = false;    ///< rings were mended, beyond points
  bool separated = false;  ///< touching rings were moved apart
  bool tangled = false;    ///< one of them is a scribble
  double dropped = 0;      ///< m², of slivers
  int slivers = 0;
  std::string more;  ///< remarks for RING_REPAIRED
  void remark(const char* text) {
    changed = true;
    if (more.find(text) == std::string::npos) more += std::string("; ") + text;
  }
};

double area_of(const std::vector<Polygon>& polygons) {
  double sum = 0;
  for (const Polygon& p : polygons) sum += geometry::area(p);
  return sum;
}

template <class Visit>
void for_each_ring(Polygon& p, Visit&& visit) {
  visit(p.outer);
  for (Ring& hole : p.holes) visit(hole);
}

bool is_sliver(const Ring& ring, double area, const RepairOptions& options) {
  return area < options.min_piece_area || area < options.spike_width * geometry::perimeter(ring.points) / 2;
}

/// Holes without size. The signed area of a hole that crosses itself may be nothing, that of its loops much.
void drop_sliver_holes(Polygon& p, const RepairOptions& options, Mending& done) {
  std::erase_if(p.holes, [&](const Ring& hole) {
    if (!is_sliver(hole, std::fabs(geometry::signed_area(hole.points)), options)) return false;
    const double area = geometry::even_odd_area(hole);
    if (!is_sliver(hole, area, options)) return false;
    done.dropped += area;
    ++done.slivers;
    return true;
  });
}

void orient(Polygon& p) {
  geometry::orient(p.outer, true);
  for (Ring& hole : p.holes) geometry::orient(hole, false);
}

bool sound(const Polygon& p, const RepairOptions& options) {
  return geometry::area(p) >= options.min_piece_area && geometry::strictly_simple(p) && geometry::rings_apart(p);
}

/// Straight walls lose their points where the polygon stays simple.
bool simplify(Polygon& p, const KeptNodes& kept, const RepairOptions& options, int& collinear) {
  if (!options.simplify) return false;
  Polygon trial;
  bool copied = false;
  int dropped = 0;
  const auto work = [&](const Ring& ring, auto&& place) {
    std::optional<Ring> simple = without_collinear_points(ring, kept, options);
    if (!simple) return;
    if (!copied) trial = p;
    copied = true;
    dropped += static_cast<int>(ring.size() - simple->size());
    place() = std::move(*simple);
  };
  work(p.outer, [&]() -> Ring& { return trial.outer; });
  for (std::size_t i = 0; i < p.holes.size(); ++i) work(p.holes[i], [&]() -> Ring& { return trial.holes[i]; });
  if (!copied || !sound(trial, options)) return false;
  p = std::move(trial);
  collinear += dropped;
  return true;
}

/// What rings enclose, each by itself.
geometry::ValidPolygons made_valid(std::vector<Ring> rings, const RepairOptions& options) {
  return geometry::make_valid(rings, std::vector<bool>(rings.size(), false), options.min_piece_area,
                              options.ring_clearance);
}

/// One form for one shape, however its rings were listed.
void make_canonical(Polygon& p) {
  for_each_ring(p, start_at_least_point);
  std::sort(p.holes.begin(), p.holes.end(), [](const Ring& a, const Ring& b) { return a.points < b.points; });
}

/// The same of several, largest first.
void make_canonical(std::vector<Polygon>& polygons) {
  for (Polygon& p : polygons) make_canonical(p);
  if (polygons.size() < 2) return;
  std::vector<std::pair<double, Polygon>> sorted;
  for (Polygon& p : polygons) sorted.emplace_back(geometry::area(p), std::move(p));
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second.outer.points < b.second.outer.points;
  });
  for (std::size_t i = 0; i < sorted.size(); ++i) polygons[i] = std::move(sorted[i].second);
}

/// Of a scribble the outlines of what it encloses, as far as they come out strictly simple. Its courts mean nothing. Where
/// it crosses itself too often even for that, the ground that it covers: its convex hull.
void mend_tangled(Polygon p, const RepairOptions& options, Mending& done, std::vector<Polygon>& out) {
  if (geometry::hopeless(p.outer)) {
    done.tangled = true;
    done.remark("a ring that crosses itself more than ten thousand times taken as its convex hull");
    if (Polygon hull{geometry::convex_hull(p.outer), {}}; sound(hull, options)) out.push_back(std::move(hull));
    return;
  }
  geometry::ValidPolygons valid = geometry::outlines_of(p.outer, options.min_piece_area, options.ring_clearance);
  done.tangled = true;
  done.remark("a ring that crosses itself everywhere taken as the outlines of its largest pieces");
  if (valid.dropped_area > 0) {
    done.dropped += valid.dropped_area;
    ++done.slivers;
  }
  for (Polygon& piece : valid.polygons) out.push_back(std::move(piece));
}

/// Makes one outer ring with its holes valid and appends what comes of it.
void mend(Polygon p, const KeptNodes& kept, const RepairOptions& options, Mending& done, std::vector<Polygon>& out) {
  if (geometry::tangled(p.outer)) return mend_tangled(std::move(p), options, done, out);
  if (std::erase_if(p.holes, geometry::tangled) > 0) done.remark("courts that cross themselves everywhere ignored");
  geometry::ValidPolygons valid = made_valid({std::move(p.outer)}, options);
  if (!p.holes.empty()) {
    // Subtracting them, rather than mending the polygon as a whole, keeps holes outside from becoming buildings.
    const geometry::ValidPolygons holes = made_valid(std::move(p.holes), options);
    geometry::ValidPolygons rest =
        geometry::difference(valid.polygons, holes.polygons, options.min_piece_area, options.ring_clearance);
    if (rest.polygons.empty()) {
      done.remark("holes that left nothing ignored");
    } else {
      restore_nodes(rest.polygons, valid.polygons);
      restore_nodes(rest.polygons, holes.polygons);
      rest.dropped_area += valid.dropped_area;
      valid = std::move(rest);
    }
  }
  done.changed = true;
  done.separated = done.separated || valid.separated;
  if (valid.dropped_area > 0) {
    done.dropped += valid.dropped_area;
    ++done.slivers;
  }
  for (std::size_t i = 0; i < valid.polygons.size(); ++i) {
    Polygon& piece = valid.polygons[i];
    // The largest stays even where it is narrow: it is what there is of the building.
    if (i > 0 && is_sliver(piece.outer, geometry::area(piece), options)) {
      done.dropped += geometry::area(piece);
      ++done.slivers;
      continue;
    }
    drop_sliver_holes(piece, options, done);
    simplify(piece, kept, options, done.collinear);
    out.push_back(std::move(piece));
  }
}

/// Of an object with a scribble the largest pieces that have no ground in common; to unite hundreds that touch each other
/// everywhere and to move them apart again would cost without end.
void keep_apart(std::vector<Polygon>& polygons, Mending& done) {
  std::vector<Polygon> kept;
  std::vector<geometry::PlanBox> boxes;
  for (Polygon& p : polygons) {
    const geometry::PlanBox box = geometry::box_of(p.outer.points);
    bool free = kept.size() < kMostPieces;
    for (std::size_t i = 0; i < kept.size() && free; ++i)
      free = !boxes[i].near(box, 0) || !geometry::interiors_meet(kept[i], p);
    if (free) {
      kept.push_back(std::move(p));
      boxes.push_back(box);
      continue;
    }
    done.dropped += geometry::area(p);
    ++done.slivers;
  }
  polygons = std::move(kept);
}

/// Outer rings of one object that overlap or share a wall become one.
void unite_pieces(std::vector<Polygon>& polygons, const RepairOptions& options, Mending& done) {
  if (polygons.size() < 2) return;
  if (done.tangled) return keep_apart(polygons, done);
  std::vector<geometry::PlanBox> boxes;
  for (const Polygon& p : polygons) boxes.push_back(geometry::box_of(p.outer.points));
  bool near = false;
  for (std::size_t i = 0; i < boxes.size() && !near; ++i)
    for (std::size_t j = i + 1; j < boxes.size() && !near; ++j) near = boxes[i].near(boxes[j], 0);
  if (!near) return;
  geometry::ValidPolygons united = geometry::unite(polygons, options.min_piece_area, options.ring_clearance);
  if (united.polygons.empty() || united.polygons.size() == polygons.size()) {
    // Rounding in a union of untouched pieces must not replace them.
    const double before = area_of(polygons), after = area_of(united.polygons);
    if (united.polygons.empty() || std::fabs(before - after) <= 1e-9 * before) return;
  }
  restore_nodes(united.polygons, polygons);
  polygons = std::move(united.polygons);
  done.separated = done.separated || united.separated;
  done.remark("overlapping or touching rings united");
  for (Polygon& p : polygons) drop_sliver_holes(p, options, done);
}

std::string counted(int n, const char* what) { return std::to_string(n) + " " + what + (n == 1 ? "" : "s"); }

void write_rows(const Mending& done, const RepairedRings& result, model::OsmId id, const RepairOptions& options,
                model::Report& report) {
  if (done.cleaning.duplicates > 0)
    report.add(id, IssueCode::duplicate_points, counted(done.cleaning.duplicates, "point"));
  if (done.cleaning.spikes > 0) report.add(id, IssueCode::spike_removed, counted(done.cleaning.spikes, "spike"));
  if (result.polygons.empty()) return;
  if (done.collinear > 0) report.add(id, IssueCode::collinear_points, counted(done.collinear, "point"));
  if (done.changed) {
    const double area = area_of(result.polygons), change = std::fabs(area - result.mapped_area);
    std::string detail = square_metres(result.mapped_area) + " to " + square_metres(area) + done.more;
    if (change > options.max_ring_area_change * result.mapped_area) {
      // Of a ring that encloses nothing by the even-odd rule no share can be told.
      const double share = result.mapped_area > 0 ? 100 * change / result.mapped_area : 100;
      detail += "; changed by " + std::to_string(std::llround(std::min(share, 1e6))) + " %";
    }
    report.add(id, IssueCode::ring_repaired, std::move(detail));
  }
  if (done.separated) report.add(id, IssueCode::touching_rings);
  if (done.slivers > 0) report.add(id, IssueCode::sliver_dropped, square_metres(done.dropped));
  if (result.polygons.size() > 1)
    report.add(id, IssueCode::split_outline, counted(static_cast<int>(result.polygons.size()), "piece"));
}

}  // namespace

bool well_wound(const Polygon& polygon) {
  return geometry::signed_area(polygon.outer.points) > 0 &&
         std::all_of(polygon.holes.begin(), polygon.holes.end(),
                     [](const Ring& hole) { return geometry::signed_area(hole.points) < 0; });
}

std::string square_metres(double area) {
  const long long hundredths = std::llround(area * 100);
  std::string fraction = std::to_string(hundredths % 100);
  if (fraction.size() < 2) fraction.insert(0, "0");
  return std::to_string(hundredths / 100) + "." + fraction + " m2";
}

void restore_nodes(std::vector<Polygon>& polygons, std::span<const Polygon> from) {
  std::vector<std::pair<Point2, std::int64_t>> node_at;
  const auto note = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (ring.nodes[i] != 0) node_at.emplace_back(ring.points[i], ring.nodes[i]);
  };
  for (const Polygon& p : from) {
    note(p.outer);
    for (const Ring& hole : p.holes) note(hole);
  }
  std::sort(node_at.begin(), node_at.end());
  for (Polygon& p : polygons)
    for_each_ring(p, [&](Ring& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        if (ring.nodes[i] != 0) continue;
        const auto found = std::lower_bound(node_at.begin(), node_at.end(), ring.points[i],
                                            [](const auto& entry, Point2 point) { return entry.first < point; });
        if (found != node_at.end() && found->first == ring.points[i]) ring.nodes[i] = found->second;
      }
    });
}

bool cut_corners(std::vector<Polygon>& polygons, std::span<const Polygon> squares, const RepairOptions& options) {
  if (geometry::common_area(polygons, squares) <= 0) return false;
  std::vector<Polygon> cut =
      geometry::difference(polygons, squares, options.min_piece_area, options.ring_clearance).polygons;
  if (cut.size() != polygons.size() || area_of(cut) < area_of(polygons) - options.min_overlap_area) return false;
  restore_nodes(cut, polygons);
  polygons = std::move(cut);
  return true;
}

RepairedRings repair_rings(model::MappedRings rings, model::OsmId id, const KeptNodes& kept,
                           const RepairOptions& options, model::Report& report) {
  RepairedRings result;
  Mending done;
  std::vector<Polygon> groups;
  bool has_ring = false, outer_kept = false;
  for (std::size_t i = 0; i < rings.rings.size(); ++i) {
    Ring& ring = rings.rings[i];
    assert(ring.points.size() == ring.nodes.size());
    const RingCleaning c = clean_ring(ring, kept, options);
    done.cleaning.duplicates += c.duplicates;
    done.cleaning.spikes += c.spikes;
    if (c.rounds > 1) done.remark("a ring given several times round taken once");
    const bool has_points = ring.size() >= 3;
    has_ring = has_ring || (has_points && !rings.inner[i]);
    if (!rings.inner[i]) outer_kept = has_points;
    // A hole whose outer ring has vanished would otherwise be taken for a building.
    if (!has_points || (rings.inner[i] && !outer_kept)) continue;
    if (rings.inner[i]) {
      groups.back().holes.push_back(std::move(ring));
    } else {
      groups.push_back({std::move(ring), {}});
    }
  }
  for (Polygon& p : groups) {
    drop_sliver_holes(p, options, done);
    if (simplify(p, kept, options, done.collinear) || sound(p, options)) {
      orient(p);
      result.mapped_area += geometry::area(p);
      result.polygons.push_back(std::move(p));
      continue;
    }
    make_canonical(p);
    double mapped = geometry::even_odd_area(p.outer);
    for (const Ring& hole : p.holes) mapped -= geometry::even_odd_area(hole);
    result.mapped_area += std::max(0.0, mapped);
    mend(std::move(p), kept, options, done, result.polygons);
  }
  make_canonical(result.polygons);  // so that what follows does not depend on the order of rings
  unite_pieces(result.polygons, options, done);
  // The proof: whatever happened above, nothing else leaves.
  std::erase_if(result.polygons, [&](const Polygon& p) {
    if (!done.changed || geometry::strictly_simple(p)) return false;
    done.dropped += geometry::area(p);
    ++done.slivers;
    return true;
  });
  if (done.changed) make_canonical(result.polygons);
  if (!has_ring)
    result.failure = done.cleaning.spikes > 0 ? IssueCode::zero_area : IssueCode::too_few_points;
  else if (result.polygons.empty())
    result.failure = IssueCode::zero_area;
  write_rows(done, result, id, options, report);
  return result;
}

}  // namespace blockrand::repair
