#include "pipeline/geometry/valid_polygon.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "pipeline/geometry/box_index.h"
#include "pipeline/geometry/geos_scope.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/slivers.h"

namespace blockrand::geometry {

namespace {

using model::Point2;
using model::Polygon;
using model::Ring;

// ---- exact simplicity ---------------------------------------------------------------------------------------------

struct Edge {
  Grid2 a, b;
  std::uint32_t ring, index, ring_size;
  std::int64_t min_x() const { return std::min(a.x, b.x); }
  std::int64_t max_x() const { return std::max(a.x, b.x); }
  bool near_in_y(const Edge& other, std::int64_t reach) const {
    return std::max(std::min(a.y, b.y), std::min(other.a.y, other.b.y)) <=
           std::min(std::max(a.y, b.y), std::max(other.a.y, other.b.y)) + reach;
  }
};

bool neighbours(const Edge& e, const Edge& f) {
  return e.ring == f.ring && ((e.index + 1) % e.ring_size == f.index || (f.index + 1) % f.ring_size == e.index);
}

/// Do two edges share more than the point that ring neighbours have in common?
bool edges_conflict(const Edge& e, const Edge& f) {
  if (neighbours(e, f)) {
    // Ring neighbours conflict only when one runs back over the other. In a triangle both ends are common; then the
    // area test has the word.
    const bool e_first = (e.index + 1) % e.ring_size == f.index;
    const Edge &first = e_first ? e : f, &second = e_first ? f : e;
    if (orientation(first.a, first.b, second.b) != 0) return false;
    return on_segment(first.a, first.b, second.b) || on_segment(second.a, second.b, first.a);
  }
  const int o1 = orientation(e.a, e.b, f.a), o2 = orientation(e.a, e.b, f.b);
  const int o3 = orientation(f.a, f.b, e.a), o4 = orientation(f.a, f.b, e.b);
  if (o1 * o2 < 0 && o3 * o4 < 0) return true;
  return on_segment(e.a, e.b, f.a) || on_segment(e.a, e.b, f.b) || on_segment(f.a, f.b, e.a) ||
         on_segment(f.a, f.b, e.b);
}

/// Within kOnWall of the edge. Grid coordinates are small here: doubles hold them exactly.
bool almost_on(const Edge& e, Grid2 p) {
  const auto point = [](Grid2 g) { return Point2{static_cast<double>(g.x), static_cast<double>(g.y)}; };
  return distance_to_segment(point(p), point(e.a), point(e.b)) <= kOnWall * model::kGridStepsPerMetre;
}

/// Does an edge of one ring end almost on one of another? Rounding to floats would let the two cross.
bool rings_almost_touch(const Edge& e, const Edge& f) {
  return e.ring != f.ring && (almost_on(e, f.a) || almost_on(e, f.b) || almost_on(f, e.a) || almost_on(f, e.b));
}

/// Calls `found(e, f)` for all pairs of edges that come within two grid steps along x and y, until it returns false.
template <class Found>
void for_each_near_pair(const Polygon& polygon, Found&& found) {
  std::vector<Edge> edges;
  const Grid2 origin = to_grid(polygon.outer.points[0]);
  std::uint32_t ring_number = 0;
  const auto add = [&](const Ring& ring) {
    const auto n = static_cast<std::uint32_t>(ring.size());
    for (std::uint32_t i = 0; i < n; ++i)
      edges.push_back(
          {to_grid(ring.points[i]) - origin, to_grid(ring.points[(i + 1) % n]) - origin, ring_number, i, n});
    ++ring_number;
  };
  add(polygon.outer);
  for (const Ring& hole : polygon.holes) add(hole);
  std::sort(edges.begin(), edges.end(), [](const Edge& e, const Edge& f) {
    return std::tuple(e.min_x(), e.ring, e.index) < std::tuple(f.min_x(), f.ring, f.index);
  });
  constexpr std::int64_t kReach = 2;
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = i + 1; j < edges.size() && edges[j].min_x() <= edges[i].max_x() + kReach; ++j)
      if (edges[i].near_in_y(edges[j], kReach) && !found(edges[i], edges[j])) return;
}

bool has_conflict(const Polygon& polygon) {
  bool found = false;
  for_each_near_pair(polygon, [&](const Edge& e, const Edge& f) { return !(found = edges_conflict(e, f)); });
  return found;
}

bool repeats_a_point(const Ring& ring) {
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (ring.points[i] == ring.points[(i + 1) % ring.size()]) return true;
  return false;
}

// ---- GEOS ---------------------------------------------------------------------------------------------------------

using geos::context;
using geos::Geometry;

Geometry collection_of(std::span<const Polygon> polygons, Point2 origin) {
  std::vector<GEOSGeometry*> parts;
  for (const Polygon& p : polygons) parts.push_back(geos::polygon_of(p, origin).release());
  return Geometry(
      GEOSGeom_createCollection_r(context(), GEOS_MULTIPOLYGON, parts.data(), static_cast<unsigned>(parts.size())));
}

Geometry union_all(std::span<const Polygon> polygons, Point2 origin) {
  const Geometry all = collection_of(polygons, origin);
  return Geometry(GEOSUnaryUnion_r(context(), all.get()));
}

void append_polygons(const GEOSGeometry* geometry, Point2 origin, std::vector<Polygon>& out) {
  if (!geometry) return;
  const int type = GEOSGeomTypeId_r(context(), geometry);
  if (type == GEOS_POLYGON) {
    if (GEOSisEmpty_r(context(), geometry)) return;
    Polygon p;
    p.outer = geos::ring_from(GEOSGetExteriorRing_r(context(), geometry), origin);
    const int holes = GEOSGetNumInteriorRings_r(context(), geometry);
    for (int i = 0; i < holes; ++i) {
      Ring hole = geos::ring_from(GEOSGetInteriorRingN_r(context(), geometry, i), origin);
      if (hole.size() >= 3) p.holes.push_back(std::move(hole));
    }
    if (p.outer.size() >= 3) out.push_back(std::move(p));
  } else if (type == GEOS_MULTIPOLYGON || type == GEOS_GEOMETRYCOLLECTION) {
    const int parts = GEOSGetNumGeometries_r(context(), geometry);
    for (int i = 0; i < parts; ++i) append_polygons(GEOSGetGeometryN_r(context(), geometry, i), origin, out);
  }
}

// ---- from GEOS's validity to strict simplicity ----------------------------------------------------------------------

void orient(Polygon& p) {
  geometry::orient(p.outer, true);
  for (Ring& hole : p.holes) geometry::orient(hole, false);
}

/// Squares around the points where rings touch or almost do, to be added to the polygon.
std::vector<Polygon> squares_at_touches(const Polygon& polygon, double half_size) {
  std::vector<Point2> places;
  for_each_near_pair(polygon, [&](const Edge& e, const Edge& f) {
    const bool touch = edges_conflict(e, f);
    if (!touch && !rings_almost_touch(e, f)) return true;
    const Grid2 origin = to_grid(polygon.outer.points[0]);
    const auto back = [&](Grid2 g) {
      return Point2{static_cast<double>(g.x + origin.x) / model::kGridStepsPerMetre,
                    static_cast<double>(g.y + origin.y) / model::kGridStepsPerMetre};
    };
    const auto add_if_on = [&](const Edge& edge, Grid2 p) {
      if (touch ? on_segment(edge.a, edge.b, p) : almost_on(edge, p)) places.push_back(back(p));
    };
    add_if_on(e, f.a);
    add_if_on(e, f.b);
    add_if_on(f, e.a);
    add_if_on(f, e.b);
    return places.size() < 1000;
  });
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<Polygon> squares;
  for (const Point2 p : places) {
    const double h = half_size;
    Polygon square;
    square.outer.points = {{p.x - h, p.y}, {p.x, p.y - h}, {p.x + h, p.y}, {p.x, p.y + h}};
    square.outer.nodes.assign(4, 0);
    squares.push_back(std::move(square));
  }
  return squares;
}

/// Makes every polygon of `pieces` strictly simple or drops it.
void finish(std::vector<Polygon> pieces, double min_area, double clearance, ValidPolygons& out) {
  // Each round rounds to the grid, asks the exact test, and mends: invalid rings by MakeValid, touching ones by squares.
  constexpr int kRounds = 6;
  for (int round = 0; round < kRounds && !pieces.empty(); ++round) {
    std::vector<Polygon> again;
    for (Polygon& p : pieces) {
      if (area(p) < min_area) {
        out.dropped_area += std::max(0.0, area(p));
        continue;
      }
      orient(p);
      // In the last round the exact test alone decides: what is valid is not dropped.
      if (strictly_simple(p) && (round + 1 == kRounds || rings_apart(p))) {
        out.polygons.push_back(std::move(p));
        continue;
      }
      const Point2 origin = p.outer.points[0];
      const Geometry raw = geos::polygon_of(p, origin);
      Geometry valid =
          GEOSisValid_r(context(), raw.get()) == 1 ? nullptr : geos::made_valid(raw.get(), GEOS_MAKE_VALID_STRUCTURE);
      if (!valid) {
        const double half_size = clearance * (round + 1);
        std::vector<Polygon> with_squares = squares_at_touches(p, half_size);
        out.separated = true;
        out.squares.insert(out.squares.end(), with_squares.begin(), with_squares.end());
        with_squares.push_back(p);
        valid = union_all(with_squares, origin);
      }
      append_polygons(valid.get(), origin, again);
    }
    pieces = std::move(again);
  }
  for (const Polygon& p : pieces) out.dropped_area += std::max(0.0, area(p));
}

/// Largest first, then by position: an order that does not depend on the input's.
void sort_polygons(std::vector<Polygon>& polygons) {
  const auto least = [](const Polygon& p) { return *std::min_element(p.outer.points.begin(), p.outer.points.end()); };
  std::sort(polygons.begin(), polygons.end(), [&](const Polygon& a, const Polygon& b) {
    const double area_a = area(a), area_b = area(b);
    return area_a != area_b ? area_a > area_b : least(a) < least(b);
  });
}

void restore_nodes(std::vector<Polygon>& polygons, const std::map<Point2, std::int64_t>& node_at) {
  const auto restore = [&](Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (const auto found = node_at.find(ring.points[i]); found != node_at.end()) ring.nodes[i] = found->second;
  };
  for (Polygon& p : polygons) {
    restore(p.outer);
    for (Ring& hole : p.holes) restore(hole);
  }
}

}  // namespace

