#include "styles/districts/presets.h"

#include <algorithm>
#include <cmath>

#include "pipeline/base/toml_file.h"

namespace blockrand::districts {
namespace {

constexpr double kShareSlack = 0.01;  // of shares that shall sum to 1

PresetMeasures read_measures(base::TomlTable& table) {
  PresetMeasures out;
  out.ground_floor_height = table.number("ground_floor_height", 2, 10);
  out.storey_height = table.number("storey_height", 2, 10);
  out.plinth = table.number("plinth", 0, 3);
  out.roof_pitch = table.number("roof_pitch", 1, 85);
  if (const auto text = table.text("roof_pitches")) {
    const auto pitches = model::parse_side_pitches(*text);
    if (!pitches) table.fail("roof_pitches", pitches.error(), "Write roof_pitches = \"street 60, yard 30\".");
    out.side_pitches = *pitches;
  }
  out.gable_to_street = table.boolean("gable_to_street");
  if (auto shares = table.table("roof")) {
    double sum = 0;
    for (const std::string& name : shares->keys()) {
      const auto shape = model::roof_shape(name);
      if (!shape) shares->fail(name, "is no shape of a roof", "docs/roofs.md lists them.");
      out.roof_shapes.emplace_back(*shape, shares->number(name, 0, 1).value_or(0));
      sum += out.roof_shapes.back().second;
    }
    shares->finish();
    if (std::abs(sum - 1) > kShareSlack)
      table.fail("roof", "has shares that do not sum to 1", "They are of all roofs.");
  }
  table.finish();
  return out;
}

PresetRequirements read_requirements(base::TomlTable& table) {
  PresetRequirements out;
  out.upper_storeys = table.numbers("upper_storeys").value_or(std::vector<double>{});
  if (!out.upper_storeys.empty() && (out.upper_storeys.size() != 2 || out.upper_storeys[0] > out.upper_storeys[1]))
    table.fail("upper_storeys", "is no range", "Write [least, most].");
  out.upper_windows_from = table.number("upper_windows_from", 0, 20);
  out.door_height = table.number("door_height", 0, 10);
  out.window_ratio = table.number("window_ratio", 0, 10);
  out.ground_window_ratio = table.number("ground_window_ratio", 0, 10);
  out.gable_window_ratio = table.number("gable_window_ratio", 0, 10);
  out.windows_in_line = table.boolean("windows_in_line").value_or(false);
  out.gable_windows_smaller = table.boolean("gable_windows_smaller").value_or(false);
  out.ornamental_gable = table.boolean("ornamental_gable");
  out.gable_overtop = table.number("gable_overtop", 0, 5);
  for (const std::string& name : table.texts("roof_shapes").value_or(std::vector<std::string>{})) {
    const auto shape = model::roof_shape(name);
    if (!shape) table.fail("roof_shapes", "`" + name + "` is no shape of a roof", "docs/roofs.md lists them.");
    out.roof_shapes.push_back(*shape);
  }
  out.roof_element_width = table.number("roof_element_width", 0, 50);
  out.roof_element_distance = table.number("roof_element_distance", 0, 50);
  out.roof_eaves_distance = table.number("roof_eaves_distance", 0, 50);
  out.roof_side_distance = table.number("roof_side_distance", 0, 50);
  table.finish();
  return out;
}

}  // namespace

Preset read_preset(const std::string& name, base::TomlTable table) {
  Preset preset;
  preset.name = name;
  preset.description = table.text("description").value_or("");
  if (preset.description.empty())
    table.fail("description", "is missing", "Say in one line what the preset looks like.");
  const std::string style = table.text("class").value_or("");
  const auto found = std::find(model::kStyleClassNames.begin(), model::kStyleClassNames.end(), style);
  if (found == model::kStyleClassNames.end())
    table.fail("class", "is no class of appearance", "Write gruenderzeit, tenement, modern or other.");
  preset.style = static_cast<model::StyleClass>(found - model::kStyleClassNames.begin());
  preset.substyles = table.texts("substyles").value_or(std::vector<std::string>{});
  preset.grammar = table.text("grammar").value_or("");
  preset.roof_grammar = table.text("roof_grammar");
  if (const auto shape = table.text("initial_shape")) {
    if (*shape != "wall" && *shape != "footprint")
      table.fail("initial_shape", "is unknown: '" + *shape + "'", "Write wall or footprint.");
    preset.on_footprint = *shape == "footprint";
    if (*preset.on_footprint && preset.roof_grammar)
      table.fail("roof_grammar", "is read by nothing: rules that begin on a footprint make the roof as well",
                 "Leave it out.");
  }
  if (auto values = table.table("attributes")) {
    for (const std::string& key : values->keys()) preset.attributes.emplace_back(key, values->text(key).value_or(""));
    values->finish();
  }
  if (auto measures = table.table("measures")) preset.measures = read_measures(*measures);
  if (auto asked = table.table("requirements")) preset.requirements = read_requirements(*asked);
  table.finish();
  return preset;
}

std::vector<Preset> read_presets(const std::string& path) {
  base::TomlTable root = base::TomlTable::read(path);
  std::vector<Preset> out;
  for (const std::string& name : root.keys()) out.push_back(read_preset(name, *root.table(name)));
  root.finish();
  return out;
}

std::size_t find_preset(const std::vector<Preset>& presets, std::string_view name) {
  const auto found = std::find_if(presets.begin(), presets.end(), [&](const Preset& p) { return p.name == name; });
  return found != presets.end() ? static_cast<std::size_t>(found - presets.begin()) : kNoPreset;
}

}  // namespace blockrand::districts
