#include "tests/unit/grammar/shapes/shapes_support.h"

namespace blockrand::grammar {
namespace {

Shape cube() {
  Shape x = rectangle(10, 10);
  run(x, "primitiveCube");
  return x;
}

TEST(Extrude, MakesAClosedPrism) {  // docs/rule_language.md §7.4, 2
  const Shape house = after(rectangle(10, 20), "extrude", {plain(5)});
  EXPECT_EQ(house.size, (Vector3{10, 5, 20}));
  EXPECT_EQ(geometry_face_count(house), 6);
  EXPECT_EQ(geometry_vertex_count(house), 8);
  EXPECT_EQ(geometry_edge_count(house), 12);
  EXPECT_NEAR(geometry_area(house), 700, 1e-9);
  EXPECT_NEAR(geometry_volume(house), 1000, 1e-9);
  expect_sound(house, true);
  EXPECT_TRUE(geometry_is_tagged(house, "extrude.top"));
  EXPECT_TRUE(geometry_is_tagged(house, "extrude.side"));
}

TEST(Extrude, WallOutwards) {
  Shape wall = taken(after(rectangle(10, 20), "extrude", {plain(5)}), ComponentKind::faces, {"front"})[0].at(0);
  run(wall, "extrude", {plain(0.5)});
  EXPECT_NEAR(wall.size.x, 10, 1e-12);
  EXPECT_NEAR(wall.size.y, 0.5, 1e-12);
  EXPECT_NEAR(wall.size.z, 5, 1e-12);
  expect_sound(wall, true);
  EXPECT_NEAR(volume(wall), 25, 1e-9);
}

TEST(Extrude, FlatTop) {  // 33
  const Shape lot = initial_shape({{0, 0, 0}, {10, 0, 0}, {10, 2, -10}, {0, 2, -10}});
  for (const auto& [height, top] : {std::pair{10.0, 10.0}, {0.0, 2.0}, {-10.0, -8.0}}) {
    const Shape body = after(lot, "extrude", {word("world.up.flatTop"), plain(height)});
    const Mesh& mesh = mesh_of(body);
    double found = 1e9;
    for (const MeshFace& face : mesh.faces) {
      const Vector3 n = turn(scope_in_world(body), face_normal(mesh, face));
      if (std::fabs(n.y) > 0.999) found = place(scope_in_world(body), face_middle(mesh, face)).y;
    }
    EXPECT_NEAR(found, top, 1e-9);
    expect_sound(body, true);
  }
}

TEST(Extrude, WorldUpOnASlope) {
  const Shape lot = initial_shape({{0, 0, 0}, {10, 0, 0}, {10, 2, -10}, {0, 2, -10}});
  const Shape body = after(lot, "extrude", {word("world.y"), plain(3)});
  expect_sound(body, true);
  EXPECT_NEAR(volume(body), 300, 1e-9);
  EXPECT_NEAR(body.size.y, 5, 1e-9);
}

TEST(Extrude, SharedWallsVanishInOnePlane) {
  const std::vector<InitialPolygon> two{{{{0, 0, 0}, {5, 0, 0}, {5, 0, -5}, {0, 0, -5}}, {}},
                                        {{{5, 0, 0}, {10, 0, 0}, {10, 0, -5}, {5, 0, -5}}, {}}};
  const Shape body = after(initial_shape(two), "extrude", {plain(2)});
  EXPECT_EQ(geometry_face_count(body), 10);
  expect_sound(body, true);
  EXPECT_NEAR(volume(body), 100, 1e-9);
}

TEST(Extrude, VertexNormalsMoveThePlanes) {
  Shape shell = after(rectangle(10, 10), "extrude", {plain(10)});
  const ComponentSplit faces = components(shell, ComponentKind::faces);
  std::vector<std::size_t> walls;
  for (std::size_t i = 0; i < faces.items.size(); ++i)
    if (selected(faces, i, *selector_of_word("side"))) walls.push_back(i);
  Shape body = *component_group(faces, walls);
  run(body, "extrude", {word("vertex.normal"), plain(1)});
  expect_sound(body, true);
  EXPECT_NEAR(volume(body), (144 - 100) * 10, 1e-6);
}

TEST(Components, TopBottomAndSides) {  // 19
  const auto parts =
      taken(after(rectangle(10, 20), "extrude", {plain(5)}), ComponentKind::faces, {"side", "top", "bottom"});
  EXPECT_EQ(parts[0].size(), 4u);
  EXPECT_EQ(parts[1].size(), 1u);
  EXPECT_EQ(parts[2].size(), 1u);
}

TEST(Components, OneSelectorAfterTheOther) {  // 20
  const auto parts = taken(cube(), ComponentKind::faces, {"front", "side", "all"});
  EXPECT_EQ(parts[0].size(), 1u);
  EXPECT_EQ(parts[1].size(), 3u);
  EXPECT_EQ(parts[2].size(), 2u);
}

TEST(Components, FrontFaceStandsInItsOwnFrame) {  // 21
  const Shape front = taken(after(rectangle(10, 20), "extrude", {plain(5)}), ComponentKind::faces, {"front"})[0].at(0);
  EXPECT_EQ(front.size, (Vector3{10, 5, 0}));
  const Frame frame = scope_in_world(front);
  EXPECT_EQ(frame.axes[0], (Vector3{1, 0, 0}));
  EXPECT_EQ(frame.axes[2], (Vector3{0, 0, 1}));
  EXPECT_EQ(frame.origin, (Vector3{0, 0, 0}));
  EXPECT_EQ(front.scope.origin, (Vector3{}));
}

TEST(Components, CountsByKind) {  // 22
  EXPECT_EQ(components(cube(), ComponentKind::edges).items.size(), 12u);
  EXPECT_EQ(components(cube(), ComponentKind::face_edges).items.size(), 24u);
  EXPECT_EQ(components(cube(), ComponentKind::vertices).items.size(), 8u);
  EXPECT_EQ(components(cube(), ComponentKind::faces).items.size(), 6u);
  EXPECT_EQ(components(cube(), ComponentKind::face_vertices).items.size(), 24u);
  EXPECT_EQ(components(cube(), ComponentKind::groups).items.size(), 1u);
  EXPECT_EQ(components(cube(), ComponentKind::materials).items.size(), 1u);
  EXPECT_EQ(components(cube(), ComponentKind::holes).items.size(), 0u);
}

TEST(Components, GroupsAndConnectedSets) {  // 23
  const Shape house = after(u_shape(), "extrude", {plain(4)});
  const ComponentSplit parts = components(house, ComponentKind::faces);
  const Selector front = *selector_of_word("front");
  std::vector<std::size_t> fronts, others;
  for (std::size_t i = 0; i < parts.items.size(); ++i) (selected(parts, i, front) ? fronts : others).push_back(i);
  EXPECT_EQ(fronts.size(), 3u);
  EXPECT_EQ(connected_sets(parts, fronts).size(), 3u);
  EXPECT_EQ(connected_sets(parts, others).size(), 1u);
  const Shape all_fronts = *component_group(parts, fronts);
  EXPECT_EQ(geometry_face_count(all_fronts), 3);
  EXPECT_EQ(all_fronts.size, (Vector3{20, 4, 10}));
  EXPECT_EQ(geometry_face_count(*component_group(parts, others)), 7);
  EXPECT_FALSE(component_group(parts, {}).has_value());
}

TEST(Components, EdgesAndVerticesHaveNoArea) {
  const ComponentSplit edges = components(cube(), ComponentKind::edges);
  for (std::size_t i = 0; i < edges.items.size(); ++i) {
    const Shape edge = component_shape(edges, i);
    EXPECT_NEAR(edge.size.x, 10, 1e-9);
    EXPECT_EQ(edge.size.y, 0);
    EXPECT_EQ(edge.size.z, 0);
    // z looks out of the cube, half way between its faces.
    const Vector3 z = scope_in_object(edge).axes[2];
    EXPECT_NEAR(std::max({std::fabs(z.x), std::fabs(z.y), std::fabs(z.z)}), std::sqrt(0.5), 1e-9);
  }
  const ComponentSplit corners = components(cube(), ComponentKind::vertices);
  EXPECT_EQ(component_shape(corners, 0).size, (Vector3{}));
}

TEST(Components, NoAlignKeepsThePivot) {
  const Shape house = after(rectangle(10, 20), "extrude", {plain(5)});
  const ComponentSplit parts = components(house, ComponentKind::faces, ComponentAlignment::none);
  for (std::size_t i = 0; i < parts.items.size(); ++i) {
    const Shape face = component_shape(parts, i);
    EXPECT_EQ(face.pivot.axes, house.pivot.axes);
    expect_sound(face, false);
  }
}

TEST(Components, HolesComeOutAsFaces) {
  const std::vector<InitialPolygon> polygon{
      {{{0, 0, 0}, {10, 0, 0}, {10, 0, -10}, {0, 0, -10}}, {{{3, 0, -3}, {7, 0, -3}, {7, 0, -7}, {3, 0, -7}}}}};
  const ComponentSplit holes = components(initial_shape(polygon), ComponentKind::holes);
  ASSERT_EQ(holes.items.size(), 1u);
  const Shape hole = component_shape(holes, 0);
  EXPECT_NEAR(geometry_area(hole), 16, 1e-9);
  EXPECT_GT(area_vector(mesh_of(hole), mesh_of(hole).faces[0]).z, 0);
}

TEST(Selectors, FramesAndSlopes) {
  // x of the object is north.
  const Shape lot = initial_shape({{5, 2, 0}, {5, 2, -8}, {1, 2, -8}, {1, 2, 0}});
  const Shape house = after(lot, "extrude", {plain(3)});
  const auto parts = taken(house, ComponentKind::faces,
                           {"world.east", "object.right", "world.side", "object.side", "world.up", "all"});
  EXPECT_EQ(parts[0].size(), 1u);
  EXPECT_NEAR(parts[0][0].size.x, 8, 1e-9);  // the front edge of 8 m looks east
  EXPECT_EQ(parts[1].size(), 1u);
  EXPECT_EQ(parts[2].size(), 2u);
  EXPECT_EQ(parts[3].size(), 0u);
  EXPECT_EQ(parts[4].size(), 1u);
  EXPECT_EQ(parts[5].size(), 1u);
  EXPECT_FALSE(selector_of_word("world.top"));
  EXPECT_FALSE(selector_of_word("fronts"));
}

TEST(Selectors, IndexAndBorder) {
  const ComponentSplit parts = components(cube(), ComponentKind::faces);
  EXPECT_TRUE(selected(parts, 2, selector_of_index(2)));
  EXPECT_FALSE(selected(parts, 3, selector_of_index(2)));
  EXPECT_TRUE(selected(parts, 5, selector_of_index(-1)));
  EXPECT_TRUE(selected(parts, 0, *selector_of_word("inside")));
  const ComponentSplit lot = components(rectangle(3, 3), ComponentKind::face_edges);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(selected(lot, i, *selector_of_word("border")));
  int front = 0;
  for (std::size_t i = 0; i < 4; ++i) front += selected(lot, i, *selector_of_word("front")) ? 1 : 0;
  EXPECT_EQ(front, 1);
}

TEST(Selectors, StreetSides) {
  std::vector<InitialPolygon> polygon{{{{0, 0, 0}, {10, 0, 0}, {10, 0, -20}, {0, 0, -20}}, {}}};
  Shape house = after(initial_shape(polygon, {0, 12, 0, 6}), "extrude", {plain(3)});
  const auto parts = taken(house, ComponentKind::faces, {"street.front", "street.side", "street.left", "all"});
  ASSERT_EQ(parts[0].size(), 1u);
  EXPECT_EQ(scope_in_world(parts[0][0]).axes[2], (Vector3{1, 0, 0}));  // the widest street is in the east
  ASSERT_EQ(parts[1].size(), 1u);
  EXPECT_EQ(scope_in_world(parts[1][0]).axes[2], (Vector3{-1, 0, 0}));
  ASSERT_EQ(parts[2].size(), 1u);
  EXPECT_EQ(scope_in_world(parts[2][0]).axes[2], (Vector3{0, 0, 1}));
  // Not known: as object.*
  EXPECT_EQ(taken(after(rectangle(10, 20), "extrude", {plain(3)}), ComponentKind::faces, {"street.front"})[0].size(),
            1u);
}

TEST(Selectors, Tags) {
  EXPECT_TRUE(tag_matches("roof", "roof.bottom"));
  EXPECT_TRUE(tag_matches("roof.?", "roof.bottom"));
  EXPECT_TRUE(tag_matches("*.bottom", "extrude.deep.bottom"));
  EXPECT_FALSE(tag_matches("roof.top", "roof.bottom"));
  EXPECT_FALSE(tag_matches("roof.bottom.x", "roof.bottom"));
  const ComponentSplit parts = components(after(rectangle(10, 20), "extrude", {plain(5)}), ComponentKind::faces);
  int sides = 0;
  for (std::size_t i = 0; i < parts.items.size(); ++i)
    sides += selected(parts, i, selector_of_tag("extrude.side.outer")) ? 1 : 0;
  EXPECT_EQ(sides, 4);
}

TEST(Measures, AreasBySelector) {  // 42
  const Shape house = after(rectangle(10, 20), "extrude", {plain(30)});
  const auto walls = taken(house, ComponentKind::faces, {"side"})[0];
  double sum = 0;
  for (const Shape& wall : walls) sum += geometry_area(wall);
  EXPECT_NEAR(sum, 1800, 1e-9);
  EXPECT_NEAR(*geometry_area(house, "side"), 1800, 1e-9);
  EXPECT_NEAR(*geometry_area(house, "top"), 200, 1e-9);
  EXPECT_NEAR(*geometry_area(house, "world.south"), 300, 1e-9);
  EXPECT_FALSE(geometry_area(house, "nonsense"));
  EXPECT_NEAR(geometry_height(house), 30, 1e-9);
  EXPECT_TRUE(geometry_is_closed(house));
  EXPECT_FALSE(geometry_is_closed(walls[0]));
  EXPECT_TRUE(geometry_is_rectangular(house, 1));
  EXPECT_FALSE(geometry_is_rectangular(triangle(), 1));
  EXPECT_TRUE(geometry_is_concave(l_shape()));
  EXPECT_FALSE(geometry_is_concave(house));
  EXPECT_TRUE(geometry_is_planar(house, 0));
  EXPECT_NEAR(geometry_boundary_length(rectangle(10, 20)), 60, 1e-9);
  EXPECT_EQ(geometry_boundary_length(house), 0);
  EXPECT_EQ(geometry_is_oriented(house, "top"), true);
  EXPECT_EQ(geometry_is_oriented(walls[0], "world.up"), false);
  EXPECT_NEAR(*geometry_angle(taken(house, ComponentKind::faces, {"world.east"})[0].at(0), "azimuth"), 90, 1e-9);
  EXPECT_NEAR(*geometry_angle(house, "maxSlope"), 90, 1e-9);
}

}  // namespace
}  // namespace blockrand::grammar
