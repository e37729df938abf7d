#include "pipeline/geometry/solid_builder.h"

#include <utility>

namespace blockrand::geometry {

std::uint32_t SolidBuilder::vertex(model::Point3 p) {
  const Grid3 g = to_grid(p);
  const auto [place, inserted] = vertex_at_.try_emplace(g, static_cast<std::uint32_t>(solid_.vertices.size()));
  if (inserted) {
    const double step = 1.0 / model::kGridStepsPerMetre;
    solid_.vertices.push_back(
        {static_cast<double>(g.x) * step, static_cast<double>(g.y) * step, static_cast<double>(g.z) * step});
  }
  return place->second;
}

void SolidBuilder::add_face(std::span<const std::vector<model::Point3>> loops, model::Face looks) {
  looks.first_loop = static_cast<std::uint32_t>(solid_.loops.size());
  looks.loop_count = 0;
  for (const auto& points : loops) {
    model::Solid::Loop loop{static_cast<std::uint32_t>(solid_.indices.size()), 0};
    for (const model::Point3 p : points) {
      const std::uint32_t v = vertex(p);
      if (loop.count > 0 && solid_.indices.back() == v) continue;
      solid_.indices.push_back(v);
      ++loop.count;
    }
    while (loop.count > 1 && solid_.indices.back() == solid_.indices[loop.first]) {
      solid_.indices.pop_back();
      --loop.count;
    }
    if (loop.count < 3) {
      solid_.indices.resize(loop.first);
      if (looks.loop_count == 0) return;  // the face itself has vanished, its holes with it
      continue;
    }
    solid_.loops.push_back(loop);
    ++looks.loop_count;
  }
  if (looks.loop_count > 0) solid_.faces.push_back(looks);
}

model::Solid SolidBuilder::take() {
  vertex_at_.clear();
  return std::exchange(solid_, {});
}

}  // namespace blockrand::geometry
