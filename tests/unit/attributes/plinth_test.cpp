// Where ground floors lie on a slope, and how heights, storeys and roofs share what is above.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "pipeline/attributes/resolve.h"
#include "pipeline/attributes/tag_conflicts.h"

namespace blockrand::attributes {
namespace {

using model::Attributes;
using model::MappedAttributes;
using model::RoofShape;
using model::Source;
using ::testing::HasSubstr;

const std::string kConfigs = std::string(BLOCKRAND_SOURCE_DIR) + "/configs";

/// One building on a slope, its attributes resolved. Its storeys are 3 m high unless tags say otherwise (apartments).
class Slope {
 public:
  Slope(double rise, double entrance, const std::string& use = "apartments") : defaults_(read_defaults(kConfigs)) {
    ground.lowest = {100, Source::terrain, 0.9f, 0};
    ground.rise = rise, ground.entrance = entrance;
    ground.entrance_reason = "highest ground along the main front";
    building_.osm = {model::OsmType::way, 1};
    building_.outline = {plan(0, 12)};
    building_.mapped.use = extract_.strings.intern(use);
    building_.mapped.roof_shape = RoofShape::flat;
    tags = &building_.mapped;
  }
  static model::Polygon plan(double from, double to) {
    model::Polygon p;
    p.outer.points = {{from, 0}, {to, 0}, {to, 10}, {from, 10}};
    p.outer.nodes.assign(4, 0);
    return p;
  }
  MappedAttributes& add_part(double from, double to) {
    model::BuildingPart part;
    part.osm = {model::OsmType::way, static_cast<std::int64_t>(10 + building_.parts.size())};
    part.plan = plan(from, to);
    part.mapped.use = extract_.strings.intern("yes");
    part.mapped.roof_shape = RoofShape::flat;
    building_.parts.push_back(part);
    building_.has_mapped_parts = true;
    return building_.parts.back().mapped;
  }
  void resolve() {
    if (building_.parts.empty()) {
      model::BuildingPart part;
      part.osm = building_.osm;
      part.plan = building_.outline[0];
      part.mapped = building_.mapped;
      building_.parts.push_back(part);
    }
    region_.extract = &extract_;
    region_.buildings = {building_};
    const context::TaggedNeighbours nobody({}, 100);
    resolve_attributes(region_, {defaults_, nobody, 1, [this](const model::Building&) { return ground; }}, {});
  }
  const Attributes& of(std::size_t part) const { return region_.buildings[0].parts.at(part).attributes; }
  const Attributes& whole() const { return region_.buildings[0].attributes; }
  std::string why() const { return region_.evidence[of(0).plinth_height.evidence].text; }
  std::vector<std::string> conflicts() const {
    std::vector<std::string> out;
    for (const model::ReportRow& row : region_.report.rows)
      if (row.code == model::IssueCode::values_conflict) out.push_back(row.detail);
    return out;
  }

  context::BuildingGround ground;
  MappedAttributes* tags;

