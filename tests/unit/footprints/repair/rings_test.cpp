#include "pipeline/footprints/repair/rings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>

#include "pipeline/base/portable_math.h"
#include "pipeline/footprints/repair/clean_ring.h"
#include "pipeline/geometry/even_odd.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::repair {
namespace {

using model::IssueCode;
using model::Point2;
using model::Polygon;
using model::Ring;
using testing_shapes::Random;
using testing_shapes::ring;

constexpr model::OsmId kId{model::OsmType::way, 1};

double area_of(const std::vector<Polygon>& polygons) {
  double sum = 0;
  for (const Polygon& p : polygons) sum += geometry::area(p);
  return sum;
}

std::string codes(const model::Report& report) {
  std::set<std::string> found;
  for (const auto& row : report.rows) found.emplace(model::info(row.code).text);
  std::string out;
  for (const auto& code : found) out += (out.empty() ? "" : " ") + code;
  return out;
}

void expect_sound(const RepairedRings& r) {
  for (const Polygon& p : r.polygons) {
    EXPECT_TRUE(geometry::strictly_simple(p));
    EXPECT_GT(geometry::signed_area(p.outer.points), 0);
    EXPECT_EQ(p.outer.points.size(), p.outer.nodes.size());
    for (const Ring& hole : p.holes) {
      EXPECT_LT(geometry::signed_area(hole.points), 0);
      EXPECT_EQ(hole.points.size(), hole.nodes.size());
    }
  }
  EXPECT_EQ(r.polygons.empty(), r.failure != IssueCode::none);
  for (std::size_t i = 0; i < r.polygons.size(); ++i)
    for (std::size_t j = i + 1; j < r.polygons.size(); ++j)
      EXPECT_LT(geometry::common_area(std::vector{r.polygons[i]}, std::vector{r.polygons[j]}), 1e-6);
}

// ---- named cases ----------------------------------------------------------------------------------------------------

struct Case {
  std::string name, codes, failure;
  model::MappedRings rings;
  std::vector<std::int64_t> kept;
  double area = -1, tolerance = 0;
  int pieces = -1, points = -1;
};

std::vector<Point2> shape(const std::string& kind, int n, double radius) {
  std::vector<Point2> out;
  if (kind == "circle") {
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * base::kPi * i / n;
      out.push_back({radius * base::cos(angle), radius * base::sin(angle)});
    }
  } else if (kind == "zigzag") {  // a comb: teeth side by side
    for (int i = 0; i < n - 2; ++i) out.push_back({i * 0.5, i % 2 == 0 ? 2.0 : 40.0});
    out.push_back({(n - 3) * 0.5 + 1, 0});
    out.push_back({-1, 0});
  } else if (kind == "stairs") {  // long teeth above each other, turned: boxes overlap whatever axis is swept
    for (int i = 0; i < n - 2; ++i) {
      const double u = i % 2 == 0 ? 2 : 400, v = i * 0.5;
      out.push_back({0.8 * u - 0.6 * v, 0.6 * u + 0.8 * v});
    }
    const double top = (n - 3) * 0.5 + 1;
    out.push_back({-0.6 * top, 0.8 * top});
    out.push_back({0.6, -0.8});
  } else {  // straight
    for (int i = 0; i < n - 3; ++i) out.push_back({i * 2000.0 / (n - 4), 0});
    out.push_back({2000, 10});
    out.push_back({0, 10});
    out.push_back({0, 5});
  }
  for (Point2& p : out) p = model::snap(p);
  return out;
}

std::vector<Point2> points_of(const std::string& text) {
  std::vector<Point2> out;
  std::istringstream in(text);
  if (std::string kind; std::isalpha(static_cast<unsigned char>(text[0]))) {
    int n = 0;
    double radius = 0;
    in >> kind >> n >> radius;
    return shape(kind, n, radius);
  }
  std::string pair;
  while (std::getline(in, pair, ',')) {
    std::istringstream numbers(pair);
    Point2 p;
    if (!(numbers >> p.x >> p.y)) ADD_FAILURE() << "no point: " << pair;
    out.push_back(model::snap(p));
  }
  return out;
}

