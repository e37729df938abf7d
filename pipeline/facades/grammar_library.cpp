#include "pipeline/facades/grammar_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "pipeline/base/error.h"
#include "pipeline/facades/facade_context.h"
#include "pipeline/facades/masonry_orders.h"
#include "pipeline/facades/rule_geometry.h"
#include "pipeline/model/element.h"

namespace blockrand::facades {
namespace {

/// Characters; the rest of the errors would not be read.
constexpr std::size_t kMostErrorText = 2000;
/// Rules for the roofs of presets that name none.
constexpr const char* kUsualRoofRules = "roofscape.cga";

std::optional<std::string> read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> list_folder(const std::string& folder) {
  std::vector<std::string> out;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    out.push_back(entry.path().filename().string());
  std::sort(out.begin(), out.end());
  return out;
}

/// Whether rules begin on what published files begin on: a lot or a footprint.
bool begins_on_lot(const grammar::Program& program) {
  constexpr std::string_view kLots[] = {"Lot", "LotInner", "LotCorner", "Parcel", "Footprint"};
  return program.start_rule != grammar::kNone &&
         std::ranges::find(kLots, program.qualified_name(program.definitions[program.start_rule])) != std::end(kLots);
}

}  // namespace

std::vector<grammar::ExtensionOperation> extension_operations(const elements::ElementCatalogue& catalogue) {
  // The first three take all kinds of their class; the others those that are named after what they make
  // (docs/rule_language.md §7.1).
  struct Named {
    const char* name;
    std::vector<std::string> kinds;
  };
  const std::vector<Named> named{{"window", {}},
                                 {"door", {}},
                                 {"element", {}},
                                 {"balcony", {"balcony"}},
                                 {"bay", {"bay"}},
                                 {"cornice", {"main_cornice", "string_course", "plinth", "sill"}},
                                 {"opening", {"reveal", "cellar_window"}},
                                 {"quoin", {"quoin", "pilaster"}}};
  std::vector<grammar::ExtensionOperation> out(named.size());
  for (std::size_t i = 0; i < named.size(); ++i) out[i].name = named[i].name;
  std::vector<std::set<std::string>> parameters(named.size());
  for (const elements::ElementKind& kind : catalogue.kinds()) {
    const std::size_t which = kind.semantic == model::ElementClass::window ? 0
                              : kind.semantic == model::ElementClass::door ? 1
                                                                           : 2;
    for (std::size_t i = 0; i < named.size(); ++i) {
      if (i != which && std::find(named[i].kinds.begin(), named[i].kinds.end(), kind.name) == named[i].kinds.end())
        continue;
      out[i].kinds.push_back(kind.name);
      for (const elements::ParameterInfo& p : kind.parameters) parameters[i].insert(p.name);
      for (const std::string_view part : model::kElementPartNames) parameters[i].insert(std::string(part) + "_colour");
    }
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i].parameters.assign(parameters[i].begin(), parameters[i].end());
  grammar::ExtensionOperation& paint = out.emplace_back();
  paint.name = kPaintOperation;
  paint.kinds = {"wall"};
  paint.parameters = {"colour", "material", "storey"};
  return out;
}

struct GrammarLibrary::File {
  std::string path;
  grammar::Program program;
  bool makes_geometry = false;
  bool begins_on_lot = false;  ///< as its start rule is called
  std::optional<grammar::Deriver> deriver;
};

GrammarLibrary::GrammarLibrary(const std::string& folder, std::span<const PresetGrammar> presets,
                               elements::ElementCatalogue elements)
    : elements_(std::move(elements)) {
  grammar::LoadOptions options;
  options.roots = {folder};
  options.read = read_file;
  options.list = list_folder;
  grammar::CheckOptions check_options;
  check_options.extensions = extension_operations(elements_);
  for (const ContextAttribute& attribute : context_attributes()) check_options.context.emplace_back(attribute.name);
  const auto file_of = [&](const std::string& name, const std::string& beside) {
    std::filesystem::path place = std::filesystem::path(folder) / name;
    if (!beside.empty() && std::filesystem::exists(std::filesystem::path(beside) / name))
      place = std::filesystem::path(beside) / name;
    const std::string path = place.string();
    auto file = std::find_if(files_.begin(), files_.end(), [&](const auto& f) { return f->path == path; });
    if (file == files_.end()) {
      auto read = std::make_unique<File>();
      read->path = path;
      read->program = grammar::load(path, options);
      std::string errors;
      std::vector<grammar::Diagnostic> told = read->program.diagnostics;
      if (!grammar::has_errors(told)) told = grammar::check(read->program, check_options);
      for (const grammar::Diagnostic& d : told)
        if (d.severity == grammar::Severity::error && errors.size() < kMostErrorText)
          errors += (errors.empty() ? "" : "\n  ") + grammar::format(d, read->program.files);
      if (read->program.modules.empty() && errors.empty()) errors = "it is not there, or cannot be read";
      if (!errors.empty()) throw base::InputError(path, "", errors, "`blockrand grammar check` tells more");
      read->deriver.emplace(read->program);
      read->makes_geometry = makes_geometry(read->program);
      read->begins_on_lot = begins_on_lot(read->program);
      files_.push_back(std::move(read));
      file = files_.end() - 1;
    }
    return file->get();
  };
  for (const PresetGrammar& preset : presets) {
    Entry entry;
    entry.preset = preset.preset;
    entry.file = preset.file;
    const File* facade = file_of(preset.file, preset.beside);
    entry.deriver = &*facade->deriver;
    entry.makes_geometry = facade->makes_geometry;
    entry.on_footprint = preset.on_footprint.value_or(facade->begins_on_lot);
    if (!preset.roof_file.empty() && !entry.on_footprint) {
      const File* roof = file_of(preset.roof_file, preset.beside);
      entry.roof = &*roof->deriver;
      entry.roof_makes_geometry = roof->makes_geometry;
    }
    for (const auto& [name, value] : preset.attributes) entry.attributes.emplace_back(name, value);
    entries_.push_back(std::move(entry));
  }
  for (const auto& file : files_)
    for (const grammar::Slot& slot : file->program.slots)
      if (!slot.constant) read_.insert(slot.name);
  // Facades read these themselves, whatever the rule file.
  for (const std::string_view name : masonry_parameters()) read_.emplace(name);
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.preset < b.preset; });
}

