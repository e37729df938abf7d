#include "pipeline/facades/footprint_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "pipeline/base/text.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/solid_builder.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/model/vector.h"
#include "styles/grammar/shapes/initial_shape.h"

namespace blockrand::facades {
namespace {

using model::Point2;
using model::Point3;

/// m: of edges as long as each other the first counts, whatever the last digits say.
constexpr double kClearlyLonger = 0.05;
/// m, of streets whose distance is not known: what counts is that there is one.
constexpr double kSomeStreet = 10;
/// Of a face's unit normal: flatter ones are roofs or undersides (about 6 degrees off the vertical).
constexpr double kUpright = 0.1;
constexpr double kSmallest = 1e-6;  ///< m2, of a face
/// m: rings nearer to themselves than two grid steps are no rings (check_solid.h).
constexpr double kNarrow = 3.0 / model::kGridStepsPerMetre;

/// The edge of a ring that a wall stands on; none where no edge is near.
std::optional<std::size_t> edge_under(const std::vector<Point2>& ring, Point2 middle) {
  std::optional<std::size_t> best;
  double least = kSameWall;
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (const double d = geometry::distance_to_segment(middle, ring[i], ring[(i + 1) % ring.size()]); d < least)
      least = d, best = i;
  return best;
}

Point3 normal_of(const std::vector<Point3>& polygon) {
  Point3 sum{};
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    sum = sum + model::cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  }
  return sum;
}

/// Takes corners away that lie nearer to a side of theirs than kNarrow: the grid moved them there.
void widen(std::vector<Point3>& polygon) {
  while (polygon.size() >= 3) {
    const std::size_t n = polygon.size();
    std::optional<std::size_t> narrow;
    double least = kNarrow;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t e = 0; e < n; ++e) {
        if (e == i || (e + 1) % n == i) continue;
        const Point3 a = polygon[e], along = polygon[(e + 1) % n] - a, to = polygon[i] - a;
        const double length = model::dot(along, along);
        const double t = length > 0 ? std::clamp(model::dot(to, along) / length, 0.0, 1.0) : 0;
        if (const double d = model::length(to - along * t); d < least) least = d, narrow = i;
      }
    if (!narrow) return;
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(*narrow));
  }
}

}  // namespace

FootprintShape footprint_shape(const model::BuildingPart& part, double base, std::span<const WallFrame> walls,
                               std::span<const FacadeSegment> segments, const model::Building& building) {
  const model::Polygon& plan = part.roof_plan.outer.size() >= 3 ? part.roof_plan : part.plan;
  std::vector<Point2> ring = plan.outer.points;
  if (geometry::signed_area(ring) < 0) std::reverse(ring.begin(), ring.end());
  std::vector<double> streets(ring.size(), 0);
  std::optional<std::size_t> first;
  double longest = 0;
  for (const FacadeSegment& s : segments) {
    if (s.kind != model::WallSegmentKind::street) continue;
    const WallFrame& wall = walls[s.wall];
    const auto edge = edge_under(ring, wall.at({(s.from + s.to) / 2, 0}).xy());
    if (!edge) continue;
    double width = kSomeStreet;
    for (const std::uint32_t e : s.edges)
      if (const double distance = building.edges[e].street_distance; distance > 0) width = 2 * distance;
    streets[*edge] = std::max(streets[*edge], width);
    if (s.length() > longest) longest = s.length(), first = edge;
  }
  if (!first) {
    first = 0;
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (const double length = model::distance(ring[i], ring[(i + 1) % ring.size()]);
          length > longest + kClearlyLonger)
        longest = length, first = i;
  }
  std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(*first), ring.end());
  std::rotate(streets.begin(), streets.begin() + static_cast<std::ptrdiff_t>(*first), streets.end());
  // Numbers near zero keep their digits.
  const Point2 at = ring.empty() ? Point2{} : model::snap(ring[0]);
  FootprintShape out;
  out.world.origin = {at.x, at.y, base};
  out.world.axes = {grammar::Vector3{1, 0, 0}, grammar::Vector3{0, 0, 1}, grammar::Vector3{0, -1, 0}};
  const auto corner = [&](Point2 p) { return grammar::Vector3{p.x - at.x, 0, at.y - p.y}; };
  grammar::InitialPolygon polygon;
  for (const Point2& p : ring) polygon.outline.push_back(corner(p));
  for (const model::Ring& hole : plan.holes) {
    auto& points = polygon.holes.emplace_back();
    for (const Point2& p : hole.points) points.push_back(corner(p));
  }
  out.shape = grammar::initial_shape(std::span(&polygon, 1), std::move(streets));
  return out;
}

