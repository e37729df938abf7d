// The second judge agrees with our own checker on sound and on broken solids.
#include "pipeline/geometry/second_judge.h"

#include <gtest/gtest.h>

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

TEST(SecondJudge, SoundSolidsPass) {
  const model::Point3 far{391000, 5819000, 34};
  EXPECT_EQ(judge_solid(polygons_of(testing_shapes::box(far, 10, 8, 6))), "");
  EXPECT_EQ(judge_solid(polygons_of(testing_shapes::gabled_house(far, 12, 9, 5, 9))), "");
  EXPECT_EQ(judge_solid(polygons_of(testing_shapes::courtyard_block(far, 60, 30, 18))), "");
  for (const auto& s : testing_shapes::sound_solids()) EXPECT_EQ(judge_solid(polygons_of(s.solid)), "") << s.name;
}

TEST(SecondJudge, FindsEveryBrokenSolidButTheOnesItCannotSee) {
  for (const auto& broken : testing_shapes::broken_solids()) {
    // CGAL has no word on planarity, folds and the direction of holes, and a second copy of a vertex at the same place is
    // the same point for it.
    if (!broken.seen_by_cgal) continue;
    EXPECT_NE(judge_solid(polygons_of(broken.solid)), "") << broken.name;
  }
}

}  // namespace
}  // namespace blockrand::geometry
