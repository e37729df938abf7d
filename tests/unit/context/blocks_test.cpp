#include "pipeline/context/blocks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::context {
namespace {

using model::OsmId;
using model::OsmType;
using model::Point2;
using ::testing::ElementsAre;

constexpr Point2 kPlace{391000, 5820000};

/// A line through points; node ids come from the place, so that lines meet in the same nodes.
NetworkLine street(std::int64_t way, std::vector<Point2> points, LineClass kind = LineClass::residential) {
  NetworkLine line;
  line.id = {OsmType::way, way};
  line.kind = kind;
  for (const Point2 p : points) {
    line.points.push_back(model::snap(Point2{kPlace.x + p.x, kPlace.y + p.y}));
    line.nodes.push_back(static_cast<std::int64_t>(p.x) * 10000 + static_cast<std::int64_t>(p.y) + 1);
  }
  return line;
}

std::vector<Point2> box(double x, double y, double width, double height) {
  return {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}, {x, y}};
}

NetworkLine area(std::int64_t way, std::vector<Point2> ring, LineClass kind) {
  NetworkLine line = street(way, std::move(ring), kind);
  line.area = true;
  return line;
}

NetworkLine carriageway(std::int64_t way, std::vector<Point2> points, const std::string& name) {
  NetworkLine line = street(way, std::move(points), LineClass::primary);
  line.oneway = true;
  line.name = name;
  return line;
}

std::vector<BlockKind> kinds(const std::vector<Block>& blocks) {
  std::vector<BlockKind> out;
  for (const Block& b : blocks) out.push_back(b.kind);
  return out;
}

/// Three by three blocks of 100 m between streets that reach 20 m beyond.
std::vector<NetworkLine> grid_of_streets() {
  std::vector<NetworkLine> lines;
  for (int i = 0; i <= 3; ++i) {
    lines.push_back(street(
        10 + i,
        {{i * 100.0, -20}, {i * 100.0, 0}, {i * 100.0, 100}, {i * 100.0, 200}, {i * 100.0, 300}, {i * 100.0, 320}}));
    lines.push_back(street(
        20 + i,
        {{-20, i * 100.0}, {0, i * 100.0}, {100, i * 100.0}, {200, i * 100.0}, {300, i * 100.0}, {320, i * 100.0}}));
  }
  return lines;
}

TEST(Blocks, LieBetweenStreets) {
  const auto blocks = find_blocks(grid_of_streets(), {});
  ASSERT_EQ(blocks.size(), 9u);
  std::set<std::string> ids;
  for (const Block& b : blocks) {
    EXPECT_DOUBLE_EQ(b.area, 10000);
    EXPECT_TRUE(b.gives_ratios());
    EXPECT_EQ(b.borders.size(), 4u);
    ids.insert(b.id);
  }
  EXPECT_EQ(ids.size(), 9u);
  EXPECT_EQ(blocks[0].id, "w10.n101.r") << "west of it runs way 10 northwards, which leaves the block on its right";
  EXPECT_DOUBLE_EQ(blocks[0].borders[0].length, 100);
}

TEST(Blocks, WhatRunsInsideThemDoesNotDivide) {
  for (const LineClass kind : {LineClass::other, LineClass::residential}) {
    std::vector lines{street(1, box(0, 0, 100, 100)), street(2, {{50, -10}, {50, 0}, {50, 100}, {50, 110}}, kind)};
    EXPECT_EQ(find_blocks(lines, {}).size(), kind == LineClass::other ? 1u : 2u);
    lines[1].tunnel = true;
    EXPECT_EQ(find_blocks(lines, {}).size(), 1u) << "houses stand above a tunnel";
    lines[1].tunnel = false;
    lines[1].bridge = true;
    lines[1].layer = 1;
    EXPECT_EQ(find_blocks(lines, {}).size(), kind == LineClass::other ? 1u : 2u) << "a bridge divides";
  }
}

