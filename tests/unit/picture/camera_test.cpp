#include "pipeline/picture/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include "pipeline/model/vector.h"
#include "pipeline/picture/image.h"
#include "pipeline/picture/view.h"
#include "tests/unit/picture/scenes.h"

namespace blockrand::picture {
namespace {

using namespace test;
using testing::DoubleNear;

MATCHER_P(IsNear, p, "") { return length(arg - p) < 1e-9; }

std::vector<Point3> corners_of_a_box() {
  Box box;
  box.include({1000, 2000, 30});
  box.include({1080, 2050, 55});
  const auto corners = box.corners();
  return {corners.begin(), corners.end()};
}

/// Furthest the points reach from the middle of a picture of 300 x 200, as a share of its half-width and half-height.
std::pair<double, double> filled(const Camera& camera, const std::vector<Point3>& points) {
  const View view(camera, {}, 300, 200);
  double x = 0, y = 0;
  for (const Point3& p : points) {
    const Point3 c = view.to_camera(p);
    EXPECT_GT(c.z, camera.near);
    const Projected q = view.project(c);
    x = std::max(x, std::abs(q.x - 150) / 150);
    y = std::max(y, std::abs(q.y - 100) / 100);
  }
  return {x, y};
}

TEST(Camera, FitsTouchTheMarginAndNothingLeavesThePicture) {
  const std::vector<Point3> points = corners_of_a_box();
  for (const double azimuth : {0.0, 35.0, 180.0, 290.0})
    for (const double elevation : {0.0, 20.0, 60.0, 90.0}) {
      const auto [x, y] = filled(fit_perspective(points, {azimuth, elevation}, 1.5, 40, 0.1), points);
      EXPECT_LE(std::max(x, y), 0.9 + 1e-6) << azimuth << ' ' << elevation;
      EXPECT_GT(std::max(x, y), 0.899) << azimuth << ' ' << elevation;
    }
}

TEST(Camera, DirectionsAreThoseOfTheMap) {
  const std::vector<Point3> points = corners_of_a_box();
  const Camera from_south = fit_perspective(points, {180, 0}, 1);
  EXPECT_THAT(from_south.forward, IsNear(Point3{0, 1, 0}));
  EXPECT_THAT(from_south.right, IsNear(Point3{1, 0, 0}));
  const Camera from_east = fit_perspective(points, {90, 0}, 1);
  EXPECT_THAT(from_east.forward, IsNear(Point3{-1, 0, 0}));
  EXPECT_THAT(from_east.right, IsNear(Point3{0, 1, 0}));
  const Camera plan = fit_perspective(points, {180, 90}, 1);
  EXPECT_THAT(plan.up, IsNear(Point3{0, 1, 0}));
  EXPECT_THAT(plan.right, IsNear(Point3{1, 0, 0}));
  EXPECT_THAT(look_at({0, 0, 9}, {0, 0, 0}).up, IsNear(Point3{0, 1, 0}));
}

TEST(Camera, ASinglePointAndNoPointAreNoError) {
  const std::vector<Point3> one{{5, 6, 7}};
  const View view(fit_perspective(one, {215, 35}, 1.5), {}, 300, 200);
  const Projected p = view.project(view.to_camera(one[0]));
  EXPECT_THAT(p.x, DoubleNear(150, 1e-6));
  EXPECT_THAT(p.y, DoubleNear(100, 1e-6));
  EXPECT_GT(p.nearness, 0);
  fit_perspective({}, {215, 35}, 1.5);
}

TEST(View, PositionsComeBack) {
  const std::vector<Point3> points = corners_of_a_box();
  Camera parallel = fit_perspective(points, {215, 35}, 1.5);
  parallel.projection = Projection::orthographic;
  parallel.height = 100;
  for (const Camera& camera : {fit_perspective(points, {215, 35}, 1.5), parallel}) {
    const View view(camera, {1000, 2000, 0}, 300, 200);
    for (const Point3& p : points) {
      const Point3 local = p - Point3{1000, 2000, 0};
      const Projected q = view.project(view.to_camera(local));
      EXPECT_THAT(view.position(q.x, q.y, q.nearness), IsNear(local));
    }
    // The ground's nearness as a linear function is that of its points.
    const View::Linear plane = view.plane({0, 0, 1}, 30);
    ASSERT_TRUE(plane.valid);
    EXPECT_THAT(view.position(40, 150, plane(40, 150)).z, DoubleNear(30, 1e-9));
  }
}

TEST(Png, ReadsBackAndCarriesNoTime) {
  Image image{5, 3, {}};
  for (int i = 0; i < 45; ++i) image.rgb.push_back(static_cast<std::uint8_t>(i * 5));
  const std::string bytes = png(image);
  EXPECT_EQ(bytes, png(image));
  EXPECT_EQ(bytes.find("tIME"), std::string::npos);
  EXPECT_NE(bytes.find("sRGB"), std::string::npos);

  png_image reader{};
  reader.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&reader, bytes.data(), bytes.size()));
  reader.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> read(PNG_IMAGE_SIZE(reader));
  ASSERT_TRUE(png_image_finish_read(&reader, nullptr, read.data(), 0, nullptr));
  EXPECT_EQ(reader.width, 5u);
  EXPECT_EQ(read, image.rgb);
}

TEST(Png, AnImageWithoutPixelsIsRefused) {
  EXPECT_THROW(png(Image{}), std::runtime_error);
  EXPECT_THROW(png(Image{2, 2, {1, 2, 3}}), std::runtime_error);
}

}  // namespace
}  // namespace blockrand::picture
