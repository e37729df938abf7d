// How far the slopes of a roof run, so that a pitch gives a height. docs/roofs.md, "Tags", has the list.
#include <algorithm>
#include <cmath>
#include <variant>

#include "pipeline/geometry/polygon_measures.h"
#include "styles/roofs/eaves_lines.h"
#include "styles/roofs/roof.h"
#include "styles/roofs/roof_sides.h"
#include "styles/roofs/shape_tables.h"
#include "styles/roofs/skeleton_roofs.h"

namespace blockrand::roofs {

using model::EavesProfile;
using model::Point2;
using model::Polygon;

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
double way_down(const Polygon& plan, const RoofRequest& request, const model::ProfileRoof& profile) {
  if (request.down) return extent(plan, *request.down);
  if (profile.falls_one_way) return extent(plan, default_slope(plan, request.edges));
  const Point2 axis = geometry::long_axis(plan.outer.points);
  return extent(plan, request.across ? axis : Point2{-axis.y, axis.x});
}

/// Do extents tell how far the slopes run, or does it take the skeleton?
bool needs_skeleton(const Polygon& plan, const RoofRequest& request, const model::EdgeRoof& roof) {
  const bool in_row =
      std::find(request.edges.begin(), request.edges.end(), model::RoofEdge::party_wall) != request.edges.end();
  return in_row || (request.side_pitches.any() && takes_side_pitches(request.shape)) ||
         roof.eaves == EavesProfile::berlin || !is_one_wing(plan) ||
         (request.along_eaves_lines && eaves_plan(plan, request.edges));
}

/// Do the slopes beside a ridge end at upright gables, so that the plan's span across the ridge is theirs? Hips at the
/// ends, of gablets as well, bound the run by the shorter side.
bool spans_between_gables(const model::EdgeRoof& roof) {
  switch (roof.ends) {
    case model::WingEnds::gables:
      // Without a skeleton, extents tell of the Berlin roof roughly.
      return roof.eaves != EavesProfile::berlin;
    case model::WingEnds::half_hips:
    case model::WingEnds::one_hip:
    case model::WingEnds::one_half_hip:
      return true;
    case model::WingEnds::hips:
    case model::WingEnds::gablets:
      break;
  }
  return false;
}

/// main_slope() by construction.
struct SlopeFinder {
  const Polygon& plan;
  const RoofRequest& request;
  bool steep;

  MainSlope operator()(const model::LevelRoof&) const { return {0, 1}; }
  MainSlope operator()(const model::UnknownRoof&) const { return {0, 1}; }
  MainSlope operator()(const model::ApexRoof&) const { return {half_width(plan), 1}; }
  MainSlope operator()(const model::CrossedRoof&) const { return {half_width(plan), 1}; }
  MainSlope operator()(const model::LinedRoof&) const { return {half_width(plan), 1}; }

  MainSlope operator()(const model::ProfileRoof& roof) const {
    const double way = way_down(plan, request, roof);
    const auto points = profile_points(request.shape, way);
    return {points[1].at * way, std::fabs(points[1].height - points[0].height)};
  }

  MainSlope operator()(const model::EdgeRoof& roof) const {
    if (needs_skeleton(plan, request, roof))
      if (const SkeletonRun s = skeleton_run(plan, request); s.run > 0) return of_run(roof, s.run, s.leans);
    return of_run(roof, spans_between_gables(roof) ? half_span(plan, request) : half_width(plan), false);
  }

  MainSlope of_run(const model::EdgeRoof& roof, double run, bool leans) const {
    switch (roof.eaves) {
      case EavesProfile::broken:
        return steep ? MainSlope{kMansardRun * run, kMansardHeight, leans} : MainSlope{run, 1, leans};
      case EavesProfile::decked:
        return {kDeckRun * run, 1, leans};
      case EavesProfile::one_pitch:
      case EavesProfile::vaulted:
      case EavesProfile::berlin:
        break;
    }
    return {run, 1, leans};
  }
};

}  // namespace

double mansard_height(double run, double attic) {
  return attic + std::max(0.0, run - attic / kMansardSteep) * kMansardGentle;
}

bool takes_side_pitches(model::RoofShape shape) {
  const auto* roof = model::constructed_as<model::EdgeRoof>(shape);
  return roof && roof->eaves == EavesProfile::one_pitch;
}

bool has_plain_extents(const Polygon& plan) { return is_one_wing(plan); }

MainSlope main_slope(const Polygon& plan, const RoofRequest& request, bool steep) {
  return std::visit(SlopeFinder{plan, request, steep}, model::traits(request.shape).construction);
}

}  // namespace blockrand::roofs
