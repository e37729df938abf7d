// Elements that a GLB places: whether they fill the holes of walls, and whether another format has them there as well.
#pragma once

#include <string>
#include <vector>

#include "pipeline/validate/format_agreement.h"
#include "pipeline/validate/glb.h"

namespace blockrand::validate {

/// m in the tile's frame, z up: the corners of the boxes of all placed elements. What holds them holds the elements.
std::vector<model::Point3> place_corners(const Glb& glb);

/// GLB_RULE where the mesh of a LoD3 body is open at an edge that no element of the body stands around: a hole one can
/// look through. Not for elements that are baked into the mesh of their bodies, which leave the ends of reveals open.
void check_openings(const Glb& glb, const std::string& file, std::vector<Finding>& findings);

/// Of a GLB whose elements are in pieces: GEOMETRY_DIFFERS where pieces do not fill the box of each element of
/// `reference`, or one lies in none of them; COLOUR_DIFFERS where their colours are not those of the elements and walls.
/// \param tolerance  m, that a corner may be off
void compare_pieces(const Side& reference, const Glb& glb, const std::string& glb_file, const ToLocal& to_local,
                    double tolerance, std::vector<Finding>& findings);

/// GEOMETRY_DIFFERS where a body has other places of elements than in `reference`, or one that is turned otherwise;
/// COLOUR_DIFFERS where an element has a colour that neither it nor a wall of its body has there.
/// \param tolerance  m, that an origin may be off
void compare_places(const Side& reference, const Glb& glb, const std::string& glb_file, const ToLocal& to_local,
                    double tolerance, std::vector<Finding>& findings);

}  // namespace blockrand::validate
