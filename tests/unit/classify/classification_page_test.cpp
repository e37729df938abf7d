// docs/classification.md says of the features what the code says, and its worked example is worked out right.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "styles/classify/evidence_model.h"
#include "styles/classify/features.h"

namespace blockrand::classify {
namespace {

std::string page() {
  std::ifstream file(BLOCKRAND_SOURCE_DIR "/docs/classification.md");
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string feature_table() {
  std::string text = "| feature | unit | group | what it is |\n|---|---|---|---|\n";
  for (const FeatureInfo& f : kFeatures)
    text += "| `" + std::string(f.name) + "` | " + std::string(f.unit == "m2" ? "m²" : f.unit) + " | " +
            std::string(f.group) + " | " + std::string(f.meaning) + " |\n";
  return text;
}

TEST(ClassificationPage, ListsTheFeaturesOfTheCode) {
  const std::string text = page(), begin = "features.h -->\n", end = "<!-- /features -->";
  const std::size_t from = text.find(begin), to = text.find(end);
  ASSERT_TRUE(from != std::string::npos && to != std::string::npos)
      << "docs/classification.md has lost the marks around its table";
  EXPECT_EQ(text.substr(from + begin.size(), to - from - begin.size()), feature_table())
      << "put this between the marks:\n"
      << feature_table();
}

TEST(ClassificationPage, NamesReachesAsTheCodeHasThem) {
  EXPECT_THAT(page(), testing::HasSubstr("within " + std::to_string(static_cast<int>(kNearReach)) + " m"));
  EXPECT_THAT(page(), testing::HasSubstr("houses of " + std::to_string(static_cast<int>(kHouseArea)) + " m²"));
}

TEST(ClassificationPage, WorksItsExampleOutRight) {
  const std::string text = page();
  const auto numbers = [&](const std::string& row) {
    const std::size_t at = text.find("| " + row + " |");
    EXPECT_NE(at, std::string::npos) << row;
    std::string line = text.substr(at, text.find('\n', at) - at);
    line = std::regex_replace(line, std::regex("\\*\\*| %"), "");
    std::array<double, 4> out{};
    std::size_t end = line.size() - 1;
    for (std::size_t k = 4; k-- > 0;) {
      const std::size_t bar = line.rfind('|', end - 1);
      out[k] = std::stod(line.substr(bar + 1, end - bar - 1));
      end = bar;
    }
    return out;
  };
  const auto depth = numbers("`depth_ratio` | 1.9"), party = numbers("`party_share` | 0.43"),
             position = numbers("`position` | 3 (mid row)");
  const auto sum = numbers("**sum**"), shown = numbers("**probability**");
  PerAnswer log_odds{};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(sum[k], depth[k] + party[k] + position[k], 1e-9) << k;
    log_odds[k] = sum[k];
  }
  const PerAnswer p = probabilities(log_odds, 4);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(shown[k], 100 * p[k], 0.5) << k;
}

}  // namespace
}  // namespace blockrand::classify
