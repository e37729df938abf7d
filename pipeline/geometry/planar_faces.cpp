#include "pipeline/geometry/planar_faces.h"

#include <geos_c.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "pipeline/geometry/noded_lines.h"
#include "pipeline/geometry/polygon.h"

namespace blockrand::geometry {

namespace {

using model::Point2;
using model::Polygon;
using model::Ring;

/// GEOS contexts are not shared between threads.
GEOSContextHandle_t context() {
  struct Owner {
    GEOSContextHandle_t handle = GEOS_init_r();
    Owner() = default;
    Owner(const Owner&) = delete;
    Owner& operator=(const Owner&) = delete;
    ~Owner() { GEOS_finish_r(handle); }
  };
  thread_local Owner owner;
  return owner.handle;
}

struct Deleter {
  void operator()(GEOSGeometry* g) const { GEOSGeom_destroy_r(context(), g); }
};
using Geometry = std::unique_ptr<GEOSGeometry, Deleter>;

Geometry checked(GEOSGeometry* geometry, const char* what) {
  if (geometry == nullptr) throw std::runtime_error(std::string("GEOS failed to ") + what);
  return Geometry(geometry);
}

GEOSGeometry* geos_segment(Point2 a, Point2 b) {
  GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(context(), 2, 2);
  GEOSCoordSeq_setXY_r(context(), sequence, 0, a.x, a.y);
  GEOSCoordSeq_setXY_r(context(), sequence, 1, b.x, b.y);
  return GEOSGeom_createLineString_r(context(), sequence);
}

/// Rings of the arrangement. The edges come in a canonical order and direction, so that no order of the input reaches
/// GEOS.
Geometry polygonized(const std::vector<NodedEdge>& edges) {
  std::vector<GEOSGeometry*> parts;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (i == 0 || edges[i].a != edges[i - 1].a || edges[i].b != edges[i - 1].b)
      parts.push_back(geos_segment(edges[i].a, edges[i].b));
  const Geometry all = checked(
      GEOSGeom_createCollection_r(context(), GEOS_MULTILINESTRING, parts.data(), static_cast<unsigned>(parts.size())),
      "collect lines");
  const GEOSGeometry* const input[] = {all.get()};
  return checked(GEOSPolygonize_r(context(), input, 1), "polygonize");
}

Ring ring_from(const GEOSGeometry* ring) {
  Ring out;
  const GEOSCoordSequence* sequence = GEOSGeom_getCoordSeq_r(context(), ring);
  unsigned n = 0;
  GEOSCoordSeq_getSize_r(context(), sequence, &n);
  for (unsigned i = 0; i + 1 < n; ++i) {
    Point2 p;
    GEOSCoordSeq_getXY_r(context(), sequence, i, &p.x, &p.y);
    out.points.push_back(p);
  }
  return out;
}

void make_canonical(Ring& ring, bool counter_clockwise) {
  if ((signed_area(ring.points) > 0) != counter_clockwise) std::reverse(ring.points.begin(), ring.points.end());
  std::rotate(ring.points.begin(), std::min_element(ring.points.begin(), ring.points.end()), ring.points.end());
}

std::vector<Polygon> polygons_from(const GEOSGeometry* collection) {
  std::vector<Polygon> out;
  const int count = GEOSGetNumGeometries_r(context(), collection);
  for (int i = 0; i < count; ++i) {
    const GEOSGeometry* g = GEOSGetGeometryN_r(context(), collection, i);
    Polygon polygon;
    polygon.outer = ring_from(GEOSGetExteriorRing_r(context(), g));
    make_canonical(polygon.outer, true);
    const int holes = GEOSGetNumInteriorRings_r(context(), g);
    for (int h = 0; h < holes; ++h) {
      polygon.holes.push_back(ring_from(GEOSGetInteriorRingN_r(context(), g, h)));
      make_canonical(polygon.holes.back(), false);
    }
    std::sort(polygon.holes.begin(), polygon.holes.end(),
              [](const Ring& a, const Ring& b) { return a.points < b.points; });
    out.push_back(std::move(polygon));
  }
  std::sort(out.begin(), out.end(), [](const Polygon& a, const Polygon& b) { return a.outer.points < b.outer.points; });
  return out;
}

/// Tells the faces what lies under their edges.
class Attribution {
 public:
  Attribution(const std::vector<NodedEdge>& edges, std::span<const DividingLine> lines) : edges_(edges) {
    for (const DividingLine& line : lines)
      for (std::size_t i = 0; i < line.nodes.size() && i < line.points.size(); ++i)
        if (line.nodes[i] != 0) nodes_.emplace_back(model::snap(line.points[i]), line.nodes[i]);
    std::sort(nodes_.begin(), nodes_.end());
  }

