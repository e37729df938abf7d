// Which rows may move to where an image shows them, so that nothing stands on a neighbour afterwards.
#pragma once

#include <functional>
#include <vector>

#include "pipeline/footprints/footprint_store.h"
#include "pipeline/footprints/move_buildings.h"
#include "pipeline/observation/imagery.h"

namespace blockrand::observation {

/// Of the smaller of two footprints: a correction is right to half a metre or so, and repair gives such an overlap to
/// one of the two, as it does with what is mapped. More is in the way.
inline constexpr double kOverlapShare = 0.05;

/// Refuses corrections of rows (RowState::refused): those with a building that a user keeps, and those that would lay
/// buildings over others (kOverlapShare) where they did not lie before. Of two rows that would meet, the less sure one stays; what stays
/// may be in the way of a third. Then walls are refused (RefinementState::refused) of rows that were, of houses that a user keeps, and
/// where the shifted ones would lie on a neighbour. Deterministic.
/// \param keeps  of a building: a user wants it where it is mapped
void refuse_corrections(ImageryObservations& observations, const footprints::FootprintStore& footprints,
                        const std::function<bool(std::uint32_t)>& keeps);

/// Where a building goes by its receipt: with its row, if that is corrected, and with its walls, if they are refined.
footprints::Movement movement_of(const OutlineReceipt& receipt);

/// What the corrected rows and refined houses are to be moved by, in the order of the buildings. What is the same house mapped twice goes
/// along with the one that stands for it.
std::vector<footprints::MovedBuilding> movements(const ImageryObservations& observations,
                                                 const footprints::FootprintStore& footprints);

}  // namespace blockrand::observation
