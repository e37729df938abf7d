// What heights are above: said by the raster, by the user, or refused.
#include "pipeline/context/height_reference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "importers/elevation/terrain.h"
#include "pipeline/base/error.h"

namespace blockrand::context {
namespace {

using importers::elevation::TerrainDescription;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Kind = AskedReference::Kind;

TerrainDescription raster(std::string name = {}, std::string code = {}) {
  TerrainDescription d;
  d.path = "dem.tif";
  d.vertical_name = std::move(name);
  d.vertical_code = std::move(code);
  return d;
}

std::string refusal(const TerrainDescription* terrain, const std::string& asked) {
  try {
    choose_height_reference(terrain, read_height_reference(asked), false);
  } catch (const base::UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(HeightReference, ReadsWhatTheUserSays) {
  EXPECT_EQ(read_height_reference("").kind, Kind::unsaid);
  EXPECT_EQ(read_height_reference("Sea-Level").kind, Kind::sea_level);
  EXPECT_EQ(read_height_reference("ellipsoid").kind, Kind::ellipsoid);
  const AskedReference crs = read_height_reference("epsg:7837");
  EXPECT_EQ(crs.vertical_code, "EPSG:7837");
  EXPECT_EQ(crs.vertical_name, "DHHN2016 height");
  EXPECT_EQ(crs.metres_per_unit, 1.0);
  EXPECT_NEAR(*read_height_reference("EPSG:6360").metres_per_unit, 1200.0 / 3937, 1e-9);  // NAVD88 in feet
  for (const char* wrong :
       {"EPSG:25833", "EPSG:5555", "EPSG:", "EPSG:7837x", "7837", "tide", "EPSG:5715"})  // the last: depths
    EXPECT_THROW(read_height_reference(wrong), base::UsageError) << wrong;
}

TEST(HeightReference, IsAskedForWhereTheRasterIsSilent) {
  const TerrainDescription silent = raster();
  EXPECT_THAT(refusal(&silent, ""), HasSubstr("dem.tif: the raster does not say what its heights are above"));
  EXPECT_THAT(refusal(&silent, ""), HasSubstr("--terrain-height-reference"));
  EXPECT_EQ(refusal(&silent, "ellipsoid"), "accepted");
  EXPECT_THAT(refusal(nullptr, "ellipsoid"), HasSubstr("needs --terrain"));
  EXPECT_EQ(refusal(nullptr, ""), "accepted");
}

TEST(HeightReference, ClaimsACodeOnlyWhereItHoldsForMetres) {
  const TerrainDescription metres = raster("DHHN2016 height", "EPSG:7837"),
                           feet = raster("NAVD88 height (ftUS)", "EPSG:6360");
  EXPECT_EQ(choose_height_reference(&metres, {}, false).vertical_crs, "EPSG:7837");
  EXPECT_EQ(choose_height_reference(&feet, {}, false).vertical_crs, "");
  const TerrainDescription silent = raster();
  EXPECT_EQ(choose_height_reference(&silent, read_height_reference("sea-level"), false).vertical_crs, "");
  EXPECT_EQ(choose_height_reference(nullptr, {}, true).vertical_crs, "");
}

TEST(HeightReference, WarnsWhereRasterAndUserDisagree) {
  const TerrainDescription egm = raster("EGM96 height", "EPSG:5773");
  const HeightReference agreed = choose_height_reference(&egm, read_height_reference("EPSG:5773"), false);
  EXPECT_THAT(agreed.warnings, IsEmpty());
  EXPECT_EQ(agreed.vertical_crs, "EPSG:5773");
  const HeightReference other = choose_height_reference(&egm, read_height_reference("ellipsoid"), false);
  ASSERT_THAT(other.warnings, SizeIs(1));
  EXPECT_THAT(other.warnings[0],
              HasSubstr("EGM96 height (EPSG:5773) by its own words; taken for heights above the ellipsoid"));
  EXPECT_FALSE(other.raised_by);
  EXPECT_THAT(choose_height_reference(&egm, read_height_reference("sea-level"), false).warnings, IsEmpty());
  TerrainDescription above = raster();
  above.ellipsoidal = true;
  EXPECT_FALSE(choose_height_reference(&above, {}, false).raised_by);
  EXPECT_THAT(choose_height_reference(&above, read_height_reference("sea-level"), false).warnings, SizeIs(1));
}

TEST(HeightReference, RaisesByWhatPROJKnows) {
  const TerrainDescription silent = raster();
  const HeightReference sea = choose_height_reference(&silent, read_height_reference("sea-level"), false);
  if (!sea.raised_by) GTEST_SKIP() << georef::Geoid::remedy();
  EXPECT_THAT(sea.in_tiles, HasSubstr("raised to the ellipsoid by EGM96"));
  const double egm = sea.raised_by->undulation(16.37, 48.2).value();
  EXPECT_NEAR(egm, 44.8, 1);
  // Vienna's own heights: a shift of 156.68 m to the Adriatic, which PROJ knows, and 0.4 m to EVRF2000.
  const HeightReference vienna = choose_height_reference(&silent, read_height_reference("EPSG:8881"), false);
  ASSERT_TRUE(vienna.raised_by);
  if (!vienna.raised_by->stands_in()) GTEST_SKIP() << "PROJ has a grid";
  EXPECT_NEAR(vienna.raised_by->undulation(16.37, 48.2).value() - egm, 156.3, 0.5);
  EXPECT_THAT(vienna.in_tiles, HasSubstr("EGM96 in place of Vienna height"));
  EXPECT_EQ(vienna.raised_by->accuracy_m(), -1);
  EXPECT_THAT(vienna.warnings, SizeIs(1));
}

TEST(GroundWarning, SaysByHowMuchHousesLieWrong) {
  // EGM96: 39.6 m in Berlin (NGA's calculator), about -29 m at San Francisco, -106 m at its lowest place, south of India.
  EXPECT_THAT(ground_warning({13.40, 52.52}),
              HasSubstr("will lie 40 m below the sea level of the place, so at least that far"));
  EXPECT_THAT(ground_warning({-122.42, 37.77}),
              ::testing::ContainsRegex("will lie 3[0-9] m above the sea level of the place"));
  EXPECT_THAT(ground_warning({78.75, 4.75}), ::testing::ContainsRegex("will lie 10[0-9] m above the sea level"));
  EXPECT_THAT(ground_warning({13.40, 52.52}), HasSubstr("Give --ground-height or --terrain"));
  EXPECT_THAT(ground_warning({13.40, 52.52}), HasSubstr("how high the ground itself is, nothing says"));
}

TEST(HeightReference, AWordThatIsMeantIsNamed) {
  EXPECT_THAT(refusal(nullptr, "sealevel"), HasSubstr("Did you mean sea-level?"));
  EXPECT_THAT(refusal(nullptr, "elipsoid"), HasSubstr("Did you mean ellipsoid?"));
}

}  // namespace
}  // namespace blockrand::context
