#include "pipeline/picture/render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pipeline/base/random.h"
#include "pipeline/base/sha256.h"
#include "pipeline/picture/lighting.h"
#include "pipeline/picture/palette.h"
#include "pipeline/picture/sky_field.h"
#include "tests/unit/outputs/sample_region.h"
#include "tests/unit/picture/scenes.h"

namespace blockrand::picture {
namespace {

using namespace test;

TEST(Render, AnEmptySceneIsBackground) {
  RenderOptions o;
  o.width = 30;
  o.height = 20;
  const Image image = render(Scene(), Camera(), o);
  ASSERT_EQ(image.rgb.size(), 30u * 20 * 3);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 30; ++x) ASSERT_TRUE(is_background(image, x, y, o));
}

TEST(Render, GroundAloneReachesTheHorizon) {
  Scene scene;
  scene.set_ground(0, kGreen);
  RenderOptions o = plain(20, 20);
  o.ground_fade = 1e6;
  const Image image = render(scene, look_at({0, 0, 2}, {0, 10, 2}), o);
  EXPECT_TRUE(is_background(image, 10, 8, o)) << "above the horizon";
  EXPECT_TRUE(greenish(image, 10, 11)) << "below it";
  const Image from_below = render(scene, look_at({0, 0, -2}, {0, 10, -2}), o);
  EXPECT_TRUE(is_background(from_below, 10, 3, o)) << "the plane is seen from above only";
}

TEST(Render, SizesAreChecked) {
  RenderOptions o;
  o.width = 0;
  EXPECT_THROW(render(Scene(), Camera(), o), std::invalid_argument);
  o = {};
  o.supersampling = 5;
  EXPECT_THROW(render(Scene(), Camera(), o), std::invalid_argument);
}

TEST(Render, NearHidesFarInAnyOrder) {
  for (const bool far_first : {false, true}) {
    Scene scene;
    const auto near = [&] { add_quad(scene, {-1, 5, -1}, {1, 5, -1}, {1, 5, 1}, {-1, 5, 1}, kRed, 1); };
    const auto far = [&] { add_quad(scene, {-4, 9, -4}, {4, 9, -4}, {4, 9, 4}, {-4, 9, 4}, kGreen, 2); };
    if (far_first) far();
    near();
    if (!far_first) far();
    const RenderOptions o = plain(40, 40);
    const Image image = render(scene, look_at({0, 0, 0}, {0, 5, 0}, 60), o);
    EXPECT_TRUE(reddish(image, 20, 20));
    EXPECT_TRUE(greenish(image, 8, 20)) << "beside the near one";
  }
}

TEST(Render, FacesThatCrossMeetOnTheirLine) {
  Scene scene;  // two walls through the axis x = 0, one leaning left, one right
  add_quad(scene, {-2, 4, -2}, {2, 8, -2}, {2, 8, 2}, {-2, 4, 2}, kRed, 1);
  add_quad(scene, {-2, 8, -2}, {2, 4, -2}, {2, 4, 2}, {-2, 8, 2}, kGreen, 2);
  const Image image = render(scene, look_at({0, 0, 0}, {0, 6, 0}, 30), plain(60, 60));
  for (int y = 5; y < 55; ++y) {
    ASSERT_TRUE(reddish(image, 28, y)) << y;
    ASSERT_TRUE(greenish(image, 31, y)) << y;
  }
}

TEST(Render, OrthographicScaleIsExact) {
  Scene scene;
  add_quad(scene, {-5, -3, 7}, {5, -3, 7}, {5, 3, 7}, {-5, 3, 7}, kRed, 1);
  const RenderOptions o = plain(200, 200);
  const Image image = render(scene, plan_camera(20), o);  // 10 pixels a metre
  int covered = 0;
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x) {
      const bool inside = x >= 50 && x < 150 && y >= 70 && y < 130;
      ASSERT_EQ(!is_background(image, x, y, o), inside) << x << ' ' << y;
      covered += inside;
    }
  EXPECT_EQ(covered, 6000);
}

