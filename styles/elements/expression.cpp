// Reads expressions by recursive descent and calculates them on a stack.
#include "styles/elements/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include "pipeline/base/toml_file.h"

namespace blockrand::elements {
namespace {

/// Operands that wait at once: a sum, a product and a min() or max() for each level, and the one in hand.
constexpr std::size_t kMostOperands = 3 * static_cast<std::size_t>(kDeepestNesting) + 4;

bool starts_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool goes_on(char c) { return starts_name(c) || (c >= '0' && c <= '9') || c == '_'; }

}  // namespace

class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, std::span<const std::string> names) : text_(text), names_(names) {}

  tl::expected<Expression, std::string> read() {
    if (text_.size() > kLongestExpression) return tl::unexpected(fmt::format("is longer than {}", kLongestExpression));
    if (sum() && !at_end()) fail(fmt::format("\"{}\" is not expected here", text_[at_]));
    if (error_) return tl::unexpected(*error_);
    return out_;
  }

 private:
  using Kind = Expression::Step::Kind;

  void skip() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n')) ++at_;
  }
  bool at_end() {
    skip();
    return at_ == text_.size();
  }
  bool take(char c) {
    if (at_end() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  bool fail(const std::string& what) {
    if (!error_) error_ = fmt::format("column {}: {}", at_ + 1, what);
    return false;
  }
  void add(Kind kind, std::uint32_t name = 0, double number = 0) { out_.steps_.push_back({kind, name, number}); }

  bool sum() {
    if (!product()) return false;
    for (;;) {
      const bool plus = take('+');
      if (!plus && !take('-')) return true;
      if (!product()) return false;
      add(plus ? Kind::add : Kind::subtract);
    }
  }

  bool product() {
    if (!factor()) return false;
    for (;;) {
      const bool times = take('*');
      if (!times && !take('/')) return true;
      if (!factor()) return false;
      add(times ? Kind::multiply : Kind::divide);
    }
  }

  bool factor() {
    if (at_end()) return fail("a value is missing");
    if (++depth_ > kDeepestNesting) return fail("brackets lie too deep in one another");
    const bool read = value();
    --depth_;
    return read;
  }

  bool value() {
    const char c = text_[at_];
    if (take('-')) {
      if (!factor()) return false;
      add(Kind::negate);
      return true;
    }
    if (take('(')) return sum() && close();
    if ((c >= '0' && c <= '9') || c == '.') return number();
    if (starts_name(c)) return name();
    return fail(fmt::format("a value is missing before \"{}\"", c));
  }

  bool close() { return take(')') || fail("a closing bracket is missing"); }

  bool number() {
    double number = 0;
    const char* const end = text_.data() + text_.size();
    const auto read = std::from_chars(text_.data() + at_, end, number);
    if (read.ec != std::errc() || !std::isfinite(number)) return fail("this is no number");
    const auto after = static_cast<std::size_t>(read.ptr - text_.data());
    if (after < text_.size() && goes_on(text_[after])) return fail("this is no number");
    at_ = after;
    add(Kind::number, 0, number);
    return true;
  }

  bool name() {
    std::size_t end = at_;
    while (end < text_.size() && goes_on(text_[end])) ++end;
    const std::string word(text_.substr(at_, end - at_));
    if (word == "min" || word == "max") {
      at_ = end;
      return extreme(word == "min" ? Kind::least : Kind::most);
    }
    const auto found = std::find(names_.begin(), names_.end(), word);
    if (found == names_.end()) return fail(fmt::format("there is no \"{}\"{}", word, known_to(word)));
    at_ = end;
    add(Kind::name, static_cast<std::uint32_t>(found - names_.begin()));
    return true;
  }

  bool extreme(Kind kind) {
    if (!take('(')) return fail("min and max want a bracket: min(a, b)");
    if (!sum()) return false;
    if (!take(',')) return fail("min and max want two values: min(a, b)");
    do {
      if (!sum()) return false;
      add(kind);
    } while (take(','));
    return close();
  }

  std::string known_to(const std::string& word) const {
    const std::vector<std::string> known(names_.begin(), names_.end());
    // Of single letters any is as near as another.
    if (const std::string near = base::nearest(word, known); word.size() > 1 && !near.empty())
      return fmt::format("; did you mean \"{}\"?", near);
    std::string list;
    for (const std::string& n : known) list += (list.empty() ? "" : ", ") + n;
    return "; known: " + list;
  }

  std::string_view text_;
  std::span<const std::string> names_;
  std::size_t at_ = 0;
  int depth_ = 0;
  Expression out_;
  std::optional<std::string> error_;
};

tl::expected<Expression, std::string> Expression::parse(std::string_view text, std::span<const std::string> names) {
  return ExpressionParser(text, names).read();
}

double Expression::value(std::span<const double> values) const {
  std::array<double, kMostOperands> stack{};
  std::size_t n = 0;
  const auto join = [&](double result) {
    --n;
    stack[n - 1] = result;
  };
  for (const Step& s : steps_) {
    const double b = n > 0 ? stack[n - 1] : 0, a = n > 1 ? stack[n - 2] : 0;
    switch (s.kind) {
      case Step::Kind::number:
        stack[n++] = s.number;
        break;
      case Step::Kind::name:
        stack[n++] = values[s.name];
        break;
      case Step::Kind::add:
        join(a + b);
        break;
      case Step::Kind::subtract:
        join(a - b);
        break;
      case Step::Kind::multiply:
        join(a * b);
        break;
      case Step::Kind::divide:
        join(a / b);
        break;
      case Step::Kind::negate:
        stack[n - 1] = -b;
        break;
      case Step::Kind::least:
        join(std::min(a, b));
        break;
      case Step::Kind::most:
        join(std::max(a, b));
        break;
    }
  }
  return n > 0 ? stack[0] : 0;
}

bool is_free_name(std::string_view name) {
  constexpr std::array<std::string_view, 6> kOwn = {"w", "h", "i", "n", "min", "max"};
  return !name.empty() && starts_name(name[0]) && std::all_of(name.begin(), name.end(), goes_on) &&
         std::find(kOwn.begin(), kOwn.end(), name) == kOwn.end();
}

}  // namespace blockrand::elements
