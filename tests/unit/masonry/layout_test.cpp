// What holds of every laid wall: GEOS judges areas, the layout has none of it but for cuts.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/footprint_overlap.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "tests/unit/masonry/masonry_walls.h"

namespace blockrand::masonry {
namespace {

using model::Polygon;

std::vector<Polygon> polygons_of(const LaidWall& laid) {
  std::vector<Polygon> out;
  for (const Stone& s : laid.stones) out.push_back(polygon_of(s.outline));
  return out;
}

double bare_area(const WallToLay& wall) {
  double out = geometry::signed_area(wall.outline);
  for (const Outline& o : wall.openings) out -= geometry::signed_area(o);
  return out;
}

double stones_area(const LaidWall& laid) {
  double out = 0;
  for (const Stone& s : laid.stones) out += geometry::signed_area(s.outline);
  return out;
}

struct Extent {
  double left = 1e300, right = -1e300, low = 1e300, high = -1e300;
};
Extent extent_of(const Outline& outline) {
  Extent e;
  for (const auto& p : outline)
    e.left = std::min(e.left, p.x), e.right = std::max(e.right, p.x), e.low = std::min(e.low, p.y),
    e.high = std::max(e.high, p.y);
  return e;
}

/// m2 that rounding to the grid may give two stones or a stone and an opening in common.
constexpr double kRounding = 0.0006;

/// m that points of cut stones lie off a slanting edge at most.
constexpr double kOffGrid = 0.0007;

void expect_sound(const WallToLay& wall, const LaidWall& laid, const std::string& what) {
  const std::vector<Polygon> stones = polygons_of(laid);
  const std::vector<Polygon> outline{polygon_of(wall.outline)};
  std::vector<Extent> extents;
  for (const Stone& s : laid.stones) extents.push_back(extent_of(s.outline));
  for (std::size_t i = 0; i < stones.size(); ++i) {
    const std::vector<Polygon> one{stones[i]};
    const double area = geometry::signed_area(stones[i].outer.points);
    ASSERT_GT(area, 0) << what << " " << text_of(laid.stones[i]);
    ASSERT_TRUE(geometry::strictly_simple(stones[i])) << what << " " << text_of(laid.stones[i]);
    EXPECT_NEAR(geometry::common_area(one, outline), area, kRounding + kOffGrid * geometry::perimeter(stones[i]))
        << what << " " << text_of(laid.stones[i]);
    for (const Outline& o : wall.openings) {
      const Extent e = extent_of(o);
      if (e.left > extents[i].right || e.right < extents[i].left || e.low > extents[i].high || e.high < extents[i].low)
        continue;
      const std::vector<Polygon> hole{polygon_of(o)};
      EXPECT_LT(geometry::common_area(one, hole), kRounding) << what << " " << text_of(laid.stones[i]);
    }
    for (std::size_t j = i + 1; j < stones.size(); ++j) {
      if (extents[j].left > extents[i].right || extents[j].right < extents[i].left ||
          extents[j].low > extents[i].high || extents[j].high < extents[i].low)
        continue;
      const std::vector<Polygon> other{stones[j]};
      EXPECT_LT(geometry::common_area(one, other), kRounding)
          << what << " " << text_of(laid.stones[i]) << " | " << text_of(laid.stones[j]);
    }
  }
}

TEST(MasonryLayout, StonesOfAHouseFrontDoNotOverlapAndKeepOutOfOpenings) {
  for (const Bond bond : kAllBonds) {
    const WallToLay wall = front_wall();
    const auto laid = lay(wall, usual_masonry(bond));
    ASSERT_TRUE(laid);
    expect_sound(wall, *laid, std::string(kBondNames[static_cast<int>(bond)]));
  }
}

TEST(MasonryLayout, StonesOfRandomWallsDoNotOverlapAndKeepOutOfOpenings) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed)
    for (const Bond bond : kAllBonds) {
      const WallToLay wall = random_wall(seed * 7 + static_cast<std::uint64_t>(bond));
      const auto laid = lay(wall, usual_masonry(bond));
      ASSERT_TRUE(laid);
      expect_sound(wall, *laid, fmt::format("{} {}", kBondNames[static_cast<int>(bond)], wall.seed));
    }
}

// Of a wall of Normalformat stones are 240 x 71 of 250 x 83.3: 81.8 %; of stretchers and headers in turn 80.1 %. The rest of the
// bounds is what rows under eaves and cuts at gables and arches leave.
TEST(MasonryLayout, StonesCoverTheWallButForJoints) {
  struct Row {
    Bond bond;
    double least, most;
  };
  for (const Row& row : {Row{Bond::stretcher, 0.78, 0.83}, Row{Bond::header, 0.75, 0.80},
                         Row{Bond::english, 0.76, 0.82}, Row{Bond::flemish, 0.76, 0.82}, Row{Bond::ashlar, 0.89, 0.95},
                         Row{Bond::rubble, 0.78, 0.92}, Row{Bond::cyclopean, 0.84, 0.96}}) {
    const WallToLay wall = front_wall();
    const auto laid = lay(wall, usual_masonry(row.bond));
    const double share = stones_area(*laid) / bare_area(wall);
    EXPECT_GT(share, row.least) << kBondNames[static_cast<int>(row.bond)];
    EXPECT_LT(share, row.most) << kBondNames[static_cast<int>(row.bond)];
    RecordProperty(std::string(kBondNames[static_cast<int>(row.bond)]), fmt::format("{:.3f}", share));
  }
}

