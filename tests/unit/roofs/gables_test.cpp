#include "styles/roofs/gables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "tests/unit/roofs/drawn_gables.h"
#include "tests/unit/roofs/element_checks.h"
#include "tests/unit/roofs/roof_checks.h"

namespace blockrand::roofs {
namespace {

using model::Point2;
using model::Point3;
using model::Polygon;
using model::RoofElementKind;
using model::RoofShape;
using model::SurfaceKind;
using roof_checks::fault;
using testing_shapes::polygon;
using testing_shapes::Random;

constexpr double kEaves = 10;  // m

Roof roof_on(const Polygon& plan, RoofShape shape, double height) {
  RoofRequest request;
  request.shape = shape;
  request.measures = {kEaves, height};
  return build_roof(plan, request)->roof;
}

/// A narrow house, its front on edge 0, 8 m wide.
const Polygon kHouse = polygon({{0, 0}, {8, 0}, {8, 20}, {0, 20}});

const std::vector<OutlinePoint> kTriangle{{0, 10}, {4, 14}, {8, 10}};  // 45 degrees

// ---- outlines

TEST(GableOutline, StepsOfAPlainGable) {
  const auto outline = gable_outline(kTriangle, 0, 0, {.steps = 4});
  ASSERT_TRUE(outline);
  // Treads of width / (2 levels), risers of a quarter of the gable, the first one lifted by the overtop.
  const std::vector<OutlinePoint> expected{{0, 11.3}, {1, 11.3}, {1, 12.3}, {2, 12.3}, {2, 13.3}, {3, 13.3}, {3, 14.3},
                                           {5, 14.3}, {5, 13.3}, {6, 13.3}, {6, 12.3}, {7, 12.3}, {7, 11.3}, {8, 11.3}};
  ASSERT_EQ(outline->size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR((*outline)[i].along, expected[i].along, 1e-9) << i;
    EXPECT_NEAR((*outline)[i].height, expected[i].height, 1e-9) << i;
  }
}

TEST(GableOutline, CountsOutOfRangeAreNone) {
  EXPECT_FALSE(gable_outline(kTriangle, 0, 0, {.steps = 2}));
  EXPECT_FALSE(gable_outline(kTriangle, 0, 0, {.steps = 6}));
  EXPECT_FALSE(gable_outline(kTriangle, 0, 0, {.form = GableForm::curved, .curves = 0}));
  EXPECT_FALSE(gable_outline(kTriangle, 0, 0, {.form = GableForm::curved, .curves = 3}));
}

TEST(GableOutline, CurvesHaveAsManySegmentsAsAsked) {
  for (const int segments : {4, 9, 16})
    for (const int curves : {1, 2}) {
      const auto outline =
          gable_outline(kTriangle, 0, 0, {.form = GableForm::curved, .curves = curves, .segments = segments});
      ASSERT_TRUE(outline);
      EXPECT_EQ(outline->size(), 2u * (1 + 2 * static_cast<std::size_t>(curves * segments)));
    }
  // Half way through a curve the first of its two Bezier curves ends: upright, half way up.
  const auto outline = gable_outline(kTriangle, 0, 0, {.form = GableForm::curved});
  EXPECT_NEAR((*outline)[9].along, 1, 1e-9);
  EXPECT_NEAR((*outline)[9].height, (12.3 + 14.3) / 2, 1e-9);
  EXPECT_NEAR((*outline)[18].along, 2, 1e-9);
  EXPECT_NEAR((*outline)[18].height, 14.3, 1e-9);
  // t = 4/9 of the first: x = 2 t (1 - t) + t², z = 12.3 + t².
  const double t = 4.0 / 9;
  EXPECT_NEAR((*outline)[4].along, 2 * t * (1 - t) + t * t, 1e-9);
  EXPECT_NEAR((*outline)[4].height, 12.3 + t * t, 1e-9);
}

TEST(GableOutline, OneSidedRoofsHaveOneFlank) {
  const std::vector<OutlinePoint> slope{{0, 10}, {6, 14}};
  const auto outline = gable_outline(slope, 0, 0, {.steps = 3});
  ASSERT_TRUE(outline);
  EXPECT_EQ(outline->size(), 6u);
  EXPECT_NEAR(outline->back().height, 14.3, 1e-9);
}

TEST(GableOutline, SteepRoofsLiftTheFirstLevel) {
  const std::vector<OutlinePoint> mansard{{0, 10}, {0.6, 13}, {4, 14.5}, {7.4, 13}, {8, 10}};
  const auto outline = gable_outline(mansard, 0, 0, {.steps = 5});
  ASSERT_TRUE(outline);
  EXPECT_GE((*outline)[1].along, 0.1);
}

TEST(GableOutline, MiddleStepIsWidestOnFlaredRoofs) {
  // Low at the eaves, steep at the top: by height alone the lowest treads would be the widest.
  const std::vector<OutlinePoint> flared{{0, 10}, {3, 10.6}, {4, 14}, {5, 10.6}, {8, 10}};
  for (int steps = 3; steps <= 5; ++steps) {
    const auto outline = gable_outline(flared, 0, 0, {.steps = steps});
    ASSERT_TRUE(outline);
    const double middle = (*outline)[outline->size() / 2].along - (*outline)[outline->size() / 2 - 1].along;
    EXPECT_GE((*outline)[1].along, 8.0 / (2 * steps - 1) - 1e-9);
    for (std::size_t i = 1; i < outline->size(); i += 2)
      EXPECT_GE(middle, (*outline)[i].along - (*outline)[i - 1].along - 1e-9) << steps;
  }
}

TEST(GableOutline, OvertopsAnySilhouette) {
  Random random(23);
  int built = 0, refused = 0;
  for (int i = 0; i < 3000; ++i) {
    // One top, both flanks rising to it at any rate: mansards, flares, trapezoids, one-sided roofs.
    const double width = 4 + 10 * random.unit(), height = 1 + 8 * random.unit(), peak = width * random.unit();
    std::vector<OutlinePoint> line;
    const int left = 1 + static_cast<int>(random.next(4)), right = 1 + static_cast<int>(random.next(4));
    const auto shares = [&](int count) {
      std::vector<double> out;
      for (int k = 0; k < count; ++k) out.push_back(random.unit());
      std::sort(out.begin(), out.end());
      return out;
    };
    const auto left_at = shares(left), left_up = shares(left), right_at = shares(right), right_up = shares(right);
    line.push_back({0, 10});
    for (int k = 0; k < left; ++k)
      line.push_back({peak * left_at[static_cast<std::size_t>(k)], 10 + height * left_up[static_cast<std::size_t>(k)]});
    line.push_back({peak, 10 + height});
    for (int k = right; k-- > 0;)
      line.push_back({width - (width - peak) * right_at[static_cast<std::size_t>(k)],
                      10 + height * right_up[static_cast<std::size_t>(k)]});
    line.push_back({width, 10});
    const GableOptions options{.form = random.next(2) == 0 ? GableForm::stepped : GableForm::curved,
                               .steps = 3 + static_cast<int>(random.next(3)),
                               .curves = 1 + static_cast<int>(random.next(2))};
    const auto outline = gable_outline(line, 0, 0, options);
    if (!outline) {
      ++refused;
      continue;
    }
    ++built;
    const auto lowest_at = [](std::span<const OutlinePoint> points, double along, bool lowest) {
      double out = lowest ? 1e9 : -1e9;
      for (std::size_t k = 1; k < points.size(); ++k) {
        const OutlinePoint &a = points[k - 1], &b = points[k];
        if (along < a.along || along > b.along) continue;
        const double share = b.along > a.along ? (along - a.along) / (b.along - a.along) : 0;
        const double here = a.height + share * (b.height - a.height);
        const double least = b.along > a.along ? here : std::min(a.height, b.height);
        out = lowest ? std::min(out, least) : std::max(out, here);
      }
      return out;
    };
    for (int k = 0; k <= 200; ++k) {
      const double along = width * k / 200;
      ASSERT_GE(lowest_at(*outline, along, true), lowest_at(line, along, false) + options.overtop - 1e-6)
          << i << " at " << along;
    }
    for (std::size_t k = 1; k < outline->size(); ++k) ASSERT_GE((*outline)[k].along, (*outline)[k - 1].along);
    if (options.form != GableForm::stepped) continue;
    double middle = 0, widest = 0, top = 0;
    std::set<long> levels;
    for (std::size_t k = 1; k < outline->size(); ++k) {
      const OutlinePoint &a = (*outline)[k - 1], &b = (*outline)[k];
      if (a.height != b.height) continue;
      levels.insert(std::lround(a.height * 1000));
      if (a.height > top) top = a.height, middle = b.along - a.along;
      widest = std::max(widest, b.along - a.along);
    }
    ASSERT_EQ(static_cast<int>(levels.size()), options.steps) << i;
    ASSERT_GE(middle, widest - 1e-9) << i;
  }
  std::printf("outlines on random silhouettes: %d built, %d refused\n", built, refused);
  EXPECT_GT(built, 1000);
}

TEST(RoofSilhouette, HalfHipShowsItsRidge) {
  const Roof roof = roof_on(kHouse, RoofShape::half_hipped, 4);
  const auto edges = plan_edges(kHouse);
  const auto seen = roof_silhouette(roof, edges[0], 8);
  double top = 0;
  for (const auto& p : seen) top = std::max(top, p.height);
  EXPECT_NEAR(top, kEaves + 4, 0.002);
  EXPECT_EQ(seen.size(), 3u);  // eaves, ridge, eaves
  // Only 0.5 m deep, the slanting end is all there is.
  const auto near_wall = roof_silhouette(roof, edges[0], 0.5);
  for (const auto& p : near_wall) EXPECT_LT(p.height, kEaves + 3.5);
}

// ---- bodies

TEST(Gables, SteppedWallOnAPlainGable) {
  const Roof roof = roof_on(kHouse, RoofShape::gabled, 4);
  const auto built = ornamental_gable(kHouse, roof, 0, {.steps = 4, .thickness = 0.3});
  ASSERT_TRUE(built.body);
  EXPECT_EQ(built.body->kind, RoofElementKind::gable);
  EXPECT_EQ(fault(masses::envelope(kHouse, 0, roof, {}), {*built.body}), "");
  // The outline's area above the eaves without the roof's triangle.
  const double area = 2 * (1.3 + 2.3 + 3.3) + 2 * 4.3 - 16;
  EXPECT_NEAR(roof_checks::volume(built.body->solid), area * 0.3, 0.01);
  EXPECT_NEAR(roof_checks::area(built.body->solid, SurfaceKind::closure), 8 * std::sqrt(2) * 0.3, 0.01);
}

TEST(Gables, AtticsAreLevelWithOrWithoutAPediment) {
  const Roof roof = roof_on(kHouse, RoofShape::hipped, 4);
  GableOptions options{.form = GableForm::attic, .attic_height = 1};
  const auto level = ornamental_gable(kHouse, roof, 0, options);
  ASSERT_TRUE(level.body);
  EXPECT_EQ(fault(masses::envelope(kHouse, 0, roof, {}), {*level.body}), "");
  EXPECT_EQ(level.outline, (std::vector<OutlinePoint>{{0, 11}, {8, 11}}));
  options.pediment = 0.5;
  const auto crowned = ornamental_gable(kHouse, roof, 0, options);
  ASSERT_TRUE(crowned.body);
  EXPECT_EQ(fault(masses::envelope(kHouse, 0, roof, {}), {*crowned.body}), "");
  EXPECT_NEAR(roof_checks::volume(crowned.body->solid) - roof_checks::volume(level.body->solid), 4 * 0.8 / 2 * 0.3,
              0.01);
}

TEST(Gables, NoRoomWhereThePlanBends) {
  // The wall's back would lie in the open 0.2 m behind the front.
  const Polygon plan = polygon({{0, 0}, {8, 0}, {8, 0.2}, {6, 0.2}, {6, 20}, {0, 20}});
  const Roof roof = roof_on(plan, RoofShape::gabled, 4);
  EXPECT_EQ(ornamental_gable(plan, roof, 0, {}).refusal, GableRefusal::no_room);
}

TEST(Gables, OnSharpCornersTheBackIsShorter) {
  const Polygon plan = polygon({{0, 0}, {9, 0}, {7, 20}, {2, 20}});
  const Roof roof = roof_on(plan, RoofShape::gabled, 5);
  for (const GableForm form : {GableForm::stepped, GableForm::curved}) {
    const auto built = ornamental_gable(plan, roof, 0, {.form = form});
    ASSERT_TRUE(built.body) << name(form);
    EXPECT_EQ(fault(masses::envelope(plan, 0, roof, {}), {*built.body}), "") << name(form);
  }
}

// ---- which gable

TEST(GableRules, WhatMayStandBeforeWhat) {
  for (const RoofShape roof : {RoofShape::gabled, RoofShape::half_hipped, RoofShape::mansard}) {
    EXPECT_TRUE(may_stand_before(GableForm::stepped, roof));
    EXPECT_TRUE(may_stand_before(GableForm::curved, roof));
    EXPECT_FALSE(may_stand_before(GableForm::attic, roof));
  }
  for (const RoofShape roof : {RoofShape::hipped, RoofShape::flat}) {
    EXPECT_FALSE(may_stand_before(GableForm::stepped, roof));
    EXPECT_FALSE(may_stand_before(GableForm::curved, roof));
    EXPECT_TRUE(may_stand_before(GableForm::attic, roof));
  }
  EXPECT_FALSE(draw_gable(1, 1, RoofShape::dome));
}

TEST(GableRules, DrawsAreKeyedByTheObject) {
  const auto same = [](const DrawnGable& a, const DrawnGable& b) {
    return a.roof == b.roof && a.gable.form == b.gable.form && a.gable.steps == b.gable.steps &&
           a.gable.curves == b.gable.curves && a.gable.pediment == b.gable.pediment;
  };
  int other = 0;
  for (std::uint64_t id = 0; id < 100; ++id) {
    EXPECT_TRUE(same(draw_gable_house(5, id), draw_gable_house(5, id)));
    other += !same(draw_gable_house(5, id), draw_gable_house(6, id));
  }
  EXPECT_GT(other, 50);
}

// ---- the oracle: a finished house as it is seen from the street

/// Highest point of triangles over a place of the plan; lower than all where there are none.
double top_at(const std::vector<std::array<Point3, 3>>& triangles, Point2 p) {
  double most = -1e9;
  for (const auto& [a, b, c] : triangles) {
    const double det = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (std::fabs(det) < 1e-9) continue;
    const double u = ((p.x - a.x) * (c.y - a.y) - (p.y - a.y) * (c.x - a.x)) / det,
                 v = ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / det;
    if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9) continue;
    most = std::max(most, a.z + u * (b.z - a.z) + v * (c.z - a.z));
  }
  return most;
}

std::vector<std::array<Point3, 3>> triangles_of(const model::Solid& solid) {
  std::vector<std::array<Point3, 3>> out;
  const auto triangles = geometry::triangulate(solid);
  if (!triangles) return out;
  for (const auto& [i, j, k] : triangles->triangles)
    out.push_back({solid.vertices[i], solid.vertices[j], solid.vertices[k]});
  return out;
}

/// A gable measured on its solid.
struct Seen {
  std::set<long> levels;       ///< heights of level treads, mm
  std::vector<double> treads;  ///< m, their widths, from one end of the front to the other
  std::size_t slanting = 0;    ///< facets that are neither level nor upright
  int inflections = 0;         ///< where the outline is steepest: one for each curve, both flanks
  double least_overtop = 1e9;  ///< m above all of the roof behind
};

Seen look(const model::Solid& gable, const model::Solid& house, const PlanEdge& front, double thickness) {
  Seen out;
  struct Facet {
    double start, end, rise;
  };
  std::vector<Facet> facets;
  const auto along = [&](const Point3& p) {
    return (p.x - front.from.x) * front.along.x + (p.y - front.from.y) * front.along.y;
  };
  for (const model::Face& face : gable.faces) {
    if (face.kind != SurfaceKind::roof) continue;
    double start = 1e9, end = -1e9, low = 1e9, high = -1e9;
    for (const std::uint32_t v : gable.indices_of(gable.loops_of(face)[0])) {
      const Point3& p = gable.vertices[v];
      // The front's corners alone: ends may be oblique.
      if ((p.x - front.from.x) * front.inward().x + (p.y - front.from.y) * front.inward().y > thickness / 2) continue;
      start = std::min(start, along(p));
      end = std::max(end, along(p));
      low = std::min(low, p.z);
      high = std::max(high, p.z);
    }
    facets.push_back({start, end, high - low});
  }
  std::sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) { return a.start < b.start; });
  for (const model::Face& face : gable.faces) {
    if (face.kind != SurfaceKind::roof) continue;
    double low = 1e9, high = -1e9;
    for (const std::uint32_t v : gable.indices_of(gable.loops_of(face)[0])) {
      low = std::min(low, gable.vertices[v].z);
      high = std::max(high, gable.vertices[v].z);
    }
    if (high - low < 0.001) out.levels.insert(std::lround(high * 1000));
  }
  std::vector<double> slopes;
  for (const Facet& f : facets) {
    if (f.rise < 0.001)
      out.treads.push_back(f.end - f.start);
    else
      ++out.slanting;
    slopes.push_back(f.rise / std::max(1e-4, f.end - f.start));
  }
  for (std::size_t i = 1; i + 1 < slopes.size(); ++i) {
    // The two steepest facets lie side by side, both where the curves meet.
    const bool rising = slopes[i] > 2 && slopes[i] >= slopes[i - 1] && slopes[i] >= slopes[i + 1];
    const bool first = slopes[i - 1] <= 2 || slopes[i - 1] < slopes[i];
    out.inflections += rising && first && !(i >= 2 && slopes[i - 2] > slopes[i]);
  }
  const auto wall = triangles_of(gable), roof = triangles_of(house);
  constexpr int kAlong = 64;
  constexpr double kDeep = 0.25;  // m
  for (int i = 1; i < kAlong; ++i) {
    const double s = front.length * i / kAlong;
    const auto at = [&](double deep) {
      return Point2{front.from.x + front.along.x * s + front.inward().x * deep,
                    front.from.y + front.along.y * s + front.inward().y * deep};
    };
    const double gable_top = top_at(wall, at(thickness / 2));
    for (double deep = 0.02; deep < front.length; deep += kDeep)
      out.least_overtop = std::min(out.least_overtop, gable_top - top_at(roof, at(deep)));
  }
  return out;
}