std::vector<Case> read_cases() {
  std::ifstream file(std::string(BLOCKRAND_SOURCE_DIR) + "/tests/unit/footprints/repair/rings.txt");
  EXPECT_TRUE(file.is_open());
  std::vector<Case> out;
  std::string line;
  std::int64_t node = 0;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    const auto space = line.find(' ');
    const std::string key = line.substr(0, space), rest = space == std::string::npos ? "" : line.substr(space + 1);
    std::istringstream in(rest);
    if (key == "case") {
      out.push_back({});
      out.back().name = rest;
      node = 0;
    } else if (key == "outer" || key == "inner") {
      Ring r = ring(points_of(rest));
      for (auto& n : r.nodes) n = ++node;
      out.back().rings.rings.push_back(std::move(r));
      out.back().rings.inner.push_back(key == "inner");
    } else if (key == "kept") {
      for (std::int64_t n; in >> n;) out.back().kept.push_back(n);
    } else if (key == "area") {
      in >> out.back().area >> out.back().tolerance;
    } else if (key == "pieces") {
      in >> out.back().pieces;
    } else if (key == "points") {
      in >> out.back().points;
    } else if (key == "codes") {
      out.back().codes = rest;
    } else if (key == "failure") {
      out.back().failure = rest;
    } else {
      ADD_FAILURE() << "unknown line: " << line;
    }
  }
  return out;
}

TEST(Rings, NamedDegenerateCases) {
  const auto cases = read_cases();
  EXPECT_GE(cases.size(), 50u);
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    model::Report report;
    const RepairedRings r = repair_rings(c.rings, kId, KeptNodes(c.kept), {}, report);
    expect_sound(r);
    EXPECT_EQ(codes(report), c.codes);
    if (!c.failure.empty()) {
      EXPECT_EQ(model::info(r.failure).text, c.failure);
      continue;
    }
    if (c.area >= 0) {
      EXPECT_NEAR(area_of(r.polygons), c.area, c.tolerance + 1e-9);
    }
    if (c.pieces >= 0) {
      EXPECT_EQ(static_cast<int>(r.polygons.size()), c.pieces);
    }
    int points = 0;
    std::set<std::int64_t> nodes;
    for (const Polygon& p : r.polygons) {
      points += static_cast<int>(p.outer.size());
      nodes.insert(p.outer.nodes.begin(), p.outer.nodes.end());
      for (const Ring& hole : p.holes) points += static_cast<int>(hole.size());
    }
    if (c.points >= 0) {
      EXPECT_EQ(points, c.points);
    }
    for (const std::int64_t n : c.kept) EXPECT_TRUE(nodes.contains(n)) << "node " << n;
  }
}

// ---- rows -----------------------------------------------------------------------------------------------------------

model::MappedRings one(std::vector<Point2> points) { return {{ring(std::move(points))}, {false}}; }

std::string detail(const model::Report& report, IssueCode code) {
  for (const auto& row : report.rows)
    if (row.code == code) return row.detail;
  return "-";
}

TEST(Rings, BothLoopsOfAFigureEightCountAsMapped) {
  model::Report report;
  const auto r = repair_rings(one({{0, 0}, {10, 8}, {10, 0}, {0, 8}}), kId, {}, {}, report);
  EXPECT_NEAR(r.mapped_area, 40, 1e-6);
  EXPECT_EQ(detail(report, IssueCode::ring_repaired), "40.00 m2 to 40.00 m2");
}

