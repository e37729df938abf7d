// The whole way of a row.
#include "pipeline/footprints/repair/repair_terrace_row.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/footprints/repair/noise_scene.h"
#include "tests/unit/footprints/repair/row_support.h"

namespace blockrand::repair::test {
namespace {

using model::IssueCode;
using model::Point2;
using testing::Contains;
using testing::DoubleNear;

/// Noisy houses of all kinds, with nested and overlapping ones among them.
TerraceRow mixed_row(double noise = 0.3) {
  Footprints truth = true_houses(3, 6);
  const std::size_t n = truth.size();
  for (std::size_t i = 0; i < n; i += 9) {
    model::Polygon moved = truth[i][0];
    for (Point2& p : moved.outer.points) p = model::snap(Point2{p.x + 3, p.y - 2});
    truth.push_back({moved});
  }
  return row_of(with_noise(truth, noise, 5));
}

/// The footprint as a set of directed edges, from its least point on.
std::vector<std::vector<Point2>> canonical(const TerraceBuilding& b) {
  std::vector<std::vector<Point2>> out;
  for (const model::Ring& r : rings(b)) {
    std::vector<Point2> points = r.points;
    std::rotate(points.begin(), std::min_element(points.begin(), points.end()), points.end());
    out.push_back(std::move(points));
  }
  std::sort(out.begin(), out.end());
  return out;
}

TerraceRow repaired(TerraceRow row, bool square = true) {
  RepairOptions options;
  options.square = square;
  model::Report report;
  repair_terrace_row(row, options, report);
  return row;
}

TEST(RepairRow, KeepsItsPromisesOnNoisyHouses) {
  for (const bool square : {false, true}) {
    const TerraceRow before = mixed_row();
    TerraceRow row = before;
    RepairOptions options;
    options.square = square;
    model::Report report;
    repair_terrace_row(row, options, report);
    ASSERT_TRUE(all_valid(row));
    for (std::size_t i = 0; i < row.buildings.size(); ++i) {
      const TerraceBuilding& b = row.buildings[i];
      EXPECT_LE(b.record.max_shift, options.max_shift + 0.001);
      EXPECT_THAT(b.record.area, DoubleNear(area(b), 1e-9));
      std::size_t vertices = 0;
      for (const model::Ring& r : rings(b)) {
        vertices += r.size();
        EXPECT_EQ(r.nodes.size(), r.points.size());
        for (const Point2 p : r.points) EXPECT_EQ(p, model::snap(p));
      }
      EXPECT_EQ(b.record.vertices, vertices);
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_LE(common_area(b, row.buildings[j]), b.record.overlap_left + 1e-6) << i << " " << j;
    }
    for (const model::ReportRow& r : report.rows) EXPECT_FALSE(r.detail.empty());
  }
}

TEST(RepairRow, DoesNotDependOnTheOrderOfBuildings) {
  for (const bool square : {false, true}) {
    const TerraceRow before = mixed_row();
    const TerraceRow expected = repaired(before, square);
    TerraceRow turned;
    const std::size_t n = before.buildings.size();
    for (std::size_t i = 0; i < n; ++i) turned.buildings.push_back(before.buildings[(i * 7 + 3) % n]);
    ASSERT_NE(n % 7, 0u);
    turned = repaired(std::move(turned), square);
    for (std::size_t i = 0; i < n; ++i) {
      const TerraceBuilding &got = turned.buildings[i], &want = expected.buildings[(i * 7 + 3) % n];
      ASSERT_EQ(got.id, want.id);
      EXPECT_TRUE(same_points(got, want)) << got.id.text();
    }
  }
}

TEST(RepairRow, DoesNotDependOnWhereRingsStart) {
  for (const bool square : {false, true}) {
    const TerraceRow before = mixed_row();
    const TerraceRow expected = repaired(before, square);
    TerraceRow turned = before;
    std::size_t by = 1;
    for (TerraceBuilding& b : turned.buildings)
      for (model::Polygon& p : b.polygons) {
        const auto middle = static_cast<std::ptrdiff_t>(by++ % p.outer.size());
        std::rotate(p.outer.points.begin(), p.outer.points.begin() + middle, p.outer.points.end());
        std::rotate(p.outer.nodes.begin(), p.outer.nodes.begin() + middle, p.outer.nodes.end());
      }
    turned = repaired(std::move(turned), square);
    for (std::size_t i = 0; i < turned.buildings.size(); ++i)
      EXPECT_EQ(canonical(turned.buildings[i]), canonical(expected.buildings[i])) << i;
  }
}

TEST(RepairRow, RotationBy37DegreesGivesTheSameTopology) {
  const TerraceRow before = mixed_row();
  const double c = 0.79863551, s = 0.60181502;
  const auto turn = [&](Point2 p) {
    const double x = p.x - kOrigin.x, y = p.y - kOrigin.y;
    return model::snap(Point2{kOrigin.x + c * x - s * y, kOrigin.y + s * x + c * y});
  };
  TerraceRow turned = before;
  for (TerraceBuilding& b : turned.buildings)
    for (model::Polygon& p : b.polygons)
      for (Point2& q : p.outer.points) q = turn(q);
  const TerraceRow expected = repaired(before, false), got = repaired(turned, false);
  for (std::size_t i = 0; i < got.buildings.size(); ++i) {
    const TerraceBuilding &a = expected.buildings[i], &b = got.buildings[i];
    ASSERT_EQ(a.polygons.size(), b.polygons.size()) << i;
    EXPECT_EQ(a.record.vertices, b.record.vertices) << i;
    EXPECT_EQ(a.record.shared_walls, b.record.shared_walls) << i;
    EXPECT_THAT(b.record.area, DoubleNear(a.record.area, 0.1)) << i;
    for (const Point2 p : a.polygons[0].outer.points) {
      double nearest = 1e9;
      for (const Point2 q : b.polygons[0].outer.points) nearest = std::min(nearest, length(turn(p), q));
      EXPECT_LE(nearest, 0.01) << i;
    }
  }
}

TEST(RepairRow, ChainOfRowHousesWithNoiseIsAPartition) {
  Footprints truth;
  for (int i = 0; i < 12; ++i) truth.push_back({polygon(box(7.0 * i, 0, 7.0 * (i + 1), 11))});
  const TerraceRow row = repaired(row_of(with_noise(truth, 0.3, 21)));
  ASSERT_TRUE(all_valid(row));
  int joined = 0;
  for (std::size_t i = 0; i + 1 < 12; ++i) {
    joined += shared_length(row.buildings[i], row.buildings[i + 1]) > 10;
    EXPECT_EQ(common_area(row.buildings[i], row.buildings[i + 1]), 0);
  }
  EXPECT_GE(joined, 10);
}

TEST(RepairRow, BuildingThatSharingWouldBreakStaysAndSaysSo) {
  // A kiosk of 1.2 x 1.2 m between two houses: closing both gaps would add 30 % to it.
  const TerraceRow before =
      row_of_polygons({polygon(box(0, 0, 10, 8)), polygon(box(10.2, 2, 11.4, 3.2)), polygon(box(11.6, 0, 20, 8))});
  TerraceRow row = before;
  model::Report report;
  repair_terrace_row(row, without_squaring(), report);
  ASSERT_TRUE(all_valid(row));
  EXPECT_TRUE(same_points(row.buildings[1], before.buildings[1]));
  EXPECT_THAT(codes_of(report, 2), Contains(IssueCode::repair_bounded));
}

TEST(RepairRow, NothingMovesFartherThanTheBound) {
  RepairOptions options;
  options.max_shift = 0.12;
  TerraceRow row = mixed_row();
  model::Report report;
  repair_terrace_row(row, options, report);
  ASSERT_TRUE(all_valid(row));
  for (const TerraceBuilding& b : row.buildings) EXPECT_LE(b.record.max_shift, 0.12 + 0.001);
}

TEST(RepairRow, RowOfOneThatIsRightStaysExactly) {
  const TerraceRow before = row_of_polygons({polygon(box(0, 0, 10, 8), {box(3, 3, 6, 6)})});
  const TerraceRow row = repaired(before);
  EXPECT_TRUE(same_points(row.buildings[0], before.buildings[0]));
  EXPECT_EQ(row.buildings[0].record.moved, 0u);
  EXPECT_EQ(row.buildings[0].record.vertices, 8u);
}

TEST(RepairRow, RoundTowerHasItsArc) {
  Points circle;
  for (int i = 0; i < 16; ++i) circle.push_back({5 * std::cos(i * 0.39269908), 5 * std::sin(i * 0.39269908)});
  const TerraceRow row = repaired(row_of_polygons({polygon(circle)}));
  ASSERT_EQ(row.buildings[0].arcs.size(), 1u);
  EXPECT_THAT(row.buildings[0].arcs[0].radius, DoubleNear(5, 0.01));
}

TEST(RepairRow, EmptyRowIsLeftAlone) {
  TerraceRow row;
  model::Report report;
  repair_terrace_row(row, {}, report);
  EXPECT_TRUE(row.buildings.empty());
  EXPECT_TRUE(report.rows.empty());
}

}  // namespace
}  // namespace blockrand::repair::test
