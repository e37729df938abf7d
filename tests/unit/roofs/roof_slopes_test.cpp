#include "styles/roofs/roof_slopes.h"

#include <gtest/gtest.h>

#include "tests/unit/roofs/element_houses.h"
#include "tests/unit/roofs/placed_dormer.h"

namespace blockrand::roofs {
namespace {

using model::RoofShape;
using namespace roof_checks;

std::map<BorderKind, int> kinds(const RoofSlope& plane) {
  std::map<BorderKind, int> out;
  for (const SlopeBorder& border : plane.borders) ++out[border.kind];
  return out;
}

using Kinds = std::map<BorderKind, int>;

TEST(RoofSlope, HasItsAxesAlongAndUpTheSlope) {
  const GabledHouse house(0.75);  // 3-4-5: the slope is 6.25 m long
  const RoofSlope plane = house.plane();
  EXPECT_NEAR(plane.rise, 0.75, 1e-6);
  EXPECT_NEAR(plane.slope_length, 1.25, 1e-6);
  EXPECT_NEAR(plane.along_axis.x, 1, 1e-9);
  EXPECT_NEAR(plane.up_axis.y, 1, 1e-9);
  EXPECT_NEAR(plane.origin.x, 0, 1e-6);
  EXPECT_NEAR(plane.origin.z, kEaves, 1e-3);
  EXPECT_NEAR(plane.along_extent().maximum, 20, 1e-6);
  EXPECT_NEAR(plane.up_extent().maximum, 6.25, 1e-3);
  const Point3 p = plane.in_space({3, 2.5}, 0.5);
  EXPECT_NEAR(p.x, 3, 1e-6);
  EXPECT_NEAR(p.y, 2, 1e-3);
  EXPECT_NEAR(p.z, kEaves + 2, 2e-3);
  EXPECT_NEAR(plane.in_plane(p).y, 2.5, 1e-9);
  EXPECT_NEAR(plane.height_at(p.xy()), kEaves + 1.5, 2e-3);
}

TEST(RoofSlope, LooksUpTheSlopeOnEverySide) {
  const Polygon plan = rectangle(20, 10);
  for (const Polygon& p : turned_about(plan)) {
    const Roof roof = roof_on(p, RoofShape::hipped, 4);
    for (const RoofSlope& plane : roof_slopes(roof)) {
      EXPECT_NEAR(plane.along_axis.x * plane.up_axis.y - plane.along_axis.y * plane.up_axis.x, 1, 1e-9);
      EXPECT_GT(geometry::signed_area(plane.loops[0]), 0);
      EXPECT_NEAR(plane.up_extent().minimum, 0, 2e-3);
      for (const auto& loop : roof.surfaces[plane.surface].loops)
        for (const Point3& q : loop) EXPECT_NEAR(plane.in_space(plane.in_plane(q)).z, q.z, 3e-3);
    }
  }
}

TEST(RoofSlope, TellsEavesSidesTopsAndFolds) {
  const Polygon plan = rectangle(20, 10);
  const GabledHouse gabled(1);
  EXPECT_EQ(kinds(gabled.plane()), (Kinds{{BorderKind::eaves, 1}, {BorderKind::side, 2}, {BorderKind::top, 1}}));
  const Roof hipped = roof_on(plan, RoofShape::hipped, 5);
  for (const RoofSlope& plane : roof_slopes(hipped)) {
    const bool end = plane.loops[0].size() == 3;
    EXPECT_EQ(kinds(plane), end ? (Kinds{{BorderKind::eaves, 1}, {BorderKind::fold, 2}})
                                : (Kinds{{BorderKind::eaves, 1}, {BorderKind::fold, 2}, {BorderKind::top, 1}}));
  }
  const Roof gambrel = roof_on(plan, RoofShape::gambrel, 5);
  int lower = 0, upper = 0;
  for (const RoofSlope& plane : roof_slopes(gambrel)) {
    lower += kinds(plane) == Kinds{{BorderKind::eaves, 1}, {BorderKind::side, 2}, {BorderKind::top, 1}};
    upper += kinds(plane) == Kinds{{BorderKind::fold, 1}, {BorderKind::side, 2}, {BorderKind::top, 1}};
  }
  EXPECT_EQ(lower, 2);
  EXPECT_EQ(upper, 2);
  // The high wall of a lean-to is no eaves.
  const Roof skillion = roof_on(plan, RoofShape::skillion, 3);
  ASSERT_EQ(roof_slopes(skillion).size(), 1u);
  EXPECT_EQ(kinds(roof_slopes(skillion)[0]),
            (Kinds{{BorderKind::eaves, 1}, {BorderKind::side, 2}, {BorderKind::top, 1}}));
}

TEST(RoofSlope, EavesAtAPartyWallAreASide) {
  const GabledHouse house(1);
  std::vector<model::RoofEdge> edges(4, model::RoofEdge::open);
  edges[0] = model::RoofEdge::party_wall;
  const auto plane = roof_slope(house.roof, house.south(), edges);
  ASSERT_TRUE(plane);
  EXPECT_EQ(kinds(*plane), (Kinds{{BorderKind::side, 3}, {BorderKind::top, 1}}));
}

TEST(RoofSlope, ValleysAreFoldsAndBaysCutTheEaves) {
  const Polygon l = plans().at("L");
  int folds = 0;
  for (const RoofSlope& plane : roof_slopes(roof_on(l, RoofShape::hipped, 3))) folds += kinds(plane)[BorderKind::fold];
  EXPECT_EQ(folds % 2, 0);
  EXPECT_GE(folds, 12);
  const Polygon bay = polygon({{0, 0}, {8, 0}, {8, -1}, {12, -1}, {12, 0}, {20, 0}, {20, 10}, {0, 10}});
  int eaves = 0;
  for (const RoofSlope& plane : roof_slopes(roof_on(bay, RoofShape::hipped, 4)))
    eaves += kinds(plane)[BorderKind::eaves];
  EXPECT_EQ(eaves, 8);
}

TEST(RoofSlope, NoneOfLevelUprightOrOverhangingSurfaces) {
  const Polygon plan = rectangle(20, 10);
  EXPECT_TRUE(roof_slopes(flat_roof(plan, kEaves)).empty());
  EXPECT_EQ(roof_slopes(roof_on(plan, RoofShape::double_saltbox, 3)).size(), 2u);
  const Roof sawtooth = roof_on(plan, RoofShape::sawtooth, 2);
  for (const RoofSlope& plane : roof_slopes(sawtooth)) EXPECT_FALSE(sawtooth.surfaces[plane.surface].upright);
  // An onion bulges: what stands on one of its faces could run into another.
  EXPECT_TRUE(roof_slopes(roof_on(regular(8, 4), RoofShape::onion, 6)).empty());
  EXPECT_FALSE(roof_slopes(roof_on(regular(8, 4), RoofShape::dome, 6)).empty());
  const GabledHouse house(1);
  EXPECT_FALSE(roof_slope(house.roof, 99));
}

TEST(RoofSlope, ElementsThatStandThereAreBorders) {
  GabledHouse house(1);
  ASSERT_TRUE(add_dormer(house.roof, house.south(), {}, {10, 1}));
  EXPECT_EQ(kinds(house.plane()),
            (Kinds{{BorderKind::eaves, 1}, {BorderKind::side, 2}, {BorderKind::top, 1}, {BorderKind::element, 5}}));
  // A plane of its own is nothing that could carry more.
  for (std::size_t s = 0; s < house.roof.surfaces.size(); ++s)
    EXPECT_EQ(roof_slope(house.roof, s).has_value(), house.roof.surfaces[s].element == -1);
}

}  // namespace
}  // namespace blockrand::roofs