std::vector<std::pair<std::string, grammar::Value>> osm_attributes(const model::Building& building,
                                                                   const model::BuildingPart& part,
                                                                   const model::Extract* extract) {
  std::vector<std::pair<std::string, grammar::Value>> out;
  const auto number = [&](const char* key, double value) {
    if (std::isfinite(value)) out.emplace_back(key, base::shortest(value));
  };
  const model::Attributes& a = part.attributes;
  // Texts become numbers where the rules declare numbers.
  out.emplace_back("building", a.use.value);
  number("building:levels", a.storeys.value);
  number("height", a.height.value);
  number("min_height", a.min_height.value);
  number("roof:levels", a.roof_storeys.value);
  number("roof:height", a.roof_height.value);
  number("roof:angle", a.roof_pitch.value);
  if (a.roof_direction) number("roof:direction", a.roof_direction->value);
  std::string shape(model::name(part.built_roof));
  std::replace(shape.begin(), shape.end(), '_', '-');  // OSM writes half-hipped
  out.emplace_back("roof:shape", std::move(shape));
  out.emplace_back("roof:orientation",
                   std::string(a.roof_orientation.value == model::RoofOrientation::across ? "across" : "along"));
  out.emplace_back("building:colour", model::text(a.shown_wall_colour));
  out.emplace_back("roof:colour", model::text(a.shown_roof_colour));
  if (extract)
    for (const model::Range tags : {part.tags, building.tags})
      for (const model::Tag& tag : extract->tags_of(tags))
        out.emplace_back(std::string(extract->strings.view(tag.key)), std::string(extract->strings.view(tag.value)));
  // What tags name finer than classes do stays as mapped.
  out.emplace_back("building:material", a.wall_material.value);
  out.emplace_back("roof:material", a.roof_material.value);
  if (!building.attributes.construction_date.value.empty())
    out.emplace_back("start_date", building.attributes.construction_date.value);
  return out;
}

void RuleSurfaces::add(const std::string& rule, std::vector<Point3> polygon, const model::PartMaterial& look,
                       bool body) {
  std::vector<Point3> points;
  for (const Point3& p : polygon)
    if (const Point3 at = model::snap(p); points.empty() || !(points.back() == at)) points.push_back(at);
  while (points.size() > 1 && points.front() == points.back()) points.pop_back();
  widen(points);
  if (points.size() < 3 || model::length(normal_of(points)) < kSmallest) return;  // thinner than the grid
  const auto [at, is_new] = number_.try_emplace(rule, rules_.size());
  if (is_new) rules_.push_back(rule);
  corners_ += points.size();
  faces_.push_back({at->second, std::move(points), look, body});
}

/// Where two bodies touch with equal faces nobody sees either.
void RuleSurfaces::drop_hidden() {
  std::map<std::vector<Point3>, std::vector<std::size_t>> at;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (!faces_[f].body) continue;
    std::vector<Point3> key = faces_[f].polygon;
    std::sort(key.begin(), key.end());
    at[std::move(key)].push_back(f);
  }
  std::vector<bool> hidden(faces_.size(), false);
  for (const auto& [key, those] : at) {
    if (those.size() != 2) continue;
    const Point3 a = normal_of(faces_[those[0]].polygon), b = normal_of(faces_[those[1]].polygon);
    if (model::dot(a, b) < 0) hidden[those[0]] = hidden[those[1]] = true;
  }
  std::size_t kept = 0;
  for (std::size_t f = 0; f < faces_.size(); ++f)
    if (!hidden[f]) {
      if (kept != f) faces_[kept] = std::move(faces_[f]);
      ++kept;
    }
  faces_.resize(kept);
}

RuleSurfaces::Made RuleSurfaces::take(double ground) {
  drop_hidden();
  std::stable_sort(faces_.begin(), faces_.end(), [](const MadeFace& a, const MadeFace& b) { return a.rule < b.rule; });
  Made out;
  geometry::SolidBuilder builder;
  std::vector<std::vector<geometry::Triangle>> triangles;
  const double floor = model::snap(ground);
  std::size_t last = rules_.size();
  for (MadeFace& face : faces_) {
    std::vector<geometry::Grid3> grid;
    std::vector<std::uint32_t> loop;
    for (const Point3& p : face.polygon) {
      loop.push_back(static_cast<std::uint32_t>(grid.size()));
      grid.push_back(geometry::to_grid(p));
    }
    auto cover = geometry::triangulate(grid, std::span(&loop, 1));
    if (!cover || cover->empty()) continue;  // the grid folded it
    const Point3 normal = normal_of(face.polygon);
    const double up = normal.z / model::length(normal);
    model::Face looks;
    looks.material = face.look.material;
    looks.colour = face.look.colour;
    looks.kind = up > kUpright    ? model::SurfaceKind::roof
                 : up < -kUpright ? model::SurfaceKind::outer_ceiling
                                  : model::SurfaceKind::wall;
    if (looks.kind == model::SurfaceKind::outer_ceiling &&
        std::all_of(face.polygon.begin(), face.polygon.end(), [&](const Point3& p) { return p.z == floor; }))
      looks.kind = model::SurfaceKind::ground;
    builder.add_face(face.polygon, looks);
    if (face.rule != last) out.rules.push_back({rules_[face.rule], static_cast<std::uint32_t>(triangles.size()), 0});
    last = face.rule;
    ++out.rules.back().count;
    triangles.push_back(std::move(*cover));
  }
  out.surfaces = builder.take();
  out.surfaces.closed = false;
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    out.triangles.first.push_back(static_cast<std::uint32_t>(out.triangles.triangles.size()));
    const auto corners = out.surfaces.indices_of(out.surfaces.loops[out.surfaces.faces[f].first_loop]);
    for (const geometry::Triangle& t : triangles[f])
      out.triangles.triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
  }
  out.triangles.first.push_back(static_cast<std::uint32_t>(out.triangles.triangles.size()));
  faces_.clear(), rules_.clear(), number_.clear();
  corners_ = 0;
  return out;
}

}  // namespace blockrand::facades
