#include "styles/classify/classify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "pipeline/base/error.h"
#include "tests/unit/classify/small_weights.h"

namespace blockrand::classify {
namespace {

using model::BuildingPosition;
using model::Era;
using model::Morphology;
using model::StyleClass;
using testing::AllOf;
using testing::HasSubstr;

const Tables& tables() {
  static const test::SmallWeights weights("classify_test");
  static const Tables read = Tables::read(weights.path());
  return read;
}

template <class E, std::size_t N>
void certain(std::array<float, N>& p, E answer) {
  p = {};
  p[static_cast<std::size_t>(answer)] = 1;
}
model::BuildingStyle style(StyleClass c, Era e, Morphology m) {
  model::BuildingStyle s;
  certain(s.style, c);
  certain(s.era, e);
  certain(s.morphology, m);
  return s;
}
std::size_t at(StyleClass c) { return static_cast<std::size_t>(c); }

// ---- reading

TEST(Tables, AreReadWithTheirWeights) {
  EXPECT_THAT(tables().storey_counts, testing::ElementsAre(1, 2, 3, 4, 5, 6, 8));
  EXPECT_EQ(tables().style.answers().size(), 4u);
  EXPECT_GT(tables().smoothing.rounds, 0);
  const Tables bare = Tables::read_without_weights(std::string(BLOCKRAND_SOURCE_DIR) + "/configs");
  EXPECT_TRUE(bare.style.answers().empty());
  EXPECT_EQ(bare.catalogue.size(), tables().catalogue.size());
  const auto villa = bare.catalogue.index("villa");
  ASSERT_TRUE(villa);
  EXPECT_NE(bare.use_of_style[*villa] >> 3 & 1, 0) << "built as a house";
  EXPECT_EQ(bare.use_of_style[*villa] >> 9 & 1, 0) << "not as a church";
}

TEST(Tables, NameThePlaceOfAnError) {
  const auto complaint = [](const std::string& file, const std::string& text) -> std::string {
    const test::SmallWeights weights("classify_test_wrong");
    weights.write(file, text);
    try {
      Tables::read(weights.path());
    } catch (const base::InputError& error) {
      return error.what();
    }
    return "no complaint";
  };
  EXPECT_THAT(complaint("weights/era.toml", "answers = [\"1840_1918\", \"pre1840\", \"1919_1945\", \"post1945\"]"),
              AllOf(HasSubstr("era.toml:1:"), HasSubstr("in this order: pre1840")));
  EXPECT_THAT(complaint("weights/storeys.toml", "answers = [\"1\", \"3\", \"2\"]"),
              AllOf(HasSubstr("storeys.toml"), HasSubstr("`2`")));
  EXPECT_THAT(complaint("weights/storeys.toml", "answers = [\"few\"]"), HasSubstr("`few` is no count"));
  EXPECT_THAT(complaint("neighbours.toml", "[style]\nround = 3\n"),
              AllOf(HasSubstr("neighbours.toml:2:"), HasSubstr("rounds")));
  EXPECT_THAT(complaint("neighbours.toml", "[style]\nrounds = 6\n"), HasSubstr("neighbours.toml:2:"));
  EXPECT_THAT(complaint("neighbours.toml", "[storey]\n"), HasSubstr("storeys"));
  EXPECT_THAT(complaint("neighbours.toml", "[quarter]\nsay = 0.5\n"), HasSubstr("quarter.perimeter_block"));
  EXPECT_THAT(complaint("neighbours.toml", "[quarter]\nperimeter_block = [0.5, 0.5, 0.5, -0.5]\n"),
              AllOf(HasSubstr("quarter.perimeter_block"), HasSubstr("sum")));
  EXPECT_THAT(complaint("tags.toml", "[styles_of_use]\nchurch = [\"palace\"]\n"),
              HasSubstr("there is no style `palace`"));
  EXPECT_THAT(complaint("tags.toml", "[styles_of_use]\nchruch = [\"public\"]\n"),
              AllOf(HasSubstr("tags.toml:2:"), HasSubstr("Did you mean `church`?")));
  EXPECT_THAT(complaint("tags.toml", "[use]\nhouse = 13\n"), HasSubstr("tags.toml:2:"));
  EXPECT_EQ(complaint("unread.toml", ""), "no complaint");
}

// ---- storeys

TEST(Storeys, ACountBelongsToTheNearestAnswer) {
  const auto count = [](double storeys) { return tables().storey_counts[storey_answer(tables(), storeys)]; };
  EXPECT_EQ(count(0), 1);
  EXPECT_EQ(count(4), 4);
  EXPECT_EQ(count(2.4), 2);
  EXPECT_EQ(count(7), 6) << "of two as near the lower";
  EXPECT_EQ(count(7.5), 8);
  EXPECT_EQ(count(30), 8) << "the last stands for more";
}

TEST(Storeys, TheChosenCountHasTheMostOnItAndBesideIt) {
  EXPECT_EQ(choose_storeys({0.3, 0, 0.25, 0.25, 0.2}, 5), 3u) << "0.25 + 0.6 (0.25 + 0.2) is more than 0.3 alone";
  EXPECT_EQ(choose_storeys({0.9, 0.1}, 2), 0u);
  EXPECT_EQ(choose_storeys({0.4, 0.2, 0.4}, 3), 1u) << "between two answers neither extreme";
  EXPECT_EQ(choose_storeys({0.5, 0.5}, 2), 0u) << "of equal ones the lower";
  EXPECT_EQ(choose_storeys({1}, 1), 0u);
}

TEST(Storeys, TheRegionsUsualOnesPullByTheDistance) {
  RegionPrior region;
  const auto gruenderzeit = style(StyleClass::gruenderzeit, Era::from1840, Morphology::perimeter_block);
  PerAnswer p = storeys_prior(tables(), region, gruenderzeit);
  for (const double v : p) EXPECT_EQ(v, 0) << "nothing is said";
  region.storeys[0] = 5;
  p = storeys_prior(tables(), region, gruenderzeit);
  for (std::size_t a = 0; a < tables().storey_counts.size(); ++a)
    EXPECT_NEAR(p[a], -0.35 * std::fabs(tables().storey_counts[a] - 5), 1.0 / 4096);
  p = storeys_prior(tables(), region, style(StyleClass::tenement, Era::from1840, Morphology::perimeter_block));
  for (const double v : p) EXPECT_EQ(v, 0) << "nothing is said of tenements";

  // Half gruenderzeit of 5, half of which nothing is said.
  auto half = gruenderzeit;
  half.style = {0.5f, 0.5f, 0, 0};
  p = storeys_prior(tables(), region, half);
  EXPECT_NEAR(p[0], std::log(0.5 + 0.5 * std::exp(-0.35 * 4)), 1.0 / 4096);
  EXPECT_NEAR(p[4], 0, 1.0 / 4096);
}

TEST(Storeys, ModernOnesAreUsualByTheirQuarter) {
  RegionPrior region;
  region.storeys[4] = 8;  // modern, slab
  region.storeys[5] = 1;  // modern, detached
  auto s = style(StyleClass::modern, Era::post1945, Morphology::slab);
  PerAnswer p = storeys_prior(tables(), region, s);
  EXPECT_NEAR(p[6], 0, 1.0 / 4096);
  EXPECT_NEAR(p[0], -0.35 * 7, 1.0 / 4096);
  s = style(StyleClass::other, Era::post1945, Morphology::detached);
  p = storeys_prior(tables(), region, s);
  EXPECT_NEAR(p[0], 0, 1.0 / 4096);
  EXPECT_NEAR(p[6], std::log(1e-3) > -0.35 * 7 ? std::log(1e-3) : -0.35 * 7, 1.0 / 4096);
}

// ---- roofs, priors, years

TEST(Roofs, EveryShapeHasItsFamily) {
  using enum model::RoofShape;
  EXPECT_EQ(family_of(flat), RoofFamily::flat);
  for (const auto s : {gabled, gabled_height_moved}) EXPECT_EQ(family_of(s), RoofFamily::gabled);
  for (const auto s : {hipped, half_hipped, pyramidal}) EXPECT_EQ(family_of(s), RoofFamily::hipped);
  for (const auto s : {mansard, gambrel}) EXPECT_EQ(family_of(s), RoofFamily::mansard);
  for (const auto s : {skillion, berlin, dome, onion, saltbox}) EXPECT_EQ(family_of(s), RoofFamily::other);
}

TEST(RegionPrior, EqualSharesSayNothingAndRareOnesMuch) {
  // The small weights tell no shares of their data: all answers are the same there.
  const double equal[] = {2, 2, 2, 2};
  PerAnswer p = prior_log_odds(equal, tables().style);
  for (const double v : p) EXPECT_EQ(v, 0);
  const double some[] = {0.5, 0.25, 0.25, 0};
  p = prior_log_odds(some, tables().style);
  EXPECT_NEAR(p[0], std::log(2), 1.0 / 4096);
  EXPECT_EQ(p[1], 0);
  EXPECT_NEAR(p[3], std::log(4e-3), 1.0 / 4096) << "nothing is impossible";
  const double none[] = {0, 0};
  EXPECT_EQ(prior_log_odds(none, tables().style)[0], 0);
}

TEST(RegionPrior, IsHeldAgainstTheSharesOfTheFit) {
  const test::SmallWeights weights("classify_test_base");
  weights.write(
      "weights/style.toml",
      "answers = [\"gruenderzeit\", \"tenement\", \"modern\", \"other\"]\n[base]\ngruenderzeit = 0.5\ntenement = 0.1\n"
      "modern = 0.3\nother = 0.1\n");
  const Tables t = Tables::read(weights.path());
  const double same[] = {0.5, 0.1, 0.3, 0.1};
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(prior_log_odds(same, t.style)[i], 0, 1.0 / 4096) << "what the fit has seen is no news";
  const double twice[] = {0.25, 0.2, 0.45, 0.1};
  EXPECT_NEAR(prior_log_odds(twice, t.style)[1], std::log(2), 1.0 / 4096);
}

TEST(EraOfYears, LeavesEachEraItsShareOfTheRange) {
  const auto p = [](model::YearRange years, double confidence) {
    return probabilities(era_of_years(years, confidence), 4);
  };
  const PerAnswer sure = p({1905, 1905}, 0.9);
  EXPECT_NEAR(sure[1], 0.925, 1e-3);
  EXPECT_NEAR(sure[0], 0.025, 1e-3) << "dates may be wrong";
  EXPECT_GT(sure[1], p({1905, 1905}, 0.5)[1]);
  EXPECT_EQ(p({1905, 1905}, 1)[1], p({1905, 1905}, 0.99)[1]) << "nobody is certain";
  const PerAnswer after = p({1919, 1968}, 0.9);  // after 1918
  EXPECT_LT(after[1], 0.05);
  EXPECT_NEAR(after[2] / after[3], 27.0 / 23, 0.05);
  const PerAnswer century = p({1801, 1900}, 0.9);  // C19
  EXPECT_NEAR(century[0], 0.9 * 0.39 + 0.025, 2e-3);
  for (const auto& [year, era] : {std::pair{1839, 0}, {1840, 1}, {1918, 1}, {1919, 2}, {1945, 2}, {1946, 3}}) {
    const auto y = static_cast<std::int16_t>(year);
    EXPECT_GT(p({y, y}, 0.9)[static_cast<std::size_t>(era)], 0.9) << year;
  }
}

// What the shipped weights say of what classes are by definition.
class ShippedWeights : public testing::Test {
 protected:
  static const Tables& shipped() {
    static const Tables read = Tables::read(std::string(BLOCKRAND_SOURCE_DIR) + "/configs");
    return read;
  }
  static PerAnswer lead_of(Feature feature, float value) {
    FeatureVector with;
    with[feature] = value;
    PerAnswer lead = shipped().style.log_odds(with);
    for (std::size_t i = 0; i < 4; ++i) lead[i] -= shipped().style.prior()[i];
    return lead;
  }
};

TEST_F(ShippedWeights, ADateDecidesBetweenTheTimes) {
  const PerAnswer old = lead_of(Feature::tag_year, 1890);
  EXPECT_GT(old[at(StyleClass::gruenderzeit)] - old[at(StyleClass::modern)], 3);
  const PerAnswer young = lead_of(Feature::tag_year, 1930);
  EXPECT_GT(young[at(StyleClass::modern)] - young[at(StyleClass::gruenderzeit)], 3);
  const PerAnswer oldest = lead_of(Feature::tag_year, 1720);
  EXPECT_GT(oldest[at(StyleClass::other)] - oldest[at(StyleClass::modern)], 3);
}

TEST_F(ShippedWeights, AChurchIsOtherWheneverItWasBuilt) {
  const PerAnswer church = lead_of(Feature::tag_use, 9), young = lead_of(Feature::tag_year, 1960);
  for (const StyleClass c : {StyleClass::gruenderzeit, StyleClass::tenement, StyleClass::modern})
    EXPECT_GT(church[at(StyleClass::other)] + young[at(StyleClass::other)], church[at(c)] + young[at(c)] + 1);
}

// ---- sub-styles

const Style& of(const Substyle& s) { return tables().catalogue[s.index]; }
Substyle best(const SubstyleFacts& facts, const RegionPrior* region = nullptr) {
  return substyles(tables(), region, facts, 1).at(0);
}

TEST(Reconcile, EraAndClassNeverExcludeEachOther) {
  std::uint32_t state = 4711;
  const auto random = [&state] {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>((state >> 8) % 1000 + 1);
  };
  const auto fill = [&random](auto& p) {
    float sum = 0;
    for (float& v : p) sum += v = random() * random() * random();
    for (float& v : p) v /= sum;
  };
  for (int i = 0; i < 2000; ++i) {
    model::BuildingStyle s;
    fill(s.style), fill(s.era);
    const model::BuildingStyle before = s;
    reconcile(s, 0.3);
    EXPECT_TRUE(agree(s.style_class(), s.built())) << i;
    const auto sum = [](const auto& p) { return std::accumulate(p.begin(), p.end(), 0.f); };
    EXPECT_NEAR(sum(s.style), 1, 1e-3f) << i;
    EXPECT_NEAR(sum(s.era), 1, 1e-3f) << i;
    for (const float v : s.style) EXPECT_GE(v, 0) << i;
    reconcile(s = before, 0);
    EXPECT_EQ(s.built(), before.built()) << i << ": the class has no say";
  }
}

TEST(ShareBefore, CountsYearsOfTheErasBefore) {
  EXPECT_DOUBLE_EQ(share_before({0.1, 0.2, 0.3, 0.4}, 1919), 0.1 + 0.2);
  EXPECT_DOUBLE_EQ(share_before({0, 0, 1, 0}, 1928), 9.0 / 27);
  EXPECT_DOUBLE_EQ(share_before({0, 0, 0, 1}, 1900), 0);
}

TEST(Reconcile, ADateDecidesWhatPlanAndRowCannot) {
  model::BuildingStyle s;
  s.style = {0.1f, 0.1f, 0.7f, 0.1f};
  s.era = {0.02f, 0.95f, 0.02f, 0.01f};
  reconcile(s, 0.3);
  EXPECT_EQ(s.built(), model::Era::from1840);
  EXPECT_NE(s.style_class(), StyleClass::modern);
  s.style = {0.8f, 0.1f, 0.05f, 0.05f};
  s.era = {0.95f, 0.03f, 0.01f, 0.01f};
  reconcile(s, 0.3);
  EXPECT_EQ(s.style_class(), StyleClass::other) << "a house of 1500 is no Gründerzeit";
}

TEST(EraOfQuarter, SaysWhatIsKnownOfSuchQuartersOverWhatTheModelLearnt) {
  const Tables shipped = Tables::read(std::string(BLOCKRAND_SOURCE_DIR) + "/configs");
  const auto says = [&](std::array<float, model::kMorphologyCount> morphology, double say) {
    QuarterSay quarter = shipped.quarter;
    quarter.say = say;
    return era_of_quarter(quarter, morphology, shipped.era);
  };
  EXPECT_GT(shipped.quarter.say, 0);
  const PerAnswer block = says({1, 0, 0, 0, 0}, 1);
  EXPECT_NEAR(block[1], std::log(shipped.quarter.eras[0][1] / shipped.era.base()[1]), 1e-3);
  EXPECT_GT(block[1], block[3]) << "a perimeter block is of 1840 to 1918";
  EXPECT_NEAR(says({1, 0, 0, 0, 0}, 0.5)[1], block[1] / 2, 1e-3);
  const PerAnswer old_town = says({0, 1, 0, 0, 0}, 1), slab = says({0, 0, 1, 0, 0}, 1);
  EXPECT_GT(old_town[0], old_town[3]);
  EXPECT_GT(slab[3], slab[1]);
  EXPECT_EQ(says({1, 0, 0, 0, 0}, 0), PerAnswer{});
  EXPECT_EQ(says({0, 0, 0, 0, 0}, 1), PerAnswer{}) << "nothing is known of the quarter";
}

TEST(Reconcile, AClassAsLikelyAsUsualSaysNothingOfTheEra) {
  const PerAnswer usual{0.3, 0.1, 0.4, 0.2};
  model::BuildingStyle s;
  s.style = {0.3f, 0.1f, 0.4f, 0.2f};
  s.era = {0.1f, 0.35f, 0.15f, 0.4f};
  const model::BuildingStyle before = s;
  reconcile(s, 1, usual);
  for (std::size_t e = 0; e < s.era.size(); ++e) EXPECT_NEAR(s.era[e], before.era[e], 1e-4f) << e;
  reconcile(s = before, 1);
  EXPECT_GT(s.era[1], before.era[1] + 0.02f) << "three of the classes can be of it";
}

TEST(Substyles, ShareTheProbabilityOfTheirClass) {
  model::BuildingStyle s = style(StyleClass::gruenderzeit, Era::from1840, Morphology::perimeter_block);
  s.style = {0.5f, 0.25f, 0.25f, 0};
  const auto all = substyles(tables(), nullptr, {.style = s}, 255);
  EXPECT_EQ(all.size(), tables().catalogue.size());
  std::array<double, model::kStyleClassCount> sum{};
  for (std::size_t i = 0; i < all.size(); ++i) {
    sum[at(of(all[i]).style_class)] += all[i].p;
    if (i > 0) {
      EXPECT_GE(all[i - 1].p, all[i].p);
    }
  }
  for (std::size_t c = 0; c < sum.size(); ++c)
    EXPECT_NEAR(sum[c], static_cast<double>(s.style[c]), 1e-3) << model::kStyleClassNames[c];
  EXPECT_EQ(substyles(tables(), nullptr, {.style = s}, 3).size(), 3u);
}

TEST(Substyles, FitClassAndPosition) {
  const auto front = style(StyleClass::gruenderzeit, Era::from1840, Morphology::perimeter_block);
  const Substyle in_row = best({.style = front, .position = BuildingPosition::mid_row, .storeys = 5});
  EXPECT_EQ(of(in_row).style_class, StyleClass::gruenderzeit);
  EXPECT_EQ(of(in_row).position, StylePosition::front);
  const auto behind = style(StyleClass::tenement, Era::from1840, Morphology::perimeter_block);
  EXPECT_EQ(of(best({.style = behind, .position = BuildingPosition::rear_building, .storeys = 5})).position,
            StylePosition::rear);
  EXPECT_EQ(of(best({.style = behind, .position = BuildingPosition::side_wing, .storeys = 5})).position,
            StylePosition::wing);
  EXPECT_NE(of(best({.style = behind, .position = BuildingPosition::mid_row, .storeys = 5})).position,
            StylePosition::wing);
}

TEST(Substyles, ARareStyleIsNotTheAnswerForAnyTownHouse) {
  auto old = style(StyleClass::other, Era::pre1840, Morphology::old_town);
  const SubstyleFacts house{.style = old, .position = BuildingPosition::mid_row, .storeys = 3};
  EXPECT_EQ(of(best(house)).share, 1) << of(best(house)).id;
  const auto p_of = [](const SubstyleFacts& facts, std::string_view id) {
    for (const Substyle& s : substyles(tables(), nullptr, facts, 255))
      if (of(s).id == id) return s.p;
    return 0.0;
  };
  EXPECT_LT(p_of(house, "baroque_palais"), 0.2 * p_of(house, "burgher_eaves")) << "the same storeys, years and quarter";
  EXPECT_GT(p_of(house, "baroque_palais"), 0);
}

TEST(Substyles, FitTheQuarterAndTheEra) {
  for (const Morphology m : {Morphology::perimeter_block, Morphology::detached, Morphology::terrace}) {
    const auto s = style(StyleClass::modern, Era::from1919, m);
    EXPECT_TRUE(of(best({.style = s})).occurs_in(m)) << model::name(m) << ": " << of(best({.style = s})).id;
  }
  for (const Era e : {Era::from1919, Era::post1945}) {
    const auto s = style(StyleClass::modern, e, Morphology::perimeter_block);
    const Style& found = of(best({.style = s}));
    EXPECT_LE(found.years.from, e == Era::from1919 ? 1945 : 2030) << found.id;
    EXPECT_GE(found.years.to, e == Era::from1919 ? 1919 : 1946) << found.id;
  }
}

/// Of one sub-style among all of its class.
double share(const char* id, const SubstyleFacts& facts, const RegionPrior* region = nullptr) {
  for (const Substyle& s : substyles(tables(), region, facts, 255))
    if (of(s).id == id) return s.p;
  return -1;
}

TEST(Substyles, YearStoreysUseAndRoofEachSpeak) {
  const auto s = style(StyleClass::modern, Era::post1945, Morphology::slab);
  const double alone = share("pb_wbs70", {.style = s});
  EXPECT_GT(alone, 0);
  EXPECT_GT(share("pb_wbs70", {.style = s, .year = 1978}), alone) << "built 1972 to 1990";
  EXPECT_LT(share("pb_wbs70", {.style = s, .year = 2015}), alone);
  EXPECT_GT(share("pb_wbs70", {.style = s, .storeys = 6}), share("pb_wbs70", {.style = s, .storeys = 2}));
  EXPECT_GT(share("pb_wbs70", {.style = s, .roof = model::RoofShape::flat}),
            share("pb_wbs70", {.style = s, .roof = model::RoofShape::hipped}));

  const auto other = style(StyleClass::other, Era::from1840, Morphology::perimeter_block);
  EXPECT_EQ(of(best({.style = other, .use = 9})).id, "public") << "a church";
  EXPECT_LT(share("public", {.style = other, .use = 5}), share("public", {.style = other, .use = 9}));
}

TEST(Substyles, TheRegionHasTheLastWord) {
  const auto s = style(StyleClass::gruenderzeit, Era::from1840, Morphology::perimeter_block);
  const SubstyleFacts facts{.style = s, .position = BuildingPosition::mid_row, .storeys = 4};
  RegionPrior region;
  region.substyle.assign(tables().catalogue.size(), 1);
  EXPECT_DOUBLE_EQ(share("gz_vienna", facts, &region), share("gz_vienna", facts));
  region.substyle[*tables().catalogue.index("gz_vienna")] = 0;
  EXPECT_EQ(share("gz_vienna", facts, &region), 0);
  region.substyle[*tables().catalogue.index("gz_vienna")] = 1e6;
  EXPECT_GT(share("gz_vienna", facts, &region), 0.99);
}

}  // namespace
}  // namespace blockrand::classify