std::vector<std::pair<EdgeOf, EdgeOf>> almost_touching_edges(const Polygon& polygon, std::size_t most) {
  std::vector<std::pair<EdgeOf, EdgeOf>> out;
  if (!polygon.holes.empty())
    for_each_near_pair(polygon, [&](const Edge& e, const Edge& f) {
      if (rings_almost_touch(e, f)) out.push_back({{e.ring, e.index}, {f.ring, f.index}});
      return out.size() < most;
    });
  return out;
}

bool rings_apart(const Polygon& polygon) { return almost_touching_edges(polygon, 1).empty(); }

bool strictly_simple(const Polygon& polygon) {
  if (polygon.outer.size() < 3 || repeats_a_point(polygon.outer) || signed_area(polygon.outer.points) == 0)
    return false;
  for (const Ring& hole : polygon.holes)
    if (hole.size() < 3 || repeats_a_point(hole) || signed_area(hole.points) == 0) return false;
  if (has_conflict(polygon)) return false;
  if (polygon.holes.empty()) return true;
  constexpr double kBoxRounding = 1e-6;  // m; more than contains() rounds. Walls of towers have thousands of holes
  std::vector<PlanBox> around;
  for (const Ring& hole : polygon.holes) around.push_back(box_of(hole.points));
  const BoxIndex boxes(std::move(around));
  // Without crossings one point of a hole decides on which side the whole hole lies.
  for (std::size_t i = 0; i < polygon.holes.size(); ++i) {
    const Point2 p = polygon.holes[i].points[0];
    if (!contains(std::span<const Point2>(polygon.outer.points), p)) return false;
    for (const std::uint32_t j : boxes.near({p, p}, kBoxRounding))
      if (i != j && contains(std::span<const Point2>(polygon.holes[j].points), p)) return false;
  }
  return true;
}

