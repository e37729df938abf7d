#include "tests/unit/grammar/language/tree_text.h"

#include <fmt/format.h>

namespace blockrand::grammar::test {

namespace {

constexpr const char* kOperators[] = {"?",  "-",  "+",   "!",   "+",  "-",   "*",  "/",   "%",   "==",
                                      "!=", "<",  "<=",  ">",   ">=", "&&",  "||", ".+",  ".-",  ".*",
                                      "./", ".%", ".==", ".!=", ".<", ".<=", ".>", ".>=", ".&&", ".||"};
constexpr const char* kMarks[] = {"", "'", "~"};
constexpr const char* kItemOperators[] = {":", "=", "=:"};

struct Writer {
  const Unit& u;

  std::string list(Range range) const {
    std::string out;
    for (const NodeId id : Unit::slice(u.expression_lists, range)) out += (out.empty() ? "" : ", ") + expression(id);
    return out;
  }
  std::string arguments(Range range) const {
    std::string out;
    for (const ArgumentNode& a : Unit::slice(u.arguments, range))
      out += (out.empty() ? "" : ", ") + std::string(kMarks[static_cast<int>(a.mark)]) + expression(a.value);
    return out;
  }
  template <typename F>
  std::string branches(Range range, bool chances, F result) const {
    std::string out = "{";
    for (const Branch& b : Unit::slice(u.branches, range)) {
      if (out.size() > 1) out += " ";
      if (b.condition == kNone)
        out += "else";
      else
        out += chances ? expression(b.condition) + "%" : "case " + expression(b.condition);
      out += ": " + result(b.result);
    }
    return out + "}";
  }
  std::string expression(NodeId id) const {
    const Expression& e = u.expressions[id];
    switch (e.kind) {
      case ExpressionKind::number:
        return fmt::format("{}", e.number);
      case ExpressionKind::text:
        return "\"" + u.texts[e.text] + "\"";
      case ExpressionKind::truth:
        return e.number != 0 ? "true" : "false";
      case ExpressionKind::name:
        return u.name(e.name) + (e.parentheses ? "(" + arguments(e.arguments) + ")" : "");
      case ExpressionKind::unary:
        return fmt::format("({}{})", kOperators[static_cast<int>(e.op)], expression(e.first));
      case ExpressionKind::binary:
        return fmt::format("({} {} {})", expression(e.first), kOperators[static_cast<int>(e.op)], expression(e.second));
      case ExpressionKind::index:
        return fmt::format("{}[{}]", expression(e.first), list(e.list));
      case ExpressionKind::array: {
        std::string out;
        for (const Range row : Unit::slice(u.rows, e.rows)) out += (out.empty() ? "" : "; ") + list(row);
        return "[" + out + "]";
      }
      case ExpressionKind::range:
        return expression(e.first) + ":" + (e.second == kNone ? "" : expression(e.second) + ":") + expression(e.third);
      case ExpressionKind::cases:
      case ExpressionKind::chances:
        return branches(e.branches, e.kind == ExpressionKind::chances, [&](NodeId r) { return expression(r); });
      case ExpressionKind::component_map: {
        std::string out;
        for (const ComponentValue& c : Unit::slice(u.component_values, e.component_values))
          out += (out.empty() ? "" : " | ") + expression(c.selector) + " " + kItemOperators[static_cast<int>(c.op)] +
                 " " + expression(c.value);
        return "comp(" + arguments(e.arguments) + "){" + out + "}";
      }
    }
    return "?";
  }

  std::string items(Range range) const {
    std::string out;
    for (const BlockItem& i : Unit::slice(u.items, range)) {
      if (!out.empty()) out += " | ";
      switch (i.kind) {
        case ItemKind::sized:
          out += kMarks[static_cast<int>(i.mark)] + expression(i.value) + " : " +
                 (i.depth == kNone ? "" : expression(i.depth) + " : ") + successor(i.successor);
          break;
        case ItemKind::group:
          out += "{" + items(i.items) + "}" + (i.repeat ? "*" : "");
          break;
        case ItemKind::selector:
          out += expression(i.value) + " " + kItemOperators[static_cast<int>(i.op)] + " " + successor(i.successor);
          break;
        case ItemKind::plain:
          out += successor(i.successor);
          break;
      }
    }
    return out;
  }
  std::string call(NodeId id) const {
    const Call& c = u.calls[id];
    std::string out;
    if (c.dynamic_import != kNone) {
      const DynamicImport& d = u.dynamic_imports[c.dynamic_import];
      out = u.name(d.name) + "(" + overrides(d.overrides) + ").";
    }
    out += u.name(c.name) + (c.terminal ? "." : "") + (c.parentheses ? "(" + arguments(c.arguments) + ")" : "");
    if (c.block == kNone) return out;
    const Block& b = u.blocks[c.block];
    out += "{" + items(b.items) + "}" + (b.repeat ? "*" : "");
    return b.remainder.empty() ? out : out + "{" + items(b.remainder) + "}";
  }
  std::string successor(NodeId id) const {
    const Successor& s = u.successors[id];
    if (s.kind != SuccessorKind::steps)
      return branches(s.branches, s.kind == SuccessorKind::chances, [&](NodeId r) { return successor(r); });
    std::string out;
    for (const Step& step : Unit::slice(u.steps, s.steps)) {
      if (!out.empty()) out += " ";
      const std::string mode = step.inline_mode == kNone ? "" : "(" + u.name(step.inline_mode) + ")";
      switch (step.kind) {
        case StepKind::call:
          out += call(step.call);
          break;
        case StepKind::push:
          out += "[" + successor(step.successor) + "]";
          break;
        case StepKind::inlined_call:
          out += "inline" + mode + " " + call(step.call);
          break;
        case StepKind::inlined:
          out += "inline" + mode + " {" + successor(step.successor) + "}";
          break;
      }
    }
    return out;
  }
  std::string overrides(Range range) const {
    std::string out;
    for (const Override& o : Unit::slice(u.overrides, range)) {
      if (!out.empty()) out += ", ";
      if (o.kind == OverrideKind::protect) out += u.name(o.name);
      if (o.kind == OverrideKind::attribute) out += u.name(o.name) + " = " + expression(o.value);
      if (o.kind == OverrideKind::rule) out += declaration(u.declarations[o.declaration]);
    }
    return out;
  }
  std::string declaration(const Declaration& d) const {
    std::string out;
    if (d.broken) out += "broken ";
    if (d.extension) out += "extension ";
    if (d.start) out += "start ";
    if (d.kind == DeclarationKind::attribute) out += "attr ";
    if (d.kind == DeclarationKind::constant) out += "const ";
    if (d.prefix != kNone) out += u.name(d.prefix) + ".";
    out += u.name(d.name);
    if (!d.parameters.empty()) {
      std::string names;
      for (const Parameter& p : Unit::slice(u.parameters, d.parameters))
        names += (names.empty() ? "" : ",") + u.name(p.name);
      out += "(" + names + ")";
    }
    for (const Parameter& p : Unit::slice(u.parameters, d.bindings))
      out += " with " + u.name(p.name) + " := " + expression(p.value);
    if (d.broken) return out;
    return out + (d.kind == DeclarationKind::rule ? " --> " + successor(d.successor) : " = " + expression(d.value));
  }
};

}  // namespace

std::string tree_text(const Unit& unit) {
  const Writer writer{unit};
  std::string out;
  for (const Declaration& d : unit.declarations) {
    if (d.override_rule) continue;
    out += (out.empty() ? "" : "; ") + writer.declaration(d);
  }
  return out;
}

}  // namespace blockrand::grammar::test
