#include "styles/classify/classify.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "pipeline/base/error.h"
#include "pipeline/base/portable_math.h"
#include "pipeline/base/toml_file.h"

namespace blockrand::classify {

namespace {

using model::BuildingStyle;
using model::Morphology;
using model::StyleClass;

constexpr double kBeside = 0.8;        ///< weight of the counts beside one: a storey off is seen by nobody, two are
constexpr double kStoreysPull = 0.35;  ///< log-odds per storey away from what is usual in the region
constexpr double kRare = 1e-3;         ///< share of what a prior calls impossible
constexpr double kYearFits = 3.0;     ///< log-odds of a tagged year inside a sub-style's years; per era it is the era's
constexpr double kWrongPlace = 0.02;  ///< a front style on a rear building, and the other way round
constexpr double kWrongQuarter = 0.25;          ///< a style outside the morphologies where it occurs
constexpr double kOtherUse = 0.1, kOwnUse = 4;  ///< a style built for another use, for this one
constexpr int kOutbuildingUse = 5;              ///< value of Feature::tag_use
constexpr double kSmallestHouse =
    60;  ///< m². What is larger, and no non-house by rule, is no garage or shed (docs/style_measures.md 1.1)
constexpr double kStoreyMisfit = 0.5;  ///< per storey beyond a style's range

VoteKernel read_votes(base::TomlTable& file, const char* name) {
  auto table = file.table(name);
  return table ? VoteKernel::read(*table) : VoteKernel{};
}

/// Years of the four eras; open ends count from 1500 and to 2030.
constexpr int kFrom[] = {1500, 1840, 1919, 1946}, kTo[] = {1839, 1918, 1945, 2030};

/// Of a style's years that lie in one era.
double share_in(model::YearRange years, int era) {
  const int first = std::max<int>(years.from, kFrom[0]), last = std::min<int>(years.to, kTo[3]);
  const int from = std::max(first, kFrom[era]), to = std::min(last, kTo[era]);
  return to < from ? 0.0 : static_cast<double>(to - from + 1) / static_cast<double>(last - first + 1);
}

}  // namespace

Tables Tables::read_without_weights(const std::string& configs) {
  const std::string folder = configs + "/styles/";
  Tables t;
  t.catalogue = read_catalogue(configs);
  t.non_houses = read_non_houses(configs, t.catalogue);
  t.ground_floor = read_ground_floor(configs);
  t.tags = TagTables::read(folder + "tags.toml");
  t.use_of_style.assign(t.catalogue.size(), 0);
  for (const auto& [use, ids] : t.tags.styles_of_use)
    for (const std::string& id : ids) {
      const auto index = t.catalogue.index(id);
      if (!index)
        throw base::InputError(folder + "tags.toml", "styles_of_use", "there is no style `" + id + "`",
                               "Name styles of catalogue.toml");
      t.use_of_style[*index] |= 1 << use;
    }
  t.attached.assign(t.catalogue.size(), false);
  for (const std::string& id : t.tags.attached) {
    const auto index = t.catalogue.index(id);
    if (!index)
      throw base::InputError(folder + "tags.toml", "attached", "there is no style `" + id + "`",
                             "Name styles of catalogue.toml");
    t.attached[*index] = true;
  }
  return t;
}

Tables Tables::read(const std::string& configs) {
  const std::string folder = configs + "/styles/";
  Tables t = read_without_weights(configs);
  t.style = EvidenceModel::read(folder + "weights/style.toml", model::kStyleClassNames);
  t.era = EvidenceModel::read(folder + "weights/era.toml", model::kEraNames);
  t.morphology = EvidenceModel::read(folder + "weights/morphology.toml", model::kMorphologyNames);
  t.storeys = EvidenceModel::read(folder + "weights/storeys.toml");
  t.roof = EvidenceModel::read(folder + "weights/roof.toml", kRoofFamilyNames);
  for (const std::string& answer : t.storeys.answers()) {
    const double n = std::strtod(answer.c_str(), nullptr);
    if (n <= (t.storey_counts.empty() ? 0.0 : t.storey_counts.back()))
      throw base::InputError(folder + "weights/storeys.toml", "answers",
                             "`" + answer + "` is no count above the one before",
                             "Answers are counts of storeys, ascending");
    t.storey_counts.push_back(n);
  }
  base::TomlTable file = base::TomlTable::read(folder + "neighbours.toml");
  t.storeys_votes = read_votes(file, "storeys");
  t.roof_votes = read_votes(file, "roof");
  t.era_votes = read_votes(file, "era");
  if (auto s = file.table("style")) {
    t.smoothing.rounds = static_cast<int>(s->integer("rounds", 0, 5).value_or(t.smoothing.rounds));
    t.smoothing.row = s->number("row", 0, 2).value_or(t.smoothing.row);
    t.smoothing.block = s->number("block", 0, 2).value_or(t.smoothing.block);
    t.smoothing.certainty = s->number("certainty", 0.1, 1).value_or(t.smoothing.certainty);
    t.smoothing.doubt = s->number("doubt", 1e-4, 1).value_or(t.smoothing.doubt);
    t.smoothing.era = s->number("era", 0, 2).value_or(t.smoothing.era);
    s->finish();
  }
  if (auto q = file.table("quarter")) {
    t.quarter.say = q->number("say", 0, 2).value_or(t.quarter.say);
    for (std::size_t m = 0; m < model::kMorphologyNames.size(); ++m) {
      const auto shares = q->numbers(model::kMorphologyNames[m]);
      double sum = 0;
      for (const double share : shares.value_or(std::vector<double>{})) sum += share >= 0 ? share : 2;
      if (!shares || shares->size() != model::kEraCount || std::fabs(sum - 1) > 0.01)
        throw base::InputError(folder + "neighbours.toml", "quarter." + std::string(model::kMorphologyNames[m]),
                               "shares of the four eras are missing, or their sum is not 1",
                               "Write [pre1840, 1840_1918, 1919_1945, post1945], for example [0.1, 0.4, 0.2, 0.3]");
      std::ranges::copy(*shares, t.quarter.eras[m].begin());
    }
    q->finish();
  }
  file.finish();
  return t;
}

PerAnswer era_of_quarter(const QuarterSay& quarter, std::span<const float> morphology, const EvidenceModel& era) {
  PerAnswer out{};
  if (quarter.say <= 0) return out;
  constexpr double kLeast = 1e-3;
  std::array<double, model::kEraCount> shares{};
  double all = 0;
  for (std::size_t m = 0; m < morphology.size(); ++m)
    for (std::size_t e = 0; e < shares.size(); ++e) {
      const double share = static_cast<double>(morphology[m]) * quarter.eras[m][e];
      shares[e] += share, all += share;
    }
  if (all <= 0) return out;
  for (std::size_t e = 0; e < shares.size(); ++e) {
    const double usual = era.base()[e] > 0 ? era.base()[e] : 1.0 / model::kEraCount;
    out[e] = round_log_odds(quarter.say * base::log(std::max(shares[e], kLeast) / usual));
  }
  return out;
}

bool any_asks(const Tables& tables, std::string_view group) {
  for (const EvidenceModel* model : {&tables.style, &tables.era, &tables.morphology, &tables.storeys, &tables.roof})
    for (std::size_t f = 0; f < kFeatureCount; ++f)
      if (kFeatures[f].group == group && model->asks(f)) return true;
  return false;
}

std::size_t storey_answer(const Tables& tables, double storeys) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < tables.storey_counts.size(); ++i)
    if (std::fabs(tables.storey_counts[i] - storeys) < std::fabs(tables.storey_counts[best] - storeys)) best = i;
  return best;
}

