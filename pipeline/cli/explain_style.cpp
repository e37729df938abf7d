#include "pipeline/cli/explain_style.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <vector>

#include "pipeline/cli/terminal_text.h"

namespace blockrand::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kFew = 6;             // terms that a reader takes in at a glance
constexpr double kSeenProbability = 0.005;  // less rounds to 0 %
constexpr double kSeenWeight = 0.005;       // likewise of weights with two decimals

std::string in_words(std::string_view style_class) {
  if (style_class == "gruenderzeit") return "Gr\u00fcnderzeit house";
  if (style_class == "tenement") return "Tenement";
  if (style_class == "modern") return "Modern building";
  return "Other building";
}

std::string_view meaning_of(std::string_view style_class) {
  if (style_class == "gruenderzeit") return "a street-side house of 1840 to 1918 with a composed front";
  if (style_class == "tenement")
    return "mass housing of 1840 to 1918 without a composed front: wings, rear buildings, workers' houses";
  if (style_class == "modern") return "designed after 1918";
  return "church, shed, garage, house from before 1840 and the like";
}

/// Features whose numbers stand for things, with what they are about.
struct Names {
  std::string_view feature, about;
  int first = 0;  ///< the number of the first name
  std::vector<std::string_view> names;
};
const Names* names_of(std::string_view feature) {
  static const std::vector<Names> all = {
      {"position",
       "how it stands",
       1,
       {"free standing", "end of a row", "within a row", "corner house", "rear building", "wing"}},
      {"street_class",
       "class of its street",
       1,
       {"motorway", "trunk road", "primary road", "secondary road", "tertiary road", "residential", "living street",
        "pedestrian"}},
      {"tag_roof",
       "roof, as tagged",
       1,
       {"flat", "gabled", "hipped", "mansard", "saltbox", "lean-to", "pyramid", "other"}},
      {"tag_use",
       "use, as tagged",
       0,
       {"untold", "flats", "residential", "house", "detached or terraced", "outbuilding", "offices", "shop", "industry",
        "church", "public", "hotel", "other"}},
      {"tag_heritage", "listed or historic, as tagged", 0, {"no", "known by an article or its architect", "yes"}},
      {"tag_shop", "a shop, office or amenity is tagged", 0, {"no", "yes"}},
      {"tag_number", "house number, as tagged", 0, {"without", "with"}},
  };
  const auto found = std::find_if(all.begin(), all.end(), [&](const Names& n) { return n.feature == feature; });
  return found == all.end() ? nullptr : &*found;
}

/// What a term is about: "how it stands" instead of the list of what its numbers mean.
std::string about(const Json& term) {
  if (const Names* names = names_of(term.value("feature", ""))) return std::string(names->about);
  return term.value("meaning", "");
}
/// The same within a sentence: without what follows a colon.
std::string about_shortly(const Json& term) {
  const std::string text = about(term);
  return text.substr(0, text.find(": "));
}

std::string term_value(const Json& term, double value) {
  return value_in_words(term.value("feature", ""), term.value("unit", ""), term.value("meaning", ""), value);
}

/// "below 1.2", "1.2 to 1.5", "30 m and more"; for what numbers stand for, the things.
std::string bin_text(const Json& term) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double low = term.value("low", -kInfinity), high = term.value("high", kInfinity);
  if (const Names* names = names_of(term.value("feature", ""))) {
    std::vector<std::string_view> inside;
    for (std::size_t i = 0; i < names->names.size(); ++i)
      if (const double n = names->first + static_cast<double>(i); n >= low && n < high)
        inside.push_back(names->names[i]);
    return fmt::format("{}", fmt::join(inside, " or "));
  }
  if (std::isinf(low) && std::isinf(high)) return "any";
  // Counts are cut between whole numbers: "2 to 4" of [1.5, 4.5).
  const auto between = [](double edge) { return std::isinf(edge) || edge - std::floor(edge) == 0.5; };
  if (term.value("unit", "").empty() && between(low) && between(high)) {
    if (std::isinf(low)) return fmt::format("at most {:.0f}", std::floor(high));
    if (std::isinf(high)) return fmt::format("{:.0f} and more", std::ceil(low));
    return high - low == 1 ? fmt::format("{:.0f}", std::ceil(low))
                           : fmt::format("{:.0f} to {:.0f}", std::ceil(low), std::floor(high));
  }
  if (std::isinf(low)) return "below " + term_value(term, high);
  if (std::isinf(high)) return term_value(term, low) + " and more";
  return term_value(term, low) + " to " + term_value(term, high);
}

