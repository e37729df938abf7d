#include <cmath>

#include "styles/grammar/language/known_names.h"
#include "styles/grammar/shapes/scope.h"
#include "tests/unit/grammar/shapes/shapes_support.h"

namespace blockrand::grammar {
namespace {

void expect_near(Vector3 a, Vector3 b, double tolerance = 1e-9) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(InitialShape, LiesBehindItsFirstEdge) {  // docs/rule_language.md §7.4, 1
  const Shape lot = rectangle(10, 20);
  EXPECT_EQ(lot.size, (Vector3{10, 0, 20}));
  EXPECT_EQ(lot.scope.origin, (Vector3{0, 0, -20}));
  EXPECT_EQ(lot.pivot.origin, (Vector3{}));
  EXPECT_NEAR(geometry_area(lot), 200, 1e-12);
  expect_sound(lot, false);
}

TEST(InitialShape, ObjectFrameFollowsTheFirstEdge) {
  // The first edge runs north: x of the object is north, its z is east (the front).
  const Shape lot = initial_shape({{5, 2, 0}, {5, 2, -8}, {1, 2, -8}, {1, 2, 0}});
  EXPECT_EQ(lot.size, (Vector3{8, 0, 4}));
  const Frame world = scope_in_world(lot);
  expect_near(world.axes[0], {0, 0, -1});
  expect_near(world.axes[2], {1, 0, 0});
  expect_near(world.origin, {1, 2, 0});
  EXPECT_DOUBLE_EQ(scope_elevation(lot), 2);
}

TEST(InitialShape, BadInputIsMended) {
  EXPECT_FALSE(initial_shape(std::vector<Vector3>{}).mesh);
  EXPECT_FALSE(initial_shape({{0, 0, 0}, {1, 0, 0}}).mesh);
  EXPECT_FALSE(initial_shape({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).mesh);
  EXPECT_FALSE(initial_shape({{0, 0, 0}, {std::nan(""), 0, 0}, {2, 0, 0}}).mesh);
  const Shape lot = initial_shape({{0, 0, 0}, {0, 0, 0}, {4, 0, 0}, {4, 0, -3}, {4, 0, -3}, {0, 0, -3}, {0, 0, 0}});
  EXPECT_EQ(geometry_vertex_count(lot), 4);
  EXPECT_EQ(lot.size, (Vector3{4, 0, 3}));
}

TEST(Scope, AnglesAndAxesAgree) {
  for (const Vector3 angles :
       {Vector3{10, 20, 30}, Vector3{-170, 45, 95}, Vector3{0, 90, 0}, Vector3{30, -90, 20}, Vector3{90, 0, 180}}) {
    const auto axes = axes_of_angles(angles);
    const auto again = axes_of_angles(angles_of_axes(axes));
    for (int i = 0; i < 3; ++i) expect_near(axes[i], again[i], 1e-9);
    expect_near(cross(axes[0], axes[1]), axes[2], 1e-12);
  }
  // R[1][0] = cos b sin c, R[2][0] = -sin b (docs/rule_language.md §2.0)
  const auto axes = axes_of_angles({0, 30, 60});
  EXPECT_NEAR(axes[0].y, std::cos(M_PI / 6) * std::sin(M_PI / 3), 1e-12);
  EXPECT_NEAR(axes[0].z, -0.5, 1e-12);
}

TEST(Transformations, TranslateAlongTheScope) {  // 3, 4
  Shape a = rectangle(10, 20);
  const Shape b = after(a, "t", {plain(3), plain(0), plain(0)});
  EXPECT_EQ(b.scope.origin.x - a.scope.origin.x, 3);
  EXPECT_EQ(after(a, "t", {plain(0), plain(5), plain(0)}).scope.origin.y, 5);
  EXPECT_EQ(after(a, "t", {relative(0.5), plain(0), relative(-0.25)}).scope.origin, (Vector3{5, 0, -25}));
  run(a, "r", {plain(0), plain(90), plain(0)});
  run(a, "t", {plain(2), plain(0), plain(0)});
  expect_near(a.scope.origin, {0, 0, -22});
}

TEST(Transformations, TranslateInSystems) {
  const Shape lot = initial_shape({{5, 2, 0}, {5, 2, -8}, {1, 2, -8}, {1, 2, 0}});
  expect_near(
      scope_in_world(after(lot, "translate", {word("rel"), word("world"), plain(1), plain(2), plain(3)})).origin,
      {2, 4, 3});
  expect_near(
      scope_in_world(after(lot, "translate", {word("abs"), word("world"), plain(1), plain(0), plain(3)})).origin,
      {1, 0, 3});
  expect_near(after(lot, "translate", {word("abs"), word("pivot"), plain(1), plain(2), plain(3)}).scope.origin,
              {1, 2, 3});
  EXPECT_NE(error_of(lot, "translate", {word("abs"), word("moon"), plain(1), plain(2), plain(3)}), "");
}

TEST(Transformations, ScaleAndCenter) {  // 35
  Shape x = rectangle(10, 20);
  const Shape base = x;
  run(x, "s", {relative(0.8), relative(1), relative(0.6)});
  const std::vector<Argument> axes{word("xz")};
  ASSERT_TRUE(find_operation("center")->run(x, {base, base}, axes));
  EXPECT_EQ(x.size, (Vector3{8, 0, 12}));
  expect_near(x.scope.origin, {1, 0, -16});
  EXPECT_NEAR(geometry_area(x), 96, 1e-9);
}

TEST(Transformations, ScaleOfZeroAndBelow) {
  Shape house = after(rectangle(10, 20), "extrude", {plain(5)});
  const Shape mirrored = after(house, "s", {relative(1), relative(1), plain(-2)});
  EXPECT_EQ(mirrored.size.z, -2);
  EXPECT_LT(volume(mirrored), 0);  // normals look inwards
  EXPECT_NEAR(geometry_volume(mirrored), 100, 1e-9);
  Shape flat = after(house, "s", {plain(0), plain(0), plain(0)});
  EXPECT_EQ(flat.size, (Vector3{}));
  run(flat, "s", {plain(3), plain(3), plain(3)});  // nothing to stretch: must not become NaN
  for (const Vector3 p : mesh_of(flat).vertices) EXPECT_TRUE(std::isfinite(p.x));
}

TEST(Transformations, RotateAboutTheCenterStays) {
  Shape house = after(rectangle(10, 20), "extrude", {plain(5)});
  const Vector3 before = place(scope_in_world(house), house.size * 0.5);
  run(house, "r", {word("scopeCenter"), plain(10), plain(40), plain(-20)});
  expect_near(place(scope_in_world(house), house.size * 0.5), before);
  run(house, "rotate", {word("abs"), word("world"), plain(0), plain(0), plain(0)});
  expect_near(scope_in_world(house).axes[0], {1, 0, 0});
  run(house, "rotate", {word("rel"), word("pivot"), plain(0), plain(90), plain(0)});
  expect_near(scope_in_world(house).axes[0], {0, 0, -1});
}

TEST(Scope, AlignToAxes) {
  Shape wall = taken(after(rectangle(10, 20), "extrude", {plain(5)}), ComponentKind::faces, {"right"})[0].at(0);
  EXPECT_EQ(wall.size, (Vector3{20, 5, 0}));
  const Vector3 middle = place(scope_in_world(wall), wall.size * 0.5);
  run(wall, "alignScopeToAxes");
  expect_near(wall.size, {0, 5, 20});
  expect_near(scope_in_world(wall).origin, {10, 0, -20});
  expect_near(place(scope_in_world(wall), wall.size * 0.5), middle);
  EXPECT_EQ(wall.scope.origin, (Vector3{}));
  Shape roof = initial_shape({{0, 0, 0}, {4, 0, 0}, {4, 3, -4}, {0, 3, -4}});
  run(roof, "alignScopeToAxes", {word("y")});
  expect_near(roof.size, {4, 3, 4});
  expect_near(scope_in_world(roof).axes[1], {0, 1, 0});
}

TEST(Scope, AlignToGeometry) {
  Shape lot = l_shape();
  run(lot, "alignScopeToGeometry", {word("yUp"), plain(0), word("longest")});
  expect_near(scope_in_world(lot).axes[0], {1, 0, 0});
  run(lot, "alignScopeToGeometry", {word("zUp"), word("largest"), plain(1)});
  expect_near(scope_in_world(lot).axes[2], {0, 1, 0});
  expect_near(scope_in_world(lot).axes[0], {0, 0, -1});
  EXPECT_EQ(lot.size.z, 0);
  run(lot, "alignScopeToGeometry", {word("yUp"), word("auto")});
  EXPECT_EQ(lot.size.y, 0);
  EXPECT_NE(error_of(lot, "alignScopeToGeometry", {word("up"), plain(0)}), "");
}

TEST(Scope, AlignToTheSmallestBox) {
  const double c = std::cos(0.3), s = std::sin(0.3);
  Shape lot = initial_shape({{0, 0, 0}, {1, 0, 0}, {1 + 0, 0, -0.1}, {3 * c, 0, -3 * s - 2}, {0, 0, -2}});
  run(lot, "alignScopeToGeometryBBox", {word("xz")});
  EXPECT_GE(lot.size.x, lot.size.z);
  const double x = lot.size.x;
  run(lot, "alignScopeToGeometryBBox", {word("zx")});
  EXPECT_NEAR(lot.size.z, x, 1e-9);
}

TEST(Scope, RotateScopeLeavesTheGeometry) {
  Shape lot = rectangle(10, 20);
  run(lot, "rotateScope", {plain(-90), plain(0), plain(0)});
  EXPECT_EQ(lot.size.z, 0);
  EXPECT_NEAR(lot.size.x * lot.size.y, 200, 1e-9);
  EXPECT_NEAR(geometry_area(lot), 200, 1e-9);
  const Mesh& mesh = mesh_of(lot);
  expect_near(place(scope_in_world(lot), mesh.vertices[mesh.faces[0].loops[0][1].vertex]), {10, 0, 0});
}

TEST(Scope, SetPivotCorners) {  // 35
  Shape x = after(rectangle(10, 20), "extrude", {plain(5)});
  const Vector3 old_z = scope_in_world(x).axes[2];
  run(x, "setPivot", {word("xyz"), plain(1)});
  EXPECT_EQ(x.size, (Vector3{20, 5, 10}));
  EXPECT_EQ(x.scope.origin, (Vector3{}));
  expect_near(scope_in_world(x).axes[0], old_z);
  for (int corner = 0; corner < 8; ++corner)
    for (const char* map : {"xyz", "yzx", "zxy"}) {
      Shape y = after(after(rectangle(10, 20), "extrude", {plain(5)}), "setPivot", {word(map), plain(corner)});
      expect_sound(y, true);
      const Frame frame = scope_in_world(y);
      expect_near(cross(frame.axes[0], frame.axes[1]), frame.axes[2]);
      EXPECT_NEAR(y.size.x * y.size.y * y.size.z, 1000, 1e-9);
    }
  EXPECT_NE(error_of(x, "setPivot", {word("xyz"), plain(8)}), "");
}

TEST(Scope, Mirrors) {
  Shape t = after(triangle(), "extrude", {plain(2)});
  const Shape m = after(t, "mirror", {plain(1), plain(0), plain(0)});
  expect_sound(m, true);
  EXPECT_NEAR(volume(m), 100, 1e-9);
  EXPECT_NEAR(taken(m, ComponentKind::faces, {"right"})[0].at(0).size.x, 10, 1e-9);  // was left
  const Shape n = after(t, "mirrorScope", {plain(1), plain(0), plain(0)});
  EXPECT_EQ(n.size.x, -10);
  expect_sound(n, true);
  expect_near(place(scope_in_world(n), {n.size.x, 0, 0}), scope_in_world(t).origin);
}

TEST(Scope, ResetGeometry) {
  const Shape start = rectangle(10, 20);
  Shape x = after(start, "extrude", {plain(5)});
  run(x, "color", {text_of("#ff0000")});
  ASSERT_TRUE(find_operation("resetGeometry")->run(x, {x, start}, {}));
  EXPECT_EQ(x.size, start.size);
  EXPECT_EQ(x.mesh, start.mesh);
  EXPECT_EQ(x.material->colour[0], 1);
}

TEST(Attributes, SetAndRead) {
  Shape x = after(rectangle(10, 20), "extrude", {plain(5)});
  EXPECT_EQ(read_attribute(x, "scope.sy"), Value(5.0));
  ASSERT_TRUE(set_attribute(x, "scope.sy", 10.0));
  EXPECT_NEAR(volume(x), 2000, 1e-9);
  ASSERT_TRUE(set_attribute(x, "scope.ry", 30.0));
  EXPECT_NEAR(std::get<double>(*read_attribute(x, "scope.ry")), 30, 1e-9);
  ASSERT_TRUE(set_attribute(x, "scope.tx", 7.0));
  EXPECT_EQ(read_attribute(x, "scope.tx"), Value(7.0));
  ASSERT_TRUE(set_attribute(x, "trim.vertical", false));
  EXPECT_EQ(read_attribute(x, "trim.vertical"), Value(false));
  EXPECT_EQ(read_attribute(x, "trim.horizontal"), Value(false));
  ASSERT_TRUE(set_attribute(x, "material.color.rgb", std::string("#3366ff")));
  EXPECT_NEAR(std::get<double>(*read_attribute(x, "material.color.g")), 0.4, 1e-9);
  EXPECT_EQ(read_attribute(x, "material.color.rgb"), Value(std::string("#3366ff")));
  ASSERT_TRUE(set_attribute(x, "material.dirtmap.su", 3.0));
  EXPECT_EQ(read_attribute(x, "material.dirtmap.su"), Value(3.0));
  EXPECT_EQ(read_attribute(x, "material.dirtmap.sv"), Value(1.0));
  EXPECT_EQ(read_attribute(x, "comp.index"), Value(-1.0));
  x.draws = 4;
  ASSERT_TRUE(set_attribute(x, "seedian", 99.0));
  EXPECT_EQ(x.seed, 99u);
  EXPECT_EQ(x.draws, 0u);
  EXPECT_FALSE(set_attribute(x, "comp.index", 1.0));
  EXPECT_FALSE(set_attribute(x, "material.nonsense", 1.0));
  EXPECT_FALSE(set_attribute(x, "scope.sx", std::string("a")));
  EXPECT_FALSE(read_attribute(x, "scope.qx"));
}

TEST(Attributes, Colours) {
  Shape x = rectangle(1, 1);
  run(x, "color", {text_of("#80ff0040")});
  EXPECT_NEAR(x.material->colour[0], 128 / 255.0, 1e-12);
  EXPECT_NEAR(x.material->colour[3], 64 / 255.0, 1e-12);
  run(x, "color", {plain(2), plain(-1), plain(0.5)});
  EXPECT_EQ(x.material->colour, (std::array<double, 4>{1, 0, 0.5, 1}));
  EXPECT_NE(error_of(x, "color", {text_of("red")}), "");
  run(x, "texture", {text_of("brick.jpg")});
  EXPECT_EQ(x.material->colour_map, "brick.jpg");
  run(x, "resetMaterial");
  EXPECT_FALSE(x.material);
}

/// Operations of the language that run in this folder.
std::vector<OperationEntry> operations() {
  std::vector<OperationEntry> out;
  for (const BuiltIn& known : built_ins())
    if (known.kind == NameKind::operation)
      if (const OperationEntry* entry = find_operation(known.name)) out.push_back(*entry);
  return out;
}

TEST(Operations, AreFoundByName) {
  EXPECT_GT(operations().size(), 50u);
  for (const char* name : {"alignScopeToAxes", "extrude", "trim"}) {
    ASSERT_TRUE(find_operation(name)) << name;
    EXPECT_EQ(find_operation(name)->name, name);
  }
  EXPECT_EQ(find_operation("exturde"), nullptr);
}

TEST(Operations, NothingCrashesOnEmptyAndFlatShapes) {
  std::vector<Shape> shapes{Shape{},
                            initial_shape(std::vector<Vector3>{}),
                            rectangle(10, 20),
                            rectangle(1e-3, 5),
                            after(rectangle(10, 20), "s", {plain(0), plain(0), plain(0)}),
                            after(rectangle(10, 20), "extrude", {plain(3)})};
  const std::vector<Argument> candidates{plain(1),         plain(0),         plain(-1),        plain(std::nan("")),
                                         plain(1e300),     relative(0.5),    word("all"),      word("xyz"),
                                         word("world.up"), word("byHeight"), text_of("x.obj"), word("scope.xy")};
  std::size_t count = 0;
  for (const OperationEntry& entry : operations())
    for (const Shape& shape : shapes)
      for (int n = 0; n <= entry.most; ++n)
        for (std::size_t k = 0; k < candidates.size() * candidates.size(); ++k) {
          std::vector<Argument> arguments;
          for (int i = 0; i < n; ++i)
            arguments.push_back(
                candidates[(i == 0 ? k / candidates.size() : k + static_cast<std::size_t>(i) - 1) % candidates.size()]);
          if (n < entry.least) break;
          error_of(shape, entry.name, arguments);
          ++count;
          if (n == 0) break;
        }
  EXPECT_GT(count, 1000u);
}

}  // namespace
}  // namespace blockrand::grammar
