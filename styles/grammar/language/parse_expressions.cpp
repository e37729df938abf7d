// Expressions: what stands in arguments, conditions and values.
#include <algorithm>
#include <charconv>
#include <limits>
#include <string>

#include "styles/grammar/language/parser_state.h"

namespace blockrand::grammar::detail {

namespace {

struct Infix {
  TokenKind token = TokenKind::end;
  Operator op = Operator::none;
  int precedence = 0;
};

constexpr Infix kInfixes[] = {
    {TokenKind::logical_or, Operator::logical_or, 1},
    {TokenKind::each_or, Operator::each_or, 1},
    {TokenKind::logical_and, Operator::logical_and, 2},
    {TokenKind::each_and, Operator::each_and, 2},
    {TokenKind::equal, Operator::equal, 3},
    {TokenKind::not_equal, Operator::not_equal, 3},
    {TokenKind::each_equal, Operator::each_equal, 3},
    {TokenKind::each_not_equal, Operator::each_not_equal, 3},
    {TokenKind::less, Operator::less, 4},
    {TokenKind::less_equal, Operator::less_equal, 4},
    {TokenKind::greater, Operator::greater, 4},
    {TokenKind::greater_equal, Operator::greater_equal, 4},
    {TokenKind::each_less, Operator::each_less, 4},
    {TokenKind::each_less_equal, Operator::each_less_equal, 4},
    {TokenKind::each_greater, Operator::each_greater, 4},
    {TokenKind::each_greater_equal, Operator::each_greater_equal, 4},
    {TokenKind::plus, Operator::add, 5},
    {TokenKind::minus, Operator::subtract, 5},
    {TokenKind::each_plus, Operator::each_add, 5},
    {TokenKind::each_minus, Operator::each_subtract, 5},
    {TokenKind::times, Operator::multiply, 6},
    {TokenKind::divide, Operator::divide, 6},
    {TokenKind::percent, Operator::modulo, 6},
    {TokenKind::each_times, Operator::each_multiply, 6},
    {TokenKind::each_divide, Operator::each_divide, 6},
    {TokenKind::each_percent, Operator::each_modulo, 6},
};

/// Operator::none of a token that joins nothing.
Infix infix(TokenKind kind) {
  for (const Infix& known : kInfixes)
    if (known.token == kind) return known;
  return {};
}

}  // namespace

NodeId Parser::add(Expression expression) {
  int tallest = std::max({height(expression.first), height(expression.second), height(expression.third)});
  for (const NodeId id : Unit::slice(unit_.expression_lists, expression.list)) tallest = std::max(tallest, height(id));
  for (const Range row : Unit::slice(unit_.rows, expression.rows))
    for (const NodeId id : Unit::slice(unit_.expression_lists, row)) tallest = std::max(tallest, height(id));
  for (const ArgumentNode& a : Unit::slice(unit_.arguments, expression.arguments))
    tallest = std::max(tallest, height(a.value));
  for (const Branch& b : Unit::slice(unit_.branches, expression.branches))
    tallest = std::max({tallest, height(b.condition), height(b.result)});
  for (const ComponentValue& c : Unit::slice(unit_.component_values, expression.component_values))
    tallest = std::max({tallest, height(c.selector), height(c.value)});
  if (tallest >= kMaximumHeight)
    fail(token(), "too_deep", "this expression is deeper than " + std::to_string(kMaximumHeight) + " levels");
  heights_.push_back(static_cast<std::uint16_t>(tallest + 1));
  unit_.expressions.push_back(expression);
  return static_cast<NodeId>(unit_.expressions.size() - 1);
}

NodeId Parser::value() {
  if (is_word(at_, "case")) return branches(false, kNone, token());
  const Token& begin = token();
  const NodeId first = binary(1);
  if (is(K::percent) && token(1).kind == K::colon) return branches(true, first, begin);
  return first;
}

NodeId Parser::value_without_chances() {
  if (is_word(at_, "case")) return branches(false, kNone, token());
  const NodeId size = binary(1);
  if (is(K::percent) && token(1).kind == K::colon)
    fail(token(), "syntax", "a percentage is no size; relative sizes are written '0.5");
  return size;
}

NodeId Parser::branches(bool chances, NodeId first_condition, const Token& begin) {
  const Nesting nesting(*this);
  Gathered<Branch> gathered(scratch_.branches);
  bool first = true, otherwise = false;
  while (!otherwise) {
    Branch branch;
    branch.location = place(token());
    otherwise = is_word(at_, "else");
    if (otherwise) {
      ++at_;
    } else if (chances) {
      if (!first && !begins_chance(at_)) break;
      branch.condition = first ? first_condition : binary(1);
      expect(K::percent, "'%'");
    } else {
      if (!is_word(at_, "case")) break;
      ++at_;
      branch.condition = value();
    }
    expect(K::colon, "':'", ":");
    // Nested case and chances belong to this value; what follows them to us.
    branch.result = value();
    gathered.push(branch);
    first = false;
  }
  if (!otherwise) tell(Severity::error, begin, "missing_else", "an 'else' is missing at the end of this choice");
  Expression expression;
  expression.location = place(begin);
  expression.kind = chances ? ExpressionKind::chances : ExpressionKind::cases;
  expression.branches = gathered.store(unit_.branches);
  return add(expression);
}

NodeId Parser::binary(int least_precedence) {
  NodeId left = unary();
  while (true) {
    const Token& t = token();
    const Infix found = infix(t.kind);
    if (found.op == Operator::none || found.precedence < least_precedence) return left;
    if (t.kind == K::percent && token(1).kind == K::colon) return left;
    ++at_;
    Expression expression;
    expression.location = place(t);
    expression.kind = ExpressionKind::binary;
    expression.op = found.op;
    expression.first = left;
    expression.second = binary(found.precedence + 1);
    left = add(expression);
  }
}

NodeId Parser::unary() {
  const Token& t = token();
  Operator op = Operator::none;
  if (t.kind == K::minus) op = Operator::negate;
  if (t.kind == K::plus) op = Operator::plus;
  if (t.kind == K::logical_not) op = Operator::logical_not;
  if (op == Operator::none) return postfix();
  const Nesting nesting(*this);
  ++at_;
  Expression expression;
  expression.location = place(t);
  expression.kind = ExpressionKind::unary;
  expression.op = op;
  expression.first = unary();
  return add(expression);
}

NodeId Parser::postfix() {
  NodeId base = primary();
  // In rules a '[' after a blank begins a push.
  while (is(K::open_square) && !(in_rule_ && token().space_before)) {
    const Nesting nesting(*this);
    Expression expression;
    expression.location = place(token());
    expression.kind = ExpressionKind::index;
    expression.first = base;
    ++at_;
    Gathered<NodeId> list(scratch_.expressions);
    do list.push(element());
    while (accept(K::comma));
    expect(K::close_square, "']'", "]");
    expression.list = list.store(unit_.expression_lists);
    base = add(expression);
  }
  return base;
}

NodeId Parser::primary() {
  const Token& t = token();
  Expression expression;
  expression.location = place(t);
  if (t.kind == K::number) {
    expression.kind = ExpressionKind::number;
    const std::string_view digits = slice(t);
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), expression.number);
    if (read.ec == std::errc::result_out_of_range) warn(t, "number_range", "this number is beyond what can be stored");
    ++at_;
    return add(expression);
  }
  if (t.kind == K::text) {
    expression.kind = ExpressionKind::text;
    expression.text = add_text(text_value(slice(t)));
    ++at_;
    return add(expression);
  }
  if (t.kind == K::name) return name_expression();
  if (t.kind == K::open_round) {
    const Nesting nesting(*this);
    ++at_;
    ++depth_;
    const NodeId inner = value();
    expect(K::close_round, "')'", ")");
    --depth_;
    return inner;
  }
  if (t.kind == K::open_square) return array();
  if (t.kind == K::relative || t.kind == K::floating)
    fail(t, "syntax", "this mark stands only before a whole argument or a whole size");
  fail(t, "syntax", "expected a value, found");
}

