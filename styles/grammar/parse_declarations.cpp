// Declarations, imports, styles; look-ahead, and going on after errors.
#include <algorithm>
#include <string>
#include <utility>

#include "styles/grammar/parser_state.h"

namespace blockrand::grammar::detail {

namespace {

/// More are not shown: a file that is no rule file would fill the screen.
constexpr std::size_t kMostDiagnostics = 200;

}  // namespace

Parser::Parser(std::string_view text, std::uint32_t file, std::vector<Diagnostic>& diagnostics)
    : text_(text), diagnostics_(diagnostics) {
  unit_.file = file;
  tokens_ = tokens_of(text, file, diagnostics);
  unit_.expressions.reserve(tokens_.size() / 3);
}

Parser::Nesting::Nesting(Parser& p) : parser(p) {
  // Counted first: a constructor that throws has no destructor run.
  if (parser.nesting_ >= kMaximumNesting)
    parser.fail(parser.token(), "too_deep",
                "this stands deeper than " + std::to_string(kMaximumNesting) + " levels of brackets and choices");
  ++parser.nesting_;
}

bool Parser::is_word(std::size_t index, std::string_view word) const {
  const Token& t = token_at(index);
  return t.kind == K::name && !t.trailing_dot && slice(t) == word;
}

bool Parser::accept(K kind) {
  if (!is(kind)) return false;
  ++at_;
  return true;
}

void Parser::expect(K kind, const char* what, std::string_view suggestion) {
  if (!accept(kind)) fail(token(), "syntax", "expected " + std::string(what) + ", found", suggestion);
}

void Parser::fail(const Token& t, const char* code, std::string message, std::string_view suggestion) {
  // A single bracket or colon is named by the message already.
  tell(Severity::error, t, code, std::move(message), suggestion.size() > 1 ? suggestion : std::string_view());
  throw SyntaxError{};
}

void Parser::tell(Severity severity, const Token& t, const char* code, std::string message,
                  std::string_view suggestion) {
  if (++told_ > kMostDiagnostics) {
    if (told_ == kMostDiagnostics + 1)
      diagnostics_.push_back({Severity::error, "too_many", place(t), "more is wrong here than is shown", {}, {}});
    return;
  }
  constexpr std::size_t kLongestQuote = 40;
  std::string quoted(slice(t).substr(0, kLongestQuote));
  if (t.kind == K::end) {
    quoted.clear();
    if (message.ends_with(", found")) message += " the end of the file";
  }
  for (char& c : quoted)
    if (c == '\n' || c == '\r') c = ' ';
  diagnostics_.push_back({severity, code, place(t), std::move(message), std::move(quoted), std::string(suggestion)});
}

void Parser::warn(const Token& t, const char* code, std::string message, std::string_view suggestion) {
  tell(Severity::warning, t, code, std::move(message), suggestion);
}

NameId Parser::intern(std::string_view name) {
  const auto [entry, added] = names_.try_emplace(name, static_cast<NameId>(unit_.names.size()));
  if (added) unit_.names.emplace_back(name);
  return entry->second;
}

std::uint32_t Parser::add_text(std::string text) {
  unit_.texts.push_back(std::move(text));
  return static_cast<std::uint32_t>(unit_.texts.size() - 1);
}

/// A name of one part.
NameId Parser::plain_name(const char* what) {
  const Token& t = token();
  if (t.kind != K::name) fail(t, "syntax", "expected " + std::string(what) + ", found");
  const std::string_view name = slice(t);
  if (t.trailing_dot || name.find('.') != std::string_view::npos)
    fail(t, "syntax", std::string(what) + " must have one part, without dots");
  ++at_;
  return intern(name);
}

/// The token after NAME [ ( … ) ] [ with ( … ) ].
std::size_t Parser::after_parameters(std::size_t index) const {
  std::size_t next = index + 1;
  if (token_at(next).kind == K::open_round && token_at(next).partner != kNone) next = token_at(next).partner + 1;
  if (is_word(next, "with") && token_at(next + 1).kind == K::open_round && token_at(next + 1).partner != kNone)
    next = token_at(next + 1).partner + 1;
  return next;
}

bool Parser::arrow_follows(std::size_t index) const { return token_at(after_parameters(index)).kind == K::arrow; }

bool Parser::begins_declaration(std::size_t index) const {
  const Token& t = token_at(index);
  if (t.kind == K::at) return token_at(index + 1).kind == K::name;
  if (t.kind != K::name) return false;
  const K after = token_at(after_parameters(index)).kind;
  if (after == K::arrow || after == K::assign) return true;
  if (t.trailing_dot) return false;
  const std::string_view word = slice(t);
  const Token& next = token_at(index + 1);
  const bool name_next = next.kind == K::name;
  if (word == "attr" || word == "const" || word == "extension") return name_next;
  if (word == "import") return name_next || next.kind == K::text;
  if (word == "version") return next.kind == K::text;
  if (word == "style") return name_next && t.line_start && !next.line_start;
  if (word == "start") return name_next && !next.line_start && arrow_follows(index + 1);
  return false;
}

/// Whether a declaration begins here although a block is still open: then its closing bracket is missing.
bool Parser::breaks_block(std::size_t index) const {
  const Token& t = token_at(index);
  if (t.kind != K::name || !t.line_start) return false;
  if (arrow_follows(index)) return true;
  const std::string_view word = slice(t);
  return (t.column == 1 || word == "attr" || word == "const") && begins_declaration(index);
}

/// The token after operands joined by + - * / %, or `index` where there is no operand.
std::size_t Parser::after_arithmetic(std::size_t index) const {
  std::size_t next = index;
  while (true) {
    while (token_at(next).kind == K::minus || token_at(next).kind == K::plus) ++next;
    const Token& operand = token_at(next);
    if (operand.kind == K::number) {
      ++next;
    } else if (operand.kind == K::name && !operand.trailing_dot) {
      ++next;
      if (token_at(next).kind == K::open_round && token_at(next).partner != kNone) next = token_at(next).partner + 1;
    } else if (operand.kind == K::open_round && operand.partner != kNone) {
      next = operand.partner + 1;
    } else {
      return index;
    }
    while (token_at(next).kind == K::open_square && !token_at(next).space_before && token_at(next).partner != kNone)
      next = token_at(next).partner + 1;
    switch (token_at(next).kind) {
      case K::percent:
        if (token_at(next + 1).kind == K::colon) return next;
        ++next;
        break;
      case K::plus:
      case K::minus:
      case K::times:
      case K::divide:
        ++next;
        break;
      default:
        return next;
    }
  }
}

bool Parser::begins_chance(std::size_t index) const {
  const Token& t = token_at(index);
  if (t.kind == K::name && (slice(t) == "case" || slice(t) == "else")) return false;
  const std::size_t next = after_arithmetic(index);
  return next != index && token_at(next).kind == K::percent && token_at(next + 1).kind == K::colon;
}

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

/// Goes to the next declaration after `begin`, at `error` or behind it.
void Parser::recover(std::size_t begin, std::size_t error) {
  int depth = 0;
  for (std::size_t i = begin; i < tokens_.size(); ++i) {
    const Token& t = tokens_[i];
    if (i > begin && i >= error) {
      bool found = false;
      if (t.kind == K::end) found = true;
      if (t.kind == K::at) found = t.line_start && begins_declaration(i);
      if (t.kind == K::name && begins_declaration(i)) {
        const bool assigns = token_at(after_parameters(i)).kind == K::assign;
        // `top = X` is an item of a block, unless it stands where no block can be.
        found = !assigns ? t.line_start || arrow_follows(i) : t.line_start && (depth <= 0 || t.column == 1);
      }
      if (found) {
        at_ = i;
        return;
      }
    }
    if (t.kind == K::open_curly || t.kind == K::open_round || t.kind == K::open_square) ++depth;
    if (t.kind == K::close_curly || t.kind == K::close_round || t.kind == K::close_square) --depth;
  }
  at_ = tokens_.size() - 1;
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
    if (node.kind != DeclarationKind::function && !node.parameters.empty())
      tell(Severity::error, name, "attribute_parameters", "attributes and constants have no parameters");
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

Parser::Sizes Parser::sizes() const {
  return {
      unit_.expressions.size(),  unit_.expression_lists.size(), unit_.rows.size(),       unit_.arguments.size(),
      unit_.branches.size(),     unit_.component_values.size(), unit_.successors.size(), unit_.steps.size(),
      unit_.calls.size(),        unit_.blocks.size(),           unit_.items.size(),      unit_.parameters.size(),
      unit_.declarations.size(), unit_.overrides.size(),        unit_.imports.size(),    unit_.dynamic_imports.size(),
      unit_.style_names.size()};
}

void Parser::shrink(const Sizes& s) {
  unit_.expressions.resize(s.expressions);
  heights_.resize(s.expressions);
  unit_.expression_lists.resize(s.expression_lists);
  unit_.rows.resize(s.rows);
  unit_.arguments.resize(s.arguments);
  unit_.branches.resize(s.branches);
  unit_.component_values.resize(s.component_values);
  unit_.successors.resize(s.successors);
  unit_.steps.resize(s.steps);
  unit_.calls.resize(s.calls);
  unit_.blocks.resize(s.blocks);
  unit_.items.resize(s.items);
  unit_.parameters.resize(s.parameters);
  unit_.declarations.resize(s.declarations);
  unit_.overrides.resize(s.overrides);
  unit_.imports.resize(s.imports);
  unit_.dynamic_imports.resize(s.dynamic_imports);
  unit_.style_names.resize(s.style_names);
}

}  // namespace blockrand::grammar::detail

namespace blockrand::grammar {

Unit parse(std::string_view text, std::uint32_t file, std::vector<Diagnostic>& diagnostics) {
  return detail::Parser(text, file, diagnostics).run();
}

}  // namespace blockrand::grammar
