#include "styles/classify/non_houses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/unit/classify/changed_configs.h"

namespace blockrand::classify {
namespace {

using testing::HasSubstr;
using TagList = std::vector<std::pair<std::string_view, std::string_view>>;

const std::string kConfigs = std::string(BLOCKRAND_SOURCE_DIR) + "/configs";
const NonHouseRules& rules() {
  static const NonHouseRules read = read_non_houses(kConfigs, read_catalogue(kConfigs));
  return read;
}

TagLookup lookup(TagList tags) {
  return [tags = std::move(tags)](std::string_view key) {
    for (const auto& [k, v] : tags)
      if (k == key) return v;
    return std::string_view();
  };
}

std::string kind(std::string_view use, double area, TagList tags = {}, bool address = false,
                 std::optional<double> storeys = {}) {
  const auto found = non_house({use, lookup(std::move(tags)), area, address, storeys, 0, false}, rules());
  return found ? found->kind : "house";
}

TEST(NonHouses, ByTheValueOfBuilding) {
  EXPECT_EQ(kind("garage", 18), "garage");
  EXPECT_EQ(kind("garages", 400), "garage");
  EXPECT_EQ(kind("carport", 20), "garage");
  EXPECT_EQ(kind("shed", 12), "shed");
  EXPECT_EQ(kind("shed", 4000), "house") << "a hall";
  EXPECT_EQ(kind("kiosk", 15, {}, true), "kiosk") << "with an address too";
  EXPECT_EQ(kind("storage_tank", 900), "tank");
  EXPECT_EQ(kind("silo", 60), "tank");
  EXPECT_EQ(kind("roof", 500), "canopy");
  EXPECT_EQ(kind("ruins", 300), "ruin");
  EXPECT_EQ(kind("collapsed", 300), "ruin");
  EXPECT_EQ(kind("construction", 300), "construction_site");
  EXPECT_EQ(kind("transformer_tower", 9), "transformer");
  EXPECT_EQ(kind("greenhouse", 2000), "greenhouse");
  EXPECT_EQ(kind("bunker", 700), "bunker");
  EXPECT_EQ(kind("toilets", 30), "toilets");
  EXPECT_EQ(kind("bridge", 300), "bridge");
  EXPECT_EQ(kind("hut", 24), "allotment_hut");
  EXPECT_EQ(kind("static_caravan", 30), "static_caravan");
  EXPECT_EQ(kind("container", 15), "container");
  EXPECT_EQ(kind("tent", 300), "tent");
  EXPECT_EQ(kind("monument", 300), "monument");
  for (const char* use :
       {"apartments", "house", "yes", "retail", "church", "school", "industrial", "barn", "warehouse"})
    EXPECT_EQ(kind(use, 300), "house") << use;
}

TEST(NonHouses, ByOtherTagsWhereTheBuildingSaysNothing) {
  EXPECT_EQ(kind("yes", 300, {{"historic", "memorial"}}), "monument");
  EXPECT_EQ(kind("yes", 300, {{"memorial", "stele"}}), "monument");
  EXPECT_EQ(kind("yes", 300, {{"tourism", "artwork"}}), "monument");
  EXPECT_EQ(kind("yes", 300, {{"tourism", "artwork"}}, true), "house") << "a gallery";
  EXPECT_EQ(kind("apartments", 300, {{"memorial", "plaque"}}), "house") << "a house with a plaque";
  EXPECT_EQ(kind("palace", 3000, {{"historic", "monument"}}), "house");
  EXPECT_EQ(kind("church", 300, {{"historic", "ruins"}}), "ruin") << "a ruin whatever it was";
  EXPECT_EQ(kind("yes", 300, {{"man_made", "storage_tank"}}), "tank");
  EXPECT_EQ(kind("industrial", 300, {{"man_made", "silo"}}), "tank");
  EXPECT_EQ(kind("yes", 3000, {{"man_made", "works"}}), "house") << "people work there";
  EXPECT_EQ(kind("yes", 12, {{"power", "substation"}}), "transformer");
  EXPECT_EQ(kind("yes", 1200, {{"power", "substation"}}), "house") << "a monument of brick";
  EXPECT_EQ(kind("yes", 300, {{"power", "no"}}), "house");
  EXPECT_EQ(kind("yes", 60, {{"amenity", "shelter"}}), "canopy");
  EXPECT_EQ(kind("yes", 60, {{"amenity", "toilets"}}), "toilets");
  EXPECT_EQ(kind("retail", 900, {{"amenity", "toilets"}}), "house") << "toilets in a shop";
  EXPECT_EQ(kind("yes", 900, {{"amenity", "parking"}}), "parking");
  EXPECT_EQ(kind("yes", 900, {{"amenity", "restaurant"}}), "house");
}

TEST(NonHouses, BySize) {
  EXPECT_EQ(kind("yes", 6), "tiny");
  EXPECT_EQ(kind("house", 6), "tiny") << "nobody lives on 6 m²";
  EXPECT_EQ(kind("yes", 6, {}, true), "house") << "unless it has an address";
  EXPECT_EQ(kind("yes", 6, {}, false, 3), "house") << "or storeys: a tower";
  EXPECT_EQ(kind("yes", 6, {}, false, 1), "tiny");
  EXPECT_EQ(kind("yes", 25), "outbuilding");
  EXPECT_EQ(kind("yes", 25, {}, true), "house");
  EXPECT_EQ(kind("yes", 25, {}, false, 2), "house");
  EXPECT_EQ(kind("yes", 25, {{"shop", "bakery"}}), "house");
  EXPECT_EQ(kind("terrace", 38), "house") << "row houses are small";
  EXPECT_EQ(kind("yes", 40), "house");
}

/// `n` x `n` rectangles of the size of a stela, `step` metres apart.
std::vector<SmallPlan> field(int n, double step, double area, double spread) {
  std::mt19937 random(5);
  std::vector<SmallPlan> out;
  for (int i = 0; i < n * n; ++i)
    out.push_back({{step * (i % n), step * (i / n)}, area * (1 + spread * (random() / 4294967296.0 - 0.5)), 4});
  return out;
}

TEST(NonHouses, FieldsOfEqualRectangles) {
  const auto plans = field(30, 1.86, 2.35, 0.2);
  const auto counts = equal_neighbours(plans, rules());
  for (std::size_t i = 0; i < plans.size(); ++i) {
    ASSERT_GE(counts[i], rules().equal_count) << i;
    const auto found = non_house({"yes", {}, plans[i].area, false, {}, counts[i], false}, rules());
    ASSERT_TRUE(found);
    ASSERT_EQ(found->kind, "field_of_equals");
  }
  const auto stela = non_house({"yes", {}, 2.35, false, {}, 100, false}, rules());
  EXPECT_THAT(stela->why, HasSubstr("100 rectangles of the same size within 15 m"));
  EXPECT_EQ(stela->style, "ancillary");
}

TEST(NonHouses, RowsOfHousesAreNoField) {
  // Row houses of 5 x 7.5 m wall to wall, both sides of a lane: as dense as dwellings get.
  std::vector<SmallPlan> row;
  for (int i = 0; i < 20; ++i)
    for (int side = 0; side < 2; ++side) row.push_back({{5.0 * i, 14.0 * side}, 37.5, 4});
  for (const int n : equal_neighbours(row, rules())) {
    EXPECT_LT(n, rules().equal_count);
    EXPECT_FALSE(non_house({"house", {}, 37.5, false, {}, n, false}, rules()));
  }
  // Even among many, what has an address or storeys is a house.
  EXPECT_FALSE(non_house({"yes", {}, 37.5, true, {}, 30, false}, rules()));
  EXPECT_FALSE(non_house({"yes", {}, 37.5, false, 2, 30, false}, rules()));
  EXPECT_FALSE(non_house({"house", {}, 37.5, false, {}, 30, false}, rules()));
  EXPECT_FALSE(non_house({"yes", {}, 200, false, {}, 30, false}, rules())) << "large houses may be equal";
}

TEST(NonHouses, AFewAreEnoughOnMemorialGround) {
  const int few = rules().equal_count_on_memorial_ground;
  const auto there = non_house({"yes", {}, 2, false, {}, few, true}, rules());
  ASSERT_TRUE(there);
  EXPECT_EQ(there->kind, "field_of_equals");
  EXPECT_EQ(non_house({"yes", {}, 2, false, {}, few, false}, rules())->kind, "tiny");
}

TEST(NonHouses, CountsDependOnNoOrderAndOnLikeSizesOnly) {
  auto plans = field(6, 4, 20, 0.8);
  plans.push_back({{8, 8}, 20, 5});
  plans.push_back({{8, 8}, 200, 4});
  const auto counts = equal_neighbours(plans, rules());
  EXPECT_EQ(counts[36], 0) << "five corners";
  EXPECT_EQ(counts[37], 0) << "too large";
  for (std::size_t i = 0; i < 36; ++i) {
    int n = 0;
    for (std::size_t k = 0; k < 36; ++k) {
      const double dx = plans[i].place.x - plans[k].place.x, dy = plans[i].place.y - plans[k].place.y;
      if (k != i && dx * dx + dy * dy <= 225 &&
          std::abs(plans[i].area - plans[k].area) <= 0.25 * std::max(plans[i].area, plans[k].area))
        ++n;
    }
    EXPECT_EQ(counts[i], n) << i;
  }
  std::vector<SmallPlan> turned(plans.rbegin(), plans.rend());
  auto back = equal_neighbours(turned, rules());
  std::reverse(back.begin(), back.end());
  EXPECT_EQ(back, counts);
}

TEST(NonHouses, RefusesWhatItDoesNotKnowAndSaysWhere) {
  const auto complaint = [](const std::string& from, const std::string& to) {
    return test::complaint("styles/non_houses.toml", from, to,
                           [](const std::string& dir) { read_non_houses(dir, read_catalogue(kConfigs)); });
  };
  EXPECT_EQ(complaint("tiny_area", "tiny_area"), "");
  EXPECT_THAT(complaint("tiny_area = 10", "tiny_aera = 10"), HasSubstr("non_houses.toml:"));
  EXPECT_THAT(complaint("equal_count = 12", "equal_count = 0"), HasSubstr("equal_count"));
  EXPECT_THAT(complaint("\"garage\"", "\"shed\""), HasSubstr("stands twice"));
  EXPECT_THAT(complaint("\"power=*\"", "\"power\""), HasSubstr("is no tag"));
  EXPECT_THAT(complaint("what = \"a bridge\"", "style = \"anciliary\"\nwhat = \"a bridge\""),
              HasSubstr("no style `anciliary`"));
  EXPECT_THAT(complaint("what = \"a bridge\"\n", ""), HasSubstr("no `what`"));
  EXPECT_THAT(complaint("uses = [\"greenhouse\"", "using = [\"greenhouse\""), HasSubstr("neither uses nor tags"));
}

}  // namespace
}  // namespace blockrand::classify
