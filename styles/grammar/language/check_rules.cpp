// Rules and functions as a graph: what nothing reaches, what never ends, what hides what.
#include <algorithm>
#include <map>

#include "styles/grammar/language/check_parts.h"

namespace blockrand::grammar::detail {

namespace {

class RuleGraph {
 public:
  RuleGraph(const Program& program, std::vector<Diagnostic>& told) : program_(program), told_(told) {}

  void run() {
    if (program_.modules.empty()) return;
    unreachable();
    endless();
    hidden();
  }

 private:
  void tell(Severity severity, const char* code, Location location, std::string message, std::string_view text) {
    told_.push_back({severity, code, location, std::move(message), std::string(text), {}});
  }
  const Declaration& declaration(std::uint32_t definition) const {
    return program_.declaration(program_.definitions[definition]);
  }
  std::string_view name(std::uint32_t definition) const {
    return program_.unit(program_.definitions[definition].module).name(declaration(definition).name);
  }
  bool annotated(std::uint32_t definition, std::string_view what) const {
    const Unit& unit = program_.unit(program_.definitions[definition].module);
    for (const Annotation& a : Unit::slice(unit.annotations, declaration(definition).annotations))
      if (a.name == what) return true;
    return false;
  }

  /// Only of start files that say where they begin: others are libraries.
  void unreachable() {
    std::vector<char> reached(program_.definitions.size(), 0);
    std::vector<std::uint32_t> open;
    bool says_start = false;
    for (std::uint32_t d = 0; d < program_.definitions.size(); ++d) {
      const Declaration& node = declaration(d);
      if (program_.definitions[d].module != 0 || node.kind != DeclarationKind::rule) continue;
      const bool start = node.start || annotated(d, "StartRule") || annotated(d, "Startrule");
      says_start = says_start || start;
      if (start || annotated(d, "Handle")) open.push_back(d);
    }
    if (!says_start) return;
    for (const std::uint32_t d : open) reached[d] = 1;
    while (!open.empty()) {
      const Definition& definition = program_.definitions[open.back()];
      open.pop_back();
      const Unit& unit = program_.unit(definition.module);
      for (const Call& call : Unit::slice(unit.calls, program_.declaration(definition).own_calls)) {
        const Target& target = program_.modules[definition.module].targets[call.use];
        if (target.kind != TargetKind::rule) continue;
        for (std::uint32_t i = 0; i < target.count; ++i) {
          const std::uint32_t next = program_.candidates[target.index + i];
          if (reached[next] != 0) continue;
          reached[next] = 1;
          open.push_back(next);
        }
      }
    }
    for (std::uint32_t d = 0; d < program_.definitions.size(); ++d) {
      const Declaration& node = declaration(d);
      if (reached[d] != 0 || node.kind != DeclarationKind::rule || program_.definitions[d].module != 0) continue;
      if (node.override_rule || node.prefix != kNone) continue;  // Reached through imports in other ways.
      tell(Severity::warning, "unreachable", node.location, "no start rule leads to this rule", name(d));
    }
  }

  // ---- Recursion without condition.

  void calls_of_steps(const Definition& definition, NodeId successor, std::vector<std::uint32_t>& out) const {
    const Unit& unit = program_.unit(definition.module);
    std::vector<NodeId> open{successor};
    while (!open.empty()) {
      const Successor& node = unit.successors[open.back()];
      open.pop_back();
      if (node.kind != SuccessorKind::steps) continue;
      for (const Step& step : Unit::slice(unit.steps, node.steps)) {
        if (step.successor != kNone) open.push_back(step.successor);
        if (step.call == kNone) continue;
        const Target& target = program_.modules[definition.module].targets[unit.calls[step.call].use];
        if (target.kind == TargetKind::rule && target.count == 1) out.push_back(program_.candidates[target.index]);
        // What follows NIL has nothing to work on.
        if (target.kind == TargetKind::operation && built_ins()[target.index].name == "NIL") break;
      }
    }
  }

  void calls_of_value(const Definition& definition, NodeId value, std::vector<std::uint32_t>& out) const {
    const Unit& unit = program_.unit(definition.module);
    std::vector<NodeId> open{value};
    const auto push = [&](NodeId id) {
      if (id != kNone) open.push_back(id);
    };
    while (!open.empty()) {
      const Expression& e = unit.expressions[open.back()];
      open.pop_back();
      const bool lazy = e.op == Operator::logical_and || e.op == Operator::logical_or;
      push(e.first);
      if (!lazy) push(e.second);
      push(e.third);
      for (const NodeId id : Unit::slice(unit.expression_lists, e.list)) push(id);
      for (const Range row : Unit::slice(unit.rows, e.rows))
        for (const NodeId id : Unit::slice(unit.expression_lists, row)) push(id);
      for (const ArgumentNode& a : Unit::slice(unit.arguments, e.arguments)) push(a.value);
      if (e.branches.count > 0) push(unit.branches[e.branches.first].condition);
      if (e.kind != ExpressionKind::name) continue;
      const Target& target = program_.modules[definition.module].targets[e.use];
      if (target.kind == TargetKind::own_function && target.count == 1)
        out.push_back(program_.candidates[target.index]);
    }
  }