std::string percent(double p) {
  if (p > 0 && p < kSeenProbability) return "< 1 %";
  if (p < 1 && p > 1 - kSeenProbability) return "> 99 %";
  return fmt::format("{:.0f} %", 100 * p);
}

/// Answers with more than nothing, the likeliest first.
std::vector<std::pair<std::string, double>> ranked(const Json& probabilities) {
  std::vector<std::pair<std::string, double>> out;
  for (const auto& [answer, p] : probabilities.items()) out.emplace_back(answer, p.get<double>());
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return out;
}

/// "modern (11 %), tenement (5 %)": those that round to something, all but the first `skip`.
template <class Name>
std::string list_of(const std::vector<std::pair<std::string, double>>& answers, std::size_t skip, Name name) {
  std::string text;
  for (std::size_t i = skip; i < answers.size(); ++i)
    if (answers[i].second >= kSeenProbability || i == 0)
      text +=
          (text.empty() ? "" : ", ") + std::string(name(answers[i].first)) + " (" + percent(answers[i].second) + ")";
  return text;
}

std::string spaced(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// What the weights of one term say for `own` against `second`.
double difference(const Json& weights, const std::string& own, const std::string& second) {
  return weights.value(own, 0.0) - weights.value(second, 0.0);
}

std::string weight_text(double weight) {
  return fmt::format("{:+.2f}", std::fabs(weight) < kSeenWeight ? 0.0 : weight);
}

/// "12 times as likely", of log-odds.
std::string odds_text(double log_odds) {
  const double odds = std::exp(std::fabs(log_odds));
  if (odds > 1000) return "more than 1000 times as likely";
  return fmt::format("{} times as likely", odds < 9.95 ? fmt::format("{:.1f}", odds) : fmt::format("{:.0f}", odds));
}

constexpr std::size_t kValueColumn = 11, kMeaningColumn = 28;

std::string weight_row(double weight, const std::string& value, const std::string& meaning) {
  std::string line = fmt::format("  {:>7}", weight_text(weight));
  line.resize(kValueColumn, ' ');
  line += value;
  // A multi-byte character takes one column.
  const auto extra =
      static_cast<std::size_t>(std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) == 0x80; }));
  line.resize(std::max(line.size() + 1, kMeaningColumn + extra), ' ');
  return line + wrapped(meaning, kMeaningColumn) + "\n";
}

/// Each term as weight, value, meaning; what all else adds; the sum.
std::string weights_text(const Json& style, const std::string& own, const std::string& second, bool all) {
  std::vector<std::pair<double, const Json*>> terms;
  for (const Json& term : style.at("terms")) terms.emplace_back(difference(term.at("weights"), own, second), &term);
  std::stable_sort(terms.begin(), terms.end(),
                   [](const auto& a, const auto& b) { return std::fabs(a.first) > std::fabs(b.first); });
  std::string text =
      "\n  " +
      wrapped(fmt::format("What speaks for {} and against {}, the next likely answer. Weights add up: +0.69 doubles "
                          "the odds, +2.3 makes them ten times as good; what has a minus speaks for {}.",
                          own, second, second),
              2) +
      "\n";
  const std::size_t shown = all ? terms.size() : std::min(terms.size(), kFew);
  double sum = 0, rest = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const auto& [weight, term] = terms[i];
    sum += weight;
    if (i < shown)
      text += weight_row(weight, term->contains("value") ? term_value(*term, term->at("value").get<double>()) : "",
                         about(*term));
    else
      rest += weight;
  }
  if (shown < terms.size())
    text += weight_row(rest, "", fmt::format("{} lighter ones together (--style lists them)", terms.size() - shown));
  const double prior = difference(style.at("prior"), own, second),
               elsewhere = difference(style.at("elsewhere"), own, second);
  if (std::fabs(prior) >= kSeenWeight)
    text += weight_row(prior, "", "how frequent both are before anything is known of it");
  text += weight_row(elsewhere, "", "what is usual in the region, its row, its block and its era");
  sum += prior + elsewhere;
  return text + weight_row(sum, "",
                           fmt::format("together: {} is {} as {}", sum < 0 ? second : own, odds_text(sum),
                                       sum < 0 ? own : second));
}

