#include "pipeline/picture/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "pipeline/base/sha256.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/wall_segment_colours.h"
#include "pipeline/picture/building_plan.h"
#include "tests/unit/outputs/row_sample.h"

namespace blockrand::picture {
namespace {

using model::Colour;
using model::Point2;
using model::WallSegmentKind;
using outputs::test::kRowX;
using outputs::test::kRowY;

constexpr Colour kWhite{255, 255, 255}, kBlack{0, 0, 0};

model::Polygon polygon(std::vector<Point2> outer, std::vector<Point2> hole = {}) {
  model::Polygon p;
  p.outer.points = std::move(outer);
  p.outer.nodes.assign(p.outer.size(), 0);
  if (!hole.empty()) p.holes.push_back({std::move(hole), {}});
  return p;
}

Colour at(const Plan& plan, double x, double y) {
  const std::uint8_t* p = plan.image().pixel(static_cast<int>((x - plan.box().min_x) / plan.metres_per_pixel()),
                                             static_cast<int>((plan.box().max_y - y) / plan.metres_per_pixel()));
  return {p[0], p[1], p[2]};
}

/// Area that is black, in m²: grey pixels count by their darkness.
double inked(const Plan& plan) {
  double sum = 0;
  for (std::size_t i = 0; i < plan.image().rgb.size(); i += 3) sum += (255 - plan.image().rgb[i]) / 255.0;
  return sum * plan.metres_per_pixel() * plan.metres_per_pixel();
}

TEST(Plan, NorthIsUpAndEastIsRight) {
  Plan plan({100, 200, 110, 220}, 4);
  EXPECT_EQ(plan.image().width, 40);
  EXPECT_EQ(plan.image().height, 80);
  plan.fill(polygon({{100, 215}, {105, 215}, {105, 220}, {100, 220}}), kBlack);
  EXPECT_EQ(at(plan, 102, 218), kBlack);
  EXPECT_EQ(at(plan, 108, 218), kWhite);
  EXPECT_EQ(at(plan, 102, 205), kWhite);
  EXPECT_EQ(*plan.image().pixel(0, 0), 0);
}

TEST(Plan, CoverageIsExact) {
  // Obliquely cut, with a hole, partly outside of the paper.
  const model::Polygon p = polygon({{1.3, 1.7}, {17.9, 4.2}, {14.1, 16.8}, {5.7, 18.3}},
                                   {{8.1, 8.2}, {7.4, 11.9}, {11.6, 12.3}, {12.2, 9.1}});
  Plan plan({0, 0, 20, 20}, 7.3);
  plan.fill(p, kBlack);
  EXPECT_NEAR(inked(plan), geometry::area(p), 0.05);
  Plan beside({10, 0, 20, 20}, 7.3), other({0, 0, 10, 20}, 7.3);
  beside.fill(p, kBlack);
  other.fill(p, kBlack);
  EXPECT_NEAR(inked(beside) + inked(other), geometry::area(p), 0.1) << "cut at the border of the paper";
  Plan elsewhere({30, 0, 40, 20}, 7.3), around({6, 6, 7, 7}, 7.3);
  elsewhere.fill(p, kBlack);
  EXPECT_EQ(inked(elsewhere), 0);
  around.fill(p, kBlack);
  EXPECT_EQ(at(around, 6.5, 6.5), kBlack) << "all corners lie outside";
}

TEST(Plan, HolesStayEmpty) {
  Plan plan({0, 0, 20, 20}, 5);
  plan.fill(polygon({{2, 2}, {18, 2}, {18, 18}, {2, 18}}, {{8, 8}, {8, 12}, {12, 12}, {12, 8}}), kBlack);
  EXPECT_EQ(at(plan, 10, 10), kWhite);
  EXPECT_EQ(at(plan, 5, 10), kBlack);
}

TEST(Plan, LinesAreAsWideAsAsked) {
  Plan plan({0, 0, 40, 40}, 6);
  const Point2 line[] = {{5, 5}, {35, 12.5}};
  plan.stroke(line, 2, kBlack);
  const double length = std::sqrt(30.0 * 30 + 7.5 * 7.5);
  EXPECT_NEAR(inked(plan), 2 * length + 3.0615, 0.1) << "a rectangle and a disc of 16 corners";
  Plan bent({0, 0, 40, 40}, 6);
  const Point2 ring[] = {{10, 10}, {30, 10}, {30, 30}, {10, 30}};
  bent.stroke(ring, 1, kBlack, true);
  EXPECT_EQ(at(bent, 10, 20), kBlack) << "closed";
  EXPECT_EQ(at(bent, 20, 20), kWhite);
  EXPECT_EQ(at(bent, 10, 10), kBlack) << "no gap at corners";
}

TEST(Plan, OpacityMixes) {
  Plan plan({0, 0, 4, 4}, 2);
  plan.fill(polygon({{0, 0}, {4, 0}, {4, 4}, {0, 4}}), kBlack, 0.5);
  EXPECT_NEAR(at(plan, 2, 2).r, 128, 1);
}

TEST(Plan, ScaleBarHasARoundLength) {
  Plan plan({0, 0, 300, 200}, 3);
  EXPECT_EQ(plan.draw_scale_bar(), 50);
  EXPECT_LT(at(plan, 5 + 25, 5).r, 80) << "the bar, 14 pixels from the border";
  EXPECT_EQ(at(plan, 14.0 / 3 + 58, 5), kWhite) << "behind its end";
  Plan small({0, 0, 30, 20}, 20);
  EXPECT_EQ(small.draw_scale_bar(), 5);
}

TEST(Plan, SizesAreChecked) {
  EXPECT_THROW(Plan({0, 0, 0, 10}, 2), std::invalid_argument);
  EXPECT_THROW(Plan({0, 0, 10, 10}, 0), std::invalid_argument);
  EXPECT_THROW(Plan({0, 0, 10000, 10}, 1), std::invalid_argument);
  EXPECT_THROW(Plan({0, 0, NAN, 10}, 1), std::invalid_argument);
  EXPECT_EQ(Plan({0, 0, 10, 5}, scale_for({0, 0, 10, 5}, 1200)).image().width, 1200);
}

// ---- a neighbourhood
// ---------------------------------------------------------------------------------------------------

Plan row_plan() {
  const auto sample = outputs::test::row_sample();
  PlanTile tile = plan_tile(sample.region());
  tile.streets.push_back({{{kRowX - 20, kRowY}, {kRowX + 70, kRowY}}, 7});
  tile.streets.push_back({{{kRowX - 10, kRowY - 10}, {kRowX - 10, kRowY + 60}}, 7});
  tile.courtyards.push_back(
      polygon({{kRowX, kRowY + 22}, {kRowX + 30, kRowY + 22}, {kRowX + 30, kRowY + 39}, {kRowX, kRowY + 39}}));
  tile.blocks.push_back(
      polygon({{kRowX - 10, kRowY}, {kRowX + 60, kRowY}, {kRowX + 60, kRowY + 50}, {kRowX - 10, kRowY + 50}}));
  const PlanTile tiles[] = {tile};
  const PlanBox box = box_of(tiles);
  EXPECT_EQ(box.min_x, kRowX - 20);
  EXPECT_EQ(box.max_y, kRowY + 59);
  Plan plan(box, 12, kPlanPaper);
  draw(plan, tiles);
  plan.draw_scale_bar();
  return plan;
}

TEST(BuildingPlan, EdgesHaveTheColourOfTheirKind) {
  const Plan plan = row_plan();
  if (const char* path = std::getenv("BLOCKRAND_PLAN")) std::ofstream(path, std::ios::binary) << png(plan.image());
  const auto edge = [](WallSegmentKind kind) { return model::colour_of(kind); };
  EXPECT_EQ(at(plan, kRowX + 6, kRowY + 8.5), edge(WallSegmentKind::street));
  EXPECT_EQ(at(plan, kRowX + 20.5, kRowY + 8.5), edge(WallSegmentKind::passage));
  EXPECT_EQ(at(plan, kRowX + 20, kRowY + 21.5), edge(WallSegmentKind::courtyard));
  EXPECT_EQ(at(plan, kRowX + 44.5, kRowY + 15), edge(WallSegmentKind::side));
  for (const double x : {11.6, 12.4})
    EXPECT_EQ(at(plan, kRowX + x, kRowY + 15), edge(WallSegmentKind::party_wall)) << "of both";
  EXPECT_EQ(at(plan, kRowX + 20, kRowY + 15), kPlanBuilding);
  EXPECT_EQ(at(plan, kRowX + 20, kRowY + 30), kPlanCourtyard);
  EXPECT_EQ(at(plan, kRowX + 50, kRowY + 2), kPlanStreet);
  EXPECT_EQ(at(plan, kRowX + 50, kRowY + 25), kPlanPaper);
  EXPECT_LT(at(plan, kRowX + 60, kRowY + 25).g, 200) << "the border of the block, little more than a pixel wide";
}

TEST(BuildingPlan, TheSameBytesEachTime) {
  const std::string bytes = png(row_plan().image());
  EXPECT_EQ(bytes, png(row_plan().image()));
  EXPECT_GT(bytes.size(), 2000u);
}

TEST(BuildingPlan, WithoutContextOutlinesAreShown) {
  const auto zoo = outputs::test::SampleRegion::zoo();
  const PlanTile tile = plan_tile(zoo.region());
  EXPECT_EQ(tile.buildings.size(), 9u) << "of parts, since the zoo has no outlines; none of the halo";
  EXPECT_TRUE(tile.edges.empty());
  EXPECT_EQ(box_of({}).width(), 0);
}

// ---- colours
// -----------------------------------------------------------------------------------------------------------

struct Lab {
  double l, a, b;
};
using Rgb = std::array<double, 3>;
Rgb linear(Colour c) {
  Rgb out;
  const std::uint8_t v[] = {c.r, c.g, c.b};
  for (std::size_t i = 0; i < 3; ++i) {
    const double x = v[i] / 255.0;
    out[i] = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
  }
  return out;
}
Lab lab(const Rgb& c) {
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
  const double x = f((0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2]) / 0.9505);
  const double y = f(0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]);
  const double z = f((0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2]) / 1.089);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

