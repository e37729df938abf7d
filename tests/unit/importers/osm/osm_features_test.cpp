// Everything kept that is no building, and the attributes of those that are.
#include <gtest/gtest.h>

#include "tests/unit/importers/osm/support.h"

namespace blockrand::importers::osm::test {
namespace {

using enum model::FeatureKind;
using model::IssueCode;

std::uint32_t bits(std::initializer_list<model::FeatureKind> kinds) {
  std::uint32_t out = 0;
  for (const auto k : kinds) out |= static_cast<std::uint32_t>(k);
  return out;
}

TEST(Features, WaysBecomeLinesAndAreasByTheirTags) {
  struct Case {
    TagList tags;
    std::uint32_t kinds;
    bool area;
  };
  const Case cases[] = {
      {{{"highway", "residential"}}, bits({street}), false},
      {{{"highway", "pedestrian"}, {"area", "yes"}}, bits({street}), true},
      {{{"highway", "service"}, {"tunnel", "building_passage"}}, bits({street, passage}), false},
      {{{"highway", "footway"}, {"covered", "yes"}}, bits({street, passage}), false},
      {{{"highway", "footway"}, {"covered", "no"}}, bits({street}), false},
      {{{"landuse", "residential"}}, bits({land_use}), true},
      {{{"landuse", "residential"}, {"area", "no"}}, bits({land_use}), false},
      {{{"landuse", "basin"}}, bits({land_use, water}), true},
      {{{"leisure", "park"}, {"barrier", "fence"}}, bits({land_use, barrier}), false},
      {{{"leisure", "track"}}, bits({land_use}), false},
      {{{"natural", "water"}}, bits({water}), true},
      {{{"natural", "coastline"}}, bits({water}), false},
      {{{"natural", "wood"}}, bits({land_use}), true},
      {{{"natural", "tree_row"}}, bits({tree}), false},
      {{{"waterway", "river"}}, bits({water}), false},
      {{{"waterway", "riverbank"}}, bits({water}), true},
      {{{"railway", "tram"}}, bits({railway}), false},
      {{{"railway", "platform"}}, bits({railway}), true},
      {{{"barrier", "wall"}}, bits({barrier}), false},
      {{{"barrier", "hedge"}, {"area", "yes"}}, bits({barrier}), true},
      {{{"amenity", "school"}, {"addr:street", "x"}}, bits({amenity, address}), true},
      {{{"shop", "mall"}}, bits({shop}), true},
      {{{"place", "square"}}, bits({place}), true},
      {{{"boundary", "administrative"}}, bits({boundary}), true},
      {{{"roof:ridge", "yes"}}, bits({roof_line}), false},
      {{{"addr:interpolation", "odd"}}, bits({address}), false},
  };
  OsmText text;
  int n = 0;
  for (const Case& c : cases) {
    ++n;
    text.square(n, 100 * n, 20 * n, 0, 10, c.tags);
  }
  const auto e = text.read();
  n = 0;
  for (const Case& c : cases) {
    ++n;
    const auto* f = feature(e, "w" + std::to_string(n));
    ASSERT_NE(f, nullptr) << c.tags[0].first << '=' << c.tags[0].second;
    EXPECT_EQ(f->kinds, c.kinds) << c.tags[0].first << '=' << c.tags[0].second;
    EXPECT_EQ(f->area, c.area) << c.tags[0].first << '=' << c.tags[0].second;
    EXPECT_EQ(ring_sizes(e, f->rings), (std::vector<int>{c.area ? 4 : 5}));
  }
}

TEST(Features, NodesOfUse) {
  const auto e = OsmText()
                     .node(1, 13, 52, {{"natural", "tree"}})
                     .node(2, 13, 52, {{"entrance", "main"}, {"addr:housenumber", "3"}})
                     .node(3, 13, 52, {{"shop", "bakery"}})
                     .node(4, 13, 52, {{"amenity", "bench"}})
                     .node(5, 13, 52, {{"door", "hinged"}})
                     .node(6, 13, 52, {{"roof:apex", "yes"}})
                     .node(7, 13, 52, {{"place", "suburb"}, {"name", "x"}})
                     .node(8, 13, 52, {{"highway", "crossing"}})
                     .node(9, 13, 52, {{"entrance", "no"}})
                     .read();
  const std::uint32_t expected[] = {bits({tree}),     bits({entrance, address}), bits({shop}), bits({amenity}),
                                    bits({entrance}), bits({roof_apex}),         bits({place})};
  for (int i = 0; i < 7; ++i) {
    const auto* f = feature(e, "n" + std::to_string(i + 1));
    ASSERT_NE(f, nullptr) << i;
    EXPECT_EQ(f->kinds, expected[i]) << i;
    EXPECT_EQ(ring_sizes(e, f->rings), (std::vector<int>{1}));
  }
  EXPECT_EQ(e.features.size(), 7u);
}

TEST(Features, EntrancesKeepTheirNodeInTheRing) {
  const auto e = OsmText().square(1, 10, 0, 0, 10, {{"building", "yes"}}).read();
  const auto nodes = e.nodes_of(e.rings_of(building(e, "w1")->rings)[0]);
  EXPECT_NE(std::find(nodes.begin(), nodes.end(), 11), nodes.end());
}

TEST(Features, LinesAreCutWhereNodesAreMissing) {
  const auto e = OsmText().corners(10, 0, 0, 10).way(1, {10, 11, 99, 12, 13, 98}, {{"highway", "residential"}}).read();
  EXPECT_EQ(ring_sizes(e, feature(e, "w1")->rings), (std::vector<int>{2, 2}));
}

TEST(Features, MembersThatSayNoMoreThanTheirRelationAreLeftOut) {
  const TagList wood = {{"natural", "wood"}};
  const auto e =
      OsmText()
          .square(1, 10, 0, 0, 10, wood)
          .square(2, 20, 2, 2, 3, {{"natural", "water"}})
          .relation(1, {"w1 outer", "w2 inner"}, {{"type", "multipolygon"}, {"natural", "wood"}, {"name", "x"}})
          .read();
  EXPECT_EQ(feature(e, "w1"), nullptr);
  ASSERT_NE(feature(e, "w2"), nullptr);
  EXPECT_EQ(ring_sizes(e, feature(e, "r1")->rings), (std::vector<int>{4, -4}));
}

TEST(Features, ABrokenBoundaryIsKeptAsLines) {
  const auto e = OsmText()
                     .corners(10, 0, 0, 10)
                     .way(1, {10, 11, 12})
                     .relation(1, {"w1 outer", "w99 outer"}, {{"type", "boundary"}, {"boundary", "administrative"}})
                     .read();
  ASSERT_NE(feature(e, "r1"), nullptr);
  EXPECT_FALSE(feature(e, "r1")->area);
  EXPECT_EQ(ring_sizes(e, feature(e, "r1")->rings), (std::vector<int>{3}));
  EXPECT_EQ(rows(e, "r1", IssueCode::members_missing), "kept as lines; not in the file: w99");
}

TEST(Attributes, AreReadWithTheirPrecedence) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10,
                             {{"building", "apartments"},
                              {"height", "tall"},
                              {"building:height", "21 m"},
                              {"est_height", "30"},
                              {"building:levels", "5;6"},
                              {"levels", "9"},
                              {"min_height", "3;2"},
                              {"building:min_level", "1"},
                              {"roof:levels", "1"},
                              {"building:levels:underground", "2"},
                              {"roof:height", "4"},
                              {"roof:angle", "30°"},
                              {"roof:slope:direction", "SSW"},
                              {"roof:orientation", "across"},
                              {"building:roof:shape", "hipped"},
                              {"building:colour", "#a33"},
                              {"roof:color", "DarkRed"},
                              {"building:facade:material", "brick"},
                              {"roof:material", "roof_tiles"}})
                     .read();
  const auto& a = building(e, "w1")->attributes;
  EXPECT_EQ(a.height, 21.0f);
  EXPECT_EQ(a.storeys, 6.0f);
  EXPECT_EQ(a.min_height, 2.0f);
  EXPECT_EQ(a.min_storey, 1.0f);
  EXPECT_EQ(a.roof_storeys, 1.0f);
  EXPECT_EQ(a.storeys_underground, 2.0f);
  EXPECT_EQ(a.roof_height, 4.0f);
  EXPECT_EQ(a.roof_angle, 30.0f);
  EXPECT_EQ(a.roof_direction, 202.5f);
  EXPECT_EQ(a.roof_orientation, model::RoofOrientation::across);
  EXPECT_EQ(a.roof_shape, model::RoofShape::hipped);
  EXPECT_EQ(a.wall_colour, (model::Colour{0xaa, 0x33, 0x33}));
  EXPECT_EQ(a.roof_colour, (model::Colour{0x8b, 0, 0}));
  EXPECT_EQ(e.strings.view(a.wall_material), "brick");
  EXPECT_EQ(e.strings.view(a.roof_material), "roof_tiles");
  EXPECT_EQ(e.strings.view(a.use), "apartments");
  EXPECT_EQ(rows(e, "w1", IssueCode::value_unreadable), "height=tall");
}

