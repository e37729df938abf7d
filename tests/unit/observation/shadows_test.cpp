// Shadows in pictures that the tests paint: where the sun stands, how long they are, and what they must not be mixed up with.
#include "pipeline/observation/shadows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::observation {
namespace {

using model::Point2;

constexpr double kPixel = 0.25, kSide = 80;  // m: the picture's middle is (0, 0)

struct Painted {
  double width = 12, depth = 9, angle = 0.3;     // of a house about (0, 0)
  Point2 towards{std::sin(2.6), std::cos(2.6)};  // the sun
  double length = 8;                             // m of shadow on the ground
  bool overcast = false;

  bool house(Point2 p) const {
    const double c = std::cos(angle), s = std::sin(angle);
    return std::fabs(p.x * c + p.y * s) < width / 2 && std::fabs(-p.x * s + p.y * c) < depth / 2;
  }
  bool shaded(Point2 p) const {
    for (double t = 0.1; t < length; t += 0.1)
      if (house({p.x + towards.x * t, p.y + towards.y * t})) return true;
    return false;
  }
  Patch patch() const {
    Patch out;
    out.west = -kSide / 2, out.north = kSide / 2, out.size = kPixel;
    out.width = out.height = static_cast<int>(kSide / kPixel);
    std::mt19937 random(7);
    for (int r = 0; r < out.height; ++r)
      for (int k = 0; k < out.width; ++k) {
        const Point2 p{out.west + (k + 0.5) * kPixel, out.north - (r + 0.5) * kPixel};
        const int grey = (house(p) ? 150 : !overcast && shaded(p) ? 45 : 120) + static_cast<int>(random() % 21) - 10;
        for (std::vector<std::uint8_t>* band : {&out.red, &out.green, &out.blue})
          band->push_back(static_cast<std::uint8_t>(grey));
        out.valid.push_back(1);
      }
    return out;
  }
  std::vector<WallPiece> pieces() const {
    const double c = std::cos(angle), s = std::sin(angle);
    std::vector<Point2> ring;
    for (const auto& [u, v] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
      const double x = u * width / 2, y = v * depth / 2;
      ring.push_back({x * c - y * s, x * s + y * c});
    }
    const std::vector<double> weights(4, 1.0);
    std::vector<WallPiece> out;
    add_pieces(ring, weights, out);
    return out;
  }
  std::optional<ShadowLength> seen(double least, double most, std::span<const Obstacles> others = {}) const {
    const Point2 away{-towards.x, -towards.y};
    return shadow_length(scan_shadow(pieces(), patch(), {}, away, others, most + 3), least, most, 0);
  }
};

TEST(Shadows, TheSunStandsWhereTheGroundBesideHousesIsBrighter) {
  SunnySides sides;
  for (int k = 0; k < 12; ++k) {
    Painted p;
    p.angle = 0.13 * k;
    sides.add(p.pieces(), p.patch(), {});
  }
  const auto sun = sides.to_sun();
  ASSERT_TRUE(sun);
  const Painted any;
  EXPECT_GT(sun->x * any.towards.x + sun->y * any.towards.y, std::cos(0.2));  // 11 degrees
}

TEST(Shadows, AnOvercastImageHasNoSun) {
  SunnySides sides;
  for (int k = 0; k < 12; ++k) {
    Painted p;
    p.angle = 0.13 * k, p.overcast = true;
    sides.add(p.pieces(), p.patch(), {});
  }
  EXPECT_FALSE(sides.to_sun());
}

TEST(Shadows, LengthsAreFoundToAQuarterOfAMetre) {
  for (const double length : {3.0, 5.0, 8.0, 12.5, 17.0}) {
    Painted p;
    p.length = length;
    const auto seen = p.seen(1.5, 24);
    ASSERT_TRUE(seen) << length;
    EXPECT_NEAR(seen->length, length, 0.3);
    EXPECT_GT(seen->clearness, 0.15) << length;
  }
}

TEST(Shadows, WithoutSunTheyAreNotClear) {
  Painted p;
  p.overcast = true;
  if (const auto seen = p.seen(1.5, 24)) {
    EXPECT_LT(seen->clearness, 0.05);
  }
}

TEST(Shadows, OneThatReachesTheNextHouseIsNotRead) {
  Painted p;
  p.length = 12;
  // A house 5 m behind the shaded walls, along all of them: what lies beyond says nothing of the shadow.
  Obstacles other;
  const Point2 away{-p.towards.x, -p.towards.y}, across{-away.y, away.x};
  std::vector<Point2> ring;
  for (const auto& [u, v] : {std::pair(-40, 12), std::pair(40, 12), std::pair(40, 30), std::pair(-40, 30)})
    ring.push_back({across.x * u + away.x * v, across.y * u + away.y * v});
  for (const Point2 q : ring) other.box.include(q);
  other.rings = {ring};
  const std::vector<Obstacles> others{other};
  const auto free = p.seen(1.5, 24), stopped = p.seen(1.5, 24, others);
  ASSERT_TRUE(free);
  EXPECT_NEAR(free->length, 12, 0.3);
  EXPECT_TRUE(!stopped || stopped->clearness < free->clearness / 2);
}

TEST(Shadows, AreReadAsFarAsTheNextHouse) {
  // Houses of any form, with courts: where the way behind a wall first lies in one, point by point.
  Patch ground;
  ground.west = -40, ground.north = 40, ground.size = 0.4, ground.width = ground.height = 200;
  for (auto* band : {&ground.red, &ground.green, &ground.blue}) band->assign(40000, 100);
  ground.valid.assign(40000, 1);
  const Brightness brightness(ground);
  std::mt19937 random(11);
  const auto unit = [&] { return static_cast<double>(random() % 10000) / 10000; };
  int stopped = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<Obstacles> others(3);
    for (Obstacles& o : others) {
      const Point2 middle{60 * unit() - 30, 60 * unit() - 30};
      for (const double size : {1.0, 0.5}) {
        std::vector<Point2>& ring = o.rings.emplace_back();
        for (int k = 0; k < 9; ++k) {
          const double a = 2 * std::acos(-1) * k / 9, r = size * (3 + 9 * unit());
          ring.push_back({middle.x + r * std::cos(a), middle.y + r * std::sin(a)});
          o.box.include(ring.back());
        }
      }
    }
    const double angle = 7 * unit(), reach = 25;
    const Point2 away{std::cos(angle), std::sin(angle)};
    const std::vector<WallPiece> wall{{{4 * unit(), 4 * unit()}, {-away.y, away.x}, 2, 1}};
    std::size_t places = 0;
    for (; places * kShadowStep <= reach; ++places) {
      const double at = static_cast<double>(places) * kShadowStep;
      const Point2 p{wall[0].middle.x + away.x * at, wall[0].middle.y + away.y * at};
      const auto within = [p](const Obstacles& o) {
        return geometry::contains(o.rings[0], p) != geometry::contains(o.rings[1], p);
      };
      if (places > 2 && std::ranges::any_of(others, within)) break;
    }
    stopped += static_cast<double>(places) * kShadowStep < reach;
    const ShadowScan scan = scan_shadow(wall, brightness, {}, away, others, reach);
    // A place speaks where 1.75 m behind it were read.
    const auto speak = std::ranges::count_if(scan.walls, [](float w) { return w > 0; });
    EXPECT_EQ(speak, std::max<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(places) - 6)) << round;
  }
  EXPECT_GT(stopped, 100);
}

TEST(Shadows, AUsualLengthDecidesBetweenTwoEdges) {
  ShadowScan scan;
  scan.weight = 10;
  scan.step.assign(100, 0.0F), scan.walls.assign(100, 10.0F);
  scan.step[20] = 0.30F, scan.step[60] = 0.31F;  // 5 m and 15 m
  scan.sharp = scan.step;
  EXPECT_NEAR(shadow_length(scan, 1, 20, 0)->length, 15, 0.3);
  EXPECT_NEAR(shadow_length(scan, 1, 20, 6)->length, 5, 0.3);
  EXPECT_FALSE(shadow_length(scan, 21, 20, 0));
  EXPECT_FALSE(shadow_length({}, 1, 20, 0));
}

}  // namespace
}  // namespace blockrand::observation
