// A house of one body with a roof, as the masses hand it on at LoD3, for what stands on roofs.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/attributes/defaults.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/masses/built_mass.h"
#include "pipeline/masses/envelope.h"
#include "pipeline/model/region.h"
#include "styles/elements/element_catalogue.h"
#include "styles/roofs/roof.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::facades::test {

using model::RoofEdge;
using model::RoofShape;
using testing_shapes::polygon;

inline const attributes::Defaults& defaults() {
  static const attributes::Defaults d = attributes::read_defaults(std::string(BLOCKRAND_SOURCE_DIR) + "/configs");
  return d;
}

/// Those of the shipped configs.
inline const elements::ElementCatalogue& elements_of_configs() {
  static const elements::ElementCatalogue catalogue =
      elements::read_element_catalogue(std::vector<std::string>{std::string(BLOCKRAND_SOURCE_DIR) + "/configs"});
  return catalogue;
}

struct House {
  model::Polygon plan = polygon({{0, 0}, {18, 0}, {18, 12}, {0, 12}});
  std::vector<RoofEdge> edges{RoofEdge::street, RoofEdge::party_wall, RoofEdge::courtyard, RoofEdge::party_wall};
  RoofShape shape = RoofShape::gabled;
  double eaves = 18, height = 5;
  std::string use = "apartments", style = "gruenderzeit", era = "1840_1918";
  double roof_storeys = 0;
};

inline roofs::Roof roof_of(const House& h) {
  roofs::RoofRequest request;
  request.shape = h.shape;
  request.measures = {h.eaves, h.height};
  request.edges = h.edges;
  if (h.shape == RoofShape::flat) return roofs::flat_roof(h.plan, h.eaves);
  return roofs::build_roof(h.plan, request)->roof;
}

/// Buildings that stand, and what the masses hand on of them.
struct Tile {
  model::Region region;
  std::vector<masses::BuiltMasses::Entry> built;
};

inline Tile tile_of(const House& h, std::int64_t id = 1) {
  Tile tile;
  model::Building b;
  b.osm = {model::OsmType::way, id};
  b.situation.width = 18;
  b.attributes.use.value = h.use;
  b.attributes.style.value = h.style;
  b.attributes.era.value = h.era;
  model::BuildingPart part;
  part.id = b.id();
  part.osm = b.osm;
  part.attributes = b.attributes;
  part.attributes.roof_storeys.value = h.roof_storeys;
  part.plan = part.roof_plan = h.plan;
  part.roof_edges = h.edges;
  part.built_roof = h.shape;
  masses::EnvelopeMaterials looks;
  looks.wall.kind = model::SurfaceKind::wall;
  looks.roof.kind = model::SurfaceKind::roof;
  looks.under.kind = model::SurfaceKind::ground;
  const roofs::Roof roof = roof_of(h);
  part.lod2 = masses::envelope(h.plan, 0, roof, looks);
  tile.built.push_back({{0, 0}, masses::built_mass(h.plan, 0, roof)});
  part.lod2_triangles = *geometry::triangulate(part.lod2);
  part.lod3.solid = part.lod2;
  part.lod3.triangles = part.lod2_triangles;
  part.lod = 3;
  b.parts.push_back(std::move(part));
  tile.region.buildings.push_back(std::move(b));
  return tile;
}

}  // namespace blockrand::facades::test
