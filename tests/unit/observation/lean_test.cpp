// The lean of an image, found again from where its roofs are seen.
#include "pipeline/observation/lean.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pipeline/base/portable_math.h"

namespace blockrand::observation {
namespace {

using model::Point2;

constexpr double kFlight = 1600;  // m

/// `count` houses over 600 m, each of a row of its own; `seen` says where the image shows one.
template <class Seen>
std::vector<SightedOutline> town(std::size_t count, Seen&& seen) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(0, 600), height(4, 20);
  std::vector<SightedOutline> houses(count);
  for (std::size_t n = 0; n < count; ++n) {
    houses[n].place = {500'000 + place(random), 5'700'000 + place(random)};
    houses[n].height = height(random);
    houses[n].guessed = false;
    houses[n].row = static_cast<std::uint32_t>(n);
    houses[n].sightings[0] = {seen(houses[n], n), 1};
  }
  return houses;
}

Point2 anywhere(std::size_t n, double least, double most) {
  const base::SinCos angle = base::sin_cos(static_cast<double>(n * n + 3 * n) * 0.7);
  const double size = least + (most - least) * static_cast<double>(n % 17) / 17;
  return {size * angle.cos, size * angle.sin};
}

Point2 lean_of(const SightedOutline& o) {
  const Point2 nadir{500'100, 5'699'900};
  return {(o.place.x - nadir.x) / kFlight * o.height, (o.place.y - nadir.y) / kFlight * o.height};
}

TEST(Lean, RoofsThatLeanFromAPlaceUnderTheCameraAreFound) {
  // A third of the houses are drawn elsewhere.
  const auto houses = town(300, [](const SightedOutline& o, std::size_t n) {
    const Point2 lean = lean_of(o), own = n % 3 == 0 ? anywhere(n, 1, 3) : Point2{};
    return Point2{lean.x + own.x, lean.y + own.y};
  });
  const LeanField field(houses);
  EXPECT_TRUE(field.leans());
  EXPECT_NEAR(field.flight_height(), kFlight, 250);
  int known = 0;
  for (const SightedOutline& o : houses) {
    const auto said = field.at(o.place, o.height);
    if (!said) continue;
    ++known;
    const Point2 lean = lean_of(o);
    EXPECT_NEAR(said->x, lean.x, 0.35);
    EXPECT_NEAR(said->y, lean.y, 0.35);
  }
  EXPECT_GT(known, 250);
}

TEST(Lean, HousesThatWereMovedAtRandomShowNoLean) {
  const LeanField field(town(300, [](const SightedOutline&, std::size_t n) { return anywhere(n, 1, 3); }));
  EXPECT_FALSE(field.found());
  EXPECT_EQ(field.at({500'300, 5'700'300}, 10), Point2{});
}

TEST(Lean, OneShiftOfAllRoofsIsNoLean) {
  const LeanField field(town(300, [](const SightedOutline&, std::size_t) { return Point2{1.2, -0.8}; }));
  ASSERT_TRUE(field.found());
  EXPECT_FALSE(field.leans());
  const auto low = field.at({500'300, 5'700'300}, 3), high = field.at({500'300, 5'700'300}, 30);
  ASSERT_TRUE(low && high);
  EXPECT_EQ(*low, *high);
  EXPECT_NEAR(low->x, 1.2, 0.1);
  EXPECT_NEAR(low->y, -0.8, 0.1);
}

TEST(Lean, AnImageThatLeansAndIsShiftedTellsBothApart) {
  const Point2 shift{1.4, -0.9};
  const auto houses = town(300, [&](const SightedOutline& o, std::size_t n) {
    const Point2 lean = lean_of(o), own = n % 4 == 0 ? anywhere(n, 1, 3) : Point2{};
    return Point2{shift.x + lean.x + own.x, shift.y + lean.y + own.y};
  });
  const LeanField field(houses);
  ASSERT_TRUE(field.leans());
  EXPECT_NEAR(field.shift().x, shift.x, 0.3);
  EXPECT_NEAR(field.shift().y, shift.y, 0.3);
  int known = 0;
  for (const SightedOutline& o : houses) {
    const auto low = field.at(o.place, 3), metre = field.per_metre(o.place);
    if (!low || !metre) continue;
    ++known;
    const Point2 lean = lean_of(o);
    EXPECT_NEAR(low->x, shift.x + lean.x / o.height * 3, 0.35);
    EXPECT_NEAR(low->y, shift.y + lean.y / o.height * 3, 0.35);
    EXPECT_NEAR(low->x, field.shift().x + 3 * metre->x, 1e-9);
  }
  EXPECT_GT(known, 250);
}

TEST(Lean, AFieldThatFoundNothingHasNoShiftEither) {
  // Many seeds of houses that were moved at random: by chance a shift of all of them may please.
  for (unsigned seed = 0; seed < 12; ++seed) {
    const LeanField field(
        town(60, [seed](const SightedOutline&, std::size_t n) { return anywhere(n * 7 + seed * 31, 0.5, 3); }));
    if (field.found()) continue;
    EXPECT_EQ(field.at({500'300, 5'700'300}, 10), Point2{}) << seed;
    EXPECT_EQ(field.shift(), Point2{}) << seed;
  }
}

TEST(Lean, AnImageThatLeansAndIsNotShiftedHasNoShift) {
  const LeanField field(town(300, [](const SightedOutline& o, std::size_t) { return lean_of(o); }));
  EXPECT_EQ(field.shift(), Point2{});
}

TEST(Lean, OneRowThatIsOffIsNoLeanOfItsPlace) {
  // 40 houses of one row, all off alike, among 40 houses alone that stand right.
  auto houses = town(80, [](const SightedOutline&, std::size_t n) { return n < 40 ? Point2{2, 2} : Point2{}; });
  for (std::size_t n = 0; n < houses.size(); ++n) {
    houses[n].place = {500'300 + static_cast<double>(n % 9) * 10, 5'700'300 + static_cast<double>(n / 9) * 10};
    if (n < 40) houses[n].row = 0, houses[n].weight = 1 / std::sqrt(40.0);
  }
  const LeanField field(houses);
  const auto said = field.at({500'340, 5'700'340}, 10);
  if (said) {
    EXPECT_LT(std::hypot(said->x, said->y), 0.3);
  }
}

TEST(Lean, AnImageWithoutHousesKnowsNothing) {
  EXPECT_FALSE(LeanField(std::vector<SightedOutline>{}).found());
  EXPECT_FALSE(LeanField(town(3, [](const SightedOutline&, std::size_t) { return Point2{1, 1}; })).found());
}

}  // namespace
}  // namespace blockrand::observation
