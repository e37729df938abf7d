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
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/base/error.h"
#include "pipeline/georef/projection.h"
#include "pipeline/georef/transform.h"
#include "pipeline/model/point.h"

namespace blockrand::importers::elevation {
namespace {

using ::testing::HasSubstr;

constexpr double kGridStep = 1.0 / 1024;    // m; results are rounded to it
constexpr double kPixelStep = 1.0 / 65536;  // positions are rounded to it; the test plane rises 1000 m a pixel
constexpr PlausibleHeights kAnyHeight{-1e30, 1e30};

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
      Terrain terrain(path, {}, kAnyHeight);
    } catch (const base::InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::filesystem::path folder_;
};

using Line = std::vector<georef::LonLat>;

Line box(double west, double south, double east, double north) {
  return {{west, south}, {east, south}, {east, north}, {west, north}};
}

std::optional<double> lowest(const Terrain& terrain, const Line& ring) {
  const auto range = terrain.range_under(std::vector<Line>{ring});
  return range ? std::optional(range->lowest) : std::nullopt;
}

double height_at(const Terrain& terrain, double lon, double lat) {
  const auto range = terrain.range_along(Line{{lon, lat}});
  EXPECT_TRUE(range.has_value());
  if (!range) return NAN;
  EXPECT_LE(range->highest - range->lowest, kGridStep) << "a point has one height";
  return range->lowest;
}

TEST_F(TerrainTest, FindsTheLowestPixelInsideARing) {
  Raster r;
  r.value = [](int column, int row) { return column == 50 && row == 40 ? 7.0 : 100.0; };
  const Terrain terrain(make("pit.tif", r), {}, kAnyHeight);
  // The pit's centre is at (13.0505, 52.5595).
  EXPECT_EQ(lowest(terrain, box(13.048, 52.558, 13.053, 52.561)), 7.0);
  EXPECT_EQ(lowest(terrain, box(13.060, 52.558, 13.065, 52.561)), 100.0);
  // The pit lies in the notch of a U: not under it.
  const Line u{{13.045, 52.555}, {13.056, 52.555}, {13.056, 52.565}, {13.053, 52.565},
               {13.053, 52.557}, {13.048, 52.557}, {13.048, 52.565}, {13.045, 52.565}};
  EXPECT_EQ(lowest(terrain, u), 100.0);
}

TEST_F(TerrainTest, InterpolatesAtVertices) {
  const Terrain terrain(make("plane.tif", {}), {}, kAnyHeight);
  // Between pixel centres the plane column + 1000 row holds exactly: (13.0105, 52.5895) is the centre of (10, 10).
  EXPECT_NEAR(height_at(terrain, 13.0110, 52.5893), 10.5 + 1000 * 10.2, kPixelStep * 1000);
  // A ring smaller than a pixel takes its lowest vertex.
  EXPECT_NEAR(*lowest(terrain, box(13.0106, 52.5893, 13.0108, 52.5894)), 10.1 + 1000 * 10.1, kPixelStep * 1000);
  // Towards the edge the outermost centre's value goes on.
  const Line corner{{13.0, 52.6}};
  EXPECT_EQ(lowest(terrain, corner), 0.0);
  const Line other_corner{{13.1, 52.5}};
  EXPECT_EQ(lowest(terrain, other_corner), 99.0 + 99000);
}

TEST_F(TerrainTest, KnowsNothingOutside) {
  const Terrain terrain(make("plane.tif", {}), {}, kAnyHeight);
  EXPECT_EQ(lowest(terrain, box(14, 52.5, 14.1, 52.6)), std::nullopt);
  EXPECT_EQ(lowest(terrain, box(-170, -52.5, -169, -52.4)), std::nullopt);
  EXPECT_EQ(lowest(terrain, {}), std::nullopt);
  EXPECT_EQ(lowest(terrain, box(13.09, 52.5, 13.2, 52.6)), 89.5);  // half outside: what is known
  EXPECT_EQ(lowest(terrain, box(12, 52, 14, 53)), 0.0);            // around everything
}

TEST_F(TerrainTest, SkipsNodataInIntegerRasters) {
  Raster r;
  r.type = GDT_Int16;
  r.nodata = -32768;
  r.value = [](int column, int row) { return column < 50 ? -32768.0 : row == 10 ? -3.0 : 12.0; };
  const Terrain terrain(make("int16.tif", r), {}, kAnyHeight);
  EXPECT_EQ(terrain.describe().nodata, -32768);
  EXPECT_EQ(lowest(terrain, box(13.01, 52.55, 13.02, 52.56)), std::nullopt);
  EXPECT_EQ(lowest(terrain, box(13.04, 52.55, 13.06, 52.56)), 12.0);
  EXPECT_EQ(lowest(terrain, box(13.04, 52.55, 13.06, 52.595)), -3.0);
  const Line at_the_gap{{13.0501, 52.5505}};  // two of its four neighbours are missing
  EXPECT_EQ(lowest(terrain, at_the_gap), 12.0);
}

TEST_F(TerrainTest, SkipsNotANumber) {
  Raster r;
  r.type = GDT_Float32;
  r.value = [](int column, int) { return column % 2 == 0 ? NAN : 5.0; };
  EXPECT_EQ(lowest(Terrain(make("nan.tif", r)), box(13.01, 52.55, 13.02, 52.56)), 5.0);
}

/// Marks for "unknown" that the file does not declare.
TEST_F(TerrainTest, SkipsWhatIsNoHeightOnEarth) {
  for (const double mark : {1e38, -1e38, -9999.0, -32768.0, 12000.0}) {
    Raster r;
    r.value = [mark](int column, int row) { return row == 50 && column > 20 ? mark : 5.0; };
    const Terrain terrain(make("marks.tif", r));
    EXPECT_EQ(lowest(terrain, box(13.03, 52.54, 13.05, 52.56)), 5.0);
    const std::optional<Terrain::Implausible> told = terrain.implausible();
    ASSERT_TRUE(told);
    EXPECT_EQ(told->row, 50);
    EXPECT_EQ(told->column, 21);
    EXPECT_EQ(told->metres, mark);
  }
  const Terrain sound(make("sound.tif", {.value = [](int, int) { return -430.0; }}));
  EXPECT_EQ(lowest(sound, box(13.03, 52.54, 13.05, 52.56)), -430.0);
  EXPECT_FALSE(sound.implausible());
}

TEST_F(TerrainTest, AppliesScaleOffsetAndUnit) {
  Raster r;
  r.type = GDT_Int16;
  r.scale = 0.25, r.offset = 100;
  r.value = [](int, int) { return 42; };
  EXPECT_EQ(lowest(Terrain(make("scaled.tif", r)), box(13.01, 52.55, 13.02, 52.56)), 110.5);
  r.unit = "ft";
  EXPECT_NEAR(*lowest(Terrain(make("feet.tif", r)), box(13.01, 52.55, 13.02, 52.56)), 110.5 * 0.3048, kGridStep);
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
  const Terrain terrain(make("utm.tif", r), {}, kAnyHeight);
  const double column = (centre.x - r.geotransform[0]) / 5 - 0.5, row = (r.geotransform[3] - centre.y) / 5 - 0.5;
  const Line point{{13.4, 52.5}};
  EXPECT_NEAR(*lowest(terrain, point), column + 1000 * row, 1000 * kPixelStep);
  EXPECT_EQ(terrain.describe().crs_code, "EPSG:25833");
  EXPECT_EQ(terrain.describe().pixel_width, 5);
  EXPECT_TRUE(terrain.describe().vertical_name.empty());
}

TEST_F(TerrainTest, ReadsRotatedRasters) {
  Raster r;
  const double c = 0.001 * std::cos(0.5), s = 0.001 * std::sin(0.5);
  r.geotransform = {13.0, c, s, 52.6, -s, -c};
  const Terrain terrain(make("rotated.tif", r), {}, kAnyHeight);
  const double column = 30.5, row = 60.5;  // the centre of pixel (30, 60)
  const Line point{{13.0 + c * column + s * row, 52.6 - s * column - c * row}};
  EXPECT_NEAR(*lowest(terrain, point), 30 + 1000.0 * 60, 1000 * kPixelStep);
  EXPECT_NEAR(terrain.describe().pixel_width, 0.001, 1e-12);
}

TEST_F(TerrainTest, ReadsGlobalRastersFrom0To360) {
  Raster r;
  r.columns = 360, r.rows = 180;
  r.geotransform = {0, 1, 0, 90, 0, -1};
  const Terrain terrain(make("globe.tif", r), {}, kAnyHeight);
  const Line new_york{{-73.5, 40.5}};
  EXPECT_NEAR(*lowest(terrain, new_york), 286 + 1000.0 * 49, kGridStep);
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
  const Terrain terrain(path, {}, kAnyHeight);
  const georef::GeoBox extent{13.3, 52.4, 13.5, 52.6};
  const georef::Projection utm(georef::open_crs("EPSG:25833", extent), extent);
  const auto place = [&](double x, double y) {
    const georef::LonLat g = utm.inverse({x, y});
    return g;
  };
  const Line ring{place(389990, 5817990), place(390050, 5817990), place(390050, 5818015), place(389990, 5818015)};
  EXPECT_EQ(lowest(terrain, ring), 35.5);  // up to the centres of the middle row, -9999 skipped
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
  const Terrain terrain(path, {}, kAnyHeight);
  EXPECT_THROW(lowest(terrain, box(13.0, 52.5, 13.1, 52.6)), base::InputError);
}

TEST_F(TerrainTest, GivesTheSameFromManyThreadsAndWhenTheCacheIsFull) {
  Raster r;
  r.columns = 3000, r.rows = 3000;  // 144 blocks; the cache keeps 64
  r.type = GDT_Float32;
  r.geotransform = {13.0, 0.0001, 0, 52.6, 0, -0.0001};
  r.value = [](int column, int row) { return (column * 7919 + row * 104729) % 5003 * 0.25; };
  const Terrain terrain(make("large.tif", r), {}, kAnyHeight);
  std::vector<Line> rings;
  for (int i = 0; i < 3000; ++i) {
    const double west = 13.0 + (i * 37 % 2990) * 0.0001, south = 52.3 + (i * 91 % 2990) * 0.0001;
    rings.push_back(box(west, south, west + 0.0004, south + 0.0003));
  }
  std::vector<std::optional<double>> alone(rings.size());
  for (std::size_t i = 0; i < rings.size(); ++i) alone[i] = lowest(terrain, rings[i]);
  std::vector<std::vector<std::optional<double>>> results(4, std::vector<std::optional<double>>(rings.size()));
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < results.size(); ++t) {
    threads.emplace_back([&, t] {
      for (std::size_t k = 0; k < rings.size(); ++k) {
        const std::size_t i = (k + t * 700) % rings.size();
        results[t][i] = lowest(terrain, rings[i]);
      }
    });
  }
  for (auto& thread : threads) thread.join();
  for (const auto& result : results) EXPECT_EQ(result, alone);
}

