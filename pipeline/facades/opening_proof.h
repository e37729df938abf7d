// Shows that cutting openings left a solid valid, without looking at all of it in three dimensions again.
#pragma once

#include "pipeline/facades/openings.h"
#include "pipeline/model/solid.h"

namespace blockrand::facades {

/// True when a solid that cut_openings() made of a valid one is valid in the sense of geometry::check_solid; false when
/// that cannot be shown this way: then the solid may still be valid, and check_solid() tells.
///
/// What cut_openings() sees to for every opening:
/// - Its outline is simple by kLeastFeature, and kOpeningClearance from the border of its wall and from other openings.
///   Rounding to the grid moves a point by at most 0.0009 m, so all of this holds of the rounded outlines, in every
///   view along a direction not far from the wall's normal.
/// - Its reveal is a prism: the outline moved by one vector `in` of the grid. A block around the prism, larger by a
///   centimetre to all sides and by kLeastBehind at its end, meets no face of the closed solid but the wall, and no
///   other block.
/// - Faces share corners by index, and edges in opposite directions: reveals close what the hole opens.
///
/// From that follows: vertices are distinct; edges, fans and connectedness are those of a closed shell; prisms lie
/// inside the closed solid, so that the rest has a volume; reveals and the polygons at their end meet no face but their
/// wall, and one another only in common edges, since side faces are parallelograms over a simple ring.
///
/// What is left are walls with holes, since their corners lie off one plane by the rounding and they have new
/// triangles. Tested of each of them here, in integers unless said otherwise:
/// 1. Its corners lie within 4/1024 m across its plane, and that leans by less than kMostLean; its triangles look
///    apart by no more than geometry::kBuilt allows (doubles). So it is plane and not folded, and simple along its normal, as its border has been before.
/// 2. Seen along each `in` of its openings all its triangles are counter-clockwise, and so are those of the polygons at
///    their ends. A drawing of a polygon with holes by triangles of one orientation covers each point as often as the
///    rings go round it: no triangle covers a point of the hole, and so none meets a reveal, which lies over the hole's
///    border, but in the edges they share. Of flush openings the view is along the axis next to the normal.
/// 3. Its triangles conflict with no triangle of another wall with holes, or of the faces that stayed as they were, by
///    check_solid's own test (geometry::triangles_conflict). Faces that lie on one side of the wall's corners are out of
///    the question at once; this leaves its neighbours' borders.
/// Pairs of faces that stayed as they were have been checked with the closed solid.
///
/// Faces that got points on their border (OpenedSolid::changed_borders): both faces of an edge got the same, so that
/// the shell stays what it was. Points lie on their edge but for rounding, a centimetre from its ends; blocks keep ten
/// times that off, so that reveals meet these faces as little as before. Tested are:
/// 4. No such point lies where another vertex is.
/// 5. Each such face by check_solid's rules of polygons (geometry::sound_polygon), and as in 3.
///
/// Passages, whose sides are no prisms, are left to check_solid: it must have found the solid with the same passages and no other opening
/// valid, and no border of that may have points (OpenedSolid::changed_borders), so that its tunnels and the faces that neither it nor
/// this solid changed are known not to meet. The walls of portals are walls with holes; tunnels are among the faces that stayed, which
/// walls with holes and changed borders are held against (3 and 5). Reveals keep off tunnels since blocks do not meet.
///
/// \param triangles  of opened.solid, by geometry::triangulate; of faces that are not opened those that were checked
/// \param passages_checked  what is said of passages above holds; else solids with passages are not proved
bool proved_valid(const OpenedSolid& opened, const model::SolidTriangles& triangles, bool passages_checked = false);

inline constexpr double kMostLean = 0.1;  ///< tangent; keeps what rounding shifts in a view along the normal small

}  // namespace blockrand::facades