TEST(Blocks, TheStripBetweenCarriagewaysIsNone) {
  std::vector lines{carriageway(1, {{-50, 0}, {0, 0}, {300, 0}, {350, 0}}, "Allee"),
                    carriageway(2, {{350, 15}, {300, 15}, {0, 15}, {-50, 15}}, "Allee"),
                    street(3, {{0, -100}, {0, 0}, {0, 15}, {0, 100}}),
                    street(4, {{300, -100}, {300, 0}, {300, 15}, {300, 100}}), street(5, {{0, 100}, {300, 100}})};
  EXPECT_THAT(kinds(find_blocks(lines, {})), ElementsAre(BlockKind::between_carriageways, BlockKind::ordinary));
  lines[1].name = "Ufer";
  EXPECT_THAT(kinds(find_blocks(lines, {})), ElementsAre(BlockKind::ordinary, BlockKind::ordinary)) << "two streets";
  lines[1].name = "Allee";
  lines[0].oneway = lines[1].oneway = false;
  EXPECT_THAT(kinds(find_blocks(lines, {})), ElementsAre(BlockKind::ordinary, BlockKind::ordinary))
      << "no carriageways";
  for (NetworkLine& l : lines)
    for (Point2& p : l.points)
      if (p.y == kPlace.y + 15) p.y += 25;
  lines[0].oneway = lines[1].oneway = true;
  EXPECT_THAT(kinds(find_blocks(lines, {})), ElementsAre(BlockKind::ordinary, BlockKind::ordinary))
      << "room for houses";
}

TEST(Blocks, TracksRoundaboutsSliversAndSquares) {
  const auto tracks =
      std::vector{street(1, {{0, -10}, {0, 0}, {0, 8}, {0, 90}, {300, 90}, {300, 8}, {300, 0}, {300, -10}}),
                  street(2, {{0, 0}, {300, 0}}, LineClass::railway), street(3, {{0, 8}, {300, 8}}, LineClass::railway)};
  EXPECT_THAT(kinds(find_blocks(tracks, {})), ElementsAre(BlockKind::between_tracks, BlockKind::ordinary));
  NetworkLine roundabout = street(1, {{0, 0}, {14, 0}, {20, 10}, {14, 20}, {0, 20}, {-6, 10}, {0, 0}});
  roundabout.roundabout = roundabout.oneway = true;
  EXPECT_THAT(kinds(find_blocks(std::vector{roundabout}, {})), ElementsAre(BlockKind::between_carriageways));
  NetworkLine circus = street(1, box(0, 0, 70, 70));
  circus.roundabout = circus.oneway = true;
  EXPECT_THAT(kinds(find_blocks(std::vector{circus}, {})), ElementsAre(BlockKind::between_carriageways));
  circus.points = street(1, box(0, 0, 170, 170)).points;
  EXPECT_THAT(kinds(find_blocks(std::vector{circus}, {})), ElementsAre(BlockKind::ordinary)) << "houses stand within";
  EXPECT_THAT(kinds(find_blocks(std::vector{street(1, box(0, 0, 12, 10))}, {})), ElementsAre(BlockKind::street_space))
      << "a traffic island, 5.5 m wide by 2 area / perimeter";
}

TEST(Blocks, SquaresAndWatersAreNoBuiltLand) {
  const auto lines =
      std::vector{street(1, box(0, 0, 200, 200)), area(2, box(20, 20, 60, 60), LineClass::pedestrian),
                  area(3, box(100, 100, 80, 80), LineClass::shore), area(3, box(120, 120, 20, 20), LineClass::shore)};
  const auto blocks = find_blocks(lines, {});
  EXPECT_THAT(kinds(blocks),
              ElementsAre(BlockKind::ordinary, BlockKind::street_space, BlockKind::water, BlockKind::ordinary))
      << "the second ring of the water is an island";
  EXPECT_DOUBLE_EQ(blocks[0].area, 40000 - 3600 - 6400);
  EXPECT_EQ(blocks[0].polygon.holes.size(), 2u);
}

TEST(Blocks, TheSeaLiesOnTheRightOfACoast) {
  const std::vector<Point2> east{{0, 0}, {100, 0}, {100, 100}, {0, 100}};
  for (const bool land : {true, false}) {
    std::vector<Point2> coast{{0, 100}, {0, 0}};
    if (!land) std::swap(coast[0], coast[1]);
    const auto blocks = find_blocks(std::vector{street(1, east), street(2, coast, LineClass::coastline)}, {});
    EXPECT_THAT(kinds(blocks), ElementsAre(land ? BlockKind::ordinary : BlockKind::water));
  }
}

