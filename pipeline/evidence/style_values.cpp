#include "pipeline/evidence/style_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace blockrand::evidence {

namespace {

using classify::Feature;
using model::Building;
using model::BuildingStyle;
using model::Source;

constexpr std::size_t kStyles = model::kStyleClassCount;
constexpr std::size_t kMostChanges = 4;  ///< more ways to another answer confuse

model::StyleTerm term_of(const classify::Contribution& c) {
  const classify::FeatureInfo& info = classify::kFeatures[c.feature];
  model::StyleTerm t;
  t.feature = info.name;
  t.unit = info.unit;
  t.meaning = info.meaning;
  t.value = static_cast<float>(c.value);
  t.low = static_cast<float>(c.low);
  t.high = static_cast<float>(c.high);
  for (std::size_t i = 0; i < kStyles; ++i) t.weights[i] = static_cast<float>(c.weights[i]);
  return t;
}

model::StyleClass second_of(const BuildingStyle& s) {
  const std::size_t first = static_cast<std::size_t>(s.style_class());
  std::size_t second = first == 0 ? 1 : 0;
  for (std::size_t i = 0; i < kStyles; ++i)
    if (i != first && s.style[i] > s.style[second]) second = i;
  return static_cast<model::StyleClass>(second);
}

model::StyleExplanation explanation_of(std::uint32_t number, const StyleInputs& in) {
  model::StyleExplanation why;
  const BuildingStyle& s = in.styles.styles[number];
  if (s.non_house) why.rule = in.tags.reasons[static_cast<std::size_t>(in.tags.non_house[number])].why;
  const classify::FeatureVector& f = in.facts.features[number];
  for (const classify::Contribution& c : in.tables.style.contributions(f)) why.terms.push_back(term_of(c));
  classify::PerAnswer elsewhere{};
  for (std::size_t i = 0; i < kStyles; ++i) {
    why.prior[i] = static_cast<float>(in.tables.style.prior()[i]);
    why.elsewhere[i] = in.styles.elsewhere[number][i];
    elsewhere[i] = static_cast<double>(why.elsewhere[i]);
  }
  why.second = second_of(s);
  if (!s.non_house)
    for (const classify::Contribution& c :
         in.tables.style.changes_to(f, static_cast<std::size_t>(why.second), elsewhere)) {
      if (why.changes.size() == kMostChanges) break;
      why.changes.push_back(term_of(c));
    }
  return why;
}

/// Where most of the lead of a class over the next one comes from.
Source source_of_style(std::uint32_t number, const StyleInputs& in) {
  const BuildingStyle& s = in.styles.styles[number];
  if (s.non_house) return Source::implied;
  const std::size_t first = static_cast<std::size_t>(s.style_class()), second = static_cast<std::size_t>(second_of(s));
  double tags = 0, geometry = 0;
  for (const classify::Contribution& c : in.tables.style.contributions(in.facts.features[number])) {
    const double lead = c.weights[first] - c.weights[second];
    (classify::is_tag(static_cast<Feature>(c.feature)) ? tags : geometry) += lead;
  }
  const auto lead_of = [&](const auto& log_odds) {
    return static_cast<double>(log_odds[number][first] - log_odds[number][second]);
  };
  const double region = lead_of(in.styles.region), neighbours = lead_of(in.styles.elsewhere) - region;
  if (tags > std::max({geometry, region, neighbours})) return Source::implied;
  if (region > std::max(geometry, neighbours)) return Source::region;
  // A date decides the era, and with it the class (classify::reconcile).
  if (neighbours > geometry && in.tags.dates[number].confidence >= 0.5f) return Source::implied;
  return neighbours > geometry ? Source::neighbours : Source::geometry;
}

void infer(Building& building, std::uint32_t number, const StyleInputs& in) {
  const BuildingStyle& s = building.style;
  model::Inferred& out = building.inferred;
  out = {};
  out.style = s.substyle;
  out.style_confidence = s.substyle_p;
  if (s.non_house) return;  // the defaults of its use know better
  // Who decided: tagged neighbours where their votes outweigh the building's own evidence, else that.
  const auto inferred_candidate = [](auto& to, auto value, float confidence, float votes, std::uint16_t voters,
                                     const classify::VoteKernel& kernel, const std::string& own) {
    const bool heard = static_cast<double>(votes) > kernel.prior;
    const std::string asked =
        fmt::format("{} tagged {} within {:.0f} m", voters, voters == 1 ? "neighbour" : "neighbours", kernel.reach);
    to = {value, heard ? Source::neighbours : Source::geometry, confidence,
          heard ? fmt::format("{}, the more alike the louder; its plan, use and quarter alone say {}", asked, own)
                : fmt::format("its plan, use and quarter, which alone say {}{}", own,
                              voters > 0 ? ", and " + asked + ", unlike or far" : std::string())};
  };
  const StoreysEstimate& storeys = in.styles.storeys[number];
  if (storeys.storeys > 0) {
    inferred_candidate(out.storeys, storeys.storeys, storeys.confidence, storeys.votes, storeys.voters,
                       in.tables.storeys_votes, fmt::format("{:g}", storeys.own));
    out.storeys.why += fmt::format("; within one storey {:.0f} %", 100 * static_cast<double>(storeys.within_one));
  }
  const RoofEstimate& roof = in.styles.roofs[number];
  inferred_candidate(out.roof_shape, roof.shape, roof.confidence, roof.votes, roof.voters, in.tables.roof_votes,
                     std::string(classify::name(roof.own)));
}

std::string years_text(model::YearRange years) {
  return years.from == years.to ? std::to_string(years.from) : fmt::format("{}..{}", years.from, years.to);
}

/// The years that an era and a sub-style have in common; those of the era where they have none.
model::YearRange years_of(model::Era era, const classify::Style& style) {
  const model::YearRange own = classify::years_of(era);
  const model::YearRange both{std::max(own.from, style.years.from), std::min(own.to, style.years.to)};
  return both.from <= both.to ? both : own;
}

std::vector<model::Candidate> others(std::span<const float> p, std::span<const std::string_view> names, std::size_t won,
                                     Source source) {
  std::vector<model::Candidate> out;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (i != won && p[i] >= 0.01f) out.push_back({source, p[i], std::string(names[i]), "less likely"});
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.confidence > b.confidence; });
  return out;
}

}  // namespace

