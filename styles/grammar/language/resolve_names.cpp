// What every use of a name means (docs/rule_language.md §1.3 numbers 5 to 7, §1.6).
#include <algorithm>
#include <set>
#include <string>

#include "styles/grammar/language/program_building.h"

namespace blockrand::grammar::detail {

namespace {

/// How an expression is used, as far as that decides what a bare name means there.
struct Use {
  bool selector = false;        ///< chooses components
  bool operand = false;         ///< of an operator: words make no sense
  bool attribute_name = false;  ///< what set() writes
  bool word = false;            ///< resolved already
};

bool fits(const BuiltIn& entry, std::size_t count) {
  for (const Signature& s : signatures(entry))
    if (count >= s.least && count <= s.most) return true;
  return false;
}

class Resolver {
 public:
  Resolver(Building& building, std::uint32_t m)
      : building_(building),
        program_(building.program),
        m_(m),
        module_(building.program.modules[m]),
        unit_(*module_.unit),
        scope_(building.scopes[m]) {}

  void run() {
    module_.targets.assign(unit_.use_count, {});
    uses_.assign(unit_.expressions.size(), {});
    owners_.assign(unit_.expressions.size(), kNone);
    // Inner declarations (rules in overrides) come before those that hold them.
    for (std::size_t d = unit_.declarations.size(); d-- > 0;) {
      const Range own = unit_.declarations[d].own_expressions;
      std::fill_n(owners_.begin() + own.first, own.count, static_cast<NodeId>(d));
    }
    for (const BlockItem& item : unit_.items)
      if (item.kind == ItemKind::selector) uses_[item.value].selector = true;
    for (const ComponentValue& value : unit_.component_values) uses_[value.selector].selector = true;
    for (const Call& call : unit_.calls) resolve_call(call);
    // Parents follow their children: backwards, what a parent says of a child is known when the child comes.
    for (std::size_t e = unit_.expressions.size(); e-- > 0;) resolve_expression(static_cast<NodeId>(e));
  }

 private:
  void tell(Severity severity, const char* code, Location location, std::string message, std::string_view text = {},
            std::string_view suggestion = {}) {
    program_.diagnostics.push_back(
        {severity, code, location, std::move(message), std::string(text), std::string(suggestion)});
  }

  Target with_candidates(TargetKind kind, const std::vector<std::uint32_t>& all, std::size_t count) {
    Target target;
    target.kind = kind;
    target.index = static_cast<std::uint32_t>(program_.candidates.size());
    for (const std::uint32_t definition : all)
      if (program_.declaration(program_.definitions[definition]).parameters.count == count)
        program_.candidates.push_back(definition);
    target.count = static_cast<std::uint32_t>(program_.candidates.size()) - target.index;
    return target;
  }

  // ---- Calls.

  void resolve_call(const Call& call) {
    Target& target = module_.targets[call.use];
    target.kind = TargetKind::leaf;
    if (call.terminal) return;
    const std::string_view name = unit_.name(call.name);
    const std::size_t count = call.arguments.count;
    if (call.dynamic_import != kNone) {
      const std::uint32_t dynamic = scope_.dynamic_modules[call.dynamic_import];
      if (dynamic == kNone) return;
      bool missing = false;
      target = rule_target(dynamic, name, count, &missing);
      target.dynamic_module = dynamic;
      if (target.kind == TargetKind::leaf && !missing) tell_undefined(call, dynamic, name);
      return;
    }
    const BuiltIn* operation = find_built_in(NameKind::operation, name);
    if (operation != nullptr && fits(*operation, count)) {
      target.kind = TargetKind::operation;
      target.index = built_in_number(*operation);
      mark_arguments(*operation, call.arguments);
      return;
    }
    bool silent = false;
    target = rule_target(m_, name, count, &silent);
    if (target.kind == TargetKind::rule) return;
    if (name.starts_with(kExtensionPrefix) && name.substr(kExtensionPrefix.size()).starts_with('.')) {
      target.kind = TargetKind::extension;
      return;
    }
    if (silent) return;
    if (operation != nullptr)
      tell(Severity::error, "argument_count", call.location,
           "this operation cannot have " + std::to_string(count) + " arguments; it is called as " +
               spelled_out(*operation),
           name);
    else
      tell_undefined(call, m_, name);
  }

