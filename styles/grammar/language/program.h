// A start file with all that it imports, names resolved: what evaluation runs.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "styles/grammar/language/ast.h"
#include "styles/grammar/language/known_names.h"
#include "styles/grammar/language/source.h"
#include "styles/grammar/language/value.h"

namespace blockrand::grammar {

/// What a use of a name means. Uses are name expressions and calls in successors.
enum class TargetKind : std::uint8_t {
  leaf,             ///< a successor's symbol without rule, or with trailing dot
  unknown,          ///< an expression's name that nothing defines: told as an error; evaluates to 0
  operation,        ///< index: number of the built-in (operation)
  function,         ///< index: number of the built-in (function)
  shape_attribute,  ///< index: number of the built-in (attribute)
  word,             ///< a bare argument or selector: its text is the name; index: kNone
  local,            ///< index: place in the frame of parameters, then bindings
  attribute,        ///< attr or const: index is the slot in Shape::attributes
  own_function,     ///< definitions: Program::candidates[index … index + count)
  rule,             ///< definitions: Program::candidates[index … index + count)
  extension,        ///< blockrand.NAME: the name is Unit::name(call.name)
};

struct Target {
  TargetKind kind = TargetKind::unknown;
  std::uint32_t index = kNone;
  std::uint32_t count = 0;
  /// The module whose attributes begin anew before a dynamically imported rule runs (Module::dynamic_slots); kNone
  /// otherwise.
  std::uint32_t dynamic_module = kNone;
};

/// A rule, function, attribute or constant of one module.
struct Definition {
  std::uint32_t module = 0;    ///< whose targets its expressions use
  NodeId declaration = 0;      ///< in the unit of that module
  std::uint32_t slot = kNone;  ///< attributes and constants: place in Shape::attributes
  /// Types of the parameters as far as their use tells; nullopt fits any.
  std::vector<std::optional<Type>> parameter_types;
  std::optional<Type> result;  ///< functions, attributes, constants: as far as known
};

/// A rule file as one import statement sees it. The same file imported twice makes two.
struct Module {
  std::shared_ptr<const Unit> unit;
  std::string prefix;            ///< of the start file's view: "" for itself, "roof." or "roof.tiles." for imports
  std::uint32_t parent = kNone;  ///< the module that imports it
  std::uint32_t style = 0;       ///< the style in force: into Unit::styles
  /// The module made for one dynamic import of which this is a part (itself or an import below it); kNone: none. Slots
  /// of such modules are evaluated at each call of the dynamic import, in the order of the root's `dynamic_slots`.
  std::uint32_t dynamic_root = kNone;
  std::vector<std::uint32_t> dynamic_slots;
  std::uint32_t first_slot = 0, slot_count = 0;  ///< its own slots
  std::vector<Target> targets;                   ///< by UseId
  std::vector<std::optional<Type>> types;        ///< of the unit's expressions, as far as known without running
  std::vector<std::pair<std::string, std::uint32_t>> start_rules;  ///< rules without parameters, ordered by name
  std::vector<std::pair<std::string, std::uint32_t>> imports;      ///< prefix → module, ordered by prefix
};

/// An `attr` or `const`: how its value comes about.
struct Slot {
  std::uint32_t definition = 0;
  std::string name;       ///< qualified: "h", "roof.h"; user values and random streams go by it
  bool constant = false;  ///< not settable from outside
  /// What gives the value if nothing from outside does: the expression `value` in the frame of `module`. With an
  /// override in an import statement it is the importer's; with propagation that of the importer's attribute of the
  /// same name.
  std::uint32_t module = 0;
  NodeId value = kNone;
  /// The importer's attribute that propagates into this one (its value is taken, also when set from outside); kNone:
  /// none.
  std::uint32_t source_slot = kNone;
  /// The override reads the attribute that it overrides: the file's own default is evaluated into the slot first.
  bool reads_itself = false;
};

struct Program {
  std::vector<SourceFile> files;
  std::vector<Module> modules;  ///< modules[0] is the start file's; empty when that could not be read
  std::vector<Definition> definitions;
  std::vector<std::uint32_t> candidates;  ///< into definitions
  std::vector<Slot> slots;
  /// Slots in an order in which each comes after those that its expression reads, as far as that is possible; those of
  /// dynamic modules left out.
  std::vector<std::uint32_t> slot_order;
  std::uint32_t start_rule =
      kNone;  ///< a definition: `start`, else the first @StartRule, else the first rule without parameters
  std::vector<Diagnostic> diagnostics;  ///< of reading and resolving, in the order of files and lines

  const Unit& unit(std::uint32_t module) const { return *modules[module].unit; }
  const Declaration& declaration(const Definition& definition) const {
    return unit(definition.module).declarations[definition.declaration];
  }
  /// "roof.Tiles" of a definition.
  std::string qualified_name(const Definition& definition) const;
};

/// Reads a file; nullopt where there is none. Must not throw.
using FileReader = std::function<std::optional<std::string>(const std::string& path)>;
/// Names of the files in a folder, for spellings that differ in case only; may be empty (then there is no such
/// fallback).
using FolderLister = std::function<std::vector<std::string>(const std::string& folder)>;

struct LoadOptions {
  /// Where imports are looked for: a path that begins with "/" below each root, others beside the importing file first,
  /// then below each root, its `rules` and its `assets` (docs/rule_language.md §1.5).
  std::vector<std::string> roots;
  /// Prefixes of workspace paths with the folder that holds them: {"/ESRI.lib", "/home/me/esri"}. The longest one that
  /// fits wins.
  std::vector<std::pair<std::string, std::string>> mounts;
  FileReader read;
  FolderLister list;
  std::string style;  ///< of the start file; empty: Default
};

/// Reads a file and all its imports, resolves styles and names. Never throws for what a file says: what is wrong is
/// told in Program::diagnostics, and what is right runs.
Program load(const std::string& path, const LoadOptions& options);

/// The definition that fits the types of the arguments; the first whose count fits, when types decide nothing.
/// \returns kNone where none fits
std::uint32_t choose(const Program& program, const Target& target, std::span<const Value> arguments);

/// A rule of the start file that can begin a derivation, by name ("Lot", "roof.Lot").
/// \returns kNone: there is no such rule without parameters
std::uint32_t find_start_rule(const Program& program, std::string_view name);

}  // namespace blockrand::grammar
