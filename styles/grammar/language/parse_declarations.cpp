// Declarations, imports, styles.
#include <algorithm>
#include <string>
#include <utility>

#include "styles/grammar/language/parser_state.h"

namespace blockrand::grammar::detail {

Unit Parser::run() {
  if (is_word(at_, "version") && token(1).kind == K::text) version();
  while (!is(K::end)) declaration_or_skip();
  return std::move(unit_);
}

void Parser::version() {
  const std::string said = text_value(slice(token(1)));
  const bool digits = said.size() >= 6 && said.size() <= 8 && said[4] == '.' &&
                      std::all_of(said.begin(), said.end(), [](char c) { return c == '.' || (c >= '0' && c <= '9'); });
  if (!digits) warn(token(1), "version", "versions look like \"2021.0\"; this one is ignored");
  if (digits) unit_.version = said;
  unit_.version_location = place(token());
  at_ += 2;
}

void Parser::declaration_or_skip() {
  const std::size_t begin = at_;
  const Sizes before = sizes();
  header_known_ = false;
  nesting_ = depth_ = 0;
  in_rule_ = false;
  try {
    statement();
  } catch (const SyntaxError&) {
    shrink(before);
    if (header_known_) {
      header_.broken = true;
      unit_.declarations.push_back(header_);
    }
    annotations_from_ = unit_.annotations.size();
    recover(begin, at_);
  }
}

void Parser::statement() {
  const Token& t = token();
  if (t.kind == K::at) return annotation();
  if (t.kind != K::name) fail(t, "syntax", "expected a declaration, found");
  const std::string_view word = slice(t);
  const K after = token_at(after_parameters(at_)).kind;
  if (after != K::arrow && after != K::assign) {
    if (word == "version" && token(1).kind == K::text) {
      warn(t, "version", "the version stands before everything else; this one is ignored");
      at_ += 2;
      return;
    }
    if (word == "import") {
      import(false);
      while (is(K::name) && token(1).kind == K::colon && token(2).kind == K::text) import(true);
      return;
    }
    if (word == "style" && token(1).kind == K::name) return style();
  }
  declaration();
}

void Parser::annotation() {
  const Token& at = token();
  ++at_;
  if (!is(K::name)) fail(at, "syntax", "expected an annotation's name after '@'");
  Annotation node;
  node.location = place(at);
  node.name = std::string(slice(token()));
  ++at_;
  // `@Hidden` before `(`, if the bracket belongs to it: on the same line.
  if (is(K::open_round)) {
    if (token().partner == kNone) fail(token(), "unclosed", "this bracket is never closed");
    const Token& close = token_at(token().partner);
    node.arguments = std::string(text_.substr(token().offset + 1, close.offset - token().offset - 1));
    at_ = token().partner + 1;
  }
  unit_.annotations.push_back(std::move(node));
}

void Parser::style() {
  Style node;
  node.location = place(token());
  ++at_;
  const Token& name = token();
  node.name = plain_name("the style's name");
  if (slice(name).find('$') != std::string_view::npos)
    warn(name, "dollar", "names of imports and styles must not contain '$' since 2023.1");
  if (is_word(at_, "extends")) {
    ++at_;
    node.base = plain_name("the name of the style that is extended");
  }
  node.annotations = {static_cast<std::uint32_t>(annotations_from_),
                      static_cast<std::uint32_t>(unit_.annotations.size() - annotations_from_)};
  annotations_from_ = unit_.annotations.size();
  // The same style may be continued further down.
  for (std::uint32_t i = 0; i < unit_.styles.size(); ++i)
    if (unit_.styles[i].name != kNone && unit_.styles[i].name == node.name) {
      style_ = i;
      if (node.base != kNone && unit_.styles[i].base != node.base)
        tell(Severity::error, name, "style_base", "this style extends another one above");
      return;
    }
  if (slice(name) == "Default") {
    style_ = 0;
    return;
  }
  unit_.styles.push_back(node);
  style_ = static_cast<std::uint32_t>(unit_.styles.size() - 1);
}

void Parser::import(bool legacy) {
  const Token& begin = token();
  Import node;
  node.location = place(begin);
  node.style = style_;
  if (legacy)
    warn(begin, "legacy_import", "several files after one 'import' belong to versions before 2020.0", "import");
  else
    ++at_;
  const Token& name = token();
  node.name = plain_name("the import's name");
  if (slice(name).find('$') != std::string_view::npos)
    warn(name, "dollar", "names of imports and styles must not contain '$' since 2023.1");
  if (is(K::open_round)) {
    ++at_;
    Gathered<NameId> names(scratch_.names);
    do names.push(plain_name("a style's name"));
    while (accept(K::comma));
    expect(K::close_round, "',' or ')'", ")");
    node.styles = names.store(unit_.style_names);
  }
  expect(K::colon, "':' after the import's name", ":");
  if (!is(K::text)) fail(token(), "syntax", "expected the file's name in quotes, found");
  node.path = add_text(text_value(slice(token())));
  node.path_location = place(token());
  ++at_;
  if (is(K::open_round)) {
    node.parentheses = true;
    node.overrides = overrides();
  }
  node.annotations = {static_cast<std::uint32_t>(annotations_from_),
                      static_cast<std::uint32_t>(unit_.annotations.size() - annotations_from_)};
  annotations_from_ = unit_.annotations.size();
  unit_.imports.push_back(node);
}

Range Parser::overrides() {
  const Nesting nesting(*this);
  expect(K::open_round, "'('");
  ++depth_;
  Gathered<Override> list(scratch_.overrides);
  if (!is(K::close_round)) do
      list.push(one_override());
    while (accept(K::comma));
  expect(K::close_round, "',' or ')'", ")");
  --depth_;
  return list.store(unit_.overrides);
}

Override Parser::one_override() {
  Override node;
  const Token& name = token();
  node.location = place(name);
  if (name.kind != K::name || name.trailing_dot)
    fail(name, "syntax", "expected the name of an attribute or rule, found");
  node.name = intern(slice(name));
  const K after = token_at(after_parameters(at_)).kind;
  if (after != K::arrow) {
    ++at_;
    if (accept(K::assign)) {
      node.kind = OverrideKind::attribute;
      node.own_expressions.first = static_cast<std::uint32_t>(unit_.expressions.size());
      node.value = value();
      node.own_expressions.count = static_cast<std::uint32_t>(unit_.expressions.size()) - node.own_expressions.first;
    }
    return node;
  }
  node.kind = OverrideKind::rule;
  Declaration rule;
  rule.location = node.location;
  rule.name = node.name;
  rule.override_rule = true;
  rule.own_expressions.first = static_cast<std::uint32_t>(unit_.expressions.size());
  rule.own_calls.first = static_cast<std::uint32_t>(unit_.calls.size());
  ++at_;
  rule.parameters = parameters();
  rule.bindings = bindings();
  expect(K::arrow, "'-->'", "-->");
  const bool outer = std::exchange(in_rule_, true);
  rule.successor = successor();
  in_rule_ = outer;
  rule.own_expressions.count = static_cast<std::uint32_t>(unit_.expressions.size()) - rule.own_expressions.first;
  rule.own_calls.count = static_cast<std::uint32_t>(unit_.calls.size()) - rule.own_calls.first;
  unit_.declarations.push_back(rule);
  node.declaration = static_cast<NodeId>(unit_.declarations.size() - 1);
  return node;
}

Range Parser::parameters() {
  if (!is(K::open_round)) return {};
  ++at_;
  ++depth_;
  Gathered<Parameter> list(scratch_.parameters);
  if (!is(K::close_round)) do {
      Parameter parameter;
      const Token& t = token();
      parameter.location = place(t);
      parameter.name = plain_name("a parameter's name");
      for (std::size_t i = list.mark; i < scratch_.parameters.size(); ++i)
        if (scratch_.parameters[i].name == parameter.name)
          tell(Severity::error, t, "duplicate_parameter", "this parameter was named before");
      list.push(parameter);
    } while (accept(K::comma));
  expect(K::close_round, "',' or ')' after a parameter", ")");
  --depth_;
  return list.store(unit_.parameters);
}

Range Parser::bindings() {
  if (!is_word(at_, "with") || token(1).kind != K::open_round) return {};
  at_ += 2;
  ++depth_;
  Gathered<Parameter> list(scratch_.parameters);
  while (!is(K::close_round)) {
    Parameter binding;
    binding.location = place(token());
    binding.name = plain_name("a local name");
    expect(K::define, "':='", ":=");
    binding.value = value();
    list.push(binding);
    accept(K::comma);
  }
  ++at_;
  --depth_;
  return list.store(unit_.parameters);
}

void Parser::declaration() {
  Declaration node;
  node.location = place(token());
  node.style = style_;
  bool attribute = false, constant = false;
  // The words are names too: `start --> X`, `style = 3`.
  while (is(K::name) && token(1).kind == K::name) {
    const K after = token_at(after_parameters(at_)).kind;
    if (after == K::arrow || after == K::assign) break;
    if (is_word(at_, "attr"))
      attribute = true;
    else if (is_word(at_, "const"))
      constant = true;
    else if (is_word(at_, "extension"))
      node.extension = true;
    else if (is_word(at_, "start") && !token(1).line_start)
      node.start = true;
    else
      break;
    ++at_;
  }
  const Token& name = token();
  if (name.kind != K::name) fail(name, "syntax", "expected a name, found");
  node.location = place(name);
  std::string_view written = slice(name);
  if (name.trailing_dot)
    tell(Severity::error, name, "terminal_rule",
         "a name that ends with a dot is a terminal symbol and can have no rule");
  const std::size_t dot = written.find('.');
  const bool prefixed = dot != std::string_view::npos && !(written[dot + 1] >= '0' && written[dot + 1] <= '9');
  if (prefixed && !attribute && !constant && arrow_follows(at_)) {
    node.prefix = intern(written.substr(0, dot));
    written = written.substr(dot + 1);
    if (written.find('.') != std::string_view::npos)
      tell(Severity::error, name, "import_prefix",
           "rules of files that are imported by imported files cannot be redefined");
  }
  node.name = intern(written);
  ++at_;
  node.own_expressions.first = static_cast<std::uint32_t>(unit_.expressions.size());
  node.own_calls.first = static_cast<std::uint32_t>(unit_.calls.size());
  header_ = node;
  header_known_ = true;
  const K after = token_at(after_parameters(at_ - 1)).kind;
  header_.kind = attribute            ? DeclarationKind::attribute
                 : constant           ? DeclarationKind::constant
                 : after == K::assign ? DeclarationKind::function
                                      : DeclarationKind::rule;
  node.parameters = parameters();
  header_.parameters.count = 0;
  node.bindings = bindings();
  node.annotations = {static_cast<std::uint32_t>(annotations_from_),
                      static_cast<std::uint32_t>(unit_.annotations.size() - annotations_from_)};
  annotations_from_ = unit_.annotations.size();
  const Token& sign = token();
  if (accept(K::arrow)) {
    if (attribute || constant) fail(sign, "syntax", "attributes and constants have a value: expected '=', found");
    node.kind = DeclarationKind::rule;
    in_rule_ = true;
    node.successor = successor();
    if (!is(K::end) && !begins_declaration(at_)) {
      const Token& t = token();
      if (is_word(at_, "case") || begins_chance(at_))
        fail(t, "operation_before_choice",
             "operations cannot stand before a choice in the same rule; put the choice in brackets, [ case … else … ], "
             "or "
             "in a rule of its own");
      if (is_word(at_, "else")) fail(t, "syntax", "this 'else' belongs to no choice");
      if (t.kind == K::close_curly || t.kind == K::close_round || t.kind == K::close_square)
        fail(t, "unopened", "this bracket was never opened");
      fail(t, "syntax", "expected an operation, a symbol or the next declaration, found");
    }
  } else if (accept(K::assign)) {
    if (node.start || node.extension) fail(sign, "syntax", "rules have a successor: expected '-->', found");
    node.kind = attribute  ? DeclarationKind::attribute
                : constant ? DeclarationKind::constant
                           : DeclarationKind::function;
    if (node.kind != DeclarationKind::function && !node.parameters.empty()) {
      tell(Severity::error, name, "attribute_parameters", "attributes and constants have no parameters");
      node.parameters.count = 0;  // nobody gives them values: in what follows their names are unknown
    }
    node.value = value();
    if (!is(K::end) && !begins_declaration(at_)) {
      const Token& t = token();
      if (is_word(at_, "else")) fail(t, "syntax", "this 'else' belongs to no choice");
      fail(t, "syntax", "expected an operator or the next declaration, found");
    }
  } else {
    header_known_ = attribute || constant;
    const std::string_view found = slice(sign);
    const bool broken_arrow = found == "-" || found == "=" || found == ">" || found == ">=";
    tell(Severity::error, sign, "syntax",
         attribute || constant ? "expected '=' after the name, found" : "expected '-->' or '=' after the name, found",
         broken_arrow ? "-->" : std::string_view());
    throw SyntaxError{};
  }
  node.own_expressions.count = static_cast<std::uint32_t>(unit_.expressions.size()) - node.own_expressions.first;
  node.own_calls.count = static_cast<std::uint32_t>(unit_.calls.size()) - node.own_calls.first;
  unit_.declarations.push_back(node);
}

}  // namespace blockrand::grammar::detail

namespace blockrand::grammar {

Unit parse(std::string_view text, std::uint32_t file, std::vector<Diagnostic>& diagnostics) {
  return detail::Parser(text, file, diagnostics).run();
}

}  // namespace blockrand::grammar
