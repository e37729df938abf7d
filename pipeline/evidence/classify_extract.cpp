#include "pipeline/evidence/classify_extract.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/base/parallel.h"
#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::evidence {

namespace {

using classify::Feature;
using classify::FeatureVector;
using classify::kNearReach;
using classify::PerAnswer;
using classify::Siting;
using classify::VoteKernel;
using classify::Voter;
using model::BuildingStyle;

constexpr std::size_t kRun = 256;  ///< buildings that one worker takes at a time
constexpr std::size_t kStyles = model::kStyleClassCount, kEras = model::kEraCount,
                      kMorphologies = model::kMorphologyCount, kRoofs = classify::kRoofFamilyCount;
/// Probability that a stated rule gives to `other`: certain but for a slip of the mapper.
constexpr float kRuleSays = 0.97f;
/// Years around the middle one that building:architecture stands for.
constexpr int kStyleYears = 15;
/// Years by which a date is later than the row around it and speaks for itself alone. A row of one building period was
/// filled within four decades (1871 to 1914 at the most); what comes later is infill and tells nothing of its neighbours.
constexpr int kInfillYears = 40;
/// Confidence that votes may not exceed: neighbours are no tags.
constexpr float kMostConfident = 0.9f;

template <std::size_t N>
std::array<float, N> as_floats(const PerAnswer& p) {
  std::array<float, N> out{};
  for (std::size_t i = 0; i < N; ++i) out[i] = static_cast<float>(p[i]);
  return out;
}

Voter voter_of(const FactsExtract& facts, std::uint32_t b) {
  const BuildingPlace& p = facts.places[b];
  const FeatureVector& f = facts.features[b];
  Voter v;
  v.place = p.place;
  v.area = f.has(Feature::area) ? static_cast<double>(f[Feature::area]) : 0;
  v.siting = classify::siting_of(p.position);
  v.street = p.street;
  v.block = p.block;
  v.use = f.has(Feature::tag_use) ? static_cast<std::uint8_t>(f[Feature::tag_use]) : std::uint8_t{0};
  return v;
}

void in_runs(std::size_t count, int workers, const std::function<void(std::size_t first, std::size_t last)>& work) {
  base::ordered_parallel((count + kRun - 1) / kRun, workers, static_cast<std::size_t>(workers) * 4,
                         [&](std::size_t i) { work(i * kRun, std::min(count, (i + 1) * kRun)); }, [](std::size_t) {});
}

/// Those who have something to say about one question.
class Poll {
 public:
  /// \param answer  of a building, or a negative number for none
  Poll(const FactsExtract& facts, const VoteKernel& kernel, std::vector<std::int16_t> answers)
      : facts_(facts), kernel_(kernel), answers_(std::move(answers)), index_(facts, tellers()) {}

  struct Result {
    PerAnswer votes{};
    double all = 0;
    std::uint16_t voters = 0;
  };
  /// \param heard  is told of each voter and its weight; may be empty
  Result ask(std::uint32_t building, std::vector<std::uint32_t>& near,
             const std::function<void(std::uint32_t voter, double weight)>& heard = {}) const {
    Result r;
    const Voter asker = voter_of(facts_, building);
    index_.near(asker.place, kernel_.reach, near);
    const auto contacts = facts_.contacts_of(building);
    for (const std::uint32_t b : near) {
      if (b == building) continue;
      const bool touches =
          std::any_of(contacts.begin(), contacts.end(), [b](const Contact& c) { return c.other == b; });
      const double w = kernel_.weight(asker, voter_of(facts_, b), touches);
      if (w <= 0) continue;
      r.votes[static_cast<std::size_t>(answers_[b])] += w;
      r.all += w;
      ++r.voters;
      if (heard) heard(b, w);
    }
    return r;
  }

