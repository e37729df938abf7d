// How a program is put together; shared by program.cpp, resolve.cpp and types.cpp, included by nobody else.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "styles/grammar/language/program.h"

namespace blockrand::grammar::detail {

/// What a name stands for in one module. Rules and functions: those of redefinitions first.
struct Entry {
  std::uint32_t attribute = kNone;  ///< a definition
  std::vector<std::uint32_t> functions, rules;
  bool broken = false;  ///< a declaration of this name could not be read
};

struct ImporterOverride {
  std::uint32_t module = 0;  ///< the importer
  Override node;
};

/// What is known of a module while it is built.
struct Scope {
  std::unordered_map<std::string_view, Entry> names;            ///< looked up only
  std::unordered_map<std::string_view, std::uint32_t> imports;  ///< kNone: could not be read
  std::vector<std::uint32_t> style_chain;                       ///< the style in force first, Default last
  std::vector<ImporterOverride> overrides;                      ///< later ones beat earlier ones
  bool protect_all = false;
  std::vector<std::uint32_t> dynamic_modules;  ///< by DynamicImport; kNone: could not be made
  std::uint32_t start_rule = kNone;
};

struct Building {
  Program& program;
  std::vector<Scope> scopes;  ///< by module
  /// Looking for what may have been meant costs as much as there are names: a broken file is not searched without end.
  int suggestions_left = 200;

  std::string_view suggestion(std::string_view word, std::span<const std::string_view> known) {
    return --suggestions_left < 0 ? std::string_view() : nearest_name(word, known);
  }
};

/// Declarations of one name, of which types choose; more are told.
inline constexpr std::size_t kMostOverloads = 64;

/// What a name means from a module on, prefixes followed; nullptr: nothing. `missing` is set where an import that could
/// not be read stands in the way.
const Entry* find_entry(const Building& building, std::uint32_t module, std::string_view name, bool* missing);

/// Fills Module::targets of all modules.
void resolve_names(Building& building);
/// Fills Module::types, Definition::parameter_types and ::result.
void infer_types(Program& program);
/// Fills Program::slot_order and Module::dynamic_slots.
void order_slots(Program& program);

}  // namespace blockrand::grammar::detail
