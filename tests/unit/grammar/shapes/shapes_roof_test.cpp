#include <random>

#include "tests/unit/grammar/shapes/shapes_support.h"

namespace blockrand::grammar {
namespace {

TEST(Roofs, HipIsSteepOrFlat) {  // docs/rule_language.md §7.4, 24
  const std::pair<double, std::size_t> cases[]{{10, 0}, {30, 1}, {80, 2}};
  for (const auto& [angle, where] : cases) {
    const auto parts = taken(after(rectangle(10, 10), "roofHip", {plain(angle)}), ComponentKind::faces,
                             {"bottom", "horizontal", "aslant", "vertical"});
    EXPECT_EQ(parts[0].size(), 1u);
    EXPECT_EQ(parts[1 + where].size(), 4u) << angle;
  }
}

TEST(Roofs, Hip) {  // 30
  const Shape roof = after(rectangle(10, 20), "roofHip", {plain(45)});
  expect_sound(roof, true);
  EXPECT_EQ(geometry_face_count(roof), 5);
  EXPECT_NEAR(roof.size.y, 5, 1e-6);
  EXPECT_NEAR(volume(roof), 1250.0 / 3, 1e-4);
  const auto edges = taken(roof, ComponentKind::edges, {"ridge", "hip", "valley", "eave"});
  ASSERT_EQ(edges[0].size(), 1u);
  EXPECT_NEAR(edges[0][0].size.x, 10, 1e-5);
  EXPECT_EQ(edges[1].size(), 4u);
  EXPECT_EQ(edges[2].size(), 0u);
  EXPECT_EQ(edges[3].size(), 4u);
  // Hips run upwards.
  for (const Shape& hip : edges[1]) EXPECT_GT(scope_in_world(hip).axes[0].y, 0);
}

TEST(Roofs, ValleysOfAnL) {
  const Shape roof = after(l_shape(), "roofHip", {word("byHeight"), plain(3)});
  expect_sound(roof, true);
  EXPECT_EQ(geometry_face_count(roof), 7);
  EXPECT_NEAR(roof.size.y, 3, 1e-6);
  EXPECT_EQ(taken(roof, ComponentKind::edges, {"valley"})[0].size(), 1u);
}

TEST(Roofs, Gable) {  // 31
  const Shape by_angle = after(rectangle(10, 20), "roofGable", {plain(45)});
  const Shape by_height = after(rectangle(10, 20), "roofGable", {word("byHeight"), plain(5)});
  for (const Shape& roof : {by_angle, by_height}) {
    expect_sound(roof, true);
    EXPECT_EQ(geometry_face_count(roof), 5);
    EXPECT_NEAR(roof.size.y, 5, 1e-6);
    EXPECT_NEAR(volume(roof), 500, 1e-4);
    const auto ridge = taken(roof, ComponentKind::edges, {"ridge"})[0];
    ASSERT_EQ(ridge.size(), 1u);
    EXPECT_NEAR(ridge[0].size.x, 20, 1e-6);
    EXPECT_NEAR(std::fabs(scope_in_world(ridge[0]).axes[0].z), 1, 1e-6);
    EXPECT_TRUE(geometry_is_tagged(roof, "roof.side"));
  }
}

TEST(Roofs, GableOnASquareAndByEdge) {
  const Shape square = after(rectangle(10, 10), "roofGable", {plain(45)});
  expect_sound(square, true);
  EXPECT_NEAR(volume(square), 250, 1e-4);
  const auto along = [](const Shape& roof) {
    return std::fabs(scope_in_world(taken(roof, ComponentKind::edges, {"ridge"})[0].at(0)).axes[0].x);
  };
  EXPECT_NEAR(along(square), 1, 1e-6);  // along the first edge
  const Shape turned = after(rectangle(10, 20), "roofGable", {plain(45), plain(0), plain(0), plain(0), plain(0)});
  EXPECT_NEAR(along(turned), 1, 1e-6);
  EXPECT_NEAR(volume(turned), 1000, 1e-3);
  expect_sound(turned, true);
}

TEST(Roofs, GablesOfWings) {
  for (const Shape& lot : {l_shape(), u_shape()}) {
    const Shape roof = after(lot, "roofGable", {plain(40)});
    expect_sound(roof, true);
    EXPECT_TRUE(geometry_is_tagged(roof, "roof.side"));
  }
}

TEST(Roofs, Overhangs) {
  const Shape roof = after(rectangle(10, 20), "roofHip", {plain(45), plain(std::sqrt(2))});
  // 1 m out and 1 m down on all sides; the bottom stays.
  EXPECT_NEAR(roof.size.x, 12, 1e-4);
  EXPECT_NEAR(roof.size.z, 22, 1e-4);
  EXPECT_NEAR(roof.size.y, 6, 1e-4);
  expect_sound(roof, false);
  const Shape gable = after(rectangle(10, 20), "roofGable", {plain(45), plain(std::sqrt(2)), plain(0.5)});
  EXPECT_NEAR(gable.size.x, 12, 1e-4);
  EXPECT_NEAR(gable.size.z, 21, 1e-4);
  const auto sides = taken(gable, ComponentKind::faces, {"vertical"})[0];
  ASSERT_EQ(sides.size(), 2u);
  EXPECT_NEAR(geometry_area(sides[0]), 25, 1e-4);  // gable walls stay where they were
}

TEST(Roofs, ShedAndPyramid) {  // 32
  const Shape shed = after(rectangle(10, 20), "roofShed", {word("byHeight"), plain(3)});
  expect_sound(shed, true);
  EXPECT_EQ(geometry_face_count(shed), 5);
  EXPECT_NEAR(volume(shed), 300, 1e-6);
  // Low along the first edge, in front.
  const auto back = taken(shed, ComponentKind::faces, {"back", "front"});
  EXPECT_EQ(back[0].size(), 1u);
  EXPECT_EQ(back[1].size(), 0u);
  const Shape side = after(rectangle(10, 20), "roofShed", {plain(45), plain(-1)});
  EXPECT_NEAR(side.size.y, 10, 1e-6);
  const Shape falling = after(rectangle(10, 20), "roofShed", {plain(-45)});
  EXPECT_NEAR(falling.size.y, -20, 1e-6);
  expect_sound(falling, true);
  const Shape pyramid = after(rectangle(10, 20), "roofPyramid", {word("byHeight"), plain(6)});
  expect_sound(pyramid, true);
  EXPECT_EQ(geometry_face_count(pyramid), 5);
  EXPECT_NEAR(volume(pyramid), 400, 1e-6);
  EXPECT_NEAR(after(rectangle(10, 20), "roofPyramid", {plain(45)}).size.y, 10, 1e-6);
}

TEST(Roofs, Ridge) {
  const Shape roof = after(rectangle(10, 20), "roofRidge", {word("byHeight"), plain(4)});
  expect_sound(roof, true);
  EXPECT_EQ(geometry_face_count(roof), 5);
  EXPECT_NEAR(volume(roof), 400, 1e-6);
  EXPECT_NEAR(roof.size.y, 4, 1e-9);
  expect_sound(after(u_shape(), "roofRidge", {plain(30)}), true);
  expect_sound(after(triangle(), "roofRidge", {word("byAngle"), plain(30)}), true);
}

TEST(Roofs, Courtyard) {
  const std::vector<InitialPolygon> polygon{
      {{{0, 0, 0}, {20, 0, 0}, {20, 0, -20}, {0, 0, -20}}, {{{6, 0, -6}, {14, 0, -6}, {14, 0, -14}, {6, 0, -14}}}}};
  const Shape court = initial_shape(polygon);
  for (const char* name : {"roofHip", "roofGable", "roofShed", "roofPyramid"}) {
    const Shape roof = after(court, name, {plain(30)});
    expect_sound(roof, std::string_view(name) != "roofPyramid");
    EXPECT_GT(roof.size.y, 0) << name;
  }
}

TEST(Roofs, OnAWallTheRoofStandsOut) {
  Shape wall = taken(after(rectangle(10, 20), "extrude", {plain(6)}), ComponentKind::faces, {"front"})[0].at(0);
  run(wall, "roofHip", {plain(45)});
  expect_sound(wall, true);
  EXPECT_NEAR(wall.size.y, 3, 1e-6);
  EXPECT_NEAR(scope_in_world(wall).axes[1].z, 1, 1e-9);
}

TEST(Roofs, RandomPlansAreClosed) {
  std::mt19937 random(5);
  const auto number = [&](double low, double high) { return low + (high - low) * (random() % 100000) / 100000.0; };
  int roofs = 0;
  for (int round = 0; round < 150; ++round) {
    std::vector<std::pair<double, double>> outline;
    const int n = 3 + static_cast<int>(random() % 7);
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * 3.14159265358979 * (i + 0.4 * number(0, 1)) / n, r = number(4, 12);
      outline.emplace_back(r * std::cos(angle), -r * std::sin(angle));
    }
    const Shape plan = lot(outline);
    for (const char* name : {"roofHip", "roofGable", "roofShed", "roofRidge"}) {
      const Shape roof = std::string_view(name) == "roofRidge" ? after(plan, name, {word("byAngle"), plain(35)})
                                                               : after(plan, name, {plain(35)});
      EXPECT_TRUE(geometry_is_closed(roof)) << name << " round " << round;
      EXPECT_GT(volume(roof), 0) << name << " round " << round;
      roofs += geometry_is_closed(roof) ? 1 : 0;
    }
  }
  EXPECT_EQ(roofs, 600);
}

}  // namespace
}  // namespace blockrand::grammar