TEST_F(TerrainTest, FollowsAPlane) {
  const Terrain terrain(make("plane.tif", {}), {}, kAnyHeight);
  // Extremes of a plane are those of the vertices: column + 1000 row, with (13.0205, 52.5795) the centre of (20, 20).
  const std::vector<Line> triangle{{{13.0205, 52.5795}, {13.0555, 52.5745}, {13.0305, 52.5445}}};
  const auto range = terrain.range_under(triangle);
  ASSERT_TRUE(range);
  EXPECT_NEAR(range->lowest, 20 + 1000 * 20, 1000 * kPixelStep);
  EXPECT_NEAR(range->highest, 30 + 1000 * 55, 1000 * kPixelStep);
  EXPECT_LE(range->lowest, 20 + 1000 * 20 + kGridStep);
}

TEST_F(TerrainTest, SeesARidgeThatCrossesAnEdge) {
  Raster r;
  r.value = [](int column, int) { return column == 50 ? 9.0 : column == 60 ? 1.0 : 5.0; };  // a ridge and a ditch
  const Terrain terrain(make("ridge.tif", r), {}, kAnyHeight);
  // A narrow house across both, no vertex and no pixel centre near them.
  const std::vector<Line> across{box(13.0452, 52.55462, 13.0653, 52.55478)};
  const auto range = terrain.range_under(across);
  ASSERT_TRUE(range);
  EXPECT_EQ(range->highest, 9.0);
  EXPECT_EQ(range->lowest, 1.0);
  const auto along = terrain.range_along(Line{{13.0452, 52.5547}, {13.0553, 52.5547}});
  EXPECT_EQ(along->highest, 9.0);
  EXPECT_EQ(along->lowest, 5.0);
}

