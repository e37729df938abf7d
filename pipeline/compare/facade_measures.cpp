// The measures of facades and openings.
#include <algorithm>
#include <optional>

#include "pipeline/compare/facade_agreement.h"

namespace blockrand::compare {
namespace {

/// Sums over the facades of one match that take part.
struct Totals {
  int model_storeys = 0, reference_storeys = 0;  // the most of any facade
  std::size_t model_openings = 0, reference_openings = 0, matched = 0;
  double model_area = 0, reference_area = 0, model_opening_area = 0, reference_opening_area = 0;  // m²
  double axes_error = 0, storey_pitch_error = 0, axis_pitch_error = 0;                            // sums
  std::size_t axes_pairs = 0, storey_pitch_pairs = 0, axis_pitch_pairs = 0;
};

Totals totals(const FacadeComparison& c, bool with_left_out) {
  Totals t;
  for (const FacadePair& pair : c.pairs) {
    const Facade* model = pair.model == FacadePair::kNone ? nullptr : &c.model[pair.model];
    const Facade* reference = pair.reference == FacadePair::kNone ? nullptr : &c.reference[pair.reference];
    if (pair.left_out && !with_left_out) continue;
    if (model != nullptr) {
      t.model_storeys = std::max(t.model_storeys, model->storeys);
      t.model_openings += model->openings.size();
      t.model_area += model->area;
      t.model_opening_area += model->opening_area;
    }
    if (reference != nullptr) {
      t.reference_storeys = std::max(t.reference_storeys, reference->storeys);
      t.reference_openings += reference->openings.size();
      t.reference_area += reference->area;
      t.reference_opening_area += reference->opening_area;
    }
    if (model == nullptr || reference == nullptr) continue;
    t.matched += pair.matches.size();
    if (!reference->openings.empty()) {
      t.axes_error += model->axes - reference->axes;
      ++t.axes_pairs;
    }
    if (model->storey_pitch && reference->storey_pitch) {
      t.storey_pitch_error += *model->storey_pitch - *reference->storey_pitch;
      ++t.storey_pitch_pairs;
    }
    if (model->axis_pitch && reference->axis_pitch) {
      t.axis_pitch_error += *model->axis_pitch - *reference->axis_pitch;
      ++t.axis_pitch_pairs;
    }
  }
  return t;
}

std::optional<int> stated_storeys(const City& city, std::span<const std::uint32_t> buildings) {
  std::optional<int> storeys;
  for (const std::uint32_t b : buildings)
    if (city.buildings[b].storeys) storeys = std::max(storeys.value_or(0), *city.buildings[b].storeys);
  return storeys;
}

struct Weighted {
  std::optional<double> value;
  double weight = 0;
};

Weighted mean(double sum, std::size_t count) {
  if (count == 0) return {};
  return {sum / static_cast<double>(count), static_cast<double>(count)};
}

Weighted share(std::size_t part, std::size_t whole) { return mean(static_cast<double>(part), whole); }

Weighted measure(Measure m, const Totals& t, std::optional<int> model_stated, std::optional<int> reference_stated) {
  if (m == Measure::storeys_error) {
    const auto model = t.model_storeys > 0 ? std::optional(t.model_storeys) : model_stated;
    const auto reference = t.reference_storeys > 0 ? std::optional(t.reference_storeys) : reference_stated;
    if (!model || !reference) return {};
    return {static_cast<double>(*model - *reference), 1};
  }
  if (t.reference_openings == 0) return {};
  if (m == Measure::axes_error) return mean(t.axes_error, t.axes_pairs);
  if (m == Measure::openings_ratio) return share(t.model_openings, t.reference_openings);
  if (m == Measure::window_to_wall_error && t.model_area > 0 && t.reference_area > 0)
    return {t.model_opening_area / t.model_area - t.reference_opening_area / t.reference_area, t.reference_area};
  if (m == Measure::opening_precision) return share(t.matched, t.model_openings);
  if (m == Measure::opening_recall) return share(t.matched, t.reference_openings);
  if (m == Measure::storey_pitch_error) return mean(t.storey_pitch_error, t.storey_pitch_pairs);
  if (m == Measure::axis_pitch_error) return mean(t.axis_pitch_error, t.axis_pitch_pairs);
  return {};
}

}  // namespace

void measure_facades(const FacadeComparison& facades, const City& model, std::span<const std::uint32_t> model_buildings,
                     const City& reference, std::span<const std::uint32_t> reference_buildings, MeasureValues& values) {
  const Totals counted = totals(facades, false), all = totals(facades, true);
  const auto model_stated = stated_storeys(model, model_buildings);
  const auto reference_stated = stated_storeys(reference, reference_buildings);
  double area = 0, left_out = 0;
  for (const Facade& f : facades.reference) {
    area += f.area;
    if (f.left_out()) left_out += f.area;
  }
  for (const Measure m :
       {Measure::storeys_error, Measure::axes_error, Measure::openings_ratio, Measure::window_to_wall_error,
        Measure::opening_precision, Measure::opening_recall, Measure::storey_pitch_error, Measure::axis_pitch_error}) {
    const Weighted with = measure(m, all, model_stated, reference_stated);
    const Weighted without = measure(m, counted, model_stated, reference_stated);
    MeasureValue& value = values[static_cast<std::size_t>(m)];
    value.counted = without.value;
    value.weight = without.weight;
    value.all = with.value;
    value.weight_all = with.weight;
    value.left_out = area > 0 && (with.value || without.value) ? left_out / area : 0;
  }
}

}  // namespace blockrand::compare
