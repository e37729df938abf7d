// Rules that begin on the footprint: one derivation a part, whose leaves are its LoD3.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/base/random.h"
#include "pipeline/facades/facade_builder.h"
#include "pipeline/facades/leaf_polygons.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/model/vector.h"
#include "styles/grammar/shapes/mesh_triangles.h"
#include "styles/grammar/shapes/scope.h"

namespace blockrand::facades {

using model::BuildingPart;
using model::IssueCode;
using model::Point2;
using model::Point3;

namespace {

/// Of the axes of a leaf that orders an element: elements are turned about the vertical alone.
constexpr double kUprightLeaf = 1e-3;
/// Leaves of fewer faces have no inside.
constexpr std::size_t kLeastBody = 4;
/// Of the limit of shapes, which is one wall's.
constexpr std::size_t kWallsOfAHouse = 20;
/// m from the first corner of the footprint: no house has anything there.
constexpr double kFarthest = 1000;
/// Of its box, that a leaf must fill to be a rectangle.
constexpr double kRectangle = 0.99;
/// m2, of a piece of wall round an element.
constexpr double kLeastPiece = 1e-4;
/// m, by which a difference of polygons may move points apart.
constexpr double kClearance = 1.0 / model::kGridStepsPerMetre;

/// Whether rules lift the footprint themselves: then it lies on the ground.
bool reads_underside(const GrammarLibrary::Entry& grammar) {
  return GrammarLibrary::reads(grammar, "min_height") || GrammarLibrary::reads(grammar, "building__min_level");
}

model::Polygon polygon(const std::vector<Point2>& points) {
  model::Polygon out;
  for (const Point2& p : points) out.outer.points.push_back(model::snap(p));
  out.outer.nodes.assign(points.size(), 0);
  return out;
}

}  // namespace

void FacadeBuilder::build_on_footprint(const GrammarLibrary::Entry& grammar, const model::Building& building,
                                       BuildingPart& part, const std::vector<WallFrame>& walls,
                                       const std::vector<FacadeSegment>& segments, double eaves, std::uint64_t seed,
                                       std::uint64_t row) {
  take_parameters(grammar, building, part);
  const model::Attributes& a = part.attributes;
  const double base = a.ground_height.value + (reads_underside(grammar) ? 0 : a.min_height.value);
  const FootprintShape footprint = footprint_shape(part, base, walls, segments, building);
  if (!footprint.shape.mesh || footprint.shape.mesh->faces.empty()) return;
  // The first of a name counts: orders, the preset's own values, what the building is.
  grammar::DeriveOptions options;
  options.attributes = derive_options_.attributes;
  for (auto& value : osm_attributes(building, part, extract_)) options.attributes.push_back(std::move(value));
  options.seed = base::random_bits(seed, base::hash_text(part.id), "footprint");
  options.building_seed = seed;
  options.row_seed = row;
  options.limits.shapes = options_.most_shapes * kWallsOfAHouse;
  std::optional<FacadeContext> context;
  if (!segments.empty()) {
    const FacadeSegment* front = &segments.front();
    for (const FacadeSegment& s : segments)
      if (s.kind == model::WallSegmentKind::street && (front->kind != s.kind || s.length() > front->length()))
        front = &s;
    context.emplace(building, part, walls[front->wall], *front, eaves, nullptr, &defaults_);
    options.source = [&](std::string_view name) { return context_value(*context, name); };
  }
  const grammar::Derivation derivation = grammar.deriver->run(footprint.shape, options);
  bool cut_short = false;
  for (const grammar::Diagnostic& d : derivation.diagnostics) {
    if (d.severity == grammar::Severity::error) tell(d.message);
    cut_short = cut_short || d.code == "too_many_shapes" || d.code == "too_many_calls";
  }
  if (cut_short) {  // half a house would stand open
    tell("the rules of " + grammar.file + " were stopped: the body stays as it is without them");
    return finish_told(part, 0);
  }

  const model::PartMaterial usual = usual_materials_[static_cast<std::size_t>(model::ElementPart::wall)];
  RuleSurfaces surfaces;
  model::Detail detail;
  for (const grammar::Leaf& leaf : derivation.leaves) {
    if (!leaf.shape.mesh) continue;
    const grammar::Frame frame = grammar::compose(footprint.world, grammar::scope_in_world(leaf.shape));
    LeafPolygons made = leaf_polygons(leaf, frame, usual, defaults_);
    if (made.polygons.empty()) continue;
    if (leaf.shape.material && !leaf.shape.material->colour_map.empty())
      tell("the image " + leaf.shape.material->colour_map + " is not shown: what rules make has colours alone");
    const auto is_far = [&](const Point3& p) {
      return !(std::fabs(p.x - footprint.world.origin.x) < kFarthest &&
               std::fabs(p.y - footprint.world.origin.y) < kFarthest && std::fabs(p.z - base) < kFarthest);
    };
    if (std::ranges::any_of(made.polygons, [&](const auto& p) { return std::ranges::any_of(p, is_far); })) {
      ++dropped_[fmt::format("{}: it lies {:g} m off its footprint, or nowhere", made.symbol, kFarthest)];
      continue;
    }
    std::size_t corners = surfaces.corners();
    for (const auto& p : made.polygons) corners += p.size();
    if (corners > RuleSurfaces::kMostCorners) {
      ++dropped_[made.symbol + ": more than two million corners on one footprint"];
      continue;
    }
    if (leaf.order && order_on_footprint(leaf, frame, made, surfaces, detail)) continue;
    const bool clear = leaf.shape.material && leaf.shape.material->colour[3] < 1;
    const bool body = made.polygons.size() >= kLeastBody && !clear;
    for (auto& p : made.polygons) surfaces.add(made.symbol, std::move(p), made.look, body);
  }
  RuleSurfaces::Made made = surfaces.take(a.ground_height.value);
  if (made.surfaces.faces.empty()) {
    tell("the rules of " + grammar.file + " made nothing of the footprint: the body stays as it is without them");
    return finish_told(part, 0);
  }
  detail.solid = std::move(made.surfaces);
  detail.triangles = std::move(made.triangles);
  detail.rules = std::move(made.rules);
  part.lod3 = std::move(detail);
  part.lod = 3;
  finish_told(part, 0);
}

bool FacadeBuilder::order_on_footprint(const grammar::Leaf& leaf, const grammar::Frame& frame, const LeafPolygons& made,
                                       RuleSurfaces& surfaces, model::Detail& detail) {
  const grammar::ElementRequest& order = *leaf.order;
  if (order.name == kPaintOperation) {
    tell("blockrand.paint is for rules that begin on a wall; color() does it on a footprint");
    return false;
  }
  if (order.arguments.empty() || !std::holds_alternative<std::string>(order.arguments[0])) {
    tell("blockrand." + order.name + " wants the name of an element first");
    return false;
  }
  const model::PartMaterial& look = made.look;
  const grammar::Vector3 right = frame.axes[0], up = frame.axes[1];
  if (std::fabs(right.z) > kUprightLeaf || up.z < 1 - kUprightLeaf) {
    ++dropped_[leaf.symbol + ": elements stand on upright faces alone"];
    return false;
  }
  double area = 0;
  for (const auto& p : made.polygons) {
    Point3 sum{};
    for (std::size_t i = 1; i + 1 < p.size(); ++i) sum = sum + model::cross(p[i] - p[0], p[i + 1] - p[0]);
    area += model::length(sum) / 2;
  }
  if (std::fabs(leaf.shape.size.z) > kUprightLeaf || area < kRectangle * leaf.shape.size.x * leaf.shape.size.y) {
    ++dropped_[leaf.symbol + ": elements stand on flat rectangles alone"];
    return false;
  }
  const std::string& name = std::get<std::string>(order.arguments[0]);
  const elements::ElementKind* kind = grammars_.elements().find(name);
  const bool run = kind && kind->width.measures == "run";
  const Point2 along = Point2{right.x, right.y} * (1 / std::hypot(right.x, right.y));
  const grammar::Vector3 corner = frame.origin;
  const double width = leaf.shape.size.x, height = leaf.shape.size.y;
  // u along, v up, w out of the leaf's plane.
  const auto at = [&](double u, double v, double w) {
    return Point3{corner.x + along.x * u + along.y * w, corner.y + along.y * u - along.x * w, corner.z + v};
  };
  std::vector<std::pair<double, double>> pieces{{0, width}};
  if (run) pieces = no_longer_than(kind->width.most, pieces);
  PartMaterials looks = usual_materials_;
  looks[static_cast<std::size_t>(model::ElementPart::wall)] = look;
  bool stands_in_it = false;
  for (const auto& [from, to] : pieces) {
    const auto [made_width, made_height] = ElementLibrary::size(kind, to - from, height);
    if (!(made_width > 0 && made_height > 0)) return false;
    library_.ask(name, made_width, made_height, looks);
    complaints_.clear();
    library_.add_request(order, from == 0, to == width, complaints_);
    for (const std::string& what : complaints_) tell(what);
    std::string error;
    const std::uint32_t number = library_.take(error);
    if (!error.empty()) tell(error);
    if (number == ElementLibrary::kNone) return false;
    const double middle = (from + to) / 2;
    detail.placements.push_back({number, model::snap(at(middle, 0, 0)), along, model::kNoOpening, 0, 0});
    const model::OpeningOutline& opening = library_.element(number).opening;
    if (opening.outline.empty()) continue;
    // What is left of the leaf around the opening, and the opening's sides.
    stands_in_it = true;
    const std::string symbol = leaf.symbol.ends_with('.') ? leaf.symbol.substr(0, leaf.symbol.size() - 1) : leaf.symbol;
    std::vector<Point2> hole;
    for (const Point2& p : opening.outline) hole.push_back({p.x + middle, p.y});
    const std::vector<model::Polygon> whole{polygon({{0, 0}, {width, 0}, {width, height}, {0, height}})},
        away{polygon(hole)};
    grammar::Mesh mesh;
    for (const model::Polygon& piece : geometry::difference(whole, away, kLeastPiece, kClearance).polygons) {
      grammar::MeshFace& face = mesh.faces.emplace_back();
      const auto add = [&](const model::Ring& ring) {
        auto& loop = face.loops.emplace_back();
        for (const Point2& p : ring.points) {
          loop.push_back({static_cast<std::uint32_t>(mesh.vertices.size()), 0});
          mesh.vertices.push_back({p.x, p.y, 0});
        }
      };
      add(piece.outer);
      for (const model::Ring& inner : piece.holes) add(inner);
    }
    for (const grammar::MeshTriangle& t : grammar::triangles_of(mesh)) {
      std::vector<Point3> triangle;
      for (const std::uint32_t v : t.vertices) triangle.push_back(at(mesh.vertices[v].x, mesh.vertices[v].y, 0));
      surfaces.add(symbol, std::move(triangle), look, false);
    }
    for (std::size_t i = 0; i < hole.size() && opening.reveal > 0; ++i) {
      const Point2 p = hole[i], q = hole[(i + 1) % hole.size()];
      surfaces.add(symbol,
                   {at(p.x, p.y, 0), at(q.x, q.y, 0), at(q.x, q.y, -opening.reveal), at(p.x, p.y, -opening.reveal)},
                   look, false);
    }
  }
  return stands_in_it;  // what stands on the leaf leaves it there
}

}  // namespace blockrand::facades
