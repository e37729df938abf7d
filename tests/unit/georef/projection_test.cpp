// Our transverse Mercator against PROJ and GeographicLib, and the ways through PROJ.
#include "pipeline/georef/projection.h"

#include <gtest/gtest.h>
#include <proj.h>

#include <GeographicLib/TransverseMercatorExact.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/base/error.h"
#include "pipeline/base/random.h"
#include "pipeline/georef/frames.h"
#include "pipeline/georef/transverse_mercator.h"

namespace blockrand::georef {
namespace {

constexpr double kMicrometre = 1e-6;

double metres_between(LonLat a, LonLat b) {
  const model::Point3 p = to_ecef({a.lon, a.lat, 0}), q = to_ecef({b.lon, b.lat, 0});
  return std::sqrt((p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y) + (p.z - q.z) * (p.z - q.z));
}

/// PROJ, called without any of our code.
class CheckedByProj {
 public:
  explicit CheckedByProj(const std::string& code) : context_(proj_context_create()) {
    PJ* raw = proj_create_crs_to_crs(context_, "EPSG:4326", code.c_str(), nullptr);
    pj_ = proj_normalize_for_visualization(context_, raw);
    proj_destroy(raw);
  }
  ~CheckedByProj() {
    proj_destroy(pj_);
    proj_context_destroy(context_);
  }
  CheckedByProj(const CheckedByProj&) = delete;
  CheckedByProj& operator=(const CheckedByProj&) = delete;
  model::Point2 forward(double lon, double lat) const {
    const PJ_COORD out = proj_trans(pj_, PJ_FWD, proj_coord(lon, lat, 0, 0));
    return {out.xy.x, out.xy.y};
  }

