#include "pipeline/footprints/load.h"

#include <cmath>

#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::footprints {

namespace {

using model::Extract;
using model::MappedBuilding;
using model::MappedRings;
using model::Ring;

MappedRings project_rings(const Extract& extract, const MappedBuilding& object, const georef::Projection& projection,
                          bool& crosses_antimeridian) {
  MappedRings out;
  for (const auto& mapped : extract.rings_of(object.rings)) {
    const auto vertices = extract.vertices_of(mapped);
    const auto nodes = extract.nodes_of(mapped);
    Ring ring;
    ring.points.reserve(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (i > 0 && std::fabs(vertices[i].lon_degrees() - vertices[i - 1].lon_degrees()) > 180)
        crosses_antimeridian = true;
      ring.points.push_back(model::snap(projection.forward(vertices[i].lon_degrees(), vertices[i].lat_degrees())));
    }
    ring.nodes.assign(nodes.begin(), nodes.end());
    out.rings.push_back(std::move(ring));
    out.inner.push_back(mapped.inner);
  }
  return out;
}

}  // namespace

model::Region load_region(const Extract& extract, const Shard& shard, const georef::Projection& projection) {
  model::Region region;
  region.tile = shard.tile;
  region.extract = &extract;
  region.buildings.reserve(shard.seeds.size());
  for (const Seed& seed : shard.seeds) {
    const MappedBuilding& lead = extract.buildings[seed.lead()];
    bool crosses = false;
    model::Building building;
    building.osm = lead.id;
    building.mapped_index = seed.lead();
    building.tags = lead.tags;
    building.mapped = lead.attributes;
    building.has_mapped_parts = !seed.parts.empty();
    // A part that stands alone is its own building: its rings are its outline, and no second body is made of it.
    const bool without_outline = seed.outline == model::kNoIndex;
    const bool alone = without_outline && seed.parts.size() == 1;
    if (alone) building.has_mapped_parts = false;
    if (without_outline && !alone) {
      // What the first part says of itself holds for that part only.
      building.mapped = {};
      building.mapped.use = lead.attributes.use;
    } else {
      building.rings = project_rings(extract, lead, projection, crosses);
    }
    if (!alone) {
      for (const std::uint32_t p : seed.parts) {
        const MappedBuilding& mapped = extract.buildings[p];
        model::BuildingPart part;
        part.id = building.id() + "." + mapped.id.text();
        part.osm = mapped.id;
        part.mapped_index = p;
        part.tags = mapped.tags;
        part.mapped = mapped.attributes;
        part.rings = project_rings(extract, mapped, projection, crosses);
        part.canopy = extract.strings.view(mapped.attributes.use) == "roof";
        building.parts.push_back(std::move(part));
      }
    }
    if (crosses) region.report.add(lead.id, model::IssueCode::antimeridian);
    region.buildings.push_back(std::move(building));
  }
  return region;
}

std::vector<model::Point2> building_places(const model::Extract& extract, const georef::Projection& projection) {
  std::vector<model::Point2> places;
  for (const model::MappedBuilding& b : extract.buildings) {
    if (b.rings.count == 0 || b.state != model::ObjectState::pending) continue;
    const model::Point2 p = projection.forward(box_centre(extract, b));
    if (std::isfinite(p.x) && std::isfinite(p.y)) places.push_back(model::snap(p));
  }
  return places;
}

}  // namespace blockrand::footprints
