// Rows and whole images against pictures that the tests paint.
#include "pipeline/observation/row_match.h"

#include <gdal.h>
#include <gtest/gtest.h>
#include <ogr_srs_api.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <random>

#include "pipeline/georef/crs.h"
#include "pipeline/observation/image_fit.h"

namespace blockrand::observation {
namespace {

using importers::imagery::AerialImage;
using model::Point2;

constexpr double kEast = 390'000, kNorth = 5'820'000, kPixel = 0.25;  // EPSG:25833, the picture's north-west corner
constexpr int kSide = 1200;

georef::Projection berlin() {
  const georef::GeoBox box{13.3, 52.4, 13.5, 52.6};
  return {georef::open_crs("EPSG:25833", box), box};
}

struct House {
  Point2 middle;
  double width, depth, angle, lean_x, lean_y;

  std::vector<Point2> ring(Point2 by = {}) const {
    const base::SinCos a = base::sin_cos(angle);
    std::vector<Point2> points;
    for (const auto& [u, v] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
      const double x = u * width / 2, y = v * depth / 2;
      points.push_back({middle.x + by.x + x * a.cos - y * a.sin, middle.y + by.y + x * a.sin + y * a.cos});
    }
    return points;
  }
  /// \param share  of the height: 1 is the roof
  bool covers(Point2 p, double share = 1) const {
    const base::SinCos a = base::sin_cos(angle);
    const double dx = p.x - middle.x - share * lean_x, dy = p.y - middle.y - share * lean_y;
    return std::fabs(dx * a.cos + dy * a.sin) < width / 2 && std::fabs(-dx * a.sin + dy * a.cos) < depth / 2;
  }
};

class Painted : public testing::Test {
 protected:
  void SetUp() override {
    GDALAllRegister();
    std::mt19937 random(3);
    std::uniform_real_distribution<double> jitter(-5, 5), size(7, 14), angle(0, 1.5);
    for (int k = 0; k < 49; ++k)
      houses_.push_back({{kEast + 50 + (k % 7) * 33 + jitter(random), kNorth - 50 - (k / 7) * 33 + jitter(random)},
                         size(random),
                         size(random),
                         angle(random),
                         0,
                         0});
  }
  void TearDown() override {
    if (!path_.empty()) std::filesystem::remove(path_);
  }

