// Which kind of roof a shape is, and what stands for it on plans that do not take it. docs/roofs.md is the list.
#include <algorithm>
#include <cmath>

#include "pipeline/geometry/polygon.h"
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
Point2 way_up(const Polygon& plan, const RoofRequest& request) {
  if (request.down) return {-request.down->x, -request.down->y};
  if (request.shape == RoofShape::skillion || request.shape == RoofShape::saltbox ||
      request.shape == RoofShape::sawtooth) {
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

}  // namespace

std::optional<BuiltRoof> build_roof(const Polygon& plan, const RoofRequest& request) {
  const RoofMeasures measures = request.measures;
  if (rises_from_edges(request.shape)) return skeleton_roof(plan, request);
  switch (request.shape) {
    case RoofShape::pyramidal:
    case RoofShape::cone:
    case RoofShape::spire:
    case RoofShape::dome:
    case RoofShape::onion: {
      if (auto roof = apex_roof(plan, measures, apex_rings(request.shape)))
        return as_asked(std::move(*roof), request.shape);
      if (request.shape != RoofShape::dome && request.shape != RoofShape::onion)
        return adapted(plan, request, RoofShape::hipped);
      auto built = vaulted_roof(plan, request);
      if (built && built->note == IssueCode::none) {
        built->note = IssueCode::roof_shape_adapted;
        built->shape = RoofShape::dome;
        built->detail = std::string(model::name(request.shape)) + " without an apex";
      }
      return built;
    }
    case RoofShape::crosspitched:
      if (auto roof = crossed_roof(plan, measures, 1)) return as_asked(std::move(*roof), request.shape);
      return adapted(plan, request, RoofShape::gabled);
    case RoofShape::helm:
      if (auto roof = crossed_roof(plan, measures, 0.5)) return as_asked(std::move(*roof), request.shape);
      return adapted(plan, request, RoofShape::hipped);
    case RoofShape::skillion:
    case RoofShape::saltbox:
    case RoofShape::butterfly:
    case RoofShape::gabled_height_moved:
    case RoofShape::sawtooth: {
      const Point2 up = way_up(plan, request);
      const geometry::Extent extent = geometry::extent_along(plan.outer.points, up);
      const auto points = profile_points(request.shape, extent.maximum - extent.minimum);
      if (auto roof = profile_roof(plan, measures, up, points)) return as_asked(std::move(*roof), request.shape);
      return std::nullopt;
    }
    default: {
      BuiltRoof out = as_asked(flat_roof(plan, measures.eaves + measures.height), RoofShape::flat);
      if (request.shape == RoofShape::other || request.shape == RoofShape::many) {
        out.note = IssueCode::roof_shape_unknown;
        out.detail = request.shape == RoofShape::many ? "many" : "";
      }
      return out;
    }
  }
}

}  // namespace blockrand::roofs