TEST(Rings, AGreatChangeOfAreaIsBuiltAndNamed) {
  // The ring winds twice around a court: even-odd leaves it out, the repair does not.
  model::Report report;
  const auto r =
      repair_rings(one({{0, 0}, {12, 0}, {12, 10}, {2, 10}, {2, 2}, {10, 2}, {10, 12}, {0, 12}}), kId, {}, {}, report);
  EXPECT_GT(area_of(r.polygons), r.mapped_area * 1.1);
  EXPECT_NE(detail(report, IssueCode::ring_repaired).find("; changed by "), std::string::npos);
}

TEST(Rings, TheRowSaysHowMuch) {
  model::Report report;
  repair_rings(one({{0, 0}, {0, 0}, {5, 0}, {10, 0}, {10, 8}, {4.01, 8}, {4, 20}, {4, 8}, {0, 8}}), kId, {}, {},
               report);
  EXPECT_EQ(detail(report, IssueCode::duplicate_points), "1 point");
  EXPECT_EQ(detail(report, IssueCode::spike_removed), "1 spike");
  EXPECT_EQ(detail(report, IssueCode::collinear_points), "3 points");
}

TEST(Rings, SimplificationCanBeSwitchedOff) {
  RepairOptions options;
  options.simplify = false;
  model::Report report;
  const auto r = repair_rings(one({{0, 0}, {5, 0}, {10, 0}, {10, 8}, {0, 8}}), kId, {}, options, report);
  EXPECT_EQ(r.polygons[0].outer.size(), 5u);
  EXPECT_TRUE(report.rows.empty());
}

TEST(Rings, SimplificationNeverMakesARingCrossItself) {
  // A dent of 15 mm in the wall, and a court whose corner lies in the dent: without the dent they would cross.
  model::MappedRings rings{
      {ring({{0, 0}, {5, -0.015625}, {10, 0}, {10, 8}, {0, 8}}), ring({{5, -0.0078125}, {6, 4}, {4, 4}})},
      {false, true}};
  model::Report report;
  const auto r = repair_rings(rings, kId, {}, {}, report);
  expect_sound(r);
  ASSERT_EQ(r.polygons.size(), 1u);
  EXPECT_EQ(r.polygons[0].outer.size(), 5u);
  EXPECT_EQ(r.polygons[0].holes.size(), 1u);
}

