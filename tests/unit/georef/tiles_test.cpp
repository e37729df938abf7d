#include "pipeline/georef/tiles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "pipeline/base/random.h"

namespace blockrand::georef {
namespace {

using model::Location;
using model::TileId;

TEST(Tiles, LevelZeroIsTwoHemispheres) {
  EXPECT_EQ(tile_of({-1'800'000'000, 0}, 0), (TileId{0, 0, 0}));
  EXPECT_EQ(tile_of({-1, 0}, 0), (TileId{0, 0, 0}));
  EXPECT_EQ(tile_of({0, 0}, 0), (TileId{0, 1, 0}));
}

TEST(Tiles, EdgesOfTheGlobeFallIntoTheLastTile) {
  EXPECT_EQ(tile_of({1'800'000'000, 900'000'000}, 15), (TileId{15, 65535, 32767}));
  EXPECT_EQ(tile_of({-1'800'000'000, -900'000'000}, 15), (TileId{15, 0, 0}));
  EXPECT_EQ(tile_of({2'000'000'000, 1'000'000'000}, 15), (TileId{15, 65535, 32767}));  // no place on earth
  EXPECT_EQ(tile_of({1'800'000'000, 900'000'000}, kMaxTileLevel), (TileId{30, 2147483647, 1073741823}));
}

TEST(Tiles, WestAndSouthEdgesBelongToTheTile) {
  // Level 10: tiles of 0.17578125 degrees, whose edges OSM can store exactly every 4th tile.
  const double size = 180.0 / 1024;
  EXPECT_EQ(bounds({10, 4, 8}).west, -180 + 4 * size);
  const TileId tile{10, 1024 + 64, 512 + 64};
  const GeoBox b = bounds(tile);
  const Location corner{static_cast<std::int32_t>(std::lround(b.west * 1e7)),
                        static_cast<std::int32_t>(std::lround(b.south * 1e7))};
  ASSERT_EQ(corner.lon_degrees(), b.west);
  EXPECT_EQ(tile_of(corner, 10), tile);
  EXPECT_EQ(tile_of({corner.lon - 1, corner.lat}, 10), (TileId{10, tile.x - 1, tile.y}));
  EXPECT_EQ(tile_of({corner.lon, corner.lat - 1}, 10), (TileId{10, tile.x, tile.y - 1}));
}

TEST(Tiles, BoundsHoldTheirPoints) {
  for (int i = 0; i < 20000; ++i) {
    const auto key = static_cast<std::uint64_t>(i);
    const Location p{static_cast<std::int32_t>((base::random_unit(1, key, "lon") - 0.5) * 3.6e9),
                     static_cast<std::int32_t>((base::random_unit(1, key, "lat") - 0.5) * 1.8e9)};
    const int level = i % (kMaxTileLevel + 1);
    const TileId tile = tile_of(p, level);
    const GeoBox b = bounds(tile);
    constexpr double kLastBit = 1e-13;  // of degrees as doubles; tile_of itself is exact
    EXPECT_GE(p.lon_degrees(), b.west - kLastBit);
    EXPECT_LE(p.lon_degrees(), b.east + kLastBit);
    EXPECT_GE(p.lat_degrees(), b.south - kLastBit);
    EXPECT_LE(p.lat_degrees(), b.north + kLastBit);
    if (level > 0) {
      const TileId above{level - 1, tile.x / 2, tile.y / 2};
      EXPECT_EQ(above, tile_of(p, level - 1));
      EXPECT_TRUE(contains(above, tile));
      EXPECT_FALSE(contains(tile, above));
    }
  }
}

}  // namespace
}  // namespace blockrand::georef
