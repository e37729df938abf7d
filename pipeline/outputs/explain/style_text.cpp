#include "pipeline/outputs/explain/style_text.h"

#include <cmath>

#include "pipeline/outputs/style_basis.h"

namespace blockrand::outputs {
namespace {

/// The weights of an evidence table have three decimals, probabilities four; more would say nothing.
constexpr double kWeightStep = 1000, kProbabilityStep = 10000;

double rounded(float v, double step) { return std::nearbyint(static_cast<double>(v) * step) / step; }

/// {"gruenderzeit":0.82,...}
template <std::size_t N>
void per_answer(JsonText& json, std::string_view key, const std::array<float, N>& values,
                const std::array<std::string_view, N>& names, double step) {
  json.key(key);
  json.open('{');
  for (std::size_t i = 0; i < N; ++i) json.number(names[i], rounded(values[i], step));
  json.close('}');
}

void append_terms(JsonText& json, std::string_view key, const std::vector<model::StyleTerm>& terms) {
  json.key(key);
  json.open('[');
  for (const model::StyleTerm& term : terms) {
    json.open('{');
    json.string("feature", term.feature);
    json.string("meaning", term.meaning);
    if (std::isfinite(term.value)) json.number("value", rounded(term.value, kWeightStep));
    if (!term.unit.empty()) json.string("unit", term.unit);
    if (std::isfinite(term.low)) json.number("low", rounded(term.low, kWeightStep));
    if (std::isfinite(term.high)) json.number("high", rounded(term.high, kWeightStep));
    per_answer(json, "weights", term.weights, model::kStyleClassNames, kWeightStep);
    json.close('}');
  }
  json.close(']');
}

}  // namespace

void append_style(JsonText& json, const model::Building& building) {
  const model::BuildingStyle& style = building.style;
  if (!is_classified(style)) return;
  const model::StyleExplanation& why = building.style_why;
  json.key("style");
  json.open('{');
  json.string("class", model::name(style.style_class()));
  per_answer(json, "probabilities", style.style, model::kStyleClassNames, kProbabilityStep);
  per_answer(json, "era", style.era, model::kEraNames, kProbabilityStep);
  if (style.years)
    json.integers("years", 2, [&](std::size_t i) { return i == 0 ? style.years->from : style.years->to; });
  per_answer(json, "morphology", style.morphology, model::kMorphologyNames, kProbabilityStep);
  if (const std::string& substyle = building.attributes.substyle.value; !substyle.empty()) {
    json.string("substyle", substyle);
    json.number("substyle_p", rounded(style.substyle_p, kProbabilityStep));
  }
  per_answer(json, "prior", why.prior, model::kStyleClassNames, kWeightStep);
  per_answer(json, "elsewhere", why.elsewhere, model::kStyleClassNames, kWeightStep);
  if (!why.rule.empty()) json.string("rule", why.rule);
  json.string("second", model::name(why.second));
  append_terms(json, "terms", why.terms);
  append_terms(json, "changes", why.changes);
  json.close('}');
}

}  // namespace blockrand::outputs
