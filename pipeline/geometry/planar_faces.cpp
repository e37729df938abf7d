#include "pipeline/geometry/planar_faces.h"

#include <geos_c.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>

#include "pipeline/geometry/polygon.h"
#include "pipeline/geometry/segment_grid.h"

namespace blockrand::geometry {

namespace {

using model::Point2;
using model::Polygon;
using model::Ring;

constexpr double kStep = 1.0 / model::kGridStepsPerMetre;
/// m. Snap rounding moves a segment's points to the centres of the pixels it passes through: by half a diagonal of a step.
constexpr double kSameLine = 0.75 * kStep;
/// m. Cells of the index that finds the lines under an edge: some street segments long.
constexpr double kIndexCell = 64;

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

/// A segment of an input line, and whose it is.
struct Source {
  Segment segment;  ///< in the line's direction
  std::uint64_t id = 0;
  friend auto operator<=>(const Source&, const Source&) = default;
};

std::vector<Source> sources_of(std::span<const DividingLine> lines) {
  std::vector<Source> out;
  for (const DividingLine& line : lines)
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      const Segment s{model::snap(line.points[i - 1]), model::snap(line.points[i])};
      if (s.a != s.b) out.push_back({s, line.id});
    }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

GEOSGeometry* geos_segment(const Segment& s) {
  GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(context(), 2, 2);
  GEOSCoordSeq_setXY_r(context(), sequence, 0, s.a.x, s.a.y);
  GEOSCoordSeq_setXY_r(context(), sequence, 1, s.b.x, s.b.y);
  return GEOSGeom_createLineString_r(context(), sequence);
}

/// What GEOS sees is a sorted set of undirected segments: the order and direction of the lines cannot reach it. It works
/// in absolute coordinates: an origin taken from the data would make the last bits of a crossing depend on far lines.
Geometry noded(const std::vector<Source>& sources) {
  std::vector<Segment> segments;
  segments.reserve(sources.size());
  for (const Source& s : sources) segments.push_back({std::min(s.segment.a, s.segment.b), std::max(s.segment.a, s.segment.b)});
  std::sort(segments.begin(), segments.end());
  segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
  std::vector<GEOSGeometry*> parts;
  parts.reserve(segments.size());
  for (const Segment& s : segments) parts.push_back(geos_segment(s));
  const Geometry all = checked(GEOSGeom_createCollection_r(context(), GEOS_MULTILINESTRING, parts.data(),
                                                           static_cast<unsigned>(parts.size())),
                               "collect lines");
  return checked(GEOSUnaryUnionPrec_r(context(), all.get(), kStep), "node lines");
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
    std::sort(polygon.holes.begin(), polygon.holes.end(), [](const Ring& a, const Ring& b) { return a.points < b.points; });
    out.push_back(std::move(polygon));
  }
  std::sort(out.begin(), out.end(), [](const Polygon& a, const Polygon& b) { return a.outer.points < b.outer.points; });
  return out;
}

/// Finds the input lines under the edges of the result.
class Attribution {
 public:
  Attribution(std::vector<Source> sources, std::span<const DividingLine> lines)
      : sources_(std::move(sources)), grid_(segments_of(sources_), kIndexCell) {
    for (const DividingLine& line : lines)
      for (std::size_t i = 0; i < line.nodes.size() && i < line.points.size(); ++i) {
        if (line.nodes[i] == 0) continue;
        const auto [place, added] = nodes_.emplace(model::snap(line.points[i]), line.nodes[i]);
        if (!added) place->second = std::min(place->second, line.nodes[i]);
      }
  }

  void attribute(Face& face) {
    std::map<std::uint64_t, BorderLine> borders;
    follow(face.polygon.outer, face, borders);
    for (Ring& hole : face.polygon.holes) follow(hole, face, borders);
    for (const auto& [id, border] : borders) face.lines.push_back(border);
  }

 private:
  static std::vector<Segment> segments_of(const std::vector<Source>& sources) {
    std::vector<Segment> out;
    out.reserve(sources.size());
    for (const Source& s : sources) out.push_back(s.segment);
    return out;
  }

  void follow(Ring& ring, Face& face, std::map<std::uint64_t, BorderLine>& borders) {
    ring.nodes.assign(ring.size(), 0);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 p = ring.points[i], q = ring.points[(i + 1) % ring.size()];
      if (const auto found = nodes_.find(p); found != nodes_.end()) ring.nodes[i] = found->second;
      find_under(p, q);
      FaceEdge edge;
      const double length = std::sqrt((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y));
      for (const FaceEdge& under : under_) {
        if (edge.line == kNoLine || under.line < edge.line) edge = under;
        BorderLine& border = borders[under.line];
        border.id = under.line;
        (under.left ? border.left : border.right) += length;
      }
      face.edges.push_back(edge);
    }
  }

  /// The interior lies on the left of every ring edge: the same direction as the line's means left of the line.
  void find_under(Point2 p, Point2 q) {
    under_.clear();
    const Point2 middle{(p.x + q.x) / 2, (p.y + q.y) / 2};
    grid_.near(middle, middle, candidates_);
    for (const std::uint32_t c : candidates_) {
      const Segment& s = sources_[c].segment;
      if (distance_to_segment(p, s.a, s.b) > kSameLine || distance_to_segment(q, s.a, s.b) > kSameLine) continue;
      const bool left = (q.x - p.x) * (s.b.x - s.a.x) + (q.y - p.y) * (s.b.y - s.a.y) > 0;
      const FaceEdge edge{sources_[c].id, left};
      // A line that runs twice along the same edge is one border.
      if (std::none_of(under_.begin(), under_.end(),
                       [&](const FaceEdge& e) { return e.line == edge.line && e.left == edge.left; }))
        under_.push_back(edge);
    }
  }

  std::vector<Source> sources_;
  SegmentGrid grid_;
  std::map<Point2, std::int64_t> nodes_;
  std::vector<std::uint32_t> candidates_;
  std::vector<FaceEdge> under_;
};

}  // namespace

std::vector<Face> faces_of_lines(std::span<const DividingLine> lines) {
  std::vector<Source> sources = sources_of(lines);
  std::vector<Face> faces;
  if (sources.empty()) return faces;
  const Geometry edges = noded(sources);
  const GEOSGeometry* const input[] = {edges.get()};
  const Geometry collection = checked(GEOSPolygonize_r(context(), input, 1), "polygonize");
  Attribution attribution(std::move(sources), lines);
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
  const Geometry g = checked(GEOSGeom_createPolygon_r(context(), ring(polygon.outer), holes.data(),
                                                      static_cast<unsigned>(holes.size())),
                             "make a polygon");
  const Geometry point(GEOSPointOnSurface_r(context(), g.get()));
  Point2 p = origin;
  double x = 0, y = 0;
  if (point && GEOSGeomGetX_r(context(), point.get(), &x) == 1 && GEOSGeomGetY_r(context(), point.get(), &y) == 1)
    p = model::snap(Point2{origin.x + x, origin.y + y});
  return p;
}

}  // namespace blockrand::geometry
