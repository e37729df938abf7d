#include "tests/unit/run/surveyed_surfaces.h"

namespace blockrand::run::test {

using model::Point3;

void add_roof_of(const model::Solid& solid, RoofSurfaces& out) {
  for (const model::Face& face : solid.faces) {
    if (face.kind != model::SurfaceKind::roof && face.kind != model::SurfaceKind::outer_floor) continue;
    std::vector<std::vector<Point3>> rings;
    for (const auto& loop : solid.loops_of(face)) {
      auto& ring = rings.emplace_back();
      for (const std::uint32_t v : solid.indices_of(loop)) ring.push_back(solid.vertices[v]);
    }
    out.add(rings);
  }
}

RoofSurfaces surfaces_of(const roofs::Roof& roof) {
  RoofSurfaces out;
  for (const auto& surface : roof.surfaces)
    if (!surface.upright) out.add(surface.loops);
  return out;
}

}  // namespace blockrand::run::test
