// What the masses hand on: the plan and roof that the built solid has, whichever step of the ladder was taken.
#include "pipeline/masses/built_mass.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/attributes/defaults.h"
#include "pipeline/masses/envelope.h"
#include "pipeline/masses/mass.h"
#include "tests/unit/geometry/random_plans.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::masses {
namespace {

using model::Point3;
using model::Polygon;
using model::RoofEdge;
using model::RoofShape;
using model::SurfaceKind;
using testing_shapes::polygon;

const attributes::Defaults& defaults() {
  static const attributes::Defaults d = attributes::read_defaults(std::string(BLOCKRAND_SOURCE_DIR) + "/configs");
  return d;
}

model::BuildingPart body(const Polygon& plan, RoofShape shape, const std::string& id) {
  model::BuildingPart part;
  part.id = id;
  part.osm = {model::OsmType::way, 1};
  part.plan = plan;
  part.attributes.ground_height.value = 34;
  part.attributes.height.value = 12;
  part.attributes.roof_shape = {shape, model::Source::tag, 1};
  part.attributes.roof_height.value = shape == RoofShape::flat ? 0 : 4.3;
  return part;
}

/// A tile with one building of these bodies.
model::Region region_of(std::vector<model::BuildingPart> parts) {
  static const model::Extract no_tags;
  model::Region region;
  region.extract = &no_tags;
  for (const attributes::Material& m : defaults().materials) region.materials.push_back(m.material_class);
  model::Building building;
  building.osm = {model::OsmType::way, 1};
  for (const model::BuildingPart& part : parts) building.outline.push_back(part.plan);
  building.parts = std::move(parts);
  region.buildings.push_back(std::move(building));
  return region;
}

std::vector<std::vector<Point3>> loops_of(const model::Solid& solid, const model::Face& face) {
  std::vector<std::vector<Point3>> out;
  for (const model::Solid::Loop& loop : solid.loops_of(face)) {
    out.emplace_back();
    for (const std::uint32_t v : solid.indices_of(loop)) out.back().push_back(solid.vertices[v]);
  }
  return out;
}

/// The first thing in which the mass is not what the solid shows; empty where the two agree.
std::string difference(const BuiltMass& mass, const model::Solid& solid) {
  // The last faces are the roof's surfaces, in their order.
  const auto& surfaces = mass.roof.surfaces;
  if (surfaces.empty() || surfaces.size() >= solid.faces.size()) return "number of surfaces";
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const model::Face& face = solid.faces[solid.faces.size() - surfaces.size() + s];
    if (face.kind != (surfaces[s].upright ? SurfaceKind::wall : SurfaceKind::roof) ||
        face.edge != (surfaces[s].upright ? -1 : surfaces[s].edge))
      return "kind or edge of surface " + std::to_string(s);
    if (loops_of(solid, face) != surfaces[s].loops) return "surface " + std::to_string(s);
  }
  // And with the plan they close it: the same faces, point by point.
  EnvelopeMaterials looks;
  looks.wall.kind = SurfaceKind::wall;
  looks.roof.kind = SurfaceKind::roof;
  looks.under.kind = solid.faces[0].kind;
  const model::Solid again = envelope(mass.plan, mass.bottom, mass.roof, looks);
  if (again.faces.size() != solid.faces.size()) return "number of faces";
  for (std::size_t f = 0; f < solid.faces.size(); ++f)
    if (again.faces[f].kind != solid.faces[f].kind || again.faces[f].edge != solid.faces[f].edge ||
        loops_of(again, again.faces[f]) != loops_of(solid, solid.faces[f]))
      return "face " + std::to_string(f);
  return {};
}

Polygon courtyard_house() {
  Polygon plan = polygon({{0, 0}, {30, 0}, {30, 24}, {0, 24}});
  plan.holes = {testing_shapes::ring({{10, 8}, {10, 16}, {20, 16}, {20, 8}})};
  return plan;
}

TEST(BuiltMass, IsWhatTheSolidShowsForEveryShape) {
  const std::vector<Polygon> plans{
      polygon({{0, 0}, {18, 0}, {18, 12}, {0, 12}}),
      polygon({{0, 0}, {24, 0}, {24, 10}, {10, 10}, {10, 22}, {0, 22}}),                      // an L
      polygon({{0, 0}, {8, 0}, {8, -1.2}, {12, -1.2}, {12, 0}, {20, 0}, {20, 12}, {0, 12}}),  // a bay
      testing_shapes::turned(polygon({{0, 0}, {18, 0}, {18, 12}, {0, 12}})), courtyard_house()};
  for (std::size_t shape = 0; shape < model::kRoofShapeCount; ++shape)
    for (const bool row : {false, true}) {
      const auto asked = static_cast<RoofShape>(shape);
      for (std::size_t p = 0; p < plans.size(); ++p) {
        const Polygon& plan = plans[p];
        std::vector<model::BuildingPart> parts{body(plan, asked, "w1")};
        parts.back().roof_plan = plan;
        std::size_t edges = plan.outer.size();
        for (const model::Ring& hole : plan.holes) edges += hole.size();
        parts.back().roof_edges.assign(edges, RoofEdge::courtyard);
        if (row) parts.back().roof_edges[1] = parts.back().roof_edges[plan.outer.size() - 1] = RoofEdge::party_wall;
        model::Region region = region_of(std::move(parts));
        const BuiltMasses built = build_masses(region, defaults(), {}, 2);
        const BuiltMass* mass = built.find({0, 0});
        ASSERT_EQ(region.buildings[0].parts[0].lod, 2);
        ASSERT_TRUE(mass);
        EXPECT_EQ(difference(*mass, region.buildings[0].parts[0].lod2), "") << model::name(asked) << " on plan " << p;
        EXPECT_EQ(mass->roof.wall_tops.size(), region.buildings[0].parts[0].roof_edges.size());
      }
    }
}

