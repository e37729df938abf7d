#include "pipeline/generate/part_overlaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "pipeline/geometry/solid_overlap.h"

namespace blockrand::generate {

namespace {

using model::BuildingPart;

double overlap(const model::Solid& a, const model::SolidTriangles& ta, const model::Solid& b,
               const model::SolidTriangles& tb) {
  const geometry::SolidOverlap found =
      geometry::overlap_of({a.vertices, ta.triangles}, {b.vertices, tb.triangles});
  return found.overlap ? found.volume : 0;
}

}  // namespace

void tell_part_overlaps(model::Region& region) {
  for (const model::Building& building : region.buildings) {
    if (!building.owned) continue;
    for (std::size_t i = 0; i < building.parts.size(); ++i)
      for (std::size_t j = i + 1; j < building.parts.size(); ++j) {
        const BuildingPart &a = building.parts[i], &b = building.parts[j];
        const double volume = std::max(overlap(a.lod1, a.lod1_triangles, b.lod1, b.lod1_triangles),
                                       overlap(a.lod2, a.lod2_triangles, b.lod2, b.lod2_triangles));
        if (volume > 0)
          region.report.add(a.osm, model::IssueCode::overlap_kept,
                            fmt::format("{}: {:.2f} m3 in common with {}", a.id, volume, b.id));
      }
  }
}

}  // namespace blockrand::generate