  /// The picture, as an image whose georeference is off by `by`.
  AerialImage paint(Point2 by = {}) {
    path_ = std::filesystem::temp_directory_path() /
            ("painted_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".tif");
    GDALDatasetH tif = GDALCreate(GDALGetDriverByName("GTiff"), path_.c_str(), kSide, kSide, 3, GDT_Byte, nullptr);
    std::array<double, 6> place{kEast + by.x, kPixel, 0, kNorth + by.y, 0, -kPixel};
    GDALSetGeoTransform(tif, place.data());
    OGRSpatialReferenceH crs = OSRNewSpatialReference(nullptr);
    OSRImportFromEPSG(crs, 25833);
    GDALSetSpatialRef(tif, crs);
    OSRDestroySpatialReference(crs);
    std::mt19937 random(4);
    std::vector<std::uint8_t> line(3 * kSide);
    for (int r = 0; r < kSide; ++r) {
      for (auto& v : line) v = static_cast<std::uint8_t>(80 + random() % 30);
      for (const House& h : houses_) {
        const double y = kNorth - (r + 0.5) * kPixel;
        if (std::fabs(y - h.middle.y) > 20) continue;
        for (int c = 0; c < kSide; ++c) {
          const Point2 p{kEast + (c + 0.5) * kPixel, y};
          bool wall = false;
          for (int share = 0; share < 10 && (h.lean_x != 0 || h.lean_y != 0); ++share)
            wall = wall || h.covers(p, share / 10.0);
          if (const int level = h.covers(p) ? 190 : wall ? 140 : 0; level > 0)
            for (int b = 0; b < 3; ++b)
              line[static_cast<std::size_t>(b * kSide + c)] = static_cast<std::uint8_t>(level - 30 * b);
        }
      }
      for (int b = 0; b < 3; ++b)
        EXPECT_EQ(GDALRasterIO(GDALGetRasterBand(tif, b + 1), GF_Write, 0, r, kSide, 1, line.data() + b * kSide, kSide,
                               1, GDT_Byte, 0, 0),
                  CE_None);
    }
    GDALClose(tif);
    return AerialImage({path_, {}, {}, {}});
  }

  static SearchedOutline searched(const House& house, Point2 by = {}) {
    SearchedOutline o;
    const std::vector<Point2> ring = house.ring(by);
    o.box = geometry::box_of(ring);
    add_pieces(ring, std::vector<double>(4, 1.0), o.pieces);
    return o;
  }
  static SearchedRow row_of(const House& house, Point2 by = {}) {
    return {{searched(house, by)}, {house.middle.x + by.x, house.middle.y + by.y}, 9};
  }

  std::vector<House> houses_;
  std::filesystem::path path_;
};

TEST_F(Painted, AHouseIsFoundWhereItIsSeen) {
  const AerialImage image = paint();
  const georef::Projection projection = berlin();
  const ImageWindows windows(image, projection, 0.2);
  for (std::size_t k = 0; k < houses_.size(); k += 5) {
    const Point2 by{0.3 * static_cast<double>(k % 9) - 1.2, 1.4 - 0.3 * static_cast<double>(k % 7)};
    const RowMatch m = match_row(row_of(houses_[k], by), windows, {}, 12);
    ASSERT_TRUE(m.seen);
    EXPECT_NEAR(m.shift.x, -by.x, 0.2);
    EXPECT_NEAR(m.shift.y, -by.y, 0.2);
    EXPECT_NEAR(m.turn, 0, 1);
    EXPECT_GT(m.best, m.second);
  }
}

TEST_F(Painted, TheLeanOfARoofIsNoMistakeOfTheMap) {
  houses_[24].lean_x = 2, houses_[24].lean_y = 1;
  const AerialImage image = paint();
  const georef::Projection projection = berlin();
  const ImageWindows windows(image, projection, 0.2);
  SearchedRow row = row_of(houses_[24]);
  EXPECT_NEAR(match_row(row, windows, {}, 12).shift.x, 2, 0.2);
  SearchedOutline& o = row.outlines[0];
  o.height = 8, o.per_metre = {0.2, 0.1}, o.lean = {1.6, 0.8}, o.uncertainty = 0.5;  // it is 10 m high
  const RowMatch m = match_row(row, windows, {}, 12);
  EXPECT_NEAR(m.shift.x, 0, 0.25);
  EXPECT_NEAR(m.shift.y, 0, 0.25);
  ASSERT_EQ(m.heights.size(), 1u);
  EXPECT_NEAR(m.heights[0], 10, 1.2);
  // Even where the height was guessed much too low: as mapped it stands as well as anywhere.
  o.height = 5, o.lean = {1, 0.5};
  const RowMatch low = match_row(row, windows, {}, 12);
  EXPECT_LT(low.best - low.here, 0.6 * low.deviation);
}

TEST_F(Painted, AHouseBeyondTheImageIsNotSeen) {
  const AerialImage image = paint();
  const georef::Projection projection = berlin();
  const ImageWindows windows(image, projection, 0.2);
  EXPECT_FALSE(match_row(row_of(houses_[0], {-400, 0}), windows, {}, 12).seen);
}

TEST_F(Painted, AnImageFitsWithinItsShiftAndNoFarther) {
  const georef::Projection projection = berlin();
  std::vector<SearchedOutline> outlines;
  for (const House& h : houses_) outlines.push_back(searched(h));
  for (const Point2 by : {Point2{0, 0}, Point2{1.5, -1}, Point2{11, 9}}) {
    const AerialImage image = paint(by);
    const ImageFit fit = fit_image(outlines, ImageWindows(image, projection, 0.5), 2);
    EXPECT_EQ(fit.state, by.x > 5 ? ImageState::misfit : ImageState::used) << fit.why;
    EXPECT_NEAR(fit.shift.x, by.x, 0.6);
    EXPECT_NEAR(fit.shift.y, by.y, 0.6);
    EXPECT_GT(fit.margin, 3);
  }
  // A few outlines decide nothing; those of another place fit nowhere.
  const AerialImage image = paint();
  const ImageWindows windows(image, projection, 0.5);
  EXPECT_EQ(fit_image(std::span(outlines).first(3), windows, 1).state, ImageState::undecided);
  std::mt19937 random(9);
  std::vector<SearchedOutline> others;
  for (House h : houses_) {
    h.middle.x += static_cast<double>(random() % 30), h.middle.y += static_cast<double>(random() % 30), h.angle += 0.5;
    others.push_back(searched(h));
  }
  EXPECT_EQ(fit_image(others, windows, 2).state, ImageState::misfit);
}

TEST_F(Painted, AWindowDoesNotDependOnWhatWasReadBefore) {
  const AerialImage image = paint();
  const georef::Projection projection = berlin();
  const geometry::PlanBox box{{kEast + 40, kNorth - 120}, {kEast + 110, kNorth - 60}};
  const Patch first = ImageWindows(image, projection, 0.2).window(box, 3);
  const ImageWindows windows(image, projection, 0.2);
  for (int k = 0; k < 30; ++k) {
    const double at = 7.0 * k;
    windows.window({{kEast + at, kNorth - at - 20}, {kEast + at + 20, kNorth - at}}, 2);
  }
  const Patch again = windows.window(box, 3);
  EXPECT_EQ(first.red, again.red);
  EXPECT_EQ(first.valid, again.valid);
  EXPECT_EQ(first.width, again.width);
  const Patch whole = image.patch(projection, 0.2, std::llround(first.west / 0.2), -std::llround(first.north / 0.2),
                                  first.width, first.height);
  EXPECT_EQ(first.green, whole.green);
}

}  // namespace
}  // namespace blockrand::observation
