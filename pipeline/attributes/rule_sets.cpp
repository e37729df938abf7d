#include "pipeline/attributes/rule_sets.h"

#include <algorithm>
#include <filesystem>

#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"
#include "styles/classify/catalogue.h"
#include "styles/districts/read_rule_set.h"

namespace blockrand::attributes {

namespace fs = std::filesystem;

namespace {

/// The files of the sets that a set builds on, the vector files that its rules name, and what stands beside a
/// Shapefile: its attributes and its CRS. One that does not exist is told by who reads it.
void add_named_files(const districts::RuleSet& set, const std::string& configs, ReadRuleSets& out) {
  const auto add = [&](const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return;
    // Where configs lie differs between installations.
    const fs::path inside = path.lexically_relative(fs::path(configs).lexically_normal());
    const std::string name = inside.empty() || *inside.begin() == ".." ? path.string() : inside.generic_string();
    const std::pair<std::string, std::string> file{name, path.string()};
    if (std::find(out.files.begin(), out.files.end(), file) == out.files.end()) out.files.push_back(file);
  };
  for (const std::string& base : set.bases) add(fs::path(base).lexically_normal());
  for (const districts::PlaceQuery& q : set.queries) {
    if (q.kind != districts::PlaceQuery::Kind::file) continue;
    fs::path path(q.file);
    std::error_code error;
    if (fs::is_directory(path, error)) {  // a file geodatabase
      std::vector<fs::path> inside;
      for (const fs::directory_entry& entry : fs::directory_iterator(path)) inside.push_back(entry.path());
      std::sort(inside.begin(), inside.end());
      for (const fs::path& p : inside) add(p);
      continue;
    }
    add(path);
    if (path.extension() == ".shp")
      for (const char* beside : {".cpg", ".dbf", ".prj", ".shx"}) add(path.replace_extension(beside));
  }
}

/// \throws base::InputError  a class of appearance keeps no sub-style
void check_absent(const districts::RuleSet& set, const classify::Catalogue& catalogue) {
  for (int c = 0; c < model::kStyleClassCount; ++c) {
    const auto left = [&](std::uint8_t i) {
      return std::find(set.prior.absent.begin(), set.prior.absent.end(), catalogue[i].id) == set.prior.absent.end();
    };
    const auto of_class = catalogue.of_class(static_cast<model::StyleClass>(c));
    if (!of_class.empty() && std::none_of(of_class.begin(), of_class.end(), left))
      throw base::InputError(
          set.file, "[prior] absent",
          "leaves no sub-style to the class " + std::string(model::name(static_cast<model::StyleClass>(c))),
          "Keep at least one");
  }
}

}  // namespace

ReadRuleSets read_rule_sets(const std::string& configs, const std::string& districts) {
  ReadRuleSets out;
  std::error_code error;
  const fs::path presets = fs::path(configs) / "styles" / "presets.toml", folder = fs::path(configs) / "districts";
  if (fs::exists(presets, error)) {
    out.book.presets = districts::read_presets(presets.string());
    out.files.emplace_back("styles/presets.toml", presets.string());
  }
  classify::Catalogue catalogue{{}};
  if (fs::exists(fs::path(configs) / "styles" / "catalogue.toml", error)) {
    catalogue = classify::read_catalogue(configs);
    for (std::size_t i = 0; i < catalogue.size(); ++i) out.book.substyles.push_back(catalogue[i].id);
    out.files.emplace_back("styles/catalogue.toml", (fs::path(configs) / "styles" / "catalogue.toml").string());
  }
  std::vector<fs::path> sets;
  if (fs::is_directory(folder, error))
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".toml") sets.push_back(entry.path());
  std::sort(sets.begin(), sets.end());

  if (!districts.empty()) {
    const auto named = std::find_if(sets.begin(), sets.end(), [&](const fs::path& p) { return p.stem() == districts; });
    fs::path file = named != sets.end() ? *named : fs::path(districts);
    if (named == sets.end() && !fs::is_regular_file(file, error)) {
      std::vector<std::string> names;
      std::string all;
      for (const fs::path& p : sets) {
        names.push_back(p.stem().string());
        all += (all.empty() ? "" : ", ") + names.back();
      }
      const std::string near = base::nearest(districts, names);
      throw base::UsageError("--districts " + districts + ": there is no such rule set and no such file. " +
                             (near.empty() ? "Known: " + all : "Did you mean " + near + "?"));
    }
    districts::read_rule_set(file.string(), out.book, folder.string());
    check_absent(out.book.sets.back(), catalogue);
    out.book.sets.back().polygon.clear();  // who names a set means it for everything
    out.files.emplace_back(named != sets.end() ? "districts/" + file.filename().string() : districts, file.string());
    add_named_files(out.book.sets.back(), configs, out);
    return out;
  }
  const districts::RuleSet* anywhere = nullptr;
  out.book.sets.reserve(sets.size());
  for (const fs::path& file : sets) {
    districts::read_rule_set(file.string(), out.book);
    const std::pair<std::string, std::string> name{"districts/" + file.filename().string(), file.lexically_normal()};
    if (std::find(out.files.begin(), out.files.end(), name) == out.files.end()) out.files.push_back(name);
    const districts::RuleSet& set = out.book.sets.back();
    check_absent(set, catalogue);
    add_named_files(set, configs, out);
    if (!set.polygon.empty()) continue;
    if (anywhere)
      throw base::InputError(file.string(), "", "has no polygon, and neither has " + anywhere->file,
                             "One rule set can hold everywhere; give the other one a polygon");
    anywhere = &set;
  }
  return out;
}

}  // namespace blockrand::attributes
