// Comparisons whose result is known: the ideal of every measure, and boxes against boxes. Distances are set against a
// quadrature of the exact distance to a box, which shares nothing with the product.
#include "pipeline/compare/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "pipeline/compare/body.h"
#include "pipeline/compare/summary.h"
#include "tests/unit/compare/boxes.h"

namespace blockrand::compare {
namespace {

using test::Block;
using test::building_of;
using test::city_of_blocks;
using test::prism;
using test::tessellated;

Comparison compared(City model, City reference, CompareOptions options = {}) {
  base::Progress progress;
  return compare_cities(std::move(model), std::move(reference), options, progress);
}

Comparison compared(const Building& model, const Building& reference) {
  return compared(city_of_blocks({model}), city_of_blocks({reference}));
}

const MeasureValue& value(const Comparison& c, Measure m, std::size_t match = 0) {
  return c.matches.at(match).values[static_cast<std::size_t>(m)];
}
double counted(const Comparison& c, Measure m) { return value(c, m).counted.value_or(NAN); }
double all(const Comparison& c, Measure m) { return value(c, m).all.value_or(NAN); }

void expect_ideal(const Comparison& c) {
  for (const MatchResult& match : c.matches)
    for (std::size_t i = 0; i < kMeasureCount; ++i) {
      const MeasureInfo& m = kMeasures[i];
      // acos of a cosine that is 1 to the last bit is 1e-6 degrees.
      const double slack = m.unit == "deg" ? 1e-4 : 1e-9;
      for (const std::optional<double>& v : {match.values[i].counted, match.values[i].all}) {
        if (!v) continue;
        if (m.better == Better::higher || m.better == Better::one) {
          EXPECT_NEAR(*v, 1, slack) << match.id << " " << m.id;
        }
        if (m.better == Better::lower || m.better == Better::zero) {
          EXPECT_NEAR(*v, 0, slack) << match.id << " " << m.id;
        }
      }
    }
}

// ---- the exact distance to a box, and its mean over another box's surface

struct Quadrature {
  double mean = 0, rms = 0, area = 0, farthest = 0, angle = 0;
  std::vector<std::pair<double, double>> distances;  ///< with weights
};

/// Distance from a point to the surface of a block (ground and roof included).
double distance_to(const Block& b, Point3 p) {
  const double dx = p.x - b.centre.x, dy = p.y - b.centre.y;
  const double x = std::fabs(dx * std::cos(b.turned) + dy * std::sin(b.turned)) - b.width / 2;
  const double y = std::fabs(-dx * std::sin(b.turned) + dy * std::cos(b.turned)) - b.depth / 2;
  const double z = std::fabs(p.z - b.ground - b.height / 2) - b.height / 2;
  const double outside = std::hypot(std::max(x, 0.0), std::max(y, 0.0), std::max(z, 0.0));
  return outside > 0 ? outside : std::min({-x, -y, -z});
}

/// Degrees between a normal and that of the block's nearest face; of faces that share the nearest place, the most
/// alike.
double angle_to(const Block& b, Point3 p, Point3 normal) {
  const double c = std::cos(b.turned), s = std::sin(b.turned);
  const double dx = p.x - b.centre.x, dy = p.y - b.centre.y;
  const double at[] = {dx * c + dy * s, -dx * s + dy * c, p.z - b.ground - b.height / 2};
  const double half[] = {b.width / 2, b.depth / 2, b.height / 2};
  const double alike[] = {std::fabs(normal.x * c + normal.y * s), std::fabs(-normal.x * s + normal.y * c),
                          std::fabs(normal.z)};
  double best = -1, depth = 1e9;
  const bool outside = std::fabs(at[0]) > half[0] || std::fabs(at[1]) > half[1] || std::fabs(at[2]) > half[2];
  for (int i = 0; i < 3; ++i) {
    const double here = half[i] - std::fabs(at[i]);
    if (outside ? here <= 0 : here < depth) {
      best = outside ? std::max(best, alike[i]) : alike[i];
      depth = here;
    }
  }
  return std::acos(std::min(1.0, best)) * 180 / std::numbers::pi;
}

/// Over the surface of `from`: walls and roof only, or the ground too.
Quadrature quadrature(const Block& from, const Block& to, bool with_ground) {
  constexpr double kStep = 0.02;
  Quadrature q;
  const auto corners = from.corners();
  const auto add = [&](Point3 o, Point3 u, Point3 v) {
    const double a = std::hypot(u.x, u.y, u.z), b = std::hypot(v.x, v.y, v.z);
    const int m = static_cast<int>(std::ceil(a / kStep)), n = static_cast<int>(std::ceil(b / kStep));
    const double weight = a * b / m / n;
    const Point3 normal{(u.y * v.z - u.z * v.y) / a / b, (u.z * v.x - u.x * v.z) / a / b,
                        (u.x * v.y - u.y * v.x) / a / b};
    for (int i = 0; i < m; ++i)
      for (int k = 0; k < n; ++k) {
        const double s = (i + 0.5) / m, t = (k + 0.5) / n;
        const double d = distance_to(to, {o.x + s * u.x + t * v.x, o.y + s * u.y + t * v.y, o.z + s * u.z + t * v.z});
        q.angle +=
            weight * angle_to(to, {o.x + s * u.x + t * v.x, o.y + s * u.y + t * v.y, o.z + s * u.z + t * v.z}, normal);
        q.mean += weight * d;
        q.rms += weight * d * d;
        q.area += weight;
        q.distances.emplace_back(d, weight);
      }
    for (const double s : {0.0, 1.0})
      for (const double t : {0.0, 1.0})
        q.farthest = std::max(
            q.farthest, distance_to(to, {o.x + s * u.x + t * v.x, o.y + s * u.y + t * v.y, o.z + s * u.z + t * v.z}));
  };
  const double g = from.ground, h = from.height;
  for (std::size_t i = 0; i < 4; ++i) {
    const Point2 a = corners[i], b = corners[(i + 1) % 4];
    add({a.x, a.y, g}, {b.x - a.x, b.y - a.y, 0}, {0, 0, h});
  }
  const Point3 u{corners[1].x - corners[0].x, corners[1].y - corners[0].y, 0};
  const Point3 v{corners[3].x - corners[0].x, corners[3].y - corners[0].y, 0};
  add({corners[0].x, corners[0].y, g + h}, u, v);
  if (with_ground) add({corners[0].x, corners[0].y, g}, u, v);
  return q;
}

/// Expects the distances of two blocks as the quadrature says, both ways and together.
void expect_distances(const Block& model, const Block& reference) {
  CompareOptions options;
  options.surface.samples = 400000;  // what is left of chance is well below a millimetre
  const Comparison c =
      compared(city_of_blocks({building_of(model)}), city_of_blocks({building_of(reference)}), options);
  ASSERT_EQ(c.matches.size(), 1u);
  constexpr double kMillimetre = 0.001;
  for (const bool with_ground : {false, true}) {
    const Quadrature a = quadrature(model, reference, with_ground), b = quadrature(reference, model, with_ground);
    const auto measured = [&](Measure m) { return with_ground ? all(c, m) : counted(c, m); };
    EXPECT_NEAR(measured(Measure::to_reference_mean), a.mean / a.area, kMillimetre) << with_ground;
    EXPECT_NEAR(measured(Measure::to_model_mean), b.mean / b.area, kMillimetre) << with_ground;
    EXPECT_NEAR(measured(Measure::distance_mean), (a.mean + b.mean) / (a.area + b.area), kMillimetre) << with_ground;
    EXPECT_NEAR(measured(Measure::distance_rms), std::sqrt((a.rms + b.rms) / (a.area + b.area)), kMillimetre)
        << with_ground;
    constexpr double kTenthOfADegree = 0.1;
    EXPECT_NEAR(measured(Measure::normal_deviation), (a.angle + b.angle) / (a.area + b.area), kTenthOfADegree)
        << with_ground;
    EXPECT_NEAR(measured(Measure::distance_max), std::max(a.farthest, b.farthest), kMillimetre) << with_ground;
    for (const auto& [bound, complete, correct] :
         {std::tuple(0.25, Measure::completeness_025, Measure::correctness_025),
          std::tuple(0.5, Measure::completeness_050, Measure::correctness_050),
          std::tuple(1.0, Measure::completeness_100, Measure::correctness_100)}) {
      const auto share = [&](const Quadrature& q, double slack) {
        double within = 0;
        for (const auto& [d, w] : q.distances) within += d <= bound + slack ? w : 0;
        return within / q.area;
      };
      // Where a whole face lies at the bound exactly, either is right.
      EXPECT_GE(measured(complete), share(b, -1e-6) - 0.002) << bound;
      EXPECT_LE(measured(complete), share(b, 1e-6) + 0.002) << bound;
      EXPECT_GE(measured(correct), share(a, -1e-6) - 0.002) << bound;
      EXPECT_LE(measured(correct), share(a, 1e-6) + 0.002) << bound;
    }
  }
}

// ---- identical models

TEST(Compare, IdenticalModelsAreIdealInEveryMeasure) {
  std::vector<Building> houses;
  for (int i = 0; i < 5; ++i)
    houses.push_back(building_of({.id = "h" + std::to_string(i), .centre = {i * 10.0, 3}, .turned = 0.0}));
  houses.push_back(building_of({.id = "free", .centre = {20, 60}, .turned = 0.4}));
  const Comparison c = compared(city_of_blocks(houses), city_of_blocks(houses));
  ASSERT_EQ(c.matches.size(), 6u);
  EXPECT_TRUE(c.missing.empty());
  EXPECT_TRUE(c.extra.empty());
  expect_ideal(c);
  for (const Measure m :
       {Measure::footprint_iou, Measure::area_ratio, Measure::eaves_error, Measure::ridge_error, Measure::volume_ratio,
        Measure::distance_mean, Measure::distance_max, Measure::completeness_025, Measure::normal_deviation,
        Measure::roof_type_agrees, Measure::valid_model, Measure::semantic_model})
    EXPECT_EQ(c.summaries[static_cast<std::size_t>(m)].counted.count, 6u) << info(m).id;
  EXPECT_NEAR(c.registration.east, 0, 1e-9);
  EXPECT_NEAR(c.registration.north, 0, 1e-9);
}

// ---- boxes against boxes

TEST(Compare, ABoxATenthOfAMetreLarger) {
  const Block reference, model{.width = 10.2, .depth = 8.2, .height = 6.1};
  const Comparison c = compared(building_of(model), building_of(reference));
  EXPECT_NEAR(counted(c, Measure::footprint_iou), 80 / (10.2 * 8.2), 1e-9);
  EXPECT_NEAR(counted(c, Measure::area_ratio), 10.2 * 8.2 / 80, 1e-9);
  EXPECT_NEAR(counted(c, Measure::volume_ratio) / (10.2 * 8.2 * 6.1 / 480), 1, 1e-6);
  EXPECT_NEAR(counted(c, Measure::eaves_error), 0.1, 1e-9);
  EXPECT_NEAR(counted(c, Measure::ridge_error), 0.1, 1e-9);
  EXPECT_NEAR(counted(c, Measure::outline_distance), 0.1 * std::numbers::sqrt2, 1e-9);
  EXPECT_NEAR(counted(c, Measure::offset_east), 0, 1e-9);
  expect_distances(model, reference);
}

TEST(Compare, ABoxThatIsShifted) {
  const Block reference, model{.centre = {0.3, 0}};
  const Comparison c = compared(building_of(model), building_of(reference));
  EXPECT_NEAR(counted(c, Measure::footprint_iou), 9.7 / 10.3, 1e-9);
  EXPECT_NEAR(counted(c, Measure::offset_east), 0.3, 1e-9);
  EXPECT_NEAR(counted(c, Measure::offset_north), 0, 1e-9);
  EXPECT_NEAR(counted(c, Measure::outline_distance), 0.3, 1e-9);
  EXPECT_NEAR(counted(c, Measure::volume_ratio), 1, 1e-6);
  EXPECT_NEAR(c.registration.east, 0.3, 1e-9);
  EXPECT_FALSE(c.registration.horizontal_removed);
  expect_distances(model, reference);
}

TEST(Compare, ABoxThatIsTurned) {
  const Block reference, model{.turned = 0.1};
  const Comparison c = compared(building_of(model), building_of(reference));
  EXPECT_NEAR(counted(c, Measure::area_ratio), 1, 1e-9);
  EXPECT_NEAR(counted(c, Measure::volume_ratio), 1, 1e-6);
  EXPECT_NEAR(counted(c, Measure::offset_east), 0, 1e-9);
  expect_distances(model, reference);
}

TEST(Compare, ABoxOneStoreyHigher) {
  const Block reference, model{.height = 9};
  const Comparison c = compared(building_of(model), building_of(reference));
  EXPECT_NEAR(counted(c, Measure::footprint_iou), 1, 1e-9);
  EXPECT_NEAR(counted(c, Measure::eaves_error), 3, 1e-9);
  EXPECT_NEAR(counted(c, Measure::ridge_error), 3, 1e-9);
  EXPECT_NEAR(counted(c, Measure::volume_ratio), 1.5, 1e-6);
  EXPECT_NEAR(counted(c, Measure::roof_volume_ratio), 1.5, 1e-9);
  expect_distances(model, reference);
}

TEST(Compare, OpeningsAreComparedAtTheHeightsThatTheRestIs) {
  // One window at one height, above a ground that lies 2 m higher in the reference.
  const auto with_window = [](double ground) {
    Building b = building_of({.height = 9 - ground, .ground = ground});
    Opening window;
    window.polygons = {{{{-1, -4, 4}, {1, -4, 4}, {1, -4, 5.5}, {-1, -4, 5.5}}}};
    b.openings.push_back(window);
    return city_of_blocks({b});
  };
  EXPECT_EQ(counted(compared(with_window(0), with_window(2)), Measure::opening_recall), 0);
  CompareOptions options;
  options.heights = Heights::absolute;
  const Comparison absolute = compared(with_window(0), with_window(2), options);
  EXPECT_EQ(counted(absolute, Measure::opening_recall), 1);
  EXPECT_NEAR(absolute.matches[0].facades.reference[0].bottom, 0, 1e-9);
  EXPECT_NEAR(absolute.matches[0].facades.model[0].bottom, -2, 1e-9);
}

TEST(Compare, HeightsAreAboveOnesOwnGround) {
  const Block reference{.ground = 34.5}, model{.height = 6.5, .ground = 0};
  const Comparison own = compared(building_of(model), building_of(reference));
  EXPECT_NEAR(counted(own, Measure::eaves_error), 0.5, 1e-9);
  EXPECT_FALSE(value(own, Measure::base_error).counted);
  EXPECT_LT(counted(own, Measure::distance_max), 0.51);

  const Comparison absolute =
      compared(city_of_blocks({building_of(model)}, true), city_of_blocks({building_of(reference)}, true));
  EXPECT_NEAR(counted(absolute, Measure::base_error), -34.5, 1e-9);
  EXPECT_NEAR(counted(absolute, Measure::eaves_error), 0.5, 1e-9);
  EXPECT_GT(counted(absolute, Measure::distance_mean), 25);
  ASSERT_TRUE(absolute.registration.up);
  EXPECT_NEAR(*absolute.registration.up, -34.5, 1e-9);

  CompareOptions options;
  options.align = Align::vertical;
  const Comparison moved =
      compared(city_of_blocks({building_of(model)}, true), city_of_blocks({building_of(reference)}, true), options);
  EXPECT_TRUE(moved.registration.vertical_removed);
  EXPECT_NEAR(counted(moved, Measure::base_error), 0, 1e-9);
  EXPECT_LT(counted(moved, Measure::distance_max), 0.51);

  // Heights of which one is no height over anything are never compared as they stand, unless the user says so.
  const Comparison mixed =
      compared(city_of_blocks({building_of(model)}, false), city_of_blocks({building_of(reference)}, true));
  EXPECT_FALSE(value(mixed, Measure::base_error).counted);
  EXPECT_FALSE(mixed.registration.up);
  City ellipsoidal = city_of_blocks({building_of(model)}, true);
  ellipsoidal.height_reference = "ellipsoidal";
  EXPECT_FALSE(compared(ellipsoidal, city_of_blocks({building_of(reference)}, true)).absolute_heights);
  options = {};
  options.heights = Heights::absolute;
  EXPECT_TRUE(compared(ellipsoidal, city_of_blocks({building_of(reference)}, true), options).absolute_heights);
}

// ---- what must not matter

TEST(Compare, IsSymmetric) {
  const Block a{.width = 11, .height = 7, .turned = 0.05}, b{.centre = {0.4, -0.2}, .depth = 8.5};
  const Comparison c = compared(building_of(a), building_of(b)), d = compared(building_of(b), building_of(a));
  for (const Measure m :
       {Measure::footprint_iou, Measure::outline_distance, Measure::distance_mean, Measure::distance_rms,
        Measure::distance_p95, Measure::distance_max, Measure::normal_deviation, Measure::roof_type_agrees}) {
    EXPECT_NEAR(counted(c, m), counted(d, m), 1e-9) << info(m).id;
    EXPECT_NEAR(all(c, m), all(d, m), 1e-9) << info(m).id;
  }
  for (const Measure m : {Measure::offset_east, Measure::offset_north, Measure::eaves_error, Measure::ridge_error})
    EXPECT_NEAR(counted(c, m), -counted(d, m), 1e-9) << info(m).id;
  for (const Measure m : {Measure::area_ratio, Measure::volume_ratio})
    EXPECT_NEAR(counted(c, m) * counted(d, m), 1, 1e-9) << info(m).id;
  for (const auto& [there, back] : {std::pair(Measure::to_reference_mean, Measure::to_model_mean),
                                    std::pair(Measure::completeness_025, Measure::correctness_025),
                                    std::pair(Measure::completeness_050, Measure::correctness_050),
                                    std::pair(Measure::completeness_100, Measure::correctness_100)}) {
    EXPECT_NEAR(counted(c, there), counted(d, back), 1e-9) << info(there).id;
    EXPECT_NEAR(counted(c, back), counted(d, there), 1e-9) << info(back).id;
  }
}

TEST(Compare, DoesNotDependOnTessellation) {
  const Block a{.width = 11, .height = 7, .turned = 0.05}, b{.centre = {0.4, -0.2}};
  const Comparison whole = compared(building_of(a), building_of(b));
  for (const int n : {1, 3, 10}) {
    const Comparison cut = compared(tessellated(building_of(a), n), tessellated(building_of(b), 7));
    for (std::size_t i = 0; i < kMeasureCount; ++i) {
      const auto m = static_cast<Measure>(i);
      if (m == Measure::triangles_model || m == Measure::triangles_reference) continue;
      ASSERT_EQ(value(whole, m).counted.has_value(), value(cut, m).counted.has_value()) << info(m).id;
      if (!value(whole, m).counted) continue;
      EXPECT_NEAR(counted(whole, m), counted(cut, m), 1e-3) << info(m).id << " " << n;
      EXPECT_NEAR(all(whole, m), all(cut, m), 1e-3) << info(m).id << " " << n;
    }
  }
}

std::vector<Building> village(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double a, double b) { return a + (b - a) * static_cast<double>(random()) / 4294967295.0; };
  std::vector<Building> out;
  for (int i = 0; i < 36; ++i)
    out.push_back(building_of({.id = "v" + std::to_string(i),
                               .centre = {25.0 * (i % 6) + between(-4, 4), 25.0 * (i / 6) + between(-4, 4)},
                               .width = between(8, 16),
                               .depth = between(6, 11),
                               .height = between(4, 15),
                               .turned = between(0, 3)}));
  return out;
}

TEST(Compare, DoesNotDependOnThreadsOrderOrFiles) {
  const std::vector<Building> a = village(1);
  std::vector<Building> b = village(1);
  for (Building& house : b)
    for (Face& f : house.faces)
      for (Point3& p : f.rings[0]) p.z += p.z > 0 ? 0.3 : 0;
  CompareOptions one;
  one.jobs = 1;
  const Comparison c = compared(city_of_blocks(a), city_of_blocks(b), one);
  std::vector<Building> turned_round(a.rbegin(), a.rend());
  for (std::size_t i = 0; i < turned_round.size(); ++i) turned_round[i].file = static_cast<std::uint32_t>(i % 3);
  CompareOptions four;
  four.jobs = 4;
  const Comparison d = compared(city_of_blocks(turned_round), city_of_blocks(b), four);
  ASSERT_EQ(c.matches.size(), d.matches.size());
  for (std::size_t i = 0; i < c.matches.size(); ++i) {
    EXPECT_EQ(c.matches[i].id, d.matches[i].id);
    for (std::size_t m = 0; m < kMeasureCount; ++m) {
      EXPECT_EQ(c.matches[i].values[m].counted, d.matches[i].values[m].counted) << kMeasures[m].id;
      EXPECT_EQ(c.matches[i].values[m].all, d.matches[i].values[m].all) << kMeasures[m].id;
    }
  }
}

// ---- registration and matching

TEST(Compare, FindsAnOffsetAndRemovesItOnRequestOnly) {
  for (const Point2 by : {Point2{0.7, -0.4}, Point2{7.3, -4.1}, Point2{-16, 20}}) {
    City model = city_of_blocks(village(7));
    move(model, {by.x, by.y, 0});
    const Comparison c = compared(model, city_of_blocks(village(7)));
    EXPECT_EQ(c.matches.size(), 36u);
    EXPECT_NEAR(c.registration.east, by.x, 1e-6);
    EXPECT_NEAR(c.registration.north, by.y, 1e-6);
    EXPECT_NEAR(c.registration.east_spread, 0, 1e-6);
    EXPECT_FALSE(c.registration.horizontal_removed);
    EXPECT_NEAR(c.summaries[static_cast<std::size_t>(Measure::offset_east)].counted.mean, by.x, 1e-6);

    CompareOptions options;
    options.align = Align::horizontal;
    const Comparison d = compared(model, city_of_blocks(village(7)), options);
    EXPECT_TRUE(d.registration.horizontal_removed);
    EXPECT_NEAR(d.summaries[static_cast<std::size_t>(Measure::footprint_iou)].counted.min, 1, 1e-6);
    EXPECT_NEAR(d.summaries[static_cast<std::size_t>(Measure::distance_max)].counted.max, 0, 1e-6);
  }
}

TEST(Compare, AStrangeHouseDoesNotMoveTheOffset) {
  std::vector<Building> houses = village(3);
  houses[5] = building_of({.id = "v5", .centre = {25 * 5 + 6.0, 3}, .width = 14});
  const Comparison c = compared(city_of_blocks(houses), city_of_blocks(village(3)));
  EXPECT_NEAR(c.registration.east, 0, 1e-6);
  EXPECT_NEAR(c.registration.north, 0, 1e-6);
}

TEST(Compare, OneBlockAgainstItsHouses) {
  std::vector<Building> houses;
  for (int i = 0; i < 4; ++i) houses.push_back(building_of({.id = "h" + std::to_string(i), .centre = {i * 10.0, 0}}));
  const Building block = building_of({.id = "block", .centre = {15, 0}, .width = 40});
  const Comparison c = compared(city_of_blocks({block}), city_of_blocks(houses));
  ASSERT_EQ(c.matches.size(), 1u);
  EXPECT_EQ(c.matches[0].reference.buildings.size(), 4u);
  EXPECT_NEAR(counted(c, Measure::footprint_iou), 1, 1e-9);
  EXPECT_NEAR(counted(c, Measure::volume_ratio), 1, 1e-9);
  EXPECT_NEAR(counted(c, Measure::eaves_error), 0, 1e-9);
  // Party walls are in the houses alone: they are left out, and told.
  EXPECT_NEAR(counted(c, Measure::distance_max), 0, 1e-6);
  EXPECT_GT(all(c, Measure::distance_max), 2.9);
  const double ground = 320, party = 6 * 8 * 6.0, surface = 4 * (160 + 36 * 6.0);
  EXPECT_NEAR(value(c, Measure::distance_mean).left_out, (ground + party) / surface, 0.01);
  const Comparison d = compared(city_of_blocks(houses), city_of_blocks({block}));
  ASSERT_EQ(d.matches.size(), 1u);
  EXPECT_EQ(d.matches[0].model.buildings.size(), 4u);
  EXPECT_NEAR(counted(d, Measure::distance_max), 0, 1e-6);
}

TEST(Compare, NeighboursThatTouchAreNotTheSameHouse) {
  // Drawn half a metre off, each house overlaps its neighbour's place by 5 %.
  std::vector<Building> a, b;
  for (int i = 0; i < 4; ++i) {
    a.push_back(building_of({.id = "h" + std::to_string(i), .centre = {i * 10.0, 0}}));
    b.push_back(building_of({.id = "h" + std::to_string(i), .centre = {i * 10.0 + 0.5, 0}}));
  }
  const Comparison c = compared(city_of_blocks(b), city_of_blocks(a));
  ASSERT_EQ(c.matches.size(), 4u);
  for (const MatchResult& m : c.matches) EXPECT_EQ(m.model.buildings.size(), 1u);
}

TEST(Compare, MissingAndExtraBuildingsAreTold) {
  std::vector<Building> model = village(2), reference = village(2);
  model.erase(model.begin() + 3);
  reference.erase(reference.begin() + 10);
  const Comparison c = compared(city_of_blocks(model), city_of_blocks(reference));
  EXPECT_EQ(c.matches.size(), 34u);
  ASSERT_EQ(c.missing.size(), 1u);
  ASSERT_EQ(c.extra.size(), 1u);
  EXPECT_EQ(c.reference.buildings[c.missing[0]].id, "v3");
  EXPECT_EQ(c.model.buildings[c.extra[0]].id, "v10");
  EXPECT_EQ(c.missing_covered[0], 0);
}

TEST(Compare, RowsOfEqualHousesDoNotJumpToTheNextHouse) {
  // Each model has ten houses of a row, eight of them the same: a shift by two houses fits all ten.
  std::vector<Building> model, reference;
  for (int row = 0; row < 5; ++row)
    for (int i = 0; i < 12; ++i) {
      const Building b = building_of(
          {.id = "r" + std::to_string(row) + "_" + std::to_string(i), .centre = {i * 6.0, row * 40.0}, .width = 6});
      if (i < 10) model.push_back(b);
      if (i >= 2) reference.push_back(b);
    }
  const Comparison c = compared(city_of_blocks(model), city_of_blocks(reference));
  EXPECT_NEAR(c.registration.east, 0, 1e-6);
  EXPECT_EQ(c.matches.size(), 40u);
  EXPECT_EQ(c.missing.size(), 10u);
}

TEST(Compare, TwoDifferentHousesAreNotTheSameAtAnyDistance) {
  const Comparison c = compared(building_of({.centre = {22, 5}}), building_of({}));
  EXPECT_TRUE(c.matches.empty());
  EXPECT_EQ(c.missing.size(), 1u);
  EXPECT_EQ(c.extra.size(), 1u);
}

TEST(Compare, AGarageUnderSixHousesMakesNoBlockOfThem) {
  std::vector<Building> houses;
  for (int i = 0; i < 6; ++i) houses.push_back(building_of({.id = "h" + std::to_string(i), .centre = {i * 14.0, 0}}));
  std::vector<Building> model = houses;
  model.push_back(
      building_of({.id = "garage", .centre = {35, 0}, .width = 90, .depth = 30, .height = 3, .ground = -3}));
  const Comparison c = compared(city_of_blocks(model), city_of_blocks(houses));
  EXPECT_EQ(c.matches.size(), 6u);
  ASSERT_EQ(c.extra.size(), 1u);
  EXPECT_EQ(c.model.buildings[c.extra[0]].id, "garage");
  EXPECT_NEAR(c.summaries[static_cast<std::size_t>(Measure::eaves_error)].counted.max, 0, 1e-9);
  EXPECT_NEAR(c.summaries[static_cast<std::size_t>(Measure::distance_mean)].left_out, 80 / 376.0, 0.02)
      << "grounds only";
}

TEST(Compare, AnAnnexDrawnApartJoinsItsHouse) {
  const Building house = building_of({.id = "house", .centre = {0, 0}, .width = 14});
  const Building main = building_of({.id = "main", .centre = {-2, 0}, .width = 10}),
                 annex = building_of({.id = "annex", .centre = {5, 0}, .width = 4});
  const Comparison c = compared(city_of_blocks({main, annex}), city_of_blocks({house}));
  ASSERT_EQ(c.matches.size(), 1u);
  EXPECT_EQ(c.matches[0].model.buildings.size(), 2u);
}

TEST(Compare, OutlinesAreMeasuredBetweenTheirCornersToo) {
  // The middle of a long block is missing: its corners lie on the reference's outline.
  const Building block = building_of({.id = "block", .width = 30, .depth = 10});
  const Building left = building_of({.id = "left", .centre = {-10, 0}, .width = 10, .depth = 10}),
                 right = building_of({.id = "right", .centre = {10, 0}, .width = 10, .depth = 10});
  const Comparison c = compared(city_of_blocks({left, right}), city_of_blocks({block}));
  EXPECT_NEAR(counted(c, Measure::outline_distance), 5, 0.3);
}

TEST(Compare, WallsBetweenBodiesOfABuildingAreLeftOut) {
  const Building whole = building_of({.id = "a", .width = 20});
  Building parts = building_of({.id = "a", .centre = {-5, 0}});
  const Building other = building_of({.centre = {5, 0}});
  parts.faces.insert(parts.faces.end(), other.faces.begin(), other.faces.end());
  parts.shells.push_back(other.shells[0]);
  parts.footprint = whole.footprint;
  parts.footprint_area = whole.footprint_area;
  parts.bodies = 2;
  const Comparison c = compared(parts, whole);
  EXPECT_NEAR(counted(c, Measure::distance_max), 0, 1e-6);
  EXPECT_NEAR(counted(c, Measure::volume_ratio), 1, 1e-9);
  EXPECT_NEAR(c.matches[0].model.left_out[static_cast<std::size_t>(LeftOut::covered)], 2 * 8 * 6, 2);
}

TEST(Compare, WallsMissingInPairsLeaveNoVolume) {
  Building terrace = building_of({.turned = 0.785398});
  terrace.shells[0].polygons.erase(terrace.shells[0].polygons.begin() + 3);
  terrace.shells[0].polygons.erase(terrace.shells[0].polygons.begin() + 4);
  terrace.faces.erase(terrace.faces.begin() + 3);
  terrace.faces.erase(terrace.faces.begin() + 4);
  EXPECT_FALSE(volume_of(terrace));
}

TEST(Compare, HalfARoofIsHalfTheRoomUnderIt) {
  Building half = building_of({.id = "b"});
  half.faces[1].rings = {{{-5, -4, 6}, {1, -4, 6}, {1, 4, 6}, {-5, 4, 6}}};
  EXPECT_NEAR(counted(compared(half, building_of({.id = "b"})), Measure::roof_volume_ratio), 0.6, 0.02);
}

TEST(Compare, TheOriginDoesNotMatter) {
  Block a{.width = 11, .height = 7, .turned = 0.3}, b{.turned = 0.25};
  const Comparison here = compared(building_of(a), building_of(b));
  a.centre = b.centre = {1234.5, -987.25};
  const Comparison there = compared(building_of(a), building_of(b));
  for (std::size_t i = 0; i < kMeasureCount; ++i) {
    const auto m = static_cast<Measure>(i);
    ASSERT_EQ(value(here, m).counted.has_value(), value(there, m).counted.has_value()) << info(m).id;
    if (!value(here, m).counted) continue;
    EXPECT_NEAR(counted(here, m), counted(there, m), 2e-4) << info(m).id;
  }
}

TEST(Compare, FarBuildingsAreNoPartOfIt) {
  std::vector<Building> model = village(2);
  model.push_back(building_of({.id = "far", .centre = {2000, 0}}));
  const Comparison c = compared(city_of_blocks(model), city_of_blocks(village(2)));
  EXPECT_TRUE(c.extra.empty());
  EXPECT_EQ(c.model.out_of_reach, 1u);
}

TEST(Compare, NothingAtAllIsNoError) {
  const Comparison c = compared(city_of_blocks({}), city_of_blocks({}));
  EXPECT_TRUE(c.matches.empty());
  const Comparison d = compared(city_of_blocks({}), city_of_blocks({building_of({})}));
  EXPECT_TRUE(d.matches.empty());
  EXPECT_EQ(d.registration.matches, 0u);
}

// ---- covered walls, bodies, soundness

TEST(Compare, PartyWallsAreLeftOutUpToTheNeighboursRoof) {
  const Building house = building_of({.id = "a", .height = 12}), low = building_of({.id = "b", .centre = {10, 0}});
  const Comparison c = compared(city_of_blocks({house, low}), city_of_blocks({house, low}));
  const SideFacts& side = c.matches[0].reference;
  EXPECT_NEAR(side.left_out[static_cast<std::size_t>(LeftOut::covered)], 8 * 6, 1.5);  // half of the wall
  EXPECT_NEAR(side.left_out[static_cast<std::size_t>(LeftOut::ground)], 80, 1.5);
  EXPECT_NEAR(c.matches[1].reference.left_out[static_cast<std::size_t>(LeftOut::covered)], 8 * 6, 1.5);
}

TEST(Compare, VolumesOfShellsVoidsAndFaces) {
  Building b = building_of({});
  EXPECT_NEAR(*volume_of(b) / 480, 1, 1e-12);
  Shell hollow = building_of({.width = 4, .depth = 2, .height = 3, .ground = 1}).shells[0];
  hollow.outer = false;
  b.shells.push_back(hollow);
  EXPECT_NEAR(*volume_of(b) / 456, 1, 1e-12);
  b.shells[0].polygons.pop_back();
  EXPECT_NEAR(*volume_of(b) / 480, 1, 1e-12) << "an open shell does not count";
  b.shells.clear();
  EXPECT_NEAR(*volume_of(b) / 480, 1, 1e-12) << "of closed faces";
  b.faces.pop_back();
  EXPECT_FALSE(volume_of(b)) << "a wall is missing";
  for (Face& f : b.faces)
    for (auto& ring : f.rings) std::reverse(ring.begin(), ring.end());
  EXPECT_FALSE(volume_of(b));
}

TEST(Compare, UnsoundSolidsAreNamed) {
  Building b = building_of({});
  EXPECT_EQ(shell_defect(b.shells[0]), "");
  Shell open = b.shells[0];
  open.polygons.pop_back();
  EXPECT_THAT(shell_defect(open), testing::HasSubstr("302"));
  Shell turned = b.shells[0];
  for (Rings3& rings : turned.polygons)
    for (auto& ring : rings) std::reverse(ring.begin(), ring.end());
  EXPECT_THAT(shell_defect(turned), testing::HasSubstr("405"));
  EXPECT_NE(shell_defect(Shell{}), "");
}

TEST(Compare, RoofFormsAreToldFromPlanes) {
  // A gabled roof over the block, ridge along x.
  Building gabled = building_of({});
  gabled.faces.erase(gabled.faces.begin() + 1);
  Face slope = building_of({}).faces[1];
  slope.rings = {{{-5, -4, 6}, {5, -4, 6}, {5, 0, 9}, {-5, 0, 9}}};
  gabled.faces.push_back(slope);
  slope.rings = {{{5, 4, 6}, {-5, 4, 6}, {-5, 0, 9}, {5, 0, 9}}};
  gabled.faces.push_back(slope);
  const Comparison c = compared(building_of({}), gabled);
  EXPECT_EQ(c.matches[0].reference.roof_form, RoofForm::gabled);
  EXPECT_EQ(c.matches[0].model.roof_form, RoofForm::flat);
  EXPECT_EQ(counted(c, Measure::roof_type_agrees), 0);
  EXPECT_NEAR(*c.matches[0].reference.pitch, std::atan(0.75) * 180 / std::numbers::pi, 1e-6);
  EXPECT_NEAR(*c.matches[0].reference.ridge, 9, 1e-9);
  EXPECT_NEAR(*c.matches[0].reference.eaves, 6, 1e-9);
  EXPECT_NEAR(counted(c, Measure::ridge_error), -3, 1e-9);
  EXPECT_NEAR(counted(c, Measure::roof_volume_ratio), 6 / 7.5, 0.005);
  EXPECT_EQ(c.roof_confusion[static_cast<std::size_t>(RoofForm::gabled)][static_cast<std::size_t>(RoofForm::flat)], 1u);
}

TEST(Compare, RidgesOfGabledRoofsAgreeOrStandSquare) {
  const auto roof = [](bool along) {
    Building b = building_of({});
    b.faces.erase(b.faces.begin() + 1);
    Face slope = building_of({}).faces[1];
    if (along) {
      slope.rings = {{{-5, -4, 6}, {5, -4, 6}, {5, 0, 9}, {-5, 0, 9}}};
      b.faces.push_back(slope);
      slope.rings = {{{5, 4, 6}, {-5, 4, 6}, {-5, 0, 9}, {5, 0, 9}}};
    } else {
      slope.rings = {{{-5, 4, 6}, {-5, -4, 6}, {0, -4, 9}, {0, 4, 9}}};
      b.faces.push_back(slope);
      slope.rings = {{{5, -4, 6}, {5, 4, 6}, {0, 4, 9}, {0, -4, 9}}};
    }
    b.faces.push_back(slope);
    return b;
  };
  EXPECT_EQ(counted(compared(roof(true), roof(true)), Measure::ridge_agrees), 1);
  EXPECT_EQ(counted(compared(roof(true), roof(false)), Measure::ridge_agrees), 0);
  const Comparison c = compared(roof(true), building_of({}));
  EXPECT_FALSE(c.matches[0].values[static_cast<std::size_t>(Measure::ridge_agrees)].counted) << "one has no ridge";
}

// ---- polygons as strangers draw them

double area_of(const std::vector<Triangle3>& triangles) {
  double sum = 0;
  for (const Triangle3& t : triangles) {
    const double ux = t[1].x - t[0].x, uy = t[1].y - t[0].y, uz = t[1].z - t[0].z;
    const double vx = t[2].x - t[0].x, vy = t[2].y - t[0].y, vz = t[2].z - t[0].z;
    sum += std::hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx) / 2;
  }
  return sum;
}

