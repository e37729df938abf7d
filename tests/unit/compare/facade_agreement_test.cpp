// Facades are what stands there, however it is drawn.
#include "pipeline/compare/facade_agreement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>

#include "tests/unit/compare/facade_scene.h"

namespace blockrand::compare::test {
namespace {

constexpr double kExact = 1e-9;
constexpr double kPi = 3.14159265358979323846;

/// All that two lists of facades have in common but which polygons made them.
void expect_same(const std::vector<Facade>& a, const std::vector<Facade>& b, double within = kExact,
                 bool places = true) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_NEAR(a[i].area, b[i].area, within * 1000);
    EXPECT_NEAR(a[i].covered, b[i].covered, within * 1000);
    EXPECT_NEAR(a[i].width(), b[i].width(), within);
    EXPECT_NEAR(a[i].bottom, b[i].bottom, within);
    EXPECT_NEAR(a[i].top, b[i].top, within);
    if (places) {
      EXPECT_NEAR(a[i].left.x, b[i].left.x, within);
      EXPECT_NEAR(a[i].left.y, b[i].left.y, within);
      EXPECT_NEAR(a[i].right.x, b[i].right.x, within);
      EXPECT_NEAR(a[i].right.y, b[i].right.y, within);
    }
    EXPECT_EQ(a[i].storeys, b[i].storeys);
    EXPECT_EQ(a[i].axes, b[i].axes);
    EXPECT_EQ(a[i].blank, b[i].blank);
    EXPECT_NEAR(a[i].storey_pitch.value_or(-1), b[i].storey_pitch.value_or(-1), within);
    EXPECT_NEAR(a[i].axis_pitch.value_or(-1), b[i].axis_pitch.value_or(-1), within);
    ASSERT_EQ(a[i].openings.size(), b[i].openings.size());
    for (std::size_t k = 0; k < a[i].openings.size(); ++k) {
      const FacadeOpening &p = a[i].openings[k], &q = b[i].openings[k];
      EXPECT_NEAR(p.left, q.left, within);
      EXPECT_NEAR(p.right, q.right, within);
      EXPECT_NEAR(p.bottom, q.bottom, within);
      EXPECT_NEAR(p.top, q.top, within);
      EXPECT_NEAR(p.area, q.area, within);
      EXPECT_EQ(p.door, q.door);
      EXPECT_EQ(p.row, q.row);
      EXPECT_EQ(p.column, q.column);
    }
  }
}

/// A house of four unlike fronts, none parallel to an axis of coordinates.
City crooked_house(const HouseStyle& style, double angle = 0.3) {
  auto north = grid(3, 4);
  north.push_back({9, 10.1, 0, 2.1, true});
  City city = city_of({house({{0, 0}, {14, 1}, {12, 13}, {-1, 10.5}}, 13, {grid(5, 4), grid(4, 4), north, {}}, style)});
  turn(city, angle);
  return city;
}

TEST(Facades, OfABox) {
  std::vector<Hole> openings = grid(5, 4);
  openings.erase(openings.begin() + 2);
  openings.push_back({6.1, 7.1, 0, 2.2, true});
  const auto found = facades(city_of({house(rectangle(10, 20, 23, 31), 12.5, {openings})}));
  ASSERT_EQ(found.size(), 4U);
  const Facade& front = *std::find_if(found.begin(), found.end(), [](const Facade& f) { return !f.openings.empty(); });
  EXPECT_EQ(front.left, (Point2{10, 20}));
  EXPECT_EQ(front.right, (Point2{23, 20}));
  EXPECT_EQ(front.bottom, 0);
  EXPECT_EQ(front.top, 12.5);
  EXPECT_NEAR(front.area, 13 * 12.5, kExact);
  EXPECT_EQ(front.storeys, 4);
  EXPECT_EQ(front.axes, 5);
  EXPECT_NEAR(*front.storey_pitch, 3, kExact);
  EXPECT_NEAR(*front.axis_pitch, 2.5, kExact);
  ASSERT_EQ(front.openings.size(), 20U);
  EXPECT_NEAR(front.openings[0].left, 1, kExact);
  EXPECT_NEAR(front.openings[0].top, 2.5, kExact);
  EXPECT_NEAR(front.openings[0].area, 1.8, kExact);
  const auto door = std::find_if(front.openings.begin(), front.openings.end(), [](const auto& o) { return o.door; });
  ASSERT_NE(door, front.openings.end());
  EXPECT_EQ(door->row, 0);
  EXPECT_EQ(door->column, 2);
  EXPECT_FALSE(front.blank);
  EXPECT_EQ(std::count_if(found.begin(), found.end(), [](const Facade& f) { return f.blank; }), 3);
}

