// Rows of houses of which everything is said by hand.
#include "pipeline/evidence/classify_extract.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/classify/small_weights.h"

namespace blockrand::evidence {
namespace {

using classify::Feature;
using model::BuildingPosition;
using model::Era;
using model::StyleClass;

const classify::Tables& tables() {
  static const classify::test::SmallWeights weights("classify_extract_test");
  static const classify::Tables read = classify::Tables::read(weights.path());
  return read;
}

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Houses of 12 x 12 m wall to wall along a street, all in one block.
struct Row {
  explicit Row(std::size_t n) {
    facts.features.resize(n);
    facts.places.resize(n);
    tags.dates.resize(n);
    tags.years.resize(n);
    tags.roofs.resize(n);
    tags.non_house.assign(n, -1);
    for (std::uint32_t i = 0; i < n; ++i) {
      auto& f = facts.features[i];
      f[Feature::area] = 144;
      f[Feature::party_share] = 0.5f;
      f[Feature::position] = 3;
      BuildingPlace& p = facts.places[i];
      p.place = {391000 + 12.0 * i, 5820000};
      p.street = 1;
      p.block = 0;
      p.position = BuildingPosition::mid_row;
      p.house = true;
      p.contacts.first = static_cast<std::uint32_t>(facts.contacts.size());
      if (i > 0) facts.contacts.push_back({i - 1, 12});
      if (i + 1 < n) facts.contacts.push_back({i + 1, 12});
      p.contacts.count = static_cast<std::uint32_t>(facts.contacts.size()) - p.contacts.first;
    }
  }
  void date(std::size_t i, int year, float confidence = 0.9f) {
    facts.features[i][Feature::tag_year] = static_cast<float>(year);
    tags.dates[i] = {static_cast<float>(year), confidence};
    tags.years[i] = model::YearRange{static_cast<std::int16_t>(year), static_cast<std::int16_t>(year)};
  }
  void storeys(std::size_t i, float n) { facts.features[i][Feature::tag_storeys] = n; }

  StyleExtract classify(const ClassifyOptions& options = {}, int workers = 1, const PriorOf& prior = {}) const {
    base::Progress quiet;
    return classify_extract(facts, tags, tables(), prior, options, workers, quiet);
  }

