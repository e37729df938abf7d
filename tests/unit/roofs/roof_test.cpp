#include "styles/roofs/roof.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include "pipeline/geometry/slivers.h"
#include "styles/roofs/skeleton_roofs.h"
#include "styles/roofs/wing_ends.h"
#include "tests/unit/geometry/random_plans.h"
#include "tests/unit/roofs/roof_checks.h"

namespace blockrand::roofs {
namespace {

using model::Point2;
using model::Point3;
using model::Polygon;
using model::RoofShape;
using namespace roof_checks;
using testing_shapes::random_plan;
using testing_shapes::turned;

RoofRequest request(RoofShape shape, RoofMeasures measures = {36, 4}) {
  RoofRequest r;
  r.shape = shape;
  r.measures = measures;
  return r;
}

std::map<std::string, Polygon> some_plans() {
  std::map<std::string, Polygon> out{
      {"rectangle", polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}})},
      {"L", polygon({{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 18}, {0, 18}})},
      {"U", polygon({{0, 0}, {30, 0}, {30, 20}, {22, 20}, {22, 8}, {8, 8}, {8, 20}, {0, 20}})},
      {"T", polygon({{0, 0}, {30, 0}, {30, 8}, {19, 8}, {19, 20}, {11, 20}, {11, 8}, {0, 8}})},
      {"trapezoid", polygon({{0, 0}, {20, 0}, {16, 9}, {3, 9}})},
  };
  Polygon court = polygon({{0, 0}, {40, 0}, {40, 30}, {0, 30}});
  court.holes.push_back(ring({{11, 11}, {11, 19}, {29, 19}, {29, 11}}));
  out.emplace("courtyard", court);
  return out;
}

/// Directions down which surfaces slope, in whole degrees.
std::set<int> slope_directions(const Roof& roof) {
  std::set<int> out;
  for (const auto& surface : roof.surfaces) {
    if (surface.upright) continue;
    const auto& p = surface.loops[0];
    double nx = 0, ny = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Point3 a = p[i], b = p[(i + 1) % p.size()];
      nx += (a.y - b.y) * (a.z + b.z);
      ny += (a.z - b.z) * (a.x + b.x);
    }
    if (std::hypot(nx, ny) < 1e-3) continue;
    out.insert((static_cast<int>(std::lround(std::atan2(ny, nx) * 180 / M_PI)) + 360) % 360);
  }
  return out;
}

TEST(HippedRoof, RidgeOfATenBySixPlan) {
  // docs/internal/seeds.md P2-59: 10 x 6 at 45 degrees has its ridge at (3,3,3) to (7,3,3).
  const auto built = build_roof(polygon({{0, 0}, {10, 0}, {10, 6}, {0, 6}}), request(RoofShape::hipped, {0, 3}));
  ASSERT_TRUE(built);
  std::set<Point3> high;
  for (const auto& s : built->roof.surfaces)
    for (const Point3& p : s.loops[0])
      if (p.z > 1e-9) high.insert(model::snap(p));
  EXPECT_EQ(high, (std::set<Point3>{{3, 3, 3}, {7, 3, 3}}));
}

TEST(GabledRoof, OneRidgePerWing) {
  for (const auto& [name, plan] : some_plans()) {
    const std::map<std::string, std::size_t> expected{{"rectangle", 2}, {"L", 2},         {"U", 2},
                                                      {"T", 3},         {"trapezoid", 2}, {"courtyard", 0}};
    for (const Polygon& p : {plan, turned(plan)}) {
      EXPECT_EQ(wing_ends(p, request(RoofShape::gabled)).size(), expected.at(name)) << name;
      const auto built = build_roof(p, request(RoofShape::gabled));
      ASSERT_TRUE(built) << name;
      EXPECT_EQ(validity(p, built->roof), "none") << name;
      EXPECT_EQ(built->note, model::IssueCode::none) << name;
    }
    const auto gabled = build_roof(plan, request(RoofShape::gabled));
    if (name == "L") {
      EXPECT_EQ(slope_directions(gabled->roof), (std::set<int>{0, 90, 180, 270}));
    }
    if (name == "rectangle") {
      EXPECT_EQ(slope_directions(gabled->roof), (std::set<int>{90, 270}));
    }
  }
}

TEST(GabledRoof, TheRidgeTurnsWithOrientationAndDirection) {
  const Polygon plan = turned(some_plans().at("rectangle"));
  RoofRequest across = request(RoofShape::gabled);
  EXPECT_EQ(wing_ends(plan, across), (std::vector<std::uint32_t>{1, 3}));
  across.across = true;
  EXPECT_EQ(wing_ends(plan, across), (std::vector<std::uint32_t>{0, 2}));
  RoofRequest down = request(RoofShape::gabled);
  down.down = compass_vector(90 - 33);  // along the long side of the turned plan: the eaves are the short sides
  EXPECT_EQ(wing_ends(plan, down), (std::vector<std::uint32_t>{0, 2}));
}

