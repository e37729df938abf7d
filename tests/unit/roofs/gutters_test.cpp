#include "styles/roofs/gutters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "styles/roofs/overhangs.h"
#include "tests/unit/roofs/element_checks.h"
#include "tests/unit/roofs/roof_checks.h"

namespace blockrand::roofs {
namespace {

using model::Point2;
using model::Point3;
using model::Polygon;
using model::RoofElementKind;
using model::RoofShape;
using roof_checks::fault;
using testing_shapes::polygon;
using testing_shapes::Random;

constexpr double kEaves = 40;  // m
constexpr GutterOptions kUsual;

Roof roof_on(const Polygon& plan, RoofShape shape, double height = 4) {
  RoofRequest request;
  request.shape = shape;
  request.measures = {kEaves, height};
  return build_roof(plan, request)->roof;
}

/// Overhangs and gutters together.
struct Dressed {
  std::vector<model::RoofInstallation> bodies;
  BuiltElements gutters;
  int count(RoofElementKind kind) const {
    int n = 0;
    for (const auto& b : bodies) n += b.kind == kind;
    return n;
  }
};

Dressed dress(
    const Polygon& plan, const Roof& roof, const std::vector<OverhangRoom>& rooms = {},
    const MayComeDown& may = [](Point2, Point2, double) { return true; }) {
  OverhangOptions options;
  options.before_eaves = kUsual.width;
  BuiltOverhangs beyond = overhangs(plan, roof, rooms, options);
  Dressed out;
  out.bodies = std::move(beyond.elements.bodies);
  out.gutters = gutters(beyond, 0, may);
  for (const auto& body : out.gutters.bodies) out.bodies.push_back(body);
  return out;
}

const Polygon kRectangle = polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}});

TEST(Gutters, RunBeforeTheEavesOfAGabledHouse) {
  const Roof roof = roof_on(kRectangle, RoofShape::gabled);
  const Dressed house = dress(kRectangle, roof);
  EXPECT_EQ(fault(masses::envelope(kRectangle, 0, roof, {}), house.bodies), "");
  EXPECT_EQ(house.count(RoofElementKind::gutter), 2);
  EXPECT_EQ(house.count(RoofElementKind::downpipe), 4) << "a run of 20 m has a pipe at each end";
  for (const auto& body : house.bodies) {
    Point3 least{1e9, 1e9, 1e9}, most{-1e9, -1e9, -1e9};
    for (const Point3& p : body.solid.vertices) {
      least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
      most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
    }
    const double south = least.y < 5 ? 1 : -1;  // mirrored about y = 5
    const double out = south > 0 ? -least.y : most.y - 10, in = south > 0 ? -most.y : least.y - 10;
    if (body.kind == RoofElementKind::gutter) {
      EXPECT_NEAR(in, 0.40, 0.01) << "it touches the board";
      EXPECT_NEAR(out, 0.52, 0.01);
      EXPECT_NEAR(most.z - least.z, kUsual.depth, 0.01);
      EXPECT_LT(most.z, kEaves);
    } else if (body.kind == RoofElementKind::downpipe) {
      EXPECT_NEAR(in, kUsual.pipe_off, 0.01) << "clear of the wall";
      EXPECT_NEAR(out, kUsual.pipe_off + kUsual.pipe, 0.01);
      EXPECT_EQ(least.z, 0);
      // Under a soffit that falls from the wall by 0.8 in 1.
      EXPECT_NEAR(most.z, kEaves - kUsual.board - 0.13 * 0.8, 0.02);
      EXPECT_NEAR(most.x - least.x, kUsual.pipe, 0.01);
      const double middle = (least.x + most.x) / 2;
      EXPECT_NEAR(std::min(middle, 20 - middle), kUsual.from_end, 0.01);
    }
  }
}

TEST(Gutters, GoRoundTheCornersOfAHip) {
  const Roof roof = roof_on(kRectangle, RoofShape::hipped);
  const Dressed house = dress(kRectangle, roof);
  EXPECT_EQ(fault(masses::envelope(kRectangle, 0, roof, {}), house.bodies), "");
  EXPECT_EQ(house.count(RoofElementKind::gutter), 1);
  double volume = 0;
  for (const auto& body : house.bodies)
    if (body.kind == RoofElementKind::gutter) volume += roof_checks::volume(body.solid);
  // A ring 0.12 m wide round the overhang, as deep as half of its depth on the mean.
  const double ring = (20.8 + 0.24) * (10.8 + 0.24) - 20.8 * 10.8;
  EXPECT_NEAR(volume, ring * kUsual.depth * 0.5, 0.02);
}

TEST(Gutters, WantRoomAndStayOffPartyWalls) {
  const Roof roof = roof_on(kRectangle, RoofShape::gabled);
  std::vector<OverhangRoom> rooms(4);
  rooms[0] = {model::RoofEdge::open, 0.45, 0.45};  // the eaves fit, a gutter does not
  rooms[1].edge = rooms[3].edge = model::RoofEdge::party_wall;
  const Dressed house = dress(kRectangle, roof, rooms);
  EXPECT_EQ(house.count(RoofElementKind::eaves), 2);
  EXPECT_EQ(house.count(RoofElementKind::gutter), 1);
  for (const auto& body : house.bodies)
    for (const Point3& p : body.solid.vertices) EXPECT_TRUE(p.x >= -0.001 && p.x <= 20.001) << "beyond a party wall";
}

TEST(Gutters, PipesComeDownWhereNothingIsInTheWay) {
  const Roof roof = roof_on(kRectangle, RoofShape::gabled);
  const auto on_the_left = [](Point2 foot, Point2, double) { return foot.x < 10; };
  EXPECT_EQ(dress(kRectangle, roof, {}, on_the_left).count(RoofElementKind::downpipe), 2);
  const auto nowhere = [](Point2, Point2, double) { return false; };
  EXPECT_EQ(dress(kRectangle, roof, {}, nowhere).count(RoofElementKind::downpipe), 0);
  EXPECT_EQ(dress(kRectangle, roof, {}, nowhere).count(RoofElementKind::gutter), 2);
}

TEST(Gutters, OnAnyPlanEveryBodyIsSoundAndApart) {
  int gutter_count = 0, pipes = 0, asked = 0, refused = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    Random random(seed);
    const Polygon plan =
        roof_checks::moved(roof_checks::random_plan(random), 360 * random.unit(), roof_checks::kPlaces[random.next(3)]);
    RoofRequest request;
    request.shape = random.unit() < 0.5 ? RoofShape::gabled : RoofShape::hipped;
    request.measures = {kEaves, 3};
    const auto built = build_roof(plan, request);
    if (!built || roof_checks::validity(plan, built->roof) != "none") continue;
    const Dressed house = dress(plan, built->roof);
    ASSERT_EQ(fault(masses::envelope(plan, 0, built->roof, {}), house.bodies), "") << seed;
    gutter_count += house.count(RoofElementKind::gutter);
    pipes += house.count(RoofElementKind::downpipe);
    asked += house.gutters.asked;
    refused += house.gutters.refused;
  }
  EXPECT_GT(gutter_count, 1000);
  EXPECT_GT(pipes, 1000);
  EXPECT_LT(refused, asked / 50 + 1);
}

}  // namespace
}  // namespace blockrand::roofs
