// Dormers and cross gables in the solid of LoD3, and the windows of their fronts.
#include "pipeline/facades/roof_elements.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/facades/facades.h"
#include "pipeline/facades/roof_edges.h"
#include "pipeline/geometry/check_solid.h"
#include "tests/unit/facades/house.h"

namespace blockrand::facades {
namespace {

using model::Point2;
using model::RoofElementKind;
using test::House;
using test::Tile;
using test::tile_of;
using testing_shapes::polygon;
using Values = std::vector<std::pair<std::string, grammar::Value>>;

RoofOrders orders_of(const Values& values) {
  std::vector<std::string> complaints;
  RoofOrders out = read_roof_orders(values, complaints);
  EXPECT_TRUE(complaints.empty()) << complaints.front();
  return out;
}

std::optional<FurnishedRoof> furnished(const Tile& tile, const RoofOrders& orders,
                                       const std::vector<WindowAxes>& axes = {}) {
  const model::Building& b = tile.region.buildings[0];
  return furnish_roof(b, b.parts[0], tile.built[0].mass, b.parts[0].roof_edges, axes, orders);
}

House steep_house() {
  House h;
  h.height = 6.5;  // 47 degrees over half of 12 m
  return h;
}

TEST(RoofOrders, SayWhatIsUnknownOrOutOfRange) {
  std::vector<std::string> complaints;
  const RoofOrders orders = read_roof_orders(Values{{"built_dormers", std::string("pagoda")},
                                                    {"built_cross_gables", std::string("gabled")},
                                                    {"cross_gable_width", 5.0},
                                                    {"dormer_every", 2.0},
                                                    {"built_gable", std::string("none")}},
                                             complaints);
  EXPECT_FALSE(orders.dormers);
  EXPECT_FALSE(orders.gable);
  ASSERT_TRUE(orders.cross_gables);
  EXPECT_EQ(orders.cross_gables->width, roofs::CrossGableParameters{}.width);
  EXPECT_EQ(orders.dormer_every, 2);
  ASSERT_EQ(complaints.size(), 2u);
  EXPECT_THAT(complaints[0], testing::AllOf(testing::HasSubstr("dormer_kind"), testing::HasSubstr("pagoda"),
                                            testing::HasSubstr("eyebrow")));
  EXPECT_THAT(complaints[1], testing::AllOf(testing::HasSubstr("cross_gable_width"), testing::HasSubstr("5")));
}

TEST(FurnishRoof, DormersStandOnTheAxesBelowAndTheSolidStaysOne) {
  for (const auto& [word, faces] : {std::pair("gabled", 5), {"hipped", 6}, {"shed", 4}, {"flat", 4}}) {
    const Tile tile = tile_of(steep_house());
    const model::BuildingPart& body = tile.region.buildings[0].parts[0];
    const std::vector<WindowAxes> axes{{0, {{3, 0}, {6, 0}, {9, 0}, {12, 0}, {15, 0}}}};
    RoofOrders orders = orders_of({{"built_dormers", std::string(word)}, {"dormer_side", std::string("street")}});
    const auto made = furnished(tile, orders, axes);
    ASSERT_TRUE(made) << word;
    EXPECT_EQ(made->dormers, 5) << word;
    EXPECT_EQ(made->left_out, 0);
    EXPECT_EQ(made->fronts.size(), 5u);
    EXPECT_TRUE(geometry::check_solid(made->solid, made->triangles).valid());
    EXPECT_EQ(made->solid.faces.size(), body.lod2.faces.size() + static_cast<std::size_t>(5 * faces)) << word;
    // What LoD2 has keeps its numbers and its places.
    for (std::size_t v = 0; v < body.lod2.vertices.size(); ++v)
      EXPECT_EQ(made->solid.vertices[v], body.lod2.vertices[v]);
    for (std::size_t f = 0; f < body.lod2.faces.size(); ++f)
      EXPECT_EQ(made->solid.faces[f].kind, body.lod2.faces[f].kind);
    std::vector<double> places;
    for (const RoofFront& front : made->fronts) {
      places.push_back(front.middle.x);
      EXPECT_EQ(made->solid.faces[front.face].kind, model::SurfaceKind::wall);
      EXPECT_GT(front.foot, 18.5) << "above the eaves";
    }
    std::sort(places.begin(), places.end());
    for (std::size_t i = 0; i < places.size(); ++i) EXPECT_NEAR(places[i], 3 + 3 * static_cast<double>(i), 0.01);
  }
}

TEST(FurnishRoof, EverySecondAxisAndSides) {
  const Tile tile = tile_of(steep_house());
  const std::vector<WindowAxes> axes{{0, {{3, 0}, {6, 0}, {9, 0}, {12, 0}, {15, 0}}},
                                     {2, {{4, 12}, {9, 12}, {14, 12}}}};
  EXPECT_EQ(furnished(tile,
                      orders_of({{"built_dormers", std::string("gabled")},
                                 {"dormer_every", 2.0},
                                 {"dormer_side", std::string("street")}}),
                      axes)
                ->dormers,
            3);
  EXPECT_EQ(
      furnished(tile, orders_of({{"built_dormers", std::string("gabled")}, {"dormer_side", std::string("rear")}}), axes)
          ->dormers,
      3);
  EXPECT_EQ(furnished(tile, orders_of({{"built_dormers", std::string("gabled")}}), axes)->dormers, 8);
  EXPECT_EQ(
      furnished(tile, orders_of({{"built_dormers", std::string("gabled")}, {"dormer_count", 1.0}}), axes)->dormers, 2);
  EXPECT_FALSE(furnished(tile, orders_of({{"built_dormers", std::string("none")}}), axes));
}

TEST(FurnishRoof, ACrossGableIsPartOfItsWall) {
  const Tile tile = tile_of(steep_house());
  const auto made = furnished(
      tile, orders_of({{"built_cross_gables", std::string("gabled")}, {"built_dormers", std::string("shed")}}));
  ASSERT_TRUE(made);
  EXPECT_EQ(made->cross_gables, 1);
  EXPECT_GT(made->dormers, 2);
  EXPECT_TRUE(geometry::check_solid(made->solid, made->triangles).valid());
  const auto front = std::find_if(made->fronts.begin(), made->fronts.end(),
                                  [](const RoofFront& f) { return f.kind == RoofElementKind::cross_gable; });
  ASSERT_NE(front, made->fronts.end());
  EXPECT_EQ(front->face, 1u) << "the underside, then the first wall";
  EXPECT_NEAR(front->middle.x, 9, 0.01);
  EXPECT_NEAR(front->middle.y, 0, 0.01);
  EXPECT_NEAR(front->foot, 18, 0.01);
}

TEST(FurnishRoof, NothingOnFlatRoofsNorWhereAnotherBodyStands) {
  House flat = steep_house();
  flat.shape = model::RoofShape::flat;
  EXPECT_FALSE(furnished(tile_of(flat), orders_of({{"built_dormers", std::string("gabled")}})));

  Tile tile = tile_of(steep_house());
  const RoofOrders orders =
      orders_of({{"built_dormers", std::string("gabled")}, {"dormer_side", std::string("street")}});
  const std::vector<WindowAxes> axes{{0, {{3, 0}, {9, 0}, {15, 0}}}};
  EXPECT_EQ(furnished(tile, orders, axes)->dormers, 3);
  model::BuildingPart tower;
  tower.id = "w1.w2";
  tower.plan = polygon({{8, 0}, {10, 0}, {10, 4}, {8, 4}});
  tower.attributes.height.value = 30;
  tile.region.buildings[0].parts.push_back(tower);
  const auto made = furnished(tile, orders, axes);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->dormers, 2);
  EXPECT_EQ(made->left_out, 1);
}

/// A tile whose walls have labels, ready for rules.
Tile labelled(const House& h) {
  Tile tile = tile_of(h);
  model::Building& b = tile.region.buildings[0];
  tile.region.materials = {{"plaster", 0.9f, 0}};
  b.outline = {h.plan};
  const auto& ring = h.plan.outer.points;
  for (std::uint32_t e = 0; e < ring.size(); ++e) {
    model::WallSegment edge;
    edge.edge = e;
    const Point2 p = ring[e], q = ring[(e + 1) % ring.size()];
    edge.end = std::hypot(q.x - p.x, q.y - p.y);
    edge.kind = h.edges[e] == model::RoofEdge::street       ? model::WallSegmentKind::street
                : h.edges[e] == model::RoofEdge::party_wall ? model::WallSegmentKind::party_wall
                                                            : model::WallSegmentKind::courtyard;
    b.edges.push_back(edge);
  }
  b.situation.fronts = {0};
  model::BuildingPart& part = b.parts[0];
  part.lod3 = {};
  part.lod = 2;
  model::Attributes& a = part.attributes;
  a.storeys.value = 5;
  a.storey_height.value = 3.5;
  a.plinth_height.value = 0.5;
  a.roof_height.value = h.height;
  a.height.value = h.eaves + h.height;
  a.roof_shape.value = h.shape;
  a.roof_pitch.value = std::atan2(h.height, 6) * 180 / 3.14159265358979;
  a.preset.value = "p";
  b.attributes.preset.value = "p";
  return tile;
}

int windows_above(const model::BuildingPart& part, double height) {
  int n = 0;
  for (const model::Placement& p : part.lod3.placements)
    n += p.opening != model::kNoOpening && part.lod3.openings[p.opening].kind == model::OpeningKind::window &&
         p.origin.z > height;
  return n;
}

TEST(RoofRules, EveryDormerHasItsWindowAlsoOnMansards) {
  const std::filesystem::path folder = std::filesystem::path(BLOCKRAND_SOURCE_DIR) / "configs/grammars";
  struct Case {
    model::RoofShape shape;
    double height;
    const char* kind;
  };
  for (const Case& c :
       {Case{model::RoofShape::gabled, 6.5, "gabled"}, Case{model::RoofShape::mansard, 6.5, "segmental"},
        Case{model::RoofShape::mansard, 6.5, "gabled"}, Case{model::RoofShape::gabled, 6.5, "shed"}}) {
    House h = steep_house();
    h.shape = c.shape;
    h.height = c.height;
    Tile tile = labelled(h);
    const std::vector<PresetGrammar> presets{
        {"p",
         "gruenderzeit.cga",
         {{"dormer_share", "1"}, {"dormer_kind", c.kind}, {"cross_gable_share", "0"}},
         "roofscape.cga"}};
    const GrammarLibrary book(folder.string(), presets, test::elements_of_configs());
    masses::BuiltMasses built(tile.built);
    build_facades(tile.region, book, test::defaults(), {}, &built);
    const model::BuildingPart& part = tile.region.buildings[0].parts[0];
    const auto dormers =
        std::count(part.lod3.roof_elements.begin(), part.lod3.roof_elements.end(), RoofElementKind::dormer);
    EXPECT_GE(dormers, 2) << c.kind;
    EXPECT_EQ(windows_above(part, h.eaves), dormers) << c.kind << " on " << model::name(c.shape);
    EXPECT_TRUE(geometry::check_solid(part.lod3.solid, part.lod3.triangles).valid());
    EXPECT_EQ(built.find({0, 0})->roof.elements.size(), static_cast<std::size_t>(dormers))
        << "what stands on the roof later knows of them";
    EXPECT_TRUE(tile.region.report.rows.empty()) << tile.region.report.rows.front().detail;
  }
}

TEST(RoofRules, PresetsWithoutRulesForRoofsLeaveThemBare) {
  Tile tile = labelled(steep_house());
  const std::vector<PresetGrammar> presets{{"p", "gruenderzeit.cga", {{"dormer_share", "1"}}}};
  const GrammarLibrary book((std::filesystem::path(BLOCKRAND_SOURCE_DIR) / "configs/grammars").string(), presets,
                            test::elements_of_configs());
  masses::BuiltMasses built(tile.built);
  build_facades(tile.region, book, test::defaults(), {}, &built);
  EXPECT_TRUE(tile.region.buildings[0].parts[0].lod3.roof_elements.empty());
  EXPECT_EQ(windows_above(tile.region.buildings[0].parts[0], 18), 0);
}

TEST(RoofRules, AGableToTheStreetGetsItsOrnamentAndWindows) {
  for (const char* form : {"stepped", "curved"}) {
    House h = steep_house();
    h.plan = polygon({{0, 0}, {9, 0}, {9, 14}, {0, 14}});
    h.height = 6;
    h.edges = {model::RoofEdge::street, model::RoofEdge::open, model::RoofEdge::courtyard, model::RoofEdge::open};
    Tile tile = labelled(h);
    const std::vector<PresetGrammar> presets{
        {"p", "plain.cga", {{"gable", form}, {"dormer_share", "0"}, {"gable_window_share", "1"}}, "roofscape.cga"}};
    const GrammarLibrary book((std::filesystem::path(BLOCKRAND_SOURCE_DIR) / "configs/grammars").string(), presets,
                              test::elements_of_configs());
    masses::BuiltMasses built(tile.built);
    build_facades(tile.region, book, test::defaults(), {}, &built);
    const bool gable_to_street = built.find({0, 0})->roof.wall_tops[0].size() > 2;
    add_roof_edges(tile.region, built, test::defaults(),
                   [](const geometry::PlanBox&, double, model::OsmId) { return std::vector<model::Polygon>{}; });
    const model::BuildingPart& part = tile.region.buildings[0].parts[0];
    const auto gables = std::count_if(part.lod3.roof_installations.begin(), part.lod3.roof_installations.end(),
                                      [](const auto& i) { return i.kind == RoofElementKind::gable; });
    EXPECT_EQ(gables, gable_to_street ? 1 : 0) << form;
    EXPECT_TRUE(gable_to_street) << "a free house with its short side to the street";
    EXPECT_GT(windows_above(part, 18), 0) << "in the gable";
  }
}

}  // namespace
}  // namespace blockrand::facades
