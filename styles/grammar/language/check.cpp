#include "styles/grammar/language/check.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "styles/grammar/language/check_parts.h"

namespace blockrand::grammar {

namespace detail {

namespace {

void check_extension(const Checked& c, const Call& call, std::string_view name, const CheckOptions& options) {
  const std::string_view own = name.substr(std::min(name.size(), kExtensionPrefix.size() + 1));
  const auto found = std::find_if(options.extensions.begin(), options.extensions.end(),
                                  [&](const ExtensionOperation& e) { return e.name == own; });
  if (found == options.extensions.end()) {
    std::vector<std::string_view> known;
    for (const ExtensionOperation& e : options.extensions) known.push_back(e.name);
    c.tell(Severity::error, "unknown_extension", call.location, "there is no operation of this name under blockrand",
           own, nearest_name(own, known));
    return;
  }
  const auto arguments = Unit::slice(c.unit.arguments, call.arguments);
  const auto text_of = [&](NodeId id) -> std::optional<std::string_view> {
    const Expression& e = c.expression(id);
    if (e.kind != ExpressionKind::text) return std::nullopt;
    return std::string_view(c.unit.texts[e.text]);
  };
  const auto require = [&](NodeId id, const std::vector<std::string>& all, const char* code, const char* what) {
    const auto text = text_of(id);
    if (!text) {
      if (const auto type = c.module.types[id]; type && *type != Type::text)
        c.tell(Severity::error, "type", c.expression(id).location, std::string(what) + " is a text");
      return;
    }
    if (all.empty() || std::find(all.begin(), all.end(), *text) != all.end()) return;
    const std::vector<std::string_view> known(all.begin(), all.end());
    c.tell(Severity::error, code, c.expression(id).location, "unknown " + std::string(what), *text,
           nearest_name(*text, known));
  };
  const std::size_t first = arguments.size() % 2;
  if (first == 1) require(arguments[0].value, found->kinds, "unknown_kind", "kind");
  static const std::vector<std::string> kNoNames{"\n"};
  for (std::size_t a = first; a + 1 < arguments.size(); a += 2)
    require(arguments[a].value, found->parameters.empty() ? kNoNames : found->parameters, "unknown_parameter",
            "parameter");
}

/// `building.storys`: a value that the program does not give.
void tell_not_given(const Checked& c, Location location, std::string_view name, const CheckOptions& options) {
  const std::vector<std::string_view> known(options.context.begin(), options.context.end());
  c.tell(Severity::error, "unknown_context", location,
         "the program gives no value of this name (docs/grammar_attributes.md)", name, nearest_name(name, known));
}
bool is_given(std::string_view name, const CheckOptions& options) {
  return std::find(options.context.begin(), options.context.end(), name) != options.context.end();
}
bool has_engine_prefix(std::string_view name) {
  const std::size_t dot = name.find('.');
  return dot != std::string_view::npos && is_engine_prefix(name.substr(0, dot));
}

void check_context(const Checked& c, const Expression& e, const CheckOptions& options) {
  const std::string_view name = c.unit.name(e.name);
  if (c.module.targets[e.use].kind != TargetKind::unknown || !has_engine_prefix(name) || is_given(name, options))
    return;
  tell_not_given(c, e.location, name, options);
}

/// The same where a rule is called: it makes a leaf, whether the program gives such a value or not.
void check_context(const Checked& c, const Call& call, const CheckOptions& options) {
  const std::string_view name = c.unit.name(call.name);
  if (call.terminal || c.module.targets[call.use].kind != TargetKind::leaf || !has_engine_prefix(name)) return;
  for (const auto& [import, module] : c.module.imports)
    if (import == name.substr(0, name.find('.'))) return;
  if (options.context.empty() || is_given(name, options))
    c.tell(Severity::warning, "no_rule", call.location, "this is a value, no rule: the shape is a leaf", name);
  else
    tell_not_given(c, call.location, name, options);
}

constexpr std::string_view kConsistencies[] = {"building", "row"};

}  // namespace

void check_calls(const Checked& c, const CheckOptions& options) {
  std::set<std::uint32_t> told_status;
  const auto status = [&](std::uint32_t number, Location location) {
    const BuiltIn& entry = built_ins()[number];
    if (!options.tell_status || entry.status == Status::runs || !told_status.insert(number).second) return;
    if (entry.status == Status::not_yet)
      c.tell(Severity::warning, "not_yet", location, "this does not run yet; the shape stays as it is", entry.name);
    else
      c.tell(Severity::note, "default_answer", location, "this is always answered the same, whatever stands around",
             entry.name);
  };
  for (const Call& call : c.unit.calls) {
    const Target& target = c.module.targets[call.use];
    const std::string_view name = c.unit.name(call.name);
    if (target.kind == TargetKind::extension && !options.extensions.empty()) check_extension(c, call, name, options);
    check_context(c, call, options);
    if (target.kind != TargetKind::operation) continue;
    status(target.index, call.location);
    const BuiltIn& operation = built_ins()[target.index];
    if (operation.block != BlockKind::none && call.block == kNone)
      c.tell(Severity::error, "missing_block", call.location, "this operation needs a block { … }", name);
    else if (call.block != kNone && c.unit.blocks[call.block].items.empty())
      c.tell(Severity::warning, "empty_block", call.location, "the block of this operation is empty", name);
  }
  for (const Expression& e : c.unit.expressions)
    if (e.kind == ExpressionKind::name && c.module.targets[e.use].kind == TargetKind::function)
      status(c.module.targets[e.use].index, e.location);
  if (!options.context.empty())
    for (const Expression& e : c.unit.expressions)
      if (e.kind == ExpressionKind::name) check_context(c, e, options);
  bool told_inline = false;
  for (const Step& step : c.unit.steps) {
    if (step.kind != StepKind::inlined && step.kind != StepKind::inlined_call) continue;
    const BuiltIn* form = find_built_in(NameKind::syntax, "inline");
    if (options.tell_status && !told_inline && form->status == Status::not_yet)
      c.tell(Severity::warning, "not_yet", step.location, "this does not run yet", "inline");
    told_inline = true;
  }
  for (const Annotation& a : c.unit.annotations) {
    if (find_built_in(NameKind::annotation, a.name) == nullptr) {
      c.tell(Severity::note, "unknown_annotation", a.location, "unknown annotation", a.name,
             nearest_built_in(NameKind::annotation, a.name));
    } else if (a.name == "Consistent") {
      std::string_view value = a.arguments;
      while (!value.empty() && (value.front() == ' ' || value.front() == '"')) value.remove_prefix(1);
      while (!value.empty() && (value.back() == ' ' || value.back() == '"')) value.remove_suffix(1);
      if (std::find(std::begin(kConsistencies), std::end(kConsistencies), value) == std::end(kConsistencies))
        c.tell(Severity::error, "annotation_value", a.location, "@Consistent takes \"building\" or \"row\"", value,
               nearest_name(value, kConsistencies));
    }
  }
  if (c.unit.version_location.line > 0 && c.unit.version < "2013.1")
    c.tell(
        Severity::note, "version", c.unit.version_location,
        "before 2013.1 attributes were evaluated when first used; here they are always evaluated before the first rule",
        c.unit.version);
}

}  // namespace detail

std::vector<Diagnostic> check(const Program& program, const CheckOptions& options) {
  std::vector<Diagnostic> told;
  for (const Module& module : program.modules) {
    const detail::Checked c{program, module, *module.unit, told};
    detail::check_choices(c);
    detail::check_sizes(c);
    detail::check_types(c);
    detail::check_calls(c, options);
    detail::check_styles(c);
  }
  detail::check_overrides(program, told);
  detail::check_rules(program, told);
  const auto key = [](const Diagnostic& d) {
    return std::tie(d.location.file, d.location.line, d.location.column, d.code, d.message, d.text);
  };
  std::stable_sort(told.begin(), told.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  told.erase(std::unique(told.begin(), told.end(), [&](const auto& a, const auto& b) { return key(a) == key(b); }),
             told.end());
  return told;
}

}  // namespace blockrand::grammar