  Target rule_target(std::uint32_t module, std::string_view name, std::size_t count, bool* silent) {
    Target leaf;
    leaf.kind = TargetKind::leaf;
    const Entry* entry = find_entry(building_, module, name, silent);
    if (entry != nullptr) {
      *silent = *silent || entry->broken;
      Target found = with_candidates(TargetKind::rule, entry->rules, count);
      if (found.count > 0) return found;
    }
    const std::size_t dot = name.rfind('.');
    if (count == 0 && name.substr(dot == std::string_view::npos ? 0 : dot + 1) == "start") {
      std::uint32_t owner = module;
      std::string_view prefix = dot == std::string_view::npos ? std::string_view() : name.substr(0, dot);
      while (!prefix.empty() && owner != kNone) {
        const std::size_t end = std::min(prefix.find('.'), prefix.size());
        const auto next = building_.scopes[owner].imports.find(prefix.substr(0, end));
        owner = next == building_.scopes[owner].imports.end() ? kNone : next->second;
        prefix.remove_prefix(std::min(end + 1, prefix.size()));
      }
      if (owner != kNone && building_.scopes[owner].start_rule != kNone)
        return with_candidates(TargetKind::rule, {building_.scopes[owner].start_rule}, 0);
    }
    return leaf;
  }

  void tell_undefined(const Call& call, std::uint32_t module, std::string_view name) {
    if (!told_symbols_.insert(std::string(name) + "/" + std::to_string(call.arguments.count)).second) return;
    bool missing = false;
    const Entry* entry = find_entry(building_, module, name, &missing);
    if (entry != nullptr && !entry->rules.empty()) {
      tell(Severity::warning, "parameter_count", call.location,
           "no rule of this name has " + std::to_string(call.arguments.count) + " parameters: the shape is a leaf",
           name);
      return;
    }
    if (entry != nullptr) {
      tell(Severity::warning, "no_rule", call.location,
           "this is an attribute or a function, no rule: the shape is a leaf", name);
      return;
    }
    const std::size_t dot = name.find('.');
    if (dot != std::string_view::npos && scope_.imports.find(name.substr(0, dot)) == scope_.imports.end()) {
      if (is_engine_prefix(name.substr(0, dot))) return;  // check() knows what the program gives
      tell(Severity::warning, "unknown_import", call.location, "there is no import of this name: the shape is a leaf",
           name, nearest_of(scope_.imports, name.substr(0, dot)));
      return;
    }
    std::string_view near =
        building_.suggestions_left > 0 ? nearest_built_in(NameKind::operation, name) : std::string_view();
    if (near.empty()) {
      std::vector<std::string_view> rules;
      for (const auto& [known, e] : building_.scopes[module].names)
        if (!e.rules.empty()) rules.push_back(known);
      std::sort(rules.begin(), rules.end());
      near = building_.suggestion(name, rules);
    }
    tell(Severity::warning, "undefined_symbol", call.location,
         "nothing defines this symbol: the shape is a leaf (write it with a dot at its end if that is meant)", name,
         near);
  }

  template <typename Map>
  std::string_view nearest_of(const Map& map, std::string_view name) {
    std::vector<std::string_view> known;
    for (const auto& entry : map) known.push_back(entry.first);
    std::sort(known.begin(), known.end());
    return building_.suggestion(name, known);
  }

  static std::string spelled_out(const BuiltIn& entry) {
    std::string out;
    for (const Signature& s : signatures(entry)) {
      if (!out.empty()) out += " or ";
      out += std::string(entry.name) + "(" + std::to_string(s.least) +
             (s.most == s.least ? ""
              : s.most > 100    ? "…"
                                : "…" + std::to_string(s.most)) +
             ")";
    }
    return out;
  }

  // ---- Arguments.

  /// Tells of each argument of a built-in whether a bare name there is a word, a selector or an attribute.
  void mark_arguments(const BuiltIn& entry, Range arguments) {
    const auto all = Unit::slice(unit_.arguments, arguments);
    for (std::size_t a = 0; a < all.size(); ++a) {
      const NodeId id = all[a].value;
      const Expression& e = unit_.expressions[id];
      const bool bare = e.kind == ExpressionKind::name && !e.parentheses;
      const std::string_view name = bare ? std::string_view(unit_.name(e.name)) : std::string_view();
      bool only_words = true;
      std::vector<std::string_view> known;
      for (const Signature& s : signatures(entry)) {
        if (all.size() < s.least || all.size() > s.most || s.items.empty()) continue;
        const Signature::Item& item = s.item(a);
        if (item.type == 'e') uses_[id].selector = true;
        if (item.type == 'i') uses_[id].attribute_name = true;
        only_words = only_words && item.type == 'w';
        known.insert(known.end(), item.words.begin(), item.words.end());
      }
      if (!bare || known.empty()) continue;
      if (std::find(known.begin(), known.end(), name) != known.end()) {
        uses_[id].word = true;
      } else if (only_words && !is_defined(id)) {
        uses_[id].word = true;
        tell(Severity::error, "unknown_word", e.location, "this word is not known here", name,
             building_.suggestion(name, known));
      }
    }
  }