TEST(Attributes, OutsideTheLimitsNothingIsSet) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10,
                             {{"building", "yes"},
                              {"height", "-3"},
                              {"building:levels", "500"},
                              {"roof:angle", "95"},
                              {"min_height", "-1"},
                              {"roof:colour", "mauveish"},
                              {"roof:shape", "zigzag"}})
                     .square(2, 20, 20, 0, 10,
                             {{"building", "yes"}, {"height", "0"}, {"building:levels", "0"}, {"roof:levels", "1"}})
                     .read();
  const auto& a = building(e, "w1")->attributes;
  EXPECT_FALSE(a.height);
  EXPECT_FALSE(a.storeys);
  EXPECT_FALSE(a.roof_angle);
  EXPECT_FALSE(a.min_height);
  EXPECT_FALSE(a.roof_colour);
  EXPECT_EQ(a.roof_shape, model::RoofShape::other);
  EXPECT_EQ(e.tag(building(e, "w1")->tags, "roof:shape"), "zigzag");
  EXPECT_EQ(rows(e, "w1", IssueCode::value_clamped), "building:levels=500 | height=-3 | min_height=-1 | roof:angle=95");
  EXPECT_EQ(rows(e, "w1", IssueCode::value_unreadable), "roof:colour=mauveish");
  EXPECT_FALSE(building(e, "w2")->attributes.height);
  EXPECT_EQ(building(e, "w2")->attributes.storeys, 0.0f);
}

TEST(Attributes, BuildingRoofIsAShapeOnlyWhereItNamesOne) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10, {{"building", "yes"}, {"building:roof", "gabled"}})
                     .square(2, 20, 20, 0, 10, {{"building", "yes"}, {"building:roof", "tile"}})
                     .read();
  EXPECT_EQ(building(e, "w1")->attributes.roof_shape, model::RoofShape::gabled);
  EXPECT_FALSE(building(e, "w2")->attributes.roof_shape);
  EXPECT_TRUE(e.report.rows.empty());
}

}  // namespace
}  // namespace blockrand::importers::osm::test
