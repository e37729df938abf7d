#include "pipeline/textures/texture_catalogue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <utility>

#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"

namespace blockrand::textures {
namespace {

using base::TomlTable;

struct PatternWord {
  const char* word;
  Pattern pattern;
  int courses;  ///< after which the pattern repeats
  bool laid;    ///< of stones, tiles or boards whose height the row must give
};
constexpr std::array<PatternWord, 19> kPatterns{{
    {"plaster", Pattern::plaster, 1, false},
    {"bond", Pattern::bond, 2, true},
    {"cross_bond", Pattern::cross_bond, 4, true},
    {"ashlar", Pattern::ashlar, 2, true},
    {"rubble", Pattern::rubble, 2, true},
    {"cyclopean", Pattern::cyclopean, 1, true},
    {"concrete", Pattern::concrete, 1, false},
    {"boards", Pattern::boards, 1, true},
    {"metal", Pattern::metal, 1, false},
    {"pantiles", Pattern::pantiles, 1, true},
    {"plain_tiles", Pattern::plain_tiles, 2, true},
    {"slates", Pattern::slates, 2, true},
    {"felt", Pattern::felt, 1, false},
    {"grains", Pattern::grains, 1, true},
    {"soil", Pattern::soil, 1, true},
    {"setts", Pattern::setts, 2, true},
    {"cobbles", Pattern::cobbles, 1, true},
    {"flags", Pattern::flags, 2, true},
    {"grass", Pattern::grass, 1, true},
}};

constexpr std::array<const char*, 3> kSurfaceKeys{"walls", "roofs", "grounds"};  // in the order of Surface

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text;
  try {
    if (file) text.assign(std::istreambuf_iterator<char>(file), {});
  } catch (const std::ios_base::failure&) {
    file.setstate(std::ios::failbit);  // a folder of that name
  }
  if (!file) throw base::InputError(path, "", "cannot be read", "Check the path and the file's permissions");
  return text;
}

const PatternWord& read_pattern(TomlTable& table) {
  const std::string word = table.text("pattern").value_or("");
  std::vector<std::string> known;
  for (const PatternWord& row : kPatterns) {
    if (word == row.word) return row;
    known.emplace_back(row.word);
  }
  const std::string remedy = "Give a pattern of pipeline/textures/texture.h";
  if (word.empty()) table.fail("pattern", "is missing", remedy);
  const std::string near = base::nearest(word, known);
  table.fail("pattern", "is unknown: `" + word + "`", near.empty() ? remedy : "Did you mean `" + near + "`?");
}

/// An error unless `whole` is a whole number of `part`.
void check_repeats(const TomlTable& table, const char* whole_key, double whole, const char* part_key, double part,
                   int multiple) {
  if (part <= 0) return;
  // Sizes are written with at most six decimals, a third of a metre is not exact: a part of 0.1 mm of rest shows nowhere.
  constexpr double kRest = 1e-4;  // m
  const double count = std::round(whole / part);
  if (count < 1 || std::abs(count * part - whole) > kRest)
    table.fail(whole_key, std::string("is no whole number of `") + part_key + "`",
               "Stones would be cut where it repeats");
  if (static_cast<long long>(count) % multiple != 0)
    table.fail(whole_key, "has " + std::to_string(static_cast<long long>(count)) + " courses",
               "The pattern repeats after " + std::to_string(multiple) + " of them");
}

TextureRow read_row(const std::string& name, TomlTable& table) {
  TextureRow row;
  row.name = name;
  if (name.empty() || name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") != std::string::npos)
    table.fail("", "has a name that is no file's", "Take letters a to z and _");
  const PatternWord& pattern = read_pattern(table);
  row.pattern = pattern.pattern;
  // Largest and smallest: what a picture of 4096 pixels can show, and what does not look the same all over.
  const auto given = [&](const char* key, double& value, double least, double most) {
    if (const auto number = table.number(key, least, most)) value = *number;
  };
  given("width", row.width, 0.1, 20);
  given("height", row.height, 0.1, 20);
  given("stone_width", row.stone_width, 0, 20);
  given("stone_height", row.stone_height, 0, 20);
  given("joint", row.joint, 0, 0.2);
  given("depth", row.depth, 0, 0.2);
  given("contrast", row.contrast, 0, 1);
  given("roughness", row.roughness, 0, 1);
  given("metallic", row.metallic, 0, 1);
  constexpr std::int64_t kLeastPixels = 16, kMostPixels = 4096;
  if (const auto pixels = table.integer("pixels", kLeastPixels, kMostPixels)) row.pixels = static_cast<int>(*pixels);
  if ((row.pixels & (row.pixels - 1)) != 0) table.fail("pixels", "is no power of two", "Take 256, 512 or 1024");
  if (pattern.laid && row.stone_width <= 0)
    table.fail("stone_width", "is missing", "Give the width in metres of what the pattern lays");
  if (pattern.laid && row.stone_height <= 0)
    table.fail("stone_height", "is missing", "Give the height in metres of what the pattern lays");
  if (row.stone_width <= 0 && (row.pattern == Pattern::metal || row.pattern == Pattern::felt))
    table.fail("stone_width", "is missing", "Give the width of a sheet in metres");
  check_repeats(table, "width", row.width, "stone_width", row.stone_width, 1);
  check_repeats(table, "height", row.height, "stone_height", row.stone_height, pattern.courses);
  const double least = std::min(row.stone_width, row.stone_height);
  if (least > 0 && row.joint >= least) table.fail("joint", "is wider than what it parts", "Give it in metres");
  return row;
}

}  // namespace

TextureCatalogue TextureCatalogue::read(const std::string& path) { return parse(text_of(path), path); }

TextureCatalogue TextureCatalogue::parse(std::string_view text, const std::string& path) {
  TextureCatalogue out;
  TomlTable file = TomlTable::parse(text, path);
  auto textures = file.table("texture");
  if (!textures) file.fail("texture", "is missing", "Give one row of it at least");
  std::vector<std::string> names = textures->keys();
  std::stable_sort(names.begin(), names.end(),
                   [&](const std::string& a, const std::string& b) { return textures->line(a) < textures->line(b); });
  for (const std::string& name : names) {
    if (!textures->holds_table(name)) textures->fail(name, "is no table", "Write it as [texture." + name + "]");
    TomlTable table = *textures->table(name);
    out.rows_.push_back(read_row(name, table));
    const int index = static_cast<int>(out.rows_.size()) - 1;
    for (std::size_t surface = 0; surface < kSurfaceKeys.size(); ++surface)
      for (const std::string& material : table.texts(kSurfaceKeys[surface]).value_or(std::vector<std::string>{})) {
        const auto [place, fresh] = out.by_material_[surface].emplace(material, index);
        if (!fresh)
          table.fail(kSurfaceKeys[surface],
                     "has `" + material + "`, which `" + out.rows_[place->second].name + "` has already",
                     "Keep it in one texture");
      }
    table.finish();
  }
  textures->finish();
  file.finish();
  return out;
}

int TextureCatalogue::find(Surface surface, std::string_view material) const {
  const auto& rows = by_material_[static_cast<std::size_t>(surface)];
  const auto found = rows.find(material);
  return found == rows.end() ? -1 : found->second;
}

std::vector<std::string> TextureCatalogue::materials(Surface surface) const {
  std::vector<std::string> out;
  for (const auto& [material, index] : by_material_[static_cast<std::size_t>(surface)]) out.push_back(material);
  return out;
}

}  // namespace blockrand::textures
