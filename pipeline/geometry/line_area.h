// The ground beside a line: a street as wide as it is.
#pragma once

#include <span>
#include <vector>

#include "pipeline/model/polygon.h"

namespace blockrand::geometry {

enum class LineEnd : unsigned char { flat, round };

/// What lies within `left` metres on the left and `right` metres on the right of a line. Bends are rounded on their outer
/// side, ends as asked.
/// \param line  m, at least two points; closed where the last is the first
/// \param left, right  m, 0 or more, seen along the line; not both 0
/// \return polygons on the 1/1024 m grid that may overlap; none where the line has no length
std::vector<model::Polygon> line_area(std::span<const model::Point2> line, double left, double right, LineEnd start,
                                      LineEnd end);

}  // namespace blockrand::geometry
