#include "styles/masonry/relief.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/polygon_measures.h"
#include "tests/unit/masonry/masonry_walls.h"

namespace blockrand::masonry {
namespace {

ReliefOptions options_for(const WallToLay& wall, const Masonry& masonry) {
  ReliefOptions out;
  out.relief = masonry.relief;
  out.irregular = !has_courses(masonry.bond);
  out.from = wall.from, out.to = wall.to;
  out.turn_left = wall.corner_left ? 90 : 0, out.turn_right = wall.corner_right ? 90 : 0;
  out.most_triangles = 1'000'000;
  return out;
}

std::size_t triangles_of(const model::ElementMesh& mesh) {
  std::size_t out = 0;
  for (const model::ElementFace& f : mesh.faces) out += f.count - 2;
  return out;
}

TEST(Relief, StandsBeforeTheWallByThreeCentimetresAtMost) {
  for (const Bond bond : kAllBonds) {
    const WallToLay wall = front_wall();
    const Relief relief = relief_of(*lay(wall, usual_masonry(bond)), options_for(wall, usual_masonry(bond)), true);
    EXPECT_EQ(relief.detail, ReliefDetail::full);
    std::size_t triangles = triangles_of(relief.dressings);
    for (const auto& mesh : relief.field) triangles += triangles_of(mesh);
    EXPECT_LE(triangles, relief.triangles);
    EXPECT_GT(triangles, relief.triangles * 9 / 10);  // sides at corners are left out
    for (const model::ElementMesh* mesh : {&relief.field[0], &relief.field[1], &relief.field[2], &relief.dressings})
      for (const model::Point3& v : mesh->vertices) {
        EXPECT_GE(v.z, 0.005);
        EXPECT_LE(v.z, 0.030);
      }
  }
}

TEST(Relief, FacesLookOutwardsAndAreFlat) {
  const WallToLay wall = front_wall();
  for (const Bond bond : kAllBonds) {
    const Relief relief = relief_of(*lay(wall, usual_masonry(bond)), options_for(wall, usual_masonry(bond)), true);
    for (const model::ElementMesh* mesh : {&relief.field[0], &relief.field[1], &relief.field[2], &relief.dressings})
      for (const model::ElementFace& f : mesh->faces) {
        const auto at = [&](std::uint32_t i) { return mesh->vertices[mesh->indices[f.first + i]]; };
        double normal_z = 0;
        for (std::uint32_t i = 0; i < f.count; ++i) {
          const auto a = at(i), b = at((i + 1) % f.count);
          normal_z += a.x * b.y - a.y * b.x;
        }
        // Sides are bevelled or upright: none looks back at the wall by more than the tip of a stone that is cut at a gable's foot,
        // where it meets the mitre of the corner (m2, twice the area).
        EXPECT_GT(normal_z, -0.001) << kBondNames[static_cast<int>(bond)];
      }
  }
}

TEST(Relief, NoTriangleOfAFanIsWithoutArea) {
  for (const Bond bond : kAllBonds)
    for (std::uint64_t seed = 1; seed < 4; ++seed) {
      const WallToLay wall = random_wall(seed);
      const Relief relief = relief_of(*lay(wall, usual_masonry(bond)), options_for(wall, usual_masonry(bond)), true);
      for (const model::ElementMesh* mesh : {&relief.field[0], &relief.field[1], &relief.field[2], &relief.dressings})
        for (const model::ElementFace& f : mesh->faces)
          for (std::uint32_t i = 1; i + 1 < f.count; ++i) {
            const auto at = [&](std::uint32_t k) { return mesh->vertices[mesh->indices[f.first + k]]; };
            const auto a = at(0), b = at(i), c = at(i + 1);
            const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
            const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
            EXPECT_GT(std::sqrt(nx * nx + ny * ny + nz * nz), 0) << kBondNames[static_cast<int>(bond)] << " " << seed;
          }
    }
}

TEST(Relief, FallsBackToFrontsThenToDressingsThenToNothing) {
  const WallToLay wall = front_wall();
  const LaidWall laid = *lay(wall, usual_masonry(Bond::stretcher));
  ReliefOptions options = options_for(wall, usual_masonry(Bond::stretcher));
  const std::size_t all = relief_of(laid, options, false).triangles;
  ASSERT_GT(all, 20000u);
  std::size_t before = all + 1;
  for (const ReliefDetail expected :
       {ReliefDetail::full, ReliefDetail::fronts, ReliefDetail::dressings, ReliefDetail::none}) {
    options.most_triangles = before - 1;
    const Relief relief = relief_of(laid, options, false);
    EXPECT_EQ(relief.detail, expected);
    EXPECT_LE(relief.triangles, options.most_triangles);
    EXPECT_LT(relief.triangles, before);
    before = relief.triangles;
    if (before == 0) break;
  }
}

TEST(Relief, StonesOfTwoWallsMeetRoundTheCorner) {
  WallToLay wall = plain_wall(4, 2);
  wall.corner_right = true;
  const Masonry masonry = usual_masonry(Bond::ashlar);
  const Relief relief = relief_of(*lay(wall, masonry), options_for(wall, masonry), true);
  double farthest = 0;
  for (const model::Point3& v : relief.dressings.vertices) {
    farthest = std::max(farthest, v.x);
    if (v.x > 4.0001) {
      EXPECT_NEAR(v.x - 4, v.z, 0.0011);  // the bisector of a right angle
    }
  }
  EXPECT_NEAR(farthest, 4 + 0.006 + masonry.relief, 0.002);
}

TEST(Relief, TrianglesCoverBentOutlines) {
  const Outline bent{{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  double area = 0;
  for (const auto& t : triangles_of_outline(bent)) {
    const Outline triangle{bent[t[0]], bent[t[1]], bent[t[2]]};
    EXPECT_GT(geometry::signed_area(triangle), 0);
    area += geometry::signed_area(triangle);
  }
  EXPECT_NEAR(area, 5, 1e-9);
}

}  // namespace
}  // namespace blockrand::masonry
