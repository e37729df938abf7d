// Single walls against a house that the test paints.
#include "pipeline/observation/edge_refinement.h"

#include <gdal.h>
#include <gtest/gtest.h>
#include <ogr_srs_api.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <random>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/georef/crs.h"

namespace blockrand::observation {
namespace {

using importers::imagery::AerialImage;
using model::Point2;

constexpr double kEast = 390'000, kNorth = 5'820'000, kPixel = 0.2;  // EPSG:25833, the picture's north-west corner
constexpr int kSide = 300;

std::vector<Point2> at(const std::vector<Point2>& ring) {
  std::vector<Point2> out;
  for (const Point2 p : ring) out.push_back({kEast + 20 + p.x, kNorth - 40 + p.y});
  return out;
}

class PaintedHouse : public testing::Test {
 protected:
  void TearDown() override {
    if (!path_.empty()) std::filesystem::remove(path_);
  }

  /// Bright on darker ground with noise.
  void paint(const std::vector<Point2>& house) {
    GDALAllRegister();
    path_ = std::filesystem::temp_directory_path() /
            ("painted_house_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".tif");
    GDALDatasetH tif = GDALCreate(GDALGetDriverByName("GTiff"), path_.c_str(), kSide, kSide, 3, GDT_Byte, nullptr);
    std::array<double, 6> place{kEast, kPixel, 0, kNorth, 0, -kPixel};
    GDALSetGeoTransform(tif, place.data());
    OGRSpatialReferenceH crs = OSRNewSpatialReference(nullptr);
    OSRImportFromEPSG(crs, 25833);
    GDALSetSpatialRef(tif, crs);
    OSRDestroySpatialReference(crs);
    std::mt19937 random(4);
    const std::vector<Point2> ring = at(house);
    for (int r = 0; r < kSide; ++r) {
      std::vector<std::uint8_t> line(3 * kSide);
      for (int c = 0; c < kSide; ++c) {
        const bool roof = geometry::contains(ring, {kEast + (c + 0.5) * kPixel, kNorth - (r + 0.5) * kPixel});
        for (int b = 0; b < 3; ++b)
          line[static_cast<std::size_t>(b * kSide + c)] =
              static_cast<std::uint8_t>((roof ? 180 - 30 * b : 80 + 10 * b) + static_cast<int>(random() % 20));
      }
      for (int b = 0; b < 3; ++b)
        EXPECT_EQ(GDALRasterIO(GDALGetRasterBand(tif, b + 1), GF_Write, 0, r, kSide, 1, line.data() + b * kSide, kSide,
                               1, GDT_Byte, 0, 0),
                  CE_None);
    }
    GDALClose(tif);
  }

  RefinedOutline refine(const std::vector<Point2>& mapped, double bound = 1, Point2 lean = {}) {
    const AerialImage image({path_, {}, {}, {}});
    const georef::GeoBox box{13.3, 52.4, 13.5, 52.6};
    const georef::Projection projection(georef::open_crs("EPSG:25833", box), box);
    const ImageWindows windows(image, projection, 0.2);
    return refine_edges({.rings = {at(mapped)}, .fixed = {}, .seen = lean, .lean = lean, .doubt = {}}, windows, bound);
  }

  std::filesystem::path path_;
};

const std::vector<Point2> kHouse = {{0, 0}, {14, 0}, {14, 6}, {8, 6}, {8, 11}, {0, 11}};
std::vector<Point2> with_east_wall_at(double x) { return {{0, 0}, {x, 0}, {x, 6}, {8, 6}, {8, 11}, {0, 11}}; }

TEST_F(PaintedHouse, AWallThatIsOffIsFound) {
  paint(kHouse);
  for (const double off : {-0.8, -0.7, 0.8}) {
    const RefinedOutline out = refine(with_east_wall_at(14 + off));
    ASSERT_EQ(out.state, RefinementState::refined) << off << ": " << out.reason;
    EXPECT_EQ(out.walls, 1u);
    EXPECT_NEAR(out.largest, std::fabs(off), 0.12);
    EXPECT_GT(out.after, out.before);
    const std::vector<Point2> right = at(kHouse);
    for (std::size_t i = 0; i < right.size(); ++i) {
      EXPECT_NEAR(out.to[0][i].x, right[i].x, 0.12) << off << ", corner " << i;
      EXPECT_NEAR(out.to[0][i].y, right[i].y, 0.001) << off << ", corner " << i;
    }
  }
}

TEST_F(PaintedHouse, AHouseThatIsRightStays) {
  paint(kHouse);
  EXPECT_EQ(refine(kHouse).state, RefinementState::left_alone);
  EXPECT_EQ(refine(with_east_wall_at(14.15)).state, RefinementState::left_alone) << "an error of the search";
}

TEST_F(PaintedHouse, WhatAllWallsHaveInCommonIsNoFaultOfOne) {
  // A roof with eaves of 0.4 m; a whole house that is off by a third of a metre.
  paint({{-0.4, -0.4}, {14.4, -0.4}, {14.4, 6.4}, {8.4, 6.4}, {8.4, 11.4}, {-0.4, 11.4}});
  EXPECT_EQ(refine(kHouse).state, RefinementState::left_alone);
  std::vector<Point2> off = kHouse;
  for (Point2& p : off) p.x += 0.3, p.y -= 0.2;
  paint(off);
  EXPECT_EQ(refine(kHouse).state, RefinementState::left_alone);
}

TEST_F(PaintedHouse, BeyondTheBoundNothingIsShifted) {
  paint(kHouse);
  EXPECT_EQ(refine(with_east_wall_at(14.8), 0.5).state, RefinementState::left_alone);
  EXPECT_EQ(refine(with_east_wall_at(15.6), 1).state, RefinementState::left_alone);
}

TEST_F(PaintedHouse, WhereRoofsLeanFarOneWallIsNotSure) {
  paint(kHouse);
  std::vector<Point2> ground = with_east_wall_at(14.8);
  for (Point2& p : ground) p.x -= 1.2, p.y -= 1.2;
  EXPECT_EQ(refine(ground, 1, {1.2, 1.2}).state, RefinementState::left_alone);
}

TEST_F(PaintedHouse, WhatTheImageDoesNotShowIsToldSo) {
  paint(kHouse);
  std::vector<Point2> beyond = kHouse;
  for (Point2& p : beyond) p.x += 500;
  EXPECT_EQ(refine(beyond).reason, "the image does not show its walls");
  EXPECT_EQ(refine({{0, 0}, {1.5, 0}, {1.5, 1.5}, {0, 1.5}}).state, RefinementState::left_alone);
}

}  // namespace
}  // namespace blockrand::observation