TEST(Facades, DoNotDependOnHowWallsAreCut) {
  const auto expected = facades(crooked_house({}));
  ASSERT_EQ(expected.size(), 4U);
  EXPECT_NEAR(expected[0].area, std::hypot(14, 1) * 13, 1e-9);
  for (const Drawn drawn : {Drawn::plain, Drawn::cells, Drawn::triangles, Drawn::strips}) {
    SCOPED_TRACE(static_cast<int>(drawn));
    HouseStyle style;
    style.drawn = drawn;
    expect_same(facades(crooked_house(style)), expected);
  }
}

TEST(Facades, DoNotDependOnReveals) {
  const auto expected = facades(crooked_house({}));
  for (const double set_back : {0.1, 0.25, 0.55}) {
    for (const bool boxes : {false, true}) {
      HouseStyle style;
      style.set_back = set_back;
      style.boxes = boxes;
      style.drawn = boxes ? Drawn::triangles : Drawn::holes;
      SCOPED_TRACE(set_back);
      expect_same(facades(crooked_house(style)), expected);
    }
  }
}

TEST(Facades, DoNotDependOnTheSideFromWhichWallsAreDrawn) {
  const auto expected = facades(crooked_house({}));
  City turned_inside_out = crooked_house({});
  reverse(turned_inside_out.buildings[0]);
  expect_same(facades(turned_inside_out), expected);
  std::mt19937 random(3);
  for (int run = 0; run < 10; ++run) {
    HouseStyle style;
    style.drawn = run % 2 == 0 ? Drawn::holes : Drawn::triangles;
    City city = crooked_house(style);
    for (Face& f : city.buildings[0].faces)
      if (random() % 2 == 0) std::reverse(f.rings[0].begin(), f.rings[0].end());
    expect_same(facades(city), expected);
  }
}

TEST(Facades, OfABuildingDrawnInsideOutKeepTheirSideWhereThePlanDoesNotTell) {
  // A tower on a broad base: its walls stand in the middle of the footprint, which only the base's walls touch.
  const auto building = [] {
    Building base = house(rectangle(0, 0, 30, 30), 5, {grid(3, 1)});
    const Building tower = house(rectangle(10, 10, 20, 20), 30, {});
    for (const Face& f : tower.faces)
      if (f.hull == Hull::wall) base.faces.push_back(f);
    return base;
  };
  City sound = city_of({building()}), inside_out = sound;
  reverse(inside_out.buildings[0]);
  const auto expected = facades(sound);
  EXPECT_EQ(expected.size(), 8U);
  expect_same(facades(inside_out), expected);
}

TEST(Facades, DoNotDependOnTheOrderOfAnything) {
  City city = crooked_house({});
  const City other = city_of({house(rectangle(40, 0, 52, 9), 9, {grid(4, 3), {}, grid(3, 3)})});
  city.buildings.push_back(other.buildings[0]);
  const auto expected = facades(city);
  std::mt19937 random(11);
  for (int run = 0; run < 10; ++run) {
    City shuffled = city;
    std::shuffle(shuffled.buildings.begin(), shuffled.buildings.end(), random);
    for (Building& b : shuffled.buildings) {
      std::shuffle(b.faces.begin(), b.faces.end(), random);
      std::shuffle(b.openings.begin(), b.openings.end(), random);
      for (Face& f : b.faces) std::rotate(f.rings[0].begin(), f.rings[0].begin() + 1, f.rings[0].end());
    }
    expect_same(facades(shuffled), expected);
  }
}

