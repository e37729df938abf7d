#include "styles/roofs/gables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "pipeline/base/random.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/solid_builder.h"
#include "pipeline/geometry/triangulate.h"
#include "styles/roofs/cut_cells.h"

namespace blockrand::roofs {

using geometry::Grid2;
using model::Point2;
using model::Point3;
using model::RoofElementKind;
using model::RoofShape;
using model::SurfaceKind;

namespace {

constexpr double kTouch = 0.003;      ///< m: what overlaps by less touches
constexpr double kLeastAcross = 0.5;  ///< sine of 30 degrees: sharper corners have no room for a wall's end

/// The piece of plan behind an edge that a wall stands on: both ends of the edge, then back.
struct Strip {
  std::array<Point2, 4> corners;
  double lead_in = 0, lead_out = 0;  ///< m by which the back is shorter at both ends
};

std::optional<Strip> strip_behind(const std::vector<PlanEdge>& edges, std::uint32_t number, double thickness) {
  const PlanEdge& e = edges[number];
  const Point2 in = e.inward();
  const auto lead = [&](Point2 neighbour, Point2 along) -> std::optional<double> {
    const double leans = neighbour.x * along.x + neighbour.y * along.y,
                 across = neighbour.x * in.x + neighbour.y * in.y;
    if (leans <= 0) return 0.0;
    if (across < kLeastAcross) return std::nullopt;
    return thickness * leans / across;
  };
  const Point2 before = edges[e.before].along, after = edges[e.after].along;
  const auto lead_in = lead({-before.x, -before.y}, e.along), lead_out = lead(after, {-e.along.x, -e.along.y});
  if (!lead_in || !lead_out || *lead_in + *lead_out > e.length / 2) return std::nullopt;
  const auto back = [&](double along) {
    return model::snap(
        Point2{e.from.x + e.along.x * along + in.x * thickness, e.from.y + e.along.y * along + in.y * thickness});
  };
  Strip out{{e.from, e.to, back(e.length - *lead_out), back(*lead_in)}, *lead_in, *lead_out};
  const std::vector<Point2> convex(out.corners.begin(), out.corners.end());
  for (const PlanEdge& other : edges)
    if (segment_enters(convex, other.from, other.to, kTouch)) return std::nullopt;
  return out;
}

/// The roof's surface within a strip: its pieces, and its border from the strip's first corner on, counter-clockwise.
struct Bed {
  std::vector<std::vector<std::vector<Point3>>> pieces;  ///< loops, seen from above
  std::array<std::vector<Point3>, 4> borders;            ///< each with both its ends
};

std::optional<Bed> bed_of(const Roof& roof, const Strip& strip, const std::vector<Point2>& front) {
  std::vector<std::vector<Point2>> regions(1, front);
  regions[0].insert(regions[0].end(), strip.corners.begin() + 1, strip.corners.end());
  std::map<Grid2, Point3> points;
  std::map<Grid2, Grid2> next;
  std::map<std::pair<Grid2, Grid2>, bool> border;
  Bed out;
  for (const RoofPiece& piece : pieces_under(roof, regions)) {
    const RoofPlane plane = plane_of(roof.surfaces[static_cast<std::size_t>(piece.surface)]);
    std::vector<std::vector<Point3>> loops;
    const auto add = [&](const model::Ring& ring) {
      loops.emplace_back();
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point2 p = ring.points[i], q = ring.points[(i + 1) % ring.size()];
        const Point3 here{p.x, p.y, model::snap(plane.height_at(p))};
        const Grid2 a = geometry::to_grid(p), b = geometry::to_grid(q);
        const auto [found, fresh] = points.emplace(a, here);
        if (!fresh && std::fabs(found->second.z - here.z) > 2 * kSameHeight) return false;  // a step in the roof
        loops.back().push_back(found->second);
        if (const auto twin = border.find({b, a}); twin != border.end())
          border.erase(twin);
        else
          border[{a, b}] = true;
      }
      return true;
    };
    if (!add(piece.plan.outer)) return std::nullopt;
    for (const auto& hole : piece.plan.holes)
      if (!add(hole)) return std::nullopt;
    out.pieces.push_back(std::move(loops));
  }
  for (const auto& [side, yes] : border)
    if (!next.emplace(side.first, side.second).second) return std::nullopt;
  Grid2 at = geometry::to_grid(strip.corners[0]);
  std::size_t used = 0;
  for (std::size_t side = 0; side < 4; ++side) {
    const Grid2 end = geometry::to_grid(strip.corners[(side + 1) % 4]);
    for (;;) {
      const auto found = points.find(at);
      if (found == points.end()) return std::nullopt;
      out.borders[side].push_back(found->second);
      if (at == end) break;
      const auto step = next.find(at);
      if (step == next.end() || ++used > next.size()) return std::nullopt;
      at = step->second;
    }
  }
  if (used != next.size()) return std::nullopt;
  return out;
}

std::vector<OutlinePoint> attic_outline(double width, double base, const GableOptions& options) {
  std::vector<OutlinePoint> out{{0, base}};
  const double share = std::min(options.pediment, 0.95);
  if (share > 0) {
    const double half = width * share / 2;
    out.push_back({width / 2 - half, base});
    out.push_back({width / 2, base + 2 * half * options.pediment_rise});
    out.push_back({width / 2 + half, base});
  }
  out.push_back({width, base});
  return out;
}

std::optional<model::Solid> wall_on(const Bed& bed, const PlanEdge& edge, const Strip& strip,
                                    const std::vector<OutlinePoint>& outline, double thickness) {
  const Point2 in = edge.inward();
  std::vector<Point3> front, back;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const OutlinePoint& p = outline[i];
    const bool first = p.along <= 0, last = p.along >= edge.length;
    const auto at = [&](double deep) {
      return Point3{edge.from.x + edge.along.x * p.along + in.x * deep,
                    edge.from.y + edge.along.y * p.along + in.y * deep, p.height};
    };
    Point3 f = at(0), b = at(thickness);
    if (first)
      f = {strip.corners[0].x, strip.corners[0].y, p.height}, b = {strip.corners[3].x, strip.corners[3].y, p.height};
    if (last)
      f = {strip.corners[1].x, strip.corners[1].y, p.height}, b = {strip.corners[2].x, strip.corners[2].y, p.height};
    front.push_back(model::snap(f));
    back.push_back(model::snap(b));
  }
  geometry::SolidBuilder builder;
  model::Face wall, roof, closure;
  wall.kind = SurfaceKind::wall;
  roof.kind = SurfaceKind::roof;
  closure.kind = SurfaceKind::closure;
  for (const auto& piece : bed.pieces) {
    auto below = piece;
    for (auto& loop : below) std::reverse(loop.begin(), loop.end());
    builder.add_face(below, closure);
  }
  std::vector<Point3> face = bed.borders[0];
  face.insert(face.end(), front.rbegin(), front.rend());
  builder.add_face(face, wall);
  face = bed.borders[1];
  face.push_back(back.back());
  face.push_back(front.back());
  builder.add_face(face, wall);
  face = bed.borders[2];
  face.insert(face.end(), back.begin(), back.end());
  builder.add_face(face, wall);
  face = bed.borders[3];
  face.push_back(front.front());
  face.push_back(back.front());
  builder.add_face(face, wall);
  for (std::size_t i = 1; i < front.size(); ++i) {
    const bool riser = outline[i].along - outline[i - 1].along <= 0;
    builder.add_face({front[i - 1], front[i], back[i], back[i - 1]}, riser ? wall : roof);
  }
  model::Solid solid = builder.take();
  const auto triangles = geometry::triangulate(solid);
  if (!triangles || !geometry::check_solid(solid, *triangles, geometry::kBuilt).valid()) return std::nullopt;
  return solid;
}

}  // namespace

