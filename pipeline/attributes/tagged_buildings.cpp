#include "pipeline/attributes/tagged_buildings.h"

#include <cmath>

#include "pipeline/attributes/resolve.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::attributes {

std::vector<context::TaggedBuilding> tagged_buildings(const model::Extract& extract, const Defaults& defaults,
                                                      const georef::Projection& projection) {
  std::vector<context::TaggedBuilding> out;
  for (const model::MappedBuilding& b : extract.buildings) {
    if (b.kind != model::ObjectKind::building || b.state != model::ObjectState::pending || b.rings.count == 0) continue;
    if (!b.attributes.storeys && !b.attributes.roof_shape) continue;
    std::vector<model::Point2> ring;
    for (const model::Location v : extract.vertices_of(extract.rings[b.rings.first]))
      ring.push_back(model::snap(projection.forward(v)));
    context::TaggedBuilding t;
    t.id = b.id;
    t.place = ring.front();
    t.group = neighbour_group(defaults, extract.strings.view(b.attributes.use), std::fabs(geometry::signed_area(ring)));
    t.storeys = b.attributes.storeys;
    t.roof_shape = b.attributes.roof_shape;
    out.push_back(t);
  }
  return out;
}

}  // namespace blockrand::attributes
