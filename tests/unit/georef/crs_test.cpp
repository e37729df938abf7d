// Which CRS a build gets, and which ones are refused.
#include "pipeline/georef/crs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "pipeline/base/error.h"
#include "pipeline/georef/projection.h"

namespace blockrand::georef {
namespace {

using ::testing::HasSubstr;

constexpr GeoBox kMunich{11.5, 48.1, 11.6, 48.2};
constexpr GeoBox kAmsterdam{4.8, 52.3, 4.9, 52.4};

std::string refusal(const std::string& code, const GeoBox& extent) {
  try {
    open_crs(code, extent);
  } catch (const base::UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ChooseCrs, TakesEtrs89UtmInEurope) {
  EXPECT_EQ(choose_crs(13.4, 52.5), "EPSG:25833");    // Berlin
  EXPECT_EQ(choose_crs(12.37, 51.34), "EPSG:25833");  // Leipzig
  EXPECT_EQ(choose_crs(7.42, 43.74), "EPSG:25832");   // Monaco
  EXPECT_EQ(choose_crs(-9.14, 38.7), "EPSG:25829");   // Lisbon
  EXPECT_EQ(choose_crs(-3.7, 40.4), "EPSG:25830");    // Madrid
  EXPECT_EQ(choose_crs(14.5, 35.9), "EPSG:25833");    // Malta
  EXPECT_EQ(choose_crs(12.6, 35.5), "EPSG:25833");    // Lampedusa
  EXPECT_EQ(choose_crs(33.4, 35.1), "EPSG:25836");    // Cyprus
  EXPECT_EQ(choose_crs(28.2, 36.44), "EPSG:25835");   // Rhodes
  EXPECT_EQ(choose_crs(26.97, 37.75), "EPSG:25835");  // Samos
  EXPECT_EQ(choose_crs(26.14, 38.37), "EPSG:25835");  // Chios
  EXPECT_EQ(choose_crs(26.55, 39.1), "EPSG:25835");   // Mytilini
  EXPECT_EQ(choose_crs(24.75, 59.4), "EPSG:25835");   // Tallinn
}

TEST(ChooseCrs, KeepsUtmsNordicExceptions) {
  EXPECT_EQ(choose_crs(5.3, 60.4), "EPSG:25832");   // Bergen: zone 31 by longitude
  EXPECT_EQ(choose_crs(15.6, 78.2), "EPSG:25833");  // Longyearbyen
  EXPECT_EQ(choose_crs(20.9, 78.2), "EPSG:25833");  // zone 34 by longitude
}

TEST(ChooseCrs, TakesWgs84UtmElsewhere) {
  EXPECT_EQ(choose_crs(-74.0, 40.7), "EPSG:32618");   // New York
  EXPECT_EQ(choose_crs(32.58, 0.32), "EPSG:32636");   // Kampala
  EXPECT_EQ(choose_crs(151.2, -33.9), "EPSG:32756");  // Sydney
  EXPECT_EQ(choose_crs(3.06, 36.75), "EPSG:32631");   // Algiers
  EXPECT_EQ(choose_crs(10.18, 36.8), "EPSG:32632");   // Tunis
  EXPECT_EQ(choose_crs(-5.8, 35.77), "EPSG:32630");   // Tangier
  EXPECT_EQ(choose_crs(-21.9, 64.1), "EPSG:32627");   // Reykjavik
  EXPECT_EQ(choose_crs(27.26, 37.86), "EPSG:32635");  // Kusadasi
  EXPECT_EQ(choose_crs(28.98, 41.01), "EPSG:32635");  // Istanbul
  EXPECT_EQ(choose_crs(32.85, 39.9), "EPSG:32636");   // Ankara
  EXPECT_EQ(choose_crs(180, 0), "EPSG:32660");
  EXPECT_EQ(choose_crs(-180, -1), "EPSG:32701");
  EXPECT_EQ(choose_crs(0, -90), "EPSG:32731");
}

TEST(OpenCrs, NamesTheOperationAndItsAccuracy) {
  const Crs crs = open_crs("epsg:25833", {13.3, 52.4, 13.5, 52.6});
  EXPECT_EQ(crs.authority_code, "EPSG:25833");
  EXPECT_EQ(crs.name, "ETRS89 / UTM zone 33N");
  EXPECT_THAT(crs.operation, HasSubstr("ETRS89 to WGS 84"));
  EXPECT_EQ(crs.accuracy_m, 1);
  EXPECT_EQ(open_crs("25833", {13.3, 52.4, 13.5, 52.6}).authority_code, "EPSG:25833");
  EXPECT_EQ(open_crs("EPSG:32633", {13.3, 52.4, 13.5, 52.6}).accuracy_m, 0);  // no change of datum
}

TEST(OpenCrs, FindsTheDatumGridOfGaussKrueger) {
  const Crs crs = open_crs("EPSG:31468", kMunich);
  EXPECT_THAT(crs.pipeline, HasSubstr("BETA2007"));
  // Frauenkirche in Munich, published in both systems to a metre: the datum shift is there (without it, > 100 m).
  const Projection projection(crs, kMunich);
  EXPECT_FALSE(projection.portable());
  const model::Point2 p = projection.forward(11.5735, 48.1386);
  EXPECT_NEAR(p.x, 4468290, 120);
  EXPECT_NEAR(p.y, 5333360, 320);
}

TEST(OpenCrs, KnowsTheDutchSystem) {
  const Projection projection(open_crs("EPSG:28992", kAmsterdam), kAmsterdam);
  // The origin of RD is the tower of Our Lady in Amersfoort, (155000, 463000).
  const model::Point2 p = projection.forward(5.387206, 52.155174);
  EXPECT_NEAR(p.x, 155000, 3);
  EXPECT_NEAR(p.y, 463000, 3);
}

TEST(OpenCrs, RefusesWithARemedy) {
  EXPECT_THAT(refusal("EPSG:4326", kAmsterdam), HasSubstr("not a projected system"));
  EXPECT_THAT(refusal("EPSG:4326", kAmsterdam), HasSubstr("EPSG:25831"));
  EXPECT_THAT(refusal("EPSG:2263", {-74, 40.6, -73.9, 40.8}), HasSubstr("US survey foot"));
  EXPECT_THAT(refusal("EPSG:5555", kMunich), HasSubstr("EPSG:25832"));
  EXPECT_THAT(refusal("EPSG:4979", kMunich), HasSubstr("not a projected system"));
  EXPECT_THAT(refusal("EPSG:3413", {8, 80, 9, 81}), HasSubstr("east and north"));
  EXPECT_THAT(refusal("EPSG:2048", {19, -34, 19.1, -33}), HasSubstr("east and north"));
  EXPECT_THAT(refusal("EPSG:999999", kMunich), HasSubstr("unknown"));
  for (const char* garbage :
       {"", "garbage", "EPSG:", "EPSG:12x", "EPSG:99999999999", "+proj=utm +zone=33", "EPSG:-1"}) {
    EXPECT_THAT(refusal(garbage, kMunich), HasSubstr("is not an EPSG code")) << garbage;
  }
}

TEST(OpenCrs, RefusesBallparkOperations) {
  // Far from Germany no datum shift to DHDN is known.
  EXPECT_THAT(refusal("EPSG:31468", {100, 30, 101, 31}), HasSubstr("ballpark"));
}

TEST(CheckCrs, TellsWithoutAPlaceWhatCanBeNone) {
  const auto told = [](const char* code) {
    try {
      check_crs(code);
    } catch (const base::UsageError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_EQ(told("EPSG:25833"), "nothing");
  EXPECT_EQ(told("EPSG:32760"), "nothing") << "whether it suits the place is said when that is known";
  EXPECT_THAT(told("EPSG:99999"), testing::HasSubstr("unknown to PROJ"));
  EXPECT_THAT(told("EPSG:4326"), testing::HasSubstr("not a projected system"));
  EXPECT_THAT(told("EPSG:5773"), testing::HasSubstr("not a projected system")) << "heights alone";
  EXPECT_THAT(told("EPSG:2263"), testing::HasSubstr("not in metres"));
  EXPECT_THAT(told("EPSG:4326"), testing::HasSubstr("or leave --crs out: the UTM zone of the extract is chosen then"));
}

}  // namespace
}  // namespace blockrand::georef
