// Measures of facades against what a hand reckons.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/unit/compare/facade_scene.h"

namespace blockrand::compare::test {
namespace {

using testing::DoubleNear;
using testing::Optional;

constexpr double kExact = 1e-9;

constexpr Measure kFacadeMeasures[] = {
    Measure::storeys_error,     Measure::axes_error,     Measure::openings_ratio,     Measure::window_to_wall_error,
    Measure::opening_precision, Measure::opening_recall, Measure::storey_pitch_error, Measure::axis_pitch_error};

auto is(double v) { return Optional(DoubleNear(v, kExact)); }

/// A house of 13 x 11 m, its street side (13 m wide, to the south) with the openings given.
City street_house(const std::vector<Hole>& south, double height = 15.5, const HouseStyle& style = {}) {
  return city_of({house(rectangle(0, 0, 13, 11), height, {south}, style)});
}

TEST(FacadeMeasures, AreIdealForTheSameModel) {
  const City city = city_of({house(rectangle(0, 0, 13, 11), 15.5, {grid(5, 5), grid(4, 5), grid(3, 4), grid(4, 5)})});
  const MeasureValues values = measured(city, city);
  for (const Measure m : kFacadeMeasures) {
    const double ideal = info(m).better == Better::zero ? 0 : 1;
    EXPECT_THAT(value(values, m).counted, is(ideal)) << info(m).id;
    EXPECT_THAT(value(values, m).all, is(ideal)) << info(m).id;
    EXPECT_EQ(value(values, m).left_out, 0) << info(m).id;
  }
  EXPECT_EQ(value(values, Measure::axes_error).weight, 4);
  EXPECT_EQ(value(values, Measure::openings_ratio).weight, 77);
  EXPECT_EQ(value(values, Measure::opening_precision).weight, 77);
  EXPECT_NEAR(value(values, Measure::window_to_wall_error).weight, 15.5 * 48, kExact);
  EXPECT_EQ(value(values, Measure::storeys_error).weight, 1);
  for (std::size_t m = 0; m < kMeasureCount; ++m)
    EXPECT_TRUE(kMeasures[m].scope == Scope::facades || !(values[m].counted || values[m].all)) << kMeasures[m].id;
}

TEST(FacadeMeasures, CountAStoreyTooMany) {
  const City reference = street_house(grid(5, 4), 12.5), model = street_house(grid(5, 5), 15.5);
  const MeasureValues values = measured(model, reference);
  EXPECT_THAT(value(values, Measure::storeys_error).counted, is(1));
  EXPECT_THAT(value(values, Measure::axes_error).counted, is(0));
  EXPECT_THAT(value(values, Measure::openings_ratio).counted, is(25.0 / 20));
  EXPECT_THAT(value(values, Measure::opening_precision).counted, is(20.0 / 25));
  EXPECT_THAT(value(values, Measure::opening_recall).counted, is(1));
  EXPECT_THAT(value(values, Measure::window_to_wall_error).counted,
              is(25 * 1.8 / (13 * 15.5) - 20 * 1.8 / (13 * 12.5)));
  EXPECT_THAT(value(values, Measure::storey_pitch_error).counted, is(0));
  EXPECT_THAT(value(values, Measure::axis_pitch_error).counted, is(0));
  EXPECT_THAT(value(values, Measure::storeys_error).all, is(1));
  // The three walls without windows are not modelled, by the rule.
  EXPECT_NEAR(value(values, Measure::storeys_error).left_out, (13 + 11 + 11) / 48.0, kExact);
}

TEST(FacadeMeasures, FindWindowsUntilHalfOfThemIsBesideTheirPlace) {
  const City reference = street_house(grid(5, 4));
  // 1.2 m wide, shifted by s: IoU (1.2 - s) / (1.2 + s), which is 0.5 at 0.4.
  for (const double shift : {0.2, 0.39, 0.4, 0.41}) {
    auto windows = grid(5, 4);
    for (Hole& h : windows) {
      h.left += shift;
      h.right += shift;
    }
    const MeasureValues values = measured(street_house(windows), reference);
    const double found = shift < 0.405 ? 1 : 0;
    EXPECT_THAT(value(values, Measure::opening_precision).counted, is(found)) << shift;
    EXPECT_THAT(value(values, Measure::opening_recall).counted, is(found)) << shift;
    EXPECT_THAT(value(values, Measure::axis_pitch_error).counted, is(0)) << shift;
    EXPECT_THAT(value(values, Measure::openings_ratio).counted, is(1)) << shift;
  }
}

TEST(FacadeMeasures, TellPitches) {
  auto windows = grid(5, 4);
  for (Hole& h : windows) {
    const double column = (h.left - 1) / 2.5, row = (h.bottom - 1) / 3;
    h.left -= 0.1 * column;
    h.right -= 0.1 * column;
    h.bottom += 0.25 * row;
    h.top += 0.25 * row;
  }
  const MeasureValues values = measured(street_house(windows), street_house(grid(5, 4)));
  EXPECT_THAT(value(values, Measure::axis_pitch_error).counted, is(-0.1));
  EXPECT_THAT(value(values, Measure::storey_pitch_error).counted, is(0.25));
  EXPECT_THAT(value(values, Measure::storeys_error).counted, is(0));
}

TEST(FacadeMeasures, SeeWindowsInTwoHalves) {
  std::vector<Hole> halves;
  for (const Hole& h : grid(5, 4)) {
    const double middle = 0.5 * (h.left + h.right);
    // 1 mm more than half of the window, so that its IoU is above a half.
    halves.push_back({h.left, middle + 0.001, h.bottom, h.top});
    halves.push_back({middle + 0.001, h.right, h.bottom, h.top});
  }
  const MeasureValues values = measured(street_house(halves), street_house(grid(5, 4)));
  EXPECT_THAT(value(values, Measure::openings_ratio).counted, is(2));
  EXPECT_THAT(value(values, Measure::opening_precision).counted, is(0.5));
  EXPECT_THAT(value(values, Measure::opening_recall).counted, is(1));
  EXPECT_THAT(value(values, Measure::axes_error).counted, is(5));
  EXPECT_THAT(value(values, Measure::storeys_error).counted, is(0));
  EXPECT_THAT(value(values, Measure::window_to_wall_error).counted, is(0));
}

TEST(FacadeMeasures, SeeAMirroredFront) {
  // Windows at 1, 3.5 and 8 m in a wall of 13 m; mirrored at 3.8, 8.3 and 10.8: none on another.
  std::vector<Hole> windows, mirrored;
  for (int row = 0; row < 4; ++row)
    for (const double x : {1.0, 3.5, 8.0}) windows.push_back({x, x + 1.2, 1 + 3.0 * row, 2.5 + 3.0 * row});
  for (const Hole& h : windows) mirrored.push_back({13 - h.right, 13 - h.left, h.bottom, h.top});
  const MeasureValues values = measured(street_house(mirrored), street_house(windows));
  // 3.8..5 on 3.5..4.7: IoU 0.9 / 1.5; 8.3..9.5 on 8..9.2 likewise; 10.8 and 1 stand alone.
  EXPECT_THAT(value(values, Measure::opening_recall).counted, is(2.0 / 3));
  EXPECT_THAT(value(values, Measure::opening_precision).counted, is(2.0 / 3));
  EXPECT_THAT(value(values, Measure::axes_error).counted, is(0));
  EXPECT_THAT(value(values, Measure::axis_pitch_error).counted, is(0));
  EXPECT_THAT(value(values, Measure::openings_ratio).counted, is(1));
}

TEST(FacadeMeasures, ChangeSidesWhenTheModelsDo) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-0.5, 0.5);
  std::bernoulli_distribution keep(0.8);
  for (int run = 0; run < 20; ++run) {
    const auto some = [&](int columns, int rows) {
      std::vector<Hole> out;
      for (Hole h : grid(columns, rows)) {
        if (!keep(random)) continue;
        const double s = shift(random);
        h.left += s;
        h.right += s;
        out.push_back(h);
      }
      return out;
    };
    const City a = city_of({house(rectangle(0, 0, 13, 11), 15.5, {some(5, 5), some(4, 5), some(5, 4), some(4, 5)})});
    City b = city_of({house({{0.2, 0.1}, {13.5, 0.6}, {12.9, 11.2}, {-0.1, 11.3}}, 14.5,
                            {some(5, 4), some(4, 4), some(4, 4), some(4, 4)})});
    const MeasureValues there = measured(a, b), back = measured(b, a);
    ASSERT_TRUE(value(there, Measure::opening_recall).counted.has_value());
    EXPECT_GT(*value(there, Measure::opening_recall).counted, 0.1);
    EXPECT_THAT(value(back, Measure::opening_precision).counted, is(*value(there, Measure::opening_recall).counted));
    EXPECT_THAT(value(back, Measure::opening_recall).counted, is(*value(there, Measure::opening_precision).counted));
    EXPECT_THAT(value(back, Measure::openings_ratio).counted, is(1 / *value(there, Measure::openings_ratio).counted));
    for (const Measure m : {Measure::storeys_error, Measure::axes_error, Measure::window_to_wall_error,
                            Measure::storey_pitch_error, Measure::axis_pitch_error})
      EXPECT_THAT(value(back, m).counted, is(-*value(there, m).counted)) << info(m).id;
  }
}

