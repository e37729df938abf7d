#include "pipeline/attributes/tag_conflicts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/geometry/shapes.h"

namespace blockrand::attributes {
namespace {

using model::MappedAttributes;
using model::RoofOrientation;
using model::RoofShape;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// 20 m along x, 10 m along y.
const model::Polygon kHouse = testing_shapes::polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
const model::Polygon kAngle = testing_shapes::polygon({{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 18}, {0, 18}});

MappedAttributes tagged(std::optional<RoofShape> shape) {
  MappedAttributes tags;
  tags.roof_shape = shape;
  return tags;
}

std::vector<std::string> texts(const MappedAttributes& tags, const model::Polygon& plan = kHouse, bool ridges = false) {
  std::vector<std::string> out;
  for (const TagConflict& c : tag_conflicts(tags, {tags.roof_shape.value_or(RoofShape::gabled), plan, 3, ridges}))
    out.push_back(std::string(model::info(c.code).text) + ": " + c.text);
  return out;
}

TEST(TagConflicts, HeightAgainstAngle) {
  auto tags = tagged(RoofShape::gabled);
  tags.roof_angle = 45;  // 5 m
  tags.roof_height = 5.4f;
  EXPECT_THAT(texts(tags), IsEmpty());
  tags.roof_height = 4;  // a fifth less: eaves and guesses
  EXPECT_THAT(texts(tags), IsEmpty());
  tags.roof_height = 2.5f;
  EXPECT_THAT(
      texts(tags),
      ElementsAre("VALUES_CONFLICT: roof:height=2.5 against roof:angle=45, which gives 5.0 m: roof:height won"));
  tags.roof_angle = 5;  // 0.4 m
  tags.roof_height = 0.8f;
  EXPECT_THAT(texts(tags), IsEmpty()) << "half a metre is nothing";
  // An untagged shape could be a lean-to as well; of a vault the angle says little.
  tags.roof_angle = 45;
  tags.roof_height = 10;
  EXPECT_THAT(texts(tags).size(), 1u);
  tags.roof_shape = std::nullopt;
  EXPECT_THAT(texts(tags), IsEmpty());
  tags.roof_shape = RoofShape::skillion;  // 10 m down the slope
  EXPECT_THAT(texts(tags), IsEmpty());
  tags.roof_shape = RoofShape::dome;
  EXPECT_THAT(texts(tags), IsEmpty());
}

TEST(TagConflicts, AnAngleOnAPlanOfSeveralWingsMustBeFarOff) {
  auto tags = tagged(RoofShape::gabled);
  tags.roof_angle = 45;  // about 4 m
  tags.roof_height = 2.3f;
  EXPECT_THAT(texts(tags, kAngle), IsEmpty());
  tags.roof_height = 1.5f;
  EXPECT_THAT(texts(tags, kAngle), ElementsAre(HasSubstr("roof:height won")));
}

TEST(TagConflicts, StoreysInTheRoofAreWeak) {
  auto tags = tagged(RoofShape::gabled);
  tags.roof_height = 9;
  tags.roof_storeys = 0;
  EXPECT_THAT(texts(tags), IsEmpty());
  tags.roof_storeys = 1;
  EXPECT_THAT(texts(tags), IsEmpty());
  tags.roof_height = 1.2f;
  EXPECT_THAT(texts(tags), IsEmpty());
  tags.roof_storeys = 3;
  EXPECT_THAT(texts(tags),
              ElementsAre("VALUES_CONFLICT: roof:height=1.2 has no room for roof:levels=3: roof:height won"));
  tags.roof_height = std::nullopt;
  tags.roof_angle = 10;  // 0.9 m
  EXPECT_THAT(texts(tags),
              ElementsAre("VALUES_CONFLICT: roof:angle=10 gives 0.9 m, no room for roof:levels=3: roof:angle won"));
}

TEST(TagConflicts, ARoofMayFillItsBuildingButNotMore) {
  auto tags = tagged(RoofShape::dome);
  tags.height = 10;
  tags.roof_height = 10;
  EXPECT_THAT(texts(tags), IsEmpty());
  tags.min_height = 4;
  EXPECT_THAT(texts(tags),
              ElementsAre("VALUES_CONFLICT: roof:height=10 against height=10 above min_height=4: height won"));
  tags.roof_height = 6;
  EXPECT_THAT(texts(tags), IsEmpty());
  tags = tagged(RoofShape::gabled);
  tags.height = 4;
  tags.roof_angle = 60;
  EXPECT_THAT(texts(tags),
              ElementsAre("VALUES_CONFLICT: roof:angle=60 gives 8.7 m, height=4 leaves 4.0 m: height won"));
  tags.height = 12;
  tags.storeys = 3;
  EXPECT_THAT(texts(tags), ElementsAre(HasSubstr("height=12 with building:levels=3 leaves 5.4 m: height won")));
  tags.storeys = 1;
  EXPECT_THAT(texts(tags), IsEmpty());
}

TEST(TagConflicts, FlatRoofsHaveParapetsAndSetBackStoreysButNoSlope) {
  auto tags = tagged(RoofShape::flat);
  tags.roof_height = 1;
  tags.roof_storeys = 1;
  tags.roof_angle = 3;
  tags.roof_direction = 90;
  tags.roof_orientation = RoofOrientation::along;
  EXPECT_THAT(texts(tags), IsEmpty());
  tags.roof_height = 3;
  tags.roof_angle = 30;
  EXPECT_THAT(texts(tags, kHouse, true),
              ElementsAre("VALUES_CONFLICT: roof:height=3 against roof:shape=flat, which has no height: the shape won",
                          "VALUES_CONFLICT: roof:angle=30 against roof:shape=flat: the shape won",
                          "VALUES_CONFLICT: mapped ridges against roof:shape=flat: the shape won"));
}

TEST(TagConflicts, ZeroIsNoMeasureOfASlopedRoof) {
  auto tags = tagged(RoofShape::hipped);
  tags.roof_height = 0;
  tags.roof_angle = 0;
  EXPECT_THAT(texts(tags), ElementsAre("VALUES_CONFLICT: roof:height=0 against roof:shape=hipped: the shape won",
                                       "VALUES_CONFLICT: roof:angle=0 against roof:shape=hipped: the shape won"));
  EXPECT_FALSE(useful_roof_height(tags, RoofShape::hipped));
  EXPECT_FALSE(height_of_angle(tags, RoofShape::hipped, kHouse));
}

TEST(TagConflicts, DirectionAgainstOrientation) {
  auto tags = tagged(RoofShape::gabled);
  tags.roof_direction = 90;  // down along the longer side, so that the ridge runs across
  EXPECT_THAT(texts(tags), IsEmpty());
  tags.roof_orientation = RoofOrientation::across;
  EXPECT_THAT(texts(tags), IsEmpty());
  tags.roof_orientation = RoofOrientation::along;
  EXPECT_THAT(texts(tags), ElementsAre("VALUES_CONFLICT: roof:direction=90 falls along the longer side against "
                                       "roof:orientation=along: roof:direction won"));
  tags.roof_direction = 135;  // between the two
  EXPECT_THAT(texts(tags), IsEmpty());
  tags.roof_direction = 5;
  EXPECT_THAT(texts(tags), IsEmpty());
  tags.roof_orientation = RoofOrientation::across;
  EXPECT_THAT(texts(tags), ElementsAre(HasSubstr("falls across the longer side")));
  EXPECT_THAT(texts(tags, testing_shapes::polygon({{0, 0}, {11, 0}, {11, 10}, {0, 10}})), IsEmpty()) << "nearly square";
  EXPECT_THAT(texts(tags, kAngle), IsEmpty());
  tags.roof_shape = RoofShape::skillion;
  EXPECT_THAT(texts(tags), IsEmpty());
}

TEST(TagConflicts, TooSteepIsLimited) {
  auto tags = tagged(RoofShape::gabled);
  tags.roof_angle = 87;
  EXPECT_THAT(texts(tags), ElementsAre("VALUE_CLAMPED: roof:angle=87, limited to 80"));
  EXPECT_NEAR(*height_of_angle(tags, RoofShape::gabled, kHouse), 5 * 5.671, 0.01);
  tags.roof_shape = RoofShape::spire;
  EXPECT_THAT(texts(tags), ElementsAre("VALUE_CLAMPED: roof:angle=87, limited to 86"));
}

TEST(TagConflicts, StoreysMustFitTheHeight) {
  auto tags = tagged(RoofShape::flat);
  tags.height = 10;
  tags.storeys = 4;
  EXPECT_THAT(texts(tags), IsEmpty());
  tags.storeys = 1;
  tags.height = 1.5f;
  EXPECT_THAT(texts(tags), IsEmpty()) << "a low shed";
  tags.height = 10;
  tags.storeys = 8;
  EXPECT_THAT(texts(tags), ElementsAre("VALUES_CONFLICT: height=10 against building:levels=8, 1.2 m each: height won"));
  tags.roof_shape = RoofShape::gabled;
  tags.storeys = 3;
  tags.roof_storeys = 1;
  EXPECT_THAT(texts(tags), IsEmpty());
  tags.roof_height = 6;
  EXPECT_THAT(texts(tags), ElementsAre(HasSubstr("height=10 and roof:height=6 against building:levels=3, 1.3 m each")));
}

TEST(TagConflicts, TheUndersideLiesBelowTheTop) {
  auto tags = tagged(RoofShape::flat);
  tags.height = 30;
  tags.min_height = 30;
  tags.storeys = 10;
  EXPECT_THAT(texts(tags), ElementsAre("VALUES_CONFLICT: min_height=30 against height=30: height won"));
  tags.min_height = 29.9f;
  tags.storeys = std::nullopt;
  EXPECT_THAT(texts(tags), IsEmpty()) << "a thin slab";
}

TEST(TagConflicts, StoreysOfAPartThatWereCountedFromItsUnderside) {
  auto tags = tagged(RoofShape::flat);
  tags.storeys = 2;
  tags.min_storey = 4;
  EXPECT_THAT(
      texts(tags),
      ElementsAre(
          "VALUES_CONFLICT: building:levels=2 ends below building:min_level=4: taken for the part's own storeys"));
  EXPECT_EQ(storeys_below(tags, 3), 4);
  tags.min_height = 15;
  EXPECT_EQ(storeys_below(tags, 3), 5);
  EXPECT_THAT(texts(tags), ElementsAre(HasSubstr("ends below min_height=15")));
  tags.storeys = 6;
  EXPECT_THAT(texts(tags), IsEmpty());
  tags.storeys = 2;
  tags.height = 18;
  EXPECT_EQ(storeys_below(tags, 3), 0);
}

}  // namespace
}  // namespace blockrand::attributes
