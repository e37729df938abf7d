// Whether faces read back from a file close up again.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::outputs::test {

/// Every directed edge of the loops occurs once, and once the other way round.
inline bool closed(const std::vector<std::vector<model::Point3>>& loops) {
  std::map<std::pair<model::Point3, model::Point3>, int> edges;
  for (const auto& loop : loops)
    for (std::size_t i = 0; i < loop.size(); ++i) ++edges[{loop[i], loop[(i + 1) % loop.size()]}];
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (count != 1 || back == edges.end() || back->second != 1) return false;
  }
  return !edges.empty();
}

/// Six times the enclosed volume of triangles.
inline double six_volumes(const std::vector<std::vector<model::Point3>>& triangles) {
  double sum = 0;
  for (const auto& t : triangles)
    sum += t[0].x * (t[1].y * t[2].z - t[1].z * t[2].y) + t[0].y * (t[1].z * t[2].x - t[1].x * t[2].z) +
           t[0].z * (t[1].x * t[2].y - t[1].y * t[2].x);
  return sum;
}

}  // namespace blockrand::outputs::test