TEST(FacadeMeasures, CountTheAreaOfNestedOpeningsOnce) {
  // A glazed front that is one opening with its 20 windows in it.
  auto windows = grid(5, 4);
  const double small = 20 * 1.8, large = 12.9 * 12.4;
  City nested = street_house({}, 12.5);
  const City inner = street_house(windows, 12.5), outer = street_house({{0.05, 12.95, 0.05, 12.45}}, 12.5);
  for (const City* city : {&inner, &outer})
    for (const Opening& o : city->buildings[0].openings) nested.buildings[0].openings.push_back(o);
  const MeasureValues values = measured(nested, inner);
  EXPECT_THAT(value(values, Measure::window_to_wall_error).counted, is((large - small) / (13 * 12.5)));
}

TEST(FacadeMeasures, LeaveOutWhatIsBlank) {
  City reference = street_house(grid(5, 4), 12.5);
  const City model = city_of({house(rectangle(0, 0, 13, 11), 12.5, {grid(5, 4), grid(4, 4), grid(5, 4), grid(4, 4)})});
  const std::vector<std::vector<std::uint32_t>> groups{{0}};
  EXPECT_EQ(mark_blank(reference, groups), 3U);
  std::size_t marked = 0;
  for (const Face& f : reference.buildings[0].faces) marked += f.left_out == LeftOut::blank;
  EXPECT_EQ(marked, 3U);
  const MeasureValues values = measured(model, reference);
  EXPECT_THAT(value(values, Measure::opening_precision).counted, is(1));
  EXPECT_THAT(value(values, Measure::opening_precision).all, is(20.0 / 72));
  EXPECT_EQ(value(values, Measure::opening_precision).weight, 20);
  EXPECT_EQ(value(values, Measure::opening_precision).weight_all, 72);
  EXPECT_THAT(value(values, Measure::openings_ratio).counted, is(1));
  EXPECT_THAT(value(values, Measure::openings_ratio).all, is(72.0 / 20));
  EXPECT_THAT(value(values, Measure::window_to_wall_error).counted, is(0));
  EXPECT_THAT(value(values, Measure::window_to_wall_error).all, is((72 - 20) * 1.8 / (48 * 12.5)));
  for (const Measure m : kFacadeMeasures) EXPECT_NEAR(value(values, m).left_out, 35.0 / 48, kExact) << info(m).id;
}

