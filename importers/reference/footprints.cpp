#include "importers/reference/footprints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "pipeline/base/error.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::importers::reference {
namespace {

using model::Point2;
using model::Point3;

/// Polygons less steep than this are horizontal: cosine of about 8 degrees. Modelled floors are flat; scanned ones
/// tilt.
constexpr double kHorizontal = 0.99;
/// m. Floors of one building within this height count as one ground, and ground lies no higher above the lowest point.
constexpr double kGroundBand = 0.5;
/// m² in plan. Less is a wall.
constexpr double kLeastPlanArea = 1e-4;

/// Newell's normal: its length is twice the area. M. E. Newell; see Sutherland et al., ACM Computing Surveys 6 (1974).
Point3 normal_of(const std::vector<Point3>& ring) {
  Point3 n;
  const Point3 o = ring[0];
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point3 a{ring[i].x - o.x, ring[i].y - o.y, ring[i].z - o.z};
    const Point3& next = ring[(i + 1) % ring.size()];
    const Point3 b{next.x - o.x, next.y - o.y, next.z - o.z};
    n.x += a.y * b.z - a.z * b.y;
    n.y += a.z * b.x - a.x * b.z;
    n.z += a.x * b.y - a.y * b.x;
  }
  return n;
}

bool is_horizontal(const Point3& n) {
  return std::fabs(n.z) >= kHorizontal * std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
}

double lowest_of(const std::vector<Point3>& ring) {
  double z = ring[0].z;
  for (const Point3& p : ring) z = std::min(z, p.z);
  return z;
}

model::Ring in_plan(const std::vector<Point3>& ring) {
  model::Ring out;
  for (const Point3& p : ring) {
    const Point2 q = model::snap(p.xy());
    if (out.points.empty() || out.points.back() != q) out.points.push_back(q);
  }
  while (out.points.size() > 1 && out.points.back() == out.points.front()) out.points.pop_back();
  out.nodes.assign(out.points.size(), 0);
  return out;
}

/// What a footprint is gathered from.
struct Gathered {
  std::vector<std::uint32_t> polygons;  ///< sorted, each once
  FootprintSource source = FootprintSource::none;
};

class Gatherer {
 public:
  explicit Gatherer(const ReferenceModel& model) : model_(model) {}

  /// The best that a Building or BuildingPart has for itself.
  Gathered gather(const Building& b) const {
    std::vector<std::uint32_t> polygons = ground_surfaces(b);
    if (has_plan_area(polygons)) return {std::move(polygons), FootprintSource::ground_surface};
    polygons = of_kind(b, GeometryKind::footprint);
    if (has_plan_area(polygons)) return {std::move(polygons), FootprintSource::footprint};
    const std::vector<std::uint32_t> shell = shell_of(b);
    polygons = lowest_horizontal(shell);
    if (has_plan_area(polygons)) return {std::move(polygons), FootprintSource::lowest_horizontal};
    polygons = of_kind(b, GeometryKind::roof_edge);
    if (has_plan_area(polygons)) return {std::move(polygons), FootprintSource::roof_edge};
    if (has_plan_area(shell)) return {shell, FootprintSource::plan};
    return {};
  }

 private:
  static void append(const std::vector<Geometry>& geometries, int lod, std::vector<std::uint32_t>& out) {
    for (const Geometry& g : geometries)
      if (g.lod == lod && (g.kind == GeometryKind::solid || g.kind == GeometryKind::surfaces))
        for (const Face& f : g.faces) out.push_back(f.polygon);
  }
  static int highest(const std::vector<Geometry>& geometries, int least) {
    for (const Geometry& g : geometries)
      if (g.kind == GeometryKind::solid || g.kind == GeometryKind::surfaces) least = std::max(least, g.lod);
    return least;
  }
  static std::vector<std::uint32_t> each_once(std::vector<std::uint32_t> polygons) {
    std::sort(polygons.begin(), polygons.end());
    polygons.erase(std::unique(polygons.begin(), polygons.end()), polygons.end());
    return polygons;
  }
  static bool is_shell(const Surface& s) {
    return !s.interior && !s.of_installation && s.surface_class != SurfaceClass::installation;
  }

  static std::vector<std::uint32_t> ground_surfaces(const Building& b) {
    int lod = -1;
    std::vector<std::uint32_t> out;
    for (const Surface& s : b.surfaces)
      if (is_shell(s) && s.surface_class == SurfaceClass::ground) lod = highest(s.geometries, lod);
    for (const Surface& s : b.surfaces)
      if (is_shell(s) && s.surface_class == SurfaceClass::ground) append(s.geometries, lod, out);
    return each_once(std::move(out));
  }

  static std::vector<std::uint32_t> of_kind(const Building& b, GeometryKind kind) {
    std::vector<std::uint32_t> out;
    for (const Geometry& g : b.geometries)
      if (g.kind == kind)
        for (const Face& f : g.faces) out.push_back(f.polygon);
    return each_once(std::move(out));
  }

  static std::vector<std::uint32_t> shell_of(const Building& b) {
    int lod = highest(b.geometries, -1);
    for (const Surface& s : b.surfaces)
      if (is_shell(s)) lod = highest(s.geometries, lod);
    std::vector<std::uint32_t> out;
    append(b.geometries, lod, out);
    for (const Surface& s : b.surfaces)
      if (is_shell(s)) append(s.geometries, lod, out);
    return each_once(std::move(out));
  }

