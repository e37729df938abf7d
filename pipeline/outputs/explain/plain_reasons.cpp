#include "pipeline/outputs/explain/plain_reasons.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

namespace blockrand::outputs {
namespace {

using Json = nlohmann::ordered_json;

/// Log-odds below which a reason says little: it makes one answer a seventh likelier.
constexpr double kLeastWeight = 0.15;
/// Reasons about the houses around, of those that are told: they say much the same.
constexpr int kMostAround = 1;

/// A sentence with one place for a number.
struct Sentence {
  std::string_view feature;
  std::string_view text;    ///< "{}" is the number
  bool share = false;       ///< in percent
  std::string_view none{};  ///< for 0, or what rounds to it; empty: the same
  std::string_view one{};   ///< for 1
};

constexpr Sentence kSentences[] = {
    {"area", "it covers {} m²"},
    {"length", "it is {} m long"},
    {"breadth", "its shorter side measures {} m"},
    {"elongation", "it is {} times as long as wide"},
    {"corners", "its outline has {} corners"},
    {"yards", "it encloses {} courtyards of its own", false, "it encloses no courtyard of its own",
     "it encloses a courtyard of its own"},
    {"frontage", "its front is {} m wide"},
    {"front_depth", "it is {} m deep behind its front"},
    {"party_share", "it shares {} % of its walls with neighbours", true, "it shares no wall with a neighbour"},
    {"neighbours", "{} houses touch it", false, "no house touches it", "one house touches it"},
    {"front_share", "{} % of its walls stand along streets", true, "none of its walls stands along a street"},
    {"court_share", "{} % of its walls stand along courtyards", true, "none of its walls stands at a courtyard"},
    {"street_distance", "its front is {} m from the middle of the street"},
    {"front_gap", "it stands {} m behind the nearest house that has a street front"},
    {"around_count", "{} houses stand within 100 m", false, "no other house stands within 100 m"},
    {"around_area", "houses around it usually cover {} m²"},
    {"around_frontage", "fronts around it are usually {} m wide"},
    {"around_depth", "houses around it are usually {} m deep"},
    {"around_depth_ratio", "{} % of the houses around it have wings", true, "no house around it has wings"},
    {"around_party_share", "houses around it share {} % of their walls", true, "houses around it stand free"},
    {"around_elongation", "houses around it are usually {} times as long as wide"},
    {"around_corners", "outlines around it have {} corners on average"},
    {"around_built", "{} % of the land around it is built on", true},
    {"around_rear", "{} % of the houses around it stand in courtyards", true,
     "no house around it stands in a courtyard"},
    {"around_small", "there are {} sheds or garages around for each house", false,
     "there are no sheds or garages around"},
    {"row_count", "its row has {} houses", false, {}, "it is no part of a row"},
    {"row_area", "its row covers {} m²"},
    {"row_breadth", "its row is {} m deep"},
    {"row_length", "its row is {} m long"},
    {"row_alike", "{} % of the houses in its row are as wide and large as their neighbours", true,
     "no two neighbours in its row are alike"},
    {"block_area", "its block has {} hectares"},
    {"block_built", "{} % of its block is built on", true},
    {"block_closure", "houses close {} % of its block's street front", true},
    {"block_court", "courtyards take {} % of its block", true, "its block has no courtyards"},
    {"block_rear", "{} % of the houses in its block stand in courtyards", true,
     "no house of its block stands in a courtyard"},
    {"street_width", "its street is {} m wide between the fronts"},
    {"town_built", "{} % of this part of town is built on", true},
    {"town_party_share", "{} % of the walls in this part of town are shared", true,
     "walls are not shared in this part of town"},
    {"town_density", "this part of town has {} buildings per hectare"},
    {"tag_storeys", "{} storeys are mapped", false, {}, "one storey is mapped"},
    {"tag_roof_storeys", "{} storeys in the roof are mapped", false, "no storey in the roof is mapped",
     "a storey in the roof is mapped"},
    {"tag_heritage", "it is mapped as listed or historic", false, "it is not mapped as listed or historic",
     "it is known by an article or its architect"},
    {"tag_shop", "a shop, office or the like is mapped in it", false, "no shop or office is mapped in it"},
    {"tag_number", "it has a house number", false, "it has no house number"},
};

/// Features whose numbers stand for things.
struct Things {
  std::string_view feature;
  int first = 0;
  std::span<const std::string_view> sentences;
};
constexpr std::string_view kPositions[] = {"it stands alone",
                                           "it stands at the end of a row",
                                           "it stands within a row",
                                           "it stands at a street corner",
                                           "it stands behind another house",
                                           "it is a wing at the back of other houses"};
constexpr std::string_view kStreets[] = {"it stands at a motorway",           "it stands at a trunk road",
                                         "it stands at a main road",          "it stands at a secondary main road",
                                         "it stands at a local through road", "it stands at a residential street",
                                         "it stands at a play street",        "it stands at a pedestrian street"};
constexpr std::string_view kRoofs[] = {
    "a flat roof is mapped",    "a gabled roof is mapped",  "a hipped roof is mapped",  "a mansard roof is mapped",
    "a saltbox roof is mapped", "a lean-to roof is mapped", "a pyramid roof is mapped", "an unusual roof is mapped"};
constexpr std::string_view kUses[] = {"the map does not say what it is used for",
                                      "it is mapped as flats",
                                      "it is mapped as residential",
                                      "it is mapped as a house",
                                      "it is mapped as a detached or terraced house",
                                      "it is mapped as an outbuilding",
                                      "it is mapped as offices",
                                      "it is mapped as a shop",
                                      "it is mapped as industry",
                                      "it is mapped as a church or the like",
                                      "it is mapped as a public building",
                                      "it is mapped as a hotel",
                                      "the use that is mapped is a rare one"};
constexpr Things kThings[] = {
    {"position", 1, kPositions}, {"street_class", 1, kStreets}, {"tag_roof", 1, kRoofs}, {"tag_use", 0, kUses}};

/// Features that are told by what their number means rather than by the number.
struct Threshold {
  std::string_view feature, below;
  double value;
  std::string_view above;
};
constexpr Threshold kThresholds[] = {
    {"rectangularity", "its outline is far from a rectangle", 0.85, "its outline is nearly a plain rectangle"},
    {"compactness", "its outline is a drawn-out one", 0.5, "its outline is a compact one"},
    {"depth_ratio", "it has no wings to the back", 1.5, "wings reach from it to the back"},
    {"street_angle", "its front is parallel to the street", 3, "its front stands at an angle to the street"},
    {"around_spread", "houses around it are of like size", 0.6, "houses around it differ much in size"},
    {"row_fill", "its row is bent or has wings", 0.75, "its row is a straight one"},
};

/// m: less is no setback that anybody sees.
constexpr double kSetback = 0.5;

/// At most two digits that say something: "17", "2.4", "760".
std::string rounded(double value) {
  const double size = std::fabs(value);
  if (size >= 1000) return fmt::format("{:.0f}", std::round(value / 100) * 100);
  if (size >= 100) return fmt::format("{:.0f}", std::round(value / 10) * 10);
  std::string text = fmt::format("{:.{}f}", value, size >= 9.95 ? 0 : 1);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

/// Measures that nobody sees in the street.
bool holds_little(std::string_view feature) {
  constexpr std::string_view kLittle[] = {"around_corners", "around_elongation", "around_spread", "row_area",
                                          "row_breadth",    "row_length",        "row_fill",      "compactness",
                                          "breadth",        "tag_number"};
  return std::find(std::begin(kLittle), std::end(kLittle), feature) != std::end(kLittle);
}

bool is_around(std::string_view feature) { return feature.starts_with("around_") || feature.starts_with("town_"); }

}  // namespace

std::string reason_sentence(std::string_view feature, std::string_view meaning, std::string_view unit, double value) {
  if (!std::isfinite(value)) return {};
  for (const Things& things : kThings)
    if (things.feature == feature) {
      const double index = std::round(value) - things.first;
      if (index < 0 || index >= static_cast<double>(things.sentences.size())) return {};
      return std::string(things.sentences[static_cast<std::size_t>(index)]);
    }
  for (const Threshold& t : kThresholds)
    if (t.feature == feature) return std::string(value < t.value ? t.below : t.above);
  if (feature == "tag_year") return fmt::format("the map says that it was built in {:.0f}", value);
  if (feature == "setback")
    return value < kSetback ? "its front stands in line with its neighbours'"
                            : fmt::format("its front stands {} m behind the line of the street", rounded(value));
  for (const Sentence& s : kSentences) {
    if (s.feature != feature) continue;
    const std::string number = rounded(s.share ? std::round(100 * value) : value);
    if (number == "0" && !s.none.empty()) return std::string(s.none);
    if (number == "1" && !s.share && !s.one.empty()) return std::string(s.one);
    return fmt::format(fmt::runtime(s.text), number);
  }
  // Of a newer build: what it means, without what its numbers stand for.
  return fmt::format("{}: {}{}{}", meaning.substr(0, meaning.find(": ")), rounded(value), unit.empty() ? "" : " ",
                     unit == "m2" ? "m²" : unit);
}

std::vector<std::string> strongest_reasons(const Json& style, std::size_t most) {
  const std::string own = style.value("class", ""), second = style.value("second", "");
  std::vector<std::pair<double, const Json*>> terms;
  for (const Json& term : style.at("terms")) {
    const double weight = term.at("weights").value(own, 0.0) - term.at("weights").value(second, 0.0);
    if (weight >= kLeastWeight && term.contains("value")) terms.emplace_back(weight, &term);
  }
  std::stable_sort(terms.begin(), terms.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> out;
  int around = 0;
  // What says little to a reader, behind what says more.
  std::stable_partition(terms.begin(), terms.end(),
                        [](const auto& t) { return !holds_little(t.second->value("feature", "")); });
  for (const auto& [weight, term] : terms) {
    const std::string feature = term->value("feature", "");
    if (out.size() >= most) break;
    if (is_around(feature) && around >= kMostAround) continue;
    std::string sentence =
        reason_sentence(feature, term->value("meaning", ""), term->value("unit", ""), term->at("value").get<double>());
    if (sentence.empty()) continue;
    around += is_around(feature);
    out.push_back(std::move(sentence));
  }
  return out;
}

}  // namespace blockrand::outputs
