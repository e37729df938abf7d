// Houses in rows and blocks: what party walls, streets and yards make of a roof. Plans are laid out by hand, south is
// the street unless said otherwise; heights are worked out from the distance to the eaves.
#include <gtest/gtest.h>

#include "styles/roofs/eaves_lines.h"
#include "styles/roofs/roof_sides.h"
#include "tests/unit/geometry/random_plans.h"
#include "tests/unit/roofs/roof_checks.h"

namespace blockrand::roofs {
namespace {

using model::IssueCode;
using model::Point2;
using model::Point3;
using model::Polygon;
using model::RoofEdge;
using model::RoofShape;
using roof_checks::moved;
using roof_checks::validity;
using testing_shapes::polygon;
using testing_shapes::Random;
using testing_shapes::ring;

constexpr RoofEdge kOpen = RoofEdge::open, kStreet = RoofEdge::street, kYard = RoofEdge::courtyard,
                   kParty = RoofEdge::party_wall;
constexpr double kEaves = 36;

Polygon rectangle(double width, double depth) { return polygon({{0, 0}, {width, 0}, {width, depth}, {0, depth}}); }

RoofRequest in_row(RoofShape shape, double height, std::vector<RoofEdge> edges) {
  RoofRequest r;
  r.shape = shape;
  r.measures = {kEaves, height};
  r.edges = std::move(edges);
  return r;
}

/// Height of the roof above its eaves over a point.
double height_at(const Roof& roof, Point2 p) {
  for (const Roof::Surface& s : roof.surfaces) {
    if (s.upright) continue;
    std::vector<Point2> flat;
    for (const Point3 q : s.loops[0]) flat.push_back(q.xy());
    if (!geometry::contains(flat, p)) continue;
    const Point3 o = s.loops[0][0];
    double nx = 0, ny = 0, nz = 0;
    for (std::size_t i = 0; i < s.loops[0].size(); ++i) {
      const Point3 a = s.loops[0][i], b = s.loops[0][(i + 1) % s.loops[0].size()];
      nx += (a.y - o.y) * (b.z - o.z) - (a.z - o.z) * (b.y - o.y);
      ny += (a.z - o.z) * (b.x - o.x) - (a.x - o.x) * (b.z - o.z);
      nz += (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
    }
    return o.z - (nx * (p.x - o.x) + ny * (p.y - o.y)) / nz - kEaves;
  }
  return -1;
}

/// The highest point above an edge's wall, above the eaves.
double wall_rise(const Roof& roof, std::size_t edge) {
  double most = 0;
  for (const Point3 p : roof.wall_tops[edge]) most = std::max(most, p.z - kEaves);
  return most;
}

TEST(MidRowHouse, RidgeRunsFromPartyWallToPartyWall) {
  // Deeper than wide: without neighbours the ridge would run the other way.
  const Polygon plan = rectangle(8, 12);
  for (const bool mapped : {false, true})
    for (const RoofShape shape :
         {RoofShape::gabled, RoofShape::hipped, RoofShape::half_hipped, RoofShape::side_hipped}) {
      if (mapped && shape == RoofShape::hipped) continue;
      RoofRequest r = in_row(shape, 6, {kStreet, kParty, kYard, kParty});
      r.shape_is_mapped = mapped;
      const auto built = build_roof(plan, r);
      ASSERT_TRUE(built) << model::name(shape);
      EXPECT_EQ(validity(plan, built->roof), "none");
      EXPECT_EQ(built->roof.surfaces.size(), 2u) << model::name(shape);
      EXPECT_EQ(wall_rise(built->roof, 0), 0);
      EXPECT_EQ(wall_rise(built->roof, 1), 6);
      EXPECT_EQ(wall_rise(built->roof, 2), 0);
      EXPECT_EQ(wall_rise(built->roof, 3), 6);
      EXPECT_NEAR(height_at(built->roof, {3, 2}), 2, 1e-9);
      EXPECT_EQ(built->note, IssueCode::none);
    }
}

TEST(MidRowHouse, BrokenRoofsEndAtThePartyWallsToo) {
  const Polygon plan = rectangle(10, 12);
  for (const RoofShape shape : {RoofShape::mansard, RoofShape::gambrel, RoofShape::double_saltbox,
                                RoofShape::quadruple_saltbox, RoofShape::round, RoofShape::berlin}) {
    const auto built = build_roof(plan, in_row(shape, 5, {kStreet, kParty, kYard, kParty}));
    ASSERT_TRUE(built) << model::name(shape);
    EXPECT_EQ(validity(plan, built->roof), "none") << model::name(shape);
    EXPECT_NEAR(wall_rise(built->roof, 1), 5, 0.002) << model::name(shape);
    EXPECT_EQ(wall_rise(built->roof, 0), 0) << model::name(shape);
  }
}

TEST(MidRowHouse, NeighboursOfOnePitchMeetInOnePlane) {
  // Three houses at one street, two of one depth and one deeper; 40 degrees each, measured by their main slopes.
  const double tangent = 0.8390996311772799;
  std::vector<Roof> roofs;
  double x = 0;
  for (const double depth : {12.0, 12.0, 15.5}) {
    Polygon plan = rectangle(9, depth);
    for (Point2& p : plan.outer.points) p.x += x;
    RoofRequest r = in_row(RoofShape::gabled, 0, {kStreet, kParty, kYard, kParty});
    const MainSlope slope = main_slope(plan, r, true);
    EXPECT_NEAR(slope.run, depth / 2, 1e-6);
    EXPECT_FALSE(slope.leans);
    r.measures.height = slope.run * tangent / slope.rise;
    roofs.push_back(build_roof(plan, r)->roof);
    x += 9;
  }
  for (std::size_t house = 0; house + 1 < roofs.size(); ++house) {
    const double wall = 9.0 * static_cast<double>(house + 1);
    for (const double y : {0.5, 3.0, 5.9})
      EXPECT_NEAR(height_at(roofs[house], {wall - 0.001, y}), height_at(roofs[house + 1], {wall + 0.001, y}), 0.002);
  }
}

TEST(MidRowHouse, DeepHousesStillTurnEavesToTheStreet) {
  // 20 m deep and 7 m wide: a hall would have its ridge along.
  const auto built = build_roof(rectangle(7, 20), in_row(RoofShape::gabled, 6, {kStreet, kParty, kYard, kParty}));
  ASSERT_TRUE(built);
  EXPECT_EQ(wall_rise(built->roof, 0), 0);
  EXPECT_EQ(wall_rise(built->roof, 1), 6);
}

TEST(EndOfRow, HasAGableAtItsFreeEnd) {
  const Polygon plan = rectangle(10, 12);
  const auto built = build_roof(plan, in_row(RoofShape::gabled, 6, {kStreet, kOpen, kYard, kParty}));
  ASSERT_TRUE(built);
  EXPECT_EQ(built->roof.surfaces.size(), 2u);
  EXPECT_EQ(wall_rise(built->roof, 1), 6);
  const auto hipped = build_roof(plan, in_row(RoofShape::hipped, 6, {kStreet, kOpen, kYard, kParty}));
  EXPECT_EQ(hipped->roof.surfaces.size(), 3u);
  EXPECT_NEAR(height_at(hipped->roof, {3.9, 6}), 6, 0.01) << "the hip at the free end is as steep as the other slopes";
  EXPECT_NEAR(main_slope(plan, in_row(RoofShape::hipped, 0, {kStreet, kOpen, kYard, kParty}), true).run, 6, 1e-6);
  EXPECT_EQ(wall_rise(hipped->roof, 1), 0);
  EXPECT_EQ(wall_rise(hipped->roof, 3), 6);
}

TEST(EndOfRow, TurnsAtAStreetCornerUnlessItsGableIsMapped) {
  const Polygon plan = rectangle(10, 12);
  RoofRequest r = in_row(RoofShape::gabled, 6, {kStreet, kStreet, kYard, kParty});
  EXPECT_EQ(wall_rise(build_roof(plan, r)->roof, 1), 0);
  EXPECT_NEAR(main_slope(plan, r, true).run, 6, 1e-6);
  EXPECT_NEAR(height_at(build_roof(plan, r)->roof, {9, 6}), 1, 0.01);
  r.shape_is_mapped = true;
  EXPECT_EQ(wall_rise(build_roof(plan, r)->roof, 1), 6);
}

TEST(CornerHouse, TurnsTheRidgeThoughItsPlanIsFull) {
  // Streets in the south and east, neighbours in the north and west, no yard but the corner between these.
  const Polygon plan = rectangle(12, 12);
  for (const double degrees : {0.0, 33.0}) {
    const Polygon p = moved(plan, degrees, {degrees, 5});
    RoofRequest r = in_row(RoofShape::gabled, 6, {kStreet, kStreet, kParty, kParty});
    const RoofSides sides = roof_sides(p, r, true);
    ASSERT_TRUE(sides.corner);
    EXPECT_EQ(*sides.corner, 3u);
    EXPECT_FALSE(sides.leans);
    const auto built = build_roof(p, r);
    ASSERT_TRUE(built);
    EXPECT_EQ(validity(p, built->roof), "none");
    EXPECT_EQ(built->roof.surfaces.size(), 4u);
    EXPECT_EQ(wall_rise(built->roof, 0), 0);
    EXPECT_EQ(wall_rise(built->roof, 1), 0);
    EXPECT_NEAR(wall_rise(built->roof, 2), 6, 0.002);
    EXPECT_NEAR(wall_rise(built->roof, 3), 6, 0.002);
    if (degrees != 0) continue;
    // As over an L whose inner corner is the yard's: hips where slopes to the streets meet, a valley to the corner.
    for (double x = 0.7; x < 12; x += 1.3)
      for (double y = 0.4; y < 12; y += 1.1)
        EXPECT_NEAR(height_at(built->roof, {x, y + 5}), std::min({y, 12 - x, std::max(x, 12 - y)}), 0.003)
            << x << ' ' << y;
  }
}

TEST(CornerHouse, WithAYardOfItsOwnHasAValleyThere) {
  const Polygon plan = polygon({{0, 0}, {20, 0}, {20, 20}, {9, 20}, {9, 11}, {0, 11}});
  const auto built = build_roof(plan, in_row(RoofShape::gabled, 5, {kStreet, kStreet, kParty, kYard, kYard, kParty}));
  ASSERT_TRUE(built);
  EXPECT_EQ(validity(plan, built->roof), "none");
  for (const std::size_t eaves : {0u, 1u, 3u, 4u}) EXPECT_EQ(wall_rise(built->roof, eaves), 0) << eaves;
  for (const std::size_t upright : {2u, 5u}) EXPECT_NEAR(wall_rise(built->roof, upright), 5, 0.003) << upright;
}

TEST(SideWing, LeansOnTheNeighbourAndFallsToTheYard) {
  const Polygon plan = rectangle(6, 20);
  RoofRequest r = in_row(RoofShape::gabled, 1.5, {kParty, kYard, kYard, kParty});
  EXPECT_TRUE(main_slope(plan, r, true).leans);
  const auto built = build_roof(plan, r);
  ASSERT_TRUE(built);
  EXPECT_EQ(validity(plan, built->roof), "none");
  EXPECT_EQ(built->shape, RoofShape::skillion);
  EXPECT_EQ(built->roof.surfaces.size(), 1u);
  EXPECT_EQ(wall_rise(built->roof, 1), 0);
  EXPECT_EQ(wall_rise(built->roof, 3), 1.5);
  const Point2 down = default_slope(plan, r.edges);
  EXPECT_EQ(down, (Point2{1, 0}));
}

TEST(SideWing, StaysALeanToBesideALightShaft) {
  const Polygon plan = polygon({{0, 0}, {6, 0}, {6, 20}, {0, 20}, {0, 11}, {1, 11}, {1, 10}, {0, 10}});
  const RoofRequest r = in_row(RoofShape::gabled, 1.5, {kParty, kYard, kYard, kParty, kOpen, kOpen, kOpen, kParty});
  EXPECT_TRUE(main_slope(plan, r, true).leans);
}

TEST(SideWing, OfAFrontHouseIsGentlerThanIt) {
  // A front house 18 m wide with a wing along the western neighbour.
  const Polygon plan = polygon({{0, 0}, {18, 0}, {18, 12}, {6, 12}, {6, 26}, {0, 26}});
  const auto built = build_roof(plan, in_row(RoofShape::gabled, 6, {kStreet, kParty, kYard, kYard, kYard, kParty}));
  ASSERT_TRUE(built);
  EXPECT_EQ(validity(plan, built->roof), "none");
  EXPECT_NEAR(height_at(built->roof, {12, 5.5}), 5.5, 0.01);
  EXPECT_NEAR(height_at(built->roof, {1, 22}), 5 * 0.3, 0.01);
  EXPECT_NEAR(wall_rise(built->roof, 4), 1.8, 0.01) << "the wing ends upright";
}

TEST(SkillionInARow, FallsToTheYardAndNeverToTheNeighbour) {
  EXPECT_EQ(default_slope(rectangle(8, 12), {kStreet, kParty, kYard, kParty}), (Point2{0, 1}));
  EXPECT_EQ(default_slope(rectangle(8, 12), {kStreet, kParty, kParty, kParty}), (Point2{0, -1}));
  EXPECT_EQ(default_slope(rectangle(8, 12), {kParty, kOpen, kYard, kParty}), (Point2{1, 0}));
  // A chip of open wall at the rear has no say.
  const Polygon chipped = polygon({{0, 0}, {8, 0}, {8, 12}, {0.3, 12}, {0, 11.9}});
  EXPECT_EQ(default_slope(chipped, {kStreet, kParty, kParty, kOpen, kParty}), (Point2{0, -1}));
}

TEST(Mapped, HipsAreBuilt) {
  RoofRequest r = in_row(RoofShape::hipped, 4, {kStreet, kParty, kYard, kParty});
  r.shape_is_mapped = true;
  const auto built = build_roof(rectangle(8, 12), r);
  EXPECT_EQ(built->roof.surfaces.size(), 4u);
  for (std::size_t e = 0; e < 4; ++e) EXPECT_EQ(wall_rise(built->roof, e), 0);
}

TEST(Mapped, ShapesKeepTheirSlopesAndDirectionsTheirAxes) {
  const Polygon plan = rectangle(14, 9);
  // A rear building stands against the whole rear.
  RoofRequest r = in_row(RoofShape::gabled, 4, {kStreet, kParty, kParty, kParty});
  EXPECT_TRUE(roof_sides(plan, r, true).leans);
  r.shape_is_mapped = true;
  const auto built = build_roof(plan, r);
  EXPECT_EQ(built->shape, RoofShape::gabled);
  EXPECT_EQ(built->roof.surfaces.size(), 2u);
  // The gable faces the street: eaves run along the party walls.
  RoofRequest old_town = in_row(RoofShape::gabled, 5, {kStreet, kParty, kYard, kParty});
  old_town.axis_is_mapped = true;
  old_town.shape_is_mapped = true;
  const auto gable_on = build_roof(rectangle(7, 15), old_town);
  EXPECT_EQ(wall_rise(gable_on->roof, 0), 5);
  EXPECT_EQ(wall_rise(gable_on->roof, 1), 0);
  // A ridge that runs at the street by order does not turn there, whoever chose the shape.
  old_town.shape_is_mapped = false;
  EXPECT_EQ(wall_rise(build_roof(rectangle(7, 15), old_town)->roof, 0), 5);
}

TEST(PerimeterBlock, MappedAsOnePolygonHasARidgeAllAround) {
  Polygon plan{ring({{0, 0}, {60, 0}, {60, 45}, {0, 45}}), {ring({{12, 12}, {12, 33}, {48, 33}, {48, 12}})}};
  const std::vector<RoofEdge> edges{kStreet, kStreet, kStreet, kStreet, kYard, kYard, kYard, kYard};
  for (const RoofShape shape : {RoofShape::gabled, RoofShape::hipped, RoofShape::mansard}) {
    const auto built = build_roof(plan, in_row(shape, 5, edges));
    ASSERT_TRUE(built);
    EXPECT_EQ(validity(plan, built->roof), "none");
    for (std::size_t e = 0; e < edges.size(); ++e) EXPECT_EQ(wall_rise(built->roof, e), 0) << e;
    for (const Point2 ridge : {Point2{30, 6}, Point2{54, 20}, Point2{20, 39}, Point2{6, 30}})
      EXPECT_NEAR(height_at(built->roof, ridge), 5, 0.01) << model::name(shape);
  }
}

TEST(BerlinRoof, IsSteepToTheStreetAndLowToTheYard) {
  const Polygon plan = rectangle(18, 13);
  RoofRequest r = in_row(RoofShape::berlin, 0, {kStreet, kParty, kYard, kParty});
  r.measures.height = main_slope(plan, r, true).run;
  EXPECT_GT(r.measures.height, 2.0);
  EXPECT_LT(r.measures.height, 5.0);  // docs/style_measures.md 2.7: the steep strip is 2 to 5 m high
  const auto built = build_roof(plan, r);
  ASSERT_TRUE(built);
  EXPECT_EQ(validity(plan, built->roof), "none");
  EXPECT_EQ(built->roof.surfaces.size(), 2u);
  EXPECT_EQ(built->shape, RoofShape::berlin);
  EXPECT_NEAR(height_at(built->roof, {9, 0.5}), 0.5 * std::sqrt(3), 0.003);
  EXPECT_NEAR(height_at(built->roof, {9, 8}) - height_at(built->roof, {9, 12}), 4 * std::tan(8 * M_PI / 180), 0.003);
  EXPECT_GT(wall_rise(built->roof, 2), 0.4) << "a knee wall at the yard";
  EXPECT_NEAR(wall_rise(built->roof, 1), r.measures.height, 0.002);
}

TEST(Mansard, HasAnAtticStoreyBehindItsSteepSlopes) {
  const Polygon plan = rectangle(12, 13);
  RoofRequest r = in_row(RoofShape::mansard, mansard_height(6.5, 2.6), {kStreet, kParty, kYard, kParty});
  r.attic = 2.6;
  const auto built = build_roof(plan, r);
  ASSERT_TRUE(built);
  const double at_break = 2.6 / kMansardSteep;
  EXPECT_NEAR(height_at(built->roof, {6, at_break}), 2.6, 0.01);
  EXPECT_NEAR(height_at(built->roof, {6, at_break / 2}), 1.3, 0.01);
  EXPECT_NEAR(height_at(built->roof, {6, 4.5}) - height_at(built->roof, {6, 2.5}), 2 * kMansardGentle, 0.01);
}

TEST(Enclosed, OnlyWhereNoSideIsFree) {
  EXPECT_TRUE(is_enclosed(rectangle(8, 9), {kParty, kParty, kParty, kParty}));
  EXPECT_FALSE(is_enclosed(rectangle(8, 9), {kYard, kParty, kParty, kParty}));
  EXPECT_FALSE(is_enclosed(rectangle(1, 9), {kStreet, kParty, kParty, kParty}));
  EXPECT_FALSE(is_enclosed(rectangle(8, 9), {}));
}

// ---- eaves lines

/// A house in a row, 14 by 12, with a stair tower of 1.2 by 3 m at its rear and a recess 1 m deep in its front.
Polygon with_bay() {
  return polygon(
      {{0, 0}, {5, 0}, {5, 1}, {8, 1}, {8, 0}, {14, 0}, {14, 12}, {9, 12}, {9, 13.2}, {6, 13.2}, {6, 12}, {0, 12}});
}
std::vector<RoofEdge> bay_edges() {
  return {kStreet, kStreet, kStreet, kStreet, kStreet, kParty, kYard, kYard, kYard, kYard, kYard, kParty};
}

TEST(EavesLines, LeaveOutBaysAndRecesses) {
  const auto eaves = eaves_plan(with_bay(), bay_edges());
  ASSERT_TRUE(eaves);
  EXPECT_EQ(eaves->plan.outer.points, (std::vector<Point2>{{0, 0}, {14, 0}, {14, 12}, {0, 12}}));
  EXPECT_EQ(eaves->edges, (std::vector<RoofEdge>{kStreet, kParty, kYard, kParty}));
  EXPECT_FALSE(eaves_plan(rectangle(14, 12), {}));
  // An L has no bay, however narrow its wing.
  EXPECT_FALSE(eaves_plan(polygon({{0, 0}, {14, 0}, {14, 12}, {3, 12}, {3, 20}, {0, 20}}), {}));
}

TEST(EavesLines, TheRoofRunsOnOverRecessesAndDownOverBays) {
  for (const double degrees : {0.0, 17.0}) {
    const Polygon plan = moved(with_bay(), degrees, {3, -2});
    RoofRequest r = in_row(RoofShape::gabled, 6, bay_edges());
    r.along_eaves_lines = true;
    const auto built = build_roof(plan, r);
    ASSERT_TRUE(built);
    EXPECT_EQ(validity(plan, built->roof), "none");
    EXPECT_EQ(built->roof.surfaces.size(), 2u);
    EXPECT_NEAR(roof_checks::covered_area(built->roof), geometry::area(plan), 0.01);
    EXPECT_NEAR(wall_rise(built->roof, 2), 1, 0.003) << "the recess's wall goes up to the roof";
    double lowest = 0;
    for (const Point3 p : built->roof.wall_tops[8]) lowest = std::min(lowest, p.z - kEaves);
    EXPECT_NEAR(lowest, -1.2, 0.003) << "the roof comes down over the stair tower";
    r.along_eaves_lines = false;
    EXPECT_GT(build_roof(plan, r)->roof.surfaces.size(), 6u);
  }
}

TEST(EavesLines, AFrontThatBendsIsTwo) {
  // Two walls of 8 m that bend by 10 degrees: the far end would lie 1.4 m off the line of the first.
  const double c = std::cos(10 * M_PI / 180), s = std::sin(10 * M_PI / 180);
  const Polygon plan = polygon({{0, 0},
                                {8, 0},
                                model::snap(Point2{8 + 8 * c, 8 * s}),
                                model::snap(Point2{8 + 8 * c - 12 * s, 8 * s + 12 * c}),
                                {6.95, 12},
                                {0, 12}});
  EXPECT_FALSE(eaves_plan(plan, {}));
}

TEST(EavesLines, NoRoofComesDownByMoreThanHalfAStorey) {
  RoofRequest r = in_row(RoofShape::gambrel, 9, bay_edges());
  r.along_eaves_lines = true;
  EXPECT_FALSE(build_roof(with_bay(), r)) << "1.2 m of bay under a slope of 75 degrees";
}

TEST(EavesLines, DoNotDependOnWhereTheRingStarts) {
  // A front in two halves with a step of a metre: equal lengths, whichever comes first.
  const Polygon plan = polygon({{0, 0}, {7, 0}, {7, 1}, {14, 1}, {14, 13}, {0, 13}});
  const auto first = eaves_plan(plan, {});
  ASSERT_TRUE(first);
  for (std::size_t k = 1; k < plan.outer.size(); ++k) {
    Polygon other = plan;
    std::rotate(other.outer.points.begin(), other.outer.points.begin() + static_cast<std::ptrdiff_t>(k),
                other.outer.points.end());
    const auto again = eaves_plan(other, {});
    ASSERT_TRUE(again);
    EXPECT_EQ(std::set<Point2>(again->plan.outer.points.begin(), again->plan.outer.points.end()),
              std::set<Point2>(first->plan.outer.points.begin(), first->plan.outer.points.end()));
  }
}

TEST(EavesLines, HousesWithAnyBaysGetValidRoofs) {
  Random random(606);
  int along = 0, houses = 0, roofs = 0, invalid = 0;
  for (int k = 0; k < 300; ++k) {
    const double width = 9 + 14 * random.unit(), depth = 9 + 6 * random.unit();
    std::vector<Point2> points;
    std::vector<RoofEdge> edges;
    const auto facade = [&](Point2 from, Point2 to, RoofEdge kind, bool bays) {
      const double dx = to.x - from.x, dy = to.y - from.y, length = std::sqrt(dx * dx + dy * dy);
      const auto at = [&](double s, double out) {
        return model::snap(
            Point2{from.x + dx * s / length + dy * out / length, from.y + dy * s / length - dx * out / length});
      };
      points.push_back(model::snap(from));
      edges.push_back(kind);
      if (!bays) return;
      for (double s = 1 + random.unit(); s + 3 < length; s += 3 + 2 * random.unit()) {
        if (random.unit() < 0.5) continue;
        const double out = (random.unit() - 0.5) * 2.4;
        for (const Point2 p : {at(s, 0), at(s, out), at(s + 2, out), at(s + 2, 0)}) {
          points.push_back(p);
          edges.push_back(kind);
        }
      }
    };
    facade({0, 0}, {width, 0}, kStreet, true);
    facade({width, 0}, {width, depth}, kParty, false);
    facade({width, depth}, {0, depth}, kYard, true);
    facade({0, depth}, {0, 0}, random.unit() < 0.5 ? kParty : kOpen, false);
    const Polygon plan = moved(polygon(points), 360 * random.unit(), {391000, 5819000});
    if (!geometry::strictly_simple(plan)) continue;
    ++houses;
    for (const RoofShape shape :
         {RoofShape::gabled, RoofShape::hipped, RoofShape::gambrel, RoofShape::double_saltbox}) {
      RoofRequest r = in_row(shape, 5, edges);
      r.along_eaves_lines = true;
      const auto built = build_roof(plan, r);
      if (!built) continue;  // counted below: callers give every bay its slopes
      ++roofs;
      // A hip that leaves a corner a grid step beside a bay's wall has a tip that is too narrow: callers see it.
      invalid += validity(plan, built->roof) != "none";
      EXPECT_NEAR(roof_checks::covered_area(built->roof), geometry::area(plan), 0.02) << k;
      if (shape == RoofShape::gabled) along += built->roof.surfaces.size() <= 3;
    }
  }
  EXPECT_GE(houses, 250);
  EXPECT_GE(along, houses * 90 / 100) << "one ridge, bays or not";
  EXPECT_GE(roofs, 3 * houses);
  EXPECT_LE(invalid, roofs / 50) << "of " << roofs;
}

// ---- any plan in any row

TEST(RowRoofs, AreValidOnRandomPlansWithRandomNeighbours) {
  Random random(77);
  int built = 0, refused = 0, invalid = 0;
  for (int k = 0; k < 1500; ++k) {
    const Polygon plan = testing_shapes::random_plan(77, static_cast<std::uint64_t>(k));
    std::size_t n = plan.outer.size();
    for (const auto& hole : plan.holes) n += hole.size();
    std::vector<RoofEdge> edges(n);
    for (RoofEdge& e : edges) e = static_cast<RoofEdge>(random.next(4));
    const RoofShape shapes[] = {RoofShape::gabled,         RoofShape::hipped, RoofShape::mansard,
                                RoofShape::double_saltbox, RoofShape::berlin, RoofShape::half_hipped};
    RoofRequest r = in_row(shapes[k % 6], 3, edges);
    r.along_eaves_lines = k % 2 == 0;
    const auto roof = build_roof(plan, r);
    if (!roof) {
      ++refused;  // closed by no slope: callers go on without neighbours
      continue;
    }
    ++built;
    invalid += validity(plan, roof->roof) != "none";
  }
  EXPECT_GE(built, 1300);
  EXPECT_LE(invalid, 15) << "of " << built << ", " << refused << " refused";
}

}  // namespace
}  // namespace blockrand::roofs