  std::vector<std::uint32_t> lowest_horizontal(const std::vector<std::uint32_t>& shell) const {
    constexpr double kNowhere = std::numeric_limits<double>::infinity();
    double lowest = kNowhere, lowest_floor = kNowhere;
    for (const std::uint32_t i : shell) {
      const auto& ring = model_.polygons[i].outer;
      const double z = lowest_of(ring);
      lowest = std::min(lowest, z);
      if (plan_area(i) >= kLeastPlanArea && is_horizontal(normal_of(ring))) lowest_floor = std::min(lowest_floor, z);
    }
    std::vector<std::uint32_t> out;
    if (lowest_floor > lowest + kGroundBand) return out;
    for (const std::uint32_t i : shell) {
      const auto& ring = model_.polygons[i].outer;
      if (is_horizontal(normal_of(ring)) && lowest_of(ring) <= lowest_floor + kGroundBand) out.push_back(i);
    }
    return out;
  }

  /// Largest triangle in plan between the first point and an edge: 0 for what stands upright, not for rings that cross
  /// themselves.
  double plan_area(std::uint32_t polygon) const {
    const auto& ring = model_.polygons[polygon].outer;
    double largest = 0;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
      const double cross =
          (ring[i].x - ring[0].x) * (ring[i + 1].y - ring[0].y) - (ring[i].y - ring[0].y) * (ring[i + 1].x - ring[0].x);
      largest = std::max(largest, std::fabs(cross) / 2);
    }
    return largest;
  }

  bool has_plan_area(const std::vector<std::uint32_t>& polygons) const {
    return std::any_of(polygons.begin(), polygons.end(),
                       [&](std::uint32_t i) { return plan_area(i) >= kLeastPlanArea; });
  }

  const ReferenceModel& model_;
};

/// The polygon in plan, made valid.
void append_in_plan(const Polygon3& polygon, double clearance, std::vector<model::Polygon>& out) {
  std::vector<model::Ring> rings{in_plan(polygon.outer)};
  if (rings[0].size() < 3) return;
  for (const auto& hole : polygon.holes) {
    model::Ring ring = in_plan(hole);
    if (ring.size() >= 3) rings.push_back(std::move(ring));
  }
  std::vector<bool> inner(rings.size(), true);
  inner[0] = false;
  auto valid = geometry::make_valid(rings, inner, kLeastPlanArea, clearance);
  for (model::Polygon& p : valid.polygons) out.push_back(std::move(p));
}

}  // namespace

std::string_view name_of(FootprintSource source) {
  switch (source) {
    case FootprintSource::ground_surface:
      return "ground_surface";
    case FootprintSource::footprint:
      return "footprint";
    case FootprintSource::lowest_horizontal:
      return "lowest_horizontal";
    case FootprintSource::roof_edge:
      return "roof_edge";
    case FootprintSource::plan:
      return "plan";
    case FootprintSource::none:
      return "none";
  }
  return "";
}

std::vector<Footprint2D> ground_footprints(const ReferenceModel& model, const FootprintOptions& options) {
  if (model.crs.geographic || model.crs.metres_per_unit != 1.0)
    throw base::UsageError(model.path + ": footprints need a projected coordinate reference system in metres, not " +
                           model.crs.name);
  const Gatherer gatherer(model);
  std::vector<Footprint2D> out;
  std::vector<std::size_t> owner(model.buildings.size());  // index into `out`
  std::vector<std::vector<std::uint32_t>> polygons;        // as `out`
  for (std::size_t i = 0; i < model.buildings.size(); ++i) {
    const Building& b = model.buildings[i];
    if (b.parent < 0) {
      owner[i] = out.size();
      out.emplace_back();
      out.back().building = i;
      polygons.emplace_back();
    } else {
      owner[i] = owner[static_cast<std::size_t>(b.parent)];
    }
    const Gathered gathered = gatherer.gather(b);
    if (gathered.source == FootprintSource::none) continue;
    Footprint2D& f = out[owner[i]];
    f.source = f.source == FootprintSource::none ? gathered.source : std::max(f.source, gathered.source);
    auto& list = polygons[owner[i]];
    list.insert(list.end(), gathered.polygons.begin(), gathered.polygons.end());
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    std::vector<model::Polygon> pieces;
    bool first = true;
    for (const std::uint32_t p : polygons[i]) {
      const double z = lowest_of(model.polygons[p].outer);
      out[i].ground_height = first ? z : std::min(out[i].ground_height, z);
      first = false;
      append_in_plan(model.polygons[p], options.clearance, pieces);
    }
    auto united = geometry::unite(pieces, options.min_area, options.clearance);
    out[i].polygons = std::move(united.polygons);
    for (model::Polygon& p : out[i].polygons) {
      std::erase_if(p.holes, [&](const model::Ring& hole) {
        return std::fabs(geometry::signed_area(hole.points)) < options.min_area;
      });
      out[i].area += geometry::area(p);
    }
  }
  return out;
}

}  // namespace blockrand::importers::reference