std::string changes_text(const Json& changes, const std::string& second, bool all) {
  if (changes.empty()) return "\n  " + wrapped("No single thing about it would make it " + second + ".", 2) + "\n";
  std::string text = "\n  It would be " + second + " if\n";
  const std::size_t shown = all ? changes.size() : std::min(changes.size(), kFew);
  for (std::size_t i = 0; i < shown; ++i) {
    const Json& c = changes[i];
    const std::string is = c.contains("value") ? " (is " + term_value(c, c.at("value").get<double>()) + ")" : "";
    text +=
        "    " + wrapped(fmt::format("{}{}: {}{}", i > 0 ? "or " : "", about_shortly(c), bin_text(c), is), 6) + "\n";
  }
  if (shown < changes.size())
    text += fmt::format("    or one of {} more (--style lists them)\n", changes.size() - shown);
  return text;
}

}  // namespace

std::string era_in_words(std::string_view era) {
  if (era == "pre1840") return "before 1840";
  if (era == "1840_1918") return "1840 to 1918";
  if (era == "1919_1945") return "1919 to 1945";
  if (era == "post1945") return "after 1945";
  return std::string(era);
}

std::string value_in_words(std::string_view feature, std::string_view unit, std::string_view meaning, double value) {
  if (const Names* names = names_of(feature)) {
    const double index = std::round(value) - names->first;
    if (index >= 0 && index < static_cast<double>(names->names.size()))
      return std::string(names->names[static_cast<std::size_t>(index)]);
  }
  const bool share = unit.empty() && (meaning.find("share ") != std::string_view::npos || meaning.ends_with("share"));
  if (share) value *= 100;
  const double size = std::fabs(value);
  std::string text = fmt::format("{:.{}f}", value, size >= 99.5 || share ? 0 : size >= 9.95 ? 1 : 2);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  if (text == "-0") text = "0";
  if (share) return text + " %";
  if (unit == "degree") return text + "\u00b0";
  if (unit == "m2") return text + " m\u00b2";
  if (unit == "1/ha") return text + " per ha";
  return unit.empty() ? text : text + " " + std::string(unit);
}

std::string style_text(const Json& style, bool all) {
  const auto classes = ranked(style.at("probabilities")), eras = ranked(style.at("era")),
             quarters = ranked(style.at("morphology"));
  if (classes.size() < 2 || eras.empty() || quarters.empty()) return {};
  const std::string own = style.at("class").get<std::string>();
  std::string second = style.value("second", "");
  if (second == own || second.empty()) second = classes[0].first == own ? classes[1].first : classes[0].first;
  const std::string rule = style.value("rule", "");

  std::string sentence = fmt::format("{} ({})", in_words(own), percent(style.at("probabilities").value(own, 0.0)));
  if (style.contains("substyle"))
    sentence += fmt::format(", sub-style {} ({})", style["substyle"].get<std::string>(),
                            percent(style.value("substyle_p", 0.0)));
  sentence += ": " + std::string(meaning_of(own)) + ".";
  if (const std::string others = list_of(classes, 1, [](const std::string& name) { return name; }); !others.empty())
    sentence += " Or else: " + others + ".";
  std::string text = "\nIts style, and why\n  " + wrapped(sentence, 2) + "\n";
  std::string era = "Era: " + list_of(eras, 0, [](const std::string& name) { return era_in_words(name); });
  if (style.contains("years"))
    era += style["years"][0] == style["years"][1]
               ? fmt::format("; tagged {}", style["years"][0].get<int>())
               : fmt::format("; tagged {} to {}", style["years"][0].get<int>(), style["years"][1].get<int>());
  text += "  " + wrapped(era + ".", 2) + "\n";
  text +=
      "  " +
      wrapped("Its quarter: " + list_of(quarters, 0, [](const std::string& name) { return spaced(name); }) + ".", 2) +
      "\n";
  if (!rule.empty()) {
    text +=
        "\n  " +
        wrapped("A stated rule says that it is no house (" + rule + "); it outweighs what follows from its shape.", 2) +
        "\n";
    if (!all) return text;
  }
  if (style.at("terms").empty()) return text;
  text += weights_text(style, own, second, all);
  // A rule is not outweighed by a change of one feature.
  return rule.empty() ? text + changes_text(style.at("changes"), second, all) : text;
}

}  // namespace blockrand::cli