 private:
  std::vector<std::uint32_t> tellers() const {
    std::vector<std::uint32_t> out;
    for (std::uint32_t b = 0; b < answers_.size(); ++b)
      if (answers_[b] >= 0) out.push_back(b);
    return out;
  }
  const FactsExtract& facts_;
  const VoteKernel& kernel_;
  std::vector<std::int16_t> answers_;
  PlaceIndex index_;
};

/// A shape of a family, where no neighbour shows one. Of the other shapes a house has the Berlin roof where that is
/// usual for its style, a wing the lean-to; nothing where neither is.
std::optional<model::RoofShape> usual_shape(classify::RoofFamily family, const classify::Style& style,
                                            model::BuildingPosition position) {
  using model::RoofShape;
  switch (family) {
    case classify::RoofFamily::flat:
      return RoofShape::flat;
    case classify::RoofFamily::gabled:
      return RoofShape::gabled;
    case classify::RoofFamily::hipped:
      return RoofShape::hipped;
    case classify::RoofFamily::mansard:
      return RoofShape::mansard;
    case classify::RoofFamily::other:
      break;
  }
  if (position == model::BuildingPosition::side_wing) return RoofShape::skillion;
  return style.double_saltbox > 0 ? std::optional(RoofShape::berlin) : std::nullopt;
}

/// One classification of an extract: what the steps share.
struct Classifier {
  const FactsExtract& facts;
  const TagFacts& tags;
  const classify::Tables& tables;
  const PriorOf& prior;
  const ClassifyOptions& options;
  const Needed& needed;
  int workers = 1;
  std::size_t n = facts.features.size();
  StyleExtract out{};
  std::vector<std::array<float, kStyles>> alone_style{};  ///< log-odds of each building's style by itself
  std::vector<std::int16_t> dated{};                      ///< era of those whose dates speak for others, or -1

  bool known(std::size_t b) const { return needed.has_style(b) && facts.features[b].has(Feature::area); }