TEST(BuiltMass, IsThatOfTheStepThatWasTaken) {
  // Plans that break roofs: some come out with bays, hipped, flat or simplified.
  int simpler = 0;
  for (std::uint64_t number = 0; number < 60; ++number) {
    const auto shape = std::array{RoofShape::gabled, RoofShape::mansard, RoofShape::half_hipped}[number % 3];
    model::Region region = region_of({body(testing_shapes::random_plan(7, number), shape, "w1")});
    const BuiltMasses built = build_masses(region, defaults(), {}, 2);
    const model::BuildingPart& part = region.buildings[0].parts[0];
    const BuiltMass* mass = built.find({0, 0});
    ASSERT_EQ(mass != nullptr, !part.lod2.empty()) << number;
    if (!mass) continue;
    EXPECT_EQ(difference(*mass, part.lod2), "") << number;
    simpler += !part.fallbacks.empty();
  }
  EXPECT_GT(simpler, 0) << "no plan reached the ladder";
}

TEST(BuiltMass, PointsAreThoseOfTheGridAndWhatVanishesThereIsLeftOut) {
  const double half_step = 0.5 / model::kGridStepsPerMetre, less = 0.4 / model::kGridStepsPerMetre;
  const Polygon plan = polygon({{0, 0}, {10, 0}, {10, 8}, {0, 8}});
  roofs::Roof roof;
  roof.wall_tops = {{{10, 0, 5}, {5 + less, 0, 5}, {5, less, 5}, {0, 0, 5}},
                    {{10, 8, 5}, {10, 0, 5}},
                    {{0, 8, 5}, {10, 8, 5}},
                    {{0, -less, 5}, {0, 8, 5}}};
  const std::vector<Point3> outer{{0, 0, 5},  {5, 0, 5}, {5 + less, 0, 5}, {10, 0, 5},
                                  {10, 8, 5}, {0, 8, 5}, {-less, 0, 5}};
  const std::vector<Point3> needle{{5, 4, 5}, {5 + less, 4, 5}, {5, 4 - less, 5}};
  const std::vector<Point3> hole{{4, 4, 5}, {4, 6, 5}, {6, 6, 5}, {6, 4, 5}};
  roof.surfaces.push_back({2, {needle, hole}, false, -1});
  roof.surfaces.push_back({0, {outer, needle, hole}, false, -1});
  const BuiltMass mass = built_mass(plan, 1 + half_step / 2, roof);
  EXPECT_EQ(mass.bottom, 1);
  EXPECT_EQ(mass.plan.outer.points, plan.outer.points);
  EXPECT_EQ(mass.roof.wall_tops[0], (std::vector<Point3>{{10, 0, 5}, {5, 0, 5}, {0, 0, 5}}));
  EXPECT_EQ(mass.roof.wall_tops[3], (std::vector<Point3>{{0, 0, 5}, {0, 8, 5}}));
  EXPECT_FALSE(std::signbit(mass.roof.wall_tops[3][0].y)) << "vertices of solids have no negative zero";
  ASSERT_EQ(mass.roof.surfaces.size(), 1u) << "the first has no area, its hole goes with it";
  EXPECT_EQ(mass.roof.surfaces[0].edge, 0);
  EXPECT_EQ(mass.roof.surfaces[0].loops,
            (std::vector<std::vector<Point3>>{{{0, 0, 5}, {5, 0, 5}, {10, 0, 5}, {10, 8, 5}, {0, 8, 5}}, hole}));
}

TEST(BuiltMasses, AreFoundByBuildingAndPart) {
  const Polygon plan = polygon({{0, 0}, {18, 0}, {18, 12}, {0, 12}});
  model::Region region = region_of(
      {body(plan, RoofShape::flat, "w1.a"), body({}, RoofShape::flat, "w1.b"), body(plan, RoofShape::gabled, "w1.c")});
  region.buildings.push_back(region.buildings[0]);
  region.buildings.push_back(region.buildings[0]);
  region.buildings[1].owned = false;
  const BuiltMasses built = build_masses(region, defaults(), {}, 2);
  for (const std::uint32_t b : {0u, 2u}) {
    ASSERT_TRUE(built.find({b, 0}));
    EXPECT_EQ(built.find({b, 0})->roof.surfaces.size(), 1u);
    EXPECT_FALSE(built.find({b, 1})) << "it has no plan";
    ASSERT_TRUE(built.find({b, 2}));
    EXPECT_EQ(built.find({b, 2})->roof.surfaces.size(), 2u);
    EXPECT_FALSE(built.find({b, 3}));
  }
  EXPECT_FALSE(built.find({1, 0})) << "another tile's";
  EXPECT_FALSE(built.find({3, 0}));
  EXPECT_FALSE(BuiltMasses().find({0, 0}));

  const BuiltMasses blocks = build_masses(region, defaults(), {}, 1);
  EXPECT_FALSE(blocks.find({0, 0})) << "LoD1 has no roof";
}

}  // namespace
}  // namespace blockrand::masses
