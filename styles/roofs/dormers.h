// Dormers: little houses that stand on a slope and are part of the building's envelope. docs/roof_elements.md shows
// them.
#pragma once

#include <span>
#include <vector>

#include "styles/roofs/dormer_bodies.h"
#include "styles/roofs/element_layout.h"

namespace blockrand::roofs {

/// Measures of a dormer. The front is a wall in the plane of the dormer's lower edge; cheeks and roof are flush with
/// it.
struct DormerParameters {
  DormerKind kind = DormerKind::gabled;
  /// m, over the walls. Typical 1.0, 1.3, 1.8 (docs/style_measures.md §2.7); at most 3.00 (kWidestElement).
  double width = 1.30;
  /// m from the slope to where the front's roof begins. 1.2 to 1.5 (docs/style_measures.md §2.7). Of eyebrows, which
  /// have no cheeks, the height of their middle: 0.6 there.
  double wall_height = 1.30;
  /// degrees. Gabled and hipped: 45, the main roof's usual pitch or steeper (own choice). Shed: 12 (own choice; tiles
  /// on battens of old Schleppgauben lie flatter than on the roof). Eyebrow: 12. Others do not read it.
  double roof_pitch = 45;
  /// m from springing to crown of a segmental head. A sixth of the width is the flat arc of the 19th century (own
  /// choice).
  double rise = 0.22;
  /// Straight pieces of an arc. 8 keep within 1 cm of the curve of a usual segmental head (width / 6 rise).
  int chords = 8;
};

/// The usual dormer of a kind: defaults as beside the fields above.
DormerParameters usual_dormer(DormerKind kind);

/// Its convex outline on a plane, about the middle of its lower edge, for lay_out(); empty when it makes no body on
/// this plane, or breaks a rule on widths (kWidestElement) or pitches (kFlattestSlope, kSteepestSlope).
std::vector<model::Point2> dormer_outline(const RoofSlope& plane, const DormerParameters& parameters);

/// Builds a dormer into a surface of a roof: a hole in the surface, cheeks, roof and front over it, all of one new
/// entry of roof.elements. The roof stays one closed surface; wall tops do not change. lay_out() found the place: nothing is
/// asked again.
/// \param plane  as the surface was then; dormers that were laid out with this one may stand there meanwhile
/// \param place  middle of the front's lower edge, in the plane's coordinates
/// \return false, and the roof as it was, when the dormer makes no body on this plane
bool add_laid_out_dormer(Roof& roof, const RoofSlope& plane, const DormerParameters& parameters, model::Point2 place);

}  // namespace blockrand::roofs
