// The questions that classification answers, and the tables it answers them from.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/model/roof_shape.h"
#include "pipeline/model/style.h"
#include "styles/classify/catalogue.h"
#include "styles/classify/evidence_model.h"
#include "styles/classify/ground_floor.h"
#include "styles/classify/non_houses.h"
#include "styles/classify/tag_features.h"
#include "styles/classify/votes.h"

namespace blockrand::classify {

/// How much a building's style follows that of its neighbours, in log-odds per doubt: what neighbours are thought to be
/// is an opinion, so its weight is below 1. Each round reaches kNearReach further.
struct Smoothing {
  int rounds = 3;
  double row = 0.5;    ///< houses with a common wall that stand alike, by the length of the wall
  double block = 0.4;  ///< houses of the same block within kNearReach that stand alike
  /// Of the log-odds that are left in the end: neighbours say again what features of the quarter have said, so the sum
  /// is surer than it is right. Chosen by the reliability table of all places.
  double certainty = 0.8;
  double doubt = 0.03;  ///< added to each probability: nobody is ever certain
  double era = 0.3;     ///< how much the style has a say in the era: power of its probabilities
};

/// What the quarter of a house says of its era.
struct QuarterSay {
  double say = 0;  ///< power of what it says; 0: nothing
  std::array<std::array<double, model::kEraCount>, model::kMorphologyCount> eras{};  ///< shares by morphology
};

/// Log-odds of the eras by what the morphology of the quarter may be: `say` times the log of the eras' expected shares over those of the
/// data of the fit.
PerAnswer era_of_quarter(const QuarterSay& quarter, std::span<const float> morphology, const EvidenceModel& era);

/// What may be assumed of a region before a building is looked at, by its district rules (`[prior]`).
struct RegionPrior {
  std::optional<std::array<double, model::kStyleClassCount>> style;  ///< probabilities
  std::optional<std::array<double, model::kEraCount>> era;
  std::vector<double> substyle;  ///< weight per index of the catalogue, 1 where nothing is said; empty: nothing is said
  /// Usual storeys of gruenderzeit, tenement, modern and, of modern and other ones by their quarter, old_town, slab,
  /// detached, terrace; 0: nothing is said.
  std::array<double, 7> storeys{};
};

/// Of a sub-style that a region names with a share of 1, against one that it does not name.
inline constexpr double kNamedSubstyle = 12;

/// The files below `<configs>/styles/` that Tables::read reads.
inline constexpr std::array kTableFiles = {
    "catalogue.toml",   "ground_floor.toml",       "neighbours.toml",   "non_houses.toml",      "tags.toml",
    "weights/era.toml", "weights/morphology.toml", "weights/roof.toml", "weights/storeys.toml", "weights/style.toml"};

/// All tables, read once.
struct Tables {
  Catalogue catalogue{{}};
  NonHouseRules non_houses;
  GroundFloorRules ground_floor;
  TagTables tags;
  EvidenceModel style, era, morphology, storeys, roof;
  VoteKernel storeys_votes, roof_votes, era_votes;
  Smoothing smoothing;
  QuarterSay quarter;
  std::vector<int> use_of_style;      ///< per index of the catalogue: bits of the kinds of use it is built for; 0: any
  std::vector<bool> attached;         ///< per index of the catalogue: stands in rows and pairs only
  std::vector<double> storey_counts;  ///< of the answers of `storeys`, ascending; the last stands for more, too
  /// Reads `<configs>/styles/`. \throws base::InputError with file, line and column
  static Tables read(const std::string& configs);
  /// All but what is fitted: the models have no answers.
  static Tables read_without_weights(const std::string& configs);
};

/// Whether any question asks for a feature of the group (FeatureInfo::group).
bool any_asks(const Tables& tables, std::string_view group);

/// The answer of `storeys` that a count belongs to.
std::size_t storey_answer(const Tables& tables, double storeys);

RoofFamily family_of(model::RoofShape shape);

/// Log-odds that a region's usual shares add to a model's: log(share / share in the data of the fit); 0 where they sum
/// to 0.
PerAnswer prior_log_odds(std::span<const double> probabilities, const EvidenceModel& model);

/// What a region's usual storeys add to the question of storeys, given what the building is thought to be.
PerAnswer storeys_prior(const Tables& tables, const RegionPrior& region, const model::BuildingStyle& style);

/// Era from tagged years: log of what the range leaves to each era, with (1 - confidence) shared by all. Years of which
/// a tenth lies in another era leave it a tenth.
PerAnswer era_of_years(model::YearRange years, double confidence);

/// Whether a house of that class can be of that era: Gründerzeit and tenements are of 1840 to 1918, what is modern is
/// younger by definition (model::StyleClass).
constexpr bool agree(model::StyleClass c, model::Era era) {
  switch (c) {
    case model::StyleClass::gruenderzeit:
    case model::StyleClass::tenement:
      return era == model::Era::from1840;
    case model::StyleClass::modern:
      return era == model::Era::from1919 || era == model::Era::post1945;
    case model::StyleClass::other:
      return true;
  }
  return true;
}

/// Makes era and class one decision: the era has the last word, the class says `weight` of its log-odds to it; then the
/// classes that exclude the era share what is left to them by being wrong about it.
/// \param usual  shares of the classes where the model learnt them: an era that three classes can be of is not likelier for that alone
///               (what a class says is its probability over its usual share); all 0: not known
void reconcile(model::BuildingStyle& style, double weight, const PerAnswer& usual = {});

/// The years of an era; of the first one from 1500, of the last one to 2030.
model::YearRange years_of(model::Era era);

/// Probability of having been built before a year, by those of the eras.
double share_before(const PerAnswer& eras, int year);

/// Whether some of a style's years lie in the era.
bool occurs_in(model::YearRange years, model::Era era);

/// The likeliest of a class's sub-styles: weight of the region x how well years, position, quarter, storeys and roof
/// fit.
struct Substyle {
  std::uint8_t index = 0;
  double p = 0;  ///< among the sub-styles of all classes, by the probabilities of their classes
};
/// What sub-styles are held against.
struct SubstyleFacts {
  const model::BuildingStyle& style;  ///< class, era and morphology probabilities
  model::BuildingPosition position = model::BuildingPosition::unknown;
  double storeys = 0;                         ///< 0: unknown
  std::optional<model::RoofShape> roof = {};  ///< as tagged
  double year = 0;                            ///< 0: unknown
  double year_says = 1;                       ///< of what a tagged year would say
  double area = 0;                            ///< m²; 0: unknown
  int neighbours = -1;                        ///< houses that touch it; -1: unknown
  int use = 0;                                ///< Feature::tag_use
};
/// The best few, the likeliest first.
std::vector<Substyle> substyles(const Tables& tables, const RegionPrior* region, const SubstyleFacts& facts,
                                std::size_t most);

/// A count of storeys from probabilities: the one with the most probability on it and, at kBeside of their weight, on
/// the counts beside it, so that a house between two answers gets neither extreme. Index of an answer.
std::size_t choose_storeys(const PerAnswer& p, std::size_t n);

}  // namespace blockrand::classify
