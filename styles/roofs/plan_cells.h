// Bodies on roofs, made of cells of the plan that each have a plane below and a plane above.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/model/point.h"
#include "pipeline/model/roof_element.h"
#include "pipeline/model/solid.h"

namespace blockrand::roofs {

/// A piece of plan under which and over which a body has one plane each; its sides are upright. Neighbours have their
/// common corners at the same places.
struct PlanCell {
  struct Corner {
    model::Point2 place;            ///< m, on the grid
    double under = 0, top = 0;      ///< m, z of the body's underside and upper side here; equal ones make an edge
    bool against_building = false;  ///< the side that begins here touches the building: a closure, not a wall
  };
  std::vector<std::vector<Corner>> loops;  ///< outer one counter-clockwise from above, holes clockwise
};

/// Bodies that were built, and what became of the others.
struct BuiltElements {
  std::vector<model::RoofInstallation> bodies;
  int asked = 0;      ///< edges, lines or gables that were to have one
  int shortened = 0;  ///< of them those that got less than asked: narrower, cut back
  int refused = 0;    ///< of them those that got none
};

/// Kinds of a body's faces.
struct BodySurfaceKinds {
  model::SurfaceKind top = model::SurfaceKind::roof;
  model::SurfaceKind side = model::SurfaceKind::wall;
  model::SurfaceKind under = model::SurfaceKind::closure;
};

/// Heights nearer than this at one place are one height: m. Planes of a roof meet to the rounding of their points, 1
/// mm, or 3 mm where they are steep.
inline constexpr double kSameHeight = 3.5 / model::kGridStepsPerMetre;

/// The cells as closed bodies: cells with a common side, of which each covers some of the other's, are one body, and
/// faces in one plane are one face. Every body passes geometry::check_solid: where a joined one does not, its cells are
/// tried one by one.
struct CellBodies {
  std::vector<model::Solid> solids;
  std::vector<std::uint32_t> lost;  ///< cells of which no valid body could be made, ascending
};
CellBodies bodies_of_cells(std::span<const PlanCell> cells, const BodySurfaceKinds& looks);

}  // namespace blockrand::roofs
