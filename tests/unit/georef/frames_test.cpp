// Frames against GeographicLib, which shares no code with ours.
#include "pipeline/georef/frames.h"

#include <gtest/gtest.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/LocalCartesian.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "pipeline/base/random.h"
#include "pipeline/georef/heights.h"
#include "pipeline/georef/round_trip.h"
#include "pipeline/georef/tile_frame.h"
#include "pipeline/georef/tiles.h"

namespace blockrand::georef {
namespace {

constexpr double kLastBits = 5e-9;     // m; an earth radius has steps of 1e-9 m
constexpr double kLastDegrees = 1e-8;  // m; 180 degrees have steps of 3e-14 degrees, 3e-9 m

double distance(const model::Point3& a, const model::Point3& b) {
  return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
}

Geodetic random_place(int i) {
  const auto key = static_cast<std::uint64_t>(i);
  return {360 * (base::random_unit(5, key, "lon") - 0.5), 180 * (base::random_unit(5, key, "lat") - 0.5),
          10000 * (base::random_unit(5, key, "h") - 0.2)};
}

TEST(Ecef, AgreesWithGeographicLibBothWays) {
  const GeographicLib::Geocentric& judge = GeographicLib::Geocentric::WGS84();
  double worst = 0, worst_back = 0;
  for (int i = 0; i < 20000; ++i) {
    const Geodetic g = random_place(i);
    model::Point3 theirs;
    judge.Forward(g.lat, g.lon, g.height, theirs.x, theirs.y, theirs.z);
    worst = std::max(worst, distance(to_ecef(g), theirs));
    worst_back = std::max(worst_back, distance(to_ecef(from_ecef(theirs)), theirs));
  }
  EXPECT_LT(worst, kLastBits);
  EXPECT_LT(worst_back, kLastDegrees);
  RecordProperty("worst_pm", std::to_string(worst * 1e12) + ' ' + std::to_string(worst_back * 1e12));
}

TEST(Ecef, HoldsAtPolesAndTheEquator) {
  EXPECT_NEAR(to_ecef({0, 90, 0}).z, kWgs84B, kLastBits);
  EXPECT_NEAR(from_ecef({0, 0, kWgs84B + 5}).height, 5, kLastBits);
  EXPECT_EQ(from_ecef({0, 0, -kWgs84B}).lat, -90);
  EXPECT_NEAR(from_ecef({-kWgs84A - 7, 0, 0}).height, 7, kLastBits);
  EXPECT_EQ(from_ecef({-kWgs84A, 0, 0}).lon, 180);
}

TEST(EnuFrame, AgreesWithGeographicLibsLocalCartesian) {
  double worst = 0, worst_back = 0;
  for (int i = 0; i < 2000; ++i) {
    const Geodetic o = random_place(i);
    const GeographicLib::LocalCartesian judge(o.lat, o.lon, o.height);
    const EnuFrame frame(o);
    const double lon = o.lon + 0.02 * (base::random_unit(6, static_cast<std::uint64_t>(i), "lon") - 0.5);
    const double lat =
        std::clamp(o.lat + 0.02 * (base::random_unit(6, static_cast<std::uint64_t>(i), "lat") - 0.5), -90., 90.);
    model::Point3 theirs;
    judge.Forward(lat, lon, 50, theirs.x, theirs.y, theirs.z);
    const model::Point3 ours = frame.to_local(lon, lat, 50);
    worst = std::max(worst, distance(ours, theirs));
    worst_back = std::max(worst_back, distance(frame.to_local(frame.to_ecef(ours)), ours));
  }
  EXPECT_LT(worst, kLastBits);
  EXPECT_LT(worst_back, kLastBits);
}

TEST(EnuFrame, MatrixIsTheFrameColumnByColumn) {
  const EnuFrame frame({13.4, 52.5, 40});
  const auto m = frame.local_to_ecef();
  const model::Point3 p{12, -34, 56};
  const model::Point3 by_matrix{m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12],
                                m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
                                m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
  EXPECT_LT(distance(by_matrix, frame.to_ecef(p)), kLastBits);
  EXPECT_EQ(m[3], 0);
  EXPECT_EQ(m[15], 1);
  EXPECT_EQ(m[2], 0);  // east is level
}

struct Place {
  const char* name;
  const char* crs;
  LonLat at;
};

class TileFrames : public ::testing::TestWithParam<Place> {};

TEST_P(TileFrames, StayWithinATenthOfAMillimetreOfTheExactWay) {
  const auto& [name, code, at] = GetParam();
  const GeoBox extent{at.lon - 0.05, at.lat - 0.05, at.lon + 0.05, at.lat + 0.05};
  const Projection projection(open_crs(code, extent), extent);
  const model::Location location{static_cast<std::int32_t>(at.lon * 1e7), static_cast<std::int32_t>(at.lat * 1e7)};
  const TileFrame frame(projection, tile_of(location, 15), 40);
  const Geodetic& o = frame.frame().origin();
  const GeographicLib::LocalCartesian judge(o.lat, o.lon, o.height);
  const model::Point2 middle = projection.forward(o.lon, o.lat);
  double worst = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto key = static_cast<std::uint64_t>(i);
    const model::Point3 p{middle.x + 2600 * (base::random_unit(8, key, "x") - 0.5),
                          middle.y + 2400 * (base::random_unit(8, key, "y") - 0.5),
                          500 * base::random_unit(8, key, "z")};
    const LonLat g = projection.inverse(p.xy());
    model::Point3 theirs;
    judge.Forward(g.lat, g.lon, p.z, theirs.x, theirs.y, theirs.z);
    worst = std::max(worst, distance(frame.to_local(p), theirs));
  }
  EXPECT_LT(worst, TileFrame::kMaxError);
  EXPECT_LE(frame.max_error_m(), TileFrame::kMaxError);
  // Far outside of the tile the exact way is taken.
  const model::Point3 far{middle.x + 20000, middle.y, 10};
  EXPECT_EQ(frame.to_local(far), frame.to_local_exact(far));
  RecordProperty("worst_nm", std::to_string(worst * 1e9) + (frame.exact() ? " exact" : ""));
}

INSTANTIATE_TEST_SUITE_P(
    Places, TileFrames,
    ::testing::Values(Place{"Berlin", "EPSG:25833", {13.4, 52.5}}, Place{"Quito", "EPSG:32717", {-78.5, -0.2}},
                      Place{"Longyearbyen", "EPSG:25833", {15.6, 78.2}},
                      Place{"OffTheZone", "EPSG:25832", {13.4, 52.5}}, Place{"Mercator", "EPSG:3857", {13.4, 52.5}},
                      Place{"Amsterdam", "EPSG:28992", {4.9, 52.37}}, Place{"MunichGrid", "EPSG:31468", {11.57, 48.14}},
                      Place{"Fiji", "EPSG:32760", {179.9, -16.8}}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(TileFrame, LargeTilesFallBackToTheExactWay) {
  const GeoBox extent{12, 51, 15, 54};
  const Projection projection(open_crs("EPSG:25833", extent), extent);
  const TileFrame frame(projection, tile_of({134'000'000, 525'000'000}, 5));
  EXPECT_TRUE(frame.exact());
  const model::Point2 p = projection.forward(13.4, 52.5);
  EXPECT_LT(distance(frame.to_local({p.x, p.y, 10}), frame.frame().to_local(13.4, 52.5, 10)), 1e-7);
}

TEST(Geoid, GivesTheUndulationsOfEgm96) {
  // NGA's test values of EGM96 (WW15MGH test points): 38.6281550 N 269.7791550 E -31.629 m, 14.6212170 S 305.0211140 E
  // -2.966 m, 46.8743190 N 102.4487290 E -43.572 m, 23.6174460 S 133.8747120 E 15.868 m. Bilinear on 15': 0.1 m.
  const struct {
    double lat, lon, height;
  } points[] = {{38.6281550, -90.2208450, -31.629},
                {-14.6212170, -54.9788860, -2.966},
                {46.8743190, 102.4487290, -43.572},
                {-23.6174460, 133.8747120, 15.868}};
  const Geoid geoid;
  if (!geoid.available()) GTEST_SKIP() << Geoid::remedy();
  for (const auto& p : points) {
    const auto undulation = geoid.undulation(p.lon, p.lat);
    ASSERT_TRUE(undulation.has_value());
    EXPECT_NEAR(*undulation, p.height, 0.1);
    EXPECT_EQ(*undulation, model::snap(*undulation));
  }
}

TEST(RoundTrip, StaysBelowAMillimetre) {
  for (const auto& [code, extent] : {std::pair<const char*, GeoBox>{"EPSG:25833", {13.0, 52.3, 13.8, 52.7}},
                                     {"EPSG:25833", {7.0, 50.3, 7.1, 50.4}},
                                     {"EPSG:32760", {179.9, -17, -179.9, -16}},
                                     {"EPSG:28992", {4.8, 52.3, 4.9, 52.4}},
                                     {"EPSG:2056", {8.5, 47.3, 8.6, 47.4}},
                                     {"EPSG:27700", {-0.2, 51.4, 0, 51.6}},
                                     {"EPSG:31468", {11.5, 48.1, 11.6, 48.2}}}) {
    const Projection projection(open_crs(code, extent), extent);
    const RoundTrip result = measure_round_trip(projection, extent);
    EXPECT_TRUE(result.ok()) << code << ' ' << result.projection_m << ' ' << result.frame_m;
    EXPECT_EQ(result.points, 17U * 17U);
    EXPECT_LT(result.projection_m, 1e-4) << code;
    EXPECT_LT(result.frame_m, 2e-4) << code;
  }
}

}  // namespace
}  // namespace blockrand::georef