GrammarLibrary::~GrammarLibrary() = default;
GrammarLibrary::GrammarLibrary(GrammarLibrary&&) noexcept = default;

std::vector<std::string> GrammarLibrary::files() const {
  std::set<std::string> out;
  for (const auto& file : files_)
    for (const grammar::SourceFile& source : file->program.files) out.insert(source.path);
  return {out.begin(), out.end()};
}

std::vector<std::string> GrammarLibrary::files_of(std::string_view preset) const {
  std::set<std::string> out;
  const Entry* entry = find(preset);
  for (const auto& file : files_)
    if (entry && (&*file->deriver == entry->deriver || &*file->deriver == entry->roof))
      for (const grammar::SourceFile& source : file->program.files) out.insert(source.path);
  return {out.begin(), out.end()};
}

const GrammarLibrary::Entry* GrammarLibrary::find(std::string_view preset) const {
  const auto place = std::lower_bound(entries_.begin(), entries_.end(), preset,
                                      [](const Entry& e, std::string_view name) { return e.preset < name; });
  return place != entries_.end() && place->preset == preset ? &*place : nullptr;
}

bool GrammarLibrary::reads(const Entry& entry, const std::string& parameter) {
  if (is_masonry_parameter(parameter)) return !entry.on_footprint;
  const std::vector<std::pair<std::string, grammar::Value>> asked{{parameter, std::string()}};
  const auto has = [&](const grammar::Deriver* deriver) {
    if (!deriver) return false;
    const std::vector<std::uint32_t> slots = deriver->outside_values(asked);
    return std::ranges::any_of(slots, [](std::uint32_t from) { return from != grammar::kNone; });
  };
  return has(entry.deriver) || has(entry.roof);
}

std::vector<std::string> unread_parameters(const districts::RuleSets& book, const GrammarLibrary& grammars) {
  std::vector<std::string> out;
  std::map<std::string, bool> known;
  for (const districts::RuleSet& set : book.sets)
    for (const districts::Rule& rule : set.rules)
      for (const auto& [key, value] : rule.parameters) {
        const auto [at, is_new] = known.try_emplace(key, false);
        if (is_new) at->second = grammars.any_reads(key);
        std::string sentence = fmt::format("{}:{}: rule \"{}\": no rule file of any preset reads the parameter {}",
                                           rule.file, rule.line, rule.name, key);
        if (!at->second && std::ranges::find(out, sentence) == out.end()) out.push_back(std::move(sentence));
      }
  for (const GrammarLibrary::Entry& entry : grammars.entries())
    for (const auto& [key, value] : entry.attributes)
      if (!GrammarLibrary::reads(entry, key))
        out.push_back(fmt::format("preset {}: its rule file {} reads no attribute {}", entry.preset, entry.file, key));
  return out;
}

GrammarLibrary read_grammars(const std::string& configs, std::span<const districts::Preset> presets,
                             const elements::ModelReader& reader) {
  const std::filesystem::path folder = std::filesystem::path(configs) / "grammars";
  // A folder of rules of one's own may do without.
  const bool usual = std::filesystem::exists(folder / kUsualRoofRules);
  std::vector<PresetGrammar> grammars;
  std::vector<std::string> folders{configs};
  for (const districts::Preset& preset : presets) {
    if (preset.grammar.empty()) continue;
    std::filesystem::path declared = std::filesystem::path(preset.declared_in).parent_path();
    if (!preset.declared_in.empty() && declared.empty()) declared = ".";
    if (!declared.empty() && std::ranges::find(folders, declared.string()) == folders.end())
      folders.push_back(declared.string());
    grammars.push_back({preset.name, preset.grammar, preset.attributes,
                        preset.roof_grammar.value_or(usual ? kUsualRoofRules : ""), declared.string(),
                        preset.on_footprint});
  }
  return {folder.string(), grammars, elements::read_element_catalogue(folders, reader)};
}

}  // namespace blockrand::facades
