// Eaves, verges, caps, parapets and fire walls on roofs that the masses hand on.
#include "pipeline/facades/roof_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "pipeline/facades/roof_installations.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/solid_overlap.h"
#include "tests/unit/facades/house.h"

namespace blockrand::facades {
namespace {

using model::Point2;
using model::RoofEdge;
using model::RoofElementKind;
using model::RoofInstallation;
using model::RoofShape;
using test::House;
using test::Tile;
using test::tile_of;
using testing_shapes::polygon;

/// A wall segment for each edge of the plan. \param covered  m, what the neighbours of party walls cover
void label(Tile& tile, const House& h, float covered) {
  model::Building& b = tile.region.buildings[0];
  b.outline = {h.plan};
  for (std::uint32_t i = 0; i < h.plan.outer.size(); ++i) {
    const Point2 p = h.plan.outer.points[i], q = h.plan.outer.points[(i + 1) % h.plan.outer.size()];
    model::WallSegment s;
    s.edge = i;
    s.end = std::hypot(q.x - p.x, q.y - p.y);
    s.kind = h.edges[i] == RoofEdge::party_wall  ? model::WallSegmentKind::party_wall
             : h.edges[i] == RoofEdge::street    ? model::WallSegmentKind::street
             : h.edges[i] == RoofEdge::courtyard ? model::WallSegmentKind::courtyard
                                                 : model::WallSegmentKind::side;
    if (h.edges[i] == RoofEdge::party_wall) s.covered_height = covered;
    b.edges.push_back(s);
  }
  const int tiles = test::defaults().material("roof_tiles");
  for (model::Face& face : b.parts[0].lod2.faces)
    if (face.kind == model::SurfaceKind::roof) face.material = static_cast<std::uint8_t>(tiles);
}

/// m³ deeper than a centimetre: slopes are the same to the grid's rounding.
double common(const model::Solid& a, const model::SolidTriangles& its, const model::Solid& b,
              const model::SolidTriangles& others) {
  return geometry::overlap_of({a.vertices, its.triangles}, {b.vertices, others.triangles}).volume;
}
constexpr double kNothing = 1e-6;

std::vector<RoofInstallation> dressed(const House& h, float covered, const std::vector<model::Polygon>& others = {},
                                      bool chimneys = false) {
  Tile tile = tile_of(h);
  label(tile, h, covered);
  const masses::BuiltMasses built(tile.built);
  if (chimneys) add_roof_installations(tile.region, built, test::defaults(), {});
  add_roof_edges(tile.region, built, test::defaults(),
                 [&](const geometry::PlanBox&, double, model::OsmId) { return others; });
  for (const RoofInstallation& i : tile.region.buildings[0].parts[0].lod3.roof_installations) {
    EXPECT_TRUE(geometry::check_solid(i.solid, i.triangles).valid()) << model::name(i.kind);
    const model::BuildingPart& body = tile.region.buildings[0].parts[0];
    EXPECT_LT(common(i.solid, i.triangles, body.lod2, body.lod2_triangles), kNothing) << model::name(i.kind);
  }
  return tile.region.buildings[0].parts[0].lod3.roof_installations;
}

std::map<RoofElementKind, int> counted(const std::vector<RoofInstallation>& all) {
  std::map<RoofElementKind, int> counts;
  for (const RoofInstallation& i : all) ++counts[i.kind];
  return counts;
}

struct Extent {
  double low_x = 1e9, high_x = -1e9, low_y = 1e9, high_y = -1e9, high_z = -1e9;
};
Extent extent_of(const std::vector<RoofInstallation>& all, RoofElementKind kind) {
  Extent e;
  for (const RoofInstallation& i : all)
    if (i.kind == kind)
      for (const model::Point3& p : i.solid.vertices) {
        e.low_x = std::min(e.low_x, p.x), e.high_x = std::max(e.high_x, p.x);
        e.low_y = std::min(e.low_y, p.y), e.high_y = std::max(e.high_y, p.y);
        e.high_z = std::max(e.high_z, p.z);
      }
  return e;
}

House villa() {
  House h;
  h.plan = polygon({{0, 0}, {14, 0}, {14, 10}, {0, 10}});
  h.edges = {RoofEdge::street, RoofEdge::open, RoofEdge::courtyard, RoofEdge::open};
  h.eaves = 6, h.height = 4;
  h.use = "house", h.style = "modern", h.era = "post1945";
  return h;
}

TEST(RoofEdges, AFreeHouseHasEavesAlongItsLengthVergesOnItsGablesAndACappedRidge) {
  const std::vector<RoofInstallation> all = dressed(villa(), 0);
  const std::map<RoofElementKind, int> counts = counted(all);
  EXPECT_GE(counts.at(RoofElementKind::eaves) + counts.at(RoofElementKind::verge), 2);
  EXPECT_EQ(counts.at(RoofElementKind::ridge_cap), 1);
  EXPECT_FALSE(counts.contains(RoofElementKind::parapet));
  Extent both = extent_of(all, RoofElementKind::eaves);
  const Extent verge = extent_of(all, RoofElementKind::verge);
  both.low_x = std::min(both.low_x, verge.low_x), both.high_x = std::max(both.high_x, verge.high_x);
  both.low_y = std::min(both.low_y, verge.low_y), both.high_y = std::max(both.high_y, verge.high_y);
  EXPECT_NEAR(both.low_y, -0.4, 0.002);
  EXPECT_NEAR(both.high_y, 10.4, 0.002);
  EXPECT_NEAR(both.low_x, -0.2, 0.002);
  EXPECT_NEAR(both.high_x, 14.2, 0.002);
}

TEST(RoofEdges, NothingHangsOverAPartyWallOrIntoANeighbour) {
  House row;  // between two neighbours, which it shares its end walls with
  row.eaves = 18;
  for (const RoofInstallation& i : dressed(row, 18))
    for (const model::Point3& p : i.solid.vertices) {
      EXPECT_GE(p.x, -0.001) << model::name(i.kind);
      EXPECT_LE(p.x, 18.001) << model::name(i.kind);
    }
  // A house 0.2 m before the front: eaves stay within that.
  const auto close = dressed(villa(), 0, {polygon({{0, -8}, {14, -8}, {14, -0.2}, {0, -0.2}})});
  const Extent front = extent_of(close, RoofElementKind::eaves);
  EXPECT_GT(front.low_y, -0.2);
  EXPECT_NEAR(front.high_y, 10.4, 0.002);
}

TEST(RoofEdges, AnOldHouseHasAFireWallWhereItsNeighbourIsLower) {
  House row;
  row.eaves = 18, row.height = 5;
  EXPECT_FALSE(counted(dressed(row, 18)).contains(RoofElementKind::firewall)) << "equal eaves";
  EXPECT_FALSE(counted(dressed(row, 17)).contains(RoofElementKind::firewall)) << "the two roofs may be one";
  const auto above = dressed(row, 9);
  EXPECT_EQ(counted(above).at(RoofElementKind::firewall), 2);
  EXPECT_NEAR(extent_of(above, RoofElementKind::firewall).high_z, 23.3, 0.01) << "0.3 m above the ridge";
  row.style = "modern", row.era = "post1945";
  EXPECT_FALSE(counted(dressed(row, 9)).contains(RoofElementKind::firewall));
}

TEST(RoofEdges, AFlatRoofHasAParapetAndNoEaves) {
  House hall = villa();
  hall.shape = RoofShape::flat;
  const auto all = dressed(hall, 0);
  const std::map<RoofElementKind, int> counts = counted(all);
  EXPECT_EQ(counts.size(), 1u);
  EXPECT_EQ(counts.at(RoofElementKind::parapet), 1);
  EXPECT_NEAR(extent_of(all, RoofElementKind::parapet).high_z, 6.4, 0.002);
  hall.plan = polygon({{0, 0}, {5, 0}, {5, 4}, {0, 4}});
  EXPECT_TRUE(dressed(hall, 0).empty()) << "a garage";
}

TEST(RoofEdges, CapsAndWallsKeepClearOfChimneys) {
  House h;
  h.eaves = 18;
  const auto all = dressed(h, 9, {}, true);
  ASSERT_GE(counted(all)[RoofElementKind::chimney], 1);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_LT(common(all[i].solid, all[i].triangles, all[k].solid, all[k].triangles), kNothing)
          << model::name(all[i].kind) << " and " << model::name(all[k].kind);
}

TEST(RoofEdges, ACorniceTakesThePlaceOfEaves) {
  const House h = villa();
  Tile tile = tile_of(h);
  label(tile, h, 0);
  model::WallInstallation cornice;
  cornice.kind = "main_cornice";
  for (const double x : {0.0, 14.0})
    for (const double y : {0.0, -0.5})
      for (const double z : {5.4, 6.0}) cornice.solid.vertices.push_back({x, y, z});
  tile.region.buildings[0].parts[0].lod3.installations.push_back(cornice);
  add_roof_edges(tile.region, masses::BuiltMasses(tile.built), test::defaults(),
                 [](const geometry::PlanBox&, double, model::OsmId) { return std::vector<model::Polygon>(); });
  const auto& all = tile.region.buildings[0].parts[0].lod3.roof_installations;
  EXPECT_GE(extent_of(all, RoofElementKind::eaves).low_y, -0.001);
  EXPECT_NEAR(extent_of(all, RoofElementKind::eaves).high_y, 10.4, 0.002);
}

}  // namespace
}  // namespace blockrand::facades
