#include "importers/osm/tag_values.h"

#include <gtest/gtest.h>

namespace blockrand::importers::osm {
namespace {

using model::Colour;
using model::RoofShape;

struct NumberCase {
  const char* text;
  double value;
};

TEST(ParseLength, KnowsEveryFormMappersUse) {
  const NumberCase cases[] = {{"12", 12},
                              {"12 m", 12},
                              {"12m", 12},
                              {" 12 ", 12},
                              {"1,5", 1.5},
                              {"1.5", 1.5},
                              {"12.", 12},
                              {".5", 0.5},
                              {"12 meters", 12},
                              {"12 Metre", 12},
                              {"12 M", 12},
                              {"500 cm", 5},
                              {"500cm", 5},
                              {"0.5 km", 500},
                              {"1500 mm", 1.5},
                              {"40'", 12.192},
                              {"40 '", 12.192},
                              {"40 ft", 12.192},
                              {"40ft", 12.192},
                              {"40 feet", 12.192},
                              {"40′", 12.192},
                              {"40'6\"", 12.3444},
                              {"40' 6\"", 12.3444},
                              {"40′6″", 12.3444},
                              {"40 ft 6 in", 12.3444},
                              {"40'6''", 12.3444},
                              {"6\"", 0.1524},
                              {"6 in", 0.1524},
                              {"10 yd", 9.144},
                              {"~12", 12},
                              {"~ 12 m", 12},
                              {"ca. 12", 12},
                              {">12", 12},
                              {"<12", 12},
                              {"3;4", 4},
                              {"4;3", 4},
                              {"3 m; 4 m", 4},
                              {"12-14", 14},
                              {"12 - 14 m", 14},
                              {"12–14", 14},
                              {"3;", 3},
                              {"-3", -3},
                              {"+3", 3},
                              {"0", 0}};
  for (const auto& c : cases) {
    const auto read = parse_length(c.text);
    ASSERT_TRUE(read) << c.text;
    EXPECT_NEAR(*read, c.value, 1e-9) << c.text;
  }
  EXPECT_EQ(parse_length("3;4", Pick::lowest), 3);
  EXPECT_EQ(parse_length("12-14", Pick::lowest), 12);
}

TEST(ParseLength, LeavesTheRestUnread) {
  for (const char* text : {"", " ", "m", "high", "12 x", "twelve", "1e3", "12 m high", "40'6", "1.2.3", "1 2", ";", "-",
                           "'", "nan", "inf", "12;high", "99999999999999999999999999999999999"})
    EXPECT_FALSE(parse_length(text)) << text;
}

TEST(ParseStoreys, KnowsEveryFormMappersUse) {
  const NumberCase cases[] = {{"3", 3},   {"2.5", 2.5}, {"1,5", 1.5}, {"3;4", 4}, {"3-4", 4},    {"2½", 2.5},
                              {"½", 0.5}, {"~5", 5},    {"0", 0},     {"-1", -1}, {"3; 5 ;4", 5}};
  for (const auto& c : cases) EXPECT_EQ(parse_storeys(c.text), c.value) << c.text;
  EXPECT_EQ(parse_storeys("3;4", Pick::lowest), 3);
  for (const char* text : {"", "3 m", "EG", "3+D", "yes", "three"}) EXPECT_FALSE(parse_storeys(text)) << text;
}

TEST(ParseAngle, TakesDegrees) {
  const NumberCase cases[] = {{"30", 30}, {"30°", 30}, {"37,5", 37.5}, {"30 deg", 30}, {"30 degrees", 30}, {"~45", 45}};
  for (const auto& c : cases) EXPECT_EQ(parse_angle(c.text), c.value) << c.text;
  for (const char* text : {"", "steep", "30%", "30;40"}) EXPECT_FALSE(parse_angle(text)) << text;
}

TEST(ParseDirection, TakesDegreesAndCompassPoints) {
  const NumberCase cases[] = {{"45", 45},          {"45°", 45},        {"0", 0},           {"360", 0},
                              {"-90", 270},        {"N", 0},           {"n", 0},           {"NNE", 22.5},
                              {"NE", 45},          {"ENE", 67.5},      {"E", 90},          {"SSW", 202.5},
                              {"NNW", 337.5},      {"north", 0},       {"South", 180},     {"west", 270},
                              {"north-west", 315}, {"southeast", 135}, {"north_east", 45}, {"north-north-east", 22.5}};
  for (const auto& c : cases) EXPECT_EQ(parse_direction(c.text), c.value) << c.text;
  for (const char* text : {"", "up", "NN", "NSE", "1000", "forward", "N;S"})
    EXPECT_FALSE(parse_direction(text)) << text;
}

TEST(ParseColour, TakesHexRgbAndNames) {
  EXPECT_EQ(parse_colour("#a33"), (Colour{0xaa, 0x33, 0x33}));
  EXPECT_EQ(parse_colour("#AA3333"), (Colour{0xaa, 0x33, 0x33}));
  EXPECT_EQ(parse_colour("#aa3333ff"), (Colour{0xaa, 0x33, 0x33}));
  EXPECT_EQ(parse_colour("aa3333"), (Colour{0xaa, 0x33, 0x33}));
  EXPECT_EQ(parse_colour("DarkRed"), (Colour{0x8b, 0, 0}));
  EXPECT_EQ(parse_colour("dark red"), (Colour{0x8b, 0, 0}));
  EXPECT_EQ(parse_colour("dark_red"), (Colour{0x8b, 0, 0}));
  EXPECT_EQ(parse_colour("light-grey"), (Colour{0xd3, 0xd3, 0xd3}));
  EXPECT_EQ(parse_colour("lightgray"), parse_colour("lightgrey"));
  EXPECT_EQ(parse_colour("red;white"), (Colour{0xff, 0, 0}));
  EXPECT_EQ(parse_colour("rgb(1,2,3)"), (Colour{1, 2, 3}));
  EXPECT_EQ(parse_colour("RGB( 1, 2, 255 )"), (Colour{1, 2, 255}));
  EXPECT_EQ(parse_colour("rgba(1,2,3,0.5)"), (Colour{1, 2, 3}));
  for (const char* text :
       {"", "#", "#12", "#12345", "#ggg", "rgb(1,2)", "rgb(1,2,300)", "rgb(1,2,3", "reddish", "ral 9010"})
    EXPECT_FALSE(parse_colour(text)) << text;
}

TEST(ParseColour, KnowsTheFirstAndTheLastName) {
  EXPECT_EQ(colour_of_name("aliceblue"), (Colour{0xf0, 0xf8, 0xff}));
  EXPECT_EQ(colour_of_name("rebeccapurple"), (Colour{0x66, 0x33, 0x99}));
  EXPECT_EQ(colour_of_name("yellowgreen"), (Colour{0x9a, 0xcd, 0x32}));
  EXPECT_FALSE(colour_of_name("AliceBlue"));
}

TEST(ParseRoofShape, TakesTheSchemesNamesInEitherSpelling) {
  for (std::size_t i = 0; i < model::kRoofShapeCount; ++i) {
    const model::RoofTraits& row = model::kRoofTraits[i];
    const RoofShape shape = row.is_tag_value ? static_cast<RoofShape>(i) : RoofShape::other;
    EXPECT_EQ(parse_roof_shape(row.name), shape);
    for (const std::string_view synonym : row.synonyms) {
      if (!synonym.empty()) {
        EXPECT_EQ(parse_roof_shape(synonym), shape) << synonym;
      }
    }
  }
  EXPECT_EQ(parse_roof_shape("berlin"), RoofShape::other) << "no value of the scheme";
  EXPECT_EQ(parse_roof_shape("half_hipped"), RoofShape::half_hipped);
  EXPECT_EQ(parse_roof_shape("Half Hipped"), RoofShape::half_hipped);
  EXPECT_EQ(parse_roof_shape("Gabled"), RoofShape::gabled);
  EXPECT_EQ(parse_roof_shape("pitched"), RoofShape::gabled);
  EXPECT_EQ(parse_roof_shape("shed"), RoofShape::skillion);
  EXPECT_EQ(parse_roof_shape("gabled;flat"), RoofShape::gabled);
  EXPECT_EQ(parse_roof_shape("zigzag"), RoofShape::other);
  EXPECT_FALSE(parse_roof_shape(" "));
}

TEST(ParseRoofOrientation, TakesTwoWords) {
  EXPECT_EQ(parse_roof_orientation("along"), model::RoofOrientation::along);
  EXPECT_EQ(parse_roof_orientation(" Across"), model::RoofOrientation::across);
  EXPECT_FALSE(parse_roof_orientation("NE"));
}

}  // namespace
}  // namespace blockrand::importers::osm
