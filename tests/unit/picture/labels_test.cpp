#include "pipeline/picture/labels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace blockrand::picture {
namespace {

using model::Point2;

std::vector<Label> placed(const std::vector<NamedLine>& lines, const LabelOptions& options = {}, int width = 800,
                          int height = 600) {
  return place_labels(lines, width, height, options, Lettering());
}

bool same(const Label& a, const Label& b) {
  return a.text == b.text && a.middle.x == b.middle.x && a.middle.y == b.middle.y && a.direction.x == b.direction.x &&
         a.direction.y == b.direction.y && a.size == b.size;
}

TEST(Labels, StandInTheMiddleOfTheirLine) {
  const auto labels = placed({{"High Street", 0, {{100, 300}, {700, 300}}}});
  ASSERT_EQ(labels.size(), 1u);
  EXPECT_NEAR(labels[0].middle.x, 400, 5);
  EXPECT_NEAR(labels[0].middle.y, 300, 1e-9);
  EXPECT_EQ(labels[0].direction.x, 1);
  EXPECT_NEAR(labels[0].start().y, 300 + labels[0].size * kSmallLetters / 2, 1e-9) << "half an x below the line";
}

TEST(Labels, AreNeverUpsideDown) {
  for (int degrees = 0; degrees < 360; degrees += 5) {
    const double a = degrees * 0.017453292519943295;
    const Point2 d{250 * std::cos(a), 250 * std::sin(a)};
    const auto labels = placed({{"Ring", 0, {{400 - d.x, 300 - d.y}, {400 + d.x, 300 + d.y}}}});
    ASSERT_EQ(labels.size(), 1u) << degrees;
    const Point2 r = labels[0].direction;
    EXPECT_NEAR(r.x * r.x + r.y * r.y, 1, 1e-12);
    EXPECT_GT(r.x, -2e-3) << degrees;
    if (std::fabs(r.x) < 1e-6) {
      EXPECT_LT(r.y, 0) << "upright: read from below";
    }
  }
}

TEST(Labels, PiecesOfOneStreetAreOneLine) {
  // Each piece alone is too short for the name.
  const std::string name = "Long Name of a Street";
  std::vector<NamedLine> lines;
  for (int i = 0; i < 8; ++i) {
    const double a = 200 + 40 * i, b = 240 + 40 * i;
    if (i % 2 == 0)
      lines.push_back({name, 0, {{a, 100}, {b, 100}}});
    else
      lines.push_back({name, 0, {{b, 100}, {a, 100}}});
  }
  const auto labels = placed(lines);
  ASSERT_EQ(labels.size(), 1u);
  EXPECT_GT(labels[0].width, 100);
  EXPECT_TRUE(placed({lines[0]}).empty()) << "no room: no label";
}

TEST(Labels, TakeTheStraightStretch) {
  std::vector<Point2> line;
  for (int i = 0; i <= 40; ++i)  // a bend of 90 degrees with a radius of 60 px, then straight on
    line.push_back({100 + 60 * std::sin(i * 0.03927), 200 - 60 * std::cos(i * 0.03927)});
  line.push_back({160, 420});
  const auto labels = placed({{"Crescent Road", 0, line}});
  ASSERT_EQ(labels.size(), 1u);
  EXPECT_GT(labels[0].middle.y, 200);
  EXPECT_NEAR(labels[0].middle.x, 160, 3);
  std::vector<Point2> circle;
  for (int i = 0; i <= 60; ++i) circle.push_back({400 + 25 * std::cos(i * 0.10472), 300 + 25 * std::sin(i * 0.10472)});
  EXPECT_TRUE(placed({{"Roundabout", 0, circle}}).empty());
}

TEST(Labels, ImportantOnesComeFirstAndLarger) {
  // Both cross in the middle of both: there is room for one of them there, and nowhere else.
  const double room = Lettering().width("Main Street", 16) + 40;
  const std::vector<NamedLine> lines{{"Side Street", 1, {{400 - room / 2, 300}, {400 + room / 2, 300}}},
                                     {"Main Street", 0, {{400, 300 - room / 2}, {400, 300 + room / 2}}}};
  const auto labels = placed(lines);
  ASSERT_EQ(labels.size(), 1u);
  EXPECT_EQ(labels[0].text, "Main Street");
  EXPECT_DOUBLE_EQ(labels[0].size, 16 * 1.2);
}

TEST(Labels, LongStreetsAreNamedAgain) {
  LabelOptions options;
  options.apart = 300;
  const auto labels = placed({{"Avenue", 0, {{-500, 200}, {2000, 200}}}}, options);
  ASSERT_GE(labels.size(), 2u);
  for (std::size_t i = 1; i < labels.size(); ++i) EXPECT_GE(std::fabs(labels[i].middle.x - labels[0].middle.x), 300);
  options.apart = 0;
  EXPECT_EQ(placed({{"Avenue", 0, {{-500, 200}, {2000, 200}}}}, options).size(), 1u);
}

TEST(Labels, MoveToWhereTheyCoverLeast) {
  LabelOptions options;
  options.covers = [](int x, int) { return x < 450 ? 1.0 : 0.0; };
  const auto labels = placed({{"Lane", 0, {{50, 300}, {750, 300}}}}, options);
  ASSERT_EQ(labels.size(), 1u);
  EXPECT_GT(labels[0].middle.x - labels[0].width / 2, 440);
}

TEST(Labels, KeepFromWhatIsTaken) {
  const std::array<std::array<Point2, 4>, 1> taken{{{{{250, 250}, {550, 250}, {550, 350}, {250, 350}}}}};
  const auto labels =
      place_labels(std::vector<NamedLine>{{"Lane", 0, {{50, 300}, {750, 300}}}}, 800, 600, {}, Lettering(), taken);
  ASSERT_EQ(labels.size(), 1u);
  EXPECT_FALSE(overlap(labels[0].corners(), taken[0]));
}

TEST(Labels, OverlapIsThatOfTurnedBoxes) {
  const std::array<Point2, 4> a{{{0, 0}, {10, 0}, {10, 10}, {0, 10}}},
      beside{{{10.5, 0}, {20, 0}, {20, 10}, {10.5, 10}}}, turned{{{15, 5}, {20, 10}, {15, 15}, {10, 10}}},
      crossing{{{5, -5}, {15, 5}, {5, 15}, {-5, 5}}};
  EXPECT_FALSE(overlap(a, beside));
  EXPECT_TRUE(overlap(a, beside, 1));
  EXPECT_FALSE(overlap(a, turned)) << "their boxes along the axes meet, they do not";
  EXPECT_TRUE(overlap(a, crossing));
}

TEST(Labels, OfATownNeverOverlapAndStayInside) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() % 10000) / 10000;
  };
  std::vector<NamedLine> lines;
  for (int i = 0; i < 160; ++i) {
    NamedLine line{"Street no " + std::to_string(i % 110), i % 3, {{between(-200, 1000), between(-200, 800)}}};
    double heading = between(0, 6.28);
    for (int k = 0; k < 6; ++k) {
      heading += between(-0.3, 0.3);
      line.points.push_back(
          {line.points.back().x + 70 * std::cos(heading), line.points.back().y + 70 * std::sin(heading)});
    }
    lines.push_back(std::move(line));
  }
  LabelOptions options;
  options.size = 13;
  const auto labels = placed(lines, options);
  EXPECT_GT(labels.size(), 25u);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    for (const Point2 p : labels[i].corners()) {
      EXPECT_GE(std::min(p.x, p.y), options.margin);
      EXPECT_LE(p.x, 800 - options.margin);
      EXPECT_LE(p.y, 600 - options.margin);
    }
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_FALSE(overlap(labels[i].corners(), labels[k].corners(), options.between))
          << labels[i].text << ", " << labels[k].text;
  }
  // Neither the order of lines nor their direction matters.
  std::vector<NamedLine> other(lines.rbegin(), lines.rend());
  for (NamedLine& line : other) std::reverse(line.points.begin(), line.points.end());
  const auto again = placed(other, options);
  EXPECT_TRUE(std::equal(labels.begin(), labels.end(), again.begin(), again.end(), same));
}

TEST(Labels, NothingToNameIsNothing) {
  EXPECT_TRUE(placed({}).empty());
  EXPECT_TRUE(
      placed({{"", 0, {{0, 100}, {800, 100}}}, {"Point", 0, {{5, 5}}}, {"Still", 0, {{9, 9}, {9, 9}}}}).empty());
  EXPECT_TRUE(placed({{"Outside", 0, {{900, 100}, {1800, 100}}}}).empty());
}

}  // namespace
}  // namespace blockrand::picture