TEST(FacadeMeasures, CountWingsThatTheReferenceDoesNotShow) {
  // The reference is a plain block with a blank back; the model has a wing behind it, with windows to the back.
  const City reference = street_house(grid(5, 4), 12.5);
  const std::vector<Point2> plan{{0, 0}, {13, 0}, {13, 16}, {5, 16}, {5, 11}, {0, 11}};
  const City model = city_of({house(plan, 12.5, {grid(5, 4), {}, grid(3, 4), grid(1, 4), grid(1, 4)})});
  // What is paired with the blank back leaves: one column of windows.
  EXPECT_EQ(value(measured(model, reference), Measure::opening_precision).weight, 36);
  EXPECT_THAT(value(measured(model, reference), Measure::opening_precision).all, is(20.0 / 40));
}

TEST(FacadePairs, LeaveOutAModelsPartyWallsButNoWindowsInThem) {
  City model = city_of({house(rectangle(0, 0, 13, 11), 12.5, {{}, grid(3, 3)})});
  // South, east, north, west after ground and roof; nothing of the reference is near.
  for (const std::size_t wall : {2, 3}) model.buildings[0].faces[wall].left_out = LeftOut::covered;
  const auto found = facades(model);
  const auto pairs = pair_facades(found, {});
  ASSERT_EQ(pairs.size(), 4U);
  for (const FacadePair& pair : pairs)
    EXPECT_EQ(pair.left_out, found[pair.model].is_covered() && found[pair.model].openings.empty());
  EXPECT_EQ(std::count_if(pairs.begin(), pairs.end(), [](const FacadePair& p) { return p.left_out; }), 1);
}