RoofFamily family_of(model::RoofShape shape) {
  using enum model::RoofGroup;
  switch (model::traits(shape).group) {
    case flat:
      return RoofFamily::flat;
    case gabled:
      return RoofFamily::gabled;
    case hipped:
    case pyramidal:
      return RoofFamily::hipped;
    case mansard:
      return RoofFamily::mansard;
    case cross_gabled:
    case saltbox:
    case shed:
    case folded:
    case round:
    case other:
      break;
  }
  return RoofFamily::other;
}

PerAnswer prior_log_odds(std::span<const double> p, const EvidenceModel& model) {
  PerAnswer out{};
  double sum = 0;
  for (const double v : p) sum += v;
  if (sum <= 0) return out;
  for (std::size_t i = 0; i < p.size(); ++i)
    out[i] = round_log_odds(base::log(std::max(p[i] / sum, kRare) / model.base()[i]));
  return out;
}

PerAnswer storeys_prior(const Tables& tables, const RegionPrior& region, const BuildingStyle& style) {
  // Shares of what the region knows by name: fronts, rear buildings, and the rest by its quarter.
  std::array<double, 7> share{};
  share[0] = static_cast<double>(style.style[0]);
  share[1] = static_cast<double>(style.style[1]);
  const double rest = static_cast<double>(style.style[2]) + static_cast<double>(style.style[3]);
  static constexpr std::array<std::size_t, model::kMorphologyCount> kOfQuarter = {2, 3, 4, 5, 6};
  for (std::size_t m = 0; m < kOfQuarter.size(); ++m)
    share[kOfQuarter[m]] += rest * static_cast<double>(style.morphology[m]);
  PerAnswer out{};
  double known = 0;
  for (std::size_t s = 0; s < share.size(); ++s)
    if (region.storeys[s] > 0) known += share[s];
  if (known <= 0) return out;
  for (std::size_t a = 0; a < tables.storey_counts.size(); ++a) {
    double sum = 1 - std::min(known, 1.0);
    for (std::size_t s = 0; s < share.size(); ++s)
      if (region.storeys[s] > 0)
        sum += share[s] * base::exp(-kStoreysPull * std::fabs(tables.storey_counts[a] - region.storeys[s]));
    out[a] = round_log_odds(base::log(std::max(sum, kRare)));
  }
  return out;
}

