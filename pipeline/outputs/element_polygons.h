// The faces of an element as the text formats have them: CityGML and CityJSON write the same polygons.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/model/element.h"

namespace blockrand::outputs {

/// In tenths of a millimetre, in the frame of CityGML's implicit geometries: x along the wall, y into it, z up.
using ElementPoint = std::array<std::int64_t, 3>;

/// A plane polygon with holes, without repeated last points; the outer ring first, counter-clockwise from outside.
struct ElementPolygon {
  model::PartMaterial look;
  std::vector<std::vector<ElementPoint>> rings;
};

/// The faces of an element, those joined that lie in one plane, look alike and share an edge: a cap of a moulding is
/// one polygon and not a fan of quadrangles, a frame around a pane one with a hole. Points are
/// rounded to 0.1 mm; those within 0.05 mm of the line between their neighbours are left out where no polygon has a
/// corner there, and so are faces of which rounding leaves fewer than three points.
std::vector<ElementPolygon> element_polygons(const model::ColouredElement& element);

}  // namespace blockrand::outputs
