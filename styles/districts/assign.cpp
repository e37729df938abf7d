#include "styles/districts/assign.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "pipeline/base/random.h"
#include "pipeline/model/osm_keys.h"

namespace blockrand::districts {

namespace {

constexpr std::string_view kPresetTag = model::osm_key::kPreset, kStyleTag = model::osm_key::kStyle;
constexpr float kTagConfidence = 0.95f, kAreaTagConfidence = 0.8f;
/// How much a rule is trusted by how closely it looks: experience, to be replaced when presets are judged.
constexpr double kLevelConfidence[] = {0.4, 0.6, 0.7, 0.8};
/// Probabilities are compared with this margin, so that no last bit decides.
constexpr double kMargin = 1e-5;

constexpr std::array<float, model::kStyleClassCount> kAnyStyle = {0.25f, 0.25f, 0.25f, 0.25f};
constexpr std::array<float, model::kEraCount> kAnyEra = {0.25f, 0.25f, 0.25f, 0.25f};

/// What is known of a building's looks, after overrides and tags.
struct SubjectStyle {
  std::array<float, model::kStyleClassCount> style = kAnyStyle;
  std::array<float, model::kEraCount> era = kAnyEra;
  std::string_view substyle;
  double substyle_p = 1;                                        ///< among the sub-styles of its class
  model::StyleClass substyle_class = model::StyleClass::other;  ///< where `substyle` is known
  std::optional<model::YearRange> years;
  bool non_house = false;
};

struct Given {
  std::string_view value;
  model::Source source = model::Source::tag;
  std::string why;
};

std::string_view tag_of(const Subject& s, std::string_view key) { return s.tag ? s.tag(key) : std::string_view{}; }

/// A class or sub-style by name; false where nobody knows the name.
bool take_style(const RuleSets& book, std::string_view value, SubjectStyle& subject_style) {
  const auto only = [&](model::StyleClass c) {
    subject_style.style.fill(0);
    subject_style.style[static_cast<std::size_t>(c)] = 1;
    subject_style.substyle_class = c;
    subject_style.substyle_p = 1;
  };
  for (int i = 0; i < model::kStyleClassCount; ++i)
    if (model::kStyleClassNames[static_cast<std::size_t>(i)] == value) {
      only(static_cast<model::StyleClass>(i));
      subject_style.substyle = {};
      return true;
    }
  const bool known = std::find(book.substyles.begin(), book.substyles.end(), value) != book.substyles.end();
  for (const Preset& p : book.presets)
    if (std::find(p.substyles.begin(), p.substyles.end(), value) != p.substyles.end()) {
      only(p.style);
      subject_style.substyle = value;
      return true;
    }
  if (known) {
    subject_style.substyle = value;
    subject_style.substyle_class = model::BuildingStyle::likeliest<model::StyleClass>(subject_style.style);
    subject_style.substyle_p = 1;
  }
  return known;
}

SubjectStyle style_of_subject(const RuleSets& book, const Subject& s, std::vector<std::string>* unreadable) {
  SubjectStyle subject_style;
  if (s.style) {
    subject_style.style = s.style->style;
    subject_style.era = s.style->era;
    subject_style.years = s.style->years;
    subject_style.non_house = s.style->non_house;
    // Classification takes the sub-style from the likeliest class.
    subject_style.substyle_class = s.style->style_class();
    const double of_class =
        static_cast<double>(subject_style.style[static_cast<std::size_t>(subject_style.substyle_class)]);
    subject_style.substyle_p = of_class > 0 ? std::min(1.0, static_cast<double>(s.style->substyle_p) / of_class) : 0;
  }
  subject_style.substyle = s.substyle;
  if (!s.overridden_style.empty() && take_style(book, s.overridden_style, subject_style)) return subject_style;
  const auto try_tag = [&](std::string_view value) {
    if (value.empty()) return false;
    if (take_style(book, value, subject_style)) return true;
    if (unreadable) unreadable->push_back(fmt::format("{}={}", kStyleTag, value));
    return false;
  };
  if (try_tag(tag_of(s, kStyleTag))) return subject_style;
  if (s.area_tag)
    if (const auto of_area = s.area_tag(kStyleTag)) try_tag(of_area->value);
  return subject_style;
}

double sum_of(const std::vector<model::Era>& eras, const SubjectStyle& subject_style) {
  double sum = 0;
  for (const model::Era e : eras) sum += static_cast<double>(subject_style.era[static_cast<std::size_t>(e)]);
  return sum;
}

template <class T, class V>
bool any(const std::vector<T>& of, const V& value) {
  return of.empty() || std::find(of.begin(), of.end(), value) != of.end();
}

bool carries(const Subject& s, const TagTest& test) {
  const std::string_view value = tag_of(s, test.key);
  return !value.empty() && (test.value.empty() || value == test.value);
}

bool fires(const Rule& rule, const Subject& s, const SubjectStyle& subject_style) {
  const Which& w = rule.which;
  // What is at hand first, what has to be looked up last.
  if (w.house && *w.house == subject_style.non_house) return false;
  if (w.style && static_cast<double>(subject_style.style[static_cast<std::size_t>(*w.style)]) < w.probability - kMargin)
    return false;
  if (!any(w.positions, s.position) || !any(w.substyles, subject_style.substyle) || !any(w.uses, s.use)) return false;
  if (!w.substyles.empty() && subject_style.substyle_p < w.probability - kMargin) return false;
  if (w.area && !w.area->holds(s.area)) return false;
  if (w.front && !(s.front && w.front->holds(*s.front))) return false;
  if (!w.eras.empty()) {
    const bool in_eras = subject_style.years ? any(w.eras, model::era_of(subject_style.years->middle()))
                                             : sum_of(w.eras, subject_style) >= w.probability - kMargin;
    if (!in_eras) return false;
  }
  if (w.years &&
      (!subject_style.years || subject_style.years->from > w.years->to || subject_style.years->to < w.years->from))
    return false;
  if (const auto& box = rule.where.bbox) {
    const double lon = s.place.lon_degrees(), lat = s.place.lat_degrees();
    if (lon < (*box)[0] || lon > (*box)[2] || lat < (*box)[1] || lat > (*box)[3]) return false;
  }
  for (const auto& [statistic, range] : rule.where.cell) {
    const std::optional<double> value = s.cell ? s.cell(statistic) : std::nullopt;
    if (!value || !range.holds(*value)) return false;
  }
  if (!std::ranges::all_of(w.tags, [&](const TagTest& t) { return carries(s, t); })) return false;
  if (!w.any_tags.empty() && !std::ranges::any_of(w.any_tags, [&](const TagTest& t) { return carries(s, t); }))
    return false;
  if (w.storeys) {
    const std::optional<double> storeys = s.storeys ? s.storeys() : std::nullopt;
    if (!storeys || !w.storeys->holds(*storeys)) return false;
  }
  for (const std::uint32_t q : rule.where.queries)
    if (!s.holds || !s.holds(q)) return false;
  return true;
}

/// Which of a rule's presets a building draws.
const WeightedPreset& draw(const Rule& rule, const Subject& s, std::uint64_t seed) {
  const bool by_block = rule.level == Level::block && !s.block.empty();
  double at = base::random_unit(seed, by_block ? base::hash_text(s.block) : s.id.key(), "preset");
  for (const WeightedPreset& p : rule.presets) {
    if (at < p.weight) return p;
    at -= p.weight;
  }
  return rule.presets.back();
}

float confidence_of(const Rule& rule, const SubjectStyle& subject_style, double weight) {
  double p = weight * kLevelConfidence[static_cast<std::size_t>(rule.level)];
  const auto of_class = [&](model::StyleClass c) {
    return static_cast<double>(subject_style.style[static_cast<std::size_t>(c)]);
  };
  const bool by_substyle = !rule.which.substyles.empty();
  if (by_substyle) p *= of_class(subject_style.substyle_class) * subject_style.substyle_p;
  if (rule.which.style && !(by_substyle && *rule.which.style == subject_style.substyle_class))
    p *= of_class(*rule.which.style);
  if (!rule.which.eras.empty() && !subject_style.years) p *= std::min(1.0, sum_of(rule.which.eras, subject_style));
  // Rounded: what a sum of floats leaves in its last bits is nobody's confidence.
  return static_cast<float>(static_cast<int>(p * 1000 + 0.5)) / 1000.0f;
}

/// A preset that tags order, for the building or the area around it.
struct TaggedPreset {
  std::uint32_t preset = Decision::kNone;
  model::Source source = model::Source::tag;
  float confidence = 0;
  std::string why;
};
std::vector<TaggedPreset> tagged_presets(const RuleSets& book, const Subject& s, bool in_words,
                                         std::vector<std::string>* unreadable) {
  std::vector<TaggedPreset> out;
  const auto take = [&](std::string_view value, model::Source source, float confidence, const model::OsmId* area) {
    if (value.empty()) return;
    const std::size_t preset = find_preset(book.presets, value);
    if (preset == kNoPreset) {
      if (unreadable) unreadable->push_back(fmt::format("{}={}", kPresetTag, value));
      return;
    }
    std::string why;
    if (in_words)
      why = area ? fmt::format("{} tagged on {}, in which it lies", kPresetTag, area->text())
                 : fmt::format("{} tagged", kPresetTag);
    out.push_back({static_cast<std::uint32_t>(preset), source, confidence, std::move(why)});
  };
  take(tag_of(s, kPresetTag), model::Source::tag, kTagConfidence, nullptr);
  if (s.area_tag)
    if (const auto of_area = s.area_tag(kPresetTag))
      take(of_area->value, model::Source::district, kAreaTagConfidence, &of_area->area);
  return out;
}

std::string position_text(model::BuildingPosition p) {
  std::string text(model::name(p));
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

/// Why a rule holds for a building, in its own conditions.
std::string conditions(const RuleSet& set, const Rule& rule, const Subject& s, const SubjectStyle& subject_style) {
  std::vector<std::string> words;
  const Which& w = rule.which;
  if (w.style)
    words.push_back(fmt::format("{} with {:.0f} %", model::name(*w.style),
                                100 * subject_style.style[static_cast<std::size_t>(*w.style)]));
  if (!w.eras.empty()) {
    std::vector<std::string_view> names;
    for (const model::Era e : w.eras) names.push_back(model::name(e));
    words.push_back(fmt::format("built {}", fmt::join(names, " or ")));
  }
  if (w.years) words.push_back(fmt::format("dated {} to {}", subject_style.years->from, subject_style.years->to));
  if (!w.substyles.empty())
    words.push_back(
        fmt::format("style {} with {:.0f} % of its class", subject_style.substyle, 100 * subject_style.substyle_p));
  if (!w.uses.empty()) words.push_back("building=" + std::string(s.use));
  if (w.area) words.push_back(fmt::format("{:.0f} m2", s.area));
  if (w.front) words.push_back(fmt::format("a front of {:.1f} m", s.front.value_or(0)));
  if (w.storeys) words.push_back(fmt::format("{:g} storeys", s.storeys().value_or(0)));
  if (!w.positions.empty()) words.push_back(position_text(s.position));
  for (const TagTest& t : w.tags) words.push_back("tagged " + t.text());
  if (const auto t = std::ranges::find_if(w.any_tags, [&](const TagTest& a) { return carries(s, a); });
      t != w.any_tags.end())
    words.push_back("tagged " + t->text());
  if (w.house) words.push_back(*w.house ? "a house" : "no house");
  for (const auto& [statistic, range] : rule.where.cell)
    words.push_back(fmt::format("{} {:.2f} around", kCellStatisticNames[static_cast<std::size_t>(statistic)],
                                s.cell(statistic).value_or(0)));
  for (const std::uint32_t q : rule.where.queries) words.push_back(set.queries[q].text());
  if (rule.where.bbox) words.push_back("in the rule's box");
  return words.empty() ? "holds for all" : fmt::format("{}", fmt::join(words, ", "));
}

std::string in_words(const RuleSet& set, const Rule& rule, const WeightedPreset& drawn, const Subject& s,
                     const SubjectStyle& subject_style) {
  std::string text = fmt::format("rule '{}' of {} ({}): {}", rule.name, set.title, name(rule.level),
                                 conditions(set, rule, s, subject_style));
  if (rule.presets.size() > 1) {
    text += fmt::format("; drawn with a chance of {:.0f} %", 100 * drawn.weight);
    if (rule.level == Level::block && !s.block.empty()) text += " for the whole block";
  }
  return text;
}

}  // namespace

Decision decide(const RuleSets& book, std::uint32_t set_index, const Subject& s, std::uint64_t seed) {
  Decision d;
  d.set = set_index;
  for (const TaggedPreset& o : tagged_presets(book, s, false, nullptr)) {
    d.preset = o.preset;
    d.source = o.source;
    d.confidence = o.confidence;
    return d;
  }
  if (set_index == RuleSets::kNoSet) return d;
  const RuleSet& set = book.sets[set_index];
  const SubjectStyle subject_style = style_of_subject(book, s, nullptr);
  for (std::uint32_t i = 0; i < set.rules.size(); ++i) {
    const Rule& rule = set.rules[i];
    if (rule.presets.empty() || !fires(rule, s, subject_style)) continue;
    const WeightedPreset& drawn = draw(rule, s, seed);
    d.preset = drawn.preset;
    d.rule = i;
    d.source = model::Source::district;
    d.confidence = confidence_of(rule, subject_style, drawn.weight);
    return d;
  }
  return d;
}

Assignment assign(const RuleSets& book, std::uint32_t set_index, const Subject& s, std::uint64_t seed) {
  Assignment a;
  a.decision.set = set_index;
  const SubjectStyle subject_style = style_of_subject(book, s, &a.unreadable);
  const auto take = [&](std::uint32_t preset, std::uint32_t rule, model::Source source, float confidence,
                        std::string why) {
    Decision& d = a.decision;
    if (d.preset == Decision::kNone) {
      d.preset = preset;
      d.rule = rule;
      d.source = source;
      d.confidence = confidence;
      a.why = std::move(why);
    } else {
      a.other_candidates.push_back({source, confidence, book.presets[preset].name, std::move(why)});
    }
  };
  for (TaggedPreset& o : tagged_presets(book, s, true, &a.unreadable))
    take(o.preset, Decision::kNone, o.source, o.confidence, std::move(o.why));
  std::sort(a.unreadable.begin(), a.unreadable.end());
  a.unreadable.erase(std::unique(a.unreadable.begin(), a.unreadable.end()), a.unreadable.end());
  if (set_index == RuleSets::kNoSet) {
    if (a.why.empty()) a.why = "no rule set holds here";
    return a;
  }
  const RuleSet& set = book.sets[set_index];
  std::map<std::string, Parameter> parameters;
  for (std::uint32_t i = 0; i < set.rules.size(); ++i) {
    const Rule& rule = set.rules[i];
    if (!fires(rule, s, subject_style)) continue;
    a.fired.push_back(i);
    for (const auto& [key, value] : rule.parameters) parameters.emplace(key, Parameter{key, value, i});
    if (rule.presets.empty()) continue;
    const WeightedPreset& drawn = draw(rule, s, seed);
    take(drawn.preset, i, model::Source::district, confidence_of(rule, subject_style, drawn.weight),
         in_words(set, rule, drawn, s, subject_style));
    // What else the deciding rule could have drawn.
    if (a.decision.rule == i)
      for (const WeightedPreset& other : rule.presets)
        if (other.preset != drawn.preset)
          take(other.preset, i, model::Source::district, confidence_of(rule, subject_style, other.weight),
               fmt::format("rule '{}' draws it with a chance of {:.0f} %", rule.name, 100 * other.weight));
  }
  for (auto& [key, parameter] : parameters) a.parameters.push_back(std::move(parameter));
  if (a.why.empty()) a.why = "no rule of " + set.title + " holds";
  return a;
}

}  // namespace blockrand::districts
