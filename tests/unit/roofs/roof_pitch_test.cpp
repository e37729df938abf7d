#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/roofs/roof_checks.h"

namespace blockrand::roofs {
namespace {

using model::RoofShape;
using namespace roof_checks;

/// 20 m along x, 10 m along y.
const Polygon kHouse = polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}});

RoofRequest request(RoofShape shape, std::optional<double> direction = {}, bool across = false) {
  RoofRequest out;
  out.shape = shape;
  if (direction) out.down = compass_vector(*direction);
  out.across = across;
  return out;
}
double run(const Polygon& plan, const RoofRequest& asked) {
  const MainSlope slope = main_slope(plan, asked, false);
  return slope.run / slope.rise;
}

TEST(MainSlope, RunsHalfTheWidthBelowARidge) {
  for (const RoofShape shape : {RoofShape::gabled, RoofShape::hipped, RoofShape::half_hipped, RoofShape::mansard,
                                RoofShape::round, RoofShape::pyramidal, RoofShape::dome, RoofShape::spire})
    EXPECT_NEAR(run(kHouse, request(shape)), 5, 1e-9) << model::name(shape);
  EXPECT_NEAR(run(kHouse, request(RoofShape::gabled, {}, true)), 10, 1e-9);
  EXPECT_NEAR(run(kHouse, request(RoofShape::gabled, 90)), 10, 1e-9);
  EXPECT_NEAR(run(kHouse, request(RoofShape::hipped, 90)), 5, 1e-9) << "hips rise from all sides";
  EXPECT_NEAR(run(regular(24, 6), request(RoofShape::cone)), 6, 0.1);
  EXPECT_NEAR(run(plans().at("L"), request(RoofShape::gabled, 90)), 4, 0.6) << "a wing's";
}

/// A house that gave way to its second drawing has no plan left, and is asked all the same.
TEST(MainSlope, IsANumberOnPlansThatAreNone) {
  const std::vector<Polygon> none = {{},
                                     polygon({{1, 2}}),
                                     polygon({{1, 2}, {5, 2}}),
                                     polygon({{1, 2}, {5, 2}, {9, 2}}),
                                     polygon({{1, 2}, {1, 2}, {1, 2}, {1, 2}}),
                                     polygon({{0, 0}, {4, 4}, {4, 0}, {0, 4}})};
  for (const Polygon& plan : none)
    for (std::size_t shape = 0; shape < model::kRoofShapeCount; ++shape)
      for (const bool steep : {false, true})
        for (const bool across : {false, true}) {
          const MainSlope slope = main_slope(plan, request(static_cast<RoofShape>(shape), {}, across), steep);
          EXPECT_TRUE(std::isfinite(slope.run) && std::isfinite(slope.rise)) << plan.outer.size() << " corners";
        }
}

TEST(MainSlope, RunsAllTheWayDownALeanTo) {
  EXPECT_NEAR(run(kHouse, request(RoofShape::skillion)), 10, 1e-9);
  EXPECT_NEAR(run(kHouse, request(RoofShape::skillion, 180)), 10, 1e-9);
  EXPECT_NEAR(run(kHouse, request(RoofShape::skillion, 270)), 20, 1e-9);
  EXPECT_NEAR(run(kHouse, request(RoofShape::butterfly)), 5, 1e-9);
  EXPECT_NEAR(run(kHouse, request(RoofShape::sawtooth)), 5, 1e-9);
}

TEST(MainSlope, EndsAtTheDeckOfASaltbox) {
  EXPECT_NEAR(run(kHouse, request(RoofShape::double_saltbox)), 3, 1e-9);
  EXPECT_NEAR(run(kHouse, request(RoofShape::double_saltbox, {}, true)), 6, 1e-9);
  EXPECT_NEAR(run(kHouse, request(RoofShape::quadruple_saltbox)), 3, 1e-9);
  EXPECT_NEAR(run(kHouse, request(RoofShape::saltbox)), 6, 1e-9);
}

/// Steepest pitch among a roof's planes, degrees.
double steepest(const Roof& roof) {
  double best = 0;
  for (const auto& surface : roof.surfaces) {
    if (surface.upright) continue;
    double nx = 0, ny = 0, nz = 0;
    const auto& l = surface.loops[0];
    for (std::size_t i = 0; i < l.size(); ++i) {
      const Point3 a = l[i], b = l[(i + 1) % l.size()];
      nx += (a.y - b.y) * (a.z + b.z);
      ny += (a.z - b.z) * (a.x + b.x);
      nz += (a.x - b.x) * (a.y + b.y);
    }
    best = std::max(best, std::atan2(std::hypot(nx, ny), nz) * 180 / M_PI);
  }
  return best;
}

TEST(MainSlope, GivesTheBuiltRoofItsPitch) {
  for (const RoofShape shape :
       {RoofShape::gabled, RoofShape::hipped, RoofShape::half_hipped, RoofShape::side_hipped,
        RoofShape::hipped_and_gabled, RoofShape::skillion, RoofShape::mansard, RoofShape::gambrel, RoofShape::saltbox,
        RoofShape::double_saltbox, RoofShape::quadruple_saltbox, RoofShape::butterfly, RoofShape::sawtooth,
        RoofShape::gabled_height_moved, RoofShape::pyramidal, RoofShape::crosspitched})
    for (const bool across : {false, true}) {
      RoofRequest asked = request(shape, {}, across);
      const MainSlope slope = main_slope(kHouse, asked, true);
      asked.measures = {30, model::snap(slope.run * std::tan(40 * M_PI / 180) / slope.rise)};
      const auto built = build_roof(kHouse, asked);
      ASSERT_TRUE(built);
      // A cross roof on an oblong plan has two pitches, the steeper one on the shorter way.
      EXPECT_NEAR(steepest(built->roof), 40, 0.2) << model::name(shape) << (across ? " across" : "");
    }
}

}  // namespace
}  // namespace blockrand::roofs
