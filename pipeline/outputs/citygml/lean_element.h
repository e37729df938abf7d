// Elements for a leaner CityGML: without the small pieces of ornaments.
#pragma once

#include <vector>

#include "pipeline/outputs/element_polygons.h"

namespace blockrand::outputs {

/// m. Pieces that are shorter in every direction are small: modillions and dentils of cornices, knobs of railings. Half a
/// metre is what CityGML 2.0 asks of points of LoD3 (OGC 12-019, table 3).
inline constexpr double kSmallPiece = 0.5;
/// m. A row of pieces that are all shorter is one ornament: the stones of a quoin.
inline constexpr double kRowPiece = 1;

/// Leaves the small pieces of an element out. Of a row of pieces none of which reaches half as far as the whole, the box
/// around all is left, in the look of its largest polygon. A piece is what hangs together over corners. An element of one
/// piece stays as it is.
std::vector<ElementPolygon> without_small_pieces(std::vector<ElementPolygon> polygons);

}  // namespace blockrand::outputs
