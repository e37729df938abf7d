#include "pipeline/geometry/fold_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "pipeline/geometry/normal_deviation.h"
#include "pipeline/geometry/triangulate.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::geometry {
namespace {

using model::Point3;
using testing_shapes::Random;

/// An upright wall with rows of openings, rounded to the grid; some stand on one axis, some near the border.
model::Solid wall_with_openings(Random& random) {
  const double angle =
      random.next(6) == 0 ? 0.5 * 3.14159265358979 * static_cast<double>(random.next(4)) : 6.28 * random.unit();
  const double c = std::cos(angle), s = std::sin(angle), length = 4 + 40 * random.unit();
  const int bays = 1 + static_cast<int>(length / 4), storeys = 1 + static_cast<int>(random.next(5));
  std::vector<std::vector<Point3>> rings;
  const auto add = [&](std::vector<model::Point2> ring, bool hole) {
    auto& out = rings.emplace_back();
    for (const model::Point2 p : ring) out.push_back(model::snap(Point3{391000 + c * p.x, 5819000 + s * p.x, p.y}));
    if (hole) std::reverse(out.begin(), out.end());
  };
  const double height = 3.0 * storeys;
  add({{0, 0}, {length, 0}, {length, height}, {0, height}}, false);
  const double sill = random.next(3) == 0 ? 0.02 + 0.05 * random.unit() : 0.8;
  for (int y = 0; y < storeys; ++y)
    for (int x = 0; x < bays; ++x) {
      const double bay = length / bays,
                   width = random.next(2) == 0 ? 1.0 : 0.6 + 0.05 * static_cast<double>(random.next(8));
      const double left = bay * x + (bay - width) / 2 + (random.next(4) == 0 ? 0.3 * random.unit() : 0),
                   low = 3.0 * y + sill;
      add({{left, low}, {left + width, low}, {left + width, low + 1.6}, {left, low + 1.6}}, true);
    }
  // Some walls are bent more than rounding does.
  if (random.next(3) == 0)
    for (auto& ring : rings)
      for (Point3& p : ring) {
        const double off = 0.002 * random.unit() * static_cast<double>(random.next(4));
        p = model::snap(Point3{p.x - s * off, p.y + c * off, p.z});
      }
  model::Solid solid;
  model::Face face;
  face.loop_count = static_cast<std::uint32_t>(rings.size());
  for (const auto& ring : rings) {
    solid.loops.push_back({static_cast<std::uint32_t>(solid.indices.size()), static_cast<std::uint32_t>(ring.size())});
    for (const Point3& p : ring) {
      solid.indices.push_back(static_cast<std::uint32_t>(solid.vertices.size()));
      solid.vertices.push_back(p);
    }
  }
  solid.faces.push_back(face);
  return solid;
}

TEST(FoldTest, SaysWhatNormalDeviationSays) {
  Random random(7);
  int folded = 0, walls = 0, sure = 0;
  for (int i = 0; i < 1500; ++i) {
    const model::Solid solid = wall_with_openings(random);
    const auto triangles = triangulate(solid);
    if (!triangles) continue;
    ++walls;
    const double angle = normal_deviation(solid, solid.faces[0]);
    // Limits around the angle itself are the hard ones.
    for (const double limit :
         {0.2617993877991494, 0.3490658503988659, 0.05, angle, angle - 1e-6, angle + 1e-6, angle / 2}) {
      if (limit < 0) continue;
      ASSERT_EQ(folds_more_than(solid, solid.faces[0], triangles->triangles, limit), angle > limit)
          << i << " " << angle << " " << limit;
    }
    folded += angle > 0.2617993877991494;
    sure += surely_folds(solid.vertices, triangles->triangles, 0.2617993877991494).has_value();
  }
  EXPECT_GT(walls, 1000);
  EXPECT_GT(folded, 50) << "too few walls fold for this to be a test";
  EXPECT_GT(sure, walls * 3 / 4) << "nearly always it must not need normal_deviation()";
}

TEST(FoldTest, TrianglesAndFlatFacesDoNotFold) {
  Random random(1);
  model::Solid solid;
  solid.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0, 0, 3}};
  solid.indices = {0, 1, 2, 3};
  solid.loops = {{0, 4}};
  solid.faces.resize(1);
  solid.faces[0].loop_count = 1;
  EXPECT_FALSE(folds_more_than(solid, solid.faces[0], {}, 0));
  solid.vertices[2].y = 1;  // a quadrangle that is bent, without triangles of it
  EXPECT_TRUE(folds_more_than(solid, solid.faces[0], {}, 0.1));
  EXPECT_FALSE(folds_more_than(solid, solid.faces[0], {}, 2));
  solid.loops[0].count = 3;
  EXPECT_FALSE(folds_more_than(solid, solid.faces[0], {}, 0));
}

}  // namespace
}  // namespace blockrand::geometry