TEST(Render, PlanHasNorthUpAndEastRight) {
  Scene scene;
  add_quad(scene, {6, 6, 1}, {8, 6, 1}, {8, 8, 1}, {6, 8, 1}, kRed, 1);
  const RenderOptions o = plain(200, 200);
  const Image image = render(scene, plan_camera(20), o);
  EXPECT_TRUE(reddish(image, 170, 30));
  EXPECT_TRUE(is_background(image, 170, 170, o));
}

TEST(Render, SharedEdgesLeaveNoGapAndNoOverlap) {
  // A sheet of triangles with corners off the grid: every sample of the sheet is drawn, and drawn once (a sample drawn
  // by two triangles of different colour would depend on their order).
  constexpr int n = 30;
  const auto corner = [](int i, int j) {
    const auto jitter = [&](int k) {
      return static_cast<double>(base::random_bits(7, static_cast<std::uint64_t>(i * 1000 + j), k == 0 ? "x" : "y") %
                                 1000) /
             2500;
    };
    const bool inner = i > 0 && j > 0 && i < n && j < n;
    return Point3{i - n / 2.0 + (inner ? jitter(0) : 0), j - n / 2.0 + (inner ? jitter(1) : 0), 0};
  };
  Scene forwards, backwards;
  std::vector<std::pair<std::array<Point3, 3>, Colour>> triangles;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      triangles.push_back({{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)}, kRed});
      triangles.push_back({{corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)}, kGreen});
    }
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    forwards.add_triangle(triangles[k].first, triangles[k].second, 1);
    const auto& last = triangles[triangles.size() - 1 - k];
    backwards.add_triangle(last.first, last.second, 1);
  }
  const RenderOptions o = plain(300, 300);
  const Image image = render(forwards, plan_camera(30), o);
  for (int y = 0; y < 300; ++y)
    for (int x = 0; x < 300; ++x) ASSERT_FALSE(is_background(image, x, y, o)) << x << ' ' << y;
  EXPECT_EQ(image, render(backwards, plan_camera(30), o));
}

TEST(Render, WhatReachesBehindTheEyeIsClipped) {
  Scene scene;  // a floor around the eye, from 100 m behind it to 100 m before it
  add_quad(scene, {-100, -100, 0}, {100, -100, 0}, {100, 100, 0}, {-100, 100, 0}, kRed, 1);
  const RenderOptions o = plain(80, 80);
  const Image image = render(scene, look_at({0, 0, 2}, {0, 10, 2}, 90), o);
  for (int x = 0; x < 80; ++x) {
    EXPECT_TRUE(is_background(image, x, 20, o)) << "sky";
    for (int y = 44; y < 80; ++y) ASSERT_TRUE(reddish(image, x, y)) << x << ' ' << y;
  }
}

TEST(Render, WhatIsBehindTheEyeIsNotSeen) {
  Scene scene;
  add_quad(scene, {-1, -5, -1}, {1, -5, -1}, {1, -5, 1}, {-1, -5, 1}, kRed, 1);
  const RenderOptions o = plain(20, 20);
  const Image image = render(scene, look_at({0, 0, 0}, {0, 5, 0}), o);
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(is_background(image, i, i, o));
}

TEST(Render, HugeTrianglesAreCutToTheFrame) {
  Scene scene;
  scene.add_triangle({Point3{-4e6, 0, -3e6}, Point3{4e6, 0, -3e6}, Point3{0, 0, 5e6}}, kRed, 1);
  const RenderOptions o = plain(40, 40);
  const Image image = render(scene, look_at({0, -3, 0}, {0, 0, 0}), o);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) ASSERT_TRUE(reddish(image, x, y));
}

