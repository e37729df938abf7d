#include "pipeline/facades/bodies_on_roofs.h"

#include <string>

#include "pipeline/geometry/solid_overlap.h"

namespace blockrand::facades {

bool is_old(const model::Attributes& attributes) {
  const std::string &style = attributes.style.value, &era = attributes.era.value;
  return style == model::name(model::StyleClass::gruenderzeit) || style == model::name(model::StyleClass::tenement) ||
         era == model::name(model::Era::pre1840) || era == model::name(model::Era::from1840);
}

bool meets_a_body(const model::Building& building, const model::RoofInstallation& made,
                  const model::BuildingPart* but_for) {
  const auto view = [](const model::Solid& solid, const model::SolidTriangles& triangles) {
    return geometry::ClosedMesh{solid.vertices, triangles.triangles};
  };
  const geometry::ClosedMesh mine = view(made.solid, made.triangles);
  for (const model::BuildingPart& part : building.parts) {
    if (&part == but_for) continue;
    const bool detailed = !part.lod3.solid.empty();
    if (geometry::interiors_meet(
            mine, detailed ? view(part.lod3.solid, part.lod3.triangles) : view(part.lod2, part.lod2_triangles)))
      return true;
    for (const model::RoofInstallation& other : part.lod3.roof_installations)
      if (geometry::interiors_meet(mine, view(other.solid, other.triangles))) return true;
  }
  return false;
}

}  // namespace blockrand::facades