TEST(Facades, TurnWithTheScene) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(0, 2 * kPi), shift(-0.3, 0.3);
  for (int run = 0; run < 30; ++run) {
    std::vector<std::vector<Hole>> walls;
    for (int w = 0; w < 4; ++w) {
      walls.push_back(grid(2 + static_cast<int>(random() % 3), 1 + static_cast<int>(random() % 4)));
      for (Hole& h : walls.back()) {
        const double s = shift(random), t = shift(random);
        h = {h.left + s, h.right + s + 0.3 * t, h.bottom + t, h.top + t, random() % 7 == 0};
      }
    }
    HouseStyle style;
    style.set_back = 0.1 * static_cast<double>(random() % 4);
    City a = city_of({house({{0, 0}, {14, 1}, {12, 13}, {-1, 10.5}}, 13, walls, style)});
    City b = city_of({house({{0.3, -0.2}, {14.4, 1}, {12, 12.7}, {-1, 10.8}}, 12, walls, style)});
    const auto expected = facades(a);
    const MeasureValues values = measured(a, b);
    const double by = angle(random);
    turn(a, by);
    turn(b, by);
    expect_same(facades(a), expected, 1e-8, false);
    const MeasureValues turned = measured(a, b);
    for (std::size_t m = 0; m < kMeasureCount; ++m) {
      ASSERT_EQ(turned[m].counted.has_value(), values[m].counted.has_value());
      EXPECT_NEAR(turned[m].counted.value_or(0), values[m].counted.value_or(0), 1e-8) << kMeasures[m].id;
      EXPECT_NEAR(turned[m].all.value_or(0), values[m].all.value_or(0), 1e-8) << kMeasures[m].id;
      EXPECT_NEAR(turned[m].left_out, values[m].left_out, 1e-8);
    }
  }
}

TEST(Facades, CountEachPlaceOnce) {
  City city = crooked_house({});
  const auto expected = facades(city);
  Building& b = city.buildings[0];
  const std::size_t faces = b.faces.size();
  for (std::size_t f = 0; f < faces; ++f) b.faces.push_back(b.faces[f]);
  const std::size_t openings = b.openings.size();
  for (std::size_t o = 0; o < openings; ++o) b.openings.push_back(b.openings[o]);
  expect_same(facades(city), expected);
}

TEST(Facades, EndAtWideGaps) {
  for (const auto& [gap, count] : {std::pair(1.4, 1U), std::pair(1.6, 2U)}) {
    const City city =
        city_of({house(rectangle(0, 0, 10, 8), 9, {}), house(rectangle(10 + gap, 0, 20 + gap, 8), 9, {})});
    const auto found = facades(city);
    EXPECT_EQ(
        std::count_if(found.begin(), found.end(), [](const Facade& f) { return f.left.y == 0 && f.right.y == 0; }),
        count)
        << gap;
  }
}

TEST(Facades, KeepShallowProjectionsAndPartWithDeepOnes) {
  for (const auto& [depth, fronts] : {std::pair(0.5, 1U), std::pair(0.9, 3U)}) {
    // A bay of 4 m in the middle of a front of 16 m.
    const City city = city_of(
        {house({{0, 0}, {6, 0}, {6, -depth}, {10, -depth}, {10, 0}, {16, 0}, {16, 10}, {0, 10}}, 9, {grid(2, 3)})});
    std::size_t south = 0, openings = 0;
    for (const Facade& f : facades(city)) {
      if (f.right.x - f.left.x < 0.9 * f.width()) continue;
      ++south;
      openings += f.openings.size();
    }
    EXPECT_EQ(south, fronts) << depth;
    EXPECT_EQ(openings, 6U);
  }
}

TEST(Facades, TakeOpeningsNearThemAndNoOthers) {
  City city = city_of({house(rectangle(0, 0, 13, 11), 9, {grid(5, 3)})});
  Building& b = city.buildings[0];
  const auto add = [&](double depth, double x, double z, double lean) {
    Opening o;
    o.polygons.push_back(
        {{{x, depth, 100 + z}, {x + 1, depth, 100 + z}, {x + 1, depth + lean, 101 + z}, {x, depth + lean, 101 + z}}});
    b.openings.push_back(o);
  };
  add(-1.0, 12, 7.5, 0);  // a bay's, before the wall
  add(0.9, 12, 1, 0);     // in a deep niche
  std::size_t loose = 99;
  EXPECT_EQ(facades_of(city, all_of(city), ground_of(city), {}, &loose).size(), 4U);
  EXPECT_EQ(loose, 0U);
  add(0.5, 6, 9.5, 0);        // a dormer's, above the eaves
  add(2.0, 12, 4, 0);         // too far behind
  add(0.1, 3, 8.0, 1.0);      // a roof window
  b.openings.emplace_back();  // of nothing
  std::size_t in = 0;
  for (const Facade& f : facades_of(city, all_of(city), ground_of(city), {}, &loose)) in += f.openings.size();
  EXPECT_EQ(loose, 4U);
  EXPECT_EQ(in, 17U);
}