TEST(Render, DegenerateTrianglesChangeNothing) {
  Scene scene, with;
  for (Scene* s : {&scene, &with}) add_quad(*s, {-1, 5, -1}, {1, 5, -1}, {1, 5, 1}, {-1, 5, 1}, kRed, 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  with.add_triangle({Point3{0, 4, 0}, Point3{0, 4, 0}, Point3{0, 4, 0}}, kGreen, 2);
  with.add_triangle({Point3{-1, 4, 0}, Point3{0, 4, 0}, Point3{1, 4, 0}}, kGreen, 2);
  with.add_triangle({Point3{nan, 4, 0}, Point3{1, 4, 0}, Point3{1, 4, 1}}, kGreen, 2);
  EXPECT_EQ(with.triangle_count(), 2u);
  const Camera camera = look_at({0, 0, 0}, {0, 5, 0});
  EXPECT_EQ(render(scene, camera, plain(40, 40)), render(with, camera, plain(40, 40)));
}

/// A slab 10 m high along the east-west axis, seen from above at 10 pixels a metre.
Image shadow_picture(double azimuth, double elevation, bool shadows) {
  Scene scene;
  add_box(scene, {-6, -0.5, 0}, {6, 0.5, 10}, kGrey, 1);
  scene.set_ground(0, kGrey);
  RenderOptions o = plain(400, 400);
  o.shadows = shadows;
  o.sun_azimuth = azimuth;
  o.sun_elevation = elevation;
  o.ground_fade = 100;
  return render(scene, plan_camera(40), o);
}

TEST(Shadow, FallsWhereTheGeometrySays) {
  const Image image = shadow_picture(180, 45, true);  // from the south: 10 m of shadow to the north
  const int lit = brightness(image, 200, 300);
  EXPECT_LT(brightness(image, 200, 150), lit * 3 / 4) << "5 m north of the slab";
  for (int metres = 1; metres < 20; ++metres) {
    const int y = 200 - 10 * metres - 5;  // metres + 0.5 north of the middle, 0 .. 10.5 being shade
    if (std::abs(metres + 0.5 - 10.5) < 0.6) continue;
    if (metres + 0.5 < 10.5)
      EXPECT_LT(brightness(image, 200, y), lit * 3 / 4) << metres;
    else
      EXPECT_EQ(brightness(image, 200, y), lit) << metres;
  }
  EXPECT_EQ(brightness(image, 200 + 65, 150), lit) << "east of the slab's end";
  EXPECT_EQ(brightness(image, 200, 250), lit) << "on the sunny side";
}

TEST(Shadow, GrowsAsTheSunSinksAndTurnsWithIt) {
  const Image low = shadow_picture(180, 30, true);  // 10 / tan(30°) = 17.3 m
  EXPECT_LT(brightness(low, 200, 200 - 165), brightness(low, 200, 300));
  EXPECT_EQ(brightness(low, 200, 200 - 185), brightness(low, 200, 300));
  const Image east = shadow_picture(90, 45, true);  // from the east: the shadow lies west of the slab, 10 m long
  EXPECT_LT(brightness(east, 200 - 110, 200), brightness(east, 200, 300));
  EXPECT_EQ(brightness(east, 200 - 175, 200), brightness(east, 200, 300));
  EXPECT_EQ(brightness(east, 200, 100), brightness(east, 200, 300));
}

TEST(Shadow, CanBeSwitchedOff) {
  const Image image = shadow_picture(180, 45, false);
  EXPECT_EQ(brightness(image, 200, 150), brightness(image, 200, 300));
}

TEST(Shadow, LitFacesDoNotShadeThemselves) {
  Scene scene;  // one large slope, lit at a grazing angle: depth maps like to stripe it
  add_quad(scene, {-50, -50, 0}, {50, -50, 0}, {50, 50, 20}, {-50, 50, 20}, kGrey, 1);
  RenderOptions o = plain(200, 200);
  o.shadows = true;
  o.sun_azimuth = 200;
  o.sun_elevation = 12;
  const Image image = render(scene, plan_camera(90), o);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x) ASSERT_EQ(brightness(image, x, y), brightness(image, 100, 100)) << x << ' ' << y;
}

