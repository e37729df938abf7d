// What the parser's subjects share: tokens, messages, look-ahead, and going on after errors.
#include "styles/grammar/language/parser_state.h"

#include <algorithm>
#include <string>
#include <utility>

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
    const K joint = token_at(next).kind;
    if (joint == K::percent && token_at(next + 1).kind == K::colon) return next;
    if (joint != K::percent && joint != K::plus && joint != K::minus && joint != K::times && joint != K::divide)
      return next;
    ++next;
  }
}

bool Parser::begins_chance(std::size_t index) const {
  const Token& t = token_at(index);
  if (t.kind == K::name && (slice(t) == "case" || slice(t) == "else")) return false;
  const std::size_t next = after_arithmetic(index);
  return next != index && token_at(next).kind == K::percent && token_at(next + 1).kind == K::colon;
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

Parser::Sizes Parser::sizes() const {
  return {.expressions = unit_.expressions.size(),
          .expression_lists = unit_.expression_lists.size(),
          .rows = unit_.rows.size(),
          .arguments = unit_.arguments.size(),
          .branches = unit_.branches.size(),
          .component_values = unit_.component_values.size(),
          .successors = unit_.successors.size(),
          .steps = unit_.steps.size(),
          .calls = unit_.calls.size(),
          .blocks = unit_.blocks.size(),
          .items = unit_.items.size(),
          .parameters = unit_.parameters.size(),
          .declarations = unit_.declarations.size(),
          .overrides = unit_.overrides.size(),
          .imports = unit_.imports.size(),
          .dynamic_imports = unit_.dynamic_imports.size(),
          .style_names = unit_.style_names.size()};
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
