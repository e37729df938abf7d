// When a row is told to stand elsewhere, and why not.
#include "pipeline/observation/verdict.h"

#include <gtest/gtest.h>

namespace blockrand::observation {
namespace {

RowMatch clear_match() {
  RowMatch m;
  m.seen = true;
  m.shift = {1.5, -1};
  m.best = 0.85, m.here = 0.55, m.mean = 0.5, m.deviation = 0.08, m.second = 0.65, m.weight = 60;
  return m;
}

TEST(Verdict, AClearMatchElsewhereIsACorrection) {
  const Verdict v = judge(clear_match(), true);
  EXPECT_EQ(v.state, RowState::corrected);
  EXPECT_TRUE(v.reason.empty());
  EXPECT_GT(v.confidence, kSureCorrection);
  EXPECT_LE(v.confidence, 1);
}

TEST(Verdict, WhatIsNotClearStaysWithAReason) {
  const auto state = [](auto&& change, bool lean_known = true) {
    RowMatch m = clear_match();
    change(m);
    const Verdict v = judge(m, lean_known);
    EXPECT_FALSE(v.reason.empty());
    return v.state;
  };
  EXPECT_EQ(state([](RowMatch& m) { m.seen = false; }), RowState::outside);
  EXPECT_EQ(state([](RowMatch& m) { m.deviation = 0; }), RowState::undecided);
  EXPECT_EQ(state([](RowMatch&) {}, false), RowState::undecided);
  EXPECT_EQ(state([](RowMatch& m) { m.shift = {0.2, -0.2}; }), RowState::left_alone);
  EXPECT_EQ(state([](RowMatch& m) { m.here = 0.82; }), RowState::left_alone);
  EXPECT_EQ(state([](RowMatch& m) { m.second = 0.84; }), RowState::undecided);
  EXPECT_EQ(state([](RowMatch& m) { m.best = 0.65, m.second = 0.6, m.mean = 0.52; }), RowState::undecided);
}

TEST(Verdict, LongRowsNeedLessOfALeadOverOtherPlaces) {
  RowMatch m = clear_match();
  m.second = m.best - 0.4 * m.deviation;
  EXPECT_EQ(judge(m, true).state, RowState::undecided);
  m.weight = 400;
  EXPECT_EQ(judge(m, true).state, RowState::corrected);
  m.second = m.best - 0.1 * m.deviation;
  EXPECT_EQ(judge(m, true).state, RowState::undecided);
}

SeenPlace seen(RowState state, double confidence, model::Point2 shift, std::string date = "") {
  return {{state, "", confidence}, shift, std::move(date)};
}

TEST(TwoImages, ThatAgreeAreSurerThanEither) {
  const auto [second, verdict] =
      joined(seen(RowState::undecided, 0.5, {1.5, 0}, "2019"), seen(RowState::undecided, 0.55, {1.7, 0.2}, "2022"));
  EXPECT_TRUE(second);
  EXPECT_EQ(verdict.state, RowState::corrected);
  EXPECT_TRUE(verdict.reason.empty());
  EXPECT_GT(verdict.confidence, 0.75);
  EXPECT_LT(verdict.confidence, 1);
}

TEST(TwoImages, ThatAreSureOfDifferentPlacesLeaveItUndecided) {
  const auto [second, verdict] =
      joined(seen(RowState::corrected, 0.8, {2, 0}), seen(RowState::left_alone, 0.7, {0.1, 0}));
  EXPECT_FALSE(second);
  EXPECT_EQ(verdict.state, RowState::undecided);
  EXPECT_EQ(verdict.reason, "another image shows it at another place");
}

TEST(TwoImages, OfOneFlightAreOneWitness) {
  // Two copies of a picture, or two tiles of a mosaic where they overlap.
  for (const char* date : {"", "2022"}) {
    const SeenPlace a = seen(RowState::undecided, 0.5, {1.5, 0}, date),
                    b = seen(RowState::undecided, 0.5, {1.5, 0}, date);
    EXPECT_EQ(joined(a, b).second.state, RowState::undecided);
    EXPECT_EQ(joined(a, b).second.confidence, 0.5);
  }
  // Undated pictures whose roofs lean differently are two.
  SeenPlace a = seen(RowState::undecided, 0.5, {1.5, 0}), b = seen(RowState::undecided, 0.5, {1.5, 0});
  a.lean = {0.1, 0}, b.lean = {-0.1, 0};
  EXPECT_EQ(joined(a, b).second.state, RowState::corrected);
}

TEST(TwoImages, AnotherHeightExplainsItStill) {
  SeenPlace a = seen(RowState::undecided, 0.5, {1.5, 0}, "2019");
  const SeenPlace b = seen(RowState::undecided, 0.45, {1.5, 0}, "2022");
  a.verdict.by_height = true;
  EXPECT_EQ(joined(a, b).second.state, RowState::undecided);
}

TEST(TwoImages, OneThatIsNotSureSaysNothing) {
  const SeenPlace sure = seen(RowState::corrected, 0.8, {2, 0});
  for (const double confidence : {0.0, 0.29}) {
    const auto [second, verdict] = joined(seen(RowState::undecided, confidence, {-1, 0}), sure);
    EXPECT_TRUE(second);
    EXPECT_EQ(verdict.state, RowState::corrected);
    EXPECT_EQ(verdict.confidence, 0.8);
  }
  // One that is half sure of another place leaves a doubt.
  const Verdict doubtful = joined(sure, seen(RowState::undecided, 0.4, {-1, 0})).second;
  EXPECT_EQ(doubtful.state, RowState::corrected);
  EXPECT_LT(doubtful.confidence, 0.75);
}

TEST(TwoImages, WhatStandsWhereItIsMappedStaysThere) {
  const auto state =
      joined(seen(RowState::left_alone, 0.6, {0.2, 0}), seen(RowState::undecided, 0.6, {0.3, 0})).second.state;
  EXPECT_EQ(state, RowState::left_alone);
  EXPECT_EQ(joined(seen(RowState::undecided, 0.6, {0.2, 0}), seen(RowState::undecided, 0.6, {0.3, 0})).second.state,
            RowState::undecided);
}

TEST(Verdict, MoreEvidenceIsMoreConfidence) {
  const double before = judge(clear_match(), true).confidence;
  RowMatch m = clear_match();
  m.weight *= 4;
  EXPECT_GT(judge(m, true).confidence, before);
  m = clear_match();
  m.mean -= 0.05;
  EXPECT_GT(judge(m, true).confidence, before);
  m = clear_match();
  m.shift = {3.5, 1};  // at the rim of the search
  EXPECT_LT(judge(m, true).confidence, before);
}

}  // namespace
}  // namespace blockrand::observation
