#include "styles/classify/evidence_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

#include "pipeline/base/error.h"

namespace blockrand::classify {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::string_view kSmall = R"(answers = ["house", "shed", "church"]
[prior]
house = 0.5
church = -1
[feature.depth_ratio]
edges = [1.2, 1.5]
house = [-1.0, 0.25, 2.0]
shed = [0.5, 0.0, -0.5]
[feature.yards]
edges = []
church = [0.125]
[feature.tag_storeys]
edges = [3.5]
shed = [1.0, -3.0]
)";

EvidenceModel read(std::string_view text, std::span<const std::string_view> answers = {}) {
  const std::string path = (std::filesystem::path(testing::TempDir()) / "evidence_model_test.toml").string();
  std::ofstream(path) << text;
  return EvidenceModel::read(path, answers);
}

std::string complaint(const std::string& from, const std::string& to, std::span<const std::string_view> answers = {}) {
  std::string text(kSmall);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  try {
    read(text, answers);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "no complaint";
}

TEST(EvidenceModel, NamesThePlaceOfEveryError) {
  constexpr std::string_view kOthers[] = {"house", "church", "shed"};
  const auto at = [](const char* line) { return HasSubstr("evidence_model_test.toml:" + std::string(line) + ":"); };
  EXPECT_THAT(complaint("[\"house\", \"shed\", \"church\"]", "[]"), AllOf(at("1"), HasSubstr("no answers")));
  EXPECT_THAT(complaint("answers = ", "anwsers = "), HasSubstr("evidence_model_test.toml: answers"));
  EXPECT_THAT(complaint("\"church\"]", "\"c\",\"d\",\"e\",\"f\",\"g\",\"h\",\"i\",\"j\",\"k\",\"l\",\"m\"]"),
              AllOf(at("1"), HasSubstr("more than 12 answers")));
  EXPECT_THAT(complaint("edges = []", "edges = []", kOthers),
              AllOf(at("1"), HasSubstr("in this order: house, church, shed")));
  EXPECT_THAT(complaint("house = 0.5", "hosue = 0.5"), AllOf(at("3"), HasSubstr("house")));
  EXPECT_THAT(complaint("house = 0.5", "house = 20.5"), AllOf(at("3"), HasSubstr("20")));
  EXPECT_THAT(complaint("[feature.depth_ratio]", "[feature.depth_ration]"),
              AllOf(at("5"), HasSubstr("Did you mean `depth_ratio`?")));
  EXPECT_THAT(complaint("[feature.depth_ratio]", "[feature.zeppelin_mast]"),
              AllOf(at("5"), HasSubstr("docs/classification.md")));
  EXPECT_THAT(complaint("[1.2, 1.5]", "[1.5, 1.2]"), AllOf(at("6"), HasSubstr("edges do not ascend")));
  EXPECT_THAT(complaint("[1.2, 1.5]", "[1.2, 1.2]"), AllOf(at("6"), HasSubstr("edges do not ascend")));
  EXPECT_THAT(complaint("[1.2, 1.5]", "[1.2, inf]"), AllOf(at("6"), HasSubstr("edges")));
  EXPECT_THAT(complaint("[1.2, 1.5]", "[1.2]"), AllOf(at("7"), HasSubstr("3 weights for 2 bins")));
  EXPECT_THAT(complaint("[-1.0, 0.25, 2.0]", "[-1.0, 0.25]"), AllOf(at("7"), HasSubstr("2 weights for 3 bins")));
  EXPECT_THAT(complaint("0.25, 2.0", "0.25, 20.5"), AllOf(at("7"), HasSubstr("a weight beyond 20")));
  EXPECT_THAT(complaint("0.25, 2.0", "0.25, nan"), at("7"));
  EXPECT_THAT(complaint("shed = [0.5", "shde = [0.5"), AllOf(at("8"), HasSubstr("shed")));
  EXPECT_THAT(complaint("[prior]", "[priors]"), AllOf(at("2"), HasSubstr("prior")));
  EXPECT_EQ(complaint("edges = []", "edges = []"), "no complaint");
  try {
    EvidenceModel::read("/nowhere/style.toml");
    FAIL() << "a missing file was read";
  } catch (const base::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/nowhere/style.toml"));
  }
}

FeatureVector with(std::initializer_list<std::pair<Feature, float>> values) {
  FeatureVector f;
  for (const auto& [feature, value] : values) f[feature] = value;
  return f;
}

TEST(EvidenceModel, AddsUpByHand) {
  const EvidenceModel m = read(kSmall);
  EXPECT_THAT(m.answers(), testing::ElementsAre("house", "shed", "church"));
  const FeatureVector f = with({{Feature::depth_ratio, 1.3f}, {Feature::yards, 7.f}, {Feature::tag_storeys, 5.f}});
  const PerAnswer all = m.log_odds(f);
  EXPECT_DOUBLE_EQ(all[0], 0.5 + 0.25);
  EXPECT_DOUBLE_EQ(all[1], 0.0 - 3.0);
  EXPECT_DOUBLE_EQ(all[2], -1 + 0.125);
  for (std::size_t a = 3; a < kMaxAnswers; ++a) EXPECT_EQ(all[a], 0);
  EXPECT_DOUBLE_EQ(m.log_odds(f, false)[1], 0) << "tags are not asked";
  EXPECT_DOUBLE_EQ(m.log_odds({})[0], 0.5) << "what is not known gives no evidence";

  const PerAnswer p = probabilities(all, 3);
  const double sum = std::exp(0.75) + std::exp(-3.0) + std::exp(-0.875);
  EXPECT_NEAR(p[0], std::exp(0.75) / sum, 1.0 / 65536);
  EXPECT_NEAR(p[1], std::exp(-3.0) / sum, 1.0 / 65536);
  EXPECT_NEAR(p[2], std::exp(-0.875) / sum, 1.0 / 65536);
  EXPECT_EQ(p[0] * 65536, std::floor(p[0] * 65536)) << "on the grid that hides the order of sums";
  EXPECT_EQ(p[3], 0);
}

TEST(EvidenceModel, ProbabilitiesStandGreatLogOdds) {
  const PerAnswer p = probabilities({900, 899, -900}, 3);
  EXPECT_NEAR(p[0], 1 / (1 + std::exp(-1.0)), 1e-4);
  EXPECT_NEAR(p[1], 1 - 1 / (1 + std::exp(-1.0)), 1e-4);
  EXPECT_EQ(p[2], 0);
}

TEST(EvidenceModel, ABinHoldsItsLowerEdge) {
  const EvidenceModel m = read(R"(answers = ["a", "b"]
[feature.neighbours]
edges = [1.5, 2]
a = [1, 2, 4]
)");
  const auto weight = [&](float v) { return m.log_odds(with({{Feature::neighbours, v}}))[0]; };
  EXPECT_EQ(weight(-1e30f), 1);
  EXPECT_EQ(weight(std::nextafter(1.5f, 0.f)), 1);
  EXPECT_EQ(weight(1.5f), 2);
  EXPECT_EQ(weight(std::nextafter(2.f, 0.f)), 2);
  EXPECT_EQ(weight(2.f), 4);
  EXPECT_EQ(weight(1e30f), 4);
  const Contribution c = m.contributions(with({{Feature::neighbours, 1.5f}})).at(0);
  EXPECT_EQ(c.low, 1.5);
  EXPECT_EQ(c.high, 2);
  EXPECT_EQ(m.contributions(with({{Feature::neighbours, 1}})).at(0).low, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(m.contributions(with({{Feature::neighbours, 3}})).at(0).high, std::numeric_limits<double>::infinity());
}

TEST(EvidenceModel, ContributionsComeTheWeightiestFirstAndSumToTheLogOdds) {
  const EvidenceModel m = read(kSmall);
  const FeatureVector f = with({{Feature::depth_ratio, 1.9f}, {Feature::yards, 0.f}, {Feature::tag_storeys, 5.f}});
  const std::vector<Contribution> c = m.contributions(f);
  ASSERT_EQ(c.size(), 3u);
  EXPECT_EQ(static_cast<Feature>(c[0].feature), Feature::tag_storeys) << "spread 3";
  EXPECT_EQ(static_cast<Feature>(c[1].feature), Feature::depth_ratio) << "spread 2.5";
  EXPECT_EQ(static_cast<Feature>(c[2].feature), Feature::yards) << "spread 0.125";
  EXPECT_FLOAT_EQ(static_cast<float>(c[1].value), 1.9f);
  PerAnswer sum = m.prior();
  for (const Contribution& term : c)
    for (std::size_t a = 0; a < kMaxAnswers; ++a) sum[a] += term.weights[a];
  const PerAnswer all = m.log_odds(f);
  for (std::size_t a = 0; a < kMaxAnswers; ++a) EXPECT_NEAR(sum[a], all[a], 1.0 / 4096);
  EXPECT_EQ(m.contributions(f, false).size(), 2u);
  EXPECT_THAT(m.contributions({}), IsEmpty());
}

/// The answer of every bin of every feature, tried one after the other, against changes_to.
TEST(EvidenceModel, ChangesAreThoseThatTryingFinds) {
  const EvidenceModel m = read(R"(answers = ["a", "b", "c"]
[prior]
b = 0.25
[feature.depth_ratio]
edges = [1, 2, 3]
a = [0.0, 1.5, 0.5, -2.5]
b = [1.0, -0.5, 0.5, 1.0]
c = [-1.0, 0.5, 2.5, 0.5]
[feature.neighbours]
edges = [1, 2, 3]
a = [0.5, -0.5, 0.0, 0.5]
b = [-1.5, 0.0, 3.5, 0.0]
c = [0.0, 1.0, 0.0, 1.5]
[feature.corners]
edges = [1, 2, 3]
a = [3.5, 0.5, 0.0, 0.0]
b = [0.0, 0.5, 0.5, 2.0]
c = [0.5, 0.0, -0.5, 2.5]
)");
  constexpr Feature kAsked[] = {Feature::depth_ratio, Feature::neighbours, Feature::corners};
  constexpr float kInside[] = {0.5f, 1.5f, 2.5f, 3.5f};
  const PerAnswer elsewhere{0.125, -0.25, 0.0625};
  const auto winner = [&](const FeatureVector& f) {
    const PerAnswer l = m.log_odds(f);
    std::size_t best = 0, ties = 0;
    for (std::size_t a = 1; a < 3; ++a)
      if (l[a] + elsewhere[a] > l[best] + elsewhere[best]) best = a;
    for (std::size_t a = 0; a < 3; ++a) ties += l[a] + elsewhere[a] == l[best] + elsewhere[best];
    return ties == 1 ? best : std::size_t{9};
  };
  int changes = 0;
  for (int i = 0; i < 64; ++i) {
    const int bins[] = {i % 4, i / 4 % 4, i / 16};
    FeatureVector f;
    for (std::size_t k = 0; k < 3; ++k) f[kAsked[k]] = kInside[bins[k]];
    for (std::size_t answer = 0; answer < 3; ++answer) {
      if (winner(f) == answer) continue;
      std::vector<std::pair<Feature, int>> expected;
      for (std::size_t k = 0; k < 3; ++k) {
        int best = -1;
        for (int b = 0; b < 4; ++b) {
          if (b == bins[k]) continue;
          FeatureVector g = f;
          g[kAsked[k]] = kInside[b];
          if (winner(g) == answer && (best < 0 || std::abs(b - bins[k]) < std::abs(best - bins[k]))) best = b;
        }
        if (best >= 0) expected.emplace_back(kAsked[k], best);
      }
      std::vector<std::pair<Feature, int>> found;
      for (const Contribution& c : m.changes_to(f, answer, elsewhere))
        found.emplace_back(static_cast<Feature>(c.feature), std::isinf(c.low) ? 0 : static_cast<int>(c.low));
      std::sort(expected.begin(), expected.end());
      std::sort(found.begin(), found.end());
      EXPECT_EQ(found, expected) << "bins " << bins[0] << bins[1] << bins[2] << ", answer " << answer;
      changes += static_cast<int>(found.size());
    }
  }
  EXPECT_GT(changes, 50) << "the table is such that much can change";
}

TEST(EvidenceModel, ChangesAskNoTagsWhereTagsAreOff) {
  const EvidenceModel m = read(kSmall);
  const FeatureVector f = with({{Feature::tag_storeys, 5.f}, {Feature::depth_ratio, 1.3f}});
  const auto with_tags = m.changes_to(f, 1, {}), without = m.changes_to(f, 1, {}, false);
  ASSERT_EQ(with_tags.size(), 1u);
  EXPECT_EQ(static_cast<Feature>(with_tags[0].feature), Feature::tag_storeys);
  EXPECT_EQ(with_tags[0].high, 3.5);
  EXPECT_EQ(with_tags[0].value, 5) << "what it is now";
  ASSERT_EQ(without.size(), 1u);
  EXPECT_EQ(static_cast<Feature>(without[0].feature), Feature::depth_ratio);
}

}  // namespace
}  // namespace blockrand::classify