PerAnswer era_of_years(model::YearRange years, double confidence) {
  // What the date leaves to each era, and a share for dates that are wrong.
  const double c = std::clamp(confidence, 0.3, 0.99);
  static constexpr int kFrom[] = {500, 1840, 1919, 1946}, kTo[] = {1839, 1918, 1945, 2100};
  PerAnswer out{};
  for (std::size_t e = 0; e < static_cast<std::size_t>(model::kEraCount); ++e) {
    const int from = std::max<int>(years.from, kFrom[e]), to = std::min<int>(years.to, kTo[e]);
    const double share =
        to < from ? 0.0 : static_cast<double>(to - from + 1) / static_cast<double>(years.to - years.from + 1);
    out[e] = round_log_odds(base::log(c * share + (1 - c) / model::kEraCount));
  }
  return out;
}

bool occurs_in(model::YearRange years, model::Era era) { return share_in(years, static_cast<int>(era)) > 0; }

model::YearRange years_of(model::Era era) {
  const auto e = static_cast<std::size_t>(era);
  return {static_cast<std::int16_t>(kFrom[e]), static_cast<std::int16_t>(kTo[e])};
}

double share_before(const PerAnswer& eras, int year) {
  double share = 0;
  for (std::size_t e = 0; e < model::kEraCount; ++e)
    share += eras[e] *
             std::clamp(static_cast<double>(year - kFrom[e]) / static_cast<double>(kTo[e] - kFrom[e] + 1), 0.0, 1.0);
  return share;
}

void reconcile(model::BuildingStyle& style, double weight, const PerAnswer& usual) {
  constexpr std::size_t kClasses = model::kStyleClassCount, kEras = model::kEraCount;
  constexpr double kLeast = 1e-4;    // nobody is that sure
  constexpr double kStep = 1 << 16;  // of probabilities, as in `probabilities`
  const auto can = [](std::size_t c, std::size_t e) {
    return agree(static_cast<StyleClass>(c), static_cast<model::Era>(e));
  };
  std::array<double, kClasses> own{};
  for (std::size_t c = 0; c < kClasses; ++c) own[c] = std::max(static_cast<double>(style.style[c]), kLeast);
  std::array<double, kEras> era{}, fits{};  // fits: what the classes that can be of an era have together
  double all = 0;
  for (std::size_t e = 0; e < kEras; ++e) {
    double usually = 0;
    for (std::size_t c = 0; c < kClasses; ++c)
      if (can(c, e)) fits[e] += own[c], usually += usual[c];
    const double says = fits[e] / (usually > 0 ? usually : 1);
    all += era[e] = std::max(static_cast<double>(style.era[e]), kLeast) * base::exp(weight * base::log(says));
  }
  std::array<double, kClasses> p{};
  for (std::size_t e = 0; e < kEras; ++e) {
    era[e] = std::floor(era[e] / all * kStep + 0.5) / kStep;
    style.era[e] = static_cast<float>(era[e]);
    for (std::size_t c = 0; c < kClasses; ++c)
      if (can(c, e)) p[c] += era[e] * own[c] / fits[e];
  }
  for (double& v : p) v = std::floor(v * kStep + 0.5) / kStep;
  // The likeliest class of the likeliest era: what is likelier over all eras gives it half of its lead.
  const std::size_t built = static_cast<std::size_t>(style.built());
  std::size_t best = static_cast<std::size_t>(StyleClass::other);
  for (std::size_t c = 0; c < kClasses; ++c)
    if (can(c, built) && own[c] > own[best]) best = c;
  for (std::size_t c = 0; c < kClasses; ++c)
    if (c != best && p[c] >= p[best]) {
      const double half = std::floor((p[c] + p[best]) / 2 * kStep);
      const double sum = p[c] + p[best];
      p[best] = half / kStep + 1 / kStep;
      p[c] = sum - p[best];
    }
  for (std::size_t c = 0; c < kClasses; ++c) style.style[c] = static_cast<float>(p[c]);
}