TEST(Sky, CourtyardsAreDarkerThanSquares) {
  Scene scene;
  add_box(scene, {-20, -20, 0}, {-8, 20, 20}, kGrey, 1);
  add_box(scene, {8, -20, 0}, {20, 20, 20}, kGrey, 1);
  add_box(scene, {-8, -20, 0}, {8, -8, 20}, kGrey, 1);
  add_box(scene, {-8, 8, 0}, {8, 20, 20}, kGrey, 1);
  scene.set_ground(0, kGrey);
  RenderOptions o = plain(200, 200);
  o.sun_strength = 0;
  o.sky_occlusion = true;
  o.ground_fade = 100;
  const Image image = render(scene, plan_camera(400), o);
  EXPECT_LT(brightness(image, 100, 100) * 10, brightness(image, 10, 100) * 8) << "courtyard against far ground";
  EXPECT_LT(brightness(image, 112, 100), brightness(image, 10, 100) + 40);
  o.sky_occlusion = false;
  const Image open = render(scene, plan_camera(400), o);
  EXPECT_EQ(brightness(open, 100, 100), brightness(open, 10, 100));
}

TEST(Sky, WallsAreDarkerAtTheirFeetAndRoofsAreOpen) {
  Scene scene;  // a street 10 m wide between houses 20 m high
  add_box(scene, {-30, 0, 0}, {30, 10, 20}, kGrey, 1);
  add_box(scene, {-30, 20, 0}, {30, 30, 20}, kGrey, 2);
  scene.set_ground(0, kGrey);
  const SkyField sky(scene, 256);
  const auto wall = sky.asker({0, 1, 0}), level = sky.asker({0, 0, 1}), outer = sky.asker({0, -1, 0});
  const float foot = sky.open(wall, 0, 10, 1), middle = sky.open(wall, 0, 10, 10), eaves = sky.open(wall, 0, 10, 19.5f);
  // What a wall of endless length, 10 m away and 19 m higher, leaves of it: 1 - (2 h + sin 2 h) / pi averaged over directions.
  EXPECT_LT(foot, 0.45f);
  EXPECT_GT(foot, 0.1f);
  EXPECT_LT(foot, middle);
  EXPECT_LT(middle, eaves);
  EXPECT_GT(eaves, 0.9f);
  EXPECT_GT(sky.open(level, 0, 5, 20), 0.95f) << "a roof";
  EXPECT_LT(sky.open(level, 0, 15, 0), 0.55f) << "the street";
  EXPECT_GT(sky.open(outer, 0, 0, 1), 0.8f) << "open land before the wall";
  EXPECT_EQ(sky.open(level, 0, -500, 0), 1.0f) << "far away";
}

TEST(Render, BandsOfRowsMakeNoSeams) {
  // As large as several bands: the same as its parts, taken by cameras that see a part each.
  Scene scene;
  for (int i = 0; i < 40; ++i)
    add_box(scene, {i * 3.0 - 60, i % 7 - 3.0, 0}, {i * 3.0 - 58, i % 7 - 1.0, 2.0 + i % 5}, i % 2 ? kRed : kGreen,
            static_cast<std::uint32_t>(i));
  scene.set_ground(0, kGrey);
  RenderOptions o = plain(400, 1600);
  o.lines = true;
  o.ground_fade = 100;
  Camera camera = plan_camera(40);
  const Image whole = render(scene, camera, o);
  o.height = 100;
  camera.height = 2.5;
  for (const int part : {0, 5, 7, 8, 15}) {
    Camera above = camera;
    above.eye = camera.eye + camera.up * (20 - 1.25 - part * 2.5);
    const Image piece = render(scene, above, o);
    for (int y = 4; y < 96; ++y)
      for (int x = 0; x < 400; ++x)
        ASSERT_EQ(brightness(piece, x, y), brightness(whole, x, part * 100 + y)) << part << ' ' << x << ' ' << y;
  }
}

TEST(Render, LightingIsSharedByPictures) {
  Scene scene;
  add_box(scene, {-6, -6, 0}, {6, 6, 10}, kGrey, 1);
  scene.set_ground(0, kGrey);
  RenderOptions o;
  o.width = 90, o.height = 60;
  const Lighting lighting(scene, o);
  for (const double azimuth : {20.0, 200.0}) {
    const Camera camera = fit_perspective(scene.points(), {azimuth, 35}, 1.5);
    EXPECT_EQ(render(scene, camera, o, &lighting), render(scene, camera, o));
  }
}