  FactsExtract facts;
  TagFacts tags;
};

float p(const StyleExtract& s, std::size_t i, StyleClass c) { return s.styles[i].style[static_cast<std::size_t>(c)]; }

TEST(ClassifyExtract, SmoothingLeavesADatedHouseAmongOthers) {
  Row row(9);
  row.date(4, 1963);
  const StyleExtract s = row.classify();
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(s.styles[i].style_class(), i == 4 ? StyleClass::modern : StyleClass::gruenderzeit) << i;
    EXPECT_EQ(s.styles[i].built(), i == 4 ? Era::post1945 : Era::from1840) << i << ": infill speaks for itself alone";
  }
  EXPECT_EQ(s.styles[4].built(), Era::post1945);
  EXPECT_EQ(s.styles[4].years, (model::YearRange{1963, 1963}));
}

TEST(ClassifyExtract, AHouseWithoutADateFollowsDatedNeighbours) {
  Row row(3);
  row.date(0, 1963);
  row.date(2, 1961);
  EXPECT_EQ(row.classify({.dates = false, .smooth = false}).styles[1].style_class(), StyleClass::gruenderzeit)
      << "by its own evidence";
  const StyleExtract s = row.classify();
  EXPECT_EQ(s.styles[1].style_class(), StyleClass::modern);
  EXPECT_EQ(s.styles[1].built(), Era::post1945) << "dated neighbours vote";
}

TEST(ClassifyExtract, DatedNeighboursOfItsEraTellTheYearsOfAHouse) {
  Row row(9);
  row.date(0, 1887), row.date(1, 1890), row.date(3, 1894), row.date(5, 1908);
  const StyleExtract s = row.classify();
  EXPECT_EQ(s.dates[1].voters, 0) << "it has a date of its own";
  EXPECT_EQ(s.dates[1].year, 0);
  const DateEstimate& d = s.dates[2];
  EXPECT_EQ(d.voters, 4);
  EXPECT_GE(d.year, 1890) << "those that touch it are loudest";
  EXPECT_LE(d.year, 1894);
  EXPECT_LE(d.from, d.year - kLeastYears);
  EXPECT_GE(d.to, d.year + kLeastYears);
  EXPECT_LT(d.to, 1908) << "the one far off is not among the middle half";
  EXPECT_GT(d.confidence, 0.5f);
  EXPECT_EQ(row.classify({.dates = false}).dates[2].year, 0);

  Row edge(3);
  edge.date(0, 1917), edge.date(2, 1918);
  const StyleExtract at_edge = edge.classify();
  EXPECT_EQ(at_edge.styles[1].built(), Era::from1840);
  EXPECT_EQ(at_edge.dates[1].to, 1918) << "within the era";
  Row old(3);
  old.date(0, 1390), old.date(2, 1404);
  const StyleExtract of_old = old.classify();
  EXPECT_EQ(of_old.styles[1].built(), Era::pre1840);
  EXPECT_LE(of_old.dates[1].from, 1390);
  EXPECT_LT(of_old.dates[1].to, 1450) << "years before 1500 are years, too";
}

TEST(ClassifyExtract, TheClassSaysLittleOfTheEraWhereDatedNeighboursAre) {
  Row row(5);
  const StyleExtract none = row.classify();
  ASSERT_EQ(none.styles[2].style_class(), StyleClass::gruenderzeit);
  for (const std::size_t i : {0u, 1u, 3u, 4u}) row.date(i, 1926);
  const StyleExtract s = row.classify();
  EXPECT_EQ(s.styles[2].built(), Era::from1919);
  EXPECT_GT(s.styles[2].era[static_cast<std::size_t>(Era::from1919)], 0.8f);
  EXPECT_TRUE(classify::agree(s.styles[2].style_class(), s.styles[2].built()));
}

TEST(ClassifyExtract, ADateSpeaksForARowOfItsTime) {
  const auto infill = [](int own, int left, int right) {
    Row row(7);
    for (BuildingPlace& place : row.facts.places) place.position = BuildingPosition::mid_row;
    row.date(3, own);
    row.date(2, left), row.date(4, right);
    Row without = row;
    without.tags.dates[3] = {}, without.tags.years[3].reset();
    without.facts.features[3][Feature::tag_year] = kUnknown;
    return row.classify({.smooth = false}).styles[0].era == without.classify({.smooth = false}).styles[0].era;
  };
  EXPECT_TRUE(infill(1963, 1890, 1900)) << "both sides are older";
  EXPECT_FALSE(infill(1963, 1890, 1961)) << "one side is of its time";
  EXPECT_FALSE(infill(1925, 1890, 1900)) << "within a building period";
  EXPECT_FALSE(infill(1890, 1963, 1961)) << "a survivor among later houses is no infill";
}

TEST(ClassifyExtract, ProbabilitiesFollowFromEvidenceAndWhatIsToldOfElsewhere) {
  Row row(7);
  row.date(2, 1963);
  const classify::RegionPrior region{.style = std::array<double, 4>{0.7, 0.1, 0.1, 0.1}, .era = {}, .substyle = {}};
  const StyleExtract s = row.classify({}, 1, [&](std::uint32_t b) { return b < 4 ? &region : nullptr; });
  for (std::size_t i = 0; i < 7; ++i) {
    classify::PerAnswer sum = tables().style.log_odds(row.facts.features[i]);
    for (std::size_t c = 0; c < 4; ++c) sum[c] += static_cast<double>(s.elsewhere[i][c]);
    const classify::PerAnswer expected = classify::probabilities(sum, 4);
    for (std::size_t c = 0; c < 4; ++c)
      EXPECT_NEAR(static_cast<double>(s.styles[i].style[c]), expected[c], 1e-3) << i << " " << c;
  }
  EXPECT_GT(p(s, 0, StyleClass::gruenderzeit), p(s, 4, StyleClass::gruenderzeit)) << "as far from the date";
}

TEST(ClassifyExtract, TagsAndDatesCanBeLeftOut) {
  Row row(3);
  row.date(1, 1963);
  const StyleExtract s = row.classify({.tags = false, .dates = false});
  EXPECT_EQ(s.styles[1].style, s.styles[0].style);
  EXPECT_EQ(s.styles[1].era, s.styles[0].era);
}

TEST(ClassifyExtract, AHousesOwnStoreysAreNoEvidenceForThemselves) {
  Row row(5);
  row.storeys(0, 4);
  row.storeys(4, 5);
  row.storeys(2, 4);
  const StyleExtract four = row.classify();
  row.storeys(2, 8);
  const StyleExtract eight = row.classify();
  row.facts.features[2][Feature::tag_storeys] = kUnknown;
  const StyleExtract hidden = row.classify();
  const auto same = [](const StoreysEstimate& a, const StoreysEstimate& b) {
    return a.storeys == b.storeys && a.confidence == b.confidence && a.votes == b.votes && a.own == b.own &&
           a.voters == b.voters;
  };
  EXPECT_TRUE(same(four.storeys[2], eight.storeys[2]));
  EXPECT_TRUE(same(four.storeys[2], hidden.storeys[2]));
  EXPECT_EQ(four.storeys[2].voters, 2);
  EXPECT_FALSE(same(four.storeys[1], eight.storeys[1])) << "but its neighbours listen to it";
  EXPECT_LE(four.storeys[1].confidence, 0.9f) << "neighbours are no tags";
}

TEST(ClassifyExtract, StoreysOfTaggedNeighboursAreMet) {
  Row row(5);
  for (const std::size_t i : {0u, 1u, 3u, 4u}) row.storeys(i, 6);
  EXPECT_EQ(row.classify().storeys[2].storeys, 6);
  EXPECT_EQ(row.classify().storeys[2].own, 4) << "what its size alone would say";
  Row alone(1);
  EXPECT_EQ(alone.classify().storeys[0].storeys, 4);
  EXPECT_EQ(alone.classify().storeys[0].voters, 0);
}

TEST(ClassifyExtract, ARuleMakesNonHousesOtherAndSilent) {
  Row row(3);
  row.tags.reasons.push_back({"garage", "ancillary", "building=garage: a garage"});
  row.tags.non_house[1] = 0;
  const StyleExtract s = row.classify();
  EXPECT_TRUE(s.styles[1].non_house);
  EXPECT_EQ(s.styles[1].style_class(), StyleClass::other);
  EXPECT_EQ(tables().catalogue[s.styles[1].substyle].id, "ancillary");
  // Their neighbours do not follow them: w0 and w2 stand as if each had the other alone in its block.
  Row without(3);
  without.facts.contacts.clear();
  for (BuildingPlace& place : without.facts.places) place.contacts = {};
  without.tags.reasons = row.tags.reasons;
  without.tags.non_house = row.tags.non_house;
  EXPECT_EQ(s.styles[0].style, without.classify().styles[0].style);
  EXPECT_EQ(s.elsewhere[1], (std::array<float, 4>{})) << "nor does it listen";
}

TEST(ClassifyExtract, TheSubstyleIsOfTheLikeliestClass) {
  Row row(5);
  row.date(3, 1963);
  const StyleExtract s = row.classify();
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(tables().catalogue[s.styles[i].substyle].style_class, s.styles[i].style_class()) << i;
    EXPECT_GT(s.styles[i].substyle_p, 0) << i;
    EXPECT_LE(s.styles[i].substyle_p, p(s, i, s.styles[i].style_class()) + 1e-4f) << i;
  }
}