TEST(Rings, SurvivingPointsKeepTheirNodes) {
  Ring outer = ring({{0, 0}, {20, 0}, {20, 10}, {0, 10}}), hole = ring({{5, 0}, {9, 0}, {9, 4}, {5, 4}});
  outer.nodes = {1, 2, 3, 4};
  hole.nodes = {5, 6, 7, 8};
  model::Report report;
  const auto r = repair_rings({{outer, hole}, {false, true}}, kId, {}, {}, report);
  ASSERT_EQ(r.polygons.size(), 1u);
  std::multiset<std::int64_t> nodes(r.polygons[0].outer.nodes.begin(), r.polygons[0].outer.nodes.end());
  EXPECT_EQ(nodes, (std::multiset<std::int64_t>{1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(Rings, OfTwoPointsInOnePlaceTheKeptNodeStays) {
  Ring r = ring({{0, 0}, {10, 0}, {10, 0.001}, {10, 8}, {0, 8}});
  r.nodes = {1, 2, 3, 4, 5};
  clean_ring(r, KeptNodes(std::vector<std::int64_t>{3}), {});
  EXPECT_EQ(std::count(r.nodes.begin(), r.nodes.end(), 3), 1);
  EXPECT_EQ(std::count(r.nodes.begin(), r.nodes.end(), 2), 0);
}

TEST(Rings, WhereASpikesEndsMeetTheKeptNodeStays) {
  // The spike leaves the wall at one node and comes back to another one in the same place.
  for (const std::int64_t kept : {3, 5}) {
    SCOPED_TRACE(kept);
    Ring r = ring({{0, 0}, {10, 0}, {10, 4}, {18, 4}, {10, 4}, {10, 8}, {0, 8}});
    r.nodes = {1, 2, 3, 4, 5, 6, 7};
    const RingCleaning done = clean_ring(r, KeptNodes(std::vector<std::int64_t>{kept}), {});
    EXPECT_EQ(done.spikes, 1);
    EXPECT_EQ(done.duplicates, 1);
    EXPECT_EQ(r.size(), 5u);
    EXPECT_EQ(std::count(r.nodes.begin(), r.nodes.end(), kept), 1);
  }
}

TEST(Rings, ARoundedBayKeepsItsPoints) {
  // A half circle of radius 4 m in steps of 5 degrees: sagittas of 4 mm, far below what a straight wall may lose.
  std::vector<Point2> points{{-4, 10}, {-10, 10}, {-10, 0}, {10, 0}, {10, 10}, {4, 10}};
  for (int degrees = 5; degrees < 180; degrees += 5) {
    const double angle = degrees * base::kRadiansPerDegree;
    points.push_back(model::snap(Point2{4 * base::cos(angle), 10 + 4 * base::sin(angle)}));
  }
  const auto n = points.size();
  model::Report report;
  const auto r = repair_rings(one(points), kId, {}, {}, report);
  EXPECT_EQ(r.polygons[0].outer.size(), n);
}

// ---- scribbles ------------------------------------------------------------------------------------------------------

// These took minutes or did not end: the work must be bounded by crossings. What counts here is which way is taken and
// what comes out; a test that ends has its bound.

TEST(Rings, AStarOf81PointsIsItsOutline) {
  std::vector<Point2> points;
  for (int i = 0; i < 81; ++i) {
    const double angle = 2 * base::kPi * (i * 40 % 81) / 81;
    points.push_back(model::snap(Point2{50 * base::cos(angle), 50 * base::sin(angle)}));
  }
  ASSERT_TRUE(geometry::tangled(ring(points)));
  model::Report report;
  const auto r = repair_rings(one(points), kId, {}, {}, report);
  expect_sound(r);
  ASSERT_EQ(r.polygons.size(), 1u);
  EXPECT_EQ(r.polygons[0].outer.size(), 162u);
  EXPECT_NEAR(area_of(r.polygons), 2618.66, 0.5);  // of the regular star polygon {81/40}
  EXPECT_NE(detail(report, IssueCode::ring_repaired).find("crosses itself everywhere"), std::string::npos);
}

TEST(Rings, AScribbleOf150PointsIsItsLargestPieces) {
  Random random(17);
  std::vector<Point2> points;
  for (int i = 0; i < 150; ++i) {
    const double x = 100 * random.unit();
    points.push_back(model::snap(Point2{x, 100 * random.unit()}));
  }
  ASSERT_TRUE(geometry::tangled(ring(points)));
  auto turned = points;
  std::rotate(turned.begin(), turned.begin() + 70, turned.end());
  model::Report first, second;
  const auto r = repair_rings(one(points), kId, {}, {}, first);
  expect_sound(r);
  EXPECT_GT(area_of(r.polygons), 1000);
  EXPECT_LE(r.polygons.size(), 32u);
  EXPECT_NEAR(r.mapped_area, 5000, 1000) << "half of the square, by the even-odd rule";
  const auto again = repair_rings(one(turned), kId, {}, {}, second);
  ASSERT_EQ(again.polygons.size(), r.polygons.size());
  for (std::size_t i = 0; i < r.polygons.size(); ++i)
    EXPECT_EQ(again.polygons[i].outer.points, r.polygons[i].outer.points);
  EXPECT_EQ(first.rows, second.rows);
}

TEST(Rings, AScribbleOf3000PointsIsItsConvexHull) {
  // It crosses itself a million times: nobody waits for the pieces.
  Random random(17);
  std::vector<Point2> points{{-10, -10}};
  for (int i = 0; i < 3000; ++i) {
    const double x = 100 * random.unit();
    points.push_back(model::snap(Point2{x, 100 * random.unit()}));
  }
  ASSERT_TRUE(geometry::hopeless(ring(points)));
  model::Report report;
  const auto r = repair_rings(one(points), kId, {}, {}, report);
  expect_sound(r);
  ASSERT_EQ(r.polygons.size(), 1u);
  EXPECT_EQ(r.polygons[0].outer.points[0], (Point2{-10, -10}));
  for (const Point2 p : points)
    EXPECT_TRUE(geometry::contains(r.polygons[0], p) ||
                std::any_of(r.polygons[0].outer.points.begin(), r.polygons[0].outer.points.end(),
                            [&](Point2 q) { return q == p; }));
  EXPECT_NE(detail(report, IssueCode::ring_repaired).find("its convex hull"), std::string::npos);
}

TEST(WellWound, CourtsRunClockwise) {
  Polygon p{ring({{0, 0}, {10, 0}, {10, 10}, {0, 10}}), {ring({{2, 2}, {2, 4}, {4, 4}, {4, 2}})}};
  EXPECT_TRUE(well_wound(p));
  geometry::orient(p.holes[0], true);
  EXPECT_TRUE(geometry::strictly_simple(p)) << "which does not see it";
  EXPECT_FALSE(well_wound(p));
  geometry::orient(p.holes[0], false);
  geometry::orient(p.outer, false);
  EXPECT_FALSE(well_wound(p));
}

// ---- properties -----------------------------------------------------------------------------------------------------

/// A star-shaped ring with noise on its points, then with slips of the mouse.
std::vector<Point2> noisy_ring(Random& random, int slips) {
  const int n = 4 + static_cast<int>(random.next(20));
  std::vector<Point2> out;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * base::kPi * (i + 0.8 * random.unit()) / n, radius = 3 + 12 * random.unit();
    out.push_back({radius * base::cos(angle), radius * base::sin(angle)});
    for (auto k = random.next(3); k > 0; --k)
      out.push_back({out.back().x + 0.1 * random.unit(), out.back().y + 0.1 * random.unit()});
  }
  for (int s = 0; s < slips; ++s) {
    const std::size_t i = random.next(out.size()), j = random.next(out.size());
    switch (random.next(4)) {
      case 0:
        std::swap(out[i], out[j]);
        break;
      case 1:
        out.insert(out.begin() + static_cast<std::ptrdiff_t>(i), out[j]);
        break;
      case 2:
        out[i] = {30 * random.unit() - 15, 30 * random.unit() - 15};
        break;
      default:
        out.insert(out.begin() + static_cast<std::ptrdiff_t>(i), out[i]);
    }
  }
  for (Point2& p : out) p = model::snap(Point2{391000.5 + p.x, 5819000.25 + p.y});
  return out;
}

TEST(Rings, WhateverComesInValidPolygonsComeOut) {
  Random random(11);
  for (int round = 0; round < 1000; ++round) {
    SCOPED_TRACE(round);
    model::MappedRings rings = one(noisy_ring(random, static_cast<int>(random.next(6))));
    for (auto more = random.next(3); more > 0; --more) {
      rings.rings.push_back(ring(noisy_ring(random, static_cast<int>(random.next(3)))));
      rings.inner.push_back(random.next(2) == 0);
    }
    model::Report report;
    const auto r = repair_rings(rings, kId, {}, {}, report);
    expect_sound(r);
    EXPECT_FALSE(r.polygons.empty());
    if (HasFailure()) break;
  }
}

TEST(Rings, NothingDependsOnWhereARingStarts) {
  Random random(12);
  int repaired = 0;
  for (int round = 0; round < 1000; ++round) {
    SCOPED_TRACE(round);
    const auto points = noisy_ring(random, static_cast<int>(random.next(4)));
    model::Report first, second;
    const auto a = repair_rings(one(points), kId, {}, {}, first);
    auto turned = points;
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(random.next(turned.size())), turned.end());
    const auto b = repair_rings(one(turned), kId, {}, {}, second);
    ASSERT_EQ(a.polygons.size(), b.polygons.size());
    for (std::size_t i = 0; i < a.polygons.size(); ++i) {
      ASSERT_EQ(a.polygons[i].outer.points, b.polygons[i].outer.points);
      ASSERT_EQ(a.polygons[i].holes.size(), b.polygons[i].holes.size());
      for (std::size_t h = 0; h < a.polygons[i].holes.size(); ++h)
        ASSERT_EQ(a.polygons[i].holes[h].points, b.polygons[i].holes[h].points);
    }
    EXPECT_EQ(first.rows, second.rows);
    repaired += detail(first, IssueCode::ring_repaired) != "-";
  }
  EXPECT_GT(repaired, 100) << "the test must see mended rings";
}

TEST(Rings, NothingDependsOnTheOrderOfRings) {
  Random random(14);
  int united = 0;
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    // Two outer rings, each with two holes somewhere.
    std::vector<Ring> rings;
    for (int i = 0; i < 6; ++i) rings.push_back(ring(noisy_ring(random, i % 3 == 0 ? 1 : 0)));
    for (const int hole : {1, 2, 4, 5})
      for (Point2& p : rings[static_cast<std::size_t>(hole)].points)
        p = model::snap(Point2{391000.5 + (p.x - 391000.5) / 3, 5819000.25 + (p.y - 5819000.25) / 3});
    model::MappedRings first{rings, {false, true, true, false, true, true}};
    model::MappedRings second{{rings[3], rings[5], rings[4], rings[0], rings[2], rings[1]}, first.inner};
    model::Report a_rows, b_rows;
    const auto a = repair_rings(first, kId, {}, {}, a_rows), b = repair_rings(second, kId, {}, {}, b_rows);
    ASSERT_EQ(a.polygons.size(), b.polygons.size());
    for (std::size_t i = 0; i < a.polygons.size(); ++i) {
      ASSERT_EQ(a.polygons[i].outer.points, b.polygons[i].outer.points);
      ASSERT_EQ(a.polygons[i].holes.size(), b.polygons[i].holes.size());
      for (std::size_t h = 0; h < a.polygons[i].holes.size(); ++h)
        ASSERT_EQ(a.polygons[i].holes[h].points, b.polygons[i].holes[h].points);
    }
    EXPECT_EQ(a_rows.rows, b_rows.rows);
    united += detail(a_rows, IssueCode::ring_repaired).find("united") != std::string::npos;
  }
  EXPECT_GT(united, 100);
}

TEST(Rings, TurningTheMapTurnsTheResult) {
  Random random(15);
  constexpr double c = 0.7986355100472928, s = 0.6018150231520483;  // 37 degrees
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const auto points = noisy_ring(random, static_cast<int>(random.next(3)));
    auto turned = points;
    for (Point2& p : turned) {
      const double x = p.x - 391000.5, y = p.y - 5819000.25;
      p = model::snap(Point2{391000.5 + c * x - s * y, 5819000.25 + s * x + c * y});
    }
    model::Report first, second;
    const auto a = repair_rings(one(points), kId, {}, {}, first), b = repair_rings(one(turned), kId, {}, {}, second);
    // Rounding may decide about a crossing of a millimetre or a point at the limit; not about more.
    EXPECT_NEAR(area_of(a.polygons), area_of(b.polygons), 0.6);
    EXPECT_NEAR(a.mapped_area, b.mapped_area, 0.6);
  }
}