  void endless() {
    enum : char { fresh, on_path, done };
    std::vector<char> state(program_.definitions.size(), fresh);
    struct Step {
      std::uint32_t definition = 0;
      std::vector<std::uint32_t> next;
      std::size_t at = 0;
    };
    const auto begin = [&](std::uint32_t d) {
      Step step;
      step.definition = d;
      const Definition& definition = program_.definitions[d];
      const Declaration& node = declaration(d);
      if (node.kind == DeclarationKind::rule) calls_of_steps(definition, node.successor, step.next);
      if (node.kind == DeclarationKind::function) calls_of_value(definition, node.value, step.next);
      state[d] = on_path;
      return step;
    };
    for (std::uint32_t first = 0; first < program_.definitions.size(); ++first) {
      if (state[first] != fresh) continue;
      std::vector<Step> path;
      path.push_back(begin(first));
      while (!path.empty()) {
        Step& step = path.back();
        if (step.at == step.next.size()) {
          state[step.definition] = done;
          path.pop_back();
          continue;
        }
        const std::uint32_t next = step.next[step.at++];
        if (state[next] == fresh) {
          path.push_back(begin(next));
        } else if (state[next] == on_path) {
          const bool rule = declaration(next).kind == DeclarationKind::rule;
          tell(Severity::error, "endless", declaration(next).location,
               rule ? "this rule leads back to itself without any condition"
                    : "this function calls itself without any condition",
               name(next));
        }
      }
    }
  }

  // ---- Declarations that hide one another.

  void hidden() {
    // Of every module's own declarations, by name.
    std::map<std::pair<std::uint32_t, NameId>, std::vector<std::uint32_t>> by_name;
    for (std::uint32_t d = 0; d < program_.definitions.size(); ++d) {
      const Declaration& node = declaration(d);
      if (node.override_rule || node.prefix != kNone) continue;
      by_name[{program_.definitions[d].module, node.name}].push_back(d);
    }
    for (const auto& [key, all] : by_name) {
      for (std::size_t i = 0; i < all.size(); ++i) {
        like_built_in(all[i]);
        for (std::size_t j = 0; j < i; ++j)
          if (compare(all[j], all[i])) break;
      }
    }
  }

  void like_built_in(std::uint32_t d) {
    const Declaration& node = declaration(d);
    if (node.kind != DeclarationKind::rule) return;
    const BuiltIn* operation = find_built_in(NameKind::operation, name(d));
    if (operation == nullptr) return;
    for (const Signature& s : signatures(*operation))
      if (node.parameters.count >= s.least && node.parameters.count <= s.most) {
        tell(Severity::warning, "hidden_by_operation", node.location,
             "an operation of this name with as many arguments exists: this rule is never called", name(d));
        return;
      }
  }

  bool compare(std::uint32_t first, std::uint32_t second) {
    const Declaration &a = declaration(first), &b = declaration(second);
    const auto valued = [](DeclarationKind kind) {
      return kind == DeclarationKind::attribute || kind == DeclarationKind::constant;
    };
    if (a.kind != b.kind && !(valued(a.kind) && valued(b.kind))) {
      tell(Severity::warning, "name_clash", b.location, "this name also stands for something of another kind",
           name(second));
      return true;
    }
    if (a.parameters.count != b.parameters.count || a.style != b.style || valued(a.kind)) return false;
    const auto &s = program_.definitions[first].parameter_types, &t = program_.definitions[second].parameter_types;
    bool same = true, differs = false;
    for (std::size_t p = 0; p < s.size(); ++p) {
      same = same && s[p] == t[p];
      differs = differs || (s[p] && t[p] && *s[p] != *t[p]);
    }
    if (differs) return false;
    tell(same ? Severity::error : Severity::warning, "duplicate", b.location,
         "the same name with as many parameters was declared before: the first is used", name(second));
    return true;
  }

  const Program& program_;
  std::vector<Diagnostic>& told_;
};

}  // namespace

void check_rules(const Program& program, std::vector<Diagnostic>& told) { RuleGraph(program, told).run(); }

}  // namespace blockrand::grammar::detail
