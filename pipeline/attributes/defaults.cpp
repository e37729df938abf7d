#include "pipeline/attributes/defaults.h"

#include <algorithm>
#include <optional>
#include <set>

#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"

namespace blockrand::attributes {

namespace {

using base::TomlTable;

std::vector<model::Colour> palette(const TomlTable& table, std::string_view key,
                                   const std::vector<std::string>& texts) {
  std::vector<model::Colour> out;
  for (const std::string& text : texts) {
    const auto colour = model::colour_of_hex(text);
    if (!colour) table.fail(key, "`" + text + "` is no colour", "Write it as #rrggbb");
    out.push_back(*colour);
  }
  if (out.empty()) table.fail(key, "the palette is empty", "Give at least one colour as #rrggbb");
  return out;
}

constexpr const char* kGroups[] = {"commercial", "industrial", "other",      "outbuilding",
                                   "public",     "religious",  "residential"};

/// Overwrites in `use` what the table says. `like` was applied before.
void read_use(TomlTable& table, UseDefaults& use, const Defaults& defaults) {
  if (const auto group = table.text("group")) {
    const auto found = std::find(defaults.groups.begin(), defaults.groups.end(), *group);
    if (found == defaults.groups.end()) {
      std::string known;
      for (const std::string& g : defaults.groups) known += (known.empty() ? "" : ", ") + g;
      table.fail("group", "unknown group `" + *group + "`", "Known groups: " + known);
    }
    use.group = static_cast<std::uint8_t>(found - defaults.groups.begin());
  }
  if (const auto v = table.number("storeys", 0.5, 150)) use.storeys = *v;
  if (const auto v = table.number("storey_height", 1.5, 60)) use.storey_height = *v;
  if (const auto v = table.boolean("hall")) use.hall = *v;
  if (const auto v = table.number("eaves_per_width", 0, 5)) use.eaves_per_width = *v;
  if (const auto v = table.number("lowest_eaves", 1, 60)) use.lowest_eaves = *v;
  if (const auto v = table.number("highest_eaves", 1, 60)) use.highest_eaves = *v;
  if (use.lowest_eaves > use.highest_eaves)
    table.fail("lowest_eaves", "the lowest eaves are above the highest", "Give lowest_eaves <= highest_eaves");
  if (const auto v = table.number("roof_pitch", 1, 80)) use.roof_pitch = *v;
  if (const auto v = table.number("pitched_width", 1, 200)) use.pitched_width = *v;
  if (const auto shape = table.text("roof_shape")) {
    const auto known = model::roof_shape(*shape);
    if (!known) {
      const std::vector<std::string> names(std::begin(model::kRoofShapeNames), std::end(model::kRoofShapeNames));
      const std::string near = base::nearest(*shape, names);
      table.fail("roof_shape", "unknown roof shape `" + *shape + "`",
                 near.empty() ? "" : "Did you mean `" + near + "`?");
    }
    use.roof_shape = *known;
  }
  const auto material = [&](std::string_view key, std::string& target) {
    const auto value = table.text(key);
    if (!value) return;
    if (defaults.material(*value) < 0)
      table.fail(key, "unknown material `" + *value + "`", "Add it to configs/materials/materials.toml");
    target = defaults.materials[static_cast<std::size_t>(defaults.material(*value))].material_class.name;
  };
  material("wall_material", use.wall_material);
  material("roof_material", use.roof_material);
  material("flat_roof_material", use.flat_roof_material);
  if (const auto v = table.texts("wall_colours")) use.wall_colours = palette(table, "wall_colours", *v);
  if (const auto v = table.texts("roof_colours")) use.roof_colours = palette(table, "roof_colours", *v);
}

void read_materials(const std::string& path, Defaults& out) {
  TomlTable file = TomlTable::read(path);
  auto classes = file.table("class");
  if (!classes) file.fail("class", "no [class.…] table", "Define at least one material class");
  for (const std::string& name : classes->keys()) {
    TomlTable table = *classes->table(name);
    Material material;
    material.material_class.name = name;
    if (const auto v = table.number("roughness", 0, 1)) material.material_class.roughness = static_cast<float>(*v);
    if (const auto v = table.number("metallic", 0, 1)) material.material_class.metallic = static_cast<float>(*v);
    const auto colour = table.text("colour");
    if (!colour) table.fail("colour", "no colour", "Write colour = \"#rrggbb\"");
    material.colour = palette(table, "colour", {*colour})[0];
    out.pigments.most_saturated.push_back(table.number("saturation", 0, 1).value_or(1));
    if (out.materials.size() >= 255) table.fail("", "more than 255 material classes", "Merge some");
    const auto index = static_cast<std::uint8_t>(out.materials.size());
    out.material_by_value[name] = index;
    if (const auto values = table.texts("values"))
      for (const std::string& value : *values)
        if (!out.material_by_value.emplace(value, index).second && out.material_by_value[value] != index)
          table.fail("values", "`" + value + "` belongs to two classes", "Keep it in one");
    table.finish();
    out.materials.push_back(std::move(material));
  }
  classes->finish();
  Pigments pigments = read_pigments(file, [&](std::string_view name) { return out.material(name); });
  pigments.most_saturated = std::move(out.pigments.most_saturated);
  out.pigments = std::move(pigments);
  file.finish();
}

}  // namespace

const UseDefaults& Defaults::use(std::string_view building_value) const {
  const auto found = uses.find(building_value);
  return found == uses.end() ? fallback : found->second;
}

int Defaults::material(std::string_view value) const {
  const auto found = material_by_value.find(value);
  return found == material_by_value.end() ? -1 : found->second;
}

Defaults read_defaults(const std::string& configs) {
  Defaults out;
  out.groups.assign(std::begin(kGroups), std::end(kGroups));
  read_materials(configs + "/materials/materials.toml", out);

  TomlTable file = TomlTable::read(configs + "/defaults/uses.toml");
  auto base_table = file.table("default");
  if (!base_table) file.fail("default", "no [default] table", "It holds what is assumed of unknown buildings");
  out.fallback.name = "default";
  read_use(*base_table, out.fallback, out);
  base_table->finish();
  if (out.fallback.wall_material.empty() || out.fallback.roof_material.empty() ||
      out.fallback.flat_roof_material.empty() || out.fallback.wall_colours.empty() || out.fallback.roof_colours.empty())
    file.fail("default", "[default] is incomplete",
              "It needs wall_material, roof_material, flat_roof_material, wall_colours and roof_colours");

  if (auto uses = file.table("use")) {
    const std::vector<std::string> names = uses->keys();
    // `like` may name a table further down; each is resolved when first needed, and circles are an error.
    std::set<std::string> under_way;
    const auto resolve = [&](const auto& self, const std::string& name) -> const UseDefaults& {
      if (const auto done = out.uses.find(name); done != out.uses.end()) return done->second;
      TomlTable table = *uses->table(name);
      if (!under_way.insert(name).second) table.fail("like", "`" + name + "` is like itself", "Break the circle");
      UseDefaults use = out.fallback;
      if (const auto like = table.text("like")) {
        if (std::find(names.begin(), names.end(), *like) == names.end()) {
          const std::string near = base::nearest(*like, names);
          table.fail("like", "no use `" + *like + "`", near.empty() ? "" : "Did you mean `" + near + "`?");
        }
        use = self(self, *like);
      }
      use.name = name;
      read_use(table, use, out);
      table.finish();
      under_way.erase(name);
      return out.uses.emplace(name, std::move(use)).first->second;
    };
    for (const std::string& name : names) resolve(resolve, name);
    uses->finish();
  }
  out.small = out.fallback;
  if (auto small = file.table("small")) {
    if (const auto like = small->text("like")) {
      if (!out.uses.contains(*like)) small->fail("like", "no use `" + *like + "`", "Name a [use.…] table");
      out.small = out.use(*like);
    }
    if (const auto v = small->number("largest_area", 0, 1000)) out.small_area = *v;
    small->finish();
  }
  file.finish();
  return out;
}

}  // namespace blockrand::attributes
