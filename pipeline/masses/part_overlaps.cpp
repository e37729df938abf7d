#include "pipeline/masses/part_overlaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "pipeline/geometry/solid_overlap.h"

namespace blockrand::masses {

namespace {

using model::BuildingPart;

constexpr double kCubicCentimetres = 0.01;  // m³; less is told in cm³

double overlap(const model::Solid& a, const model::SolidTriangles& ta, const model::Solid& b,
               const model::SolidTriangles& tb) {
  if (!a.closed || !b.closed) return 0;  // surfaces have no inside
  const double volume = geometry::common_volume({a.vertices, ta.triangles}, {b.vertices, tb.triangles});
  return volume > geometry::kLeastCommonVolume ? volume : 0;
}

struct Box {
  model::Point3 min, max;
};
/// Of the solids, not of the plan: roofs may reach beyond it.
Box box_of(const BuildingPart& part) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Box box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (const model::Solid* solid : {&part.lod1, &part.lod2})
    for (const model::Point3& p : solid->vertices) {
      box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
      box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
    }
  return box;
}
bool meet(const Box& a, const Box& b) {
  return a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y && a.min.z < b.max.z &&
         b.min.z < a.max.z;
}

}  // namespace

void tell_part_overlaps(model::Region& region) {
  std::vector<Box> boxes;
  for (const model::Building& building : region.buildings) {
    if (!building.owned || building.parts.size() < 2) continue;
    boxes.clear();
    for (const BuildingPart& part : building.parts) boxes.push_back(box_of(part));
    for (std::size_t i = 0; i < building.parts.size(); ++i)
      for (std::size_t j = i + 1; j < building.parts.size(); ++j) {
        if (!meet(boxes[i], boxes[j])) continue;
        const BuildingPart &a = building.parts[i], &b = building.parts[j];
        const double volume = std::max({overlap(a.lod1, a.lod1_triangles, b.lod1, b.lod1_triangles),
                                        overlap(a.lod2, a.lod2_triangles, b.lod2, b.lod2_triangles),
                                        overlap(a.lod3.solid, a.lod3.triangles, b.lod3.solid, b.lod3.triangles)});
        if (volume > 0)
          region.report.add(a.osm, model::IssueCode::overlap_kept,
                            volume >= kCubicCentimetres
                                ? fmt::format("{}: {:.2f} m3 in common with {}", a.id, volume, b.id)
                                : fmt::format("{}: {:.2g} cm3 in common with {}", a.id, volume * 1e6, b.id));
      }
  }
}

}  // namespace blockrand::masses
