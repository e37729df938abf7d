#include "pipeline/model/roof_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <map>
#include <string>

namespace blockrand::model {
namespace {

/// As the importer compares values: lower case, gaps as underscores.
std::string normal(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c == '-' || c == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

TEST(RoofShapes, AreFoundByTheirNames) {
  for (std::size_t i = 0; i < kRoofShapeCount; ++i) {
    const auto shape = static_cast<RoofShape>(i);
    EXPECT_FALSE(name(shape).empty());
    EXPECT_EQ(roof_shape(name(shape)), shape);
    EXPECT_EQ(kRoofShapeNames[i], name(shape));
  }
  EXPECT_FALSE(roof_shape("zigzag"));
  EXPECT_FALSE(roof_shape("Gabled")) << "configuration files spell names as they are";
}

TEST(RoofShapes, HaveNoNameOrSynonymTwice) {
  std::map<std::string, int> times;
  for (const RoofTraits& row : kRoofTraits) {
    ++times[normal(row.name)];
    for (const std::string_view synonym : row.synonyms) {
      if (synonym.empty()) continue;
      ++times[std::string(synonym)];
      EXPECT_EQ(normal(synonym), synonym) << "the importer compares it with normal text";
      EXPECT_TRUE(row.is_tag_value) << synonym << " would never be read";
    }
  }
  for (const auto& [text, count] : times) EXPECT_EQ(count, 1) << text;
}

TEST(RoofShapes, KeepTheNumbersThatOutputsHold) {
  EXPECT_EQ(static_cast<int>(RoofShape::flat), 0);
  EXPECT_EQ(static_cast<int>(RoofShape::hipped), 4);
  EXPECT_EQ(static_cast<int>(RoofShape::dome), 16);
  EXPECT_EQ(static_cast<int>(RoofShape::other), 25);
  EXPECT_EQ(static_cast<int>(RoofShape::berlin), 27);
}

TEST(RoofShapes, HaveTheDataOfTheirConstruction) {
  ASSERT_TRUE(constructed_as<EdgeRoof>(RoofShape::gambrel));
  EXPECT_EQ(constructed_as<EdgeRoof>(RoofShape::gambrel)->eaves, EavesProfile::broken);
  EXPECT_EQ(constructed_as<EdgeRoof>(RoofShape::gambrel)->ends, WingEnds::gables);
  EXPECT_FALSE(constructed_as<ApexRoof>(RoofShape::gambrel));
  EXPECT_TRUE(rises_from_edges(RoofShape::berlin));
  EXPECT_FALSE(rises_from_edges(RoofShape::dome)) << "its relative rises from edges, where the plan has no apex";
  EXPECT_TRUE(is_unknown(RoofShape::many));
  EXPECT_TRUE(is_unknown(RoofShape::other));
  EXPECT_FALSE(is_unknown(RoofShape::lined));
}

TEST(RoofShapes, HaveUsualPitchesThatRoofsCanHave) {
  for (const RoofTraits& row : kRoofTraits) {
    EXPECT_GE(row.pitch.own, 0) << row.name;
    EXPECT_LE(row.pitch.own, 75) << row.name << ": max_roof_pitch limits what no tag measures";
    EXPECT_GT(row.pitch.most, 0) << row.name;
  }
}

}  // namespace
}  // namespace blockrand::model