NodeId Parser::name_expression() {
  const Token& t = token();
  const std::string_view name = slice(t);
  Expression expression;
  expression.location = place(t);
  if (t.trailing_dot) fail(t, "syntax", "a name that ends with a dot is a terminal symbol and has no value");
  if (name == "true" || name == "false") {
    expression.kind = ExpressionKind::truth;
    expression.number = name == "true" ? 1 : 0;
    ++at_;
    return add(expression);
  }
  if (name == "else" || name == "case") fail(t, "syntax", "expected a value, found");
  if (breaks_block(at_)) fail(t, "syntax", "expected a value before this declaration");
  if (name == "comp" && token(1).kind == K::open_round && token(1).partner != kNone &&
      token_at(token(1).partner + 1).kind == K::open_curly)
    return component_map();
  ++at_;
  expression.kind = ExpressionKind::name;
  expression.name = intern(name);
  if (is(K::open_round)) {
    expression.parentheses = true;
    expression.arguments = arguments();
  }
  expression.use = unit_.use_count++;
  return add(expression);
}

NodeId Parser::component_map() {
  const Nesting nesting(*this);
  Expression expression;
  expression.location = place(token());
  expression.kind = ExpressionKind::component_map;
  expression.name = intern("comp");
  ++at_;
  expression.arguments = arguments();
  expect(K::open_curly, "'{'");
  ++depth_;
  Gathered<ComponentValue> values(scratch_.component_values);
  if (!is(K::close_curly)) do {
      ComponentValue entry;
      entry.location = place(token());
      entry.selector = value_without_chances();
      entry.op = item_operator();
      entry.value = value();
      values.push(entry);
    } while (accept(K::bar));
  expect(K::close_curly, "'|' or '}'");
  --depth_;
  expression.component_values = values.store(unit_.component_values);
  return add(expression);
}

