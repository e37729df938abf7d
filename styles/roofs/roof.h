// Roofs on plans: from a shape and its measures to the surfaces above the eaves. docs/roofs.md says what each shape is.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/model/issue_codes.h"
#include "pipeline/model/polygon.h"
#include "pipeline/model/roof_element.h"
#include "pipeline/model/roof_line.h"
#include "pipeline/model/roof_shape.h"
#include "pipeline/model/side_pitches.h"

namespace blockrand::roofs {

/// A roof as surfaces over a plan. Edges are numbered ring by ring, outer ring first; edge i starts at corner i.
struct Roof {
  struct Surface {
    std::int32_t edge = -1;                         ///< the plan edge it rises from; -1 when none
    std::vector<std::vector<model::Point3>> loops;  ///< counter-clockwise from outside; holes follow
    bool upright = false;                           ///< a piece of wall that stands in the roof: gablet, sawtooth
    std::int32_t element = -1;  ///< the element it belongs to (its cheek, front, roof): Roof::elements
  };
  std::vector<Surface> surfaces;
  /// For each plan edge the upper end of its wall, from the edge's end back to its start: two points at eaves height
  /// for most, more for a gable.
  std::vector<std::vector<model::Point3>> wall_tops;
  /// What was built into the surfaces: dormers and cross gables. The roof stays one closed surface with them.
  std::vector<model::RoofElementKind> elements;
};

/// Measures of a roof. Heights in metres.
struct RoofMeasures {
  double eaves = 0;   ///< z of the lowest eaves
  double height = 0;  ///< eaves to the highest point
};

/// What is asked of a roof.
struct RoofRequest {
  model::RoofShape shape = model::RoofShape::flat;
  RoofMeasures measures;
  std::optional<model::Point2> down;  ///< unit vector down the slope (roof:direction)
  bool across = false;                ///< roof:orientation=across: the axis is the shorter side
  double attic = 0;                   ///< m, mansard and gambrel: height of the break above the eaves; 0: by the table
  model::SidePitches side_pitches;    ///< of shapes with one pitch on all sides; others do not read it
  double other_sides_pitch = 0;       ///< degrees, of the sides without one of their own; wanted beside `side_pitches`
  double coarseness = 1;              ///< geometry::roof_surfaces(); for a second try
  /// One per plan edge, ring by ring; empty: all open. Party walls turn ridges and make lean-to roofs (roof_sides.h).
  std::vector<model::RoofEdge> edges;
  /// Bays and recesses of facades get no slopes of their own (eaves_lines.h). No roof where that does not fit the plan.
  bool along_eaves_lines = false;
  bool shape_is_mapped =
      false;  ///< tagged: hips, two slopes and gables at street corners stay, whatever the row is like
  bool axis_is_mapped = false;  ///< `down` and `across` are: ridges run that way, eaves along party walls or not
};

/// What was built.
struct BuiltRoof {
  Roof roof;
  model::RoofShape shape = model::RoofShape::flat;  ///< differs from the asked one where the plan does not take it
  model::IssueCode note = model::IssueCode::none;   ///< ROOF_SHAPE_ADAPTED, ROOF_SHAPE_UNKNOWN, SKELETON_FALLBACK
  std::string detail;
  model::SidePitches pitches_met{};  ///< of RoofRequest::side_pitches those that a side of the roof has
};

/// The roof of `request.shape` on a plan (strictly simple, on the grid). Empty when none can be built, which callers
/// report; the surfaces' edges match each other and the wall tops point by point.
std::optional<BuiltRoof> build_roof(const model::Polygon& plan, const RoofRequest& request);

/// Coarseness of the tries at one roof, until its solid is valid. At 3, nodes of a centimetre and a half are one, at 10
/// those of five: coordinates in OpenStreetMap are multiples of 1e-7 degrees, a centimetre, so what is regular on the ground
/// has events that lie centimetres apart.
inline constexpr double kCoarseness[] = {1, 3, 10};

// ---- kinds of roofs, on which build_roof() draws

/// One horizontal surface.
Roof flat_roof(const model::Polygon& plan, double z);

/// Every plan edge's point on a line of the profile below: `at` in [0, 1] of the way, heights as shares of the roof's.
/// Two entries with one `at` are an upright step.
struct ProfilePoint {
  double at = 0, height = 0;
};

/// A roof whose height depends on the way along `up` alone: 0 at the plan's first extent in that direction, 1 at its
/// last; `profile` runs from 0 to 1. Works on every plan with holes; lines of the profile cut it into faces.
std::optional<Roof> profile_roof(const model::Polygon& plan, RoofMeasures measures, model::Point2 up,
                                 std::span<const ProfilePoint> profile);

/// A ring of the plan scaled about its apex: `size` in [0, 1], height as a share of the roof's.
struct ApexRing {
  double size = 0, height = 0;
};

/// Rings of the plan, scaled about the centroid, joined by a face per edge; `rings` begin with {1, 0} and end with
/// {0, 1}. Empty for plans with holes and where the centroid does not see every edge from 0.05 m inside.
std::optional<Roof> apex_roof(const model::Polygon& plan, RoofMeasures measures, std::span<const ApexRing> rings);

/// A gable over the middle of every edge, `gable_height` of the roof's height high, and ridges from there to the apex over
/// the centroid. Two faces that share a plane at a corner become one. Empty for plans with holes, concave plans and
/// those with more than 12 edges.
std::optional<Roof> crossed_roof(const model::Polygon& plan, RoofMeasures measures, double gable_height);

/// The slope that a roof's pitch speaks of: how far it runs horizontally and which share of the roof's height it climbs.
struct MainSlope {
  double run = 0;      ///< m
  double rise = 1;     ///< share of the roof's height
  bool leans = false;  ///< of a lean-to in a row, whose usual pitch is gentler
};

/// Shapes whose sides may have pitches of their own (RoofRequest::side_pitches): what rises from edges with one pitch.
bool takes_side_pitches(model::RoofShape shape);

/// The main slope of `request.shape` on a plan (docs/roofs.md, "Tags"). Of plans of one wing that stand free, from their extents
/// alone: exact on rectangles, near on others. In rows and on plans of several wings, from the skeleton, so that a pitch is
/// exactly that of the roof. `request.measures` is not read.
/// \param steep  of mansard and gambrel, the lower slope; else all of the way up
MainSlope main_slope(const model::Polygon& plan, const RoofRequest& request, bool steep);

/// m. Height of a mansard over `run` m with an attic storey of `attic` m behind its steep slopes, at the usual pitches of
/// 68 and 26 degrees (docs/style_measures.md 2.7).
double mansard_height(double run, double attic);
inline constexpr double kMansardSteep = 2.4750868534162964;    ///< tangent of 68 degrees
inline constexpr double kMansardGentle = 0.48773258856586144;  ///< tangent of 26 degrees

/// True for plans of one wing: their extents tell how far slopes run and in which direction.
bool has_plain_extents(const model::Polygon& plan);

/// The roof that roof:ridge, roof:edge and roof:apex draw (docs/roofs.md, "Lines"), from points on the grid. Empty when there is
/// no ridge, when lines cross where they have no common point, leave the plan, or hang in the air.
std::optional<Roof> lined_roof(const model::Polygon& plan, RoofMeasures measures,
                               std::span<const model::RoofLine> lines);

/// Unit vector of a compass direction in degrees (0 north, 90 east).
model::Point2 compass_vector(double degrees);

/// A direction down the slope for a lean-to roof that has none tagged: across the longest edge that is no party wall,
/// outwards. In a row, away from the street if a wall is free there; else away from a party wall, but not to the street if
/// that can be avoided: the high side stands on the fire wall, water runs to the yard.
model::Point2 default_slope(const model::Polygon& plan, const std::vector<model::RoofEdge>& edges = {});

}  // namespace blockrand::roofs