TEST(GableRules, HoldOnGeneratedHouses) {
  constexpr std::uint64_t kHouses = 1200, kSeed = 11;
  std::map<RoofShape, int> roofs;
  std::map<GableForm, int> forms;
  std::map<int, int> steps, curves;
  int built_count = 0, refused = 0, pediments = 0;
  for (std::uint64_t id = 0; id < kHouses; ++id) {
    Random random(1000 + id);
    const double width = 5 + 7 * random.unit(), depth = width * (1.3 + 1.5 * random.unit());
    const double pitch = (45 + 15 * random.unit()) * M_PI / 180;
    const double skew = (random.unit() - 0.5) * 0.6;  // m: lots are not quite square
    const Polygon plan =
        roof_checks::moved(polygon({{0, 0}, {width, skew}, {width + skew, depth}, {-skew, depth + 2 * skew}}),
                           360 * random.unit(), roof_checks::kPlaces[random.next(3)]);
    const DrawnGable drawn = draw_gable_house(kSeed, id);
    ++roofs[drawn.roof];
    ++forms[drawn.gable.form];
    ASSERT_EQ(drawn.roof == RoofShape::hipped, drawn.gable.form == GableForm::attic);
    const Roof roof = roof_on(plan, drawn.roof, width / 2 * std::tan(pitch));
    const model::Solid house = masses::envelope(plan, 0, roof, {});
    const auto built = ornamental_gable(plan, roof, 0, drawn.gable);
    if (!built.body) {
      if (std::getenv("BLOCKRAND_ROOF_CASES"))
        std::printf("%s before %s, %d steps, %d curves, width %.1f: refusal %d\n",
                    std::string(name(drawn.gable.form)).c_str(), std::string(model::name(drawn.roof)).c_str(),
                    drawn.gable.steps, drawn.gable.curves, width, static_cast<int>(built.refusal));
      ++refused;
      continue;
    }
    ++built_count;
    ASSERT_EQ(fault(house, {*built.body}), "") << id;
    const PlanEdge front = plan_edges(plan)[0];
    const Seen seen = look(built.body->solid, house, front, drawn.gable.thickness);
    if (drawn.gable.form == GableForm::attic) {
      ASSERT_EQ(seen.levels.size(), 1u);
      ASSERT_EQ(seen.slanting, drawn.gable.pediment > 0 ? 2u : 0u);
      pediments += drawn.gable.pediment > 0;
      continue;
    }
    // Overtops the roof everywhere, so that half-hips and mansards are hidden (3 mm for the rounding of both).
    ASSERT_GE(seen.least_overtop, drawn.gable.overtop - 0.003) << id << ' ' << model::name(drawn.roof);
    if (drawn.gable.form == GableForm::stepped) {
      const int levels = static_cast<int>(seen.levels.size());
      ASSERT_GE(levels, 3);
      ASSERT_LE(levels, 5);
      ASSERT_EQ(levels, drawn.gable.steps);
      ASSERT_EQ(seen.slanting, 0u);
      ASSERT_EQ(seen.treads.size(), 2u * static_cast<std::size_t>(levels) - 1);
      const double middle = seen.treads[seen.treads.size() / 2];
      for (const double t : seen.treads) ASSERT_GE(middle, t - 0.002) << id;
      ++steps[levels];
    } else {
      ASSERT_EQ(seen.slanting, 2u * 2 * 9 * static_cast<std::size_t>(drawn.gable.curves)) << id;
      ASSERT_EQ(seen.inflections, 2 * drawn.gable.curves) << id;
      ++curves[drawn.gable.curves];
    }
  }
  std::printf(
      "gable houses: %d built, %d refused; stepped %d, curved %d, attic %d (%d with pediment); gabled %d, half-hipped "
      "%d, mansard %d, hipped %d\n",
      built_count, refused, forms[GableForm::stepped], forms[GableForm::curved], forms[GableForm::attic], pediments,
      roofs[RoofShape::gabled], roofs[RoofShape::half_hipped], roofs[RoofShape::mansard], roofs[RoofShape::hipped]);
  EXPECT_GE(built_count, 1000);
  EXPECT_GT(roofs[RoofShape::gabled], roofs[RoofShape::half_hipped]);
  EXPECT_GT(roofs[RoofShape::gabled], roofs[RoofShape::mansard]);
  // Half of the roofs behind stepped and curved gables, to three standard deviations.
  const double gables = static_cast<double>(kHouses - static_cast<std::uint64_t>(roofs[RoofShape::hipped]));
  EXPECT_NEAR(roofs[RoofShape::gabled] / gables, 0.5, 3 * 0.5 / std::sqrt(gables));
  EXPECT_EQ(steps.size(), 3u);
  EXPECT_EQ(curves.size(), 2u);
  EXPECT_GT(pediments, 0);
}