TEST_F(TerrainTest, LeavesCourtyardsOut) {
  Raster r;
  r.value = [](int column, int row) { return column == 50 && row == 40 ? -7.0 : 100.0; };
  const Terrain terrain(make("court.tif", r), {}, kAnyHeight);
  const Line outer = box(13.040, 52.550, 13.060, 52.570), court = box(13.0480, 52.5570, 13.0530, 52.5620);
  EXPECT_EQ(lowest(terrain, outer), -7.0);
  EXPECT_EQ(terrain.range_under(std::vector<Line>{outer, court})->lowest, 100.0);
  EXPECT_EQ(terrain.range_under(std::vector<Line>{court, outer})->lowest, 100.0) << "in any order";
  // A courtyard so narrow that its wall touches the slope of the pit.
  const Line narrow = box(13.0500, 52.5590, 13.0510, 52.5600);
  EXPECT_NEAR(terrain.range_under(std::vector<Line>{outer, narrow})->lowest, 100 - 107 / 2.0, 0.01);
}

TEST_F(TerrainTest, FollowsAPlaneInARotatedRaster) {
  Raster r;
  const double c = 0.001 * std::cos(0.5), s = 0.001 * std::sin(0.5);
  r.geotransform = {13.0, c, s, 52.6, -s, -c};
  const Terrain terrain(make("rotated.tif", r), {}, kAnyHeight);
  const auto place = [&](double column, double row) {
    return georef::LonLat{13.0 + c * column + s * row, 52.6 - s * column - c * row};
  };
  const auto range = terrain.range_under(std::vector<Line>{{place(30, 40), place(70, 44), place(50, 80.5)}});
  ASSERT_TRUE(range);
  EXPECT_NEAR(range->lowest, 29.5 + 1000 * 39.5, 1000 * kPixelStep);
  EXPECT_NEAR(range->highest, 49.5 + 1000 * 80.0, 1000 * kPixelStep);
}

