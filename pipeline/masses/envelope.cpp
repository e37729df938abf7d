#include "pipeline/masses/envelope.h"

#include <vector>

#include "pipeline/geometry/solid_builder.h"

namespace blockrand::masses {

using model::Face;
using model::Point2;
using model::Point3;
using model::Polygon;
using model::Ring;
using model::Solid;

Solid envelope(const Polygon& plan, double bottom, const roofs::Roof& roof, const EnvelopeMaterials& materials) {
  geometry::SolidBuilder builder;
  std::vector<std::vector<Point3>> underside;
  const auto loop_below = [&](const Ring& ring) {
    std::vector<Point3> loop;
    for (auto p = ring.points.rbegin(); p != ring.points.rend(); ++p) loop.push_back({p->x, p->y, bottom});
    underside.push_back(std::move(loop));
  };
  loop_below(plan.outer);
  for (const Ring& hole : plan.holes) loop_below(hole);
  builder.add_face(underside, materials.under);

  std::int32_t edge = 0;
  const auto walls = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i, ++edge) {
      const Point2 a = ring.points[i], b = ring.points[(i + 1) % ring.size()];
      std::vector<Point3> loop{{a.x, a.y, bottom}, {b.x, b.y, bottom}};
      const auto& top = roof.wall_tops[static_cast<std::size_t>(edge)];
      loop.insert(loop.end(), top.begin(), top.end());
      Face face = materials.wall;
      face.edge = edge;
      builder.add_face(loop, face);
    }
  };
  walls(plan.outer);
  for (const Ring& hole : plan.holes) walls(hole);

  for (const auto& surface : roof.surfaces) {
    Face face = surface.upright ? materials.wall : materials.roof;
    face.edge = surface.upright ? -1 : surface.edge;
    builder.add_face(surface.loops, face);
  }
  return builder.take();
}

}  // namespace blockrand::masses