 private:
  Defaults defaults_;
  model::Extract extract_;
  model::Building building_;
  model::Region region_;
};

/// m: how far the ceiling of the ground floor lies above the highest ground.
double clearance(const Attributes& a, double rise) { return a.plinth_height.value + a.storey_height.value - rise; }

TEST(Plinth, IsNoneWithoutTerrain) {
  Slope s(0, 0);
  s.ground = {};
  s.resolve();
  EXPECT_EQ(s.of(0).plinth_height.value, 0);
  EXPECT_EQ(s.of(0).plinth_height.source, Source::default_);
}

TEST(Plinth, ReachesUpToTheEntrance) {
  Slope s(2, 1.5);
  s.tags->storeys = 4;
  s.resolve();
  EXPECT_EQ(s.of(0).plinth_height.value, 1.5);
  EXPECT_EQ(s.of(0).plinth_height.source, Source::terrain);
  EXPECT_THAT(s.why(), HasSubstr("highest ground along the main front"));
  EXPECT_DOUBLE_EQ(s.of(0).height.value, 1.5 + 4 * 3);
  EXPECT_EQ(s.of(0).ground_height.value, 100);
}

TEST(Plinth, LiesAtMostAStoreyBelowTheHighestGround) {
  Slope s(5, 0);
  s.tags->storeys = 4;
  s.resolve();
  EXPECT_DOUBLE_EQ(s.of(0).plinth_height.value, 5 - 3);
  EXPECT_THAT(s.why(), HasSubstr("does not lie below the terrain"));
}

TEST(Plinth, ATaggedHeightIsMeasuredFromTheLowestGround) {
  Slope s(1, 1);
  s.tags->height = 10;
  s.tags->storeys = 3;
  s.resolve();
  EXPECT_EQ(s.of(0).height.value, 10);
  EXPECT_EQ(s.of(0).plinth_height.value, 1);
  EXPECT_DOUBLE_EQ(s.of(0).storey_height.value, 3);
}

TEST(Plinth, GivesWayUntilStoreysFit) {
  Slope s(1, 1);
  s.tags->height = 7;
  s.tags->storeys = 3;
  s.resolve();
  EXPECT_NEAR(s.of(0).plinth_height.value, 7 - 3 * kLowestStorey, 1e-9);
  EXPECT_NEAR(s.of(0).storey_height.value, kLowestStorey, 1e-9);
  EXPECT_THAT(s.why(), HasSubstr("1.0 m wished"));
}

TEST(Plinth, StoreysShrinkBeforeTheGroundFloorDrowns) {
  Slope s(5, 5);
  s.tags->height = 9;
  s.tags->storeys = 3;
  s.resolve();
  EXPECT_EQ(s.of(0).height.value, 9);
  EXPECT_NEAR(s.of(0).plinth_height.value, 3, 1e-9);
  EXPECT_NEAR(s.of(0).storey_height.value, 2, 1e-9);
  EXPECT_NEAR(clearance(s.of(0), 5), 0, 1e-9);
  EXPECT_TRUE(s.conflicts().empty());
}

TEST(Plinth, UncountedStoreysBecomeFewer) {
  Slope s(8, 8);
  s.tags->height = 10.5;
  s.resolve();
  EXPECT_EQ(s.of(0).storeys.value, 1);
  EXPECT_GE(clearance(s.of(0), 8), 0);
  EXPECT_EQ(s.of(0).height.value, 10.5);
}

TEST(Plinth, AHeightThatTheTerrainSwallowsIsMeasuredFromTheGroundFloor) {
  Slope s(6, 0);
  s.tags->height = 3;
  s.resolve();
  EXPECT_EQ(s.of(0).plinth_height.value, 3);
  EXPECT_EQ(s.of(0).height.value, 6);
  EXPECT_EQ(s.of(0).height.source, Source::implied);
  ASSERT_EQ(s.conflicts().size(), 1u);
  EXPECT_THAT(s.conflicts()[0], HasSubstr("height=3 leaves no storey"));
  EXPECT_GE(clearance(s.of(0), 6), 0);
}

TEST(Plinth, APitchedRoofGivesWayToo) {
  Slope s(3, 3);
  s.tags->height = 8;
  s.tags->storeys = 1;
  s.tags->roof_shape = RoofShape::gabled;
  s.resolve();
  const double eaves = s.of(0).height.value - s.of(0).roof_height.value;
  EXPECT_EQ(s.of(0).height.value, 8);
  EXPECT_GE(eaves, 3 + 0.0);
  EXPECT_GE(clearance(s.of(0), 3), 0);
}

TEST(Plinth, PartsShareTheFloorAndKeepTheirHeights) {
  Slope s(2, 2);
  s.add_part(0, 4).storeys = 2;
  MappedAttributes& tower = s.add_part(4, 8);
  tower.height = 20;
  MappedAttributes& bridge = s.add_part(8, 12);
  bridge.min_height = 4, bridge.height = 6;
  s.resolve();
  for (std::size_t part = 0; part < 3; ++part) EXPECT_EQ(s.of(part).plinth_height.value, 2) << part;
  EXPECT_EQ(s.whole().plinth_height.value, 2);
  EXPECT_DOUBLE_EQ(s.of(0).height.value, 2 + 2 * s.of(0).storey_height.value);
  EXPECT_EQ(s.of(1).height.value, 20);
  EXPECT_EQ(s.of(2).height.value, 6);
  EXPECT_EQ(s.of(2).min_height.value, 4);
}

TEST(Plinth, SkippedStoreysStandOnIt) {
  Slope s(2, 2);
  s.add_part(0, 6);
  MappedAttributes& upper = s.add_part(6, 12);
  upper.min_storey = 1, upper.storeys = 3;
  s.resolve();
  const double storey = s.of(1).storey_height.value;
  EXPECT_DOUBLE_EQ(s.of(1).min_height.value, 2 + storey);
  EXPECT_DOUBLE_EQ(s.of(1).height.value, 2 + 3 * storey);
}

TEST(Plinth, ALowPartDownhillLeavesTheCommonFloor) {
  Slope s(6, 6);
  s.ground.part_rise = {6, 1};
  s.add_part(0, 6).storeys = 3;
  s.add_part(6, 12).height = 3;
  s.resolve();
  EXPECT_EQ(s.of(0).plinth_height.value, 6);
  EXPECT_EQ(s.of(1).height.value, 3);
  EXPECT_NEAR(s.of(1).plinth_height.value, 3 - kLowestStorey, 1e-9);
}

TEST(Plinth, APartFarBelowTheCommonFloorHasItsOwn) {
  Slope s(20, 20);
  s.ground.part_rise = {20, 18, 4};
  for (const double from : {0.0, 4.0, 8.0}) s.add_part(from, from + 4).storeys = 3;
  s.resolve();
  EXPECT_EQ(s.of(0).plinth_height.value, 20);
  EXPECT_EQ(s.of(1).plinth_height.value, 20) << "within a storey";
  EXPECT_EQ(s.of(2).plinth_height.value, 4) << "the highest ground under it";
  EXPECT_DOUBLE_EQ(s.of(2).height.value, 4 + 3 * s.of(2).storey_height.value);
}

/// Nothing drowns, whatever is tagged.
TEST(Plinth, KeepsGroundFloorsAboveTheTerrain) {
  for (const double rise : {0.3, 1.0, 2.5, 4.0, 9.0, 30.0})
    for (const double share : {0.0, 0.5, 1.0})
      for (const float height : {0.0f, 2.5f, 4.0f, 9.5f, 40.0f})
        for (const float storeys : {0.0f, 1.0f, 2.0f, 5.0f})
          for (const RoofShape shape : {RoofShape::flat, RoofShape::gabled, RoofShape::dome}) {
            Slope s(rise, share * rise);
            if (height > 0) s.tags->height = height;
            if (storeys > 0) s.tags->storeys = storeys;
            s.tags->roof_shape = shape;
            s.resolve();
            const Attributes& a = s.of(0);
            const std::string what = testing::PrintToString(std::vector<double>{rise, share, height, storeys}) +
                                     std::string(model::name(shape));
            const bool all_roof = a.height.value - a.roof_height.value < kLowestStorey;
            EXPECT_GE(all_roof ? a.height.value - rise : clearance(a, rise), -1e-9) << what;
            EXPECT_GE(a.plinth_height.value, 0) << what;
            EXPECT_LE(a.plinth_height.value, rise) << what;
            EXPECT_GE(a.height.value, a.plinth_height.value + a.roof_height.value - 1e-9) << what;
            if (height > 0 && s.conflicts().empty()) {
              EXPECT_EQ(a.height.value, height) << what;
            }
          }
}

}  // namespace
}  // namespace blockrand::attributes
