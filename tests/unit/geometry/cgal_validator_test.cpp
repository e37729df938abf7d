// The second judge agrees with our own checker on sound and on broken solids.
#include "pipeline/geometry/cgal_validator.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/geometry/broken_solids.h"

namespace blockrand::geometry {
namespace {

/// Faces as polygons of points. Loops whose indices are nonsense give an empty ring, which the judge refuses.
std::vector<PolygonRings> polygons_of(const model::Solid& solid) {
  std::vector<PolygonRings> out;
  for (const model::Face& face : solid.faces) {
    auto& rings = out.emplace_back();
    for (const auto& loop : solid.loops_of(face)) {
      auto& ring = rings.emplace_back();
      for (const auto i : solid.indices_of(loop)) {
        if (i >= solid.vertices.size()) return {{{}}};
        ring.push_back(solid.vertices[i]);
      }
    }
  }
  return out;
}

TEST(CgalValidation, SoundSolidsPass) {
  const model::Point3 far{391000, 5819000, 34};
  EXPECT_EQ(validate_solid(polygons_of(testing_shapes::box(far, 10, 8, 6))), "");
  EXPECT_EQ(validate_solid(polygons_of(testing_shapes::gabled_house(far, 12, 9, 5, 9))), "");
  EXPECT_EQ(validate_solid(polygons_of(testing_shapes::courtyard_block(far, 60, 30, 18))), "");
  for (const auto& s : testing_shapes::sound_solids()) EXPECT_EQ(validate_solid(polygons_of(s.solid)), "") << s.name;
}

TEST(CgalValidation, FindsEveryBrokenSolidButTheOnesItCannotSee) {
  for (const auto& broken : testing_shapes::broken_solids()) {
    // CGAL has no word on planarity, folds and the direction of holes, and a second copy of a vertex at the same place is
    // the same point for it.
    if (!broken.seen_by_cgal) continue;
    EXPECT_NE(validate_solid(polygons_of(broken.solid)), "") << broken.name;
  }
}

TEST(CgalValidation, CoordinatesBeyondAllMeasureEndInAVerdict) {
  for (const double wrong :
       {1e200, -1e300, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    auto polygons = polygons_of(testing_shapes::box({0, 0, 0}, 10, 8, 6));
    polygons[2][0][1].x = wrong;
    EXPECT_EQ(validate_solid(polygons), "a coordinate beyond all measure");
    EXPECT_EQ(validate_triangles({{{0, 0, 0}, {1, 0, 0}, {wrong, 1, 0}}}), "a coordinate beyond all measure");
  }
}

}  // namespace
}  // namespace blockrand::geometry
