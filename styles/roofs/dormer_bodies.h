// What dormers and cross gables have in common: a front with a head, and a roof that runs back until the slope swallows
// it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/model/point.h"
#include "styles/roofs/element_layout.h"
#include "styles/roofs/roof.h"

namespace blockrand::roofs {

/// The six heads. The comment tells what DormerParameters::roof_pitch and rise mean to each.
enum class DormerKind : std::uint8_t {
  gabled,     ///< ridge level and square to the front; pitch of both planes
  hipped,     ///< as gabled, with a hip over the front: of the same pitch, steeper where the slope leaves less room
  shed,       ///< one plane that falls to the front; its pitch
  flat,       ///< one level plane
  segmental,  ///< an arc `rise` high over the front, its barrel level
  eyebrow,    ///< no cheeks: the front swells out of the slope, `wall_height` high; pitch of the roof behind it
};
inline constexpr DormerKind kDormerKinds[] = {DormerKind::gabled, DormerKind::hipped,    DormerKind::shed,
                                              DormerKind::flat,   DormerKind::segmental, DormerKind::eyebrow};

/// Measures of such a front.
struct DormerBodyMeasures {
  DormerKind kind = DormerKind::gabled;
  double width = 0, wall_height = 0, rise = 0;  ///< m
  double roof_pitch = 0;                        ///< degrees
  int chords = 0;                               ///< of arcs
};

/// In axes of its own: x along the front from its middle, y level into the slope, z up from the slope below the front's
/// middle. The front stands at y = 0.
struct DormerBody {
  struct Face {
    std::vector<model::Point3> loop;  ///< counter-clockwise from outside
    bool upright = false;
  };
  std::vector<model::Point3> outline;  ///< on the slope: from the front's left end over the back to its right end
  /// The front's upper border from right to left; may begin and end in the ends of the outline.
  std::vector<model::Point3> head;
  std::vector<Face> faces;  ///< cheeks and roof; not the front
  double highest = 0;       ///< m above the slope below the front's middle
};

/// \param rise  tangent of the slope's pitch
/// Empty when the measures make no body: not positive, a roof as steep as the slope, an arc that is more than half a
/// circle, cheeks or a ridge under kLeastPart.
std::optional<DormerBody> dormer_body(const DormerBodyMeasures& measures, double rise);

/// The shape's outline in the coordinates of a plane, counter-clockwise, about the middle of its front.
std::vector<model::Point2> outline_in_plane(const DormerBody& shape, const RoofSlope& plane);

/// The convex outline around points, counter-clockwise.
std::vector<model::Point2> hull(std::vector<model::Point2> points);

inline constexpr double kLeastFall = 5;  ///< degrees that a slope must be steeper than a roof that runs back into it
inline constexpr double kSteepestDormerRoof = 75;  ///< degrees, of gabled and hipped heads: steeper ones are spires
inline constexpr int kMostChords = 64;             ///< finer arcs have faces that the grid folds

}  // namespace blockrand::roofs
