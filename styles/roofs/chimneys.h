// Chimneys: stacks along party walls, on ridges, on level roofs and in slopes, in this order (chimney_places.cpp).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipeline/model/polygon.h"
#include "styles/roofs/roof.h"

namespace blockrand::roofs {

/// Measures of chimneys and the distances between them (docs/style_measures.md §2.7 unless another source stands
/// there).
struct ChimneyParameters {
  double width = 0.58;        ///< m, the shorter side; 0.5 to 0.65
  double length = 1.20;       ///< m, the longer side, along ridge or party wall; 0.8 to 1.6
  double above_ridge = 0.75;  ///< m from the ridge over the slopes it stands on to its top; 0.5 to 1.0
  double above_flat = 1.00;   ///< m above a flat roof
  double step = 6.0;          ///< m between chimneys on one wall or ridge: "every 5-7 m"
  double frontage = 6.0;      ///< m of frontage for each chimney of a house; at least one
  /// m from the highest point of the roof below it to its top (own choice): stacks more slender than 1 : 5 need stays.
  /// On steep roofs this keeps chimneys near the ridge.
  double tallest = 3.00;
  /// m from a party wall's line to the stack (own choice): plaster. Two neighbours' stacks stand back to back and share
  /// no plane.
  double inset = 0.05;
  /// m from the stack to dormers and cross gables (own choice): room for flashing.
  double clearance = 0.30;
  /// m that the underside lies over the surfaces it follows, square to them (own choice): solids of one building must not
  /// overlap, and rounding moves corners of both by up to 0.001. Nobody sees the gap.
  double gap = 0.003;
};

/// Where a chimney stands: the middle of its plan and the unit vector of its longer side.
struct ChimneyPlace {
  model::Point2 middle, along;
};

/// Looks of its faces: material and colour; kinds are set.
struct ChimneyMaterials {
  model::Face stack, top;
};

/// Chimneys of a house with that frontage in metres: frontage / parameters.frontage, rounded, at least 1; 1 where
/// either is not above 0.
int chimney_count(double frontage, const ChimneyParameters& parameters = {});

/// A stack over one surface, or over two that meet in one line across it (ridge, hip, valley, break): its underside
/// follows them. Sides are of kind wall, the top roof, the underside closure. Empty where three surfaces meet, where it
/// leaves the roof, stands over an element or nearer than `clearance` to one, where a surface line would cut off less
/// than kLeastPart of it, or where it would be higher than `tallest`.
std::optional<model::RoofInstallation> chimney(const Roof& roof, ChimneyPlace place,
                                               const ChimneyParameters& parameters = {},
                                               const ChimneyMaterials& materials = {});

/// The four corners of a stack on the plan, counter-clockwise: for occupy().
std::vector<model::Point2> chimney_outline(ChimneyPlace place, const ChimneyParameters& parameters = {});

/// Places on ridges: length / step of each, rounded, at least one, in the middles of equal fields; none on ridges
/// shorter than a stack. A ridge is a level line from which two surfaces fall.
std::vector<ChimneyPlace> ridge_places(const Roof& roof, const ChimneyParameters& parameters = {});

/// Places along party walls, `inset` inside. Where the roof above a wall has a highest point: there, and every step
/// from there; where it is level, length / step, rounded, at least one, in the middles of equal fields. All walls'
/// highest places come first.
/// \param edges  one per plan edge
std::vector<ChimneyPlace> party_wall_places(const model::Polygon& plan, std::span<const model::RoofEdge> edges,
                                            const Roof& roof, const ChimneyParameters& parameters = {});

/// Places on level surfaces, along the middle line of their smallest rectangle, then along four lines beside it, on
/// each stretch that lies over the surface: its length / step, rounded, at least one.
std::vector<ChimneyPlace> flat_places(const Roof& roof, const ChimneyParameters& parameters = {});

/// The chimneys of a house: chimney_count() of them at the first places that take one; party walls first, then ridges,
/// then flat roofs, then slopes (high up those that reach highest; not the lower ones of mansards). A place that takes
/// none is moved along its line by up to a third of a step; two stacks are no nearer than five sixths of a step. The caller
/// may refuse a stack for what stands around it (RoofInstaller::add); no other takes its place then.
std::vector<model::RoofInstallation> chimneys(const model::Polygon& plan, std::span<const model::RoofEdge> edges,
                                              const Roof& roof, double frontage,
                                              const ChimneyParameters& parameters = {},
                                              const ChimneyMaterials& materials = {});

}  // namespace blockrand::roofs
