// An order of polygons that does not depend on the file: formats may group the faces of an element as they like.
#pragma once

#include <algorithm>
#include <vector>

#include "pipeline/validate/contents.h"

namespace blockrand::validate {

/// Sorts by colour, then by the points of the rings; where a ring starts counts.
inline void sort_polygons(std::vector<ReadPolygon>& polygons) {
  const auto point_less = [](const model::Point3& a, const model::Point3& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
  };
  const auto ring_less = [&](const std::vector<model::Point3>& a, const std::vector<model::Point3>& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), point_less);
  };
  std::sort(polygons.begin(), polygons.end(), [&](const ReadPolygon& a, const ReadPolygon& b) {
    if (a.colour != b.colour) return a.colour < b.colour;
    return std::lexicographical_compare(a.rings.begin(), a.rings.end(), b.rings.begin(), b.rings.end(), ring_less);
  });
}

}  // namespace blockrand::validate