TEST(SkillionRoof, OnePlaneDownTheGivenDirection) {
  for (const auto& [name, plan] : some_plans()) {
    const Polygon p = turned(plan);
    RoofRequest r = request(RoofShape::skillion, {36, 3});
    r.down = compass_vector(45);
    const auto built = build_roof(p, r);
    ASSERT_TRUE(built) << name;
    EXPECT_EQ(built->roof.surfaces.size(), 1u);
    EXPECT_EQ(validity(p, built->roof), "none") << name;
    EXPECT_EQ(slope_directions(built->roof), std::set<int>{45}) << name;
  }
  const auto east = compass_vector(90);
  EXPECT_NEAR(east.x, 1, 1e-15);
  EXPECT_NEAR(east.y, 0, 1e-15);
}

TEST(SkillionRoof, ShedHasOneHighWall) {
  // docs/internal/seeds.md FK-23: the wall on the high side reaches the top, the opposite one the eaves.
  RoofRequest r = request(RoofShape::skillion, {36, 3});
  r.down = Point2{0, -1};
  const auto built = build_roof(some_plans().at("rectangle"), r);
  ASSERT_TRUE(built);
  EXPECT_DOUBLE_EQ(built->roof.wall_tops[0][0].z, 36);
  EXPECT_DOUBLE_EQ(built->roof.wall_tops[2][0].z, 39);
}

// Regular plans as they are mapped: corners are multiples of 1e-7 degrees, about a centimetre.
TEST(HippedRoof, RegularPlansAtThePrecisionOfTheMap) {
  std::size_t built = 0, refused = 0;
  for (int corners = 5; corners <= 12; ++corners)
    for (const bool is_star : {false, true})
      for (int turn = 0; turn < 10; ++turn) {
        std::vector<Point2> points;
        const int count = is_star ? 2 * corners : corners;
        for (int i = 0; i < count; ++i) {
          const double angle = 2 * M_PI * (i + 0.1 * turn) / count, radius = is_star && i % 2 ? 8 : 20;
          const auto mapped = [](double metres, double unit) { return std::round(metres / unit) * unit; };
          points.push_back(model::snap(Point2{391000 + mapped(radius * std::cos(angle), 0.0068),
                                              5819000 + mapped(radius * std::sin(angle), 0.0111)}));
        }
        const Polygon plan = polygon(points);
        bool valid = false;
        for (const double coarseness : kCoarseness) {
          RoofRequest asked = request(RoofShape::hipped);
          asked.coarseness = coarseness;
          const auto roof = build_roof(plan, asked);
          valid = valid || (roof && validity(plan, roof->roof) == "none");
        }
        ++built;
        refused += !valid;
      }
  std::printf("%zu of %zu regular plans refused\n", refused, built);
  EXPECT_LE(refused, built / 25);
}

// Every shape that rises from the edges, on random polygons with holes: no crash, no invalid solid, few fallbacks.
TEST(RandomRoofs, AreValidOrCounted) {
  const bool many = std::getenv("BLOCKRAND_MANY") != nullptr;
  const std::uint64_t rounds = many ? 100000 : 2000;
  const RoofShape shapes[] = {RoofShape::hipped,         RoofShape::gabled,
                              RoofShape::half_hipped,    RoofShape::mansard,
                              RoofShape::gambrel,        RoofShape::round,
                              RoofShape::side_hipped,    RoofShape::hipped_and_gabled,
                              RoofShape::double_saltbox, RoofShape::quadruple_saltbox};
  std::map<std::string, std::uint64_t> validities;
  std::uint64_t built = 0, fallbacks = 0, invalid = 0;
  for (std::uint64_t i = 0; i < rounds; ++i) {
    // As repair leaves plans: without needles.
    Polygon plan = random_plan(23, i);
    geometry::cut_slivers(plan, 0.1);
    const RoofShape shape = shapes[(i / 4) % std::size(shapes)];
    RoofRequest asked = request(shape);
    std::string v;
    for (const double coarseness : kCoarseness) {
      asked.coarseness = coarseness;
      const auto roof = build_roof(plan, asked);
      if (!roof || roof->note == model::IssueCode::skeleton_fallback) {
        v = "skeleton given up";
        break;
      }
      v = validity(plan, roof->roof);
      if (v == "none") {
        EXPECT_NEAR(covered_area(roof->roof), geometry::area(plan), 0.005 * geometry::perimeter(plan)) << i;
        break;
      }
    }
    fallbacks += v == "skeleton given up";
    built += v == "none";
    if (v == "none") continue;
    ++invalid;
    ++validities[v.substr(0, v.find(" at"))];
    ++validities[std::string(model::name(shape))];
    if (invalid < 12) std::printf("polygon %lu, %s: %s\n", i, std::string(model::name(shape)).c_str(), v.c_str());
  }
  for (const auto& [v, n] : validities) std::printf("  %s: %lu\n", v.c_str(), n);
  std::printf("%lu random polygons: %lu roofs, %lu skeletons given up, %lu solids refused by the checker (%.3f %%)\n",
              rounds, built, fallbacks, invalid, 100.0 * static_cast<double>(invalid) / static_cast<double>(rounds));
  // Of those refused some fold (204, as val3dity sees folds): builds then take a simpler roof.
  EXPECT_LT(fallbacks + invalid, 1 + rounds / 500);
}

}  // namespace
}  // namespace blockrand::roofs
