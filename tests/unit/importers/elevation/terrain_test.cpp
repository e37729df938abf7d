// Terrain rasters made here with GDAL, and a real one of Vienna.
#include "importers/elevation/terrain.h"

#include <cpl_conv.h>
#include <gdal.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_srs_api.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/base/error.h"
#include "pipeline/georef/projection.h"

namespace blockrand::importers::elevation {
namespace {

using model::Location;
using ::testing::HasSubstr;

constexpr double kGridStep = 1.0 / 1024;    // m; results are rounded to it
constexpr double kPixelStep = 1.0 / 65536;  // positions are rounded to it; the test plane rises 1000 m a pixel

/// A folder that goes with the test.
class TerrainTest : public ::testing::Test {
 protected:
  void SetUp() override {
    GDALAllRegister();
    folder_ =
        std::filesystem::temp_directory_path() / ("blockrand_terrain_" + std::to_string(::getpid()) + "_" +
                                                  ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  struct Raster {
    int columns = 100, rows = 100;
    std::array<double, 6> geotransform{13.0, 0.001, 0, 52.6, 0, -0.001};
    int epsg = 4326;  // 0: none
    GDALDataType type = GDT_Float64;
    std::optional<double> nodata{};
    double scale = 1, offset = 0;
    const char* unit = "";
    std::function<double(int, int)> value = [](int column, int row) { return column + 1000.0 * row; };
  };

  std::string make(const std::string& name, const Raster& r) {
    const std::string path = (folder_ / name).string();
    GDALDatasetH dataset =
        GDALCreate(GDALGetDriverByName("GTiff"), path.c_str(), r.columns, r.rows, 1, r.type, nullptr);
    auto transform = r.geotransform;
    if (transform[1] != 0) GDALSetGeoTransform(dataset, transform.data());
    if (r.epsg != 0) {
      OGRSpatialReferenceH reference = OSRNewSpatialReference(nullptr);
      OSRImportFromEPSG(reference, r.epsg);
      GDALSetSpatialRef(dataset, reference);
      OSRDestroySpatialReference(reference);
    }
    GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
    if (r.nodata) GDALSetRasterNoDataValue(band, *r.nodata);
    if (r.scale != 1) GDALSetRasterScale(band, r.scale);
    if (r.offset != 0) GDALSetRasterOffset(band, r.offset);
    if (*r.unit != 0) GDALSetRasterUnitType(band, r.unit);
    std::vector<double> line(static_cast<std::size_t>(r.columns));
    for (int row = 0; row < r.rows; ++row) {
      for (int column = 0; column < r.columns; ++column) line[static_cast<std::size_t>(column)] = r.value(column, row);
      EXPECT_EQ(GDALRasterIO(band, GF_Write, 0, row, r.columns, 1, line.data(), r.columns, 1, GDT_Float64, 0, 0),
                CE_None);
    }
    GDALClose(dataset);
    return path;
  }

  static std::string refusal(const std::string& path) {
    try {
      Terrain terrain(path);
    } catch (const base::InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::filesystem::path folder_;
};

Location at(double lon, double lat) {
  return {static_cast<std::int32_t>(std::lround(lon * 1e7)), static_cast<std::int32_t>(std::lround(lat * 1e7))};
}

std::vector<Location> box(double west, double south, double east, double north) {
  return {at(west, south), at(east, south), at(east, north), at(west, north)};
}

TEST_F(TerrainTest, FindsTheLowestPixelInsideARing) {
  Raster r;
  r.value = [](int column, int row) { return column == 50 && row == 40 ? 7.0 : 100.0; };
  const Terrain terrain(make("pit.tif", r));
  // The pit's centre is at (13.0505, 52.5595).
  EXPECT_EQ(terrain.minimum_under(box(13.048, 52.558, 13.053, 52.561)), 7.0);
  EXPECT_EQ(terrain.minimum_under(box(13.060, 52.558, 13.065, 52.561)), 100.0);
  // The pit lies in the notch of a U: not under it.
  const std::vector<Location> u{at(13.045, 52.555), at(13.056, 52.555), at(13.056, 52.565), at(13.053, 52.565),
                                at(13.053, 52.557), at(13.048, 52.557), at(13.048, 52.565), at(13.045, 52.565)};
  EXPECT_EQ(terrain.minimum_under(u), 100.0);
}

TEST_F(TerrainTest, InterpolatesAtVertices) {
  const Terrain terrain(make("plane.tif", {}));
  // Between pixel centres the plane column + 1000 row holds exactly: (13.0105, 52.5895) is the centre of (10, 10).
  const std::vector<Location> middle{at(13.0110, 52.5893)};
  EXPECT_NEAR(*terrain.minimum_under(middle), 10.5 + 1000 * 10.2, kPixelStep * 1000);
  // A ring smaller than a pixel takes its lowest vertex.
  EXPECT_NEAR(*terrain.minimum_under(box(13.0106, 52.5893, 13.0108, 52.5894)), 10.1 + 1000 * 10.1, kPixelStep * 1000);
  // Towards the edge the outermost centre's value goes on.
  const std::vector<Location> corner{at(13.0, 52.6)};
  EXPECT_EQ(terrain.minimum_under(corner), 0.0);
  const std::vector<Location> other_corner{at(13.1, 52.5)};
  EXPECT_EQ(terrain.minimum_under(other_corner), 99.0 + 99000);
}

TEST_F(TerrainTest, KnowsNothingOutside) {
  const Terrain terrain(make("plane.tif", {}));
  EXPECT_EQ(terrain.minimum_under(box(14, 52.5, 14.1, 52.6)), std::nullopt);
  EXPECT_EQ(terrain.minimum_under(box(-170, -52.5, -169, -52.4)), std::nullopt);
  EXPECT_EQ(terrain.minimum_under({}), std::nullopt);
  EXPECT_EQ(terrain.minimum_under(box(13.09, 52.5, 13.2, 52.6)), 89.5);  // half outside: what is known
  EXPECT_EQ(terrain.minimum_under(box(12, 52, 14, 53)), 0.0);            // around everything
}

TEST_F(TerrainTest, SkipsNodataInIntegerRasters) {
  Raster r;
  r.type = GDT_Int16;
  r.nodata = -32768;
  r.value = [](int column, int row) { return column < 50 ? -32768.0 : row == 10 ? -3.0 : 12.0; };
  const Terrain terrain(make("int16.tif", r));
  EXPECT_EQ(terrain.describe().nodata, -32768);
  EXPECT_EQ(terrain.minimum_under(box(13.01, 52.55, 13.02, 52.56)), std::nullopt);
  EXPECT_EQ(terrain.minimum_under(box(13.04, 52.55, 13.06, 52.56)), 12.0);
  EXPECT_EQ(terrain.minimum_under(box(13.04, 52.55, 13.06, 52.595)), -3.0);
  const std::vector<Location> at_the_gap{at(13.0501, 52.5505)};  // two of its four neighbours are missing
  EXPECT_EQ(terrain.minimum_under(at_the_gap), 12.0);
}

TEST_F(TerrainTest, SkipsNotANumber) {
  Raster r;
  r.type = GDT_Float32;
  r.value = [](int column, int) { return column % 2 == 0 ? NAN : 5.0; };
  EXPECT_EQ(Terrain(make("nan.tif", r)).minimum_under(box(13.01, 52.55, 13.02, 52.56)), 5.0);
}

TEST_F(TerrainTest, AppliesScaleOffsetAndUnit) {
  Raster r;
  r.type = GDT_Int16;
  r.scale = 0.25, r.offset = 100;
  r.value = [](int, int) { return 42; };
  EXPECT_EQ(Terrain(make("scaled.tif", r)).minimum_under(box(13.01, 52.55, 13.02, 52.56)), 110.5);
  r.unit = "ft";
  EXPECT_NEAR(*Terrain(make("feet.tif", r)).minimum_under(box(13.01, 52.55, 13.02, 52.56)), 110.5 * 0.3048, kGridStep);
  r.unit = "kelvin";
  EXPECT_THAT(refusal(make("kelvin.tif", r)), HasSubstr("kelvin"));
}

TEST_F(TerrainTest, ReadsProjectedRasters) {
  const georef::GeoBox extent{13.3, 52.4, 13.5, 52.6};
  const georef::Projection utm(georef::open_crs("EPSG:25833", extent), extent);
  const model::Point2 centre = utm.forward(13.4, 52.5);
  Raster r;
  r.epsg = 25833;
  r.geotransform = {std::floor(centre.x) - 250, 5, 0, std::floor(centre.y) + 250, 0, -5};
  const Terrain terrain(make("utm.tif", r));
  const double column = (centre.x - r.geotransform[0]) / 5 - 0.5, row = (r.geotransform[3] - centre.y) / 5 - 0.5;
  const std::vector<Location> point{at(13.4, 52.5)};
  EXPECT_NEAR(*terrain.minimum_under(point), column + 1000 * row, 0.02);  // 1e-7 degrees are a centimetre
  EXPECT_EQ(terrain.describe().crs_code, "EPSG:25833");
  EXPECT_EQ(terrain.describe().pixel_width, 5);
  EXPECT_TRUE(terrain.describe().vertical_name.empty());
}

TEST_F(TerrainTest, ReadsRotatedRasters) {
  Raster r;
  const double c = 0.001 * std::cos(0.5), s = 0.001 * std::sin(0.5);
  r.geotransform = {13.0, c, s, 52.6, -s, -c};
  const Terrain terrain(make("rotated.tif", r));
  const double column = 30.5, row = 60.5;  // the centre of pixel (30, 60)
  const std::vector<Location> point{at(13.0 + c * column + s * row, 52.6 - s * column - c * row)};
  EXPECT_NEAR(*terrain.minimum_under(point), 30 + 1000.0 * 60, 0.2);  // 1e-7 degrees are 1e-4 pixels, 0.1 in row
  EXPECT_NEAR(terrain.describe().pixel_width, 0.001, 1e-12);
}

TEST_F(TerrainTest, ReadsGlobalRastersFrom0To360) {
  Raster r;
  r.columns = 360, r.rows = 180;
  r.geotransform = {0, 1, 0, 90, 0, -1};
  const Terrain terrain(make("globe.tif", r));
  const std::vector<Location> new_york{at(-73.5, 40.5)};
  EXPECT_NEAR(*terrain.minimum_under(new_york), 286 + 1000.0 * 49, kGridStep);
}

TEST_F(TerrainTest, NamesTheHeightSystem) {
  Raster r;
  r.epsg = 5555;  // ETRS89 / UTM 32N + DHHN92
  r.geotransform = {690000, 5, 0, 5335000, 0, -5};
  const TerrainDescription d = Terrain(make("compound.tif", r)).describe();
  EXPECT_EQ(d.crs_name, "ETRS89 / UTM zone 32N");
  EXPECT_EQ(d.vertical_name, "DHHN92 height");
  EXPECT_EQ(d.vertical_code, "EPSG:5783");
}

TEST_F(TerrainTest, ReadsAsciiGridsWithAPrjFile) {
  const std::string path = (folder_ / "grid.asc").string();
  std::ofstream(path) << "ncols 4\nnrows 3\nxllcorner 390000\nyllcorner 5818000\ncellsize 10\nNODATA_value -9999\n"
                         "31 32 33 34\n35.5 -9999 36 37\n38 39 40 41\n";
  EXPECT_THAT(refusal(path), HasSubstr("no coordinate reference system"));
  OGRSpatialReferenceH reference = OSRNewSpatialReference(nullptr);
  OSRImportFromEPSG(reference, 25833);
  OSRMorphToESRI(reference);
  char* wkt = nullptr;
  OSRExportToWkt(reference, &wkt);
  std::ofstream((folder_ / "grid.prj").string()) << wkt;
  CPLFree(wkt);
  OSRDestroySpatialReference(reference);
  const Terrain terrain(path);
  const georef::GeoBox extent{13.3, 52.4, 13.5, 52.6};
  const georef::Projection utm(georef::open_crs("EPSG:25833", extent), extent);
  const auto place = [&](double x, double y) {
    const georef::LonLat g = utm.inverse({x, y});
    return at(g.lon, g.lat);
  };
  const std::vector<Location> ring{place(389990, 5817990), place(390050, 5817990), place(390050, 5818025),
                                   place(389990, 5818025)};
  EXPECT_EQ(terrain.minimum_under(ring), 38.0 < 35.5 ? 38.0 : 35.5);  // the lower two rows, -9999 skipped
}

TEST_F(TerrainTest, RefusesWithARemedy) {
  EXPECT_THAT(refusal((folder_ / "missing.tif").string()), HasSubstr("no such terrain raster"));
  EXPECT_THAT(refusal(folder_.string()), HasSubstr("directory"));
  Raster bare;
  bare.epsg = 0;
  EXPECT_THAT(refusal(make("no_crs.tif", bare)), HasSubstr("no coordinate reference system"));
  bare.geotransform = {};  // none
  bare.epsg = 4326;
  EXPECT_THAT(refusal(make("no_transform.tif", bare)), HasSubstr("no georeference"));
  const std::string garbage = (folder_ / "garbage.tif").string();
  std::ofstream(garbage) << "II*\0 this is no TIFF";
  EXPECT_THAT(refusal(garbage), HasSubstr("no raster that GDAL can read"));
  const std::string empty = (folder_ / "empty.tif").string();
  std::ofstream{empty};
  EXPECT_THAT(refusal(empty), HasSubstr("no raster that GDAL can read"));
}

TEST_F(TerrainTest, ReportsATruncatedFileWhenItReads) {
  const std::string path = make("cut.tif", {});
  std::filesystem::resize_file(path, 20000);
  const std::string refused = refusal(path);
  if (refused != "accepted") {
    EXPECT_THAT(refused, HasSubstr("cut.tif"));
    return;
  }
  const Terrain terrain(path);
  EXPECT_THROW(terrain.minimum_under(box(13.0, 52.5, 13.1, 52.6)), base::InputError);
}

TEST_F(TerrainTest, GivesTheSameFromManyThreadsAndWhenTheCacheIsFull) {
  Raster r;
  r.columns = 3000, r.rows = 3000;  // 144 blocks; the cache keeps 64
  r.type = GDT_Float32;
  r.geotransform = {13.0, 0.0001, 0, 52.6, 0, -0.0001};
  r.value = [](int column, int row) { return (column * 7919 + row * 104729) % 5003 * 0.25; };
  const Terrain terrain(make("large.tif", r));
  std::vector<std::vector<Location>> rings;
  for (int i = 0; i < 3000; ++i) {
    const double west = 13.0 + (i * 37 % 2990) * 0.0001, south = 52.3 + (i * 91 % 2990) * 0.0001;
    rings.push_back(box(west, south, west + 0.0004, south + 0.0003));
  }
  std::vector<std::optional<double>> alone(rings.size());
  for (std::size_t i = 0; i < rings.size(); ++i) alone[i] = terrain.minimum_under(rings[i]);
  std::vector<std::vector<std::optional<double>>> results(4, std::vector<std::optional<double>>(rings.size()));
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < results.size(); ++t) {
    threads.emplace_back([&, t] {
      for (std::size_t k = 0; k < rings.size(); ++k) {
        const std::size_t i = (k + t * 700) % rings.size();
        results[t][i] = terrain.minimum_under(rings[i]);
      }
    });
  }
  for (auto& thread : threads) thread.join();
  for (const auto& result : results) EXPECT_EQ(result, alone);
}

TEST_F(TerrainTest, ReadsTheTerrainOfVienna) {
#ifdef BLOCKRAND_SHARED_DIR
  const std::string path = std::string(BLOCKRAND_SHARED_DIR) + "/data/imagery/wien-schoenbrunn/44_2_dgm.tif";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const Terrain terrain(path);
  const TerrainDescription& d = terrain.describe();
  RecordProperty("crs", d.crs_name + ' ' + d.crs_code + ", " + d.operation);
  // Schoenbrunn palace stands at about 178 m above the Adriatic (city datum: Wiener Null is 156.68 m), the Gloriette
  // hill 60 m higher; which datum the file has is the file's to say, so only the difference and the range are judged.
  const auto palace = terrain.minimum_under(box(16.3110, 48.1844, 16.3135, 48.1853));
  ASSERT_TRUE(palace.has_value()) << d.crs_name << ' ' << d.operation;
  EXPECT_GT(*palace, 10);
  EXPECT_LT(*palace, 260);
  RecordProperty("palace_m", std::to_string(*palace));
#else
  GTEST_SKIP() << "BLOCKRAND_SHARED_DIR is not set";
#endif
}

}  // namespace
}  // namespace blockrand::importers::elevation