TEST(FacadeMeasures, LeaveOutWhatNeighboursCover) {
  City reference = city_of({house(rectangle(0, 0, 3.5, 11), 12.5, {{{1, 2.2, 1, 2.5}, {1, 2.2, 4, 5.5}}})});
  City model = city_of({house(rectangle(0, 0, 3.5, 11), 12.5, {{{1, 2.2, 1, 2.5}, {1, 2.2, 4, 5.5}}, grid(4, 4)})});
  // Walls follow ground and roof: south, east, north, west. East is covered; the narrow north wall may be windowless.
  reference.buildings[0].faces[3].left_out = LeftOut::covered;
  const std::vector<std::vector<std::uint32_t>> groups{{0}};
  EXPECT_EQ(mark_blank(reference, groups), 1U);
  EXPECT_EQ(reference.buildings[0].faces[3].left_out, LeftOut::covered);
  EXPECT_EQ(reference.buildings[0].faces[4].left_out, LeftOut::no);
  EXPECT_EQ(reference.buildings[0].faces[5].left_out, LeftOut::blank);
  const MeasureValues values = measured(model, reference);
  EXPECT_THAT(value(values, Measure::opening_precision).counted, is(1));
  EXPECT_THAT(value(values, Measure::opening_precision).all, is(2.0 / 18));
  EXPECT_NEAR(value(values, Measure::opening_precision).left_out, 22.0 / 29, kExact);
  // Openings above a low neighbour are seen: the wall counts again.
  City above = model;
  above.buildings[0].faces[3].left_out = LeftOut::covered;
  EXPECT_THAT(value(measured(model, above), Measure::opening_precision).counted, is(1));
  EXPECT_EQ(value(measured(model, above), Measure::opening_precision).weight, 18);
}

TEST(FacadeMeasures, FallBackOnStatedStoreys) {
  City reference = street_house({}), model = street_house(grid(5, 5));
  EXPECT_FALSE(value(measured(model, reference), Measure::storeys_error).counted);
  reference.buildings[0].storeys = 3;
  MeasureValues values = measured(model, reference);
  EXPECT_THAT(value(values, Measure::storeys_error).counted, is(2));
  for (const Measure m : kFacadeMeasures)
    EXPECT_TRUE(m == Measure::storeys_error || !(value(values, m).counted || value(values, m).all)) << info(m).id;
  // Rows of openings win over what the file states.
  model.buildings[0].storeys = 9;
  EXPECT_THAT(value(measured(model, reference), Measure::storeys_error).counted, is(2));
}