ValidPolygons make_valid(std::span<const Ring> rings, const std::vector<bool>& inner, double min_area,
                         double clearance) {
  ValidPolygons out;
  std::vector<Polygon> raw;
  std::map<Point2, std::int64_t> node_at;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (!inner[i] || raw.empty()) {
      raw.push_back({rings[i], {}});
    } else {
      raw.back().holes.push_back(rings[i]);
    }
  }
  std::vector<Polygon> mend;
  for (Polygon& p : raw) {
    if (p.outer.size() < 3) {
      out.changed = true;
      continue;
    }
    if (strictly_simple(p) && rings_apart(p) && area(p) >= min_area) {
      orient(p);
      out.polygons.push_back(std::move(p));
      continue;
    }
    mend.push_back(std::move(p));
  }
  if (!mend.empty()) {
    out.changed = true;
    for (const Polygon& p : mend) {
      for (std::size_t i = 0; i < p.outer.size(); ++i) node_at.emplace(p.outer.points[i], p.outer.nodes[i]);
      for (const Ring& hole : p.holes)
        for (std::size_t i = 0; i < hole.size(); ++i) node_at.emplace(hole.points[i], hole.nodes[i]);
    }
    for (const Polygon& p : mend) {
      const Point2 origin = p.outer.points[0];
      const Geometry geometry = geos::polygon_of(p, origin);
      const Geometry valid = geos::made_valid(geometry.get(), GEOS_MAKE_VALID_STRUCTURE);
      std::vector<Polygon> pieces;
      append_polygons(valid.get(), origin, pieces);
      finish(std::move(pieces), min_area, clearance, out);
    }
    restore_nodes(out.polygons, node_at);
  }
  sort_polygons(out.polygons);
  return out;
}

