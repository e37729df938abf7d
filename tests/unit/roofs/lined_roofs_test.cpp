#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/roofs/roof_checks.h"

namespace blockrand::roofs {
namespace {

using model::RoofLine;
using model::RoofLineKind;
using namespace roof_checks;

RoofLine line(RoofLineKind kind, std::vector<Point2> points) {
  RoofLine out;
  out.kind = kind;
  out.nodes.assign(points.size(), 0);
  out.points = std::move(points);
  return out;
}
RoofLine ridge(std::vector<Point2> points) { return line(RoofLineKind::ridge, std::move(points)); }
RoofLine edge(std::vector<Point2> points) { return line(RoofLineKind::edge, std::move(points)); }
RoofLine apex(Point2 p) { return line(RoofLineKind::apex, {p}); }

const Polygon kHouse = polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}});

/// The roof's height at a plan point; -1 where no face lies over it.
double height_at(const Roof& roof, Point2 p) {
  for (const auto& s : roof.surfaces) {
    std::vector<Point2> flat;
    for (const Point3& q : s.loops[0]) flat.push_back(q.xy());
    if (!geometry::contains(flat, p)) continue;
    double nx = 0, ny = 0, nz = 0;
    const auto& l = s.loops[0];
    for (std::size_t i = 0; i < l.size(); ++i) {
      const Point3 a = l[i], b = l[(i + 1) % l.size()];
      nx += (a.y - b.y) * (a.z - 36 + b.z - 36);
      ny += (a.z - b.z) * (a.x + b.x);
      nz += (a.x - b.x) * (a.y + b.y);
    }
    const Point3 a = l[0];
    return a.z - 36 - (nx * (p.x - a.x) + ny * (p.y - a.y)) / nz;
  }
  return -1;
}

void judge(const Polygon& plan, const std::optional<Roof>& roof, std::size_t faces, double height = 4) {
  ASSERT_TRUE(roof);
  EXPECT_EQ(validity(plan, *roof), "none");
  EXPECT_EQ(roof->surfaces.size(), faces);
  EXPECT_NEAR(covered_area(*roof), geometry::area(plan), 0.05);
  EXPECT_DOUBLE_EQ(highest(*roof), 36 + height);
}

TEST(LinedRoof, RidgeFromWallToWallIsAGable) {
  const auto roof = lined_roof(kHouse, {36, 4}, std::vector{ridge({{0, 5}, {20, 5}})});
  judge(kHouse, roof, 2);
  EXPECT_EQ(roof->wall_tops[1].size(), 3u);
  EXPECT_DOUBLE_EQ(roof->wall_tops[1][1].z, 40);
  EXPECT_NEAR(height_at(*roof, {3, 2.5}), 2, 1e-3);
  EXPECT_EQ(roof->surfaces[0].edge + roof->surfaces[1].edge, 2) << "they rise from the long walls";
}

TEST(LinedRoof, RidgeOffTheMiddle) {
  const auto roof = lined_roof(kHouse, {36, 4}, std::vector{ridge({{0, 3}, {20, 4}})});
  judge(kHouse, roof, 4);  // two triangles each: no plane goes through four such points
  EXPECT_NEAR(height_at(*roof, {0.01, 1.5}), 2, 0.01);
}

TEST(LinedRoof, RidgeAloneGetsHips) {
  const auto roof = lined_roof(kHouse, {36, 4}, std::vector{ridge({{5, 5}, {15, 5}})});
  judge(kHouse, roof, 4);
  EXPECT_NEAR(height_at(*roof, {2.5, 5}), 2, 1e-3);
}

TEST(LinedRoof, HipsAndRidge) {
  const auto roof = lined_roof(kHouse, {36, 4},
                               std::vector{ridge({{4, 5}, {15, 5}}), edge({{0, 0}, {4, 5}}), edge({{4, 5}, {0, 10}}),
                                           edge({{20, 0}, {15, 5}}), edge({{15, 5}, {20, 10}})});
  judge(kHouse, roof, 4);
}

TEST(LinedRoof, RidgesOfAnAngleWithHipAndValley) {
  const Polygon plan = polygon({{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 18}, {0, 18}});
  const auto roof = lined_roof(
      plan, {36, 4}, std::vector{ridge({{20, 4}, {4, 4}, {4, 18}}), edge({{0, 0}, {4, 4}}), edge({{4, 4}, {8, 8}})});
  judge(plan, roof, 4);
  EXPECT_NEAR(height_at(*roof, {14, 2}), 2, 1e-3);
  EXPECT_NEAR(height_at(*roof, {2, 14}), 2, 1e-3);
}

TEST(LinedRoof, RidgesMeetInTheMiddleOfAnother) {
  // A dormer's ridge that ends on the main one without a common node, 8 mm beside it.
  const auto roof = lined_roof(kHouse, {36, 4},
                               std::vector{ridge({{0, 5}, {20, 5}}), ridge({{10, 0}, {10, 5.0078125}}),
                                           edge({{7, 0}, {10, 5}}), edge({{13, 0}, {10, 5}})});
  judge(kHouse, roof, 5);
  EXPECT_EQ(roof->wall_tops[0].size(), 5u);
}