TEST(FacadeMeasures, OfAModelWithoutOpenings) {
  City model = street_house({});
  const MeasureValues values = measured(model, street_house(grid(5, 4)));
  EXPECT_THAT(value(values, Measure::opening_recall).counted, is(0));
  EXPECT_THAT(value(values, Measure::openings_ratio).counted, is(0));
  EXPECT_FALSE(value(values, Measure::opening_precision).counted);
  EXPECT_FALSE(value(values, Measure::storeys_error).counted);
  EXPECT_FALSE(value(values, Measure::storey_pitch_error).counted);
  EXPECT_THAT(value(values, Measure::axes_error).counted, is(-5));
  EXPECT_THAT(value(values, Measure::window_to_wall_error).counted, is(-20 * 1.8 / (13 * 15.5)));
}

TEST(FacadeMeasures, CompareHeightsAboveEachOnesGround) {
  HouseStyle low;
  low.ground = 3;
  const MeasureValues values = measured(street_house(grid(5, 4), 15.5, low), street_house(grid(5, 4)));
  EXPECT_THAT(value(values, Measure::opening_recall).counted, is(1));
}

TEST(FacadeMeasures, OfABlockAgainstItsHouses) {
  auto right = grid(5, 4);
  auto whole = grid(5, 4);
  for (Hole h : right) {
    h.left += 13;
    h.right += 13;
    whole.push_back(h);
  }
  City block = city_of({house(rectangle(0, 0, 26, 11), 12.5, {whole})});
  City houses = city_of(
      {house(rectangle(0, 0, 13, 11), 12.5, {grid(5, 4)}), house(rectangle(13, 0, 26, 11), 12.5, {grid(5, 4)})});
  houses.buildings[0].faces[3].left_out = LeftOut::covered;  // east
  houses.buildings[1].faces[5].left_out = LeftOut::covered;  // west
  const auto front = facades(houses).front();
  EXPECT_NEAR(front.width(), 26, kExact);
  EXPECT_EQ(front.openings.size(), 40U);
  for (const auto& [a, b] : {std::pair(&block, &houses), std::pair(&houses, &block)}) {
    const MeasureValues values = measured(*a, *b);
    EXPECT_THAT(value(values, Measure::opening_recall).counted, is(1));
    EXPECT_THAT(value(values, Measure::opening_precision).counted, is(1));
    EXPECT_THAT(value(values, Measure::axes_error).counted, is(0));
    EXPECT_THAT(value(values, Measure::window_to_wall_error).counted, is(0));
  }
}

TEST(FacadeMeasures, OfABlockAgainstItsHousesOnASlope) {
  // The same walls: the upper house, with the larger part of the front, begins 3 m higher; so do its windows.
  const double step = 3;
  HouseStyle upper;
  upper.ground += step;
  auto left = grid(5, 4), right = grid(6, 3), whole = left;
  for (Hole h : right) {
    h.left += 13;
    h.right += 13;
    h.bottom += step;
    h.top += step;
    whole.push_back(h);
  }
  City block = city_of({house(rectangle(0, 0, 29, 11), 12.5, {whole})});
  City houses = city_of(
      {house(rectangle(0, 0, 13, 11), 12.5, {left}), house(rectangle(13, 0, 29, 11), 12.5 - step, {right}, upper)});
  houses.buildings[0].faces[3].left_out = LeftOut::covered;  // east
  houses.buildings[1].faces[5].left_out = LeftOut::covered;  // west
  for (const auto& [a, b] : {std::pair(&block, &houses), std::pair(&houses, &block)}) {
    const MeasureValues values = measured(*a, *b);
    EXPECT_THAT(value(values, Measure::opening_recall).counted, is(1));
    EXPECT_THAT(value(values, Measure::opening_precision).counted, is(1));
    EXPECT_THAT(value(values, Measure::storeys_error).counted, is(0));
  }
}

