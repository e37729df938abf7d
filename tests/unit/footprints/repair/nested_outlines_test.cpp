// Houses drawn twice and outlines around houses.
#include "pipeline/footprints/repair/nested_outlines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/footprints/repair/row_support.h"

namespace blockrand::repair::test {
namespace {

using model::IssueCode;
using model::ObjectState;
using testing::ElementsAre;

const TerraceBuilding& find(const TerraceRow& row, model::OsmId id) {
  return *std::find_if(row.buildings.begin(), row.buildings.end(),
                       [&](const TerraceBuilding& b) { return b.id == id; });
}

/// A square of 10 m at x; of a share of 1 - d / 10 with another one d metres beside it.
model::Polygon square_at(double x) { return polygon(box(x, 0, x + 10, 10)); }

TEST(Coverings, ADuplicateIsOneOfABuildingThatStays) {
  // w1 and w2 have most in common, w3 is the strongest, and all are one house.
  TerraceRow row = row_of_polygons({square_at(0), square_at(0.05), square_at(0.5)});
  row.buildings[1].tags = 1;
  row.buildings[2].tags = 2;
  model::Report report;
  settle_coverings(row, {}, report);
  for (const std::size_t i : {0u, 1u}) {
    EXPECT_EQ(row.buildings[i].settled, ObjectState::duplicate);
    EXPECT_EQ(row.buildings[i].related, row.buildings[2].id);
  }
  EXPECT_EQ(row.buildings[2].settled, ObjectState::pending);
}

TEST(Coverings, AHouseThatOnlyADuplicateResemblesIsNoDuplicate) {
  // w2 is a duplicate of w3; w1 has nine tenths in common with w2 alone; w3 lies within it.
  TerraceRow row = row_of_polygons({square_at(0), square_at(0.8), square_at(1.6)});
  row.buildings[1].tags = 1;
  row.buildings[2].tags = 2;
  model::Report report;
  settle_coverings(row, {}, report);
  EXPECT_EQ(row.buildings[1].settled, ObjectState::duplicate);
  EXPECT_EQ(row.buildings[0].settled, ObjectState::pending);
  EXPECT_THAT(codes_of(report, 1), ElementsAre(IssueCode::covered_outline));
}

TEST(Coverings, InAnyOrderNobodyIsADuplicateOfADuplicate) {
  // 40 drawings that drift by 0.3 m each.
  std::vector<model::Polygon> drawings;
  for (int i = 0; i < 40; ++i) drawings.push_back(square_at(0.3 * i));
  TerraceRow first = row_of_polygons(drawings);
  for (std::size_t i = 0; i < 40; ++i) first.buildings[i].tags = static_cast<int>(i * 7 % 5);
  TerraceRow second = first;
  std::reverse(second.buildings.begin(), second.buildings.end());
  const TerraceRow before = first;
  model::Report report;
  settle_coverings(first, {}, report);
  settle_coverings(second, {}, report);
  int duplicates = 0;
  for (std::size_t i = 0; i < 40; ++i) {
    const TerraceBuilding& b = first.buildings[i];
    EXPECT_EQ(find(second, b.id).settled, b.settled);
    EXPECT_EQ(find(second, b.id).related, b.related);
    if (b.settled != ObjectState::duplicate) continue;
    ++duplicates;
    EXPECT_NE(find(first, b.related).settled, ObjectState::duplicate);
    EXPECT_GE(common_area(before.buildings[i], find(before, b.related)), kSameShare * 99.9);
  }
  EXPECT_GT(duplicates, 20);
}

TEST(Coverings, OutlineOfTwoHousesKeepsWhatTheyLeaveFree) {
  TerraceRow row = row_of_polygons({polygon(box(0, 0, 8, 10)), polygon(box(8, 0, 16, 10)), polygon(box(0, 0, 20, 10))});
  model::Report report;
  settle_coverings(row, {}, report);
  EXPECT_NEAR(area(row.buildings[2]), 40, 1e-6);
  EXPECT_THAT(codes_of(report, 3), ElementsAre(IssueCode::covered_outline));
}

TEST(Coverings, OutlineWithoutARestIsRepresentedByTheLargestHouse) {
  TerraceRow row =
      row_of_polygons({polygon(box(0, 0, 7, 10)), polygon(box(7, 0, 16, 10)), polygon(box(0, 0, 16.2, 10))});
  model::Report report;
  settle_coverings(row, {}, report);
  EXPECT_EQ(row.buildings[2].settled, ObjectState::represented);
  EXPECT_EQ(row.buildings[2].related, row.buildings[1].id);
}

}  // namespace
}  // namespace blockrand::repair::test