TEST(LinedRoof, ABreakBetweenEavesAndRidgeLiesBetween) {
  // A mansard: a ring of edges, joined to corners and ridge.
  std::vector<RoofLine> lines{ridge({{7, 5}, {13, 5}}), edge({{2, 2}, {18, 2}, {18, 8}, {2, 8}, {2, 2}})};
  for (const auto& [corner, brk, end] : {std::tuple{Point2{0, 0}, Point2{2, 2}, Point2{7, 5}},
                                         {{20, 0}, {18, 2}, {13, 5}},
                                         {{20, 10}, {18, 8}, {13, 5}},
                                         {{0, 10}, {2, 8}, {7, 5}}})
    lines.push_back(edge({corner, brk, end}));
  const auto roof = lined_roof(kHouse, {36, 4}, lines);
  judge(kHouse, roof, 8);
  const double z = height_at(*roof, {10, 2});
  EXPECT_NEAR(z, 4 * std::sqrt(8) / (std::sqrt(8) + std::sqrt(34)), 1e-3) << "in proportion to the way along the edges";
}

TEST(LinedRoof, RidgeOnAWallIsALeanTo) {
  const auto roof = lined_roof(kHouse, {36, 4}, std::vector{ridge({{0, 10}, {20, 10}})});
  judge(kHouse, roof, 1);
  EXPECT_NEAR(height_at(*roof, {7, 5}), 2, 1e-3);
}

TEST(LinedRoof, ApexIsAtFullHeight) {
  const auto roof = lined_roof(kHouse, {36, 4}, std::vector{ridge({{0, 5}, {8, 5}}), apex({16, 5})});
  ASSERT_TRUE(roof);
  EXPECT_EQ(validity(kHouse, *roof), "none");
  EXPECT_NEAR(height_at(*roof, {16, 5}), 4, 1e-3);
}

TEST(LinedRoof, NothingLiesFlatAtTheEavesThatASlopeCanTake) {
  // A ridge over a stem with bays beside its end (w490887948 in Triesen): Delaunay triangles would span the eaves.
  const Polygon plan = polygon({{2.3125, 4.5},
                                {1.875, 1.1875},
                                {12.375, 0},
                                {13.875, 13.3125},
                                {0.625, 14.6875},
                                {0, 9.375},
                                {4.1875, 8.875},
                                {3.6875, 4.3125}});
  const auto roof = lined_roof(plan, {36, 2}, std::vector{ridge({{4.0625, 7.734375}, {13.125, 6.65625}})});
  ASSERT_TRUE(roof);
  EXPECT_EQ(validity(plan, *roof), "none");
  EXPECT_GT(height_at(*roof, {7, 10}), 0.5);
  EXPECT_GT(height_at(*roof, {8, 3}), 0.5);
}

TEST(LinedRoof, CourtyardWithARidgeAllAround) {
  Polygon plan = polygon({{0, 0}, {40, 0}, {40, 30}, {0, 30}});
  plan.holes.push_back(ring({{10, 10}, {10, 20}, {30, 20}, {30, 10}}));
  const auto roof = lined_roof(plan, {36, 4}, std::vector{ridge({{5, 5}, {35, 5}, {35, 25}, {5, 25}, {5, 5}})});
  judge(plan, roof, 8);
}

TEST(LinedRoof, RefusesWhatMakesNoRoof) {
  const RoofMeasures m{36, 4};
  EXPECT_FALSE(lined_roof(kHouse, m, std::vector{edge({{0, 0}, {20, 10}})})) << "no ridge";
  EXPECT_FALSE(lined_roof(kHouse, m, std::vector{ridge({{0, 5}, {25, 5}})})) << "leaves the plan";
  EXPECT_FALSE(lined_roof(kHouse, m, std::vector{ridge({{0, 5}, {20, 5}}), edge({{0, 0}, {20, 10}})}))
      << "cross without a node";
  EXPECT_FALSE(lined_roof(kHouse, m, std::vector{ridge({{0, 5}, {20, 5}}), edge({{3, 2}, {8, 3}})}))
      << "hangs in the air";
  const Polygon u = plans().at("U");
  EXPECT_FALSE(lined_roof(u, m, std::vector{ridge({{4, 20}, {4, 4}}), edge({{8, 20}, {22, 20}})}))
      << "bridges the court";
}

TEST(LinedRoof, EveryRoofOfTheGridCanBeDrawn) {
  // The lines of roofs that are built otherwise, mapped with the errors of a hand, give solids or nothing.
  testing_shapes::Random random(7);
  int drawn = 0, valid = 0;
  for (int i = 0; i < 400; ++i) {
    const double turn = 360 * random.unit();
    const Polygon plan = moved(kHouse, turn, kPlaces[random.next(3)]);
    const auto at = [&](double u, double v) {
      const Point2 o = plan.outer.points[0], a = plan.outer.points[1], b = plan.outer.points[3];
      return model::snap(Point2{o.x + u * (a.x - o.x) + v * (b.x - o.x), o.y + u * (a.y - o.y) + v * (b.y - o.y)});
    };
    const double v = 0.3 + 0.4 * random.unit(), left = 0.1 + 0.2 * random.unit(), right = 0.7 + 0.2 * random.unit();
    std::vector<RoofLine> lines;
    if (random.next(2) == 0) {
      lines = {ridge({at(0, v), at(0.4, v + 0.1 * random.unit()), at(1, v)})};
    } else {
      lines = {ridge({at(left, v), at(right, v)}), edge({at(0, 0), at(left, v), at(0, 1)}),
               edge({at(1, 0), at(right, v), at(1, 1)})};
      if (random.next(2) == 0) lines.push_back(ridge({at((left + right) / 2, v), at((left + right) / 2, 0)}));
    }
    const auto roof = lined_roof(plan, {36, 1 + 6 * random.unit()}, lines);
    if (!roof) continue;
    ++drawn;
    const std::string said = validity(plan, *roof);
    EXPECT_EQ(said, "none") << i;
    valid += said == "none";
  }
  EXPECT_EQ(drawn, 400);
  EXPECT_EQ(valid, drawn);
}

}  // namespace
}  // namespace blockrand::roofs