TEST(Facades, SurviveWhatFilesHold) {
  City city = city_of({house(rectangle(0, 0, 13, 11), 9, {grid(5, 3)})});
  const auto expected = facades(city);
  Building& b = city.buildings[0];
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const auto wall = [&](std::vector<Point3> ring) {
    Face f;
    f.rings.push_back(std::move(ring));
    b.faces.push_back(f);
    Opening o;
    o.polygons.push_back(f.rings);
    b.openings.push_back(o);
  };
  wall({});
  wall({{0, 0, 100}, {5, 0, 100}});
  wall({{0, 0, 100}, {5, 0, 100}, {10, 0, 100}});
  wall({{0, 0, 100}, {5, 0, nan}, {10, 0, 105}});
  wall({{0, 0, 100}, {infinite, 0, 101}, {10, 0, 105}});
  wall({{2, 0, 100}, {2, 0, 109}, {2, 1e-8, 109}});
  Face none;
  b.faces.push_back(none);
  std::size_t loose = 0;
  const auto found = facades_of(city, all_of(city), ground_of(city), {}, &loose);
  expect_same(found, expected);
  EXPECT_EQ(loose, 6U);
  const MeasureValues values = measured(city, city);
  EXPECT_EQ(value(values, Measure::opening_recall).counted, 1.0);
  EXPECT_TRUE(facades(city_of({Building{}})).empty());
  EXPECT_TRUE(facades(city_of({})).empty());
}

/// A round tower with one window in each of its sides.
City tower(int sides, double radius) {
  std::vector<Point2> plan;
  for (int i = 0; i < sides; ++i)
    plan.push_back({radius * std::cos(2 * kPi * i / sides), radius * std::sin(2 * kPi * i / sides)});
  const double side = 2 * radius * std::sin(kPi / sides);
  return city_of({house(
      plan, 12, std::vector<std::vector<Hole>>(static_cast<std::size_t>(sides), {{0.2 * side, 0.8 * side, 1, 2.5}}))});
}

TEST(Facades, OfRoundWallsAreThePiecesThatAreWideEnough) {
  std::size_t loose = 0;
  City city = tower(64, 5);  // sides of 0.49 m at 5.6 degrees
  EXPECT_TRUE(facades_of(city, all_of(city), ground_of(city), {}, &loose).empty());
  EXPECT_EQ(loose, 64U);
  city = tower(12, 5);  // sides of 2.6 m
  EXPECT_EQ(facades_of(city, all_of(city), ground_of(city), {}, &loose).size(), 12U);
  EXPECT_EQ(loose, 0U);
  city = tower(600, 30);  // sides of 0.31 m at 0.6 degrees: stretches of as many sides as are within the angle
  std::size_t openings = 0;
  for (const Facade& f : facades_of(city, all_of(city), ground_of(city), {}, &loose)) {
    EXPECT_LT(f.width(), 8);
    EXPECT_TRUE(std::isfinite(f.area));
    openings += f.openings.size();
  }
  EXPECT_EQ(openings + loose, 600U);
  EXPECT_GT(openings, 550U);
}

TEST(Facades, AreFoundFast) {
  // 500 houses of 100 openings each, each opening a box with frame and pane, walls in triangles.
  HouseStyle style;
  style.drawn = Drawn::triangles;
  style.boxes = true;
  style.set_back = 0.15;
  std::vector<Building> buildings;
  for (int i = 0; i < 500; ++i) {
    const double x = 40.0 * (i % 25), y = 40.0 * (i / 25);
    buildings.push_back(
        house(rectangle(x, y, x + 13, y + 13), 15.5, {grid(5, 5), grid(5, 5), grid(5, 5), grid(5, 5)}, style));
  }
  const City city = city_of(std::move(buildings));
  const auto start = std::chrono::steady_clock::now();
  std::size_t openings = 0;
  for (std::uint32_t b = 0; b < 500; ++b) {
    const std::vector<std::uint32_t> one{b};
    for (const Facade& f : facades_of(city, one, ground_of(city))) openings += f.openings.size();
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  RecordProperty("seconds", std::to_string(seconds));
  EXPECT_EQ(openings, 50000U);
  EXPECT_LT(seconds, 30) << "a few seconds on an idle machine, with optimisation";
}

}  // namespace
}  // namespace blockrand::compare::test
