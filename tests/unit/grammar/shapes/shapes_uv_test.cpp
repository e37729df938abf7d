#include <set>

#include "styles/grammar/shapes/pieces.h"
#include "tests/unit/grammar/shapes/shapes_support.h"

namespace blockrand::grammar {
namespace {

Shape facade() {
  return taken(after(rectangle(10, 20), "extrude", {plain(6)}), ComponentKind::faces, {"right"})[0].at(0);  // 20 x 6
}

TEST(Uv, ProjectionTilesAFacade) {
  Shape wall = facade();
  run(wall, "setupProjection", {plain(0), word("scope.xy"), plain(4), plain(3)});
  EXPECT_FALSE(geometry_has_uvs(wall, 0));
  run(wall, "projectUV", {plain(0)});
  EXPECT_NEAR(geometry_uv_extent(wall, false, false, 0), 5, 1e-9);
  EXPECT_NEAR(geometry_uv_extent(wall, true, false, 0), 2, 1e-9);
  EXPECT_NEAR(geometry_uv_extent(wall, false, true, 0), 20, 1e-9);
  EXPECT_NEAR(geometry_uv_extent(wall, true, true, 0), 6, 1e-9);
  EXPECT_NEAR(geometry_uv_minimum(wall, false, 0), 0, 1e-9);
  EXPECT_NEAR(geometry_uv_maximum(wall, true, 0), 2, 1e-9);
}

TEST(Uv, FloatingRelativeAndNegativeTiles) {
  Shape wall = facade();
  run(wall, "setupProjection", {plain(2), word("scope.xy"), floating(3), relative(0.5)});
  run(wall, "projectUV", {plain(2)});
  EXPECT_NEAR(geometry_uv_extent(wall, false, false, 2), 7, 1e-9);  // 20 / 3 is nearest to 7 tiles
  EXPECT_NEAR(geometry_uv_extent(wall, true, false, 2), 2, 1e-9);
  run(wall, "setupProjection", {plain(2), word("scope.xy"), plain(-4), plain(3), plain(2), plain(1.5)});
  run(wall, "projectUV", {plain(2)});
  EXPECT_NEAR(geometry_uv_minimum(wall, false, 2), -5.5, 1e-9);
  EXPECT_NEAR(geometry_uv_maximum(wall, false, 2), -0.5, 1e-9);
  EXPECT_NEAR(geometry_uv_minimum(wall, true, 2), 0.5, 1e-9);
  EXPECT_NE(error_of(facade(), "projectUV", {plain(1)}), "");
  EXPECT_NE(error_of(facade(), "setupProjection", {plain(10), word("scope.xy"), plain(1), plain(1)}), "");
  EXPECT_NE(error_of(facade(), "setupProjection", {plain(0), word("scope.xx"), plain(1), plain(1)}), "");
}

TEST(Uv, ProjectionIsInheritedWithoutSeams) {
  Shape wall = facade();
  run(wall, "setupProjection", {plain(0), word("scope.xy"), plain(1), plain(1)});
  const auto pieces = split(wall, 0, {item('A', 7), item('B', 1, Mark::floating)});
  Shape right = pieces[1];
  run(right, "projectUV", {plain(0)});
  EXPECT_NEAR(geometry_uv_minimum(right, false, 0), 7, 1e-9);
  EXPECT_NEAR(geometry_uv_maximum(right, false, 0), 20, 1e-9);
}

TEST(Uv, WorldProjection) {
  Shape wall = facade();
  run(wall, "setupProjection", {plain(0), word("world.xz"), plain(1), plain(1)});
  run(wall, "projectUV", {plain(0)});
  EXPECT_NEAR(geometry_uv_minimum(wall, false, 0), 10, 1e-9);
  EXPECT_NEAR(geometry_uv_minimum(wall, true, 0), -20, 1e-9);
}

TEST(Uv, Edits) {
  Shape wall = facade();
  run(wall, "setupProjection", {plain(0), word("scope.xy"), plain(4), plain(3)});
  run(wall, "projectUV", {plain(0)});
  EXPECT_NEAR(geometry_uv_extent(after(wall, "scaleUV", {plain(0), plain(2), plain(0.5)}), false, false, 0), 10, 1e-9);
  EXPECT_NEAR(geometry_uv_minimum(after(wall, "translateUV", {plain(0), plain(0.25), plain(3)}), false, 0), 0.25, 1e-9);
  EXPECT_NEAR(geometry_uv_minimum(after(wall, "offsetUV", {plain(0), plain(0.25), plain(3)}), true, 0), 3, 1e-9);
  const Shape turned = after(wall, "rotateUV", {plain(0), plain(90)});
  EXPECT_NEAR(geometry_uv_extent(turned, true, false, 0), 5, 1e-9);
  EXPECT_NEAR(geometry_uv_minimum(turned, false, 0), -2, 1e-9);
  const Shape unit = after(wall, "normalizeUV", {plain(0), word("uv"), word("collectiveAllFaces")});
  EXPECT_NEAR(geometry_uv_extent(unit, false, false, 0), 1, 1e-9);
  EXPECT_NEAR(geometry_uv_extent(unit, true, false, 0), 1, 1e-9);
  EXPECT_NEAR(geometry_uv_extent(after(wall, "normalizeUV", {plain(0), word("uvUniform"), word("separatePerFace")}),
                                 true, false, 0),
              0.4, 1e-9);
  EXPECT_NEAR(geometry_uv_extent(after(wall, "tileUV", {plain(0), plain(2), plain(0)}), false, false, 0), 10, 1e-9);
  EXPECT_NEAR(geometry_uv_extent(after(wall, "tileUV", {plain(0), floating(6), plain(0)}), false, false, 0), 3, 1e-9);
  const Shape copied = after(wall, "copyUV", {plain(0), plain(5)});
  EXPECT_NEAR(geometry_uv_extent(copied, false, false, 5), 5, 1e-9);
  EXPECT_FALSE(geometry_has_uvs(after(copied, "deleteUV", {plain(0)}), 0));
  EXPECT_TRUE(geometry_has_uvs(after(copied, "deleteUV", {plain(0)}), 5));
}

TEST(Uv, SurviveExtrusionReversalAndCleaning) {
  Shape wall = facade();
  run(wall, "setupProjection", {plain(0), word("scope.xy"), plain(4), plain(3)});
  run(wall, "projectUV", {plain(0)});
  for (const char* name : {"reverseNormals", "convexify"}) expect_sound(after(wall, name), false);
  expect_sound(after(wall, "extrude", {plain(0.3)}), true);
  expect_sound(after(wall, "cleanupGeometry", {word("all"), plain(0.1)}), false);
  const Shape back = after(after(wall, "reverseNormals"), "reverseNormals");
  EXPECT_EQ(back.mesh->uv[0], wall.mesh->uv[0]);
}

TEST(SplitUv, CutsAlongTheTexture) {
  Shape wall = facade();
  run(wall, "setupProjection", {plain(1), word("scope.xy"), plain(4), plain(3)});
  run(wall, "projectUV", {plain(1)});
  const auto range = uv_range(wall, false, true, 1);
  ASSERT_TRUE(range);
  EXPECT_NEAR(range->length(), 20, 1e-9);
  const auto sizes =
      split_sizes(std::vector<SplitItem>{item('A', 5), item('B', 1, Mark::floating)}, false, range->length());
  const auto pieces = split_uv(wall, false, 1, *range, sizes);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_NEAR(geometry_area(pieces[0]), 30, 1e-9);
  EXPECT_NEAR(geometry_area(pieces[1]), 90, 1e-9);
  EXPECT_NEAR(pieces[1].size.x, 15, 1e-9);
  EXPECT_NEAR(geometry_uv_minimum(pieces[1], false, 1), 1.25, 1e-9);
  for (const Shape& piece : pieces) expect_sound(piece, false);
  const auto units = uv_range(wall, true, false, 1);
  EXPECT_NEAR(units->length(), 2, 1e-9);
  EXPECT_FALSE(uv_range(wall, false, false, 0));
  EXPECT_FALSE(uv_range(wall, false, false, 11));
}

TEST(SplitUv, ACylinderByItsTurn) {
  const Shape round = after(after(rectangle(4, 4), "extrude", {plain(3)}), "primitiveCylinder", {plain(16)});
  const ComponentSplit faces = components(round, ComponentKind::faces);
  std::vector<std::size_t> sides;
  for (std::size_t i = 0; i < 16; ++i) sides.push_back(i);
  const Shape hull = *component_group(faces, sides);
  const auto range = uv_range(hull, false, false, 0);
  const auto sizes = split_sizes(std::vector<SplitItem>{item('A', 0.25, Mark::relative)}, true, range->length());
  const auto quarters = split_uv(hull, false, 0, *range, sizes);
  ASSERT_EQ(quarters.size(), 4u);
  double sum = 0;
  for (const Shape& q : quarters) {
    EXPECT_EQ(geometry_face_count(q), 4);
    sum += geometry_area(q);
  }
  EXPECT_NEAR(sum, geometry_area(hull), 1e-9);
}

TEST(Scatter, OnInAndAround) {
  Shape lot = u_shape();
  lot.seed = 5;
  const auto points = scatter(lot, ScatterDomain::surface, 500, ScatterDistribution::uniform, "center", {});
  ASSERT_EQ(points.size(), 500u);
  for (const Shape& p : points) {
    const Vector3 at = place(scope_in_world(p), {});
    EXPECT_FALSE(at.x > 5 && at.x < 15 && at.z > -10);  // not in the yard
    EXPECT_EQ(p.size, (Vector3{}));
    EXPECT_FALSE(p.mesh);
  }
  const auto again = scatter(lot, ScatterDomain::surface, 500, ScatterDistribution::uniform, "center", {});
  EXPECT_EQ(points[7].scope.origin, again[7].scope.origin);
  lot.seed = 6;
  EXPECT_NE(points[7].scope.origin,
            scatter(lot, ScatterDomain::surface, 8, ScatterDistribution::uniform, "center", {})[7].scope.origin);
  Shape house = after(u_shape(), "extrude", {plain(4)});
  for (const Shape& p : scatter(house, ScatterDomain::volume, 300, ScatterDistribution::uniform, "center", {})) {
    const Vector3 at = place(scope_in_world(p), {});
    EXPECT_FALSE(at.x > 5 && at.x < 15 && at.z > -10);
    EXPECT_TRUE(at.y > 0 && at.y < 4);
  }
  int near = 0;
  for (const Shape& p :
       scatter(rectangle(10, 20), ScatterDomain::scope, 400, ScatterDistribution::gaussian, "left", {1, 1, 3}))
    near += place(scope_in_world(p), {}).x < 2 ? 1 : 0;
  EXPECT_GT(near, 340);
  EXPECT_TRUE(scatter(Shape{}, ScatterDomain::surface, 10, ScatterDistribution::uniform, "center", {}).empty());
}

TEST(Tags, SetQueryAndDelete) {
  Shape house = after(rectangle(10, 20), "extrude", {plain(4)});
  run(house, "tag", {text_of("wing.left")});
  EXPECT_TRUE(geometry_is_tagged(house, "wing"));
  EXPECT_TRUE(geometry_is_tagged(house, "extrude.top"));
  run(house, "deleteTags", {text_of("extrude")});
  EXPECT_FALSE(geometry_is_tagged(house, "extrude"));
  EXPECT_EQ(geometry_tags(house), (std::vector<std::string>{"wing.left"}));
  run(house, "tag", {text_of("edgy"), word("edges")});
  const ComponentSplit edges = components(house, ComponentKind::edges);
  EXPECT_TRUE(selected(edges, 0, selector_of_tag("edgy")));
  run(house, "deleteTags");
  EXPECT_TRUE(geometry_tags(house).empty());
  EXPECT_NE(error_of(house, "tag", {text_of("a"), word("vertices")}), "");
}

TEST(InsertAlongUv, KeepsTheSurfaceUnderTheName) {
  Shape wall = facade();
  run(wall, "insertAlongUV", {plain(0), text_of("streets/lamp.obj"), plain(3)});
  EXPECT_EQ(wall.mesh->asset, "lamp");
  EXPECT_NEAR(geometry_area(wall), 120, 1e-9);
}

TEST(Envelope, StepsBackFromTheStreet) {
  const Shape room = after(rectangle(20, 20), "envelope", {word("normal"), plain(20), plain(10), plain(45)});
  expect_sound(room, true);
  EXPECT_NEAR(room.size.y, 20, 1e-4);
  // Sides and back upright, in front 10 m up and then back at 45 degrees.
  EXPECT_NEAR(volume(room), 20 * (20 * 20 - 50), 1e-2);
  const Shape box = after(rectangle(20, 20), "envelope", {word("world.up"), plain(8), plain(0), plain(90)});
  expect_sound(box, true);
  EXPECT_NEAR(volume(box), 3200, 1e-3);
  const Shape all = after(rectangle(20, 20), "envelope",
                          {word("normal"), plain(5), plain(0), plain(45), plain(0), plain(45), plain(0), plain(45)});
  expect_sound(all, true);
  EXPECT_NEAR(volume(all), 5.0 / 3 * (400 + 100 + 200), 1e-2);
}

}  // namespace
}  // namespace blockrand::grammar
