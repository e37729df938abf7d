#include "styles/grammar/language/program.h"

#include <algorithm>
#include <deque>
#include <map>
#include <tuple>

#include "styles/grammar/language/file_search.h"
#include "styles/grammar/language/lexer.h"
#include "styles/grammar/language/parser.h"
#include "styles/grammar/language/program_building.h"

namespace blockrand::grammar {

namespace {

using detail::Entry;
using detail::kMostOverloads;
using detail::Scope;

/// A file that imports itself over many ways would otherwise fill the memory.
constexpr std::size_t kMostModules = 1000;
/// The same, as expressions of all modules together.
constexpr std::size_t kMostExpressions = 4'000'000;

class Loader {
 public:
  Loader(Program& program, const LoadOptions& options) : program_(program), options_(options), building_{program, {}} {}

  void run(const std::string& path) {
    const std::shared_ptr<const Unit> unit = read(path, "", {});
    if (!unit) return;
    Module start;
    start.unit = unit;
    add_module(std::move(start), Scope{});
    if (!options_.style.empty()) program_.modules[0].style = style_named(*unit, options_.style, {unit->file, 0, 0});
    for (std::uint32_t m = 0; m < program_.modules.size(); ++m) {
      find_style_chain(m);
      load_imports(m);
    }
    for (std::uint32_t m = 0; m < program_.modules.size(); ++m) define(m);
    for (std::uint32_t m = 0; m < program_.modules.size(); ++m) redefine(m);
    for (std::uint32_t m = 0; m < program_.modules.size(); ++m) connect_slots(m);
    find_start_rules();
    detail::resolve_names(building_);
    detail::infer_types(program_);
    detail::order_slots(program_);
    name_imports();
  }

 private:
  void tell(Severity severity, const char* code, Location location, std::string message, std::string text = {},
            std::string_view suggestion = {}) {
    program_.diagnostics.push_back(
        {severity, code, location, std::move(message), std::move(text), std::string(suggestion)});
  }

  std::shared_ptr<const Unit> read(const std::string& path, const std::string& from, Location place) {
    const std::optional<FoundFile> found = find_file(path, from, options_);
    if (!found) {
      if (from.empty()) {
        program_.files.push_back({path, {}});
        tell(Severity::error, "file_not_found", {0, 0, 0}, "this file cannot be read", path);
      } else {
        tell(Severity::error, "file_not_found", place, "this file was not found", path);
      }
      return nullptr;
    }
    if (!found->written_otherwise.empty())
      tell(Severity::warning, "file_case", place, "found only with other upper and lower case", path,
           found->written_otherwise);
    if (const auto known = units_.find(found->path); known != units_.end()) return known->second;
    const auto number = static_cast<std::uint32_t>(program_.files.size());
    program_.files.push_back({found->path, to_utf8(found->bytes)});
    auto unit = std::make_shared<const Unit>(parse(program_.files.back().text, number, program_.diagnostics));
    units_.emplace(found->path, unit);
    return unit;
  }

  std::uint32_t add_module(Module module, Scope scope) {
    program_.modules.push_back(std::move(module));
    building_.scopes.push_back(std::move(scope));
    return static_cast<std::uint32_t>(program_.modules.size() - 1);
  }

  std::uint32_t style_named(const Unit& unit, std::string_view name, Location place) {
    std::vector<std::string_view> known;
    for (std::uint32_t i = 1; i < unit.styles.size(); ++i) {
      if (unit.name(unit.styles[i].name) == name) return i;
      known.push_back(unit.name(unit.styles[i].name));
    }
    if (name != "Default")
      tell(Severity::error, "unknown_style", place, "no such style", std::string(name),
           building_.suggestion(name, known));
    return 0;
  }

  void find_style_chain(std::uint32_t m) {
    const Unit& unit = program_.unit(m);
    std::vector<std::uint32_t>& chain = building_.scopes[m].style_chain;
    for (std::uint32_t style = program_.modules[m].style; style != 0;) {
      if (std::find(chain.begin(), chain.end(), style) != chain.end()) {
        tell(Severity::error, "style_cycle", unit.styles[style].location, "this style extends itself",
             unit.name(unit.styles[style].name));
        break;
      }
      chain.push_back(style);
      const NameId base = unit.styles[style].base;
      style = base == kNone ? 0 : style_named(unit, unit.name(base), unit.styles[style].location);
    }
    chain.push_back(0);
  }

