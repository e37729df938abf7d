#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "styles/masonry/bond_joints.h"
#include "tests/unit/masonry/masonry_walls.h"

namespace blockrand::masonry {
namespace {

TEST(BondJoints, NoUprightJointLiesAboveAnother) {
  for (const Bond bond : {Bond::stretcher, Bond::header, Bond::english, Bond::flemish})
    for (double length = 0.6; length < 8; length += 0.0625) {
      const int quarters = quarters_of(bond, length, 0.0625);
      const std::vector<int> even = bond_joints(bond, quarters, false), odd = bond_joints(bond, quarters, true);
      ASSERT_FALSE(even.empty());
      for (const auto* course : {&even, &odd}) {
        int before = 0;
        for (const int at : *course) {
          EXPECT_GE(at - before, 1);
          EXPECT_LE(at - before, 4);
          before = at;
        }
        EXPECT_LE(quarters - before, 4);
        EXPECT_GE(quarters - before, 1);
      }
      std::vector<int> both;
      std::ranges::set_intersection(even, odd, std::back_inserter(both));
      EXPECT_TRUE(both.empty()) << kBondNames[static_cast<int>(bond)] << " " << quarters << ": " << both.front();
    }
}

TEST(BondJoints, EndsAlternateSoThatWallsAgreeRoundCorners) {
  for (const Bond bond : {Bond::stretcher, Bond::header, Bond::english, Bond::flemish})
    for (int quarters = 12; quarters < 120; ++quarters) {
      if (quarters != quarters_of(bond, quarters * 0.0625, 0.0625)) continue;
      const std::vector<int> even = bond_joints(bond, quarters, false), odd = bond_joints(bond, quarters, true);
      EXPECT_EQ(even.front(), 2);
      EXPECT_GE(odd.front(), 3);
      EXPECT_GE(quarters - even.back(), 3) << kBondNames[static_cast<int>(bond)] << quarters;
      EXPECT_EQ(quarters - odd.back(), 2) << kBondNames[static_cast<int>(bond)] << quarters;
    }
}

// Words of the trade: English bond has a course of headers above each of stretchers; Flemish has both in each course.
TEST(Bonds, HaveTheStonesThatTheirNamesSay) {
  const auto roles = [](Bond bond) {
    std::map<int, std::map<StoneRole, int>> out;
    for (const Stone& s : stones_of(plain_wall(10, 2), usual_masonry(bond))) ++out[s.course % 2][s.role];
    return out;
  };
  auto stretcher = roles(Bond::stretcher);
  EXPECT_GT(stretcher[0][StoneRole::stretcher], 10 * stretcher[0][StoneRole::header]);
  auto header = roles(Bond::header);
  EXPECT_GT(header[0][StoneRole::header], 30 * header[0][StoneRole::stretcher]);
  auto english = roles(Bond::english);
  EXPECT_GT(english[0][StoneRole::stretcher], 10 * english[0][StoneRole::header]);
  EXPECT_GT(english[1][StoneRole::header], 10 * english[1][StoneRole::stretcher]);
  EXPECT_GT(english[0][StoneRole::closer], 0);
  auto flemish = roles(Bond::flemish);
  for (const int odd : {0, 1})
    EXPECT_NEAR(flemish[odd][StoneRole::stretcher], flemish[odd][StoneRole::header],
                0.15 * flemish[odd][StoneRole::header]);
}

// Twelve courses of Normalformat make a metre (DIN 4172), thirteen of Reichsformat.
TEST(Bonds, CoursesOfAMetre) {
  const auto courses = [](const BrickFormat& f) { return 1 / (f.height + f.bed); };
  EXPECT_NEAR(courses(kBrickFormats[0]), 12, 0.01);
  EXPECT_NEAR(courses(kBrickFormats[1]), 16, 0.01);
  EXPECT_NEAR(courses(kBrickFormats[2]), 13, 0.02);
  int highest = 0;
  for (const Stone& s : stones_of(plain_wall(4, 3), usual_masonry(Bond::stretcher)))
    highest = std::max(highest, s.course);
  EXPECT_EQ(highest, 35);
}

TEST(Bonds, QuoinsOfTwoWallsAgreeInEachCourse) {
  for (const Bond bond : kAllBonds) {
    WallToLay before = plain_wall(7.3, 4), after = plain_wall(5.1, 4);
    before.corner_right = after.corner_left = true;
    std::map<int, double> ends, begins;
    const auto width = [](const Stone& s) {
      double low = 1e300, high = -1e300;
      for (const auto& p : s.outline) low = std::min(low, p.x), high = std::max(high, p.x);
      return high - low;
    };
    for (const Stone& s : stones_of(before, usual_masonry(bond)))
      if (s.at_right) ends[s.course] = width(s);
    for (const Stone& s : stones_of(after, usual_masonry(bond)))
      if (s.at_left) begins[s.course] = width(s);
    ASSERT_GT(ends.size(), 7u) << kBondNames[static_cast<int>(bond)];
    ASSERT_EQ(ends.size(), begins.size());
    for (const auto& [course, end] : ends) {
      ASSERT_TRUE(begins.contains(course));
      const double long_one = course % 2 == 0 ? end : begins[course],
                   short_one = course % 2 == 0 ? begins[course] : end;
      EXPECT_GT(long_one, short_one * 1.3) << kBondNames[static_cast<int>(bond)] << " " << course;
    }
  }
}

}  // namespace
}  // namespace blockrand::masonry
