#include "pipeline/footprints/roof_lines.h"

#include <gtest/gtest.h>

#include "tests/unit/geometry/shapes.h"

namespace blockrand::footprints {
namespace {

using model::OsmType;
using model::Point2;
using model::RoofLine;
using model::RoofLineKind;

RoofLine line(std::int64_t id, RoofLineKind kind, std::vector<Point2> points, std::vector<std::int64_t> nodes = {}) {
  nodes.resize(points.size(), 0);
  return {{OsmType::way, id}, kind, std::move(points), std::move(nodes)};
}

model::BuildingPart part(std::vector<Point2> outline) {
  model::BuildingPart p;
  p.plan = testing_shapes::polygon(std::move(outline));
  return p;
}

const std::vector<Point2> kHouse{{0, 0}, {20, 0}, {20, 5}, {20, 10}, {0, 10}};

TEST(RoofLines, GoWhereTheirNodesWent) {
  model::Polygon plan = testing_shapes::polygon(kHouse);
  plan.outer.nodes = {1, 2, 3, 4, 5};
  bool inside = false;
  // As mapped, 0.4 m beside the repaired wall.
  const auto fitted = fit_roof_line(line(9, RoofLineKind::ridge, {{0.25, 5}, {20.4375, 5.25}}, {8, 3}), plan, inside);
  ASSERT_TRUE(fitted);
  EXPECT_TRUE(inside);
  EXPECT_EQ(fitted->points[1], (Point2{20, 5})) << "by its node";
  EXPECT_EQ(fitted->points[0], (Point2{0, 5})) << "an end beside a wall";
}

TEST(RoofLines, EndsBesideCornersGoThere) {
  const model::Polygon plan = testing_shapes::polygon(kHouse);
  bool inside = false;
  const auto fitted = fit_roof_line(line(9, RoofLineKind::edge, {{-0.125, 0.25}, {5, 5}, {10, 0.5}}), plan, inside);
  ASSERT_TRUE(fitted);
  EXPECT_EQ(fitted->points, (std::vector<Point2>{{0, 0}, {5, 5}, {10, 0}}));
  EXPECT_FALSE(fit_roof_line(line(9, RoofLineKind::edge, {{-1, 5}, {5, 5}}), plan, inside));
  ASSERT_TRUE(fit_roof_line(line(9, RoofLineKind::ridge, {{0, 0.125}, {20, 0}}), plan, inside));
  EXPECT_FALSE(inside);
}

TEST(RoofLines, LieOnTheSmallestPlanThatHoldsThem) {
  model::Building b;
  b.parts = {part({{0, 0}, {40, 0}, {40, 20}, {0, 20}}), part(kHouse)};
  fit_roof_lines(b,
                 {line(1, RoofLineKind::ridge, {{0, 5}, {20, 5}}), line(2, RoofLineKind::ridge, {{25, 3}, {35, 3}})});
  ASSERT_EQ(b.parts[0].roof_lines.size(), 1u);
  EXPECT_EQ(b.parts[0].roof_lines[0].id.number, 2);
  ASSERT_EQ(b.parts[1].roof_lines.size(), 1u);
  EXPECT_EQ(b.parts[1].roof_lines[0].id.number, 1);
}

TEST(RoofLines, NoRidgeNoLines) {
  model::Building b;
  b.parts = {part(kHouse)};
  fit_roof_lines(b, {line(1, RoofLineKind::edge, {{0, 0}, {5, 5}}), line(2, RoofLineKind::ridge, {{0, 0}, {20, 0}})});
  EXPECT_TRUE(b.parts[0].roof_lines.empty()) << "a ridge on the wall may be the neighbour's";
  fit_roof_lines(b, {line(3, RoofLineKind::ridge, {{5, 5}, {15, 5}}), line(1, RoofLineKind::edge, {{0, 0}, {5, 5}}),
                     line(2, RoofLineKind::ridge, {{0, 0}, {20, 0}})});
  EXPECT_EQ(b.parts[0].roof_lines.size(), 3u);
}

}  // namespace
}  // namespace blockrand::footprints