  /// 0 is the style in force; kNone: the style does not hold.
  std::uint32_t rank(std::uint32_t m, std::uint32_t style) const {
    const auto& chain = building_.scopes[m].style_chain;
    const auto found = std::find(chain.begin(), chain.end(), style);
    return found == chain.end() ? kNone : static_cast<std::uint32_t>(found - chain.begin());
  }

  void load_imports(std::uint32_t m) {
    const std::shared_ptr<const Unit> unit = program_.modules[m].unit;
    // An import of a derived style replaces that of its base.
    std::map<NameId, const Import*> chosen;
    for (const Import& import : unit->imports) {
      const std::uint32_t r = rank(m, import.style);
      if (r == kNone) continue;
      const auto [entry, added] = chosen.try_emplace(import.name, &import);
      if (added) continue;
      const std::uint32_t other = rank(m, entry->second->style);
      if (other == r)
        tell(Severity::error, "duplicate_import", import.location, "an import of this name stands above",
             unit->name(import.name));
      if (r < other) entry->second = &import;
    }
    // In the order of the file.
    for (const Import& import : unit->imports) {
      const auto found = chosen.find(import.name);
      if (found == chosen.end() || found->second != &import) continue;
      const std::string& name = unit->name(import.name);
      if (is_reserved_prefix(name))
        tell(Severity::error, "reserved_prefix", import.location, "this name belongs to the language", name);
      building_.scopes[m].imports[name] = load_import(m, import, nullptr);
    }
    building_.scopes[m].dynamic_modules.assign(unit->dynamic_imports.size(), kNone);
    for (std::size_t d = 0; d < unit->dynamic_imports.size(); ++d) {
      const DynamicImport& dynamic = unit->dynamic_imports[d];
      const auto found = chosen.find(dynamic.name);
      if (found == chosen.end()) {
        std::vector<std::string_view> known;
        for (const auto& [name, import] : chosen) known.push_back(unit->name(name));
        tell(Severity::error, "unknown_import", dynamic.location, "no import of this name", unit->name(dynamic.name),
             building_.suggestion(unit->name(dynamic.name), known));
        continue;
      }
      building_.scopes[m].dynamic_modules[d] = load_import(m, *found->second, &dynamic);
    }
  }

  std::uint32_t load_import(std::uint32_t m, const Import& import, const DynamicImport* dynamic) {
    const std::shared_ptr<const Unit> unit = program_.modules[m].unit;
    if (program_.modules.size() >= kMostModules || expressions_ > kMostExpressions) {
      tell(Severity::error, "too_many_imports", import.location,
           "all imports together make more than " + std::to_string(kMostModules) + " modules or " +
               std::to_string(kMostExpressions) + " expressions");
      return kNone;
    }
    const std::shared_ptr<const Unit> imported =
        read(unit->texts[import.path], program_.files[unit->file].path, import.path_location);
    if (!imported) return kNone;
    for (std::uint32_t above = m; above != kNone; above = program_.modules[above].parent)
      if (program_.unit(above).file == imported->file) {
        tell(Severity::error, "import_cycle", import.path_location, "this file imports itself",
             unit->texts[import.path]);
        return kNone;
      }
    Module module;
    module.unit = imported;
    module.parent = m;
    module.prefix = program_.modules[m].prefix + unit->name(import.name) + ".";
    module.dynamic_root = program_.modules[m].dynamic_root;
    if (dynamic != nullptr && module.dynamic_root == kNone)
      module.dynamic_root = static_cast<std::uint32_t>(program_.modules.size());
    const auto styles = Unit::slice(unit->style_names, import.styles);
    if (!styles.empty()) module.style = style_named(*imported, unit->name(styles[0]), import.location);
    if (styles.size() > 1)
      tell(Severity::warning, "several_styles", import.location, "only the first of these styles is used",
           unit->name(import.name));
    expressions_ += imported->expressions.size() + imported->calls.size();
    Scope scope;
    scope.protect_all = import.parentheses && import.overrides.empty();
    for (const Override& o : Unit::slice(unit->overrides, import.overrides)) scope.overrides.push_back({m, o});
    if (dynamic != nullptr)
      for (const Override& o : Unit::slice(unit->overrides, dynamic->overrides)) scope.overrides.push_back({m, o});
    return add_module(std::move(module), std::move(scope));
  }

  std::uint32_t add_definition(std::uint32_t module, NodeId declaration) {
    Definition definition;
    definition.module = module;
    definition.declaration = declaration;
    const Unit& unit = program_.unit(module);
    definition.parameter_types.resize(unit.declarations[declaration].parameters.count);
    program_.definitions.push_back(std::move(definition));
    return static_cast<std::uint32_t>(program_.definitions.size() - 1);
  }