  bool is_defined(NodeId id) const {
    const Expression& e = unit_.expressions[id];
    bool missing = false;
    return local(owners_[id], e.name) != kNone || find_entry(building_, m_, unit_.name(e.name), &missing) != nullptr ||
           missing;
  }

  // ---- Expressions.

  void resolve_expression(NodeId id) {
    const Expression& e = unit_.expressions[id];
    const Use use = uses_[id];
    switch (e.kind) {
      case ExpressionKind::unary:
      case ExpressionKind::binary:
        for (const NodeId child : {e.first, e.second}) {
          if (child == kNone) continue;
          uses_[child].operand = true;
          uses_[child].selector = use.selector;
        }
        break;
      case ExpressionKind::index:
        uses_[e.first].operand = true;
        uses_[e.first].attribute_name = use.attribute_name;
        break;
      case ExpressionKind::cases:
      case ExpressionKind::chances:
        for (const Branch& branch : Unit::slice(unit_.branches, e.branches))
          uses_[branch.result].selector = use.selector;
        break;
      case ExpressionKind::component_map:
        mark_arguments(*find_built_in(NameKind::function, "comp"), e.arguments);
        break;
      case ExpressionKind::name:
        resolve_name(id, e, use);
        break;
      case ExpressionKind::number:
      case ExpressionKind::text:
      case ExpressionKind::truth:
      case ExpressionKind::array:
      case ExpressionKind::range:
        break;
    }
  }

  std::uint32_t local(NodeId owner, NameId name) const {
    if (owner == kNone) return kNone;
    const Declaration& declaration = unit_.declarations[owner];
    // Bindings hide parameters.
    for (std::uint32_t i = declaration.bindings.count; i-- > 0;)
      if (unit_.parameters[declaration.bindings.first + i].name == name) return declaration.parameters.count + i;
    for (std::uint32_t i = 0; i < declaration.parameters.count; ++i)
      if (unit_.parameters[declaration.parameters.first + i].name == name) return i;
    return kNone;
  }

  void resolve_name(NodeId id, const Expression& e, const Use& use) {
    Target& target = module_.targets[e.use];
    const std::string_view name = unit_.name(e.name);
    const std::size_t count = e.arguments.count;
    if (use.word) {
      target.kind = TargetKind::word;
      return;
    }
    if (use.attribute_name && !e.parentheses) return resolve_written(e, name, target);
    if (!e.parentheses) {
      if (const std::uint32_t place = local(owners_[id], e.name); place != kNone) {
        target.kind = TargetKind::local;
        target.index = place;
        return;
      }
      if (use.selector && find_built_in(NameKind::selector, name) != nullptr) {
        target.kind = TargetKind::word;
        return;
      }
    }
    bool silent = false;
    const Entry* entry = find_entry(building_, m_, name, &silent);
    if (entry != nullptr) {
      if (count == 0 && entry->attribute != kNone) {
        target.kind = TargetKind::attribute;
        target.index = program_.definitions[entry->attribute].slot;
        return;
      }
      const Target found = with_candidates(TargetKind::own_function, entry->functions, count);
      if (found.count > 0) {
        target = found;
        return;
      }
      silent = silent || entry->broken;
    }
    const BuiltIn* function = find_built_in(NameKind::function, name);
    if (function != nullptr && fits(*function, count)) {
      target.kind = TargetKind::function;
      target.index = built_in_number(*function);
      mark_arguments(*function, e.arguments);
      return;
    }
    const BuiltIn* attribute = find_built_in(NameKind::attribute, name);
    if (attribute != nullptr && !e.parentheses) {
      target.kind = TargetKind::shape_attribute;
      target.index = built_in_number(*attribute);
      return;
    }
    const bool is_word =
        find_built_in(NameKind::word, name) != nullptr || find_built_in(NameKind::selector, name) != nullptr;
    if (!e.parentheses && !use.operand && !use.selector && is_word) {
      target.kind = TargetKind::word;
      return;
    }
    if (!silent) tell_unknown(id, e, use, name, entry, function);
  }