std::vector<Substyle> substyles(const Tables& tables, const RegionPrior* region, const SubstyleFacts& facts,
                                std::size_t most) {
  std::vector<Substyle> all;
  const BuildingStyle& style = facts.style;
  const Siting siting = siting_of(facts.position);
  for (std::size_t c = 0; c < static_cast<std::size_t>(model::kStyleClassCount); ++c) {
    const double share = static_cast<double>(style.style[c]);
    const std::size_t first = all.size();
    double sum = 0;
    for (const std::uint8_t index : tables.catalogue.of_class(static_cast<StyleClass>(c))) {
      const Style& s = tables.catalogue[index];
      double w = s.share * (region != nullptr && index < region->substyle.size() ? region->substyle[index] : 1);
      double era = 0;
      for (int e = 0; e < model::kEraCount; ++e)
        era += static_cast<double>(style.era[static_cast<std::size_t>(e)]) * share_in(s.years, e);
      w *= era + kRare;
      if (facts.year > 0)
        w *= base::exp(facts.year_says *
                       (facts.year >= s.years.from && facts.year <= s.years.to ? kYearFits : -kYearFits));
      if (tables.attached[index] && facts.neighbours == 0) w *= kWrongPlace;
      if (tables.use_of_style[index] == 1 << kOutbuildingUse && facts.area >= kSmallestHouse) w *= kRare;
      const bool behind = s.position == StylePosition::rear || s.position == StylePosition::wing;
      if (s.position == StylePosition::front && siting == Siting::behind) w *= kWrongPlace;
      if (behind && siting == Siting::front) w *= kWrongPlace;
      if (s.position == StylePosition::wing && facts.position != model::BuildingPosition::side_wing) w *= kWrongQuarter;
      if (s.position == StylePosition::rear && facts.position == model::BuildingPosition::side_wing) w *= kWrongQuarter;
      if (!s.morphologies.empty()) {
        double there = 0;
        for (const Morphology m : s.morphologies)
          there += static_cast<double>(style.morphology[static_cast<std::size_t>(m)]);
        w *= kWrongQuarter + (1 - kWrongQuarter) * there;
      }
      if (facts.storeys > 0) {
        const double beyond = std::max({s.storeys.min - facts.storeys, facts.storeys - s.storeys.max, 0.0});
        w *= base::exp(-kStoreyMisfit * beyond * 2 - 0.15 * std::fabs(facts.storeys - s.storeys.typ));
      }
      if (const int uses = tables.use_of_style[index]; facts.use != 0 && uses != 0)
        w *= (uses >> facts.use & 1) != 0 ? kOwnUse : kOtherUse;
      if (facts.roof) w *= 0.1 + s.roof[static_cast<std::size_t>(family_of(*facts.roof))];
      all.push_back({index, w});
      sum += w;
    }
    for (std::size_t i = first; i < all.size(); ++i)
      all[i].p = sum > 0 ? std::floor(share * all[i].p / sum * 65536 + 0.5) / 65536 : 0;
  }
  std::stable_sort(all.begin(), all.end(), [](const Substyle& a, const Substyle& b) { return a.p > b.p; });
  if (all.size() > most) all.resize(most);
  return all;
}

std::size_t choose_storeys(const PerAnswer& p, std::size_t n) {
  std::size_t best = 0;
  double most = -1;
  for (std::size_t a = 0; a < n; ++a) {
    double sum = p[a];
    if (a > 0) sum += kBeside * p[a - 1];
    if (a + 1 < n) sum += kBeside * p[a + 1];
    if (sum > most) {
      most = sum;
      best = a;
    }
  }
  return best;
}

}  // namespace blockrand::classify
