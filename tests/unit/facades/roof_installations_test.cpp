// Chimneys and roof windows on roofs that the masses hand on.
#include "pipeline/facades/roof_installations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/masses/built_mass.h"
#include "tests/unit/facades/house.h"

namespace blockrand::facades {
namespace {

using model::Point2;
using model::RoofEdge;
using model::RoofShape;
using test::defaults;
using test::House;
using test::Tile;
using test::tile_of;
using testing_shapes::polygon;

void furnish(Tile& tile) { add_roof_installations(tile.region, masses::BuiltMasses(tile.built), defaults(), {}); }

int count(const model::Region& region, model::RoofElementKind kind) {
  const auto& all = region.buildings[0].parts[0].lod3.roof_installations;
  return static_cast<int>(std::count_if(all.begin(), all.end(), [&](const auto& i) { return i.kind == kind; }));
}

model::Region fitted(const House& h, std::int64_t id = 1) {
  Tile tile = tile_of(h, id);
  furnish(tile);
  return std::move(tile.region);
}

TEST(RoofInstallations, StandOnTheRoofThatTheMassesHandOn) {
  House h;
  h.shape = RoofShape::flat;
  Tile tile = tile_of(h);
  const auto lowest_of_all = [](const Tile& of) {
    double z = 1e9;
    for (const auto& i : of.region.buildings[0].parts[0].lod3.roof_installations)
      for (const auto& v : i.solid.vertices) z = std::min(z, v.z);
    return z;
  };
  Tile raised = tile;
  raised.built[0].mass = masses::built_mass(h.plan, 0, roofs::flat_roof(h.plan, h.eaves + 1));
  furnish(tile);
  furnish(raised);
  EXPECT_NEAR(lowest_of_all(tile), h.eaves, 0.05);
  EXPECT_NEAR(lowest_of_all(raised), h.eaves + 1, 0.05);

  Tile without = tile_of(h);
  without.built.clear();
  furnish(without);
  EXPECT_TRUE(without.region.buildings[0].parts[0].lod3.roof_installations.empty());
}

TEST(RoofInstallations, AnOldHouseHasAStackForEverySixMetresOfFrontage) {
  for (const RoofShape shape : {RoofShape::gabled, RoofShape::mansard, RoofShape::flat}) {
    House h;
    h.shape = shape;
    const model::Region region = fitted(h);
    EXPECT_EQ(count(region, model::RoofElementKind::chimney), 3) << model::name(shape);
    double ridge = 0;
    for (const auto& v : region.buildings[0].parts[0].lod2.vertices) ridge = std::max(ridge, v.z);
    for (const auto& i : region.buildings[0].parts[0].lod3.roof_installations) {
      if (i.kind != model::RoofElementKind::chimney) continue;
      EXPECT_TRUE(geometry::check_solid(i.solid, i.triangles).valid());
      double top = 0, low = 1e9;
      for (const auto& v : i.solid.vertices) {
        top = std::max(top, v.z);
        low = std::min(low, v.z);
        EXPECT_TRUE(geometry::contains(h.plan, v.xy()));
      }
      EXPECT_GE(top, ridge + 0.49) << "above the ridge";
      EXPECT_LE(top, ridge + 1.01);
      EXPECT_LT(low, ridge + 0.005) << "it stands on the roof";
    }
  }
}

TEST(RoofInstallations, CountsFollowEraRoofAndUse) {
  model::Attributes a;
  a.style.value = "modern";
  a.era.value = "1919_1945";
  const auto row = model::BuildingPosition::mid_row, free = model::BuildingPosition::free_standing;
  EXPECT_EQ(wanted_chimneys(a, row, false, 24, 0), 2);
  a.era.value = "post1945";
  EXPECT_EQ(wanted_chimneys(a, row, true, 60, 0), 0) << "shafts, no stacks";
  EXPECT_EQ(wanted_chimneys(a, row, false, 54, 0), 3);
  EXPECT_EQ(wanted_chimneys(a, free, false, 12, 0.84), 1);
  EXPECT_EQ(wanted_chimneys(a, free, false, 12, 0.86), 0);
  a.era.value = "pre1840";
  EXPECT_EQ(wanted_chimneys(a, free, false, 8, 0.9), 1);
  a.style.value = "tenement";
  EXPECT_EQ(wanted_chimneys(a, row, true, 24, 0.9), 4);

  House church;
  church.use = "church";
  church.style = "other";
  EXPECT_TRUE(fitted(church).buildings[0].parts[0].lod3.roof_installations.empty());
  House shed;
  shed.plan = polygon({{0, 0}, {5, 0}, {5, 5}, {0, 5}});
  shed.height = 2;
  EXPECT_TRUE(fitted(shed).buildings[0].parts[0].lod3.roof_installations.empty());
  Tile below = tile_of({});
  below.region.buildings[0].parts[0].lod = 2;
  furnish(below);
  EXPECT_TRUE(below.region.buildings[0].parts[0].lod3.roof_installations.empty());
}

TEST(RoofInstallations, AtticStoreysHaveRoofWindowsOnBothSidesAndConvertedLoftsToTheYard) {
  House attic;
  attic.roof_storeys = 1;
  attic.height = 7;
  EXPECT_GE(count(fitted(attic), model::RoofElementKind::roof_window), 4);
  int converted = 0;
  for (std::int64_t id = 1; id <= 300; ++id) {
    House loft;
    loft.height = 7;
    const model::Region region = fitted(loft, id);
    const int windows = count(region, model::RoofElementKind::roof_window);
    converted += windows > 0;
    for (const auto& i : region.buildings[0].parts[0].lod3.roof_installations) {
      if (i.kind != model::RoofElementKind::roof_window) continue;
      for (const auto& v : i.solid.vertices) EXPECT_GT(v.y, 6) << "behind the ridge";
    }
  }
  EXPECT_NEAR(converted, 100, 30);
}

TEST(RoofInstallations, DependsOnNothingButTheBuilding) {
  House h;
  const auto alone = fitted(h, 7).buildings[0].parts[0].lod3.roof_installations;
  Tile two = tile_of(h, 5);
  const Tile second = tile_of(h, 7);
  two.region.buildings.push_back(second.region.buildings[0]);
  two.built.push_back({{1, 0}, second.built[0].mass});
  furnish(two);
  const auto& beside = two.region.buildings[1].parts[0].lod3.roof_installations;
  ASSERT_EQ(alone.size(), beside.size());
  for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_EQ(alone[i].solid.vertices, beside[i].solid.vertices);
  const auto& first = two.region.buildings[0].parts[0].lod3.roof_installations;
  EXPECT_TRUE(first.size() != beside.size() || first[0].solid.vertices != beside[0].solid.vertices)
      << "houses have their own measures";
}

TEST(RoofInstallations, NothingStandsWhereAnotherBodyOfTheHouseDoes) {
  Tile tile = tile_of({});
  model::Building& house = tile.region.buildings[0];
  model::BuildingPart tower = house.parts[0];
  tower.id = "w1.tower";
  tower.plan = polygon({{-1, -1}, {17, -1}, {17, 11}, {-1, 11}});
  house.parts.push_back(tower);
  tile.built.push_back({{0, 1}, tile.built[0].mass});
  furnish(tile);
  for (const auto& i : house.parts[0].lod3.roof_installations)
    for (const auto& v : i.solid.vertices) EXPECT_FALSE(geometry::contains(tower.plan, v.xy()));
  EXPECT_TRUE(house.parts[1].lod3.roof_installations.empty()) << "the largest body has them";
  // What is left out is told, and nothing else is.
  const int built = count(tile.region, model::RoofElementKind::chimney), wanted = 3;
  ASSERT_LT(built, wanted);
  ASSERT_EQ(tile.region.report.rows.size(), 1u);
  EXPECT_EQ(tile.region.report.rows[0].code, model::IssueCode::roof_element_left_out);
  EXPECT_EQ(tile.region.report.rows[0].detail, "chimneys: " + std::to_string(wanted - built) + ", roof windows: 0");
  EXPECT_EQ(house.parts[0].fallbacks, std::vector{model::IssueCode::roof_element_left_out});
  EXPECT_TRUE(fitted({}).report.rows.empty());
}

/// A body with a flat roof, and what the masses hand on of it.
std::pair<model::BuildingPart, masses::BuiltMass> body(const model::Polygon& plan, double bottom, double top,
                                                       const std::string& id) {
  House h;
  h.plan = plan;
  h.shape = RoofShape::flat;
  model::BuildingPart part = tile_of(h).region.buildings[0].parts[0];
  part.id = id;
  masses::EnvelopeMaterials looks;
  looks.wall.kind = model::SurfaceKind::wall;
  looks.roof.kind = model::SurfaceKind::roof;
  looks.under.kind = model::SurfaceKind::ground;
  const roofs::Roof roof = roofs::flat_roof(plan, top);
  part.lod2 = part.lod3.solid = masses::envelope(plan, bottom, roof, looks);
  part.lod2_triangles = part.lod3.triangles = *geometry::triangulate(part.lod2);
  return {std::move(part), masses::built_mass(plan, bottom, roof)};
}

/// A house of these bodies.
Tile house_of(std::vector<std::pair<model::BuildingPart, masses::BuiltMass>> bodies) {
  Tile tile = tile_of(House{});
  tile.region.buildings[0].parts.clear();
  tile.built.clear();
  for (auto& [part, mass] : bodies) {
    tile.built.push_back({{0, static_cast<std::uint32_t>(tile.built.size())}, std::move(mass)});
    tile.region.buildings[0].parts.push_back(std::move(part));
  }
  return tile;
}

TEST(RoofInstallations, TowersOverAPodiumHaveTheChimneys) {
  const model::Polygon plan = polygon({{0, 0}, {18, 0}, {18, 12}, {0, 12}}),
                       wide = polygon({{-2, -2}, {20, -2}, {20, 14}, {-2, 14}});
  for (const bool wider : {false, true}) {
    Tile tile = house_of({body(wider ? wide : plan, 0, 6, "w1.podium"), body(plan, 6, 24, "w1.tower")});
    furnish(tile);
    const auto& parts = tile.region.buildings[0].parts;
    EXPECT_TRUE(parts[0].lod3.roof_installations.empty()) << "the podium is covered";
    EXPECT_EQ(parts[1].lod3.roof_installations.size(), 3u) << "what is below is not in the way";
  }
  // A lantern does not cover the house under it.
  Tile tile = house_of(
      {body(plan, 0, 24, "w1.house"), body(polygon({{8, 4}, {14, 4}, {14, 10}, {8, 10}}), 24, 27, "w1.lantern")});
  furnish(tile);
  EXPECT_FALSE(tile.region.buildings[0].parts[0].lod3.roof_installations.empty());
  EXPECT_TRUE(tile.region.buildings[0].parts[1].lod3.roof_installations.empty());
}

TEST(RoofInstallations, WithoutAFrontageThePlanTellsIt) {
  Tile tile = tile_of({});
  tile.region.buildings[0].situation.width = 0;
  furnish(tile);
  EXPECT_EQ(count(tile.region, model::RoofElementKind::chimney), 2) << "sqrt(18 m * 12 m) / 6 m";
}

}  // namespace
}  // namespace blockrand::facades
