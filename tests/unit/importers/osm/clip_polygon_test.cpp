// The area that a region's data are cut to.
#include "importers/osm/clip_polygon.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "pipeline/base/error.h"
#include "tests/unit/importers/osm/support.h"

namespace blockrand::importers::osm {
namespace {

using model::Location;
using test::TempFolder;
using Ring = std::vector<Location>;

ClipPolygon polygon(const ClipPolygon::Rings& rings) { return ClipPolygon(std::vector<ClipPolygon::Rings>{rings}); }

TEST(ClipPolygon, HolesAndSeveralAreas) {
  const Ring outer = {{0, 0}, {100, 0}, {100, 100}, {0, 100}}, hole = {{40, 40}, {40, 60}, {60, 60}, {60, 40}};
  const ClipPolygon one = polygon({outer, hole});
  EXPECT_TRUE(one.contains({10, 10}));
  EXPECT_FALSE(one.contains({50, 50}));
  EXPECT_FALSE(one.contains({101, 50}));
  EXPECT_FALSE(one.contains({50, -1}));
  EXPECT_FALSE(one.contains({50, 101}));
  // Another that covers the hole: what lies in one of them is in.
  const ClipPolygon two(std::vector<ClipPolygon::Rings>{{outer, hole}, {{{30, 30}, {70, 30}, {70, 70}, {30, 70}}}});
  EXPECT_TRUE(two.contains({50, 50}));
  EXPECT_TRUE(two.contains({35, 35}));
  EXPECT_FALSE(ClipPolygon({}).contains({0, 0}));
  EXPECT_FALSE(polygon({{{0, 0}, {10, 0}}}).contains({5, 0})) << "without any area";
}

/// Of triangles that fill a square, each grid point lies in one: none is lost on a border, none is in two. Up to the ends of the world.
TEST(ClipPolygon, NeighboursShareNothing) {
  std::mt19937 random(3);
  for (const std::int32_t size : {7, 40, 900'000'000}) {
    const Ring corners = {{-size, -size}, {size, -size}, {size, size}, {-size, size}};
    std::uniform_int_distribution<std::int32_t> inside(-size + 1, size - 1);
    const Location middle{inside(random), inside(random)};
    std::vector<ClipPolygon> fans;
    for (std::size_t i = 0; i < 4; ++i) fans.push_back(polygon({{corners[i], corners[(i + 1) % 4], middle}}));
    for (std::int64_t y = -size; y < size; y += std::max(1, size / 20))
      for (std::int64_t x = -size; x < size; x += std::max(1, size / 20)) {
        int in = 0;
        for (const ClipPolygon& fan : fans)
          in += fan.contains({static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)});
        ASSERT_EQ(in, 1) << x << " " << y << " of " << size;
      }
  }
}

/// As many edges as a country's border: the same as asking them one by one.
TEST(ClipPolygon, ManyEdges) {
  std::mt19937 random(5);
  std::uniform_int_distribution<std::int32_t> away(200'000, 900'000), place(-1'000'000, 1'000'000);
  Ring ring;
  for (int i = 0; i < 20'000; ++i) {
    const double angle = 2 * 3.14159265 * i / 20'000;
    const double r = away(random);
    ring.push_back({static_cast<std::int32_t>(r * std::cos(angle)), static_cast<std::int32_t>(r * std::sin(angle))});
  }
  const ClipPolygon banded = polygon({ring});
  int in = 0;
  for (int k = 0; k < 300; ++k) {
    const Location p{place(random), place(random)};
    bool inside = false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Location a = ring[i], b = ring[(i + 1) % ring.size()];
      if ((a.lat > p.lat) == (b.lat > p.lat)) continue;
      const long double at = a.lon + (static_cast<long double>(p.lat) - a.lat) *
                                         (static_cast<long double>(b.lon) - a.lon) /
                                         (static_cast<long double>(b.lat) - a.lat);
      if (at > p.lon) inside = !inside;
    }
    EXPECT_EQ(banded.contains(p), inside);
    in += inside;
  }
  EXPECT_GT(in, 30);
}

TEST(PolyFile, SectionsAndHoles) {
  const TempFolder folder;
  const std::string path = folder.write("a.poly",
                                        "place\r\n1\n  1.0E+01 5.0e1\n\t11 50\n 11.0 +51\n 10 51 \n 10 50\nEND\n!2\n "
                                        "10.4 50.4\n 10.6 50.4\n 10.5 50.6\nEND\nEND\n\n");
  const ClipPolygon area = read_poly_file(path);
  EXPECT_TRUE(area.contains({101'000'000, 501'000'000}));
  EXPECT_TRUE(area.contains({109'999'999, 509'999'999}));
  EXPECT_FALSE(area.contains({110'000'001, 505'000'000}));
  EXPECT_FALSE(area.contains({105'000'000, 505'000'000}));
  // What overlaps is no hole, and a hole outside of all is nothing.
  const ClipPolygon two = read_poly_file(folder.write(
      "b.poly", "x\n1\n 0 0\n 2 0\n 2 2\n 0 2\nEND\n2\n 1 0\n 3 0\n 3 2\n 1 2\nEND\n!3\n 8 8\n 9 8\n 9 9\nEND\nEND\n"));
  EXPECT_TRUE(two.contains({15'000'000, 10'000'000}));
  EXPECT_FALSE(two.contains({88'000'000, 85'000'000}));
}

TEST(PolyFile, WhatIsWrongIsToldWithItsLine) {
  const std::pair<const char*, const char*> cases[] = {{"", "breaks off"},
                                                       {"name\n", "breaks off"},
                                                       {"name\nEND\n", "no section"},
                                                       {"name\n!1\n 1 1\n 2 1\n 2 2\nEND\nEND\n", "no section"},
                                                       {"name\n1\n 1 1\n 2 1\n 2 2\n", "breaks off"},
                                                       {"name\n1\n 1 1\n 2 1\n 2 2\nEND\n", "breaks off"},
                                                       {"name\n1\n 1 1\n 2 1\nEND\nEND\n", "line 5"},
                                                       {"name\n1\n 1 1\n 2 one\n 2 2\nEND\nEND\n", "line 4"},
                                                       {"name\n1\n 1 1\n 2 91\n 2 2\nEND\nEND\n", "line 4"},
                                                       {"name\n1\n 1 1\n 2 nan\n 2 2\nEND\nEND\n", "line 4"},
                                                       {"name\n1\n 1 1 1\n 2 1\n 2 2\nEND\nEND\n", "line 3"},
                                                       {"name\n1\n 1 1\n 2 1\n 2 2\nEND\nEND\nmore\n", "line 8"}};
  const TempFolder folder;
  for (const auto& [text, words] : cases) {
    SCOPED_TRACE(text);
    try {
      read_poly_file(folder.write("a.poly", text));
      ADD_FAILURE() << "is read";
    } catch (const base::InputError& error) {
      EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("a.poly"), testing::HasSubstr(words)));
    }
  }
  EXPECT_THROW(read_poly_file(folder.path("none.poly")), base::InputError);
}

}  // namespace
}  // namespace blockrand::importers::osm
