// Successors of rules: steps, blocks, choices.
#include <algorithm>
#include <string>

#include "styles/grammar/language/known_names.h"
#include "styles/grammar/language/parser_state.h"

namespace blockrand::grammar::detail {

NodeId Parser::successor() {
  const Nesting nesting(*this);
  if (is_word(at_, "case")) return rule_branches(false);
  if (begins_chance(at_)) return rule_branches(true);
  Successor node;
  node.location = place(token());
  Gathered<Step> steps(scratch_.steps);
  while (true) {
    const Token& t = token();
    if (t.kind == K::open_square) {
      steps.push(step());
      continue;
    }
    if (t.kind != K::name || is_word(at_, "case") || is_word(at_, "else")) break;
    if (depth_ == 0 ? begins_declaration(at_) : breaks_block(at_)) break;
    if (begins_chance(at_)) break;
    steps.push(step());
  }
  node.steps = steps.store(unit_.steps);
  unit_.successors.push_back(node);
  return static_cast<NodeId>(unit_.successors.size() - 1);
}

NodeId Parser::rule_branches(bool chances) {
  const Token& begin = token();
  Gathered<Branch> gathered(scratch_.branches);
  bool otherwise = false;
  while (!otherwise) {
    Branch branch;
    branch.location = place(token());
    otherwise = is_word(at_, "else");
    if (otherwise) {
      ++at_;
    } else if (chances) {
      if (!begins_chance(at_)) break;
      branch.condition = binary(1);
      expect(K::percent, "'%'");
    } else {
      if (!is_word(at_, "case")) break;
      ++at_;
      branch.condition = value();
    }
    expect(K::colon, chances && !otherwise ? "':' after '%'" : "':' after the condition", ":");
    branch.result = successor();
    gathered.push(branch);
  }
  if (!otherwise) tell(Severity::error, begin, "missing_else", "an 'else' is missing at the end of this choice");
  Successor node;
  node.location = place(begin);
  node.kind = chances ? SuccessorKind::chances : SuccessorKind::cases;
  node.branches = gathered.store(unit_.branches);
  unit_.successors.push_back(node);
  return static_cast<NodeId>(unit_.successors.size() - 1);
}

Step Parser::step() {
  Step node;
  node.location = place(token());
  if (accept(K::open_square)) {
    ++depth_;
    node.kind = StepKind::push;
    node.successor = successor();
    expect(K::close_square, "']'", "]");
    --depth_;
    return node;
  }
  const auto begins_inlined = [&](std::size_t index) {
    const Token& t = token_at(index);
    return t.kind == K::open_curly || (t.kind == K::name && !begins_declaration(index));
  };
  if (is_word(at_, "inline")) {
    const Token& next = token(1);
    if (next.kind == K::open_round && next.partner == at_ + 3 && begins_inlined(at_ + 4)) {
      node.inline_mode = intern(slice(token(2)));
      const auto modes = word_set("inline");
      if (std::find(modes.begin(), modes.end(), slice(token(2))) == modes.end())
        tell(Severity::error, token(2), "unknown_word", "unknown way to inline", nearest_name(slice(token(2)), modes));
      at_ += 4;
      node.kind = StepKind::inlined;
    } else if (begins_inlined(at_ + 1)) {
      ++at_;
      node.kind = StepKind::inlined;
    }
  }
  if (node.kind == StepKind::inlined) {
    if (accept(K::open_curly)) {
      ++depth_;
      node.successor = successor();
      expect(K::close_curly, "'}'", "}");
      --depth_;
      return node;
    }
    node.kind = StepKind::inlined_call;
  }
  node.call = call();
  return node;
}

NodeId Parser::call() {
  const Token& name = token();
  Call node;
  node.location = place(name);
  node.terminal = name.trailing_dot;
  const std::size_t begin = at_++;
  if (is(K::open_round) && token().partner != kNone && token_at(token().partner + 1).kind == K::dot &&
      token_at(token().partner + 2).kind == K::name) {
    DynamicImport dynamic;
    dynamic.location = place(name);
    dynamic.name = intern(slice(name));
    dynamic.overrides = overrides();
    unit_.dynamic_imports.push_back(dynamic);
    node.dynamic_import = static_cast<NodeId>(unit_.dynamic_imports.size() - 1);
    ++at_;
    node.terminal = token().trailing_dot;
    node.name = intern(slice(token()));
    ++at_;
  } else {
    node.name = intern(slice(token_at(begin)));
  }
  if (is(K::open_round)) {
    node.parentheses = true;
    node.arguments = arguments();
  }
  if (is(K::open_curly)) {
    const BuiltIn* operation = find_built_in(NameKind::operation, unit_.names[node.name]);
    if (operation == nullptr || operation->block == BlockKind::none || node.terminal || node.dynamic_import != kNone) {
      const std::string_view written = slice(name);
      tell(Severity::error, name, operation == nullptr ? "unknown_operation" : "unexpected_block",
           operation == nullptr ? "this operation, which is followed by a block, does not exist"
                                : "this operation takes no block",
           operation == nullptr ? nearest_built_in(NameKind::operation, written) : std::string_view());
      if (token().partner == kNone) fail(token(), "unclosed", "this bracket is never closed");
      at_ = token().partner + 1;
      accept(K::times);
    } else {
      node.block = block(operation->block, name);
    }
  }
  node.use = unit_.use_count++;
  unit_.calls.push_back(node);
  return static_cast<NodeId>(unit_.calls.size() - 1);
}

NodeId Parser::block(BlockKind kind, const Token& name) {
  const Nesting nesting(*this);
  const Token& open = token();
  Block node;
  node.location = place(open);
  node.kind = kind;
  const auto close = [&] {
    if (breaks_block(at_)) fail(open, "unclosed", "this block is not closed before the next declaration begins");
    expect(K::close_curly, kind == BlockKind::scatter ? "'}'" : "'|' or '}'", "}");
    --depth_;
  };
  ++at_;
  ++depth_;
  node.items = items(kind);
  close();
  if (is(K::times)) {
    if (kind != BlockKind::split && kind != BlockKind::perimeter)
      tell(Severity::error, token(), "unexpected_repeat", "only splits can repeat");
    node.repeat = true;
    ++at_;
  }
  if (kind == BlockKind::perimeter && is(K::open_curly)) {
    ++at_;
    ++depth_;
    node.remainder = items(BlockKind::selectors);
    close();
  }
  if (kind == BlockKind::boolean && node.items.count != 2)
    tell(Severity::error, name, "operands", "this operation needs two operands, separated by '|'");
  unit_.blocks.push_back(node);
  return static_cast<NodeId>(unit_.blocks.size() - 1);
}

Range Parser::items(BlockKind kind) {
  Gathered<BlockItem> list(scratch_.items);
  if (kind == BlockKind::scatter || !is(K::close_curly)) do {
      if (is(K::close_curly) && !list.empty()) {
        warn(token(), "empty_item", "nothing follows the last '|'");
        break;
      }
      list.push(item(kind));
    } while (kind != BlockKind::scatter && accept(K::bar));
  return list.store(unit_.items);
}

BlockItem Parser::item(BlockKind kind) {
  const Nesting nesting(*this);
  BlockItem node;
  node.location = place(token());
  if (kind == BlockKind::scatter || kind == BlockKind::boolean) {
    node.kind = ItemKind::plain;
    node.successor = successor();
    return node;
  }
  if (kind == BlockKind::selectors) {
    node.kind = ItemKind::selector;
    node.value = value_without_chances();
    node.op = item_operator();
    node.successor = successor();
    return node;
  }
  if (kind == BlockKind::split && is(K::open_curly)) {
    const Token& open = token();
    ++at_;
    ++depth_;
    node.kind = ItemKind::group;
    node.items = items(kind);
    if (breaks_block(at_)) fail(open, "unclosed", "this block is not closed before the next declaration begins");
    expect(K::close_curly, "'|' or '}'", "}");
    --depth_;
    node.repeat = accept(K::times);
    return node;
  }
  node.kind = ItemKind::sized;
  if (!item_has_size()) {
    warn(token(), "item_without_size", "items without size belong to versions before 2015.0; '~1' is assumed");
    Expression one;
    one.location = node.location;
    one.number = 1;
    node.mark = Mark::floating;
    node.value = add(one);
    node.successor = successor();
    return node;
  }
  if (accept(K::relative))
    node.mark = Mark::relative;
  else if (accept(K::floating))
    node.mark = Mark::floating;
  node.value = value_without_chances();
  expect(K::colon, "':' after the size", ":");
  if (kind == BlockKind::perimeter) {
    node.depth = value_without_chances();
    expect(K::colon, "':' after the depth", ":");
  }
  node.successor = successor();
  return node;
}

/// Whether a ':' stands before the item ends.
bool Parser::item_has_size() const {
  for (std::size_t i = at_; i < tokens_.size(); ++i) {
    const Token& t = tokens_[i];
    if (t.kind == K::colon) return true;
    if (t.kind == K::bar || t.kind == K::close_curly || t.kind == K::end)
      return i == at_;  // An empty item: the missing size is told.
    if (t.kind == K::open_round || t.kind == K::open_square || t.kind == K::open_curly) {
      if (t.partner == kNone) return true;
      i = t.partner;
    } else if (t.line_start && t.kind == K::name && arrow_follows(i)) {
      return true;
    }
  }
  return true;
}

ItemOperator Parser::item_operator() {
  if (accept(K::assign)) return ItemOperator::all;
  if (accept(K::connect)) return ItemOperator::connected;
  expect(K::colon, "':', '=' or '=:' after the selector", ":");
  return ItemOperator::each;
}

}  // namespace blockrand::grammar::detail
