// The parser's inside: one class, its functions by subject in parse_declarations, parse_successors, parse_expressions.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "styles/grammar/language/ast.h"
#include "styles/grammar/language/lexer.h"
#include "styles/grammar/language/parser.h"

namespace blockrand::grammar::detail {

/// Ends the declaration that is being read; what was wrong has been told.
struct SyntaxError {};

class Parser {
 public:
  Parser(std::string_view text, std::uint32_t file, std::vector<Diagnostic>& diagnostics);
  Unit run();

 private:
  using K = TokenKind;

  // Tokens.
  const Token& token(std::size_t ahead = 0) const { return tokens_[std::min(at_ + ahead, tokens_.size() - 1)]; }
  const Token& token_at(std::size_t index) const { return tokens_[std::min(index, tokens_.size() - 1)]; }
  std::string_view slice(const Token& t) const { return text_.substr(t.offset, t.length); }
  Location place(const Token& t) const { return {unit_.file, t.line, t.column}; }
  bool is(K kind) const { return token().kind == kind; }
  bool is_word(std::size_t index, std::string_view word) const;
  bool accept(K kind);
  void expect(K kind, const char* what, std::string_view suggestion = {});
  [[noreturn]] void fail(const Token& t, const char* code, std::string message, std::string_view suggestion = {});
  void tell(Severity severity, const Token& t, const char* code, std::string message, std::string_view suggestion = {});
  void warn(const Token& t, const char* code, std::string message, std::string_view suggestion = {});

  // Names and texts.
  NameId intern(std::string_view name);
  std::uint32_t add_text(std::string text);
  NameId plain_name(const char* what);

  // Look-ahead (docs/rule_language.md §1.3, 1 and 3); all take an index into tokens_.
  std::size_t after_parameters(std::size_t index) const;
  bool arrow_follows(std::size_t index) const;
  bool begins_declaration(std::size_t index) const;
  bool breaks_block(std::size_t index) const;
  bool begins_chance(std::size_t index) const;
  std::size_t after_arithmetic(std::size_t index) const;

  // Declarations.
  void version();
  void declaration_or_skip();
  void statement();
  void recover(std::size_t begin, std::size_t error);
  void annotation();
  void style();
  void import(bool legacy);
  void declaration();
  Range parameters();
  Range bindings();
  Range overrides();
  Override one_override();

  // Successors.
  NodeId successor();
  NodeId rule_branches(bool chances);
  Step step();
  NodeId call();
  NodeId block(BlockKind kind, const Token& name);
  Range items(BlockKind kind);
  BlockItem item(BlockKind kind);
  bool item_has_size() const;
  ItemOperator item_operator();

  // Expressions.
  NodeId value();                  ///< cexpr
  NodeId value_without_chances();  ///< cexpr of sizes and selectors
  NodeId branches(bool chances, NodeId first_condition, const Token& begin);
  NodeId binary(int least_precedence);
  NodeId unary();
  NodeId postfix();
  NodeId primary();
  NodeId name_expression();
  NodeId component_map();
  NodeId array();
  NodeId element();
  Range arguments();
  NodeId add(Expression expression);
  int height(NodeId expression) const { return expression == kNone ? 0 : heights_[expression]; }

  /// Lists are gathered on a stack of their own, since their items may hold lists again.
  template <typename T>
  struct Gathered {
    std::vector<T>& scratch;
    std::size_t mark;
    explicit Gathered(std::vector<T>& s) : scratch(s), mark(s.size()) {}
    ~Gathered() { scratch.resize(mark); }
    Gathered(const Gathered&) = delete;
    Gathered& operator=(const Gathered&) = delete;
    void push(const T& item) { scratch.push_back(item); }
    bool empty() const { return scratch.size() == mark; }
    Range store(std::vector<T>& target) {
      const Range range{static_cast<std::uint32_t>(target.size()), static_cast<std::uint32_t>(scratch.size() - mark)};
      target.insert(target.end(), scratch.begin() + static_cast<std::ptrdiff_t>(mark), scratch.end());
      return range;
    }
  };
  struct Nesting {
    explicit Nesting(Parser& parser);
    ~Nesting() { --parser.nesting_; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;
    Parser& parser;
  };

  /// How long the tree's vectors are: a broken declaration is taken out again.
  struct Sizes {
    std::size_t expressions, expression_lists, rows, arguments, branches, component_values, successors, steps, calls,
        blocks, items, parameters, declarations, overrides, imports, dynamic_imports, style_names;
  };
  Sizes sizes() const;
  void shrink(const Sizes& sizes);

  std::string_view text_;
  std::vector<Diagnostic>& diagnostics_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::size_t failed_at_ = 0;
  Unit unit_;
  std::unordered_map<std::string_view, NameId> names_;  ///< looked up only
  std::vector<std::uint16_t> heights_;                  ///< of unit_.expressions
  std::uint32_t style_ = 0;
  int nesting_ = 0;
  int depth_ = 0;  ///< brackets open in this declaration
  bool in_rule_ = false;
  std::size_t told_ = 0;
  std::size_t annotations_from_ = 0;
  Declaration header_;  ///< of the declaration being read, for the case that it breaks
  bool header_known_ = false;

  struct {
    std::vector<NodeId> expressions;
    std::vector<Range> rows;
    std::vector<ArgumentNode> arguments;
    std::vector<Branch> branches;
    std::vector<ComponentValue> component_values;
    std::vector<Step> steps;
    std::vector<BlockItem> items;
    std::vector<Parameter> parameters;
    std::vector<Override> overrides;
    std::vector<NameId> names;
  } scratch_;
};

}  // namespace blockrand::grammar::detail