class GablesOn : public testing::TestWithParam<RoofShape> {};

TEST_P(GablesOn, EveryEdgeOfEveryPlanIsValidOrRefused) {
  int asked = 0, built_count = 0;
  for (const auto& [name, plan] : roof_checks::plans())
    for (const double angle : {0.0, 33.0}) {
      const Polygon place = roof_checks::moved(plan, angle, angle == 0 ? Point2{} : Point2{395000.123, 5818000.456});
      const Roof roof = roof_on(place, GetParam(), 4);
      const model::Solid house = masses::envelope(place, 0, roof, {});
      if (roof_checks::validity(house) != "none" || roof.wall_tops.size() > 30) continue;
      for (std::uint32_t edge = 0; edge < roof.wall_tops.size(); ++edge)
        for (const GableForm form : {GableForm::stepped, GableForm::curved, GableForm::attic}) {
          ++asked;
          const auto built = ornamental_gable(place, roof, edge, {.form = form});
          if (!built.body) continue;
          ++built_count;
          ASSERT_EQ(fault(house, {*built.body}), "") << name << " edge " << edge << ' ' << roofs::name(form);
        }
    }
  std::printf("%s: gables %d of %d\n", std::string(model::name(GetParam())).c_str(), built_count, asked);
  EXPECT_GT(built_count, 0);
}

INSTANTIATE_TEST_SUITE_P(Shapes, GablesOn,
                         testing::Values(RoofShape::flat, RoofShape::gabled, RoofShape::hipped, RoofShape::mansard,
                                         RoofShape::gambrel, RoofShape::half_hipped, RoofShape::skillion,
                                         RoofShape::double_saltbox, RoofShape::round),
                         [](const auto& info) {
                           std::string name(model::name(info.param));
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace blockrand::roofs
