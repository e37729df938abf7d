// How far the slopes of a roof run, so that a pitch gives a height. docs/roofs.md, "Tags", has the list.
#include <algorithm>
#include <cmath>

#include "pipeline/geometry/polygon.h"
#include "styles/roofs/roof.h"
#include "styles/roofs/shape_tables.h"
#include "styles/roofs/eaves_lines.h"
#include "styles/roofs/roof_sides.h"
#include "styles/roofs/skeleton_roofs.h"

namespace blockrand::roofs {

using model::Point2;
using model::Polygon;
using model::RoofShape;

namespace {

double extent(const Polygon& plan, Point2 direction) {
  const geometry::Extent e = geometry::extent_along(plan.outer.points, direction);
  return e.maximum - e.minimum;
}

/// Half the width of a wing; on plain plans half the shorter side.
double half_width(const Polygon& plan) {
  const Point2 axis = geometry::long_axis(plan.outer.points);
  const double shorter = extent(plan, {-axis.y, axis.x});
  return (has_plain_extents(plan) ? shorter : std::min(shorter, geometry::equivalent_width(plan))) / 2;
}

/// The way from the eaves to a ridge between two gables.
double half_span(const Polygon& plan, const RoofRequest& request) {
  if (!is_one_wing(plan)) return half_width(plan);  // no skeleton: extents tell roughly
  const Point2 axis = ridge_axis(plan, request);
  return extent(plan, {-axis.y, axis.x}) / 2;
}

/// The plan's extent down a slope that a profile across the plan gives.
double way_down(const Polygon& plan, const RoofRequest& request) {
  if (request.down) return extent(plan, *request.down);
  if (request.shape == RoofShape::skillion || request.shape == RoofShape::sawtooth ||
      request.shape == RoofShape::saltbox)
    return extent(plan, default_slope(plan, request.edges));
  const Point2 axis = geometry::long_axis(plan.outer.points);
  return extent(plan, request.across ? axis : Point2{-axis.y, axis.x});
}

/// Do extents tell how far the slopes run, or does it take the skeleton?
bool needs_skeleton(const Polygon& plan, const RoofRequest& request) {
  if (!rises_from_edges(request.shape)) return false;
  const bool in_row = std::find(request.edges.begin(), request.edges.end(), model::RoofEdge::party_wall) != request.edges.end();
  return in_row || request.shape == RoofShape::berlin || !is_one_wing(plan) ||
         (request.along_eaves_lines && eaves_plan(plan, request.edges));
}

}  // namespace

double mansard_height(double run, double attic) {
  return attic + std::max(0.0, run - attic / kMansardSteep) * kMansardGentle;
}

bool has_plain_extents(const Polygon& plan) { return is_one_wing(plan); }

MainSlope main_slope(const Polygon& plan, const RoofRequest& request, bool steep) {
  if (needs_skeleton(plan, request)) {
    if (const SkeletonRun s = skeleton_run(plan, request); s.run > 0) {
      switch (request.shape) {
        case RoofShape::gambrel:
        case RoofShape::mansard:
          return steep ? MainSlope{kMansardRun * s.run, kMansardHeight, s.leans} : MainSlope{s.run, 1, s.leans};
        case RoofShape::double_saltbox:
        case RoofShape::quadruple_saltbox:
          return {kDeckRun * s.run, 1, s.leans};
        default:
          return {s.run, 1, s.leans};
      }
    }
  }
  switch (request.shape) {
    case RoofShape::flat:
    case RoofShape::many:
    case RoofShape::other:
      return {0, 1};
    case RoofShape::skillion:
      return {way_down(plan, request), 1};
    case RoofShape::saltbox:
      return {kDeckRun * way_down(plan, request), 1};
    case RoofShape::butterfly:
    case RoofShape::gabled_height_moved:
    case RoofShape::sawtooth: {
      const double way = way_down(plan, request);
      const auto points = profile_points(request.shape, way);
      return {points[1].at * way, std::fabs(points[1].height - points[0].height)};
    }
    case RoofShape::gambrel:
    case RoofShape::mansard: {
      const double run = request.shape == RoofShape::mansard ? half_width(plan) : half_span(plan, request);
      return steep ? MainSlope{kMansardRun * run, kMansardHeight} : MainSlope{run, 1};
    }
    case RoofShape::double_saltbox:
      return {kDeckRun * half_span(plan, request), 1};
    case RoofShape::quadruple_saltbox:
      return {kDeckRun * half_width(plan), 1};
    case RoofShape::gabled:
    case RoofShape::half_hipped:
    case RoofShape::side_hipped:
    case RoofShape::side_half_hipped:
    case RoofShape::round:
      return {half_span(plan, request), 1};
    default:
      return {half_width(plan), 1};
  }
}

}  // namespace blockrand::roofs
