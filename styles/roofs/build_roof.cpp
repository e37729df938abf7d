// Which kind of roof a shape is, and what stands for it on plans that do not take it. docs/roofs.md is the list.
#include <algorithm>
#include <cmath>
#include <variant>

#include "pipeline/geometry/polygon_measures.h"
#include "styles/roofs/roof.h"
#include "styles/roofs/shape_tables.h"
#include "styles/roofs/skeleton_roofs.h"

namespace blockrand::roofs {

using model::IssueCode;
using model::Point2;
using model::Polygon;
using model::RoofShape;

namespace {

/// The same request for a relative of the shape, said so.
std::optional<BuiltRoof> adapted(const Polygon& plan, RoofRequest request, RoofShape relative) {
  const RoofShape asked = request.shape;
  request.shape = relative;
  auto built = skeleton_roof(plan, request);
  if (built && built->note == IssueCode::none) {
    built->note = IssueCode::roof_shape_adapted;
    built->detail = std::string(model::name(asked)) + " as " + std::string(model::name(relative));
  }
  return built;
}

BuiltRoof as_asked(Roof roof, RoofShape shape) { return {std::move(roof), shape, IssueCode::none, {}}; }

/// The way up across the plan of the shapes with one profile.
Point2 way_up(const Polygon& plan, const RoofRequest& request, const model::ProfileRoof& profile) {
  if (request.down) return {-request.down->x, -request.down->y};
  if (profile.falls_one_way) {
    const Point2 down = default_slope(plan, request.edges);
    return {-down.x, -down.y};
  }
  const Point2 axis = geometry::long_axis(plan.outer.points);
  const Point2 up = request.across ? axis : Point2{-axis.y, axis.x};
  // Low where the longest edge looks (in rows: as default_slope() says), so that turning a plan turns its roof; where it lies along the way, where
  // its following corner lies.
  const Point2 down = default_slope(plan, request.edges);
  double against = up.x * down.x + up.y * down.y;
  constexpr double kSquare = 0.1;
  if (std::fabs(against) < kSquare) against = up.x * -down.y + up.y * down.x;
  return against > 0 ? Point2{-up.x, -up.y} : up;
}

/// Relatives are shapes that stand on every plan.
constexpr bool relatives_rise_from_edges() {
  for (std::size_t i = 0; i < model::kRoofShapeCount; ++i) {
    const auto shape = static_cast<RoofShape>(i);
    const auto* crossed = model::constructed_as<model::CrossedRoof>(shape);
    if (crossed && !model::rises_from_edges(crossed->relative)) return false;
    const auto* rings = model::constructed_as<model::ApexRoof>(shape);
    if (rings && !model::rises_from_edges(rings->relative) && !model::constructed_as<model::ApexRoof>(rings->relative))
      return false;
  }
  return true;
}
static_assert(relatives_rise_from_edges());

/// build_roof() by construction.
struct RoofBuilder {
  const Polygon& plan;
  const RoofRequest& request;

  std::optional<BuiltRoof> operator()(const model::EdgeRoof&) const { return skeleton_roof(plan, request); }

  std::optional<BuiltRoof> operator()(const model::ApexRoof& form) const {
    if (auto roof = apex_roof(plan, request.measures, apex_rings(request.shape)))
      return as_asked(std::move(*roof), request.shape);
    if (model::rises_from_edges(form.relative)) return adapted(plan, request, form.relative);
    auto built = vaulted_roof(plan, request);
    if (built && built->note == IssueCode::none) {
      built->note = IssueCode::roof_shape_adapted;
      built->shape = form.relative;
      built->detail = std::string(model::name(request.shape)) + " without an apex";
    }
    return built;
  }

  std::optional<BuiltRoof> operator()(const model::CrossedRoof& form) const {
    if (auto roof = crossed_roof(plan, request.measures, form.gable_height))
      return as_asked(std::move(*roof), request.shape);
    return adapted(plan, request, form.relative);
  }

  std::optional<BuiltRoof> operator()(const model::ProfileRoof& form) const {
    const Point2 up = way_up(plan, request, form);
    const geometry::Extent extent = geometry::extent_along(plan.outer.points, up);
    const auto points = profile_points(request.shape, extent.maximum - extent.minimum);
    if (auto roof = profile_roof(plan, request.measures, up, points)) return as_asked(std::move(*roof), request.shape);
    return std::nullopt;
  }

  std::optional<BuiltRoof> operator()(const model::LevelRoof&) const { return level(); }
  /// Lines make a roof by lined_roof(): here is none of them.
  std::optional<BuiltRoof> operator()(const model::LinedRoof&) const { return level(); }
  std::optional<BuiltRoof> operator()(const model::UnknownRoof&) const {
    BuiltRoof out = level();
    out.note = IssueCode::roof_shape_unknown;
    out.detail = request.shape == RoofShape::many ? "many" : "";
    return out;
  }

  BuiltRoof level() const {
    return as_asked(flat_roof(plan, request.measures.eaves + request.measures.height), RoofShape::flat);
  }
};

}  // namespace

std::optional<BuiltRoof> build_roof(const Polygon& plan, const RoofRequest& request) {
  return std::visit(RoofBuilder{plan, request}, model::traits(request.shape).construction);
}

}  // namespace blockrand::roofs