 private:
  PJ_CONTEXT* context_;
  PJ* pj_;
};

TEST(Projection, AgreesWithProjInUtmZonesWorldwide) {
  for (const int zone : {1, 2, 17, 18, 31, 32, 33, 36, 45, 56, 59, 60}) {
    for (const int base : {32600, 32700}) {
      const std::string code = "EPSG:" + std::to_string(base + zone);
      const double centre = 6 * zone - 183;
      const GeoBox extent =
          base == 32600 ? GeoBox{centre - 3, 0, centre + 3, 84} : GeoBox{centre - 3, -80, centre + 3, 0};
      const Projection projection(open_crs(code, extent), extent);
      ASSERT_TRUE(projection.portable()) << code;
      const CheckedByProj judge(code);
      double worst = 0, worst_back = 0;
      for (int i = 0; i < 500; ++i) {
        const auto key = static_cast<std::uint64_t>(zone * 1000 + i);
        // Up to 6 degrees off the central meridian: zones 1 and 60 cross the antimeridian there.
        double lon = centre + 12 * (base::random_unit(3, key, "lon") - 0.5);
        if (lon < -180) lon += 360;
        if (lon > 180) lon -= 360;
        const double lat = extent.south + base::random_unit(3, key, "lat") * (extent.north - extent.south);
        const model::Point2 ours = projection.forward(lon, lat), theirs = judge.forward(lon, lat);
        worst = std::max({worst, std::fabs(ours.x - theirs.x), std::fabs(ours.y - theirs.y)});
        worst_back = std::max(worst_back, metres_between(projection.inverse(theirs), {lon, lat}));
      }
      EXPECT_LT(worst, kMicrometre) << code;
      EXPECT_LT(worst_back, kMicrometre) << code;
    }
  }
}

TEST(Projection, IsContinuousAcrossTheAntimeridian) {
  const GeoBox extent{179.9, -17, -179.9, -16};
  const Projection projection(open_crs("EPSG:32760", extent), extent);
  EXPECT_TRUE(projection.portable());
  const model::Point2 west = projection.forward(179.9999999, -16.5), east = projection.forward(-179.9999999, -16.5);
  EXPECT_LT(std::hypot(west.x - east.x, west.y - east.y), 0.03);
  EXPECT_EQ(projection.forward(180, -16.5), projection.forward(-180, -16.5));
  EXPECT_LT(metres_between(projection.inverse(east), {-179.9999999, -16.5}), kMicrometre);
}

TEST(TransverseMercator, AgreesWithGeographicLibsExactForm) {
  const GeographicLib::TransverseMercatorExact judge(6378137.0, 1 / 298.257222101, 0.9996);
  const TransverseMercator ours({.central_meridian = 9});
  double worst = 0, worst_scale = 0, worst_back = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto key = static_cast<std::uint64_t>(i);
    const double lon = 9 + 24 * (base::random_unit(4, key, "lon") - 0.5);
    const double lat = 178 * (base::random_unit(4, key, "lat") - 0.5);
    double x = 0, y = 0, gamma = 0, k = 0;
    judge.Forward(9, lat, lon, x, y, gamma, k);
    const model::Point2 p = ours.forward({lon, lat});
    worst = std::max({worst, std::fabs(p.x - 500000 - x), std::fabs(p.y - y)});
    worst_scale = std::max(worst_scale, std::fabs(ours.scale({lon, lat}) - k));
    worst_back = std::max(worst_back, metres_between(ours.inverse(p), {lon, lat}));
  }
  EXPECT_LT(worst, 2e-8);
  EXPECT_LT(worst_scale, 1e-11);
  EXPECT_LT(worst_back, 2e-8);
  RecordProperty("worst_nm", static_cast<int>(worst * 1e9));
}

TEST(TransverseMercator, HoldsAtPolesEquatorAndMeridian) {
  const TransverseMercator utm({.central_meridian = 15});
  EXPECT_EQ(utm.forward({15, 0}), (model::Point2{500000, 0}));
  EXPECT_NEAR(utm.forward({15, 90}).x, 500000, 1e-8);
  EXPECT_NEAR(utm.forward({100, 90}).y, utm.forward({15, 90}).y, 1e-8);
  EXPECT_NEAR(utm.inverse(utm.forward({15, 90})).lat, 90, 1e-13);
  EXPECT_NEAR(utm.inverse(utm.forward({15, -90})).lat, -90, 1e-13);
  EXPECT_NEAR(utm.inverse(utm.forward({14, 89.99999})).lat, 89.99999, 1e-12);
  EXPECT_NEAR(utm.scale({15, 50}), 0.9996, 1e-15);
  const TransverseMercator british({.central_meridian = -2, .latitude_of_origin = 49, .false_northing = -100000});
  EXPECT_NEAR(british.forward({-2, 49}).y, -100000, 1e-8);
}

TEST(Projection, GoesThroughProjWhereTheSeriesDoesNotHold) {
  for (const auto& [code, extent] : {std::pair<const char*, GeoBox>{"EPSG:2154", {2.2, 48.8, 2.4, 48.9}},
                                     {"EPSG:28992", {4.8, 52.3, 4.9, 52.4}},
                                     {"EPSG:31468", {11.5, 48.1, 11.6, 48.2}},
                                     {"EPSG:3857", {13.3, 52.4, 13.5, 52.6}}}) {
    const Projection projection(open_crs(code, extent), extent);
    EXPECT_FALSE(projection.portable()) << code;
    double worst = 0;
    for (int i = 0; i <= 8; ++i) {
      for (int j = 0; j <= 8; ++j) {
        const LonLat p = extent.at(i / 8.0, j / 8.0);
        worst = std::max(worst, metres_between(projection.inverse(projection.forward(p.lon, p.lat)), p));
      }
    }
    EXPECT_LT(worst, 1e-4) << code;
  }
}

TEST(Projection, StatesTheGridScale) {
  const GeoBox berlin{13.3, 52.4, 13.5, 52.6};
  const Projection utm(open_crs("EPSG:25833", berlin), berlin);
  EXPECT_NEAR(utm.grid_scale(13.4, 52.5), 0.99974479, 1e-7);
  const Projection mercator(open_crs("EPSG:3857", berlin), berlin);
  EXPECT_NEAR(mercator.grid_scale(13.4, 52.5), 1.0 / std::cos(52.5 * M_PI / 180), 6e-3);
}

TEST(Projection, IsNotFiniteWhereTheCrsIsUndefined) {
  const GeoBox extent{11.5, 48.1, 11.6, 48.2};
  const Projection gauss_krueger(open_crs("EPSG:31468", extent), extent);
  EXPECT_FALSE(std::isfinite(gauss_krueger.forward(100, 30).x));  // outside of the datum grid
  EXPECT_TRUE(std::isfinite(gauss_krueger.forward(11.55, 48.15).x));
}

TEST(Projection, GivesTheSameBitsFromManyThreads) {
  for (const char* code : {"EPSG:25833", "EPSG:3068"}) {
    const GeoBox extent{13.3, 52.4, 13.5, 52.6};
    const Projection projection(open_crs(code, extent), extent);
    std::vector<LonLat> in;
    for (int i = 0; i < 2000; ++i) in.push_back(extent.at(i / 2000.0, (i * 7 % 2000) / 2000.0));
    std::vector<model::Point2> alone(in.size());
    projection.forward(in, alone);
    std::vector<std::vector<model::Point2>> results(4, std::vector<model::Point2>(in.size()));
    std::vector<std::thread> threads;
    for (auto& result : results) threads.emplace_back([&] { projection.forward(in, result); });
    for (auto& thread : threads) thread.join();
    for (const auto& result : results) EXPECT_EQ(result, alone) << code;
  }
}

TEST(Projection, ReopensAPinnedOperation) {
  const GeoBox extent{13.3, 52.4, 13.5, 52.6};
  const Crs crs = open_crs("EPSG:25833", extent);
  Crs pinned;
  pinned.pipeline = crs.pipeline;
  const Projection first(crs, extent), again(pinned, {13.35, 52.45, 13.4, 52.5});
  EXPECT_EQ(first.forward(13.37, 52.47), again.forward(13.37, 52.47));
  pinned.pipeline = "+proj=nonsense";
  EXPECT_THROW(Projection(pinned, extent), base::UsageError);
}

// A sum over the bits of many results; every x86-64 must find it.
TEST(Projection, BitsAreTheOnesOnRecord) {
  const TransverseMercator utm({.central_meridian = 15});
  std::uint64_t sum = 0;
  const auto eat = [&sum](double value) {
    std::uint64_t bits = 0;
    __builtin_memcpy(&bits, &value, sizeof bits);
    sum = base::mix64(sum ^ bits);
  };
  for (int i = 0; i < 5000; ++i) {
    const LonLat p{12 + i * 0.0012, -80 + i * 0.0327};
    const model::Point2 xy = utm.forward(p);
    const LonLat back = utm.inverse(xy);
    for (const double value : {xy.x, xy.y, back.lon, back.lat, utm.scale(p)}) eat(value);
  }
  EXPECT_EQ(sum, 7807699888855795386u);
}

}  // namespace
}  // namespace blockrand::georef
