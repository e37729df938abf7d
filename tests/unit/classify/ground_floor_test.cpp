#include "styles/classify/ground_floor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "tests/unit/classify/changed_configs.h"

namespace blockrand::classify {
namespace {

using model::Source;
using testing::HasSubstr;
using TagList = std::vector<std::pair<std::string_view, std::string_view>>;

const std::string kConfigs = std::string(BLOCKRAND_SOURCE_DIR) + "/configs";

const Catalogue& catalogue() {
  static const Catalogue read = read_catalogue(kConfigs);
  return read;
}
const GroundFloorRules& rules() {
  static const GroundFloorRules read = read_ground_floor(kConfigs);
  return read;
}

TagLookup lookup(TagList tags) {
  return [tags = std::move(tags)](std::string_view key) {
    for (const auto& [k, v] : tags)
      if (k == key) return v;
    return std::string_view();
  };
}

std::vector<int> points(const std::map<std::string, int>& counts) {
  std::vector<int> out;
  for (const GroundFloorCategory& c : rules().categories)
    out.push_back(counts.contains(c.name) ? counts.at(c.name) : 0);
  return out;
}

/// A front house of a style on a street.
GroundFloorFacts house(const char* style, std::string_view street, bool corner = false) {
  GroundFloorFacts facts;
  facts.use = "apartments";
  facts.style = catalogue().find(style);
  EXPECT_TRUE(facts.style) << style;
  facts.faces_street = true;
  facts.corner_house = corner;
  facts.street_class = street;
  facts.storeys = 5;
  return facts;
}

TEST(GroundFloor, TagsOfTheBuildingComeFirst) {
  const auto use = [](TagList tags) {
    GroundFloorFacts facts = house("villa", "residential");
    facts.tag = lookup(std::move(tags));
    return ground_floor_use(facts, rules());
  };
  EXPECT_EQ(use({{"shop", "bakery"}}).value, "shop");
  EXPECT_EQ(use({{"shop", "bakery"}}).source, Source::tag);
  EXPECT_EQ(use({{"shop", "bakery"}}).evidence, "shop=bakery on the building");
  EXPECT_EQ(use({{"amenity", "cafe"}}).value, "gastronomy");
  EXPECT_EQ(use({{"amenity", "bank"}}).value, "service");
  EXPECT_EQ(use({{"office", "lawyer"}}).value, "office");
  EXPECT_EQ(use({{"craft", "tailor"}}).value, "craft");
  EXPECT_EQ(use({{"tourism", "hotel"}}).value, "lodging");
  EXPECT_EQ(use({{"healthcare", "doctor"}, {"amenity", "cafe"}}).value, "gastronomy")
      << "named values before any value";
  EXPECT_EQ(use({{"shop", "no"}}).value, "apartments");
  EXPECT_EQ(use({{"shop", "vacant"}}).value, "apartments");
  EXPECT_EQ(use({{"amenity", "bench"}}).value, "apartments");
}

TEST(GroundFloor, TheUseOfTheBuildingMayNameIt) {
  GroundFloorFacts facts;
  for (const auto& [use, value] : std::map<std::string, std::string>{{"retail", "shop"},
                                                                     {"office", "office"},
                                                                     {"hotel", "lodging"},
                                                                     {"school", "education"},
                                                                     {"industrial", "industrial"}}) {
    facts.use = use;
    EXPECT_EQ(ground_floor_use(facts, rules()).value, value) << use;
    EXPECT_EQ(ground_floor_use(facts, rules()).source, Source::implied);
  }
  facts.use = "barn";
  EXPECT_EQ(ground_floor_use(facts, rules()).value, "barn");
  EXPECT_EQ(ground_floor_use(facts, rules()).source, Source::default_);
}

TEST(GroundFloor, PointsInside) {
  GroundFloorFacts facts = house("gz_mk_front", "residential");
  const auto use = [&](const std::map<std::string, int>& counts) {
    const std::vector<int> n = points(counts);
    facts.points = n;
    return ground_floor_use(facts, rules());
  };
  EXPECT_EQ(use({{"shop", 1}}).value, "shop");
  EXPECT_EQ(use({{"shop", 1}}).source, Source::geometry);
  EXPECT_NEAR(use({{"shop", 1}}).confidence, 0.95, 1e-6);
  EXPECT_EQ(use({{"shop", 1}}).evidence, "1 point of category shop mapped inside");
  EXPECT_EQ(use({{"gastronomy", 2}, {"shop", 1}}).value, "gastronomy");
  EXPECT_EQ(use({{"gastronomy", 1}, {"shop", 1}}).value, "shop") << "equally likely: by the order of the file";
  EXPECT_EQ(use({{"office", 1}}).value, "apartments") << "most offices are upstairs";
  EXPECT_EQ(use({{"office", 2}}).value, "office");
  EXPECT_EQ(use({{"health", 1}, {"craft", 1}}).value, "craft");
  facts.tag = lookup({{"office", "company"}});
  EXPECT_EQ(use({{"shop", 3}}).value, "office") << "the building's own tag is stronger";
}

TEST(GroundFloor, ShopsByStyleAndStreet) {
  const auto at = [](const GroundFloorFacts& facts) { return ground_floor_use(facts, rules()); };
  EXPECT_EQ(at(house("gz_mk_front", "primary")).value, "shop");
  EXPECT_NEAR(at(house("gz_mk_front", "primary")).confidence, 0.7, 1e-6);
  EXPECT_EQ(at(house("gz_mk_front", "primary")).source, Source::preset);
  EXPECT_THAT(at(house("gz_mk_front", "primary")).evidence, HasSubstr("a shop with probability 70 %"));
  EXPECT_EQ(at(house("gz_mk_front", "tertiary")).value, "apartments");
  EXPECT_EQ(at(house("gz_mk_front", "tertiary", true)).value, "shop") << "0.4 + 0.3 at a corner";
  EXPECT_EQ(at(house("gz_mk_front", "residential", true)).value, "apartments") << "0.45";
  EXPECT_NEAR(at(house("gz_mk_front", "primary", true)).confidence, 0.95, 1e-6) << "no more than the highest";
  EXPECT_EQ(at(house("gz_mk_front", "cycleway")).value, "apartments");
  EXPECT_EQ(at(house("villa", "primary")).value, "apartments");
  EXPECT_EQ(at(house("pb_wbs70", "primary")).value, "apartments");
  EXPECT_EQ(at(house("farm", "primary")).value, "apartments") << "anywhere is not an old town";

  GroundFloorFacts rear = house("gz_mk_rear", "primary");
  rear.faces_street = false;
  EXPECT_EQ(at(rear).value, "apartments");
  GroundFloorFacts low = house("gz_early", "primary");
  low.storeys = 1;
  EXPECT_EQ(at(low).value, "apartments");
  GroundFloorFacts church = house("gz_mk_front", "primary");
  church.use = "farm_auxiliary";
  EXPECT_EQ(at(church).value, "farm_auxiliary");
  GroundFloorFacts unknown;
  unknown.use = "yes";
  EXPECT_EQ(at(unknown).value, "residential");
  EXPECT_LT(at(unknown).confidence, 0.5);
}

TEST(GroundFloor, PointsAreSortedIntoCategoriesByTheirTags) {
  const auto category = [](TagList tags) {
    const auto c = rules().category(lookup(std::move(tags)));
    return c ? rules().categories[*c].name : std::string("none");
  };
  EXPECT_EQ(category({{"shop", "clothes"}}), "shop");
  EXPECT_EQ(category({{"amenity", "pub"}}), "gastronomy");
  EXPECT_EQ(category({{"amenity", "atm"}}), "none");
  EXPECT_EQ(category({}), "none");
  EXPECT_FALSE(rules().category({}));
}

TEST(GroundFloor, RefusesWhatItDoesNotKnowAndSaysWhere) {
  const auto complaint = [](const std::string& from, const std::string& to) {
    return test::complaint("styles/ground_floor.toml", from, to,
                           [](const std::string& dir) { read_ground_floor(dir); });
  };
  EXPECT_EQ(complaint("0.95", "0.95"), "");
  EXPECT_THAT(complaint("primary = 0.7", "primray = 0.7"), HasSubstr("Did you mean shop_rule.street.primary?"));
  EXPECT_THAT(complaint("primary = 0.7", "primray = 0.7"), HasSubstr("ground_floor.toml:"));
  EXPECT_THAT(complaint("primary = 0.7", "primary = 1.7"), HasSubstr("primary"));
  EXPECT_THAT(complaint("\"shop\", \"gastronomy\"", "\"shop\", \"gastronmy\""),
              HasSubstr("Did you mean `gastronomy`?"));
  EXPECT_THAT(complaint("\"shop\", \"gastronomy\"", "\"shop\""), HasSubstr("not all categories"));
  EXPECT_THAT(complaint("\"old_town\"]", "\"oldtown\"]"), HasSubstr("Did you mean `old_town`?"));
  EXPECT_THAT(complaint("\"craft=*\"", "\"shop=*\""), HasSubstr("stands twice"));
  EXPECT_THAT(complaint("\"craft=*\"", "\"craft\""), HasSubstr("is no tag"));
  EXPECT_THAT(complaint("corner = 0.3\n", ""), HasSubstr("no `corner`"));
}

}  // namespace
}  // namespace blockrand::classify
