// Cross gables (Zwerchgiebel, Zwerchhaus): the front wall goes up through the eaves and carries a roof of its own,
// flush with the façade.
#pragma once

#include <span>
#include <vector>

#include "styles/roofs/dormer_bodies.h"
#include "styles/roofs/element_layout.h"

namespace blockrand::roofs {

/// Measures of a cross gable. Its front lies in the façade; nothing of wall, eaves or slope is left below its roof.
struct CrossGableParameters {
  /// The head; gabled is the Zwerchgiebel, others are Zwerchhäuser. Not eyebrow.
  DormerKind kind = DormerKind::gabled;
  double width = 2.60;  ///< m. At most 3.00 (docs/sources.md, Holtmeier 5.3); two axes of windows need some 2.5 (own
                        ///< choice).
  /// m from the eaves to the foot of the gable; 0: the gable's slopes start at the eaves (own choice).
  double wall_height = 1.00;
  double roof_pitch = 45;  ///< degrees, of gabled, hipped and shed heads; of shed ones below the slope's by kLeastFall
  double rise = 0.43;      ///< m, of segmental heads: a sixth of the width
  int chords = 8;          ///< of arcs: as DormerParameters
};

/// Its outline on a plane, about the middle of its front at the eaves, for lay_out() with `flush` and `up` 0; empty
/// when it makes no body on this plane, or breaks a rule on widths or pitches.
std::vector<model::Point2> cross_gable_outline(const RoofSlope& plane, const CrossGableParameters& parameters);

/// Builds a cross gable into a surface and the wall below it, in one operation: the wall top goes up the gable and down
/// again, the slope is cut back along the valleys, cheeks and roof stand between; all of one new entry of roof.elements
/// (the front stays part of the plan edge's wall). The roof stays one closed surface.
/// \param place  middle of the front, in the coordinates of roof_slope(); y tells which eaves, 0 for most
/// \return false, and the roof as it was, when no eaves run there (a party wall's are none) or this one does not fit
/// there
bool add_cross_gable(Roof& roof, std::size_t surface, const CrossGableParameters& parameters, model::Point2 place,
                     std::span<const model::RoofEdge> edges = {}, const ElementDistances& distances = {});

}  // namespace blockrand::roofs