/// A town with something of everything.
Row town();

TEST(ClassifyExtract, EraClassAndSubstyleAreOneDecision) {
  const Row row = town();
  const StyleExtract s = row.classify();
  for (std::size_t i = 0; i < 3000; ++i) {
    const model::BuildingStyle& style = s.styles[i];
    if (!row.facts.features[i].has(Feature::area) || style.non_house) continue;
    EXPECT_TRUE(classify::agree(style.style_class(), style.built())) << i;
    EXPECT_EQ(tables().catalogue[style.substyle].style_class, style.style_class()) << i;
  }
}

Row town() {
  Row row(3000);
  std::uint32_t state = 12345;
  const auto random = [&](std::uint32_t below) {
    state = state * 1664525u + 1013904223u;
    return (state >> 8) % below;
  };
  row.tags.reasons.push_back({"garage", "ancillary", "building=garage: a garage"});
  for (std::uint32_t i = 0; i < 3000; ++i) {
    auto& f = row.facts.features[i];
    BuildingPlace& place = row.facts.places[i];
    place.place = {391000 + 12.0 * (i % 60), 5820000 + 40.0 * (i / 60)};
    place.block = random(20) == 0 ? model::kNoIndex : i / 30;
    place.street = i / 60;
    place.position = static_cast<BuildingPosition>(random(7));
    f[Feature::position] = static_cast<float>(place.position);
    f[Feature::area] = static_cast<float>(30 + random(400));
    f[Feature::party_share] = static_cast<float>(random(100)) / 100;
    place.house = f[Feature::area] >= 40;
    if (random(10) == 0) row.date(i, 1800 + static_cast<int>(random(220)), static_cast<float>(random(100)) / 100);
    if (random(3) == 0) row.storeys(i, static_cast<float>(1 + random(8)));
    if (random(5) == 0) {
      row.tags.roofs[i] = static_cast<model::RoofShape>(random(12));
      f[Feature::tag_roof] = 1;
    }
    if (random(30) == 0) row.tags.non_house[i] = 0;
    if (random(50) == 0) f = {};  // repair left nothing of it
  }
  return row;
}