TEST(Rings, SoundRingsKeepTheirAreaAndDroppedPointsAreNear) {
  Random random(13);
  int dropped = 0;
  for (int round = 0; round < 1000; ++round) {
    // A house with points along its walls, off by up to 15 mm.
    const double w = 6 + 20 * random.unit(), d = 6 + 20 * random.unit();
    const std::vector<Point2> corners{{0, 0}, {w, 0}, {w, d}, {w / 2, d}, {w / 2, d / 2}, {0, d / 2}};
    std::vector<Point2> points;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point2 a = corners[i], b = corners[(i + 1) % corners.size()];
      const auto n = random.next(6);
      points.push_back(a);
      for (std::uint64_t k = 1; k <= n; ++k) {
        const double t = static_cast<double>(k) / static_cast<double>(n + 1);
        points.push_back({a.x + t * (b.x - a.x) + 0.015 * (random.unit() - 0.5),
                          a.y + t * (b.y - a.y) + 0.015 * (random.unit() - 0.5)});
      }
    }
    const Polygon plan = testing_shapes::turned(testing_shapes::polygon(points));
    model::Report report;
    const auto r = repair_rings(one(plan.outer.points), kId, {}, {}, report);
    ASSERT_EQ(r.polygons.size(), 1u);
    const Ring& outer = r.polygons[0].outer;
    EXPECT_NEAR(geometry::area(r.polygons[0]), geometry::area(plan), 0.02 * geometry::perimeter(plan));
    for (const Point2 p : plan.outer.points) {
      double nearest = 1e9;
      for (std::size_t i = 0; i < outer.size(); ++i)
        nearest =
            std::min(nearest, geometry::distance_to_segment(p, outer.points[i], outer.points[(i + 1) % outer.size()]));
      EXPECT_LE(nearest, RepairOptions{}.collinear_distance);
    }
    for (const Point2 p : outer.points)
      EXPECT_NE(std::find(plan.outer.points.begin(), plan.outer.points.end(), p), plan.outer.points.end());
    dropped += static_cast<int>(plan.outer.size() - outer.size());
  }
  EXPECT_GT(dropped, 5000);
}

