#include <random>

#include "styles/grammar/shapes/mesh_cut.h"
#include "tests/unit/grammar/shapes/shapes_support.h"

namespace blockrand::grammar {
namespace {

TEST(MeshOperations, ReverseKeepsTheFirstEdge) {
  const Shape lot = rectangle(10, 20);
  const Shape turned = after(lot, "reverseNormals");
  EXPECT_EQ(face_normal(mesh_of(turned), mesh_of(turned).faces[0]), (Vector3{0, -1, 0}));
  const Loop &a = mesh_of(lot).faces[0].loops[0], &b = mesh_of(turned).faces[0].loops[0];
  EXPECT_EQ(mesh_of(lot).vertices[a[0].vertex], mesh_of(turned).vertices[b[1].vertex]);
  EXPECT_EQ(mesh_of(lot).vertices[a[1].vertex], mesh_of(turned).vertices[b[0].vertex]);
  const Shape house = after(lot, "extrude", {plain(3)});
  EXPECT_NEAR(volume(after(house, "reverseNormals")), -600, 1e-9);
  expect_sound(after(after(house, "reverseNormals"), "reverseNormals"), true);
}

TEST(MeshOperations, DeleteHoles) {
  const std::vector<InitialPolygon> polygon{
      {{{0, 0, 0}, {10, 0, 0}, {10, 0, -10}, {0, 0, -10}}, {{{3, 0, -3}, {7, 0, -3}, {7, 0, -7}, {3, 0, -7}}}}};
  EXPECT_NEAR(geometry_area(after(initial_shape(polygon), "deleteHoles")), 100, 1e-9);
}

TEST(MeshOperations, Convexify) {
  for (const Shape& lot : {l_shape(), u_shape()}) {
    const Shape parts = after(lot, "convexify");
    EXPECT_GT(geometry_face_count(parts), 1);
    EXPECT_LT(geometry_face_count(parts), 5);
    EXPECT_FALSE(geometry_is_concave(parts));
    EXPECT_NEAR(geometry_area(parts), 300, 1e-6);
    expect_sound(parts, false);
  }
  // Only lines shorter than the limit cut: the shortest of the L has 10 m.
  EXPECT_EQ(geometry_face_count(after(l_shape(), "convexify", {plain(5)})), 1);
  EXPECT_EQ(geometry_face_count(after(l_shape(), "convexify", {plain(20)})), 2);
  EXPECT_NEAR(geometry_area(after(u_shape(), "convexify", {plain(7)})), 300, 1e-6);
  EXPECT_EQ(after(rectangle(10, 20), "convexify").mesh->faces.size(), 1u);
  const std::vector<InitialPolygon> polygon{
      {{{0, 0, 0}, {10, 0, 0}, {10, 0, -10}, {0, 0, -10}}, {{{3, 0, -3}, {7, 0, -3}, {7, 0, -7}, {3, 0, -7}}}}};
  EXPECT_NEAR(geometry_area(after(initial_shape(polygon), "convexify")), 84, 1e-6);
  EXPECT_EQ(geometry_hole_count(after(initial_shape(polygon), "convexify")), 0);
}

TEST(MeshOperations, CleanUp) {
  // A point on the straight front edge, and the two halves of a lot.
  Shape lot1 = lot({{0, 0}, {4, 0}, {10, 0}, {10, -20}, {0, -20}});
  EXPECT_EQ(geometry_vertex_count(after(lot1, "cleanupGeometry", {word("vertices"), plain(0)})), 4);
  EXPECT_EQ(geometry_vertex_count(after(lot1, "cleanupGeometry", {word("edges"), plain(0)})), 5);
  const std::vector<InitialPolygon> two{{{{0, 0, 0}, {5, 0, 0}, {5, 0, -5}, {0, 0, -5}}, {}},
                                        {{{5, 0, 0}, {10, 0, 0}, {10, 0, -5}, {5, 0, -5}}, {}}};
  const Shape one = after(initial_shape(two), "cleanupGeometry", {word("all"), plain(0)});
  EXPECT_EQ(geometry_face_count(one), 1);
  EXPECT_EQ(geometry_vertex_count(one), 4);
  EXPECT_NEAR(geometry_area(one), 50, 1e-9);
  const Shape house =
      after(after(initial_shape(two), "extrude", {plain(3)}), "cleanupGeometry", {word("all"), plain(0)});
  EXPECT_EQ(geometry_face_count(house), 6);
  expect_sound(house, true);
  // Nearly straight corners go at a tolerance of 10 degrees.
  Shape bent = lot({{0, 0}, {5, 0.2}, {10, 0}, {10, -20}, {0, -20}});
  EXPECT_EQ(geometry_vertex_count(after(bent, "cleanupGeometry", {word("all"), plain(0)})), 5);
  EXPECT_EQ(geometry_vertex_count(after(bent, "cleanupGeometry", {word("vertices"), plain(1)})), 4);
  EXPECT_NE(error_of(bent, "cleanupGeometry", {word("some"), plain(1)}), "");
}

TEST(MeshOperations, Rectify) {
  const Shape crooked = lot({{0, 0}, {10, 0}, {10.3, -20.2}, {0, -20}});
  EXPECT_FALSE(geometry_is_rectangular(crooked, 0.1));
  EXPECT_TRUE(geometry_is_rectangular(after(crooked, "rectify", {plain(5)}), 0.001));
  EXPECT_FALSE(geometry_is_rectangular(after(crooked, "rectify", {plain(0.1)}), 0.1));
}

TEST(MeshOperations, Footprint) {
  const Shape house = after(u_shape(), "extrude", {plain(4)});
  const Shape print = after(house, "footprint");
  EXPECT_NEAR(geometry_area(print), 300, 1e-6);
  EXPECT_EQ(geometry_face_count(print), 1);
  EXPECT_EQ(print.size.y, 0);
  const Shape wall = taken(house, ComponentKind::faces, {"front"})[0].at(0);
  EXPECT_FALSE(after(wall, "alignScopeToAxes").mesh == nullptr);
}

TEST(MeshOperations, Taper) {
  const Shape x = after(rectangle(10, 20), "taper", {plain(6)});
  expect_sound(x, true);
  EXPECT_NEAR(volume(x), 400, 1e-9);
  EXPECT_EQ(x.size, (Vector3{10, 6, 20}));
  EXPECT_TRUE(geometry_is_tagged(x, "taper.side"));
  expect_sound(after(l_shape(), "taper", {plain(-2)}), true);
}

TEST(MeshCut, ConcaveFaceFallsIntoThree) {
  // A comb with three teeth, cut across the teeth.
  const Shape comb =
      lot({{0, 0}, {2, 0}, {2, -4}, {4, -4}, {4, 0}, {6, 0}, {6, -4}, {8, -4}, {8, 0}, {10, 0}, {10, -6}, {0, -6}});
  Mesh mesh = mesh_of(comb);
  EXPECT_TRUE(cut_mesh(mesh, {{0, 0, 1}, 4}, false));  // keeps the front 2 m
  EXPECT_EQ(mesh.faces.size(), 3u);
  double area = 0;
  for (const MeshFace& face : mesh.faces) area += face_area(mesh, face);
  EXPECT_NEAR(area, 12, 1e-9);
  // Exactly along the roots of the teeth, from both sides.
  mesh = mesh_of(comb);
  cut_mesh(mesh, {{0, 0, 1}, 2}, false);
  EXPECT_EQ(mesh.faces.size(), 3u);
  mesh = mesh_of(comb);
  cut_mesh(mesh, {{0, 0, -1}, -2}, false);
  EXPECT_EQ(mesh.faces.size(), 1u);
  EXPECT_NEAR(face_area(mesh, mesh.faces[0]), 20, 1e-9);
}

TEST(MeshCut, PlanesInAnyDirectionKeepVolume) {
  std::mt19937 random(3);
  const auto number = [&] { return (random() % 20001) / 10000.0 - 1; };
  const Shape house = after(u_shape(), "extrude", {plain(7)});
  for (int i = 0; i < 500; ++i) {
    const Vector3 normal = normalized({number(), number(), number()});
    if (normal == Vector3{}) continue;
    const double at = dot(normal, house.size * 0.5) + number() * 4;
    Mesh a = mesh_of(house), b = mesh_of(house);
    cut_mesh(a, {normal, at}, true);
    cut_mesh(b, {-normal, -at}, true);
    EXPECT_NEAR(signed_volume(a) + signed_volume(b), 2100, 1e-6);
    EXPECT_TRUE(a.faces.empty() || is_closed(a));
    EXPECT_TRUE(b.faces.empty() || is_closed(b));
  }
}

}  // namespace
}  // namespace blockrand::grammar
