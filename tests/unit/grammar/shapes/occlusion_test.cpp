// How shapes lie to one another, where faces coincide, edges meet and bodies are not convex.
#include "styles/grammar/shapes/occlusion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/grammar/shapes/shapes_support.h"

namespace blockrand::grammar {
namespace {

/// A box from a corner, sizes along x, y, z (z to the north).
Shape box(double x, double y, double z, double width, double height, double depth) {
  Shape out = after(lot({{x, z}, {x + width, z}, {x + width, z - depth}, {x, z - depth}}), "extrude", {plain(height)});
  run(out, "translate", {word("rel"), word("world"), plain(0), plain(y), plain(0)});
  return out;
}
struct Answer {
  bool inside, overlaps, touches;
  bool operator==(const Answer&) const = default;
};
Answer answer(const Shape& shape, const Shape& other) {
  const Occluder occluder = occluder_of(other);
  const Mesh mesh = mesh_in_world(shape);
  Effort effort;
  return {is_inside(mesh, occluder, effort), overlaps(mesh, occluder, effort), touches(mesh, occluder, effort)};
}
void PrintTo(const Answer& a, std::ostream* out) { *out << a.inside << a.overlaps << a.touches; }

constexpr Answer kNothing{false, false, false}, kContactOnly{false, false, true}, kOver{false, true, true};

TEST(Occlusion, BoxesApartTouchingAndThroughOneAnother) {
  const Shape base = box(0, 0, 0, 4, 4, 4);
  EXPECT_EQ(answer(box(5, 0, 0, 4, 4, 4), base), kNothing);
  EXPECT_EQ(answer(box(4, 0, 0, 4, 4, 4), base), kContactOnly) << "wall against wall";
  EXPECT_EQ(answer(box(4, 1, -1, 1, 1, 1), base), kContactOnly) << "a small one against a large wall";
  EXPECT_EQ(answer(box(4, 4, 0, 4, 4, 4), base), kNothing) << "along an edge alone";
  EXPECT_EQ(answer(box(4, 4, 4, 4, 4, 4), base), kNothing) << "at a corner alone";
  EXPECT_EQ(answer(box(2, 1, -1, 4, 1, 1), base), kOver);
  EXPECT_EQ(answer(box(-1, 1, -1, 6, 1, 1), base), kOver) << "a beam right through";
  EXPECT_EQ(answer(box(1, 1, -1, 1, 1, 1), base), (Answer{true, false, false})) << "in the middle of it";
  EXPECT_EQ(answer(box(0, 0, 0, 4, 4, 4), base), (Answer{true, false, true})) << "the same one";
  EXPECT_EQ(answer(box(-1, -1, 1, 6, 6, 6), base), kOver) << "around it";
}

TEST(Occlusion, FacesAndABodyThatIsNotConvex) {
  Shape u = after(u_shape(), "extrude", {plain(6)});  // the court: x 5 to 15, z 0 to -10
  const auto face = [](double x0, double x1, double y, double z0, double z1) {
    Shape out = lot({{x0, z0}, {x1, z0}, {x1, z1}, {x0, z1}});
    run(out, "translate", {word("rel"), word("world"), plain(0), plain(y), plain(0)});
    return out;
  };
  EXPECT_EQ(answer(face(6, 14, 3, -1, -9), u), kNothing) << "in the court";
  EXPECT_EQ(answer(face(1, 4, 3, -1, -9), u), (Answer{true, false, false}));
  EXPECT_EQ(answer(face(1, 19, 3, -1, -9), u), kOver) << "from wing to wing";
  EXPECT_EQ(answer(face(1, 4, 6, -1, -9), u), (Answer{true, false, true})) << "on the roof, in its plane";
  EXPECT_EQ(answer(face(6, 14, 6, -1, -9), u), kNothing) << "in the roof's plane over the court";
  EXPECT_EQ(answer(face(1, 14, 6, -1, -9), u), kContactOnly) << "half on the roof, half over the court";
}

TEST(Occlusion, OpenShapesHideNothing) {
  EXPECT_EQ(answer(box(0, 0, 0, 1, 1, 1), rectangle(4, 4)), kNothing);
  EXPECT_EQ(answer(Shape(), box(0, 0, 0, 1, 1, 1)), kNothing);
  EXPECT_TRUE(occluder_of(rectangle(4, 4)).mesh.empty());
}

TEST(Occlusion, DistancesOfScopes) {
  const auto distance = [](const Shape& a, const Shape& b) { return box_distance(scope_corners(a), scope_corners(b)); };
  EXPECT_NEAR(distance(box(0, 0, 0, 1, 1, 1), box(4, 0, 0, 1, 1, 1)), 3, 1e-6);
  EXPECT_NEAR(distance(box(0, 0, 0, 1, 1, 1), box(4, 5, 0, 1, 1, 1)), 5, 1e-6) << "edge to edge: 3 and 4";
  EXPECT_EQ(distance(box(0, 0, 0, 4, 4, 4), box(2, 2, -1, 4, 4, 4)), 0);
  EXPECT_EQ(distance(box(0, 0, 0, 4, 4, 4), box(4, 0, 0, 4, 4, 4)), 0);
  Shape turned = box(0, 0, 0, 2, 1, 2);
  run(turned, "r", {word("scopeCenter"), plain(0), plain(45), plain(0)});
  // Its corner points to the other one: half the diagonal from the middle.
  EXPECT_NEAR(distance(turned, box(4, 0, 0, 1, 1, 2)), 3 - std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(distance(rectangle(2, 2), box(0, 3, 0, 2, 1, 2)), 3, 1e-6) << "a scope without height";
}

}  // namespace
}  // namespace blockrand::grammar
