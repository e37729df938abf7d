// Patches of small images that the tests write: right colours, right place, whatever the kind of file.
#include "importers/imagery/aerial_image.h"

#include <cpl_conv.h>
#include <gdal.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_srs_api.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "pipeline/base/error.h"
#include "pipeline/georef/crs.h"

namespace blockrand::importers::imagery {
namespace {

using testing::HasSubstr;

constexpr double kEast = 390000, kNorth = 5820000;  // EPSG:25833, in Berlin

georef::Projection berlin() {
  const georef::GeoBox box{13.3, 52.4, 13.5, 52.6};
  return {georef::open_crs("EPSG:25833", box), box};
}

struct Recipe {
  std::string name = "a.tif", driver = "GTiff";
  int width = 64, height = 48, bands = 3;
  GDALDataType type = GDT_Byte;
  std::array<double, 6> place{kEast, 0.25, 0, kNorth, 0, -0.25};
  int epsg = 25833;  ///< 0: none
  std::vector<GDALColorInterp> meaning{};
  std::optional<double> nodata{};
  std::function<double(int band, int column, int row)> value = [](int band, int column, int row) {
    return band == 0 ? 4 * column : band == 1 ? 5 * row : 100;
  };
  std::function<void(GDALDatasetH)> besides = [](GDALDatasetH) {};
};

class Images : public testing::Test {
 protected:
  void SetUp() override {
    GDALAllRegister();
    folder_ = std::filesystem::temp_directory_path() /
              ("aerial_image_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const Recipe& recipe) const {
    const std::string path = folder_ / recipe.name;
    GDALDatasetH memory =
        GDALCreate(GDALGetDriverByName("MEM"), "", recipe.width, recipe.height, recipe.bands, recipe.type, nullptr);
    std::array<double, 6> place = recipe.place;
    GDALSetGeoTransform(memory, place.data());
    if (recipe.epsg != 0) {
      OGRSpatialReferenceH crs = OSRNewSpatialReference(nullptr);
      OSRImportFromEPSG(crs, recipe.epsg);
      OSRSetAxisMappingStrategy(crs, OAMS_TRADITIONAL_GIS_ORDER);
      GDALSetSpatialRef(memory, crs);
      OSRDestroySpatialReference(crs);
    }
    std::vector<double> line(static_cast<std::size_t>(recipe.width));
    for (int b = 0; b < recipe.bands; ++b) {
      GDALRasterBandH band = GDALGetRasterBand(memory, b + 1);
      if (static_cast<std::size_t>(b) < recipe.meaning.size())
        GDALSetRasterColorInterpretation(band, recipe.meaning[static_cast<std::size_t>(b)]);
      if (recipe.nodata) GDALSetRasterNoDataValue(band, *recipe.nodata);
      for (int r = 0; r < recipe.height; ++r) {
        for (int c = 0; c < recipe.width; ++c) line[static_cast<std::size_t>(c)] = recipe.value(b, c, r);
        EXPECT_EQ(GDALRasterIO(band, GF_Write, 0, r, recipe.width, 1, line.data(), recipe.width, 1, GDT_Float64, 0, 0),
                  CE_None);
      }
    }
    recipe.besides(memory);
    GDALDatasetH copy =
        GDALCreateCopy(GDALGetDriverByName(recipe.driver.c_str()), path.c_str(), memory, 0, nullptr, nullptr, nullptr);
    EXPECT_NE(copy, nullptr) << path;
    if (copy != nullptr) GDALClose(copy);
    GDALClose(memory);
    return path;
  }

  std::string refusal(const std::string& path) const {
    try {
      const AerialImage image({path, {}, {}, {}});
    } catch (const base::InputError& error) {
      return error.what();
    }
    return "it was read";
  }

  std::filesystem::path folder_;
};

/// The patch of exactly the pixels of a recipe's default place.
Patch whole(const AerialImage& image, int width = 64, int height = 48) {
  return image.patch(berlin(), 0.25, std::llround(kEast * 4), -std::llround(kNorth * 4), width, height);
}

TEST_F(Images, APatchOnThePixelsOfTheImageHasThem) {
  const AerialImage image({write({}), {}, {}, {}});
  EXPECT_NEAR(image.describe().pixel_m, 0.25, 0.001);
  EXPECT_EQ(image.describe().crs_code, "EPSG:25833");
  const Patch p = whole(image);
  EXPECT_EQ(p.west, kEast);
  EXPECT_EQ(p.north, kNorth);
  for (int r = 0; r < 48; ++r)
    for (int c = 0; c < 64; ++c) {
      const auto i = static_cast<std::size_t>(r * 64 + c);
      ASSERT_EQ(p.valid[i], 1) << c << " " << r;
      ASSERT_EQ(p.red[i], 4 * c);
      ASSERT_EQ(p.green[i], 5 * r);
      ASSERT_EQ(p.blue[i], 100);
    }
}

TEST_F(Images, WhatLiesOutsideIsNotValid) {
  const AerialImage image({write({}), {}, {}, {}});
  const Patch p = image.patch(berlin(), 0.25, std::llround(kEast * 4) - 10, -std::llround(kNorth * 4) - 7, 84, 62);
  for (int r = 0; r < 62; ++r)
    for (int c = 0; c < 84; ++c)
      ASSERT_EQ(p.valid[static_cast<std::size_t>(r * 84 + c)] != 0, c >= 10 && c < 74 && r >= 7 && r < 55)
          << c << " " << r;
}

/// A ramp along the image's rows in another CRS, turned against the grid: its value tells the place.
TEST_F(Images, AnotherReferenceSystemAndATurnedImage) {
  const double cosine = std::cos(0.3), sine = std::sin(0.3);
  Recipe recipe;
  recipe.width = recipe.height = 400;
  recipe.epsg = 3068;
  recipe.place = {24000, 0.25 * cosine, 0.25 * sine, 21000, 0.25 * sine, -0.25 * cosine};
  recipe.value = [](int band, int column, int row) { return band == 0 ? 0.5 * column : band == 1 ? 0.5 * row : 7; };
  const AerialImage image({write(recipe), {}, {}, {}});
  // The middle of the image, through PROJ by hand.
  const georef::Transform soldner("EPSG:4326", "EPSG:3068", image.describe().area);
  const auto corner = [&](double column, double row) {
    return model::Point2{recipe.place[0] + recipe.place[1] * column + recipe.place[2] * row,
                         recipe.place[3] + recipe.place[4] * column + recipe.place[5] * row};
  };
  const model::Point2 lonlat = soldner.inverse(corner(200.5, 120.5));
  const model::Point2 here = berlin().forward(lonlat.x, lonlat.y);
  const Patch p = image.patch(berlin(), 0.25, static_cast<long long>(std::floor(here.x * 4)) - 8,
                              static_cast<long long>(std::floor(-here.y * 4)) - 8, 17, 17);
  const auto middle = static_cast<std::size_t>(8 * 17 + 8);
  ASSERT_EQ(p.valid[middle], 1);
  // The centre of that pixel is at most half a pixel from the place: a quarter of a grey level, and rounding.
  EXPECT_NEAR(p.red[middle], 100, 1.5);
  EXPECT_NEAR(p.green[middle], 60, 1.5);
}

TEST_F(Images, APatchDoesNotDependOnItsDivision) {
  Recipe recipe;
  recipe.width = recipe.height = 700;
  recipe.epsg = 3068;
  recipe.place = {24000, 0.1, 0, 21000, 0, -0.1};
  recipe.value = [](int band, int column, int row) { return (column * 37 + row * 101 + band * 53) % 256; };
  const AerialImage image({write(recipe), {}, {}, {}});
  const georef::GeoBox area = image.describe().area;
  const model::Point2 middle = berlin().forward(area.centre().lon, area.centre().lat);
  const auto column = static_cast<long long>(middle.x * 4) - 60, row = static_cast<long long>(-middle.y * 4) - 60;
  const Patch all = image.patch(berlin(), 0.25, column, row, 120, 120);
  int seen = 0;
  std::vector<std::thread> threads;
  std::array<Patch, 9> parts;
  for (int k = 0; k < 9; ++k)
    threads.emplace_back([&, k] {
      const AerialImage& again = image;
      parts[static_cast<std::size_t>(k)] =
          again.patch(berlin(), 0.25, column + 40 * (k % 3), row + 40 * (k / 3), 40, 40);
    });
  for (std::thread& t : threads) t.join();
  for (int r = 0; r < 120; ++r)
    for (int c = 0; c < 120; ++c) {
      const Patch& part = parts[static_cast<std::size_t>(r / 40 * 3 + c / 40)];
      const auto i = static_cast<std::size_t>(r * 120 + c), k = static_cast<std::size_t>(r % 40 * 40 + c % 40);
      ASSERT_EQ(all.valid[i], part.valid[k]);
      ASSERT_EQ(all.red[i], part.red[k]) << c << " " << r;
      ASSERT_EQ(all.blue[i], part.blue[k]);
      seen += all.valid[i];
    }
  EXPECT_GT(seen, 10000);
}

TEST_F(Images, FinePixelsAreAveraged) {
  Recipe recipe;
  recipe.place = {kEast, 0.0625, 0, kNorth, 0, -0.0625};
  recipe.value = [](int, int column, int row) { return (column + row) % 2 == 0 ? 200 : 100; };
  const AerialImage image({write(recipe), {}, {}, {}});
  const Patch p = image.patch(berlin(), 0.25, std::llround(kEast * 4), -std::llround(kNorth * 4), 16, 12);
  for (std::size_t i = 0; i < p.red.size(); ++i) {
    ASSERT_EQ(p.valid[i], 1);
    ASSERT_EQ(p.red[i], 150);
  }
}

TEST_F(Images, NodataAndBlackRoofs) {
  Recipe recipe;
  recipe.nodata = 0;
  recipe.value = [](int band, int column, int) { return column < 20 ? 0 : column < 40 && band == 0 ? 0 : 50; };
  const Patch p = whole(AerialImage({write(recipe), {}, {}, {}}));
  EXPECT_EQ(p.valid[5], 0);
  EXPECT_EQ(p.valid[30], 1);  // black in one band only
  EXPECT_EQ(p.valid[50], 1);
}

TEST_F(Images, FourthBands) {
  Recipe alpha;
  alpha.bands = 4;
  alpha.meaning = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand};
  alpha.value = [](int band, int column, int) { return band < 3 ? 90 : column < 32 ? 0 : 255; };
  const AerialImage masked({write(alpha), {}, {}, {}});
  EXPECT_FALSE(masked.describe().infrared);
  EXPECT_EQ(whole(masked).valid[5], 0);
  EXPECT_EQ(whole(masked).valid[50], 1);
  Recipe near;
  near.name = "b.tif";
  near.bands = 4;
  near.meaning = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_Undefined};
  near.value = [](int band, int, int) { return 10 * (band + 1); };
  const AerialImage infrared({write(near), {}, {}, {}});
  ASSERT_TRUE(infrared.describe().infrared);
  EXPECT_EQ(whole(infrared).infrared[100], 40);
  EXPECT_EQ(whole(infrared).blue[100], 30);
}

TEST_F(Images, GreyPaletteAndSixteenBits) {
  Recipe grey;
  grey.bands = 1;
  EXPECT_EQ(whole(AerialImage({write(grey), {}, {}, {}})).blue[10], 40);
  Recipe palette;
  palette.name = "p.tif";
  palette.bands = 1;
  palette.value = [](int, int column, int) { return column % 2; };
  palette.besides = [](GDALDatasetH dataset) {
    GDALColorTableH table = GDALCreateColorTable(GPI_RGB);
    const GDALColorEntry roof{180, 60, 40, 255}, tree{20, 90, 30, 255};
    GDALSetColorEntry(table, 0, &roof);
    GDALSetColorEntry(table, 1, &tree);
    GDALSetRasterColorTable(GDALGetRasterBand(dataset, 1), table);
    GDALDestroyColorTable(table);
  };
  const AerialImage indexed({write(palette), {}, {}, {}});
  EXPECT_EQ(indexed.describe().bands, 3);
  EXPECT_EQ(whole(indexed).red[0], 180);
  EXPECT_EQ(whole(indexed).green[1], 90);
  Recipe deep;
  deep.name = "d.tif";
  deep.type = GDT_UInt16;
  deep.value = [](int, int column, int) { return 1000 + 100 * column; };
  const AerialImage sixteen({write(deep), {}, {}, {}});
  EXPECT_EQ(sixteen.describe().bits, 16);
  const Patch p = whole(sixteen);
  EXPECT_LE(p.red[0], 1);
  EXPECT_GE(p.red[63], 254);
  EXPECT_NEAR(p.red[32], 128, 4);
}

TEST_F(Images, AJpegWithAWorldFile) {
  Recipe recipe;
  recipe.name = "a.jpg";
  recipe.driver = "JPEG";
  recipe.epsg = 0;
  recipe.value = [](int, int, int) { return 120; };
  const std::string path = write(recipe);
  std::filesystem::remove(path + ".aux.xml");
  EXPECT_THAT(refusal(path), HasSubstr("no georeference"));
  std::ofstream(folder_ / "a.jgw") << "0.25\n0\n0\n-0.25\n"
                                   << kEast + 0.125 << "\n"
                                   << std::fixed << kNorth - 0.125 << "\n";
  EXPECT_THAT(refusal(path), HasSubstr("no coordinate reference system"));
  char* wkt = nullptr;
  OGRSpatialReferenceH crs = OSRNewSpatialReference(nullptr);
  OSRImportFromEPSG(crs, 25833);
  OSRMorphToESRI(crs);
  OSRExportToWkt(crs, &wkt);
  std::ofstream(folder_ / "a.prj") << wkt;
  CPLFree(wkt);
  OSRDestroySpatialReference(crs);
  const Patch p = whole(AerialImage({path, {}, {}, {}}));
  EXPECT_EQ(p.valid[64 * 20 + 30], 1);
  EXPECT_NEAR(p.red[64 * 20 + 30], 120, 2);
}

TEST_F(Images, WebMercatorPixelsAreMeasuredOnTheGround) {
  Recipe recipe;
  recipe.epsg = 3857;
  recipe.place = {1489000, 0.3, 0, 6893000, 0, -0.3};  // 52.5 degrees north
  const AerialImage image({write(recipe), {}, {}, {}});
  EXPECT_NEAR(image.describe().pixel_m, 0.3 * std::cos(52.53 * 3.14159265 / 180), 0.002);
  recipe.name = "coarse.tif";
  recipe.place[1] = 3, recipe.place[5] = -3;
  EXPECT_THAT(refusal(write(recipe)), HasSubstr("1.83 m on the ground"));
}

TEST_F(Images, WhatIsRefusedSaysWhy) {
  EXPECT_THAT(refusal(folder_ / "none.tif"), HasSubstr("no such image"));
  EXPECT_THAT(refusal(folder_), HasSubstr("gdalbuildvrt"));
  std::ofstream(folder_ / "text.tif") << "no image";
  EXPECT_THAT(refusal(folder_ / "text.tif"), HasSubstr("no image that GDAL can read"));
  Recipe alone;
  alone.name = "alpha.tif";
  alone.bands = 1;
  alone.meaning = {GCI_AlphaBand};
  EXPECT_THAT(refusal(write(alone)), HasSubstr("no band of colours"));
  Recipe radar;
  radar.name = "radar.tif";
  radar.bands = 1;
  radar.type = GDT_CFloat32;
  EXPECT_THAT(refusal(write(radar)), HasSubstr("complex numbers"));
  Recipe lost;
  lost.name = "lost.tif";
  lost.place = {NAN, 0.25, 0, kNorth, 0, -0.25};
  EXPECT_THAT(refusal(write(lost)), HasSubstr("no georeference"));
  lost.name = "far.tif";
  lost.place = {9e12, 0.25, 0, kNorth, 0, -0.25};
  EXPECT_THAT(refusal(write(lost)), testing::AnyOf(HasSubstr("nowhere on Earth"), HasSubstr("cannot be used")));
}

TEST_F(Images, ADamagedFileIsToldWhenItIsRead) {
  Recipe recipe;
  recipe.width = recipe.height = 600;
  recipe.value = [](int band, int column, int row) { return (column * 7 + row * 13 + band) % 256; };
  const std::string path = write(recipe);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 3);
  std::string said = refusal(path);
  if (said == "it was read") {
    try {
      whole(AerialImage({path, {}, {}, {}}), 600, 600);
    } catch (const base::InputError& error) {
      said = error.what();
    }
  }
  EXPECT_THAT(said, HasSubstr("a.tif"));
}

TEST_F(Images, DatesAndOwners) {
  Recipe recipe;
  recipe.besides = [](GDALDatasetH dataset) {
    GDALSetMetadataItem(dataset, "TIFFTAG_DATETIME", "2014:06:21 10:00:00", nullptr);
    GDALSetMetadataItem(dataset, "TIFFTAG_COPYRIGHT", "The Survey", nullptr);
  };
  const std::string path = write(recipe);
  EXPECT_EQ(AerialImage({path, {}, {}, {}}).describe().source.date, "2014-06-21");
  EXPECT_EQ(AerialImage({path, {}, {}, {}}).describe().source.attribution, "The Survey");
  EXPECT_EQ(AerialImage({path, "2015", {}, {}}).describe().source.date, "2015");
}

}  // namespace
}  // namespace blockrand::importers::imagery