ValidPolygons outlines_of(const Ring& ring, double min_area, double clearance) {
  ValidPolygons out;
  out.changed = true;
  if (ring.size() < 3) return out;
  const Point2 origin = ring.points[0];
  const Geometry raw = geos::polygon_of({ring, {}}, origin),
                 valid = geos::made_valid(raw.get(), GEOS_MAKE_VALID_STRUCTURE);
  std::vector<Polygon> pieces;
  append_polygons(valid.get(), origin, pieces);
  for (Polygon& p : pieces) p.holes.clear();
  finish(std::move(pieces), min_area, clearance, out);
  std::map<Point2, std::int64_t> node_at;
  for (std::size_t i = 0; i < ring.size(); ++i) node_at.emplace(ring.points[i], ring.nodes[i]);
  restore_nodes(out.polygons, node_at);
  sort_polygons(out.polygons);
  return out;
}

ValidPolygons difference(std::span<const Polygon> a, std::span<const Polygon> b, double min_area, double clearance) {
  ValidPolygons out;
  if (a.empty()) return out;
  const Point2 origin = a[0].outer.points[0];
  const Geometry left = union_all(a, origin), right = union_all(b, origin);
  if (!left || !right) return out;
  const Geometry rest(GEOSDifference_r(context(), left.get(), right.get()));
  std::vector<Polygon> pieces;
  append_polygons(rest.get(), origin, pieces);
  finish(std::move(pieces), min_area, clearance, out);
  std::map<Point2, std::int64_t> node_at;
  for (const auto polygons : {a, b})
    for (const Polygon& p : polygons)
      for (std::size_t i = 0; i < p.outer.size(); ++i) node_at.emplace(p.outer.points[i], p.outer.nodes[i]);
  restore_nodes(out.polygons, node_at);
  sort_polygons(out.polygons);
  return out;
}

ValidPolygons unite(std::span<const Polygon> polygons, double min_area, double clearance) {
  ValidPolygons out;
  if (polygons.empty()) return out;
  const Point2 origin = polygons[0].outer.points[0];
  const Geometry all = union_all(polygons, origin);
  std::vector<Polygon> pieces;
  append_polygons(all.get(), origin, pieces);
  finish(std::move(pieces), min_area, clearance, out);
  std::map<Point2, std::int64_t> node_at;
  for (const Polygon& p : polygons)
    for (std::size_t i = 0; i < p.outer.size(); ++i) node_at.emplace(p.outer.points[i], p.outer.nodes[i]);
  restore_nodes(out.polygons, node_at);
  sort_polygons(out.polygons);
  return out;
}

double common_area(std::span<const Polygon> a, std::span<const Polygon> b) {
  if (a.empty() || b.empty()) return 0;
  const Point2 origin = a[0].outer.points[0];
  const Geometry left = union_all(a, origin), right = union_all(b, origin);
  if (!left || !right) return 0;
  const Geometry both(GEOSIntersection_r(context(), left.get(), right.get()));
  double size = 0;
  if (both) GEOSArea_r(context(), both.get(), &size);
  return size;
}

}  // namespace blockrand::geometry