  PerAnswer own_era(std::size_t b, const FeatureVector& f, std::span<const float> quarter = {}) const;
  bool is_infill(std::size_t b) const;
  void eras_and_styles();
  void quarters();
  void smooth_styles();
  void reconcile_eras();
  void years();
  void storeys_and_roofs();
};

/// What a building's own evidence, its quarter and its region say of its era. \param quarter  its morphology; empty: not asked
PerAnswer Classifier::own_era(std::size_t b, const FeatureVector& f, std::span<const float> quarter) const {
  PerAnswer era = tables.era.log_odds(f, options.tags);
  const PerAnswer by_quarter = classify::era_of_quarter(tables.quarter, quarter, tables.era);
  for (std::size_t e = 0; e < kEras; ++e) era[e] += by_quarter[e];
  const classify::RegionPrior* region = prior ? prior(static_cast<std::uint32_t>(b)) : nullptr;
  if (region != nullptr && region->era) {
    const PerAnswer add = classify::prior_log_odds(*region->era, tables.era);
    for (std::size_t e = 0; e < kEras; ++e) era[e] += add[e];
  }
  return classify::probabilities(era, kEras);
}

/// What is known of a building wherever an area ends: without what it shares with its row, its block and what stands around.
FeatureVector alone(const FeatureVector& f) {
  FeatureVector out;
  for (std::size_t i = 0; i < classify::kFeatureCount; ++i)
    if (const std::string_view group = classify::kFeatures[i].group;
        group == "footprint" || group == "situation" || group == "tag")
      out[static_cast<Feature>(i)] = f[static_cast<Feature>(i)];
  return out;
}

/// Whether a dated house is much later than those that touch it on two sides and more: by their dates where they have
/// one, else by their own evidence.
bool Classifier::is_infill(std::size_t b) const {
  const int before = static_cast<int>(tags.dates[b].year) - kInfillYears;
  const Siting siting = classify::siting_of(facts.places[b].position);
  double older = 0;
  int around = 0;
  for (const Contact& c : facts.contacts_of(static_cast<std::uint32_t>(b))) {
    if (!facts.places[c.other].house || tags.non_house[c.other] >= 0 ||
        classify::siting_of(facts.places[c.other].position) != siting)
      continue;
    ++around;
    if (tags.dates[c.other].confidence > 0.5f)
      older += tags.dates[c.other].year < static_cast<float>(before) ? 1 : 0;
    else
      older += classify::share_before(own_era(c.other, alone(facts.features[c.other])), before);
  }
  return around >= 2 && older > 0.5 * around;
}

/// Era and style of each building alone, with dated neighbours.
void Classifier::eras_and_styles() {
  alone_style.resize(n);
  dated.assign(n, -1);
  if (options.dates)
    for (std::size_t b = 0; b < n; ++b)
      if (tags.dates[b].confidence > 0.5f && facts.features[b].has(Feature::area) && !is_infill(b))
        dated[b] = static_cast<std::int16_t>(model::era_of(static_cast<int>(tags.dates[b].year)));
  const Poll era_poll(facts, tables.era_votes, dated);
  in_runs(n, workers, [&](std::size_t first, std::size_t last) {
    std::vector<std::uint32_t> near;
    for (std::size_t b = first; b < last; ++b) {
      if (!known(b)) continue;
      const FeatureVector& f = facts.features[b];
      BuildingStyle& s = out.styles[b];
      const classify::RegionPrior* region = prior ? prior(static_cast<std::uint32_t>(b)) : nullptr;
      s.years = tags.years[b];
      s.non_house = tags.non_house[b] >= 0 &&
                    (options.tags || tags.reasons[static_cast<std::size_t>(tags.non_house[b])].by_geometry());

      PerAnswer p = own_era(b, f, s.morphology);
      const Poll::Result votes = era_poll.ask(static_cast<std::uint32_t>(b), near);
      // What is dated speaks for itself.
      const bool is_dated = options.dates && tags.dates[b].confidence > 0.5f;
      if (votes.all > 0 && !is_dated) {
        p = classify::posterior(votes.votes, p, tables.era_votes, kEras);
        out.dates[b].votes = static_cast<float>(votes.all);
        out.dates[b].voters = votes.voters;
      }
      if (options.dates && tags.dates[b].confidence > 0) {
        const auto middle = static_cast<std::int16_t>(tags.dates[b].year);
        const model::YearRange years = tags.years[b].value_or(model::YearRange{
            static_cast<std::int16_t>(middle - kStyleYears), static_cast<std::int16_t>(middle + kStyleYears)});
        const PerAnswer told = classify::era_of_years(years, static_cast<double>(tags.dates[b].confidence));
        PerAnswer sum{};
        for (std::size_t e = 0; e < kEras; ++e) sum[e] = base::log(std::max(p[e], 1e-4)) + told[e];
        p = classify::probabilities(sum, kEras);
      }
      s.era = as_floats<kEras>(p);

      PerAnswer style = tables.style.log_odds(f, options.tags);
      if (region != nullptr && region->style) {
        const PerAnswer add = classify::prior_log_odds(*region->style, tables.style);
        for (std::size_t c = 0; c < kStyles; ++c) {
          style[c] += add[c];
          out.region[b][c] = out.elsewhere[b][c] = static_cast<float>(add[c]);
        }
      }
      alone_style[b] = as_floats<kStyles>(style);
      s.style = as_floats<kStyles>(classify::probabilities(style, kStyles));
      if (s.non_house) {
        s.style.fill((1 - kRuleSays) / (kStyles - 1));
        s.style[static_cast<std::size_t>(model::StyleClass::other)] = kRuleSays;
      }
    }
  });
}

/// A quarter is what its houses say together: the mean of their log-odds.
void Classifier::quarters() {
  std::vector<std::uint32_t> houses;
  for (std::uint32_t b = 0; b < n; ++b)
    if (facts.places[b].house) houses.push_back(b);
  const PlaceIndex index(facts, houses);
  std::vector<PerAnswer> alone(n);
  in_runs(n, workers, [&](std::size_t first, std::size_t last) {
    for (std::size_t b = first; b < last; ++b)
      if (known(b)) alone[b] = tables.morphology.log_odds(facts.features[b], false);
  });
  in_runs(n, workers, [&](std::size_t first, std::size_t last) {
    std::vector<std::uint32_t> near;
    for (std::size_t b = first; b < last; ++b) {
      if (!known(b)) continue;
      index.near(facts.places[b].place, kNearReach, near);
      PerAnswer sum = facts.places[b].house ? PerAnswer{} : alone[b];
      const double voices = static_cast<double>(near.size()) + (facts.places[b].house ? 0 : 1);
      for (const std::uint32_t o : near)
        for (std::size_t m = 0; m < kMorphologies; ++m) sum[m] += alone[o][m];
      for (std::size_t m = 0; m < kMorphologies; ++m) sum[m] = classify::round_log_odds(sum[m] / voices);
      out.styles[b].morphology = as_floats<kMorphologies>(classify::probabilities(sum, kMorphologies));
    }
  });
}

/// Styles follow those of the row and the block.
void Classifier::smooth_styles() {
  std::vector<std::uint32_t> houses;
  for (std::uint32_t b = 0; b < n; ++b)
    if (facts.places[b].house && !out.styles[b].non_house) houses.push_back(b);
  const PlaceIndex index(facts, houses);
  std::vector<std::array<float, kStyles>> next(n), added(n);
  for (int round = 0; round < tables.smoothing.rounds; ++round) {
    in_runs(n, workers, [&](std::size_t first, std::size_t last) {
      std::vector<std::uint32_t> near;
      for (std::size_t b = first; b < last; ++b) {
        next[b] = out.styles[b].style;
        if (!known(b) || !facts.places[b].house || out.styles[b].non_house) continue;
        const BuildingPlace& own = facts.places[b];
        const Siting siting = classify::siting_of(own.position);
        PerAnswer sum{};
        for (std::size_t c = 0; c < kStyles; ++c) sum[c] = static_cast<double>(alone_style[b][c]);
        const auto listen = [&](const PerAnswer& heard, double weight, double strength) {
          if (weight <= 0) return;
          for (std::size_t c = 0; c < kStyles; ++c)
            sum[c] += strength * base::log((heard[c] / weight + tables.smoothing.doubt) * static_cast<double>(kStyles));
        };
        PerAnswer row{};
        double lengths = 0;
        for (const Contact& c : facts.contacts_of(static_cast<std::uint32_t>(b))) {
          if (classify::siting_of(facts.places[c.other].position) != siting || out.styles[c.other].non_house) continue;
          for (std::size_t k = 0; k < kStyles; ++k)
            row[k] += static_cast<double>(c.length) * static_cast<double>(out.styles[c.other].style[k]);
          lengths += static_cast<double>(c.length);
        }
        listen(row, lengths, tables.smoothing.row);
        PerAnswer block{};
        double houses_there = 0;
        if (own.block != model::kNoIndex) {
          index.near(own.place, kNearReach, near);
          for (const std::uint32_t o : near) {
            if (o == b || facts.places[o].block != own.block || classify::siting_of(facts.places[o].position) != siting)
              continue;
            for (std::size_t k = 0; k < kStyles; ++k) block[k] += static_cast<double>(out.styles[o].style[k]);
            ++houses_there;
          }
        }
        listen(block, houses_there, tables.smoothing.block);
        for (std::size_t c = 0; c < kStyles; ++c) {
          sum[c] = classify::round_log_odds(sum[c]);
          added[b][c] = static_cast<float>(sum[c]) - alone_style[b][c];
        }
        next[b] = as_floats<kStyles>(classify::probabilities(sum, kStyles));
      }
    });
    for (std::size_t b = 0; b < n; ++b) out.styles[b].style = next[b];
  }
  for (std::size_t b = 0; b < n; ++b) {
    if (!known(b) || out.styles[b].non_house) continue;
    PerAnswer sum{};
    for (std::size_t c = 0; c < kStyles; ++c) {
      sum[c] =
          classify::round_log_odds(tables.smoothing.certainty * static_cast<double>(alone_style[b][c] + added[b][c]));
      // With what is taken off for having been said twice, so that all terms still add up.
      out.elsewhere[b][c] += static_cast<float>(sum[c]) - alone_style[b][c];
    }
    out.styles[b].style = as_floats<kStyles>(classify::probabilities(sum, kStyles));
  }
}

/// Era and class become one decision; what that changes of the class is told with what else is not its own evidence.
void Classifier::reconcile_eras() {
  constexpr double kLeast = 1.0 / (1 << 17);  // half a step of probabilities
  for (std::size_t b = 0; b < n; ++b) {
    if (!known(b) || out.styles[b].non_house) continue;
    // The class is evidence of its own: of the era it says as much as that is heard beside dated neighbours.
    const double heard = tables.era_votes.prior / (tables.era_votes.prior + static_cast<double>(out.dates[b].votes));
    classify::reconcile(out.styles[b], tables.smoothing.era * heard, tables.style.base());
    // From the probabilities themselves, so that all terms still add up; only differences between classes count.
    PerAnswer sum{};
    double shift = 0;
    const auto features = [&](std::size_t c) { return alone_style[b][c] - out.region[b][c]; };  // what they alone say
    for (std::size_t c = 0; c < kStyles; ++c) {
      sum[c] = base::log(std::max(static_cast<double>(out.styles[b].style[c]), kLeast));
      shift += (sum[c] - static_cast<double>(features(c) + out.elsewhere[b][c])) / kStyles;
    }
    for (std::size_t c = 0; c < kStyles; ++c)
      out.elsewhere[b][c] = static_cast<float>(classify::round_log_odds(sum[c] - shift)) - features(c);
  }
}

/// Years of those that dated neighbours of their era give one.
void Classifier::years() {
  const Poll poll(facts, tables.era_votes, dated);
  in_runs(n, workers, [&](std::size_t first, std::size_t last) {
    std::vector<std::uint32_t> near;
    for (std::size_t b = first; b < last; ++b) {
      DateEstimate& date = out.dates[b];
      if (!known(b) || date.voters == 0) continue;
      const model::Era era = out.styles[b].built();
      std::vector<std::pair<int, double>> heard;  // year, weight
      poll.ask(static_cast<std::uint32_t>(b), near, [&](std::uint32_t voter, double weight) {
        const int year = static_cast<int>(tags.dates[voter].year);
        if (model::era_of(year) == era) heard.emplace_back(year, weight);
      });
      if (heard.empty()) continue;
      std::ranges::sort(heard);
      double all = 0;
      for (const auto& [year, weight] : heard) all += weight;
      const auto year_at = [&](double share) {
        double sum = 0;
        for (const auto& [year, weight] : heard)
          if ((sum += weight) >= share * all) return year;
        return heard.back().first;
      };
      const int middle = year_at(0.5);
      int from = std::min(year_at(0.25), middle - kLeastYears), to = std::max(year_at(0.75), middle + kLeastYears);
      while (model::era_of(from) != era) ++from;  // by kLeastYears at most
      while (model::era_of(to) != era) --to;
      date.year = static_cast<std::int16_t>(middle);
      date.from = static_cast<std::int16_t>(from), date.to = static_cast<std::int16_t>(to);
      double between = 0;
      for (const auto& [year, weight] : heard)
        if (year >= date.from && year <= date.to) between += weight;
      date.confidence = std::min(kMostConfident,
                                 out.styles[b].era[static_cast<std::size_t>(era)] * static_cast<float>(between / all));
    }
  });
}

/// Storeys, sub-style, roof.
void Classifier::storeys_and_roofs() {
  const std::size_t counts = tables.storey_counts.size();
  std::vector<std::int16_t> storeys_told(n, -1), roofs_told(n, -1);
  for (std::size_t b = 0; b < n; ++b) {
    const FeatureVector& f = facts.features[b];
    if (f.has(Feature::tag_storeys) && f[Feature::tag_storeys] > 0)
      storeys_told[b] =
          static_cast<std::int16_t>(classify::storey_answer(tables, static_cast<double>(f[Feature::tag_storeys])));
    if (f.has(Feature::tag_roof) && tags.roofs[b])
      roofs_told[b] = static_cast<std::int16_t>(classify::family_of(*tags.roofs[b]));
  }
  const Poll storeys_poll(facts, tables.storeys_votes, storeys_told), roofs_poll(facts, tables.roof_votes, roofs_told);
  in_runs(n, workers, [&](std::size_t first, std::size_t last) {
    std::vector<std::uint32_t> near;
    for (std::size_t i = first; i < last; ++i) {
      if (!known(i)) continue;
      const auto b = static_cast<std::uint32_t>(i);
      FeatureVector f = facts.features[b];
      BuildingStyle& s = out.styles[b];
      const classify::RegionPrior* region = prior ? prior(b) : nullptr;

      // Own storeys are no evidence for themselves.
      f[Feature::tag_storeys] = std::numeric_limits<float>::quiet_NaN();
      PerAnswer log_odds = tables.storeys.log_odds(f, true);
      if (region != nullptr) {
        const PerAnswer add = classify::storeys_prior(tables, *region, s);
        for (std::size_t a = 0; a < counts; ++a) log_odds[a] += add[a];
      }
      const PerAnswer own = classify::probabilities(log_odds, counts);
      const Poll::Result votes = storeys_poll.ask(b, near);
      const PerAnswer p = classify::posterior(votes.votes, own, tables.storeys_votes, counts);
      const std::size_t chosen = classify::choose_storeys(p, counts);
      double sure = p[chosen];
      if (chosen > 0) sure += p[chosen - 1];
      if (chosen + 1 < counts) sure += p[chosen + 1];
      out.storeys[b] = {static_cast<float>(tables.storey_counts[chosen]),
                        std::min(kMostConfident, static_cast<float>(p[chosen])),
                        static_cast<float>(std::min(sure, 1.0)),
                        static_cast<float>(votes.all),
                        static_cast<float>(tables.storey_counts[classify::choose_storeys(own, counts)]),
                        votes.voters};

      const float told = facts.features[b][Feature::tag_storeys];
      classify::SubstyleFacts sub{.style = s};
      sub.position = facts.places[b].position;
      sub.storeys = told == told ? static_cast<double>(told) : tables.storey_counts[chosen];
      sub.roof = tags.roofs[b];
      sub.year = options.dates ? static_cast<double>(tags.dates[b].year) : 0;
      if (sub.year <= 0 && out.dates[b].year > 0)
        sub.year = out.dates[b].year, sub.year_says = static_cast<double>(out.dates[b].confidence);
      sub.area = static_cast<double>(f[Feature::area]);
      if (f.has(Feature::neighbours)) sub.neighbours = static_cast<int>(f[Feature::neighbours]);
      sub.use = f.has(Feature::tag_use) ? static_cast<int>(f[Feature::tag_use]) : 0;
      if (s.non_house) {
        const auto index = tables.catalogue.index(tags.reasons[static_cast<std::size_t>(tags.non_house[b])].style);
        s.substyle = index.value_or(0);
        s.substyle_p = s.style[static_cast<std::size_t>(model::StyleClass::other)];
      } else {
        // Of the likeliest class and, where there is one, of the likeliest era, so that the three answers fit together.
        bool found = false;
        for (const classify::Substyle& c : classify::substyles(tables, region, sub, tables.catalogue.size())) {
          const classify::Style& style = tables.catalogue[c.index];
          if (style.style_class != s.style_class()) continue;
          const bool fits = classify::occurs_in(style.years, s.built());
          if (found && !fits) continue;
          s.substyle = c.index;
          s.substyle_p = static_cast<float>(c.p);
          found = true;
          if (fits) break;
        }
      }

      f[Feature::tag_roof] = std::numeric_limits<float>::quiet_NaN();
      f[Feature::tag_storeys] = static_cast<float>(sub.storeys);
      const PerAnswer own_roof = classify::probabilities(tables.roof.log_odds(f, true), kRoofs);
      std::array<double, model::kRoofShapeCount> shapes{};
      const Poll::Result roofs = roofs_poll.ask(b, near, [&](std::uint32_t voter, double weight) {
        if (model::traits(*tags.roofs[voter]).lent) shapes[static_cast<std::size_t>(*tags.roofs[voter])] += weight;
      });
      const PerAnswer roof = classify::posterior(roofs.votes, own_roof, tables.roof_votes, kRoofs);
      // The likeliest family that can be shown: by the shape that most neighbours of that family have, else by its
      // usual one.
      const auto shape_of = [&](classify::RoofFamily family) {
        std::optional<model::RoofShape> best;
        for (std::size_t k = 0; k < shapes.size(); ++k) {
          const auto shape = static_cast<model::RoofShape>(k);
          if (shapes[k] > 0 && classify::family_of(shape) == family &&
              (!best || shapes[k] > shapes[static_cast<std::size_t>(*best)]))
            best = shape;
        }
        return best ? best : usual_shape(family, tables.catalogue[s.substyle], facts.places[b].position);
      };
      std::array<std::size_t, kRoofs> order{};
      for (std::size_t k = 0; k < kRoofs; ++k) order[k] = k;
      std::stable_sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return roof[x] > roof[y]; });
      RoofEstimate& estimate = out.roofs[b];
      for (const std::size_t k : order)
        if (const auto shape = shape_of(static_cast<classify::RoofFamily>(k))) {
          estimate.shape = *shape;
          estimate.confidence = std::min(kMostConfident, static_cast<float>(roof[k]));
          break;
        }
      estimate.votes = static_cast<float>(roofs.all);
      estimate.voters = roofs.voters;
      estimate.own = static_cast<classify::RoofFamily>(std::max_element(own_roof.begin(), own_roof.begin() + kRoofs) -
                                                       own_roof.begin());
    }
  });
}

}  // namespace