TEST_F(TerrainTest, TakesTheUnitItIsGiven) {
  Raster r;
  r.value = [](int, int) { return 100.0; };
  const Terrain terrain(make("feet.tif", r), 0.3048);
  EXPECT_NEAR(*lowest(terrain, box(13.01, 52.55, 13.02, 52.56)), 30.48, kGridStep);
}

/// Houses on real ground: what is found is exact, as far as dense sampling of the raster's own numbers can tell.
TEST_F(TerrainTest, HoldsUnderHousesInVienna) {
#ifdef BLOCKRAND_SHARED_DIR
  const std::string path = std::string(BLOCKRAND_SHARED_DIR) + "/data/imagery/wien-schoenbrunn/44_2_dgm.tif";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  GDALDatasetH dataset = GDALOpen(path.c_str(), GA_ReadOnly);
  const int columns = GDALGetRasterXSize(dataset), rows = GDALGetRasterYSize(dataset);
  std::array<double, 6> origin{};
  ASSERT_EQ(GDALGetGeoTransform(dataset, origin.data()), CE_None);
  std::vector<double> z(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  ASSERT_EQ(GDALRasterIO(GDALGetRasterBand(dataset, 1), GF_Read, 0, 0, columns, rows, z.data(), columns, rows,
                         GDT_Float64, 0, 0),
            CE_None);
  GDALClose(dataset);
  const auto ground = [&](double x, double y) {
    const double c = (x - origin[0]) / origin[1] - 0.5, r = (y - origin[3]) / origin[5] - 0.5;
    const auto i = static_cast<std::size_t>(c), j = static_cast<std::size_t>(r), n = static_cast<std::size_t>(columns);
    const double u = c - static_cast<double>(i), v = r - static_cast<double>(j);
    return (z[j * n + i] * (1 - u) + z[j * n + i + 1] * u) * (1 - v) +
           (z[(j + 1) * n + i] * (1 - u) + z[(j + 1) * n + i + 1] * u) * v;
  };
  const Terrain terrain(path, {}, kAnyHeight);
  const georef::Transform to_raster("EPSG:4326", "EPSG:31256", georef::GeoBox{16.30, 48.18, 16.32, 48.19});
  std::mt19937 random(1);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  double worst = 0;
  for (int house = 0; house < 400; ++house) {
    const double x = origin[0] + between(30, columns - 30), y = origin[3] - between(30, rows - 30),
                 turn = between(0, 3.2);
    const double w = between(4, 15), d = between(4, 12), cosine = std::cos(turn), sine = std::sin(turn);
    const auto place = [&](double along, double across) {
      return model::Point2{x + cosine * along - sine * across, y + sine * along + cosine * across};
    };
    Line ring;
    // An L: the corner at (w, d) is cut out.
    for (const auto& [a, b] : {std::pair{0.0, 0.0}, {w, 0.0}, {w, d / 2}, {w / 2, d / 2}, {w / 2, d}, {0.0, d}}) {
      const model::Point2 p = to_raster.inverse(place(a, b));
      ring.push_back({p.x, p.y});
    }
    double low = 1e9, high = -1e9;
    constexpr int kSteps = 120;
    for (int i = 0; i <= kSteps; ++i)
      for (int j = 0; j <= kSteps; ++j) {
        const double a = w * i / kSteps, b = d * j / kSteps;
        if (a > w / 2 && b > d / 2) continue;
        const model::Point2 p = place(a, b);
        low = std::min(low, ground(p.x, p.y)), high = std::max(high, ground(p.x, p.y));
      }
    const auto range = terrain.range_under(std::vector<Line>{ring});
    ASSERT_TRUE(range) << house;
    ASSERT_LE(range->lowest, low + 1e-4) << house;
    ASSERT_GE(range->highest, high - 1e-4) << house;
    worst = std::max({worst, low - range->lowest, range->highest - high});
  }
  RecordProperty("worst_m", std::to_string(worst));
  EXPECT_LT(worst, 0.05) << "dense sampling comes near";
#else
  GTEST_SKIP() << "BLOCKRAND_SHARED_DIR is not set";
#endif
}

TEST_F(TerrainTest, ReadsTheTerrainOfVienna) {
#ifdef BLOCKRAND_SHARED_DIR
  const std::string path = std::string(BLOCKRAND_SHARED_DIR) + "/data/imagery/wien-schoenbrunn/44_2_dgm.tif";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const Terrain terrain(path, {}, kAnyHeight);
  const TerrainDescription& d = terrain.describe();
  RecordProperty("crs", d.crs_name + ' ' + d.crs_code + ", " + d.operation);
  // Schoenbrunn palace stands at about 178 m above the Adriatic (city datum: Wiener Null is 156.68 m), the Gloriette
  // hill 60 m higher; which datum the file has is the file's to say, so only the difference and the range are judged.
  const auto palace = lowest(terrain, box(16.3110, 48.1844, 16.3135, 48.1853));
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