TEST(Blocks, CutByTheEdgeOfTheExtract) {
  const auto lines = grid_of_streets();
  // Data ends 40 m west of the last street but one.
  std::vector<Point2> points;
  for (const Point2 p : {Point2{5, 5}, {160, 5}, {160, 295}, {5, 295}, {80, 100}})
    points.push_back({p.x + kPlace.x, p.y + kPlace.y});
  const auto coverage = coverage_of(points);
  EXPECT_EQ(coverage.size(), 4u);
  EXPECT_GT(geometry::signed_area(coverage), 0);
  int cut = 0;
  for (const Block& b : find_blocks(lines, coverage)) {
    EXPECT_EQ(b.cut_by_extract_edge, b.polygon.outer.points[0].x >= kPlace.x + 100)
        << "nearer than the margin is inside";
    EXPECT_NE(b.cut_by_extract_edge, b.gives_ratios());
    cut += b.cut_by_extract_edge;
  }
  EXPECT_EQ(cut, 6);
  EXPECT_TRUE(coverage_of(std::vector<Point2>{{0, 0}, {5, 5}, {10, 10}}).empty()) << "a line covers nothing";
}

TEST(Blocks, CutWhereAMainStreetEndsWithoutACause) {
  auto lines = grid_of_streets();
  lines.push_back(street(50, {{0, 100}, {40, 50}}, LineClass::secondary));
  const auto flags = [&] {
    int cut = 0;
    for (const Block& b : find_blocks(lines, {})) cut += b.cut_by_extract_edge;
    return cut;
  };
  EXPECT_EQ(flags(), 1);
  lines.push_back(street(51, {{40, 50}, {60, 50}}, LineClass::other));
  EXPECT_EQ(flags(), 0) << "it goes on as something smaller";
  lines.back() = street(51, {{40, 60}, {60, 60}}, LineClass::other);
  lines[lines.size() - 2].kind = LineClass::residential;
  EXPECT_EQ(flags(), 0) << "a blind alley";
}

TEST(Blocks, TooLargeOnesGiveNoRatios) {
  const auto blocks = find_blocks(std::vector{street(1, box(0, 0, 1001, 50)), street(2, box(0, 100, 1000, 50))}, {});
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_TRUE(blocks[0].too_large);
  EXPECT_FALSE(blocks[0].gives_ratios());
  EXPECT_FALSE(blocks[1].too_large);
}

TEST(Blocks, IdsTellTheSidesOfALoopApart) {
  // A closed way with one street through it: both halves have the same ways and the same junctions.
  const auto blocks =
      find_blocks(std::vector{street(7, {{0, 0}, {100, 0}, {100, 50}, {100, 100}, {0, 100}, {0, 50}, {0, 0}}),
                              street(9, {{0, 50}, {100, 50}})},
                  {});
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_NE(blocks[0].id, blocks[1].id);
}

TEST(Blocks, IdsTellTheLoopsOfAStreetThatPassesANodeTwiceApart) {
  // Way 1 leaves its first node around one loop and then around another, each on its left.
  const auto blocks =
      find_blocks(std::vector{street(1, {{0, 0}, {100, 0}, {100, 50}, {0, 0}, {100, 100}, {50, 100}, {0, 0}})}, {}, {});
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(std::set<std::string>({blocks[0].id, blocks[1].id}).size(), 2u) << blocks[0].id << " " << blocks[1].id;
  EXPECT_EQ(blocks[1].id, blocks[0].id + ".2");
}

TEST(Blocks, WhereOnlyBridgesCrossThePlaceStandsForTheNode) {
  std::vector lines{street(1, {{-50, 0}, {150, 0}}), street(2, {{-50, 100}, {150, 100}}),
                    street(3, {{0, -50}, {0, 150}}), street(4, {{100, -50}, {100, 150}})};
  const auto blocks = find_blocks(lines, {});
  ASSERT_EQ(blocks.size(), 1u);
  EXPECT_EQ(blocks[0].id, "w1.p400384000_5959680000.l");
}

TEST(Blocks, OrderAndCutsOfLinesDoNotMatterAndABlockDependsOnItsBoxAlone) {
  auto lines = grid_of_streets();
  lines.push_back(area(30, box(120, 120, 30, 30), LineClass::pedestrian));
  lines.push_back(street(31, {{0, 30}, {35, 47}, {100, 71}}));
  const auto blocks = find_blocks(lines, {});
  std::mt19937 random(5);
  std::shuffle(lines.begin(), lines.end(), random);
  const auto again = find_blocks(lines, {});
  ASSERT_EQ(blocks.size(), 11u);
  ASSERT_EQ(again.size(), blocks.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    EXPECT_EQ(blocks[i].id, again[i].id);
    EXPECT_EQ(blocks[i].polygon.outer.points, again[i].polygon.outer.points);
    EXPECT_EQ(blocks[i].kind, again[i].kind);
  }
  // Only the four streets around the first two blocks and the one between.
  std::erase_if(lines, [](const NetworkLine& l) {
    return l.id.number != 10 && l.id.number != 11 && l.id.number != 20 && l.id.number != 21 && l.id.number != 31;
  });
  const auto near = find_blocks(lines, {});
  ASSERT_EQ(near.size(), 2u);
  EXPECT_EQ(near[0].id, blocks[0].id);
  EXPECT_EQ(near[0].polygon.outer.points, blocks[0].polygon.outer.points);
  EXPECT_EQ(near[1].id, blocks[1].id);
}

