// Overlaps of solids: by a tolerance, whatever their shapes.
#include "pipeline/geometry/solid_overlap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/triangulate.h"
#include "tests/unit/geometry/broken_solids.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::geometry {
namespace {

using model::Point3;
using model::Solid;

const Point3 kFar{391000, 5819000, 34};
constexpr double kStep = 1.0 / 1024;

Point3 at(double x, double y, double z) { return {kFar.x + x, kFar.y + y, kFar.z + z}; }

struct Mesh {
  Solid solid;
  model::SolidTriangles triangles;
  explicit Mesh(Solid s) : solid(std::move(s)), triangles(*triangulate(solid)) {}
  ClosedMesh view() const { return {solid.vertices, triangles.triangles}; }
};

double common(const Solid& a, const Solid& b) { return common_volume(Mesh(a).view(), Mesh(b).view()); }
bool overlap(const Solid& a, const Solid& b) {
  const Mesh p(a), q(b);
  const bool forwards = overlap_of(p.view(), q.view()).overlap;
  EXPECT_EQ(forwards, overlap_of(q.view(), p.view()).overlap);
  return forwards;
}

Solid turned(Solid s, double angle) {
  const double c = std::cos(angle), d = std::sin(angle);
  for (Point3& v : s.vertices) {
    const double x = v.x - kFar.x, y = v.y - kFar.y;
    v = model::snap(Point3{kFar.x + c * x - d * y, kFar.y + d * x + c * y, v.z});
  }
  return s;
}

using testing_shapes::box;
using testing_shapes::courtyard_block;
using testing_shapes::gabled_house;

TEST(CommonVolume, OfBoxes) {
  const Solid a = box(kFar, 10, 8, 6);
  EXPECT_NEAR(common(a, a), 480, 1e-6);
  EXPECT_NEAR(common(a, box(at(9, 7, 5), 10, 10, 10)), 1, 1e-8);
  EXPECT_NEAR(common(a, box(at(2, 2, 2), 1, 1, 1)), 1, 1e-8);
  EXPECT_NEAR(common(a, box(at(10, 0, 0), 5, 8, 6)), 0, 1e-9);
  EXPECT_NEAR(common(a, box(at(0, 0, 6), 10, 8, 6)), 0, 1e-9);
  EXPECT_NEAR(common(a, box(at(-5, -5, 3), 50, 50, 1)), 80, 1e-7);
}

TEST(CommonVolume, OfRoofsCourtyardsAndOverhangs) {
  const Solid house = gabled_house(kFar, 12, 9, 5, 9);
  EXPECT_NEAR(common(house, house), 12 * 9 * 7, 1e-6);
  // The upper half of the roof: a prism over a triangle half as wide and high.
  EXPECT_NEAR(common(house, box(at(-1, -1, 7), 20, 20, 20)), 12 * 4.5 * 2 / 2, 1e-7);
  // The house in the courtyard of a block, and reaching into it.
  EXPECT_NEAR(common(courtyard_block(at(-20, -20, 0), 60, 40, 18), house), 0, 1e-9);
  EXPECT_NEAR(common(courtyard_block(at(-20, -20, 0), 60, 40, 18), box(at(25, 0, 0), 10, 10, 10)), 500, 1e-6);
  // A slab through a solid with a waist: two wedges point to point have nothing between them.
  SolidBuilder b;
  const Point3 p0 = at(0, 0, 10), p1 = at(4, 0, 10), p2 = at(4, 4, 10), p3 = at(0, 4, 10), low = at(2, 2, 0);
  const model::Face face;
  b.add_face({p0, p1, p2, p3}, face);
  b.add_face({p1, p0, low}, face);
  b.add_face({p2, p1, low}, face);
  b.add_face({p3, p2, low}, face);
  b.add_face({p0, p3, low}, face);
  const Solid overhanging = b.take();  // a pyramid on its tip
  EXPECT_NEAR(common(overhanging, box(at(-1, -1, -1), 10, 10, 6)), 4 * 4 * 10 / 3.0 / 8, 1e-7);
  EXPECT_NEAR(common(overhanging, overhanging), 160 / 3.0, 1e-7);
}

TEST(CommonVolume, AgreesWithTheVolumeOfTurnedSolids) {
  testing_shapes::Random random(7);
  for (int i = 0; i < 50; ++i) {
    const Mesh a(turned(gabled_house(kFar, 5 + 10 * random.unit(), 4 + 10 * random.unit(), 3, 4 + 4 * random.unit()),
                        6 * random.unit()));
    EXPECT_NEAR(common_volume(a.view(), a.view()), volume(a.solid, a.triangles), 1e-6);
    // Cut in two by a box that covers one side of it: both pieces together are the whole.
    const double x = 10 * random.unit() - 5;
    const Mesh left(box(at(x - 100, -100, -10), 100, 200, 100)), right(box(at(x, -100, -10), 100, 200, 100));
    EXPECT_NEAR(common_volume(a.view(), left.view()) + common_volume(a.view(), right.view()),
                volume(a.solid, a.triangles), 1e-6);
  }
}

TEST(OverlapOf, NeighboursDoNot) {
  const Solid a = box(kFar, 10, 8, 6);
  EXPECT_FALSE(overlap(a, box(at(10, 0, 0), 10, 8, 6))) << "a wall in common";
  EXPECT_FALSE(overlap(a, box(at(0, 0, 6), 10, 8, 6))) << "one on the other";
  EXPECT_FALSE(overlap(a, box(at(10, 8, 6), 10, 8, 6))) << "a corner in common";
  EXPECT_FALSE(overlap(a, box(at(10 - kStep, 0, 0), 10, 8, 6))) << "a grid step into the wall";
  EXPECT_FALSE(overlap(a, box(at(10 - 8 * kStep, 0, 0), 10, 8, 6))) << "8 mm into the wall";
  EXPECT_FALSE(overlap(a, box(at(0, 0, 6 - 8 * kStep), 10, 8, 6))) << "8 mm into the roof";
  // A wall of 300 m by 100 m: the volume of rounding is large, and no overlap.
  EXPECT_FALSE(overlap(box(kFar, 300, 300, 100), box(at(300 - 4 * kStep, 0, 0), 300, 300, 100)));
  // In a courtyard that fits but for rounding on all four sides.
  EXPECT_FALSE(overlap(courtyard_block(kFar, 40, 20, 18),
                       box(at(10 - 3 * kStep, 10 - 3 * kStep, 0), 20 + 6 * kStep, 20 + 6 * kStep, 18)));
  // Two roofs back to back.
  EXPECT_FALSE(overlap(gabled_house(kFar, 12, 9, 5, 9), gabled_house(at(0, 9 - 2 * kStep, 0), 12, 9, 5, 9)));
  // A tower on the ridge's wall, a loft on a roof: the roof's own solid as the hull of another.
  EXPECT_FALSE(overlap(box(kFar, 10, 8, 6), box(at(3, 3, 6), 2, 2, 5)));
}

TEST(OverlapOf, OverlapsAreFound) {
  const Solid a = box(kFar, 10, 8, 6);
  EXPECT_TRUE(overlap(a, a));
  EXPECT_TRUE(overlap(a, box(at(10 - 15 * kStep, 0, 0), 10, 8, 6))) << "15 mm into the wall";
  EXPECT_TRUE(overlap(a, box(at(2, 2, 2), 1, 1, 1))) << "inside";
  EXPECT_TRUE(overlap(a, box(at(2, 2, -10), 0.2, 0.2, 30))) << "a mast through it";
  EXPECT_FALSE(overlap(a, box(at(2, 2, -10), 8 * kStep, 8 * kStep, 30))) << "a wire through it";
  EXPECT_TRUE(overlap(gabled_house(kFar, 12, 9, 5, 9), box(at(4, 4, 8), 1, 1, 5)))
      << "a tower that begins below the ridge";
  EXPECT_FALSE(overlap(gabled_house(kFar, 12, 9, 5, 9), box(at(4, 0, 8), 1, 1, 5)))
      << "above the eaves, beside the ridge";
  // A cube in common beside a long wall that overlaps by rounding.
  EXPECT_TRUE(overlap(courtyard_block(kFar, 40, 20, 18), box(at(10 - 3 * kStep, 9.5, 0), 20, 20, 18)));
}

TEST(OverlapOf, TurnedNeighboursDoNot) {
  // Walls in common at any angle: both take the same points, rounded, but for T-junctions.
  for (int i = 1; i < 40; ++i) {
    const double angle = 0.16 * i;
    const Solid a = turned(box(kFar, 30, 8, 12), angle);
    EXPECT_FALSE(overlap(a, turned(box(at(7, 8, 0), 9, 9, 12), angle))) << angle;
    EXPECT_FALSE(overlap(a, turned(gabled_house(at(11, -9, 0), 12, 9, 5, 9), angle))) << angle;
    EXPECT_FALSE(overlap(a, turned(gabled_house(at(3, 1, 12), 12, 6, 5, 9), angle))) << angle;
    EXPECT_TRUE(overlap(a, turned(box(at(7, 7.96, 0), 9, 9, 12), angle))) << angle;
  }
}

}  // namespace
}  // namespace blockrand::geometry
