// What each edge of a plan is to its roof: eaves, gable, party wall, the foot of a lean-to. Rows and perimeter blocks
// are made here: ridges run from party wall to party wall, a corner house turns them, side wings lean on the neighbour.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "styles/roofs/wing_ends.h"

namespace blockrand::roofs {

enum class RoofSide : std::uint8_t {
  eaves,
  lean,   ///< eaves of a slope that rises to a party wall across the wing, without a ridge
  gable,  ///< a free end of a wing
  party,  ///< upright: a neighbour's wall, and short returns between such walls
};

struct RoofSides {
  std::vector<RoofSide> sides;  ///< one per plan edge
  /// A corner house whose plan is full: the corner between two party walls where its yard would be. The roof falls to
  /// it (geometry::CornerEaves).
  std::optional<std::uint32_t> corner;
  bool leans = false;  ///< all eaves are of slopes that rise to a party wall: a lean-to

  std::vector<std::uint32_t> which(RoofSide side) const;
  bool has(RoofSide side) const;
};

/// The sides of a roof whose ridges run between gables (`wants_gables`), or that falls to all free sides.
///
/// Without party walls: wing_ends(). With them, by these rules, in this order:
/// * Edges that bend by less than 20 degrees are one wall: a party wall when enough of it is (party_share_of()).
/// Returns of less than 2 m
///   between two party walls belong to them.
/// * Where roof:direction or roof:orientation say how the ridge runs, party walls along it stay eaves.
/// * The ridge of a plan of one wing runs along its street; at a street corner, and without a street, from the party
///   walls as ridge_between() says. An end without a neighbour is a gable, but never one that faces a street: there the
///   roof turns (a mapped shape keeps its gable). Other plans have gables at the ends of their wings that face no
///   street.
/// * Eaves from which the way in ends at a party wall, with hardly any eaves behind them that look the other way, are
/// the foot
///   of a lean-to; hips over the ends of wings are not. Where that is so of all fronts of a house on two streets, it is
///   a corner house without a yard of its own.
/// * Mapped hips stay hips.
/// * A mapped shape with a ridge keeps it: where all eaves would be the foot of a lean-to, party walls that do not look
///   along the plan's axis stay eaves.
RoofSides roof_sides(const model::Polygon& plan, const RoofRequest& request, bool wants_gables);

/// Which way the longest street front looks; none without one.
std::optional<model::Point2> street_outlook(const std::vector<PlanSide>& edges,
                                            const std::vector<model::RoofEdge>& kinds);

/// The share of a facade that makes it a party wall: half; three quarters where it looks away from the street, since
/// wings and rear buildings that are mapped for themselves stand against the rear eaves of their front house.
double party_share_of(const PlanSide& facade, std::optional<model::Point2> street);

/// Unit vector along which the ridge of a plan of one wing runs between its party walls where no street tells: across
/// the longer side when neighbours stand at both long sides (at 0.3 of each), or at more than half of one of a plan no
/// longer than 2 widths, and at none of its short sides; else along it. Of 252 gabled roofs of The Hague between two
/// such neighbours 251 run so (docs/internal/RESULTS.md, "Roofs against references"). None without party walls.
std::optional<model::Point2> ridge_between(const model::Polygon& plan, const std::vector<PlanSide>& edges,
                                           const std::vector<char>& party);

/// True where neighbours stand at all sides of a plan: no eaves can be had, water runs off inside.
bool is_enclosed(const model::Polygon& plan, const std::vector<model::RoofEdge>& edges);

/// The direction of the ridge of a plan of one wing in a row, as roof_sides() lays it; none where party walls say
/// nothing.
std::optional<model::Point2> row_axis(const model::Polygon& plan, const RoofRequest& request);

}  // namespace blockrand::roofs