BuiltGable ornamental_gable(const model::Polygon& plan, const Roof& roof, std::uint32_t number,
                            const GableOptions& options) {
  BuiltGable out;
  const auto edges = plan_edges(plan);
  const PlanEdge& edge = edges[number];
  const auto strip = strip_behind(edges, number, options.thickness);
  if (!strip) {
    out.refusal = GableRefusal::no_room;
    return out;
  }
  // Points of the wall's upper end lie off the edge's line by their rounding; the strip keeps to them.
  std::vector<Point2> front{edge.from};
  const auto& top = roof.wall_tops[number];
  for (std::size_t i = top.size(); i-- > 0;) {
    const Point2 p = top[i].xy();
    const double along = (p.x - edge.from.x) * edge.along.x + (p.y - edge.from.y) * edge.along.y;
    const double before = (front.back().x - edge.from.x) * edge.along.x + (front.back().y - edge.from.y) * edge.along.y;
    if (along > before + kTouch && along < edge.length - kTouch) front.push_back(p);
  }
  const auto bed = bed_of(roof, *strip, front);
  if (!bed) {
    out.refusal = GableRefusal::no_body;
    return out;
  }
  if (options.form == GableForm::attic) {
    double lowest = 1e18, highest = -1e18;
    for (const auto& border : bed->borders)
      for (const Point3& p : border) {
        lowest = std::min(lowest, p.z);
        highest = std::max(highest, p.z);
      }
    out.outline =
        attic_outline(edge.length, std::max(lowest + options.attic_height, highest + options.overtop), options);
  } else if (auto outline =
                 gable_outline(roof_silhouette(roof, edge, edge.length), strip->lead_in, strip->lead_out, options)) {
    out.outline = std::move(*outline);
  } else {
    out.refusal = GableRefusal::form;
    return out;
  }
  auto solid = wall_on(*bed, edge, *strip, out.outline, options.thickness);
  if (!solid) {
    out.refusal = GableRefusal::no_body;
    return out;
  }
  out.body = model::RoofInstallation{RoofElementKind::gable, std::move(*solid), {}};
  out.place.assign(strip->corners.begin(), strip->corners.end());
  return out;
}

bool may_stand_before(GableForm form, RoofShape roof) {
  switch (model::traits(roof).ornament) {
    case model::OrnamentalGable::gable:
      return form != GableForm::attic;
    case model::OrnamentalGable::attic:
      return form == GableForm::attic;
    case model::OrnamentalGable::none:
      break;
  }
  return false;
}

}  // namespace blockrand::roofs