TEST(Render, TrianglesOfAPlaneAreOneFace) {
  Scene scene;
  add_box(scene, {0, 0, 0}, {2, 2, 2}, kGrey, 1);
  EXPECT_EQ(scene.triangle_count(), 10u);
  EXPECT_EQ(scene.faces().size(), 5u);
  add_quad(scene, {0, 0, 3}, {2, 0, 3}, {2, 2, 3}, {0, 2, 3}, kGrey, 1);  // parallel to the last, a metre higher
  add_quad(scene, {0, 0, 3}, {2, 0, 3}, {2, 2, 3}, {0, 2, 3}, kRed, 1);
  EXPECT_EQ(scene.faces().size(), 7u);
  Scene both;
  both.append(scene, 5);
  both.append(scene, 9);
  ASSERT_EQ(both.faces().size(), 14u);
  EXPECT_EQ(both.faces()[both.triangles().back().face].object, 10u);
  EXPECT_EQ(both.faces()[both.triangles().front().face].object, 6u);
  std::vector<bool> hidden(7, false);
  hidden[6] = true;
  Scene rest = scene;
  rest.append_without(both, hidden);
  EXPECT_EQ(rest.triangle_count(), 2 * scene.triangle_count());
  EXPECT_EQ(rest.faces()[rest.triangles().back().face].object, 10u);
}

TEST(Palette, KeepsAreasAndFindsTheNearestOfOthers) {
  Image counted = blank(10, 10, kRed);
  put(counted, blank(10, 4, kGreen), 0, 0);
  Palette palette;
  palette.count(counted);
  palette.choose(16);
  ASSERT_EQ(palette.colours().size(), 2u);
  Image rows = blank(3, 1, kRed);
  rows.rgb[3] = kGreen.r, rows.rgb[4] = kGreen.g, rows.rgb[5] = kGreen.b;
  rows.rgb[6] = 30, rows.rgb[7] = 255, rows.rgb[8] = 90;  // was not counted
  std::vector<std::uint8_t> pixels;
  palette.append(rows, pixels);
  ASSERT_EQ(pixels.size(), 3u);
  EXPECT_EQ(palette.colours()[pixels[0]], kRed);
  EXPECT_EQ(palette.colours()[pixels[1]], kGreen);
  EXPECT_EQ(palette.colours()[pixels[2]], kGreen);
  const PaletteImage image{palette.colours(), pixels};
  const Image back = read_png(png(3, image, 5));
  EXPECT_EQ((Colour{back.rgb[3], back.rgb[4], back.rgb[5]}), kGreen);
}

TEST(Render, CornersColoursBlend) {
  Scene scene;
  const Colour dark{40, 40, 40}, light{240, 240, 240};
  scene.add_blended_triangle({Point3{-10, -10, 0}, Point3{10, -10, 0}, Point3{10, 10, 0}}, {dark, light, light}, 1);
  const Image image = render(scene, plan_camera(20), plain(100, 100));
  EXPECT_LT(brightness(image, 10, 95), brightness(image, 50, 95));
  EXPECT_LT(brightness(image, 50, 95), brightness(image, 90, 95));
}

TEST(Render, LinesMarkBordersBetweenObjectsAndCreases) {
  const auto row_across = [](std::uint32_t second_object, double second_height) {
    Scene scene;
    add_quad(scene, {-8, -4, 0}, {0, -4, 0}, {0, 4, 0}, {-8, 4, 0}, kGrey, 1);
    add_quad(scene, {0, -4, 0}, {8, -4, second_height}, {8, 4, second_height}, {0, 4, 0}, kGrey, second_object);
    RenderOptions o = plain(200, 200);
    o.lines = true;
    o.sun_strength = 0;
    const Image image = render(scene, plan_camera(20), o);
    int darkest = 1000;
    for (int x = 95; x < 105; ++x) darkest = std::min(darkest, brightness(image, x, 100));
    return darkest < brightness(image, 60, 100) * 8 / 10;
  };
  EXPECT_TRUE(row_across(2, 0)) << "two objects in one plane";
  EXPECT_FALSE(row_across(1, 0)) << "one face of one object";
  EXPECT_FALSE(row_across(1, 1)) << "7 degrees are no crease";
  EXPECT_TRUE(row_across(1, 8)) << "45 degrees are";
}

