#include "pipeline/observation/roof_view.h"

#include <gdal.h>
#include <gtest/gtest.h>
#include <ogr_srs_api.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <random>

#include "importers/imagery/aerial_image.h"

namespace blockrand::observation {
namespace {

using model::Colour;
using model::Point2;

constexpr double kEast = 390'000, kNorth = 5'820'000, kPixel = 0.2;  // m, of the picture's corner
constexpr int kSide = 300;                                           // pixels: 60 m

class RoofPicture : public testing::Test {
 protected:
  static void SetUpTestSuite() { GDALAllRegister(); }
  void TearDown() override { std::filesystem::remove(path_); }

  /// Looks at a roof of 20 m x 12 m in the middle of a picture, turned by `angle`. \param paint  colour at (u, v) m from
  /// the roof's middle, along and across its longer side
  RoofView look(const std::function<Colour(double, double)>& paint, double angle = 0) {
    path_ = std::filesystem::temp_directory_path() /
            ("roof_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".tif");
    const double c = std::cos(angle), s = std::sin(angle);
    const Point2 middle{kEast + 30, kNorth - 30};
    GDALDatasetH tif = GDALCreate(GDALGetDriverByName("GTiff"), path_.c_str(), kSide, kSide, 3, GDT_Byte, nullptr);
    std::array<double, 6> place{kEast, kPixel, 0, kNorth, 0, -kPixel};
    GDALSetGeoTransform(tif, place.data());
    OGRSpatialReferenceH crs = OSRNewSpatialReference(nullptr);
    OSRImportFromEPSG(crs, 25833);
    GDALSetSpatialRef(tif, crs);
    OSRDestroySpatialReference(crs);
    std::mt19937 random(5);
    std::vector<std::uint8_t> line(3 * kSide);
    for (int r = 0; r < kSide; ++r) {
      for (int k = 0; k < kSide; ++k) {
        const double x = kEast + (k + 0.5) * kPixel - middle.x, y = kNorth - (r + 0.5) * kPixel - middle.y;
        const double u = x * c + y * s, v = -x * s + y * c;
        const bool roof = std::fabs(u) < 10 && std::fabs(v) < 6;
        const Colour colour = roof ? paint(u, v) : Colour{70, 100, 60};
        const std::array<std::uint8_t, 3> bands{colour.r, colour.g, colour.b};
        for (int b = 0; b < 3; ++b)
          line[static_cast<std::size_t>(b * kSide + k)] = static_cast<std::uint8_t>(
              std::clamp<int>(bands[static_cast<std::size_t>(b)] + static_cast<int>(random() % 9) - 4, 0, 255));
      }
      for (int b = 0; b < 3; ++b)
        EXPECT_EQ(GDALRasterIO(GDALGetRasterBand(tif, b + 1), GF_Write, 0, r, kSide, 1, line.data() + b * kSide, kSide,
                               1, GDT_Byte, 0, 0),
                  CE_None);
    }
    GDALClose(tif);
    model::Polygon plan;
    for (const auto& [u, v] : {std::pair(-10, -6), std::pair(10, -6), std::pair(10, 6), std::pair(-10, 6)})
      plan.outer.points.push_back({middle.x + u * c - v * s, middle.y + u * s + v * c});
    plan.outer.nodes.assign(4, 0);
    const georef::GeoBox box{13.3, 52.4, 13.5, 52.6};
    const georef::Projection projection(georef::open_crs("EPSG:25833", box), box);
    const importers::imagery::AerialImage image({path_, {}, {}, {}});
    const ImageWindows windows(image, projection, kPixel);
    return look_at_roof({&plan, 1}, windows);
  }

  std::filesystem::path path_;
};

constexpr Colour kRed{180, 90, 70}, kShade{95, 48, 40}, kGrey{140, 140, 142};

void expect_near(const std::optional<Colour>& colour, Colour wanted) {
  ASSERT_TRUE(colour);
  EXPECT_NEAR(colour->r, wanted.r, 4);
  EXPECT_NEAR(colour->g, wanted.g, 4);
  EXPECT_NEAR(colour->b, wanted.b, 4);
}

TEST_F(RoofPicture, TheColourIsThatOfTheSunlitPart) {
  expect_near(look([](double, double v) { return v < 0 ? kRed : kShade; }).colour, kRed);
  // A tree's shadow over two thirds, a tree over some.
  expect_near(look([](double u, double v) {
                return u < 3 ? kShade : v > 4 ? Colour{60, 110, 50} : kRed;
              }).colour,
              kRed);
  // A small bright thing is not the roof.
  expect_near(look([](double u, double v) {
                return std::fabs(u) < 1 && std::fabs(v) < 1 ? Colour{250, 250, 250} : kGrey;
              }).colour,
              kGrey);
  expect_near(look([](double, double) { return Colour{80, 130, 60}; }).colour, {80, 130, 60});
}

TEST_F(RoofPicture, ARidgeIsWhereBothSlopesMeet) {
  for (const double angle : {0.0, 0.4, 1.1}) {
    const RoofView view = look([](double, double v) { return v < 0 ? kRed : kShade; }, angle);
    EXPECT_NEAR(view.long_side, 20, 2);
    EXPECT_NEAR(view.short_side, 12, 2);
    EXPECT_NEAR(view.ridges[0].angle, angle * 57.29578, 0.5);
    EXPECT_LT(view.ridges[0].contrast, -0.3) << "its right side is the brighter one";
    EXPECT_GT(view.ridges[0].consistency, 0.95);
    EXPECT_LT(view.ridges[0].offset, 0.1);
    EXPECT_LT(std::fabs(view.ridges[1].contrast), 0.05);
  }
}

TEST_F(RoofPicture, TheSunTellsSlopesFromPaint) {
  // Of three houses the sides to the south are bright; the fourth is even, the fifth bright on its northern side.
  std::vector<RoofView> roofs;
  for (const double angle : {0.0, 0.3, -0.4})
    roofs.push_back(look([](double, double v) { return v < 0 ? kRed : kShade; }, angle));
  roofs.push_back(look([](double, double) { return kGrey; }));
  const std::optional<double> sun = sun_azimuth(roofs);
  ASSERT_TRUE(sun);
  EXPECT_NEAR(*sun, 180, 8);
  judge_roof(roofs[0], *sun);
  EXPECT_EQ(roofs[0].form, RoofForm::pitched);
  ASSERT_TRUE(roofs[0].ridge);
  EXPECT_NEAR(*roofs[0].ridge, 90, 1);
  judge_roof(roofs[3], *sun);
  EXPECT_NE(roofs[3].form, RoofForm::pitched);
  EXPECT_FALSE(roofs[3].ridge);
  RoofView odd = look([](double, double v) { return v > 0 ? kGrey : Colour{75, 75, 77}; });
  judge_roof(odd, *sun);
  EXPECT_NE(odd.form, RoofForm::pitched);
}

TEST_F(RoofPicture, RoofsThatDoNotAgreeTellNoSun) {
  std::vector<RoofView> roofs;
  for (const double angle : {0.0, 1.5708, 3.14159, 4.71239})
    roofs.push_back(look([](double, double v) { return v < 0 ? kRed : kShade; }, angle));
  EXPECT_FALSE(sun_azimuth(roofs));
  EXPECT_FALSE(sun_azimuth({}));
}

}  // namespace
}  // namespace blockrand::observation