// ---- from an extract ------------------------------------------------------------------------------------------------

class ExtractMaker {
 public:
  void add(std::int64_t id, model::FeatureKind kind, std::vector<std::pair<std::string, std::string>> tags,
           bool area = false, std::int32_t size = 100) {
    model::Feature f;
    f.id = {OsmType::way, id};
    f.kinds = static_cast<std::uint32_t>(kind);
    f.area = area;
    f.rings = {static_cast<std::uint32_t>(e.rings.size()), 1};
    e.rings.push_back({{static_cast<std::uint32_t>(e.vertices.size()), area ? 4u : 2u}, false});
    for (const model::Location v : {model::Location{0, 0}, {size, 0}, {size, size}, {0, size}}) {
      if (!area && e.vertices.size() == e.rings.back().vertices.first + 2u) break;
      e.vertices.push_back(v);
      e.vertex_nodes.push_back(id * 10 + static_cast<std::int64_t>(e.vertices.size()));
    }
    f.tags = {static_cast<std::uint32_t>(e.tags.size()), static_cast<std::uint32_t>(tags.size())};
    for (const auto& [key, value] : tags) e.tags.push_back({e.strings.intern(key), e.strings.intern(value)});
    e.features.push_back(f);
  }
  /// Class of each line, by OSM id.
  std::map<std::int64_t, NetworkLine> lines() const {
    std::map<std::int64_t, NetworkLine> out;
    for (NetworkLine& l : network_lines(e, [](model::Location v) { return Point2{v.lon * 1.0003, v.lat * 1.0003}; }))
      out[l.id.number] = std::move(l);
    return out;
  }
  model::Extract e;
};

TEST(NetworkLines, TakeWhatTheTagsSay) {
  using enum model::FeatureKind;
  ExtractMaker m;
  m.add(1, street, {{"highway", "primary_link"}, {"name", "Damm"}, {"oneway", "yes"}});
  m.add(2, street, {{"highway", "service"}});
  m.add(3, street, {{"highway", "residential"}, {"tunnel", "building_passage"}});
  m.add(4, street, {{"highway", "secondary"}, {"tunnel", "yes"}});
  m.add(5, railway, {{"railway", "rail"}});
  m.add(6, railway, {{"railway", "rail"}, {"service", "yard"}});
  m.add(7, railway, {{"railway", "tram"}});
  m.add(8, railway, {{"railway", "light_rail"}, {"bridge", "yes"}, {"layer", "-2"}});
  m.add(9, water, {{"waterway", "stream"}});
  m.add(10, water, {{"waterway", "river"}});
  m.add(11, water, {{"natural", "water"}}, true, 100);
  m.add(12, water, {{"natural", "water"}}, true, 30);
  m.add(13, street, {{"highway", "pedestrian"}, {"area", "yes"}}, true);
  m.add(14, street, {{"highway", "service"}, {"area", "yes"}}, true);
  m.add(15, street, {{"highway", "construction"}});
  const auto lines = m.lines();
  EXPECT_EQ(lines.at(1).kind, LineClass::primary);
  EXPECT_TRUE(lines.at(1).oneway);
  EXPECT_EQ(lines.at(1).name, "Damm");
  EXPECT_EQ(lines.at(1).points[1], model::snap(Point2{100.03, 0})) << "on the grid";
  EXPECT_EQ(lines.at(1).nodes.size(), 2u);
  std::vector<std::int64_t> bounding;
  for (const auto& [id, line] : lines)
    if (bounds_blocks(line)) bounding.push_back(id);
  EXPECT_THAT(bounding, ElementsAre(1, 3, 5, 8, 10, 11, 13));
  EXPECT_EQ(lines.at(8).layer, -2);
  EXPECT_TRUE(lines.at(4).tunnel);
  EXPECT_FALSE(lines.contains(7));
  EXPECT_FALSE(lines.contains(12)) << "a pond";
  EXPECT_EQ(lines.at(11).kind, LineClass::shore);
  EXPECT_EQ(lines.at(13).points.size(), 5u);
  EXPECT_EQ(lines.at(13).points.front(), lines.at(13).points.back());
}

}  // namespace
}  // namespace blockrand::context
