#include "pipeline/geometry/check_solid.h"

#include <gtest/gtest.h>

#include "pipeline/geometry/triangulate.h"
#include "tests/unit/geometry/broken_solids.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::geometry {
namespace {

using model::Solid;

SolidCheck check(const Solid& solid) {
  for (const auto index : solid.indices)
    if (index >= solid.vertices.size()) return check_solid(solid, {});
  for (const auto& loop : solid.loops)
    if (loop.count < 3) return check_solid(solid, {});
  const auto triangles = solid.faces.empty() ? std::nullopt : triangulate(solid);
  return check_solid(solid, triangles ? *triangles : model::SolidTriangles{});
}

TEST(CheckSolid, SoundSolidsPass) {
  const model::Point3 far{391000, 5819000, 34};
  EXPECT_EQ(check(testing_shapes::box(far, 10, 8, 6)).text(), "none");
  EXPECT_EQ(check(testing_shapes::gabled_house(far, 12, 9, 5, 9)).text(), "none");
  EXPECT_EQ(check(testing_shapes::courtyard_block(far, 60, 30, 18)).text(), "none");
}

TEST(CheckSolid, VolumeOfABox) {
  const Solid box = testing_shapes::box({391000, 5819000, 34}, 10, 8, 6);
  EXPECT_DOUBLE_EQ(volume(box, *triangulate(box)), 480);
}

TEST(CheckSolid, FindsEveryBrokenSolid) {
  const auto broken = testing_shapes::broken_solids();
  EXPECT_GE(broken.size(), 50u);
  for (const auto& b : broken) EXPECT_FALSE(check(b.solid).valid()) << b.name;
}

TEST(CheckSolid, NamesTheDefect) {
  const auto broken = testing_shapes::broken_solids();
  const auto defect = [&](const std::string& name) {
    for (const auto& b : broken)
      if (b.name == name) return check(b.solid).defect;
    ADD_FAILURE() << "no broken solid " << name;
    return SolidDefect::none;
  };
  EXPECT_EQ(defect("box without face 1"), SolidDefect::open_edge);
  EXPECT_EQ(defect("house with face 1 flipped"), SolidDefect::wrong_orientation);
  EXPECT_EQ(defect("block inside out"), SolidDefect::inside_out);
  EXPECT_EQ(defect("box with a face twice"), SolidDefect::non_manifold_edge);
  EXPECT_EQ(defect("two boxes on one edge"), SolidDefect::non_manifold_edge);
  EXPECT_EQ(defect("two boxes on one corner"), SolidDefect::non_manifold_vertex);
  EXPECT_EQ(defect("box beside another"), SolidDefect::not_connected);
  EXPECT_EQ(defect("house with a corner 5 cm off its plane"), SolidDefect::not_planar);
  EXPECT_EQ(defect("no faces"), SolidDefect::empty);
  EXPECT_EQ(defect("no height"), SolidDefect::repeated_vertex);
}

TEST(CheckSolid, SelfIntersectionThatTopologyCannotSee) {
  // One vertex of a house pulled through the opposite wall: closed and oriented, but crossing itself.
  Solid house = testing_shapes::gabled_house({391000, 5819000, 34}, 12, 9, 5, 9);
  // Turn each face into triangles, so that planarity has no say.
  const auto triangles = triangulate(house);
  ASSERT_TRUE(triangles);
  std::vector<Grid3> grid;
  for (const auto& v : house.vertices) grid.push_back(to_grid(v) - to_grid(house.vertices[0]));
  EXPECT_EQ(check_mesh(grid, triangles->triangles).text(), "none");
  for (auto& g : grid)
    if (g.z > 8 * 1024) g.z -= 12 * 1024;  // the ridge goes below the ground
  EXPECT_EQ(check_mesh(grid, triangles->triangles).defect, SolidDefect::self_intersection);
}

TEST(Triangulate, ConcaveOutlineWithThreeHoles) {
  // seed003-part2 P2-06: the triangles' area is the outline's minus the holes'.
  std::vector<Grid2> points;
  std::vector<std::vector<std::uint32_t>> loops;
  const auto add = [&](std::initializer_list<Grid2> loop) {
    auto& l = loops.emplace_back();
    for (const Grid2 p : loop) {
      l.push_back(static_cast<std::uint32_t>(points.size()));
      points.push_back(p);
    }
  };
  add({{0, 0}, {100, 0}, {100, 100}, {60, 100}, {60, 60}, {0, 60}});
  add({{10, 10}, {10, 20}, {20, 20}, {20, 10}});
  add({{30, 10}, {30, 40}, {40, 40}, {40, 10}});
  add({{70, 70}, {70, 90}, {90, 90}, {90, 70}});
  const auto triangles = triangulate(points, loops);
  ASSERT_TRUE(triangles);
  std::int64_t twice = 0;
  for (const auto& t : *triangles) {
    const Grid2 u = points[t[1]] - points[t[0]], v = points[t[2]] - points[t[0]];
    EXPECT_GT(u.x * v.y - u.y * v.x, 0);
    twice += u.x * v.y - u.y * v.x;
  }
  EXPECT_EQ(twice, 2 * (100 * 60 + 40 * 40 - 100 - 300 - 400));
}

TEST(Triangulate, RefusesCrossingAndTouchingLoops) {
  const std::vector<Grid2> points{{0, 0}, {10, 10}, {10, 0}, {0, 10}};
  EXPECT_FALSE(triangulate(points, std::vector<std::vector<std::uint32_t>>{{0, 1, 2, 3}}));
  const std::vector<Grid2> touching{{0, 0}, {20, 0}, {20, 20}, {0, 20}, {0, 10}, {5, 12}, {5, 8}};
  EXPECT_FALSE(triangulate(touching, std::vector<std::vector<std::uint32_t>>{{0, 1, 2, 3}, {4, 5, 6}}));
}

TEST(Orientation, ExactWhereDoublesAreNot) {
  // Four points whose determinant is 1 although its products exceed 2^60.
  const std::int64_t big = 1 << 30;
  EXPECT_EQ(orientation(Grid3{0, 0, 0}, Grid3{big, 0, 0}, Grid3{0, big, 0}, Grid3{big / 2, big / 2, 0}), 0);
  EXPECT_EQ(orientation(Grid3{0, 0, 0}, Grid3{big, 0, 0}, Grid3{0, big, 0}, Grid3{big / 2, big / 2, 1}), -1);
  EXPECT_EQ(orientation(Grid3{0, 0, 0}, Grid3{big, 0, 0}, Grid3{0, big, 0}, Grid3{big / 2, big / 2, -1}), 1);
}

}  // namespace
}  // namespace blockrand::geometry
