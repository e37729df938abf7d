// The edge language of openings (docs/sources.md, Finkenzeller 3.11.1 and 2).
#include "styles/elements/opening_edges.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/base/random.h"

namespace blockrand::elements {
namespace {

using model::Point2;
using testing::HasSubstr;

const OpeningRectangle kRectangle{1, 2, 3, 6};  // 2 m wide, 4 m high

Profile arch() {
  const auto program = parse_profile("Modifications { arc, abs, 0, 180, 1; }");
  return trace(program.value(), 4);
}

TEST(OpeningOutline, PlainEdgesGiveTheRectangle) {
  const auto outline = opening_outline(kRectangle, {}, false);
  ASSERT_TRUE(outline.has_value()) << outline.error();
  EXPECT_EQ(*outline, (Outline{{1, 2}, {3, 2}, {3, 6}, {1, 6}}));
}

TEST(OpeningOutline, TheDigestsExample) {
  // Top and bottom dominant, only the top has a size.
  OpeningEdges edges;
  edges[0].dominant = edges[2].dominant = true;
  edges[0].dist_left = 0.125;
  edges[0].dist_right = 0.25;
  edges[1].dist_inward = 0.125;
  edges[2].dist_left = 0.0625;
  edges[2].dist_right = 0.125;
  edges[2].size = 0.25;
  edges[3].dist_inward = 0.0625;
  const auto outline = opening_outline(kRectangle, edges, false);
  ASSERT_TRUE(outline.has_value()) << outline.error();
  // b_l, b_r, r_l, r_r = t_l, t_r = l_l, l_r of the formulas.
  EXPECT_EQ((*outline)[0], (Point2{1.25, 2}));
  EXPECT_EQ((*outline)[1], (Point2{2.5, 2}));
  EXPECT_EQ((*outline)[2], (Point2{2.75, 2}));
  EXPECT_EQ((*outline)[3], (Point2{2.75, 5}));
  EXPECT_EQ((*outline)[4], (Point2{1.125, 5}));
  EXPECT_EQ((*outline)[5], (Point2{1.125, 2}));
  EXPECT_EQ(outline->size(), 6u);
}

TEST(OpeningOutline, ArchesSpringAtTheStripAndTouchTheRim) {
  OpeningEdges edges;
  edges[2].size = 0.25;
  edges[2].profile = arch();
  const auto outline = opening_outline(kRectangle, edges, false);
  ASSERT_TRUE(outline.has_value()) << outline.error();
  const Bounds2 box = bounds_of(*outline);
  EXPECT_EQ(box.most.y, 6);
  EXPECT_EQ(outline->size(), 2u + 9u);
  EXPECT_THAT(*outline, testing::Contains(Point2{3, 5}));
  EXPECT_THAT(*outline, testing::Contains(Point2{2, 6}));
  EXPECT_THAT(*outline, testing::Contains(Point2{1, 5}));
  EXPECT_TRUE(is_simple(*outline));
}

TEST(OpeningOutline, AsymmetricHeadsLookAsDrawn) {
  // Steep on the left, flat on the right: the highest point lies in the viewer's left half.
  OpeningEdges edges;
  edges[2].size = 0.2;
  edges[2].profile = Profile{{{0, 0}, {1, 1}, {4, 0}}, 0};
  const auto outline = opening_outline(kRectangle, edges, false);
  ASSERT_TRUE(outline.has_value()) << outline.error();
  EXPECT_THAT(*outline, testing::Contains(Point2{1.5, 6}));
}

TEST(OpeningOutline, DoorsKeepTheirFloor) {
  OpeningEdges edges;
  edges[0] = {true, 0.2, 0.2, 0.1, 0.2, arch()};
  const auto outline = opening_outline(kRectangle, edges, true);
  ASSERT_TRUE(outline.has_value()) << outline.error();
  EXPECT_EQ(*outline, (Outline{{1, 2}, {3, 2}, {3, 6}, {1, 6}}));
}

/// FK-66: with alternating dominance, every combination of edges with and without size gives a simple opening inside.
TEST(OpeningOutline, AllSixteenCombinationsOfSizesAreSimple) {
  for (const bool jambs_dominant : {false, true})
    for (int mask = 0; mask < 16; ++mask) {
      OpeningEdges edges;
      for (std::size_t k = 0; k < 4; ++k) {
        edges[k].dominant = (k % 2 == 1) == jambs_dominant;
        if (mask >> k & 1) {
          edges[k].size = 0.2;
          edges[k].profile = arch();
        }
      }
      const auto outline = opening_outline(kRectangle, edges, false);
      ASSERT_TRUE(outline.has_value()) << mask << outline.error();
      EXPECT_TRUE(is_simple(*outline)) << mask;
      EXPECT_GT(signed_area(*outline), 0) << mask;
      const Bounds2 box = bounds_of(*outline);
      EXPECT_EQ(box.least, (Point2{1, 2})) << mask << ": arches touch the rim";
      EXPECT_EQ(box.most, (Point2{3, 6})) << mask;
    }
}

TEST(OpeningOutline, RefusesWhatIsNone) {
  OpeningEdges edges;
  edges[0].dominant = edges[1].dominant = true;
  EXPECT_THAT(opening_outline(kRectangle, edges, false).error(), HasSubstr("cannot both be dominant"));
  edges = {};
  edges[0].dist_inward = edges[2].dist_inward = 0.5;
  EXPECT_THAT(opening_outline(kRectangle, edges, false).error(), HasSubstr("nothing is left"));
  edges = {};
  edges[1].size = 1.5;
  EXPECT_THAT(opening_outline(kRectangle, edges, false).error(), HasSubstr("shares from 0 to 1"));
  edges = {};
  edges[2].size = 0.2;
  edges[2].profile = Profile{{{0, 0}, {1, 1}, {2, 0.5}}, 0};
  EXPECT_THAT(opening_outline(kRectangle, edges, false).error(), HasSubstr("same height at its end"));
}

TEST(OpeningOutline, RandomEdgesGiveSimpleOpeningsInsideOrAnError) {
  int built = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    OpeningEdges edges;
    std::uint64_t n = 0;
    const auto draw = [&] { return base::random_unit(seed, n++, "edges"); };
    for (OpeningEdge& e : edges) {
      e.dominant = draw() < 0.3;
      e.dist_left = draw() < 0.5 ? 0 : 0.5 * draw();
      e.dist_right = draw() < 0.5 ? 0 : 0.5 * draw();
      e.dist_inward = draw() < 0.5 ? 0 : 0.5 * draw();
      e.size = draw() < 0.5 ? 0 : 0.6 * draw();
      if (draw() < 0.6) e.profile = arch();
    }
    const auto outline = opening_outline(kRectangle, edges, draw() < 0.3);
    if (!outline) {
      EXPECT_FALSE(outline.error().empty());
      continue;
    }
    ++built;
    ASSERT_TRUE(is_simple(*outline)) << seed;
    ASSERT_GT(signed_area(*outline), 0) << seed;
    const Bounds2 box = bounds_of(*outline);
    ASSERT_TRUE(box.least.x >= 1 && box.least.y >= 2 && box.most.x <= 3 && box.most.y <= 6) << seed;
  }
  EXPECT_GT(built, 700);
}

}  // namespace
}  // namespace blockrand::elements