  void attribute(Face& face) {
    borders_.clear();
    follow(face.polygon.outer, face);
    for (Ring& hole : face.polygon.holes) follow(hole, face);
    // A stable sort keeps the order along the rings, in which lengths are summed.
    std::stable_sort(borders_.begin(), borders_.end(),
                     [](const BorderLine& a, const BorderLine& b) { return a.id < b.id; });
    for (const BorderLine& border : borders_) {
      if (face.lines.empty() || face.lines.back().id != border.id) {
        face.lines.push_back(border);
        continue;
      }
      face.lines.back().left += border.left;
      face.lines.back().right += border.right;
    }
  }

 private:
  void follow(Ring& ring, Face& face) {
    ring.nodes.assign(ring.size(), 0);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 p = ring.points[i], q = ring.points[(i + 1) % ring.size()];
      // Of several nodes at one place the least.
      const auto node =
          std::lower_bound(nodes_.begin(), nodes_.end(), std::pair(p, std::numeric_limits<std::int64_t>::min()));
      if (node != nodes_.end() && node->first == p) ring.nodes[i] = node->second;
      const double length = std::sqrt((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y));
      // The interior lies on the left of every ring edge: the same direction as the line's means left of the line.
      const bool forward = p < q;
      const Point2 a = std::min(p, q), b = std::max(p, q);
      FaceEdge edge;
      for (auto under = std::lower_bound(edges_.begin(), edges_.end(), NodedEdge{a, b, 0, false});
           under != edges_.end() && under->a == a && under->b == b; ++under) {
        const bool left = under->forward == forward;
        if (edge.line == kNoLine) edge = {under->line, left};  // edges are sorted: the first has the least id
        borders_.push_back({under->line, left ? length : 0, left ? 0 : length});
      }
      face.edges.push_back(edge);
    }
  }

  const std::vector<NodedEdge>& edges_;
  std::vector<std::pair<Point2, std::int64_t>> nodes_;  ///< sorted
  std::vector<BorderLine> borders_;
};

}  // namespace

std::vector<Face> faces_of_lines(std::span<const DividingLine> lines) {
  const std::vector<NodedEdge> edges = noded_edges(lines);
  std::vector<Face> faces;
  if (edges.empty()) return faces;
  const Geometry collection = polygonized(edges);
  Attribution attribution(edges, lines);
  for (Polygon& polygon : polygons_from(collection.get())) {
    Face face;
    face.polygon = std::move(polygon);
    attribution.attribute(face);
    faces.push_back(std::move(face));
  }
  return faces;
}

Point2 inner_point(const Polygon& polygon) {
  const Point2 origin = polygon.outer.points[0];
  const auto ring = [&](const Ring& r) {
    const auto n = static_cast<unsigned>(r.size());
    GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(context(), n + 1, 2);
    for (unsigned i = 0; i <= n; ++i)
      GEOSCoordSeq_setXY_r(context(), sequence, i, r.points[i % n].x - origin.x, r.points[i % n].y - origin.y);
    return GEOSGeom_createLinearRing_r(context(), sequence);
  };
  std::vector<GEOSGeometry*> holes;
  for (const Ring& hole : polygon.holes) holes.push_back(ring(hole));
  const Geometry g = checked(
      GEOSGeom_createPolygon_r(context(), ring(polygon.outer), holes.data(), static_cast<unsigned>(holes.size())),
      "make a polygon");
  const Geometry point(GEOSPointOnSurface_r(context(), g.get()));
  Point2 p = origin;
  double x = 0, y = 0;
  if (point && GEOSGeomGetX_r(context(), point.get(), &x) == 1 && GEOSGeomGetY_r(context(), point.get(), &y) == 1)
    p = model::snap(Point2{origin.x + x, origin.y + y});
  return p;
}

}  // namespace blockrand::geometry