void put_styles(model::Region& region, std::span<const std::uint32_t> numbers, const StyleInputs& in, bool why) {
  for (std::size_t i = 0; i < region.buildings.size(); ++i) {
    Building& building = region.buildings[i];
    if (building.settled != model::ObjectState::pending || !in.facts.features[numbers[i]].has(Feature::area)) continue;
    building.style = in.styles.styles[numbers[i]];
    building.style_known = true;
    infer(building, numbers[i], in);
    if (why) building.style_why = explanation_of(numbers[i], in);
  }
}

void put_style_attributes(model::Region& region, std::span<const std::uint32_t> numbers, const StyleInputs& in) {
  for (std::size_t i = 0; i < region.buildings.size(); ++i) {
    Building& building = region.buildings[i];
    const std::uint32_t number = numbers[i];
    model::Attributes& a = building.attributes;
    const auto put = [&](model::Sourced<std::string>& to, std::string value, Source source, float confidence,
                         std::string text, std::vector<model::Candidate> other_candidates) {
      to = {std::move(value), source, confidence, region.evidence.add({std::move(text), std::move(other_candidates)})};
    };
    const auto tag = [&](std::string_view key) { return region.extract->tag(building.tags, key); };
    if (!building.style_known) {
      for (auto* to : {&a.construction_date, &a.era, &a.style, &a.substyle})
        put(*to, "unknown", Source::default_, 0, "not classified: no outline", {});
    } else {
      const BuildingStyle& s = building.style;
      const classify::Style& style = in.tables.catalogue[s.substyle];
      const float date_confidence = in.tags.dates[number].confidence;
      const auto& told = building.mapped.built;
      const Source found = s.non_house ? Source::implied : source_of_style(number, in);
      const std::size_t era = static_cast<std::size_t>(s.built());
      if (told)
        put(a.construction_date, years_text(told->years), Source::tag, told->confidence,
            told->confidence < 0.5f ? "tagged, but perhaps the date of the shop or office in it" : "tagged", {});
      else if (const DateEstimate& date = in.styles.dates[number]; date.year > 0)
        put(a.construction_date, years_text({date.from, date.to}), Source::neighbours, date.confidence,
            fmt::format("{} dated {} within {:.0f} m; of those of the era the middle one is of {}", date.voters,
                        date.voters == 1 ? "neighbour" : "neighbours", in.tables.era_votes.reach, date.year),
            {});
      else
        put(a.construction_date, years_text(years_of(s.built(), style)), Source::geometry, s.era[era] * s.substyle_p,
            fmt::format("years of {} within {}", style.id, model::kEraNames[era]), {});
      const DateEstimate& heard = in.styles.dates[number];
      const bool neighbours = static_cast<double>(heard.votes) > in.tables.era_votes.prior;
      const Source era_source = date_confidence >= 0.5f ? Source::implied
                                : neighbours            ? Source::neighbours
                                                        : Source::geometry;
      put(a.era, std::string(model::kEraNames[era]), era_source, s.era[era],
          era_source == Source::implied ? "by what is tagged of its date or architecture"
          : neighbours ? fmt::format("{} dated {} within {:.0f} m, the nearer the louder", heard.voters,
                                     heard.voters == 1 ? "neighbour" : "neighbours", in.tables.era_votes.reach)
                       : "plan, quarter, neighbours and what is tagged of its storeys and roof",
          others(s.era, model::kEraNames, era, era_source));
      const std::size_t won = static_cast<std::size_t>(s.style_class());
      put(a.style, std::string(model::kStyleClassNames[won]), found, s.style[won],
          s.non_house ? in.tags.reasons[static_cast<std::size_t>(in.tags.non_house[number])].why
                      : std::string("sum of evidence; blockrand explain lists it"),
          others(s.style, model::kStyleClassNames, won, found));
      put(a.substyle, style.id, s.non_house ? Source::implied : Source::preset, s.substyle_p,
          fmt::format("of the class {}, where position, quarter, era, storeys and use fit best: {}",
                      model::name(style.style_class), style.note),
          {});

      classify::GroundFloorFacts ground;
      ground.use = a.use.value;
      ground.tag = tag;
      ground.points = in.tags.points_of(number);
      ground.style = &style;
      const model::BuildingPosition position = building.situation.position;
      ground.faces_street = !building.situation.fronts.empty();
      ground.corner_house = position == model::BuildingPosition::corner_house;
      if (ground.faces_street) ground.street_class = building.edges[building.situation.fronts.front()].street_class;
      ground.storeys = a.storeys.value;
      classify::GroundFloorUse use = classify::ground_floor_use(ground, in.tables.ground_floor);
      if (s.non_house && use.source != Source::tag && use.source != Source::implied)
        use = {"none", Source::implied, s.style[static_cast<std::size_t>(model::StyleClass::other)],
               in.tags.reasons[static_cast<std::size_t>(in.tags.non_house[number])].why};
      put(a.ground_floor_use, use.value, use.source, use.confidence, use.evidence, {});
    }
    if (!building.style_known) put(a.ground_floor_use, a.use.value, Source::default_, 0.1f, "as the building", {});
    // A body of its own has its own heights, but the house's style.
    for (model::BuildingPart& part : building.parts)
      for (const auto member :
           {&model::Attributes::construction_date, &model::Attributes::era, &model::Attributes::style,
            &model::Attributes::substyle, &model::Attributes::ground_floor_use})
        part.attributes.*member = a.*member;
  }
}

}  // namespace blockrand::evidence