TagFacts tag_facts(const model::Extract& extract, const footprints::FootprintStore& store,
                   const context::ContextExtract& context, const classify::Tables& tables,
                   const georef::Projection& projection, FactsExtract& facts) {
  TagFacts out;
  const std::size_t n = store.size();
  out.dates.resize(n);
  out.years.resize(n);
  out.roofs.resize(n);
  out.non_house.assign(n, -1);

  // Fields of equal small rectangles.
  std::vector<classify::SmallPlan> plans;
  std::vector<std::uint32_t> small;
  for (std::uint32_t b = 0; b < n; ++b) {
    const FeatureVector& f = facts.features[b];
    if (!f.has(Feature::area) || static_cast<double>(f[Feature::area]) > tables.non_houses.equal_largest_area) continue;
    plans.push_back(
        {facts.places[b].place, static_cast<double>(f[Feature::area]), static_cast<int>(f[Feature::corners])});
    small.push_back(b);
  }
  const std::vector<int> equal = classify::equal_neighbours(plans, tables.non_houses);
  std::vector<int> equal_of(n, 0);
  for (std::size_t i = 0; i < small.size(); ++i) equal_of[small[i]] = equal[i];

  // House numbers inside: a node with an address makes a shed a house. Shops inside: what the ground floor is used for.
  std::vector<std::uint8_t> addressed(n, 0);
  {
    const geometry::BoxIndex index = footprints::index_of(store);
    const auto for_each_around = [&](model::Point2 place, auto&& visit) {
      for (const std::uint32_t b : index.near({place, place}, 0)) {
        const std::vector<model::Polygon> polygons = store.polygons(b);
        if (std::any_of(polygons.begin(), polygons.end(),
                        [&](const model::Polygon& p) { return geometry::contains(p, place); }))
          visit(b);
      }
    };
    for (const context::SitePoint& p : context.points)
      if (!p.house_number.empty()) for_each_around(p.place, [&](std::uint32_t b) { addressed[b] = 1; });
    for (const model::Feature& feature : extract.features) {
      if (feature.area || feature.rings.count == 0 || feature.id.type != model::OsmType::node ||
          !(feature.is(model::FeatureKind::shop) || feature.is(model::FeatureKind::amenity)))
        continue;
      const auto category =
          tables.ground_floor.category([&](std::string_view key) { return extract.tag(feature.tags, key); });
      if (!category) continue;
      const model::Point2 place =
          model::snap(projection.forward(extract.vertices_of(extract.rings[feature.rings.first]).front()));
      for_each_around(place, [&](std::uint32_t b) {
        std::vector<int>& counts = out.points[b];
        counts.resize(tables.ground_floor.categories.size());
        ++counts[*category];
      });
    }
  }

  std::map<std::pair<std::string, std::string>, std::int32_t> reasons;
  for (std::uint32_t b = 0; b < n; ++b) {
    FeatureVector& f = facts.features[b];
    if (!f.has(Feature::area)) continue;
    const model::MappedBuilding& mapped = extract.buildings[store[b].lead];
    const std::string_view use = extract.strings.view(mapped.attributes.use);
    const classify::TagLookup tag = [&](std::string_view key) { return extract.tag(mapped.tags, key); };
    classify::fill_tag_features(f, mapped.attributes, use, tag, tables.tags);
    if (addressed[b]) f[Feature::tag_number] = 1;
    if (mapped.attributes.built) out.years[b] = mapped.attributes.built->years;
    if (f.has(Feature::tag_year)) {
      const bool dated = mapped.attributes.built &&
                         static_cast<float>(mapped.attributes.built->years.middle()) == f[Feature::tag_year];
      out.dates[b] = {f[Feature::tag_year], dated ? mapped.attributes.built->confidence : 0.7f};
    }
    out.roofs[b] = mapped.attributes.roof_shape;
    classify::NonHouseFacts asked;
    asked.use = use;
    asked.tag = tag;
    asked.area = static_cast<double>(f[Feature::area]);
    asked.has_address = f[Feature::tag_number] > 0;
    if (mapped.attributes.storeys) asked.storeys = static_cast<double>(*mapped.attributes.storeys);
    asked.equal_neighbours = equal_of[b];
    if (auto non_house = classify::non_house(asked, tables.non_houses)) {
      const auto [known, fresh] =
          reasons.try_emplace({non_house->kind, non_house->why}, static_cast<std::int32_t>(out.reasons.size()));
      out.non_house[b] = known->second;
      if (fresh) out.reasons.push_back(std::move(*non_house));
    }
  }
  return out;
}

