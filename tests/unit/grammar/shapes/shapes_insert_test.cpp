#include "styles/grammar/shapes/insert.h"
#include "tests/unit/grammar/shapes/shapes_support.h"

namespace blockrand::grammar {
namespace {

Mesh asset() {  // 3 x 6 x 2 with its lowest corner at (1, 1, 1)
  Mesh mesh = cube_mesh();
  for (Vector3& p : mesh.vertices) p = {1 + 3 * p.x, 1 + 6 * p.y, 1 + 2 * p.z};
  return mesh;
}

TEST(Insert, SizeRules) {  // docs/rule_language.md §7.4, 34
  const Shape start = rectangle(10, 20);
  const auto inserted = [&](double a, double b, double c) {
    Shape x = after(start, "s", {plain(a), plain(b), plain(c)});
    const Vector3 before = x.scope.origin;
    insert_asset(x, asset());
    expect_sound(x, true);
    return std::pair(x.size, x.scope.origin - before);
  };
  EXPECT_EQ(inserted(0, 0, 0), (std::pair(Vector3{3, 6, 2}, Vector3{1, 1, 1})));
  EXPECT_EQ(inserted(0, 12, 0), (std::pair(Vector3{6, 12, 4}, Vector3{2, 0, 2})));
  EXPECT_EQ(inserted(9, 9, 0), (std::pair(Vector3{9, 9, 4.5}, Vector3{0, 0, 0})));
  EXPECT_EQ(inserted(1, 2, 3), (std::pair(Vector3{1, 2, 3}, Vector3{0, 0, 0})));
}

TEST(Insert, PlaceholderBox) {
  Shape x = rectangle(10, 20);
  run(x, "s", {plain(2), plain(3), plain(1)});
  run(x, "i", {text_of("assets/Windows/window 01.obj")});
  EXPECT_EQ(x.mesh->asset, "window 01");
  EXPECT_NEAR(volume(x), 6, 1e-9);
  run(x, "i", {text_of("builtin:cube")});
  EXPECT_EQ(x.mesh->asset, "");
  run(x, "s", {plain(0), plain(0), plain(0)});
  run(x, "i", {text_of("a.obj"), word("yUp")});
  EXPECT_EQ(x.size, (Vector3{1, 1, 1}));
  EXPECT_NE(error_of(x, "i", {plain(1)}), "");
  EXPECT_NE(error_of(x, "i", {text_of("a.obj"), word("sideways")}), "");
}

TEST(Insert, PrimitivesFitTheScope) {
  Shape x = after(rectangle(10, 20), "extrude", {plain(5)});
  for (const char* name : {"primitiveCube", "primitiveCylinder", "primitiveCone", "primitiveSphere"}) {
    Shape y = after(x, name);
    expect_sound(y, true);
    EXPECT_EQ(y.size, x.size) << name;
    EXPECT_TRUE(geometry_has_uvs(y, 0)) << name;
    Box box = box_of(mesh_of(y));
    EXPECT_NEAR(box.extent().y, 5, 1e-9) << name;
  }
  EXPECT_NEAR(volume(after(x, "primitiveCube")), 1000, 1e-9);
  EXPECT_NEAR(volume(after(x, "primitiveCylinder", {plain(4)})), 500, 1e-9);
  EXPECT_NEAR(volume(after(x, "primitiveCone", {plain(4)})), 500 / 3.0, 1e-9);
  EXPECT_NEAR(geometry_area(after(x, "primitiveQuad")), 200, 1e-9);
  EXPECT_NEAR(geometry_area(after(x, "primitiveDisk", {plain(4)})), 100, 1e-9);
}

TEST(Insert, PrimitivesWithSizesStandInTheMiddle) {
  Shape x = rectangle(10, 20);
  run(x, "primitiveCube", {plain(2), plain(3), plain(4)});
  EXPECT_EQ(x.size, (Vector3{2, 3, 4}));
  EXPECT_EQ(x.scope.origin, (Vector3{-1, 0, -22}));
  Shape y = after(rectangle(10, 20), "primitiveCylinder", {plain(32), plain(2), plain(3)});
  EXPECT_NEAR(y.size.x, 4, 1e-9);
  EXPECT_NEAR(y.size.y, 3, 1e-9);
  expect_sound(y, true);
  expect_sound(after(rectangle(10, 20), "primitiveSphere", {plain(8), plain(6), plain(2)}), true);
  EXPECT_NEAR(geometry_area(after(rectangle(10, 20), "primitiveQuad", {plain(2), plain(3)})), 6, 1e-9);
}

TEST(Trim, BoxesAreCutAtTheCornersOfTheHouse) {  // 36
  const Shape house = after(rectangle(10, 10), "extrude", {plain(10)});
  Shape f = taken(house, ComponentKind::faces, {"front"})[0].at(0);
  ASSERT_TRUE(f.trim_planes);
  EXPECT_EQ(f.trim_planes->size(), 4u);
  const auto grown = [&](bool trimmed) {
    Shape x = f;
    EXPECT_TRUE(set_attribute(x, "trim.vertical", trimmed));
    run(x, "s", {plain(15), relative(1), plain(2)});
    const std::vector<Argument> axes{word("xyz")};
    EXPECT_TRUE(find_operation("center")->run(x, {f, f}, axes));
    run(x, "primitiveCube");
    return x;
  };
  EXPECT_NEAR(volume(grown(true)), 200, 1e-6);
  expect_sound(grown(true), true);
  EXPECT_NEAR(volume(grown(false)), 300, 1e-6);
}

TEST(Trim, HorizontalPlanesWhenAsked) {
  const Shape house = after(rectangle(10, 10), "extrude", {plain(10)});
  Shape f = taken(house, ComponentKind::faces, {"front"})[0].at(0);
  ASSERT_TRUE(set_attribute(f, "trim.horizontal", true));
  ASSERT_TRUE(set_attribute(f, "trim.vertical", false));
  Shape x = f;
  run(x, "s", {relative(1), plain(14), plain(2)});
  const std::vector<Argument> axes{word("xyz")};
  ASSERT_TRUE(find_operation("center")->run(x, {f, f}, axes));
  run(x, "primitiveCube");
  EXPECT_NEAR(volume(x), 200, 1e-6);
}

}  // namespace
}  // namespace blockrand::grammar