  const Declaration& declaration_of(std::uint32_t definition) const {
    return program_.declaration(program_.definitions[definition]);
  }

  void define(std::uint32_t m) {
    const Unit& unit = program_.unit(m);
    Scope& scope = building_.scopes[m];
    program_.modules[m].first_slot = static_cast<std::uint32_t>(program_.slots.size());
    for (NodeId d = 0; d < unit.declarations.size(); ++d) {
      const Declaration& declaration = unit.declarations[d];
      const std::uint32_t r = rank(m, declaration.style);
      if (declaration.override_rule || declaration.prefix != kNone || r == kNone) continue;
      Entry& entry = scope.names[unit.name(declaration.name)];
      if (declaration.broken) {
        entry.broken = true;
        continue;
      }
      if (declaration.style != 0 && (declaration.start || declaration.extension))
        tell(Severity::error, "style_section", declaration.location,
             "start and extension rules stand before the first style", unit.name(declaration.name));
      switch (declaration.kind) {
        case DeclarationKind::attribute:
        case DeclarationKind::constant:
          define_attribute(m, d, r, entry);
          break;
        case DeclarationKind::function:
          add_overload(entry.functions, m, d, r);
          break;
        case DeclarationKind::rule:
          add_overload(entry.rules, m, d, r);
          break;
      }
    }
    program_.modules[m].slot_count = static_cast<std::uint32_t>(program_.slots.size()) - program_.modules[m].first_slot;
  }

  void define_attribute(std::uint32_t m, NodeId d, std::uint32_t r, Entry& entry) {
    const Unit& unit = program_.unit(m);
    const Declaration& declaration = unit.declarations[d];
    const bool constant = declaration.kind == DeclarationKind::constant;
    if (entry.attribute != kNone) {
      Definition& other = program_.definitions[entry.attribute];
      const std::uint32_t other_rank = rank(m, unit.declarations[other.declaration].style);
      if (other_rank == r)
        tell(Severity::error, "duplicate", declaration.location, "this attribute was declared before",
             unit.name(declaration.name));
      if (r < other_rank) {
        other.declaration = d;
        Slot& slot = program_.slots[other.slot];
        slot.constant = constant;
        slot.value = declaration.value;
      }
      return;
    }
    entry.attribute = add_definition(m, d);
    program_.definitions[entry.attribute].slot = static_cast<std::uint32_t>(program_.slots.size());
    Slot slot;
    slot.definition = entry.attribute;
    slot.name = program_.modules[m].prefix + unit.name(declaration.name);
    slot.constant = constant;
    slot.module = m;
    slot.value = declaration.value;
    program_.slots.push_back(std::move(slot));
  }

