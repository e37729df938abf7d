#include "styles/districts/presets.h"

#include <algorithm>

#include "pipeline/base/toml_file.h"

namespace blockrand::districts {

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
  if (auto values = table.table("attributes")) {
    for (const std::string& key : values->keys()) preset.attributes.emplace_back(key, values->text(key).value_or(""));
    values->finish();
  }
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
