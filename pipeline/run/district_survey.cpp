#include "pipeline/run/district_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/attributes/defaults.h"
#include "pipeline/attributes/tagged_buildings.h"
#include "pipeline/base/parallel.h"
#include "pipeline/base/text.h"
#include "pipeline/evidence/region_priors.h"
#include "pipeline/footprints/load.h"
#include "pipeline/layer_file/layer_file.h"
#include "pipeline/layer_file/well_known_binary.h"
#include "pipeline/outputs/output.h"
#include "pipeline/outputs/plan/plan_picture.h"
#include "pipeline/picture/building_plan.h"
#include "pipeline/picture/image.h"
#include "pipeline/picture/plan.h"
#include "pipeline/picture/sheet.h"

namespace blockrand::run {

namespace {

namespace districts = districts;
using districts::Assignment;
using districts::Decision;
using districts::RuleSets;

constexpr int kMapPixels = 3000;  // a side
constexpr double kFinest = 6;     // pixels per metre

/// Told apart by eye; from the most frequent on. After M. Krzywinski's and K. Kelly's sets of contrasting colours.
constexpr model::Colour kColours[] = {{0xc2, 0x3b, 0x22}, {0x2f, 0x6d, 0xb3}, {0x3f, 0x9b, 0x4b}, {0xf0, 0xa0, 0x30},
                                      {0x8e, 0x5a, 0xa8}, {0x3c, 0xb4, 0xb4}, {0xe3, 0x77, 0xc2}, {0x8c, 0x56, 0x4b},
                                      {0xbc, 0xbd, 0x22}, {0x10, 0x4e, 0x5b}, {0xff, 0x8f, 0x7a}, {0x7f, 0xb2, 0xe5},
                                      {0x9c, 0xd6, 0x7f}, {0x5b, 0x2a, 0x2a}, {0xf5, 0xd0, 0x4c}, {0x4b, 0x3f, 0x8f},
                                      {0x6b, 0x6b, 0x3a}, {0xd6, 0x2f, 0x6f}, {0x00, 0x80, 0x60}, {0xc8, 0xa0, 0xd8},
                                      {0xa0, 0x60, 0x10}, {0x50, 0x70, 0x90}, {0x20, 0x30, 0x20}, {0xff, 0xc0, 0xa0}};
constexpr model::Colour kNothing{0xc8, 0xc8, 0xc8};  // no preset, or one of the rarest

std::string preset_of(const RuleSets& book, const Decision& d) {
  return d.preset == Decision::kNone ? "" : book.presets[d.preset].name;
}
std::string set_of(const RuleSets& book, const Decision& d) {
  return d.set == RuleSets::kNoSet ? "" : book.sets[d.set].name;
}
std::string rule_of(const RuleSets& book, const Decision& d) {
  return d.rule == Decision::kNone ? "" : book.sets[d.set].rules[d.rule].name;
}

std::string parameters_text(const Assignment& a) {
  std::string text;
  for (const districts::Parameter& p : a.parameters)
    text += fmt::format("{}{}={}", text.empty() ? "" : ", ", p.key, p.value);
  return text;
}

std::vector<layer_file::Column> columns() {
  using layer_file::ColumnKind;
  return {{"id", ColumnKind::text, "", "OSM id of the building"},
          {"rule_set", ColumnKind::text, "", "rule set that holds there"},
          {"rule", ColumnKind::text, "", "rule that chose the preset; empty where a tag did"},
          {"preset", ColumnKind::text, "", "grammar preset"},
          {"parameters", ColumnKind::text, "", "parameters that rules give it"},
          {"source", ColumnKind::text, "", "where the preset comes from"},
          {"confidence", ColumnKind::real, "", "from 0 to 1"},
          {"why", ColumnKind::text, "", "the rule's conditions as they hold here"},
          {"lost", ColumnKind::text, "", "presets of weaker rules"},
          {"fired", ColumnKind::text, "", "all rules whose conditions hold, strongest first"}};
}

std::string map_png(const DistrictSurvey& survey, const std::vector<std::uint32_t>& buildings,
                    const std::vector<std::string>& labels, std::string_view title) {
  std::map<std::string, std::uint64_t> counts;
  for (const std::string& l : labels) ++counts[l];
  std::vector<std::pair<std::string, std::uint64_t>> order(counts.begin(), counts.end());
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::map<std::string, model::Colour> colours;
  picture::SheetText text{
      .title = std::string(title),
      .below_title = {outputs::about_words(buildings.size(), survey.located.extract.data_time, survey.located.crs)},
      .legend = {},
      .metres_per_pixel = 0,
      .north = {},
      .attribution = outputs::kAttribution,
      .generator = outputs::generator()};
  for (const auto& [label, count] : order) {
    const std::size_t next = colours.size();
    const model::Colour colour = label.empty() || next >= std::size(kColours) ? kNothing : kColours[next];
    colours[label] = colour;
    text.legend.push_back({colour, fmt::format("{} ({})", label.empty() ? "none" : label, base::with_thousands(count)),
                           picture::LegendSign::area});
  }
  picture::PlanTile all;
  std::vector<std::string_view> label_of;
  for (std::size_t i = 0; i < buildings.size(); ++i)
    for (model::Polygon& p : survey.prepared->repaired.footprints.polygons(buildings[i])) {
      all.buildings.push_back(std::move(p));
      label_of.push_back(labels[i]);
    }
  const picture::PlanBox box = picture::box_of({&all, 1});
  if (!(box.width() > 0 && box.height() > 0)) return {};
  picture::Plan plan(box, std::min(kFinest, picture::scale_for(box, kMapPixels)), picture::kPlanPaper);
  for (const context::NetworkLine& line : survey.prepared->context.lines) {
    if (!context::is_street(line.kind) || line.tunnel || line.area) continue;
    const geometry::PlanBox b = geometry::box_of(line.points);
    if (b.maximum.x < box.min_x || b.minimum.x > box.max_x || b.maximum.y < box.min_y || b.minimum.y > box.max_y)
      continue;
    plan.stroke(line.points, 7, picture::kPlanStreet);
  }
  for (std::size_t i = 0; i < all.buildings.size(); ++i) plan.fill(all.buildings[i], colours[std::string(label_of[i])]);
  text.north =
      outputs::north_words(survey.located.projection, {(box.min_x + box.max_x) / 2, (box.min_y + box.max_y) / 2});
  text.metres_per_pixel = plan.metres_per_pixel();
  return picture::palette_png(picture::sheet(plan.image(), text, picture::kPlanPaper), 128);
}

}  // namespace

attributes::AssignInputs DistrictSurvey::inputs(const evidence::StyleExtract& styles) const {
  return {.extract = located.extract,
          .footprints = prepared->repaired.footprints,
          .context = prepared->context,
          .styles = styles,
          .projection = located.projection,
          .defaults = defaults,
          .neighbours = *neighbours,
          .neighbour_minimum = neighbour_minimum,
          .overrides = &overrides,
          .pinned = {},
          .seed = seed,
          .facts = &prepared->facts};
}

std::vector<std::uint32_t> DistrictSurvey::buildings() const {
  const footprints::FootprintStore& store = prepared->repaired.footprints;
  std::vector<std::uint32_t> out;
  for (std::uint32_t i = 0; i < store.size(); ++i)
    if (!store[i].box.empty() && store[i].settled == model::ObjectState::pending) out.push_back(i);
  std::sort(out.begin(), out.end(), [&](std::uint32_t a, std::uint32_t b) { return store[a].id < store[b].id; });
  return out;
}

std::unique_ptr<DistrictSurvey> survey_districts(const BuildOptions& options, const attributes::ReadRuleSets& rules,
                                                 base::Progress& progress) {
  attributes::Defaults defaults = attributes::read_defaults(options.configs);
  attributes::Overrides overrides;
  if (!options.overrides.empty()) {
    attributes::OverrideNames names{{}, rules.book.substyles};
    for (const districts::Preset& p : rules.book.presets) names.presets.push_back(p.name);
    overrides = attributes::read_overrides(options.overrides, defaults, names);
  }
  std::unique_ptr<DistrictSurvey> survey(new DistrictSurvey{.located = locate_extract(options, {}, progress),
                                                            .prepared = {},
                                                            .defaults = std::move(defaults),
                                                            .overrides = std::move(overrides),
                                                            .neighbours = {},
                                                            .positions = {},
                                                            .seed = options.seed,
                                                            .neighbour_minimum = options.generate.neighbour_minimum,
                                                            .tables = classify::Tables::read(options.configs)});
  model::Report unmatched;
  attributes::apply_overrides(survey->overrides, survey->located.extract, unmatched);
  for (const model::ReportRow& row : unmatched.rows) progress.warn(row.object.text() + ": " + row.detail);
  survey->prepared.emplace(prepare_extract(survey->located, options, {}, survey->tables, rules.book, progress));
  survey->neighbours.emplace(
      attributes::tagged_buildings(survey->located.extract, survey->defaults, survey->located.projection),
      options.generate.neighbour_reach);
  for (const evidence::BuildingPlace& p : survey->prepared->facts.places) survey->positions.push_back(p.position);
  return survey;
}

DistrictView show_districts(const DistrictSurvey& survey, const RuleSets& book, bool by_rule,
                            base::StagedFolder& folder, int workers, base::Progress& progress) {
  const attributes::DistrictAssigner assigner(book, survey.inputs(survey.prepared->styles));
  const std::vector<Decision> decisions = attributes::assign_extract(assigner, survey.positions, workers, progress);
  const std::vector<std::uint32_t> buildings = survey.buildings();
  progress.begin("map");
  DistrictView view;
  view.buildings = buildings.size();
  view.unanswered = assigner.unanswered();
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::uint64_t> counts;
  std::set<std::pair<std::uint32_t, std::uint32_t>> fired, chosen;
  std::set<std::uint32_t> sets;
  std::vector<std::string> labels;

  layer_file::LayerSpec layer{"districts", layer_file::GeometryKind::multi_polygon, columns(),
                              std::string("What district rules choose for each building. ") + outputs::kAttribution};
  layer_file::LayerFile file(folder.staging_path() + "/districts.gpkg",
                             {survey.located.crs.authority_code, survey.located.extract.data_time}, {layer});
  layer_file::CellTable table;
  for (const std::uint32_t b : buildings) {
    const Decision& d = decisions[b];
    ++counts[{d.set, d.rule, d.preset}];
    if (d.set != RuleSets::kNoSet) sets.insert(d.set);
    if (d.rule != Decision::kNone) chosen.emplace(d.set, d.rule);
    view.without += d.preset == Decision::kNone;
    labels.push_back(by_rule ? rule_of(book, d) : preset_of(book, d));
    const Assignment a = assigner.assign(b, survey.positions[b]);
    std::string all_fired;
    for (const std::uint32_t r : a.fired) {
      fired.emplace(d.set, r);
      all_fired += (all_fired.empty() ? "" : "; ") + book.sets[d.set].rules[r].name;
    }
    std::string other_candidates;
    for (const model::Candidate& c : a.other_candidates)
      other_candidates += fmt::format("{}{} ({:.2f})", other_candidates.empty() ? "" : ", ", c.value, c.confidence);
    layer_file::RowWriter row(table, layer.columns.size());
    row.text(survey.prepared->repaired.footprints[b].id.text());
    row.text(set_of(book, d));
    row.text(rule_of(book, d));
    row.text(preset_of(book, d));
    row.text(parameters_text(a));
    row.text(model::name(d.source));
    row.real(static_cast<double>(d.confidence));
    row.text(a.why);
    row.text(other_candidates);
    row.text(all_fired);
    layer_file::append_multi_polygon(row.geometry(), survey.prepared->repaired.footprints.polygons(b));
    row.end_row();
    if (table.rows() >= 4096) {
      file.put(0, table);
      table = {};
    }
  }
  if (table.rows() > 0) file.put(0, table);
  file.close();
  folder.adopt("districts.gpkg");

  for (const auto& [key, n] : counts) {
    const Decision d{std::get<0>(key), std::get<2>(key), std::get<1>(key)};
    view.counts.push_back({set_of(book, d), rule_of(book, d), preset_of(book, d), n});
  }
  for (const std::uint32_t set : sets)
    for (std::uint32_t r = 0; r < book.sets[set].rules.size(); ++r) {
      const std::string name = book.sets[set].name + ": " + book.sets[set].rules[r].name;
      if (!fired.contains({set, r}))
        view.silent_rules.push_back(name);
      else if (!book.sets[set].rules[r].presets.empty() && !chosen.contains({set, r}))
        view.idle_rules.push_back(name);
    }
  nlohmann::ordered_json j;
  j["attribution"] = outputs::kAttribution;
  j["extract"] = survey.located.extract.file;
  j["data_time"] = survey.located.extract.data_time;
  j["buildings"] = view.buildings;
  j["without_preset"] = view.without;
  j["counts"] = nlohmann::ordered_json::array();
  for (const DistrictCount& c : view.counts)
    j["counts"].push_back({{"rule_set", c.set}, {"rule", c.rule}, {"preset", c.preset}, {"buildings", c.buildings}});
  j["silent_rules"] = view.silent_rules;
  j["idle_rules"] = view.idle_rules;
  j["unanswered"] = view.unanswered;
  folder.write("districts.json", j.dump(1) + "\n");
  if (const std::string png = map_png(
          survey, buildings, labels, by_rule ? "Buildings by the rule that chose their preset" : "Buildings by preset");
      !png.empty())
    folder.write("map.png", png);
  progress.end();
  return view;
}

std::vector<DistrictChange> diff_districts(const DistrictSurvey& survey, const RuleSets& a, const RuleSets& b,
                                           int workers, base::Progress& progress) {
  const PreparedExtract& prepared = *survey.prepared;
  const evidence::StyleExtract by_b = evidence::classify_extract(
      prepared.facts, prepared.tags, survey.tables,
      evidence::prior_by_place(survey.located.extract, prepared.repaired.footprints, b, survey.tables), {}, workers,
      progress);
  const attributes::DistrictAssigner first(a, survey.inputs(prepared.styles)), second(b, survey.inputs(by_b));
  std::vector<DistrictChange> out;
  for (const std::uint32_t building : survey.buildings()) {
    const Assignment x = first.assign(building, survey.positions[building]),
                     y = second.assign(building, survey.positions[building]);
    DistrictChange change{.id = prepared.repaired.footprints[building].id,
                          .preset_a = preset_of(a, x.decision),
                          .preset_b = preset_of(b, y.decision),
                          .rule_a = rule_of(a, x.decision),
                          .rule_b = rule_of(b, y.decision),
                          .parameters_a = parameters_text(x),
                          .parameters_b = parameters_text(y)};
    if (change.preset_a != change.preset_b || change.parameters_a != change.parameters_b)
      out.push_back(std::move(change));
  }
  return out;
}

}  // namespace blockrand::run
