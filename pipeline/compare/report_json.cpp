// compare.json: everything that was found, in a fixed order, without a clock or a host in it.
#include <nlohmann/json.hpp>

#include "pipeline/base/text.h"
#include "pipeline/base/version.h"
#include "pipeline/compare/comparison_report.h"
#include "pipeline/compare/report_numbers.h"
#include "pipeline/compare/report_places.h"

namespace blockrand::compare {
namespace {

using Json = nlohmann::ordered_json;

std::string_view name_of(Better better) {
  static constexpr std::string_view kNames[] = {"higher", "lower", "zero", "one", "none"};
  return kNames[static_cast<int>(better)];
}
std::string_view name_of(Pool pool) {
  static constexpr std::string_view kNames[] = {"mean", "rms", "max", "sum"};
  return kNames[static_cast<int>(pool)];
}
std::string_view name_of(Scope scope) {
  static constexpr std::string_view kNames[] = {"plan", "body", "surface", "facades"};
  return kNames[static_cast<int>(scope)];
}

Json number(const std::optional<double>& value) {
  const std::optional<double> sound = finite(value);
  return sound ? Json(*sound) : Json();
}

Json file_json(const CityFile& file) {
  Json notes = Json::array();
  for (const importers::reference::Note& note : file.notes) {
    Json examples = Json::array();
    for (const std::string& example : note.examples) examples.push_back(example);
    notes.push_back({{"kind", importers::reference::name_of(note.kind)},
                     {"breach", importers::reference::is_breach(note.kind)},
                     {"count", note.count},
                     {"examples", std::move(examples)}});
  }
  return {{"path", file.path},           {"format", file.format},     {"crs", file.crs},          {"bytes", file.bytes},
          {"buildings", file.buildings}, {"breaches", file.breaches}, {"notes", std::move(notes)}};
}

Json city_json(const City& city) {
  Json files = Json::array();
  for (const CityFile& file : city.files) files.push_back(file_json(file));
  return {{"name", city.name},
          {"attribution", city.attribution.empty() ? Json() : Json(city.attribution)},
          {"height_reference", city.height_reference},
          {"absolute_heights", city.absolute_heights},
          {"buildings", city.buildings.size()},
          {"without_geometry", city.without_geometry},
          {"out_of_reach", city.out_of_reach},
          {"repetitions", city.repetitions},
          {"files", std::move(files)}};
}

Json registration_json(const Registration& r) {
  return {{"matches", r.matches},
          {"east", r.matches > 0 ? number(r.east) : Json()},
          {"north", r.matches > 0 ? number(r.north) : Json()},
          {"east_spread", r.matches > 0 ? number(r.east_spread) : Json()},
          {"north_spread", r.matches > 0 ? number(r.north_spread) : Json()},
          {"up", number(r.up)},
          {"up_spread", r.up ? number(r.up_spread) : Json()},
          {"horizontal_removed", r.horizontal_removed},
          {"vertical_removed", r.vertical_removed},
          {"rule", r.rule}};
}

Json summary_json(const Summary& s, Better better) {
  const bool any = s.count > 0;
  const auto value = [&](double v) { return any ? number(v) : Json(); };
  Json out = {{"count", s.count},
              {"pooled", value(s.pooled)},
              {"mean", value(s.mean)},
              {"mean_abs", value(s.mean_abs)},
              {"rms", value(s.rms)},
              {"median", value(s.median)},
              {"p95_abs", value(s.p95_abs)},
              {"min", value(s.min)},
              {"max", value(s.max)}};
  if (better == Better::one) out["mean_factor"] = value(s.mean_factor);
  return out;
}

Json summaries_json(const MeasureSummaries& summaries) {
  Json out = Json::object();
  for (std::size_t m = 0; m < kMeasureCount; ++m) {
    const MeasureInfo& measure = kMeasures[m];
    out[std::string(measure.id)] = {{"title", measure.title},
                                    {"what", measure.text},
                                    {"unit", measure.unit},
                                    {"better", name_of(measure.better)},
                                    {"pool", name_of(measure.pool)},
                                    {"scope", name_of(measure.scope)},
                                    {"left_out", number(summaries[m].left_out)},
                                    {"counted", summary_json(summaries[m].counted, measure.better)},
                                    {"all", summary_json(summaries[m].all, measure.better)}};
  }
  return out;
}

/// \param city  for the ids of the buildings; nullptr for totals, which have none and no heights
Json side_json(const SideFacts& side, const City* city) {
  Json out = Json::object();
  if (city != nullptr) {
    Json ids = Json::array();
    for (const std::uint32_t b : side.buildings) ids.push_back(city->buildings[b].id);
    out["buildings"] = std::move(ids);
  }
  out["footprint_area"] = number(side.footprint_area);
  out["surface_area"] = number(side.surface_area);
  Json area = Json::object(), left_out = Json::object(), defects = Json::object();
  for (int i = 0; i < kHullCount; ++i)
    area[std::string(name_of(static_cast<Hull>(i)))] = number(side.area_of[static_cast<std::size_t>(i)]);
  for (int i = 0; i < kLeftOutCount; ++i)
    left_out[std::string(name_of(static_cast<LeftOut>(i)))] = number(side.left_out[static_cast<std::size_t>(i)]);
  for (const auto& [defect, count] : side.defects) defects[defect] = count;
  out["area_of_class"] = std::move(area);
  out["area_left_out"] = std::move(left_out);
  out["unclassified_area"] = number(side.unclassified_area);
  if (city != nullptr) {
    out["ground"] = number(side.ground);
    out["eaves"] = number(side.eaves);
    out["ridge"] = number(side.ridge);
  }
  out["volume"] = number(side.volume);
  if (city != nullptr) {
    out["pitch"] = number(side.pitch);
    out["roof_form"] = name_of(side.roof_form);
  }
  out["solids"] = side.solids;
  out["valid_solids"] = side.valid_solids;
  out["defects"] = std::move(defects);
  out["openings"] = side.openings;
  out["triangles"] = side.triangles;
  return out;
}

Json facade_json(const Facade& f, const City& city) {
  return {{"building", f.building < city.buildings.size() ? Json(city.buildings[f.building].id) : Json()},
          {"width", number(f.width())},
          {"bottom", number(f.bottom)},
          {"top", number(f.top)},
          {"area", number(f.area)},
          {"covered", number(f.covered)},
          {"openings", f.openings.size()},
          {"storeys", f.storeys},
          {"axes", f.axes},
          {"storey_pitch", number(f.storey_pitch)},
          {"axis_pitch", number(f.axis_pitch)},
          {"blank", f.blank}};
}

Json facades_json(const FacadeComparison& facades, const Comparison& c) {
  Json model = Json::array(), reference = Json::array(), pairs = Json::array();
  for (const Facade& f : facades.model) model.push_back(facade_json(f, c.model));
  for (const Facade& f : facades.reference) reference.push_back(facade_json(f, c.reference));
  const auto index = [](std::size_t i) { return i == FacadePair::kNone ? Json() : Json(i); };
  for (const FacadePair& p : facades.pairs)
    pairs.push_back({{"model", index(p.model)},
                     {"reference", index(p.reference)},
                     {"matched_openings", p.matches.size()},
                     {"left_out", p.left_out}});
  return {{"model", std::move(model)}, {"reference", std::move(reference)}, {"pairs", std::move(pairs)}};
}

Json values_json(const MeasureValues& values) {
  Json out = Json::object();
  for (std::size_t m = 0; m < kMeasureCount; ++m) {
    const MeasureValue& v = values[m];
    out[std::string(kMeasures[m].id)] = {{"counted", number(v.counted)},
                                         {"all", number(v.all)},
                                         {"weight", number(v.weight)},
                                         {"weight_all", number(v.weight_all)},
                                         {"left_out", number(v.left_out)}};
  }
  return out;
}

/// \param covered  for each building the share of its footprint that the other model covers
Json unmatched_json(const City& city, const std::vector<std::uint32_t>& buildings, const std::vector<double>& covered) {
  Json out = Json::array();
  for (std::size_t i = 0; i < buildings.size(); ++i) {
    const Building& building = city.buildings[buildings[i]];
    const Point2 place = place_of(city, building);
    out.push_back({{"id", building.id},
                   {"file", building.file < city.files.size() ? Json(city.files[building.file].path) : Json()},
                   {"place", {number(place.x), number(place.y)}},
                   {"footprint_area", number(building.footprint_area)},
                   {"covered", i < covered.size() ? number(covered[i]) : Json()}});
  }
  return out;
}

Json confusion_json(const Comparison& c) {
  Json out = Json::object();
  for (int r = 0; r < kRoofFormCount; ++r) {
    Json row = Json::object();
    for (int m = 0; m < kRoofFormCount; ++m)
      row[std::string(name_of(static_cast<RoofForm>(m)))] =
          c.roof_confusion[static_cast<std::size_t>(r)][static_cast<std::size_t>(m)];
    out[std::string(name_of(static_cast<RoofForm>(r)))] = std::move(row);
  }
  return out;
}

Json distances_json(const DistanceDistribution& d) {
  const auto list = [](const std::vector<double>& values) {
    Json out = Json::array();
    for (const double v : values) out.push_back(number(v));
    return out;
  };
  return {{"upto", list(d.upto)},
          {"model_to_reference", list(d.to_reference)},
          {"reference_to_model", list(d.to_model)},
          {"p95_model_to_reference", number(d.p95_to_reference)},
          {"p95_reference_to_model", number(d.p95_to_model)}};
}

// ---- text: what has no container in it stands on one line

bool is_flat(const Json& value) {
  for (const Json& item : value)
    if (item.is_structured() && !item.empty()) return false;
  return true;
}

void append(std::string& out, const Json& value, std::size_t indent) {
  if (value.is_string()) {
    out += base::json_quoted(value.get_ref<const std::string&>());
  } else if (value.is_number_float()) {
    out += base::shortest(value.get<double>());
  } else if (!value.is_structured()) {
    out += value.dump();
  } else {
    const bool flat = is_flat(value);
    out += value.is_object() ? '{' : '[';
    bool first = true;
    for (auto item = value.begin(); item != value.end(); ++item) {
      if (!first) out += flat ? ", " : ",";
      first = false;
      if (!flat) (out += '\n').append(indent + 2, ' ');
      if (value.is_object()) (out += base::json_quoted(item.key())) += ": ";
      append(out, *item, indent + 2);
    }
    if (!flat) (out += '\n').append(indent, ' ');
    out += value.is_object() ? '}' : ']';
  }
}

}  // namespace

std::string comparison_json(const Comparison& c, const OptionList& options) {
  Json out = {{"format", kJsonFormat},
              {"format_version", kJsonFormatVersion},
              {"program", "Blockrand"},
              {"program_version", base::kVersion}};
  Json asked = Json::object();
  for (const auto& [key, value] : options) asked[key] = value;
  out["options"] = std::move(asked);
  out["crs"] = c.reference.crs.empty() ? c.model.crs : c.reference.crs;
  out["heights"] = heights_key(c);
  out["model"] = city_json(c.model);
  out["reference"] = city_json(c.reference);
  out["registration"] = registration_json(c.registration);
  std::size_t model_buildings = 0, reference_buildings = 0;
  for (const MatchResult& m : c.matches) {
    model_buildings += m.model.buildings.size();
    reference_buildings += m.reference.buildings.size();
  }
  out["counts"] = {{"matches", c.matches.size()},
                   {"matched_model_buildings", model_buildings},
                   {"matched_reference_buildings", reference_buildings},
                   {"missing", c.missing.size()},
                   {"extra", c.extra.size()},
                   {"missing_area", number(footprint_area(c.reference, c.missing))},
                   {"extra_area", number(footprint_area(c.model, c.extra))},
                   {"blank_facades", c.blank_facades}};
  out["summary"] = summaries_json(c.summaries);
  out["distances"] = distances_json(c.distances);
  out["roof_confusion"] = confusion_json(c);
  out["totals"] = {{"model", side_json(c.model_total, nullptr)}, {"reference", side_json(c.reference_total, nullptr)}};
  out["missing"] = unmatched_json(c.reference, c.missing, c.missing_covered);
  out["extra"] = unmatched_json(c.model, c.extra, c.extra_covered);
  Json matches = Json::array();
  for (const MatchResult& m : c.matches)
    matches.push_back({{"id", m.id},
                       {"model", side_json(m.model, &c.model)},
                       {"reference", side_json(m.reference, &c.reference)},
                       {"measures", values_json(m.values)},
                       {"facades", facades_json(m.facades, c)}});
  out["matches"] = std::move(matches);
  std::string text;
  append(text, out, 0);
  return text + "\n";
}

}  // namespace blockrand::compare