TEST(MasonryLayout, CoursesAreLevelAndBeginAtTheGround) {
  for (const Bond bond : {Bond::stretcher, Bond::header, Bond::english, Bond::flemish, Bond::ashlar}) {
    WallToLay wall = front_wall();
    wall.ground = -0.2;  // the wall begins above the ground of the house
    const Masonry masonry = usual_masonry(bond);
    const auto laid = lay(wall, masonry);
    int lowest = 1000;
    for (const Stone& s : laid->stones) {
      if (s.course < 0) continue;
      lowest = std::min(lowest, s.course);
      const Extent e = extent_of(s.outline);
      const double low = wall.ground + s.course * masonry.course() + masonry.bed / 2;
      EXPECT_GT(e.low, low - 0.001) << text_of(s);
      EXPECT_LT(e.high, low + masonry.height + 0.001) << text_of(s);
      // What is not cut by an arch or the gable fills its course.
      if (s.outline.size() == 4 && e.high < 2 && e.low > 0.05) {
        EXPECT_NEAR(e.low, low, 0.002) << text_of(s);
        EXPECT_NEAR(e.high, low + masonry.height, 0.002) << text_of(s);
      }
    }
    EXPECT_LE(lowest, static_cast<int>(0.2 / masonry.course()) + 1);
  }
}

TEST(MasonryLayout, NoPieceIsASliver) {
  for (const Bond bond : kAllBonds)
    for (std::uint64_t seed = 50; seed < 60; ++seed) {
      const WallToLay wall = random_wall(seed);
      const Masonry masonry = usual_masonry(bond);
      const auto laid = lay(wall, masonry);
      std::size_t narrow = 0;
      for (const Stone& s : laid->stones) {
        if (s.role == StoneRole::sill || s.role == StoneRole::lintel || s.role == StoneRole::voussoir ||
            s.role == StoneRole::keystone)
          continue;
        const Extent e = extent_of(s.outline);
        // A quarter brick less its joint, up to a tenth shorter in short runs.
        const double closer = (masonry.length + masonry.perpend) / 4 - masonry.perpend;
        if (is_brick(bond) && e.right - e.left < closer * 0.8) ++narrow;
        if (!has_courses(bond)) {
          EXPECT_GT(geometry::signed_area(s.outline), 0.09 * masonry.length * masonry.height) << text_of(s);
        }
      }
      EXPECT_LE(narrow, laid->forced) << kBondNames[static_cast<int>(bond)] << " " << seed;
    }
}

TEST(MasonryLayout, SameSeedSameStonesAndAnotherSeedOthers) {
  for (const Bond bond : kAllBonds) {
    const auto text = [&](std::uint64_t seed) {
      std::string out;
      for (const Stone& s : stones_of(front_wall(seed), usual_masonry(bond))) out += text_of(s) + "\n";
      return out;
    };
    EXPECT_EQ(text(1), text(1));
    EXPECT_NE(text(1), text(2));  // of bricks the shades
  }
}

TEST(MasonryLayout, CellsAreConvexButWhereOpeningsOrGablesCutThem) {
  for (const Bond bond : {Bond::rubble, Bond::cyclopean}) {
    const auto whole = lay(plain_wall(8, 5), usual_masonry(bond));
    ASSERT_GT(whole->stones.size(), 50u);
    for (const Stone& s : whole->stones) {
      const std::size_t n = s.outline.size();
      for (std::size_t i = 0; i < n; ++i) {
        const auto &a = s.outline[i], &b = s.outline[(i + 1) % n], &c = s.outline[(i + 2) % n];
        EXPECT_GT((b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x), -1e-5) << text_of(s);
      }
    }
    // Corners of openings have joints of their own: few cells bend round one.
    WallToLay wall = front_wall();
    wall.corner_left = wall.corner_right = false;  // toothed quoins bend what they tooth into
    const auto front = lay(wall, usual_masonry(bond));
    std::size_t bent = 0, fields = 0;
    for (const Stone& s : front->stones) {
      if (s.role != StoneRole::field) continue;
      ++fields;
      const std::size_t n = s.outline.size();
      bool bends = false;
      for (std::size_t i = 0; i < n; ++i) {
        const auto &a = s.outline[i], &b = s.outline[(i + 1) % n], &c = s.outline[(i + 2) % n];
        const double turn = (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
        const double lengths = std::hypot(b.x - a.x, b.y - a.y) * std::hypot(c.x - b.x, c.y - b.y);
        bends = bends || turn < -0.5 * lengths;  // by 30 degrees
      }
      bent += bends;
    }
    EXPECT_LT(static_cast<double>(bent), 0.15 * static_cast<double>(fields));
  }
}

TEST(MasonryLayout, SizesThatMakeNoSenseAreRefused) {
  Masonry masonry = usual_masonry(Bond::stretcher);
  masonry.length = 0;
  EXPECT_FALSE(lay(plain_wall(5, 3), masonry));
  masonry = usual_masonry(Bond::stretcher);
  masonry.perpend = 0.06;
  EXPECT_FALSE(lay(plain_wall(5, 3), masonry));
  masonry = usual_masonry(Bond::cyclopean);
  masonry.height = std::nan("");
  EXPECT_FALSE(lay(plain_wall(5, 3), masonry));
}

TEST(MasonryLayout, WhatOtherBodiesCoverIsNotLaid) {
  WallToLay wall = plain_wall(6, 3);
  const std::size_t all = lay(wall, usual_masonry(Bond::stretcher))->stones.size();
  wall.covered = {rectangle(-1, -1, 7, 0.5)};
  const auto laid = lay(wall, usual_masonry(Bond::stretcher));
  EXPECT_LT(laid->stones.size(), all);
  for (const Stone& s : laid->stones) EXPECT_GT(extent_of(s.outline).high, 0.5);
}

}  // namespace
}  // namespace blockrand::masonry