  void resolve_written(const Expression& e, std::string_view name, Target& target) {
    bool silent = false;
    const Entry* entry = find_entry(building_, m_, name, &silent);
    if (entry != nullptr && entry->attribute != kNone) {
      target.kind = TargetKind::attribute;
      target.index = program_.definitions[entry->attribute].slot;
      if (program_.slots[target.index].constant)
        tell(Severity::error, "not_settable", e.location, "constants cannot be set", name);
      return;
    }
    const BuiltIn* attribute = find_built_in(NameKind::attribute, name);
    if (attribute != nullptr) {
      target.kind = TargetKind::shape_attribute;
      target.index = built_in_number(*attribute);
      if (!attribute->settable)
        tell(Severity::error, "not_settable", e.location, "this attribute can only be read", name);
      return;
    }
    if (silent || (entry != nullptr && entry->broken)) return;
    std::vector<std::string_view> known;
    for (const auto& [own, o] : scope_.names)
      if (o.attribute != kNone) known.push_back(own);
    std::sort(known.begin(), known.end());
    for (const BuiltIn& b : built_ins())
      if (b.kind == NameKind::attribute && b.settable) known.push_back(b.name);
    tell(Severity::error, "unknown_attribute", e.location, "there is no attribute of this name to set", name,
         building_.suggestion(name, known));
  }

  void tell_unknown(NodeId id, const Expression& e, const Use& use, std::string_view name, const Entry* entry,
                    const BuiltIn* function) {
    if (use.selector && !e.parentheses && !use.operand) {
      std::vector<std::string_view> known;
      for (const BuiltIn& b : built_ins())
        if (b.kind == NameKind::selector) known.push_back(b.name);
      tell(Severity::error, "unknown_selector", e.location, "this selects nothing", name,
           building_.suggestion(name, known));
      return;
    }
    const std::string arguments =
        std::to_string(e.arguments.count) + (e.arguments.count == 1 ? " argument" : " arguments");
    if (function != nullptr) {
      tell(Severity::error, "argument_count", e.location,
           "this function cannot have " + arguments + "; it is called as " + spelled_out(*function), name);
      return;
    }
    if (entry != nullptr) {
      const bool is_function = !entry->functions.empty();
      tell(Severity::error, is_function ? "argument_count" : "no_value", e.location,
           is_function            ? "no function of this name has " + arguments
           : entry->rules.empty() ? "this attribute takes no arguments"
                                  : "rules have no value",
           name);
      return;
    }
    const std::size_t dot = name.find('.');
    if (dot != std::string_view::npos && is_engine_prefix(name.substr(0, dot)) &&
        scope_.imports.find(name.substr(0, dot)) == scope_.imports.end())
      return;  // the evaluator asks the program for it
    if (dot != std::string_view::npos && !is_reserved_prefix(name.substr(0, dot)) &&
        scope_.imports.find(name.substr(0, dot)) == scope_.imports.end()) {
      tell(Severity::error, "unknown_import", e.location, "there is no import of this name", name,
           nearest_of(scope_.imports, name.substr(0, dot)));
      return;
    }
    std::vector<std::string_view> known;
    if (owners_[id] != kNone) {
      const Declaration& declaration = unit_.declarations[owners_[id]];
      for (const Range range : {declaration.parameters, declaration.bindings})
        for (const Parameter& p : Unit::slice(unit_.parameters, range)) known.push_back(unit_.name(p.name));
    }
    std::vector<std::string_view> own;
    for (const auto& [other, o] : scope_.names)
      if (o.attribute != kNone || !o.functions.empty()) own.push_back(other);
    std::sort(own.begin(), own.end());
    known.insert(known.end(), own.begin(), own.end());
    for (const BuiltIn& b : built_ins())
      if (b.kind == NameKind::function || (b.kind == NameKind::attribute && !e.parentheses)) known.push_back(b.name);
    tell(Severity::error, "unknown_name", e.location, "nothing of this name has a value", name,
         building_.suggestion(name, known));
  }

  Building& building_;
  Program& program_;
  std::uint32_t m_;
  Module& module_;
  const Unit& unit_;
  Scope& scope_;
  std::vector<Use> uses_;
  std::vector<NodeId> owners_;
  std::set<std::string> told_symbols_;
};

}  // namespace

const Entry* find_entry(const Building& building, std::uint32_t module, std::string_view name, bool* missing) {
  const Scope& scope = building.scopes[module];
  // The longest prefix of imports first (docs/rule_language.md §7.2, 20).
  const std::size_t dot = name.find('.');
  if (dot != std::string_view::npos) {
    const auto import = scope.imports.find(name.substr(0, dot));
    if (import != scope.imports.end()) {
      if (import->second == kNone) {
        *missing = true;
        return nullptr;
      }
      if (const Entry* found = find_entry(building, import->second, name.substr(dot + 1), missing)) return found;
    }
  }
  const auto own = scope.names.find(name);
  return own == scope.names.end() ? nullptr : &own->second;
}

void resolve_names(Building& building) {
  for (std::uint32_t m = 0; m < building.program.modules.size(); ++m) Resolver(building, m).run();
}

}  // namespace blockrand::grammar::detail