Needed needed_for(std::span<const std::uint32_t> asked, const footprints::FootprintStore& store,
                  const context::ContextExtract& context, const classify::Tables& tables) {
  // Of what lies beside a tile's buildings the class is asked as well (tile_key.cpp).
  constexpr double kBeside = 5;  // m
  Needed needed;
  needed.facts.assign(store.size(), 0);
  needed.styles.assign(store.size(), 0);
  const geometry::BoxIndex index = footprints::index_of(store);
  const auto grow = [&](std::vector<std::uint8_t>& set, std::span<const std::uint32_t> from, double distance) {
    std::vector<std::uint32_t> added;
    for (const std::uint32_t b : from)
      if (!store[b].box.empty())
        for (const std::uint32_t o : index.near(store[b].box, distance))
          if (!set[o]) set[o] = 1, added.push_back(o);
    return added;
  };
  // Middles lie in their boxes: what is near by its middle is near by its box, and so is what touches.
  std::vector<std::uint32_t> edge = grow(needed.styles, asked, kBeside);
  for (int round = 0; round < std::max(1, tables.smoothing.rounds); ++round)
    edge = grow(needed.styles, edge, kNearReach);
  const double reach = std::max({kNearReach, tables.era_votes.reach, tables.storeys_votes.reach,
                                 tables.roof_votes.reach, tables.non_houses.equal_radius});
  std::vector<std::uint32_t> classified;
  std::vector<std::uint8_t> blocks(context.blocks.size(), 0);
  for (std::uint32_t b = 0; b < store.size(); ++b) {
    if (!needed.styles[b]) continue;
    classified.push_back(b);
    if (context.block_of[b] != model::kNoIndex) blocks[context.block_of[b]] = 1;
  }
  const std::vector<std::uint32_t> voters = grow(needed.facts, classified, reach);
  grow(needed.facts, voters, kBeside);  // what a dated voter is compared with: Classifier::is_infill
  for (std::uint32_t b = 0; b < store.size(); ++b)
    if (context.block_of[b] != model::kNoIndex && blocks[context.block_of[b]]) needed.facts[b] = 1;
  return needed;
}

StyleExtract classify_extract(const FactsExtract& facts, const TagFacts& tags, const classify::Tables& tables,
                              const PriorOf& prior, const ClassifyOptions& options, int workers,
                              base::Progress& progress, const Needed& needed) {
  progress.begin("classify", 4);
  Classifier classifier{.facts = facts,
                        .tags = tags,
                        .tables = tables,
                        .prior = prior,
                        .options = options,
                        .needed = needed,
                        .workers = workers};
  StyleExtract& out = classifier.out;
  out.styles.resize(classifier.n);
  out.storeys.resize(classifier.n);
  out.roofs.resize(classifier.n);
  out.dates.resize(classifier.n);
  out.elsewhere.assign(classifier.n, {});
  out.region.assign(classifier.n, {});
  classifier.quarters();
  progress.advance_to(1);
  classifier.eras_and_styles();
  progress.advance_to(2);
  if (options.smooth) classifier.smooth_styles();
  progress.advance_to(3);
  classifier.reconcile_eras();
  classifier.years();
  classifier.storeys_and_roofs();
  return std::move(out);
}

}  // namespace blockrand::evidence
