// Churches and halls: their eaves follow the width of the nave, never the storeys of the houses around them.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "pipeline/attributes/resolve.h"

namespace blockrand::attributes {
namespace {

using model::Source;

const std::string kConfigs = std::string(BLOCKRAND_SOURCE_DIR) + "/configs";

/// A building of `use`, `width` by twice that, among neighbours who are thought to have five storeys.
model::Attributes among_tenements(const std::string& use, double width, std::optional<float> storeys = std::nullopt) {
  static const Defaults defaults = read_defaults(kConfigs);
  model::Extract extract;
  model::Building building;
  building.osm = {model::OsmType::way, 1};
  model::Polygon plan;
  plan.outer.points = {{0, 0}, {2 * width, 0}, {2 * width, width}, {0, width}};
  plan.outer.nodes.assign(4, 0);
  building.outline = {plan};
  building.mapped.use = extract.strings.intern(use);
  building.mapped.storeys = storeys;
  building.inferred.storeys = {5, Source::neighbours, 0.9f, "seven tagged neighbours"};
  model::BuildingPart part;
  part.osm = building.osm;
  part.plan = plan;
  part.mapped = building.mapped;
  building.parts.push_back(part);
  model::Region region;
  region.extract = &extract;
  region.buildings = {building};
  const context::TaggedNeighbours nobody({}, 100);
  resolve_attributes(region, {defaults, nobody, 1, [](const model::Building&) { return context::BuildingGround{}; }},
                     {});
  return region.buildings[0].attributes;
}

TEST(Halls, AChurchOfFiveStoreysIsNone) {
  const model::Attributes church = among_tenements("church", 20);
  EXPECT_EQ(church.storeys.value, 1);
  EXPECT_GT(church.eaves_height.value, 10);
  EXPECT_LT(church.eaves_height.value, 16);
  EXPECT_GT(church.height.value, church.eaves_height.value + 5);
}

TEST(Halls, EavesFollowTheWidthOfTheNave) {
  EXPECT_LT(among_tenements("church", 9).eaves_height.value, 8);
  EXPECT_LE(among_tenements("chapel", 5).eaves_height.value, 5);
  EXPECT_GE(among_tenements("cathedral", 34).eaves_height.value, 20);
  EXPECT_LE(among_tenements("cathedral", 80).eaves_height.value, 24);
}

TEST(Halls, TaggedStoreysShareTheEaves) {
  const model::Attributes church = among_tenements("church", 20, 2.f);
  EXPECT_EQ(church.storeys.value, 2);
  EXPECT_LT(church.eaves_height.value, 16);
}

TEST(Halls, AHangarHasNoStoreysOfItsNeighbours) {
  EXPECT_LT(among_tenements("hangar", 30).eaves_height.value, 12);
  EXPECT_LT(among_tenements("industrial", 30).eaves_height.value, 8);
  EXPECT_GT(among_tenements("apartments", 12).eaves_height.value, 12);
}

}  // namespace
}  // namespace blockrand::attributes
