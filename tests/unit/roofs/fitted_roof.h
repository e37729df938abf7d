// Roofs with all kinds of elements put on them, and what a tape measure finds on the finished geometry.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "styles/roofs/chimneys.h"
#include "styles/roofs/cross_gables.h"
#include "styles/roofs/dormers.h"
#include "styles/roofs/roof_windows.h"
#include "tests/unit/roofs/roof_checks.h"

namespace blockrand::roof_checks {

/// What is put on a roof.
struct Fitting {
  bool cross_gables = true, dormers = true, roof_windows = true, chimneys = true;
  roofs::DormerParameters dormer;
  roofs::CrossGableParameters cross_gable;
  roofs::RoofWindowParameters roof_window;
  roofs::ChimneyParameters chimney;
  int most_dormers = 1000;  ///< on one slope
  int window_rows = 2;      ///< rows of roof windows, one over the other
  double frontage = 12;     ///< m, for chimneys
};

/// A roof with what fitted on it.
struct Fitted {
  roofs::Roof roof;
  std::vector<model::RoofInstallation> installations;
  std::map<model::RoofElementKind, int> built;   ///< by kind
  std::map<model::RoofElementKind, int> slopes;  ///< by kind, the slopes that took at least one
  int slopes_asked = 0;                          ///< planes of 15 to 80 degrees
  std::vector<std::string> faults;               ///< places of the layout that the element then refused
};

/// One cross gable in the middle of each eaves, then dormers, then roof windows, as many as fit on each slope; then
/// chimneys.
Fitted fit_out(const model::Polygon& plan, std::span<const model::RoofEdge> edges, const roofs::Roof& roof,
               const Fitting& with);

/// Party walls where a wall goes up to the roof (gables), open edges elsewhere: a house of a row.
std::vector<model::RoofEdge> gables_as_party_walls(const roofs::Roof& roof);

/// The first installation that the checker does not take; "none" when all are valid.
std::string installations_validity(const std::vector<model::RoofInstallation>& installations);

/// Holtmeier's distances and widths, measured on the finished surfaces and bodies alone, in space; each complaint one
/// line. Looks for: dormers and roof windows nearer than 1.00 m to the eaves; any element nearer than 1.00 m to a verge
/// or party wall of its slope, nearer than 1.50 m to another of its slope, nearer than 0.75 m to a hip or valley;
/// fronts wider than 3.00 m; outlines that leave their slope on the plan, points off its plane; chimneys that hang in
/// the air or stand in an element.
std::vector<std::string> broken_rules(const roofs::Roof& roof,
                                      const std::vector<model::RoofInstallation>& installations);

/// Heights, areas and counts of one element's surfaces.
struct ElementMeasures {
  int upright = 0, sloped = 0;
  double upright_area = 0, sloped_area = 0;  ///< m², true size
  double plan_area = 0;                      ///< m², of what lies over it on the plan
  double highest = -1e9;
};
ElementMeasures measures_of(const roofs::Roof& roof, std::int32_t element);

/// m³ of the solid from z = 30 to the roof.
double volume_under(const model::Polygon& plan, const roofs::Roof& roof);

}  // namespace blockrand::roof_checks