  /// Those of a style replace those of its base with as many parameters; those of one style stand side by side.
  void add_overload(std::vector<std::uint32_t>& all, std::uint32_t m, NodeId d, std::uint32_t r) {
    const Unit& unit = program_.unit(m);
    const Declaration& declaration = unit.declarations[d];
    for (std::size_t i = 0; i < all.size();) {
      const Declaration& other = declaration_of(all[i]);
      const std::uint32_t other_rank = rank(m, other.style);
      if (other.parameters.count != declaration.parameters.count || other_rank == r) {
        ++i;
        continue;
      }
      if (other_rank < r) return;
      all.erase(all.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (all.size() >= kMostOverloads) return tell_overloads(declaration, unit);
    all.push_back(add_definition(m, d));
  }

  void tell_overloads(const Declaration& declaration, const Unit& unit) {
    tell(Severity::error, "too_many_overloads", declaration.location,
         "more than " + std::to_string(kMostOverloads) + " declarations of this name", unit.name(declaration.name));
  }

  /// Rules that importers redefine: in their import statement, or as `imp.Rule -->`.
  void redefine(std::uint32_t m) {
    // Later ones are put in front, so that the last word wins.
    for (const detail::ImporterOverride& o : building_.scopes[m].overrides) {
      if (o.node.kind != OverrideKind::rule) continue;
      redefine_rule(m, o.module, o.node.declaration, true);
    }
    const Unit& unit = program_.unit(m);
    const Scope& scope = building_.scopes[m];
    std::map<std::tuple<NameId, NameId, std::uint32_t>, std::uint32_t> ranks;
    for (NodeId d = 0; d < unit.declarations.size(); ++d) {
      const Declaration& declaration = unit.declarations[d];
      if (declaration.prefix == kNone || declaration.broken || rank(m, declaration.style) == kNone) continue;
      if (declaration.style != 0)
        tell(Severity::error, "style_section", declaration.location,
             "rules of imports are redefined before the first style", unit.name(declaration.name));
      const std::string& prefix = unit.name(declaration.prefix);
      const auto found = scope.imports.find(prefix);
      if (found == scope.imports.end()) {
        std::vector<std::string_view> known;
        for (const auto& [name, module] : scope.imports) known.push_back(name);
        std::sort(known.begin(), known.end());
        tell(Severity::error, "unknown_import", declaration.location, "no import of this name", prefix,
             building_.suggestion(prefix, known));
        continue;
      }
      if (found->second != kNone) redefine_rule(found->second, m, d, false);
      for (std::size_t i = 0; i < unit.dynamic_imports.size(); ++i)
        if (unit.dynamic_imports[i].name == declaration.prefix && scope.dynamic_modules[i] != kNone)
          redefine_rule(scope.dynamic_modules[i], m, d, false);
    }
  }

  void redefine_rule(std::uint32_t target, std::uint32_t importer, NodeId d, bool must_be_extension) {
    const Unit& unit = program_.unit(importer);
    const Declaration& declaration = unit.declarations[d];
    const std::string& name = unit.name(declaration.name);
    // The key must live as long as the program: the importer's unit does.
    Entry& entry = building_.scopes[target].names[name];
    bool known = false, extension = false;
    for (const std::uint32_t rule : entry.rules) {
      if (declaration_of(rule).parameters.count != declaration.parameters.count) continue;
      known = true;
      extension = extension || declaration_of(rule).extension || program_.definitions[rule].module == importer;
    }
    if (!known && !entry.broken) {
      std::vector<std::string_view> names;
      for (const auto& [other, o] : building_.scopes[target].names)
        if (!o.rules.empty()) names.push_back(other);
      std::sort(names.begin(), names.end());
      tell(Severity::warning, "unknown_rule", declaration.location,
           "the imported file has no rule of this name with as many parameters", name,
           building_.suggestion(name, names));
    } else if (must_be_extension && !extension && known) {
      tell(Severity::warning, "no_extension", declaration.location,
           "this rule is not declared as extension by the imported file; it is replaced all the same", name);
    }
    if (entry.rules.size() >= kMostOverloads) return tell_overloads(declaration, unit);
    entry.rules.insert(entry.rules.begin(), add_definition(importer, d));
  }

  /// Where the values of a module's attributes come from (docs/rule_language.md §1.5).
  void connect_slots(std::uint32_t m) {
    const Scope& scope = building_.scopes[m];
    const std::uint32_t parent = program_.modules[m].parent;
    if (parent == kNone) return;
    const Module& module = program_.modules[m];
    std::vector<char> own(module.slot_count, scope.protect_all ? 1 : 0);
    for (const detail::ImporterOverride& o : scope.overrides) {
      if (o.node.kind == OverrideKind::rule) continue;
      const std::string& name = program_.unit(o.module).name(o.node.name);
      const auto found = scope.names.find(name);
      if (found == scope.names.end() || found->second.attribute == kNone) {
        if (found != scope.names.end() && found->second.broken) continue;
        std::vector<std::string_view> names;
        for (const auto& [other, entry] : scope.names)
          if (entry.attribute != kNone) names.push_back(other);
        std::sort(names.begin(), names.end());
        const bool protect = o.node.kind == OverrideKind::protect;
        const bool far = name.find('.') != std::string::npos;
        tell(protect ? Severity::warning : Severity::error, "unknown_attribute", o.node.location,
             far ? "attributes of imports of imports cannot be set here"
                 : "the imported file has no attribute of this name",
             name, building_.suggestion(name, names));
        continue;
      }
      const std::uint32_t number = program_.definitions[found->second.attribute].slot;
      Slot& slot = program_.slots[number];
      own[number - module.first_slot] = 1;
      if (o.node.kind == OverrideKind::protect) continue;
      if (slot.constant) {
        tell(Severity::error, "constant", o.node.location, "constants cannot be set by an import", name);
        continue;
      }
      slot.module = o.module;
      slot.value = o.node.value;
    }
    for (std::uint32_t i = 0; i < module.slot_count; ++i) {
      Slot& slot = program_.slots[module.first_slot + i];
      if (own[i] != 0 || slot.constant) continue;
      const std::string_view name = std::string_view(slot.name).substr(module.prefix.size());
      const auto above = building_.scopes[parent].names.find(name);
      if (above == building_.scopes[parent].names.end() || above->second.attribute == kNone) continue;
      const std::uint32_t source = program_.definitions[above->second.attribute].slot;
      if (!program_.slots[source].constant) slot.source_slot = source;
    }
  }

  void find_start_rules() {
    for (std::uint32_t m = 0; m < program_.modules.size(); ++m) {
      const Unit& unit = program_.unit(m);
      std::uint32_t first = kNone, annotated = kNone, start = kNone;
      for (std::uint32_t d = 0; d < unit.declarations.size(); ++d) {
        const Declaration& declaration = unit.declarations[d];
        if (declaration.kind != DeclarationKind::rule || declaration.parameters.count != 0) continue;
        if (declaration.override_rule || declaration.prefix != kNone || declaration.broken) continue;
        const std::uint32_t rule = rule_without_parameters(m, unit.name(declaration.name));
        if (rule == kNone) continue;
        if (declaration.start && start == kNone) start = rule;
        for (const Annotation& a : Unit::slice(unit.annotations, declaration.annotations))
          if ((a.name == "StartRule" || a.name == "Startrule") && annotated == kNone) annotated = rule;
        if (first == kNone) first = rule;
      }
      building_.scopes[m].start_rule = start != kNone ? start : annotated != kNone ? annotated : first;
    }
    program_.start_rule = building_.scopes[0].start_rule;
  }

  std::uint32_t rule_without_parameters(std::uint32_t m, std::string_view name) const {
    const auto found = building_.scopes[m].names.find(name);
    if (found == building_.scopes[m].names.end()) return kNone;
    for (const std::uint32_t rule : found->second.rules)
      if (declaration_of(rule).parameters.count == 0) return rule;
    return kNone;
  }

  /// Fills what find_start_rule asks for later.
  void name_imports() {
    for (std::uint32_t m = 0; m < program_.modules.size(); ++m) {
      for (const auto& [name, module] : building_.scopes[m].imports)
        if (module != kNone) program_.modules[m].imports.emplace_back(name, module);
      std::sort(program_.modules[m].imports.begin(), program_.modules[m].imports.end());
      for (const auto& [name, entry] : building_.scopes[m].names) {
        const std::uint32_t rule = rule_without_parameters(m, name);
        if (rule != kNone) program_.modules[m].start_rules.emplace_back(name, rule);
      }
      std::sort(program_.modules[m].start_rules.begin(), program_.modules[m].start_rules.end());
    }
  }

  Program& program_;
  const LoadOptions& options_;
  detail::Building building_;
  std::map<std::string, std::shared_ptr<const Unit>> units_;
  std::size_t expressions_ = 0;
};

/// Each thing once (a file may be imported many times), in the order of files and lines.
void sort_diagnostics(std::vector<Diagnostic>& all) {
  const auto key = [](const Diagnostic& d) {
    return std::tie(d.location.file, d.location.line, d.location.column, d.code, d.message);
  };
  std::stable_sort(all.begin(), all.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  all.erase(std::unique(all.begin(), all.end(), [&](const auto& a, const auto& b) { return key(a) == key(b); }),
            all.end());
}

}  // namespace

std::string Program::qualified_name(const Definition& definition) const {
  const Declaration& d = declaration(definition);
  const Unit& u = unit(definition.module);
  return modules[definition.module].prefix + (d.prefix == kNone ? "" : u.name(d.prefix) + ".") + u.name(d.name);
}

Program load(const std::string& path, const LoadOptions& options) {
  Program program;
  Loader(program, options).run(path);
  sort_diagnostics(program.diagnostics);
  return program;
}

std::uint32_t choose(const Program& program, const Target& target, std::span<const Value> arguments) {
  for (std::uint32_t i = 0; i < target.count; ++i) {
    const std::uint32_t candidate = program.candidates[target.index + i];
    const auto& types = program.definitions[candidate].parameter_types;
    bool fits = types.size() == arguments.size();
    for (std::size_t a = 0; fits && a < types.size(); ++a) fits = !types[a] || *types[a] == type_of(arguments[a]);
    if (fits) return candidate;
  }
  return target.count == 1 ? program.candidates[target.index] : kNone;
}

std::uint32_t find_start_rule(const Program& program, std::string_view name) {
  if (program.modules.empty()) return kNone;
  std::uint32_t m = 0;
  while (true) {
    for (const auto& [rule, definition] : program.modules[m].start_rules)
      if (rule == name) return definition;
    const std::size_t dot = name.find('.');
    if (dot == std::string_view::npos) return kNone;
    std::uint32_t next = kNone;
    for (const auto& [prefix, module] : program.modules[m].imports)
      if (prefix == name.substr(0, dot)) next = module;
    if (next == kNone) return kNone;
    m = next;
    name.remove_prefix(dot + 1);
  }
}

}  // namespace blockrand::grammar