NodeId Parser::array() {
  const Nesting nesting(*this);
  Expression expression;
  expression.location = place(token());
  expression.kind = ExpressionKind::array;
  ++at_;
  ++depth_;
  Gathered<Range> rows(scratch_.rows);
  if (!is(K::close_square)) do {
      Gathered<NodeId> list(scratch_.expressions);
      do list.push(element());
      while (accept(K::comma));
      rows.push(list.store(unit_.expression_lists));
    } while (accept(K::semicolon));
  expect(K::close_square, "',', ';' or ']'", "]");
  --depth_;
  expression.rows = rows.store(unit_.rows);
  return add(expression);
}

NodeId Parser::element() {
  const Token& begin = token();
  const NodeId first = value();
  if (!is(K::colon)) return first;
  ++at_;
  Expression expression;
  expression.location = place(begin);
  expression.kind = ExpressionKind::range;
  expression.first = first;
  expression.third = binary(1);
  if (accept(K::colon)) {
    expression.second = expression.third;
    expression.third = binary(1);
  }
  return add(expression);
}

Range Parser::arguments() {
  const Nesting nesting(*this);
  expect(K::open_round, "'('");
  ++depth_;
  Gathered<ArgumentNode> list(scratch_.arguments);
  if (!is(K::close_round)) do {
      ArgumentNode argument;
      if (accept(K::relative))
        argument.mark = Mark::relative;
      else if (accept(K::floating))
        argument.mark = Mark::floating;
      argument.value = value();
      list.push(argument);
    } while (accept(K::comma));
  expect(K::close_round, "',' or ')'", ")");
  --depth_;
  return list.store(unit_.arguments);
}

}  // namespace blockrand::grammar::detail
