// When rows that an image shows elsewhere say more of the image than of the map.
#include "pipeline/observation/rows_off_alike.h"

#include <gtest/gtest.h>

namespace blockrand::observation {
namespace {

/// `rows` rows of two houses each, all shown elsewhere by image 0.
ImageryObservations moved_rows(std::uint32_t rows, model::Point2 (*shift)(std::uint32_t row)) {
  ImageryObservations seen;
  seen.images.resize(2);
  for (std::uint32_t row = 0; row < rows; ++row)
    for (int house = 0; house < 2; ++house) {
      OutlineReceipt& r = seen.outlines.emplace_back();
      r.state = RowState::corrected, r.row = row, r.image = 0, r.shift = shift(row), r.confidence = 0.8;
      r.refined.state = RefinementState::refined;
    }
  return seen;
}

model::Point2 nearly_alike(std::uint32_t row) { return {1.5 + 0.1 * (row % 3), -1.0 - 0.1 * (row % 2)}; }
model::Point2 all_ways(std::uint32_t row) { return {row % 2 ? 1.5 : -1.5, row % 3 ? 1.2 : -1.2}; }

TEST(RowsOffAlike, AreNotMoved) {
  ImageryObservations seen = moved_rows(6, nearly_alike);
  doubt_rows_off_alike(0, seen);
  EXPECT_NEAR(seen.images[0].alike.x, 1.6, 0.11);
  EXPECT_NEAR(seen.images[0].alike.y, -1.05, 0.11);
  for (const OutlineReceipt& r : seen.outlines) {
    EXPECT_EQ(r.state, RowState::undecided);
    EXPECT_FALSE(r.reason.empty());
    EXPECT_EQ(r.refined.state, RefinementState::none);
  }
}

TEST(RowsOffAlike, RowsThatAreOffInAllDirectionsAreTheMaps) {
  ImageryObservations seen = moved_rows(8, all_ways);
  doubt_rows_off_alike(0, seen);
  EXPECT_EQ(seen.images[0].alike, model::Point2{});
  for (const OutlineReceipt& r : seen.outlines) EXPECT_EQ(r.state, RowState::corrected);
}

TEST(RowsOffAlike, AFewAmongManyThatStandRightAreTheMaps) {
  ImageryObservations seen = moved_rows(20, nearly_alike);
  for (OutlineReceipt& r : seen.outlines)
    if (r.row >= 8) r.state = RowState::left_alone, r.shift = {};
  doubt_rows_off_alike(0, seen);
  EXPECT_EQ(seen.outlines.front().state, RowState::corrected);
}

TEST(RowsOffAlike, ThreeRowsAreChance) {
  ImageryObservations seen = moved_rows(3, nearly_alike);
  doubt_rows_off_alike(0, seen);
  EXPECT_EQ(seen.outlines.front().state, RowState::corrected);
}

TEST(RowsOffAlike, OtherImagesKeepTheirOwn) {
  ImageryObservations seen = moved_rows(6, nearly_alike);
  for (OutlineReceipt& r : seen.outlines) r.image = 1;
  doubt_rows_off_alike(0, seen);
  EXPECT_EQ(seen.outlines.front().state, RowState::corrected);
  ImageryObservations nothing;
  nothing.images.resize(1);
  doubt_rows_off_alike(0, nothing);
  EXPECT_EQ(nothing.images[0].alike, model::Point2{});
}

}  // namespace
}  // namespace blockrand::observation