TEST(FaceTriangles, OfPolygonsAsTheyCome) {
  const std::vector<Point3> square{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
  EXPECT_NEAR(area_of(triangles_of({square})), 100, 1e-9);
  const std::vector<Point3> hole{{2, 2, 0}, {2, 4, 0}, {4, 4, 0}, {4, 2, 0}};
  EXPECT_NEAR(area_of(triangles_of({square, hole})), 96, 1e-9);
  // Upright, turned either way.
  const std::vector<Point3> wall{{0, 0, 0}, {3, 4, 0}, {3, 4, 7}, {0, 0, 7}};
  EXPECT_NEAR(area_of(triangles_of({wall})), 35, 1e-9);
  EXPECT_NEAR(area_of(triangles_of({{wall.rbegin(), wall.rend()}})), 35, 1e-9);
  // Repeated points, points on edges.
  EXPECT_NEAR(
      area_of(triangles_of({{{0, 0, 0}, {5, 0, 0}, {5, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {0, 0, 0}}})), 100,
      1e-9);
  bool mended = false;
  // A spike, a hole that touches the outer ring, a figure of eight.
  EXPECT_NEAR(
      area_of(triangles_of({{{0, 0, 0}, {10, 0, 0}, {15, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}}}, &mended)), 100,
      0.01);
  EXPECT_NEAR(area_of(triangles_of({square, {{0, 0, 0}, {2, 4, 0}, {4, 2, 0}}}, &mended)), 94, 0.1);
  EXPECT_TRUE(mended);
  EXPECT_GT(area_of(triangles_of({{{0, 0, 0}, {10, 0, 0}, {0, 7, 0}, {8, 9, 0}}})), 0);
  // Lines and points.
  EXPECT_TRUE(triangles_of({}).empty());
  EXPECT_TRUE(triangles_of({{{0, 0, 0}, {1, 1, 1}}}).empty());
  EXPECT_TRUE(triangles_of({{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}}).empty());
}

TEST(NearestSurface, AgreesWithTheDistanceToATriangle) {
  const std::vector<Triangle3> triangles{{Point3{0, 0, 0}, Point3{4, 0, 0}, Point3{0, 4, 0}},
                                         {Point3{1, 1, 1}, Point3{1, 1, 1}, Point3{2, 2, 2}},  // no area: left out
                                         {Point3{0, 0, 5}, Point3{4, 0, 5}, Point3{0, 4, 5}}};
  const geometry::NearestSurface surface(triangles);
  EXPECT_NEAR(surface.nearest({1, 1, 1}).distance, 1, 1e-12);
  EXPECT_EQ(surface.nearest({1, 1, 1}).triangle, 0u);
  EXPECT_EQ(surface.nearest({1, 1, 4}).triangle, 2u);
  EXPECT_NEAR(surface.nearest({-3, -4, 0}).distance, 5, 1e-12);
  EXPECT_NEAR(surface.nearest({4, 4, 0}).distance, 2 * std::numbers::sqrt2, 1e-12);
  EXPECT_TRUE(geometry::NearestSurface({}).empty());
}

TEST(DistanceHistogram, TellsSharesAndQuantiles) {
  DistanceHistogram h;
  EXPECT_EQ(h.share_up_to(1), 0);
  for (int i = 0; i < 100; ++i) h.add(0.01 * i + 0.0005, 2);
  EXPECT_NEAR(h.share_up_to(0.25), 0.25, 1e-12);
  EXPECT_NEAR(h.quantile(0.95), 0.941, 1e-9);
  h.add(1e9, 200);
  EXPECT_NEAR(h.share_up_to(20), 0.5, 1e-12);
}

TEST(Summaries, OfValuesThatAreKnown) {
  std::vector<MatchResult> matches(4);
  const double errors[] = {1, -2, 3, 2};
  for (std::size_t i = 0; i < 4; ++i) {
    MeasureValue& v = matches[i].values[static_cast<std::size_t>(Measure::eaves_error)];
    v.counted = errors[i];
    v.weight = static_cast<double>(i);
  }
  matches[3].values[static_cast<std::size_t>(Measure::distance_max)].counted = 7;
  const MeasureSummaries s = summarise(matches);
  const Summary& e = s[static_cast<std::size_t>(Measure::eaves_error)].counted;
  EXPECT_EQ(e.count, 4u);
  EXPECT_DOUBLE_EQ(e.mean, 1);
  EXPECT_DOUBLE_EQ(e.mean_abs, 2);
  EXPECT_DOUBLE_EQ(e.rms, std::sqrt(18.0 / 4));
  EXPECT_DOUBLE_EQ(e.median, 1.5);
  EXPECT_DOUBLE_EQ(e.p95_abs, 3);
  EXPECT_DOUBLE_EQ(e.pooled, (-2.0 + 6 + 6) / 6);
  EXPECT_EQ(s[static_cast<std::size_t>(Measure::eaves_error)].all.count, 0u);
  EXPECT_DOUBLE_EQ(s[static_cast<std::size_t>(Measure::distance_max)].counted.pooled, 7);
}

}  // namespace
}  // namespace blockrand::compare
