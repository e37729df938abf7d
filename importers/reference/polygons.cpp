#include "importers/reference/polygons.h"

#include <cstdint>
#include <utility>

namespace blockrand::importers::reference {

void drop_polygons(ReferenceModel& model, const std::vector<bool>& marked) {
  std::vector<std::uint32_t> number(marked.size(), 0);
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < marked.size(); ++i) {
    number[i] = kept;
    if (marked[i]) continue;
    if (kept != i) model.polygons[kept] = std::move(model.polygons[i]);
    ++kept;
  }
  model.polygons.resize(kept);
  const auto keep = [&](std::vector<Geometry>& geometries) {
    for (Geometry& g : geometries) {
      std::vector<Face> faces;
      std::size_t outer = 0;
      for (std::size_t i = 0; i < g.faces.size(); ++i) {
        if (marked[g.faces[i].polygon]) continue;
        if (i < g.outer_faces) ++outer;
        faces.push_back({number[g.faces[i].polygon], g.faces[i].reversed});
      }
      g.faces = std::move(faces);
      g.outer_faces = outer;
    }
    std::erase_if(geometries, [](const Geometry& g) { return g.faces.empty(); });
  };
  for (Building& b : model.buildings) {
    keep(b.geometries);
    for (Surface& s : b.surfaces) {
      keep(s.geometries);
      for (Opening& o : s.openings) keep(o.geometries);
    }
  }
}

}  // namespace blockrand::importers::reference
