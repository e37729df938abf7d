// What district rules make of an extract, without building it: which rule fires where, and what another set would
// change.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/attributes/assign_extract.h"
#include "pipeline/attributes/rule_sets.h"
#include "pipeline/base/progress.h"
#include "pipeline/base/publish.h"
#include "pipeline/run/build.h"
#include "pipeline/run/prepare_extract.h"

namespace blockrand::run {

/// An extract up to the point where rules are asked. Things refer to each other: it stays where it is made.
struct DistrictSurvey {
  LocatedExtract located;
  std::optional<PreparedExtract> prepared;
  attributes::Defaults defaults;
  attributes::Overrides overrides;
  std::optional<context::TaggedNeighbours> neighbours;
  std::vector<model::BuildingPosition> positions;
  std::uint64_t seed = 1;
  int neighbour_minimum = 3;
  classify::Tables tables;

  /// \param styles  what classification says by the priors of the book that will be asked
  attributes::AssignInputs inputs(const evidence::StyleExtract& styles) const;
  /// Buildings that stand for themselves, by number, in the order of their ids.
  std::vector<std::uint32_t> buildings() const;
};

/// Reads, repairs, finds the context, classifies, and finds where in its block each building stands.
/// \param options  input, configs, CRS, overrides, bbox, jobs, seed and tuning of a build
std::unique_ptr<DistrictSurvey> survey_districts(const BuildOptions& options, const attributes::ReadRuleSets& rules,
                                                 base::Progress& progress);

/// How often something was chosen.
struct DistrictCount {
  std::string set, rule, preset;  ///< rule: empty for tags
  std::uint64_t buildings = 0;
};

struct DistrictView {
  std::vector<DistrictCount> counts;  ///< by set, in the order of the rules' strength, then preset
  std::vector<std::string>
      silent_rules;  ///< "berlin: stripped fronts": of the sets that were chosen, those that never fire
  std::vector<std::string> idle_rules;  ///< likewise, those that fire and name presets, but stronger ones always choose
  std::vector<std::string> unanswered;  ///< DistrictAssigner::unanswered
  std::uint64_t buildings = 0, without = 0;
};

/// Writes districts.gpkg, districts.json and map.png into `folder`.
/// \param by_rule  the map is coloured by rule instead of preset
DistrictView show_districts(const DistrictSurvey& survey, const districts::RuleSets& book, bool by_rule,
                            base::StagedFolder& folder, int workers, base::Progress& progress);

/// A building that two rule books treat differently. Parameters are written "key=value, key=value".
struct DistrictChange {
  model::OsmId id;
  std::string preset_a, preset_b, rule_a, rule_b, parameters_a, parameters_b;
};
/// Each book is asked after a classification by its own priors, so that the difference is that of two calls of
/// show_districts. \param a  the book of the survey
std::vector<DistrictChange> diff_districts(const DistrictSurvey& survey, const districts::RuleSets& a,
                                           const districts::RuleSets& b, int workers, base::Progress& progress);

}  // namespace blockrand::run
