// Features of small towns that are known by construction.
#include "pipeline/evidence/building_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/run/osm_town.h"

namespace blockrand::evidence {
namespace {

using classify::Feature;
using model::BuildingPosition;
using run::test::MeasuredTown;
using run::test::OsmTown;

/// Coordinates of OSM have 1 cm, repair's squaring a few.
constexpr double kLength = 0.15;
/// Features are rounded to 1 / kFeatureSteps.
constexpr double kShare = 0.5 / 256 + 1e-6;

/// A block of 200 x 100 m between four streets. On South Street, fronts 10 m from its middle, wall to wall from the
/// west: 1 to 5 boxes 12 m wide and 12 m deep; 6 the same with a wing of 4 m back to a depth of 30 m; 7 is 18 m wide. 8
/// stands in the yard of 12, a ring of four wings 10 m deep on East Street; 9 is a shed of 3 x 4 m; 10 stands alone on
/// North Street, 9 m from its middle.
OsmTown block() {
  OsmTown t;
  t.street(901, {{-60, 0}, {0, 0}, {200, 0}, {260, 0}}, "South Street");
  t.street(902, {{200, -60}, {200, 0}, {200, 100}, {200, 160}}, "East Street", "tertiary");
  t.street(903, {{260, 100}, {200, 100}, {0, 100}, {-60, 100}}, "North Street");
  t.street(904, {{0, 160}, {0, 100}, {0, 0}, {0, -60}}, "West Street");
  for (int i = 0; i < 5; ++i) t.box(1 + i, 40 + 12 * i, 10, 12, 12);
  t.house(6, {{100, 10}, {112, 10}, {112, 22}, {104, 22}, {104, 40}, {100, 40}, {100, 22}});
  t.box(7, 112, 10, 18, 12);
  t.box(8, 156, 46, 12, 10);
  t.box(9, 20, 50, 3, 4);
  t.box(10, 60, 81, 10, 10);
  t.ring(12, {{140, 30}, {185, 30}, {185, 75}, {140, 75}}, {{150, 40}, {175, 40}, {175, 65}, {150, 65}});
  return t;
}

const MeasuredTown& town() {
  static const MeasuredTown measured(block(), "facts_block");
  return measured;
}

TEST(BuildingFacts, ThePlanAlone) {
  EXPECT_NEAR(town().of(1, Feature::area), 144, 2);
  EXPECT_NEAR(town().of(7, Feature::length), 18, kLength);
  EXPECT_NEAR(town().of(7, Feature::breadth), 12, kLength);
  EXPECT_NEAR(town().of(7, Feature::elongation), 1.5, 0.02);
  EXPECT_NEAR(town().of(7, Feature::rectangularity), 1, 0.01);
  EXPECT_NEAR(town().of(1, Feature::compactness), M_PI / 4, 0.01);
  EXPECT_EQ(town().of(1, Feature::corners), 4);
  EXPECT_EQ(town().of(6, Feature::corners), 6) << "the point where the wing leaves the party wall is none";
  EXPECT_EQ(town().of(1, Feature::yards), 0);
  EXPECT_EQ(town().of_relation(12, Feature::yards), 1);
}

TEST(BuildingFacts, DepthRatioTellsWings) {
  EXPECT_NEAR(town().of(1, Feature::frontage), 12, kLength);
  EXPECT_NEAR(town().of(1, Feature::front_depth), 12, kLength);
  EXPECT_NEAR(town().of(1, Feature::depth_ratio), 1, 0.02);
  EXPECT_NEAR(town().of(6, Feature::front_depth), 12, kLength) << "of the house, not of its wing";
  EXPECT_NEAR(town().of(6, Feature::depth_ratio), 30.0 / 12, 0.05);
  EXPECT_FALSE(town().knows(8, Feature::depth_ratio)) << "no front, no depth behind it";
}

TEST(BuildingFacts, PartyWallsAndNeighbours) {
  EXPECT_NEAR(town().of(2, Feature::party_share), 24.0 / 48, 0.01);
  EXPECT_NEAR(town().of(1, Feature::party_share), 12.0 / 48, 0.01) << "the end of the row";
  EXPECT_EQ(town().of(10, Feature::party_share), 0);
  EXPECT_EQ(town().of(2, Feature::neighbours), 2);
  EXPECT_EQ(town().of(10, Feature::neighbours), 0);
  const auto contacts = town().facts.contacts_of(town().number(6));
  ASSERT_EQ(contacts.size(), 2u);
  for (const Contact& c : contacts) EXPECT_NEAR(static_cast<double>(c.length), 12, kLength);
}

TEST(BuildingFacts, PositionAndStreet) {
  EXPECT_EQ(town().of(3, Feature::position), static_cast<double>(BuildingPosition::mid_row));
  EXPECT_EQ(town().of(1, Feature::position), static_cast<double>(BuildingPosition::end_of_row));
  EXPECT_EQ(town().of(8, Feature::position), static_cast<double>(BuildingPosition::rear_building));
  EXPECT_EQ(town().of(10, Feature::position), static_cast<double>(BuildingPosition::free_standing));
  EXPECT_NEAR(town().of(3, Feature::street_distance), 10, kLength);
  EXPECT_NEAR(town().of(3, Feature::street_angle), 0, 0.5);
  EXPECT_EQ(town().of(3, Feature::street_class), 6) << "residential";
  EXPECT_NEAR(town().of(3, Feature::front_share), 0.25, 0.01);
  EXPECT_NE(town().facts.places[town().number(3)].street, town().facts.places[town().number(10)].street);
  EXPECT_EQ(town().facts.places[town().number(3)].street, town().facts.places[town().number(7)].street);
  EXPECT_EQ(town().facts.places[town().number(8)].street, 0u);
  EXPECT_NEAR(town().of(8, Feature::front_gap), 6, kLength) << "to the walls of the yard";
}

TEST(BuildingFacts, TheRowIsOneThroughAnother) {
  for (const std::int64_t id : {1, 3, 7}) {
    EXPECT_EQ(town().of(id, Feature::row_count), 7) << id;
    EXPECT_NEAR(town().of(id, Feature::row_length), 90, 2 * kLength) << id;
    EXPECT_NEAR(town().of(id, Feature::row_breadth), 30, 2 * kLength) << id;
    EXPECT_NEAR(town().of(id, Feature::row_area), 6 * 144 + 72 + 216, 6) << id;
    EXPECT_NEAR(town().of(id, Feature::row_fill), 1152.0 / 2700, 0.01) << id;
  }
  EXPECT_EQ(town().of(10, Feature::row_count), 1);
  EXPECT_NEAR(town().of(10, Feature::row_area), 100, 2);
}

TEST(BuildingFacts, HousesAlikeRepeatEachOther) {
  EXPECT_EQ(town().of(2, Feature::row_alike), 1);
  EXPECT_EQ(town().of(5, Feature::row_alike), 0.5) << "like 4, unlike 6 with its wing";
  EXPECT_EQ(town().of(7, Feature::row_alike), 0) << "wider than its neighbour";
  EXPECT_FALSE(town().knows(10, Feature::row_alike)) << "touches nobody";
}

TEST(BuildingFacts, TheStreetIsAsWideAsItsFrontsAreApart) {
  EXPECT_NEAR(town().of(3, Feature::street_width), 20, 2 * kLength);
  EXPECT_NEAR(town().of(10, Feature::street_width), 18, 2 * kLength);
  EXPECT_FALSE(town().knows(8, Feature::street_width));
}

TEST(BuildingFacts, HousesAndShedsAround) {
  EXPECT_TRUE(town().facts.places[town().number(8)].house);
  EXPECT_FALSE(town().facts.places[town().number(9)].house) << "12 m2";
  // Around 4: nine houses beside itself; 6 and 12 are deeper than their front, 8 is a rear building, and there is one
  // shed.
  EXPECT_NEAR(town().of(4, Feature::around_rear), 1.0 / 9, kShare);
  EXPECT_NEAR(town().of(4, Feature::around_small), 1.0 / 9, kShare);
  EXPECT_NEAR(town().of(4, Feature::around_depth_ratio), 2.0 / 8, kShare) << "of those with a front";
  EXPECT_NEAR(town().of(4, Feature::around_depth), 12, kLength);
  EXPECT_NEAR(town().of(4, Feature::around_frontage), 12, kLength);
  EXPECT_NEAR(town().of(4, Feature::around_area), 144, 2);
}

TEST(BuildingFacts, ReadNoTagsOfTheBuilding) {
  const classify::FeatureVector& f = town().facts.features[town().number(3)];
  for (std::size_t i = 0; i < classify::kFeatureCount; ++i)
    if (classify::is_tag(static_cast<Feature>(i))) {
      EXPECT_FALSE(f.has(static_cast<Feature>(i))) << classify::kFeatures[i].name;
    }
}

// ---- a town of many blocks ------------------------------------------------------------------------------------------

/// Blocks of 100 m from (first, first) to (last, last), each with houses of many widths and depths; a block has the
/// same houses with the same ids in every town that has it.
OsmTown blocks(int first, int last) {
  OsmTown t;
  const double low = 100.0 * first, high = 100.0 * (last + 1);
  for (int i = first; i <= last + 1; ++i) {
    OsmTown::Points across, up;
    for (int k = first; k <= last + 1; ++k) {
      across.push_back({100.0 * k, 100.0 * i});
      up.push_back({100.0 * i, 100.0 * k});
    }
    across.insert(across.begin(), {low - 20, 100.0 * i});
    across.push_back({high + 20, 100.0 * i});
    t.street(900000 + i, across, fmt::format("{}. Street", i));
    t.street(910000 + i, up, fmt::format("{}. Avenue", i), i % 3 == 0 ? "secondary" : "residential");
  }
  for (int bx = first; bx <= last; ++bx)
    for (int by = first; by <= last; ++by) {
      const double x = 100.0 * bx, y = 100.0 * by;
      const int id = 1000 + (bx * 50 + by) * 40;
      double at = 12;
      for (int k = 0; k < 6; ++k) {
        const int mix = (bx * 7 + by * 13 + k * 5) % 11;
        const double width = 9 + mix % 5, depth = 10 + mix % 4, wing = mix % 3 == 0 ? 14 : 0;
        if (wing > 0)
          t.house(id + k, {{x + at, y + 9},
                           {x + at + width, y + 9},
                           {x + at + width, y + 9 + depth},
                           {x + at + 4, y + 9 + depth},
                           {x + at + 4, y + 9 + depth + wing},
                           {x + at, y + 9 + depth + wing}});
        else
          t.box(id + k, x + at, y + 9, width, depth);
        at += width;
      }
      t.box(id + 10, x + 20 + (bx + by) % 5, y + 76, 12 + by % 4, 13);
      t.box(id + 11, x + 55, y + 74, 14 + bx % 3, 15);
      t.box(id + 12, x + 30, y + 52, 15, 9);
      if ((bx + by) % 2 == 0) t.box(id + 13, x + 60, y + 55, 5, 5);
    }
  return t;
}

TEST(BuildingFacts, APartOfATownGivesTheSameInsideIt) {
  const MeasuredTown whole(blocks(0, 11), "facts_whole");
  const MeasuredTown part(blocks(1, 9), "facts_part", &whole, 1);
  ASSERT_EQ(whole.repaired->footprints.size(), 144u * 9 + 72);
  int compared = 0, known = 0;
  for (const int block : {5 * 50 + 5, 5 * 50 + 4, 4 * 50 + 5})  // 400 m inside the part
    for (const int k : {0, 1, 2, 3, 4, 5, 10, 11, 12}) {
      const std::int64_t id = 1000 + block * 40 + k;
      const std::uint32_t a = whole.number(id), b = part.number(id);
      for (std::size_t f = 0; f < classify::kFeatureCount; ++f) {
        // The cells of a town reach 750 m.
        if (classify::kFeatures[f].group == "town") continue;
        const float u = whole.facts.features[a].at(f), v = part.facts.features[b].at(f);
        EXPECT_TRUE(u == v || (u != u && v != v)) << id << " " << classify::kFeatures[f].name << ": " << u << ", " << v;
        ++compared;
        known += u == u;
      }
      EXPECT_EQ(whole.facts.places[a].street, part.facts.places[b].street) << id;
      EXPECT_EQ(whole.facts.places[a].position, part.facts.places[b].position) << id;
      EXPECT_EQ(whole.facts.contacts_of(a).size(), part.facts.contacts_of(b).size()) << id;
    }
  EXPECT_GT(compared, 1000);
  EXPECT_GT(known, compared / 2) << "blocks, rows and streets were found";
}

TEST(LabelledBuildings, AreRecalledAsTheyWouldBeFound) {
  OsmTown town;
  for (int i = 0; i < 12; ++i) town.box(100 + i, 12.0 * i, 0, i % 4 == 3 ? 9 : 12, 14);
  town.ring(7, {{0, 30}, {60, 30}, {60, 70}, {0, 70}}, {{15, 40}, {45, 40}, {45, 60}, {15, 60}});
  town.street(1, {{-30, -8}, {180, -8}}, "Hauptstrasse");
  town.street(2, {{-30, 22}, {180, 22}}, "Nebenstrasse");
  const MeasuredTown measured(town, "labelled");
  const footprints::FootprintStore& store = measured.repaired->footprints;
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t b = 0; b < store.size(); ++b) numbers.push_back(b);
  const auto region_of = [&](const context::VicinityFinder& finder) {
    model::Region region;
    region.extract = &measured.extract;
    for (const std::uint32_t n : numbers) {
      model::Building& building = region.buildings.emplace_back();
      building.osm = store[n].id;
      building.tags = measured.extract.buildings[store[n].lead].tags;
      building.outline = store.polygons(n);
      building.arcs = store.arcs(n);
    }
    finder.label_wall_segments(region, numbers);
    base::Packer packer;
    for (const model::Building& b : region.buildings) packer << b.edges << b.situation << b.trees;
    return packer.bytes;
  };
  const std::string found = region_of(context::VicinityFinder(measured.extract, store, measured.context));
  EXPECT_GT(found.size(), 1000u);
  const auto kept = std::make_shared<context::LabelledBuildings>();
  const context::VicinityFinder finder(measured.extract, store, measured.context, kept);
  model::Building other;
  other.osm = store[0].id;
  other.tags = measured.extract.buildings[store[0].lead].tags;
  EXPECT_FALSE(kept->recall(0, other)) << "nothing was labelled yet";
  EXPECT_EQ(region_of(finder), found);
  EXPECT_TRUE(kept->recall(0, other));
  EXPECT_FALSE(other.edges.empty());
  EXPECT_EQ(region_of(finder), found);
  other.osm = store[1].id;
  EXPECT_FALSE(kept->recall(0, other)) << "of another building";
}

}  // namespace
}  // namespace blockrand::evidence