/// A village of the exporters' sample with everything switched on.
Image village(int size) {
  const auto region = outputs::test::SampleRegion::settlement(60, false);
  Scene scene({391000, 5819000, 34});
  std::uint32_t object = 0;
  for (const model::Building& b : region.region().buildings)
    for (const model::BuildingPart& p : b.parts) scene.add(p.lod2, p.lod2_triangles, object++);
  scene.set_ground(34.25, {214, 214, 208});
  RenderOptions o;
  o.width = size;
  o.height = size * 2 / 3;
  return render(scene, fit_perspective(scene.points(), {215, 35}, 1.5), o);
}

TEST(Render, TheSameBytesEachTimeAndOnEveryMachine) {
  const Image image = village(240);
  EXPECT_EQ(image, village(240));
  base::Sha256 digest;
  digest.add({reinterpret_cast<const char*>(image.rgb.data()), image.rgb.size()});
  EXPECT_EQ(digest.finish(), "9cfa494050b5d5a1f30efb423569eccb6687ce3a442a598bb4412dae38523b4c")
      << "The renderer draws something else than before. Where that was meant, look at a picture, then update the "
         "hash; "
         "where it was not, something in it depends on the machine.";
}

TEST(Render, WithoutLightColoursAreAsGiven) {
  Scene scene;
  scene.add_triangle({{{-50, 5, -50}, {50, 5, -50}, {0, 5, 80}}}, {10, 120, 230}, 0);
  RenderOptions o = plain(20, 20);
  o.lines = false;
  o.lit = false;
  o.sun_elevation = -10;
  const Image image = render(scene, look_at({0, 0, 0}, {0, 10, 0}), o);
  const std::uint8_t* p = image.pixel(10, 10);
  EXPECT_EQ(p[0], 10);
  EXPECT_EQ(p[1], 120);
  EXPECT_EQ(p[2], 230);
}

TEST(PalettePng, KeepsFewColoursExactly) {
  Image image{4, 1, {1, 2, 3, 200, 100, 50, 1, 2, 3, 9, 9, 9}};
  const PaletteImage reduced = reduce_colours(image, 8);
  ASSERT_EQ(reduced.palette.size(), 3u);
  for (std::size_t i = 0; i < 4; ++i) {
    const Colour c = reduced.palette[reduced.pixels[i]];
    EXPECT_EQ(c, (Colour{image.rgb[i * 3], image.rgb[i * 3 + 1], image.rgb[i * 3 + 2]}));
  }
}

TEST(PalettePng, ReducesManyColoursToNearOnes) {
  Image image{256, 64, {}};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 256; ++x)
      for (const int v : {x, y * 4, 128}) image.rgb.push_back(static_cast<std::uint8_t>(v));
  const PaletteImage reduced = reduce_colours(image, 64);
  EXPECT_EQ(reduced.palette.size(), 64u);
  int worst = 0;
  for (std::size_t i = 0; i < reduced.pixels.size(); ++i) {
    const Colour c = reduced.palette[reduced.pixels[i]];
    worst = std::max({worst, std::abs(c.r - image.rgb[i * 3]), std::abs(c.g - image.rgb[i * 3 + 1])});
  }
  EXPECT_LE(worst, 24) << "eight by eight colours are 32 wide";
  EXPECT_EQ(palette_png(image), palette_png(image));
  EXPECT_EQ(palette_png(image).substr(1, 3), "PNG");
  EXPECT_THROW(palette_png(Image{}), std::runtime_error);
}

}  // namespace
}  // namespace blockrand::picture