// ---- kept nodes -----------------------------------------------------------------------------------------------------

std::uint32_t add_way(model::Extract& e, std::vector<std::int64_t> nodes) {
  e.rings.push_back({{static_cast<std::uint32_t>(e.vertices.size()), static_cast<std::uint32_t>(nodes.size())}, false});
  for (const std::int64_t n : nodes) {
    e.vertices.push_back({});
    e.vertex_nodes.push_back(n);
  }
  return static_cast<std::uint32_t>(e.rings.size() - 1);
}

void add_building(model::Extract& e, std::vector<std::int64_t> nodes,
                  model::ObjectState state = model::ObjectState::pending) {
  model::MappedBuilding b;
  b.rings = {add_way(e, std::move(nodes)), 1};
  b.state = state;
  e.buildings.push_back(b);
}

TEST(KeptNodes, SharedAndMeaningfulNodesOnly) {
  model::Extract e;
  add_building(e, {1, 2, 3, 4});
  add_building(e, {3, 5, 6, 4});
  add_building(e, {1, 2, 3, 4}, model::ObjectState::duplicate);
  add_building(e, {7, 8, 9, 7, 8, 9});  // twice round is one object
  model::Feature street;
  street.kinds = static_cast<std::uint32_t>(model::FeatureKind::street);
  street.rings = {add_way(e, {6, 20}), 1};
  model::Feature entrance;
  entrance.kinds = static_cast<std::uint32_t>(model::FeatureKind::entrance);
  entrance.rings = {add_way(e, {1}), 1};
  model::Feature lawn;
  lawn.area = true;
  lawn.rings = {add_way(e, {2, 30, 31}), 1};
  e.features = {street, entrance, lawn};
  const KeptNodes kept(e);
  for (const std::int64_t n : {1, 3, 4, 6, 20}) EXPECT_TRUE(kept.contains(n)) << n;
  for (const std::int64_t n : {0, 2, 5, 7, 8, 9, 30, 31}) EXPECT_FALSE(kept.contains(n)) << n;
  EXPECT_EQ(kept.size(), 5u);
}

}  // namespace
}  // namespace blockrand::repair
