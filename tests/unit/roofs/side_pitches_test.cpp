// Roofs whose sides have pitches of their own.
#include "pipeline/model/side_pitches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "styles/roofs/roof.h"
#include "tests/unit/roofs/roof_checks.h"

namespace blockrand::roofs {
namespace {

using model::Point2;
using model::Point3;
using model::Polygon;
using model::RoofEdge;
using model::RoofShape;
using testing::HasSubstr;
using testing_shapes::polygon;
using testing_shapes::Random;

TEST(SidePitches, AreReadAndWritten) {
  const auto read = model::parse_side_pitches(" street 60,yard 30 ; north 45");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(model::text(*read), "street 60, yard 30, north 45");
  for (const auto& [text, wrong] : {std::pair{"", "begins with no side"},
                                    {"front 40", "begins with no side"},
                                    {"street", "whole number"},
                                    {"street 3", "5 to 80"},
                                    {"street 81", "5 to 80"},
                                    {"street 40.5", "whole number"},
                                    {"street 40, street 50", "twice"},
                                    {"street 40,", "no side"}}) {
    const auto none = model::parse_side_pitches(text);
    ASSERT_FALSE(none.has_value()) << text;
    EXPECT_THAT(none.error(), HasSubstr(wrong)) << text;
  }
}

/// Degrees of the slope that rises from a plan edge, measured on its surface.
double pitch_of(const Roof& roof, std::int32_t edge) {
  for (const Roof::Surface& s : roof.surfaces) {
    if (s.edge != edge || s.upright) continue;
    Point3 n;
    const auto& loop = s.loops[0];
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point3 a = loop[i], b = loop[(i + 1) % loop.size()];
      n.x += (a.y - b.y) * (a.z + b.z), n.y += (a.z - b.z) * (a.x + b.x), n.z += (a.x - b.x) * (a.y + b.y);
    }
    return std::atan2(std::hypot(n.x, n.y), n.z) * 180 / M_PI;
  }
  return 0;
}

const Polygon kHouse = polygon({{0, 0}, {14, 0}, {14, 10}, {0, 10}});  // edges: south, east, north, west

RoofRequest request_of(RoofShape shape, const char* pitches, double others) {
  RoofRequest request;
  request.shape = shape;
  request.edges = {RoofEdge::street, RoofEdge::open, RoofEdge::courtyard, RoofEdge::open};
  request.side_pitches = *model::parse_side_pitches(pitches);
  request.other_sides_pitch = others;
  request.measures.eaves = 40;
  const MainSlope slope = main_slope(kHouse, request, true);
  request.measures.height = slope.run * std::tan(others * M_PI / 180) / slope.rise;
  return request;
}

TEST(SidePitches, StandAsOrderedOnEverySide) {
  for (const RoofShape shape : {RoofShape::hipped, RoofShape::gabled, RoofShape::half_hipped}) {
    const auto built = build_roof(kHouse, request_of(shape, "street 60, yard 30", 45));
    ASSERT_TRUE(built.has_value());
    EXPECT_EQ(roof_checks::validity(kHouse, built->roof), "none");
    EXPECT_NEAR(pitch_of(built->roof, 0), 60, 0.1) << static_cast<int>(shape);
    EXPECT_NEAR(pitch_of(built->roof, 2), 30, 0.1) << static_cast<int>(shape);
    EXPECT_EQ(model::text(built->pitches_met), "street 60, yard 30");
  }
  const auto quarters = build_roof(kHouse, request_of(RoofShape::hipped, "north 25, east 70", 40));
  const double wanted[] = {40, 70, 25, 40};
  for (std::int32_t e = 0; e < 4; ++e) EXPECT_NEAR(pitch_of(quarters->roof, e), wanted[e], 0.1) << e;
}

TEST(SidePitches, WhatNoSideHasIsNotMet) {
  // A gabled house with its ridge from west to east has no slope to the east; without streets none to the street.
  RoofRequest request = request_of(RoofShape::gabled, "east 50, north 30", 45);
  EXPECT_EQ(model::text(build_roof(kHouse, request)->pitches_met), "north 30");
  request = request_of(RoofShape::hipped, "street 50", 45);
  request.edges.clear();
  EXPECT_EQ(model::text(build_roof(kHouse, request)->pitches_met), "");
  EXPECT_EQ(model::text(build_roof(kHouse, request_of(RoofShape::mansard, "street 50", 45))->pitches_met), "");
}

TEST(SidePitches, MakeValidRoofsOnAnyPlan) {
  int built_count = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    Random random(seed);
    const Polygon plan = roof_checks::moved(roof_checks::random_plan(random), 360 * random.unit(), {});
    RoofRequest request;
    request.shape = random.unit() < 0.5 ? RoofShape::gabled : RoofShape::hipped;
    request.measures = {40, 5};
    request.other_sides_pitch = 40;
    for (std::uint8_t& d : request.side_pitches.degrees)
      d = static_cast<std::uint8_t>(random.unit() < 0.5 ? 0 : 15 + random.next(60));
    bool valid = false;  // with the tries of a build
    for (const double coarseness : kCoarseness) {
      request.coarseness = coarseness;
      const auto built = build_roof(plan, request);
      ASSERT_TRUE(built.has_value()) << seed;
      if ((valid = roof_checks::validity(plan, built->roof) == "none")) break;
    }
    built_count += valid;
  }
  EXPECT_GE(built_count, 399);
}

}  // namespace
}  // namespace blockrand::roofs