TEST(EdgeColours, StayApartForColourBlindPeople) {
  // Machado, Oliveira, Fernandes 2009, severity 1: protanopia, deuteranopia, tritanopia; and everyone else.
  constexpr double kSeen[4][3][3] = {
      {{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}},
      {{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}},
      {{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}},
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  std::vector<Colour> colours{kPlanBuilding};
  for (int k = 0; k < model::kWallSegmentKindCount; ++k)
    colours.push_back(model::colour_of(static_cast<WallSegmentKind>(k)));
  for (int eye = 0; eye < 4; ++eye) {
    std::vector<Lab> seen;
    for (const Colour c : colours) {
      const Rgb from = linear(c);
      Rgb to;
      for (std::size_t i = 0; i < 3; ++i)
        to[i] =
            std::clamp(kSeen[eye][i][0] * from[0] + kSeen[eye][i][1] * from[1] + kSeen[eye][i][2] * from[2], 0.0, 1.0);
      seen.push_back(lab(to));
    }
    for (std::size_t i = 0; i < seen.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const double l = seen[i].l - seen[j].l, a = seen[i].a - seen[j].a, b = seen[i].b - seen[j].b;
        EXPECT_GT(std::sqrt(l * l + a * a + b * b), 20) << "eye " << eye << ", colours " << i << " and " << j;
      }
  }
}

}  // namespace
}  // namespace blockrand::picture