void expect_same(const StyleExtract& a, const StyleExtract& b, std::size_t i) {
  EXPECT_EQ(a.styles[i].style, b.styles[i].style) << i;
  EXPECT_EQ(a.styles[i].era, b.styles[i].era) << i;
  EXPECT_EQ(a.styles[i].morphology, b.styles[i].morphology) << i;
  EXPECT_EQ(a.styles[i].substyle, b.styles[i].substyle) << i;
  EXPECT_EQ(a.styles[i].substyle_p, b.styles[i].substyle_p) << i;
  EXPECT_EQ(a.elsewhere[i], b.elsewhere[i]) << i;
  EXPECT_EQ(a.storeys[i].storeys, b.storeys[i].storeys) << i;
  EXPECT_EQ(a.storeys[i].confidence, b.storeys[i].confidence) << i;
  EXPECT_EQ(a.storeys[i].votes, b.storeys[i].votes) << i;
  EXPECT_EQ(a.roofs[i].shape, b.roofs[i].shape) << i;
  EXPECT_EQ(a.roofs[i].confidence, b.roofs[i].confidence) << i;
}

TEST(ClassifyExtract, TheNumberOfWorkersChangesNothing) {
  const Row row = town();
  const StyleExtract one = row.classify();
  for (const int workers : {2, 5}) {
    const StyleExtract many = row.classify({}, workers);
    for (std::size_t i = 0; i < 3000 && !HasFailure(); ++i) expect_same(one, many, i);
  }
}

TEST(ClassifyExtract, ProbabilitiesSumToOneOrNothingIsKnown) {
  const Row row = town();
  const StyleExtract s = row.classify();
  const auto sum = [](const auto& p) {
    float all = 0;
    for (const float v : p) all += v;
    return all;
  };
  int unknown = 0;
  for (std::size_t i = 0; i < 3000; ++i) {
    const bool known = row.facts.features[i].has(Feature::area);
    unknown += !known;
    EXPECT_NEAR(sum(s.styles[i].style), known, 2e-4) << i;
    EXPECT_NEAR(sum(s.styles[i].era), known, 2e-4) << i;
    EXPECT_NEAR(sum(s.styles[i].morphology), known, 2e-4) << i;
  }
  EXPECT_GT(unknown, 0);
}

TEST(ClassifyExtract, WhatIsFarAwayIsNotListenedTo) {
  Row row(60);
  const StyleExtract before = row.classify();
  row.date(59, 1963);
  row.storeys(59, 1);
  const StyleExtract after = row.classify();
  // 150 m of votes, three rounds of 100 m and a house: 59 stands 708 m from 0.
  for (std::size_t i = 0; i < 60 - 1 - 460 / 12; ++i) expect_same(before, after, i);
  EXPECT_NE(before.styles[58].style, after.styles[58].style);
}

}  // namespace
}  // namespace blockrand::evidence
