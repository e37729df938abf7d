// Is it the map that is off, row by row, or the image as a whole?
#pragma once

#include <cstdint>
#include <string_view>

#include "pipeline/observation/imagery.h"

namespace blockrand::observation {

/// Gives a receipt another state. Walls were looked for where their row was thought to stand: they say nothing then.
void restate(OutlineReceipt& receipt, RowState state, std::string_view reason);

/// Where the map is wrong here and there, rows are off in all directions. Where an image shows most of its rows off alike, it may be
/// the image: nobody can tell from here. Then nothing is moved by it, and ImageReceipt::alike says how far.
void doubt_rows_off_alike(std::uint32_t image, ImageryObservations& observations);

}  // namespace blockrand::observation