TEST(FacadePairs, TakeTheNearerOfTwoAndEachOnce) {
  // Two fronts to the south, one behind the other, against the nearer one alone, 0.5 m off.
  const City two = city_of({house({{0, 0}, {6, 0}, {6, 2.4}, {12, 2.4}, {12, 10}, {0, 10}}, 9, {})});
  const City one = city_of({house(rectangle(0.5, -0.5, 12, 10), 9, {})});
  const auto a = facades(two), b = facades(one);
  const auto pairs = pair_facades(a, b);
  std::vector<int> model_seen(a.size(), 0), reference_seen(b.size(), 0);
  for (const FacadePair& pair : pairs) {
    if (pair.model != FacadePair::kNone) ++model_seen[pair.model];
    if (pair.reference != FacadePair::kNone) ++reference_seen[pair.reference];
    if (pair.reference == FacadePair::kNone || b[pair.reference].left.y > -0.4) continue;
    if (b[pair.reference].right.y > -0.4) continue;
    ASSERT_NE(pair.model, FacadePair::kNone);
    EXPECT_NEAR(a[pair.model].left.y, 0, kExact);
  }
  EXPECT_THAT(model_seen, testing::Each(1));
  EXPECT_THAT(reference_seen, testing::Each(1));
  const auto back = pair_facades(b, a);
  ASSERT_EQ(back.size(), pairs.size());
  for (const FacadePair& pair : pairs)
    EXPECT_TRUE(std::any_of(back.begin(), back.end(), [&](const FacadePair& other) {
      return other.model == pair.reference && other.reference == pair.model;
    }));
}

TEST(FacadePairs, SeeBothFacadesFromHalfWayBetweenThem) {
  // Two walls from one corner, 12 degrees apart; of the second only the stretch from 10 m on was drawn. Both have a
  // slit 11 m from the corner.
  const auto wall = [](double angle, double from) {
    const double c = std::cos(angle), s = std::sin(angle);
    Facade f;
    f.left = {from * c, from * s};
    f.right = {14 * c, 14 * s};
    f.top = 10;
    f.area = 10 * (14 - from);
    FacadeOpening slit;
    slit.left = 11 - from;
    slit.right = 11.12 - from;
    slit.bottom = 1;
    slit.top = 2;
    f.openings.push_back(slit);
    return std::vector<Facade>{f};
  };
  const double half = 6 * 3.14159265358979323846 / 180;
  const auto a = wall(-half, 0), b = wall(half, 10);
  ASSERT_EQ(pair_facades(a, b).size(), 1U);
  EXPECT_EQ(pair_facades(a, b)[0].matches.size(), 1U);
  EXPECT_EQ(pair_facades(b, a)[0].matches.size(), 1U);
}

TEST(FacadePairs, DoNotJoinWhatLiesFarApartOrLooksElsewhere) {
  const auto a = facades(city_of({house(rectangle(0, 0, 13, 11), 12, {})}));
  // 3.1 m before the front; 0.1 m deep, so that its back is no partner either.
  const auto far = facades(city_of({house(rectangle(0, -3.1, 13, -3), 12, {})}));
  EXPECT_EQ(far.size(), 2U);
  for (const FacadePair& pair : pair_facades(a, far))
    EXPECT_TRUE(pair.model == FacadePair::kNone || pair.reference == FacadePair::kNone);
  const auto near = facades(city_of({house(rectangle(0, -2.9, 13, -2.8), 12, {})}));
  EXPECT_NE(pair_facades(a, near).front().model, FacadePair::kNone);
  City turned = city_of({house(rectangle(0, 0, 13, 11), 12, {})});
  turn(turned, 0.36);
  for (const FacadePair& pair : pair_facades(a, facades(turned)))
    EXPECT_TRUE(pair.model == FacadePair::kNone || pair.reference == FacadePair::kNone);
}

}  // namespace
}  // namespace blockrand::compare::test
