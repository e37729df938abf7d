// Does a building that is mapped stand where an image was taken?
#pragma once

#include "pipeline/observation/imagery.h"

namespace blockrand::observation {

/// From this probability on a building is told to be gone, perhaps. It is never deleted.
inline constexpr double kPerhapsGone = 0.85;

/// How likely it is that no building stands there: leaves or grass instead of a roof, walls that lie on no edge wherever
/// within the search they are put, no shadow. Walls are those of the row: one house of a row that is gone is not noticed.
/// Of buildings whose roof or walls the image does not show, and under white, which may be a cloud: 0.
/// \param shadow_clearness  ShadowLength; 0 or less: none was found
double gone_probability(const OutlineReceipt& receipt, const RoofView& roof, double shadow_clearness);

}  // namespace blockrand::observation
