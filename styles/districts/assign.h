// Which preset a building gets, with which parameters, and why.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/sourced.h"
#include "styles/districts/rule_set.h"

namespace blockrand::districts {

/// Everything that predicates may ask about a building. Texts and pointers must outlive the call; the functions are
/// asked only where a rule needs them. Empty functions answer nothing.
struct Subject {
  model::OsmId id;
  model::Location place;                        ///< middle of its mapped box
  const model::BuildingStyle* style = nullptr;  ///< null: every class and era is as likely as any other
  std::string_view substyle;                    ///< id in the catalogue; empty: none. `style` has its probability
  std::string_view use;                         ///< value of building=*
  double area = 0;                              ///< m²
  std::optional<double> front;                  ///< m, width of the main front; empty: none on a street
  model::BuildingPosition position = model::BuildingPosition::unknown;
  std::string_view block;             ///< id of its block; empty: none
  std::string_view overridden_style;  ///< class or sub-style that an override gives
  std::function<std::optional<double>()> storeys;
  std::function<std::optional<double>(CellStatistic)> cell;
  std::function<std::string_view(std::string_view)> tag;  ///< of the building; empty: absent
  std::function<bool(std::uint32_t)> holds;               ///< RuleSet::queries[i], at the building
  /// A tag of the smallest landuse=* or place=* polygon around the building that carries it, and that polygon.
  struct AreaTag {
    std::string_view value;
    model::OsmId area;
  };
  std::function<std::optional<AreaTag>(std::string_view)> area_tag;
};

/// The answer in short: what a map or a table of counts needs. Sets and rules are indices into the book.
struct Decision {
  std::uint32_t set = RuleSets::kNoSet;
  std::uint32_t preset = kNone;  ///< into RuleSets::presets
  std::uint32_t rule = kNone;    ///< into RuleSet::rules; kNone where a tag decided or nothing did
  model::Source source = model::Source::default_;
  float confidence = 0;
  static constexpr std::uint32_t kNone = 0xffffffff;
  friend bool operator==(const Decision&, const Decision&) = default;
};

/// A parameter and the rule it comes from.
struct Parameter {
  std::string key, value;
  std::uint32_t rule = 0;
  friend bool operator==(const Parameter&, const Parameter&) = default;
};

/// The answer in full.
struct Assignment {
  Decision decision;
  std::vector<Parameter> parameters;               ///< by key
  std::vector<std::uint32_t> fired;                ///< rules whose conditions hold, strongest first
  std::string why;                                 ///< a sentence
  std::vector<model::Candidate> other_candidates;  ///< weaker presets, strongest first
  std::vector<std::string> unreadable;             ///< blockrand:* tags with values that nobody knows
};

/// Strongest first: `blockrand:preset` on the building, then on the area around it, then the rules of the set. Rules
/// inherit City -> district -> block -> building: the preset is that of the first rule in the order of strength that
/// fires and has one; each parameter that of the first that sets it. `blockrand:style` replaces what classification
/// says before rules are asked. A preset is drawn by (seed, building, "preset"), of rules of the level `block` by
/// (seed, block, "preset"). Confidence: the probability of the class, of the sub-style among those of its class and of
/// the eras that the rule asked for, times the weight of what was drawn, times a factor of the level.
Decision decide(const RuleSets& book, std::uint32_t set, const Subject& subject, std::uint64_t seed);
/// \returns what decide() does as `decision`
Assignment assign(const RuleSets& book, std::uint32_t set, const Subject& subject, std::uint64_t seed);

}  // namespace blockrand::districts
