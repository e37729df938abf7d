#include "styles/grammar/language/lexer.h"

#include <algorithm>
#include <array>

namespace blockrand::grammar {

namespace {

using K = TokenKind;

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
/// Bytes above 127 belong to letters of other languages; the few that do not are taken out before.
constexpr bool is_name_start(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$' ||
         static_cast<unsigned char>(c) >= 128;
}
constexpr bool is_name_part(char c) { return is_name_start(c) || is_digit(c); }

constexpr std::string_view kTypographicQuotes[] = {"\u2019", "\u2018", "\u00b4"};
constexpr std::string_view kOddBlanks[] = {"\u00a0", "\ufeff", "\u200b", "\u2003", "\u2002", "\u2009"};
constexpr std::string_view kTypographicDoubleQuotes[] = {"\u201c", "\u201d", "\u201e"};

struct MarkText {
  std::string_view text;
  K kind;
};
/// Longer ones first.
constexpr MarkText kMarks[] = {
    {"-->", K::arrow},
    {".==", K::each_equal},
    {".!=", K::each_not_equal},
    {".<=", K::each_less_equal},
    {".>=", K::each_greater_equal},
    {".&&", K::each_and},
    {".||", K::each_or},
    {".<", K::each_less},
    {".>", K::each_greater},
    {".+", K::each_plus},
    {".-", K::each_minus},
    {".*", K::each_times},
    {"./", K::each_divide},
    {".%", K::each_percent},
    {":=", K::define},
    {"=:", K::connect},
    {"==", K::equal},
    {"!=", K::not_equal},
    {"<=", K::less_equal},
    {">=", K::greater_equal},
    {"&&", K::logical_and},
    {"||", K::logical_or},
    {"=", K::assign},
    {":", K::colon},
    {",", K::comma},
    {";", K::semicolon},
    {"|", K::bar},
    {"@", K::at},
    {".", K::dot},
    {"'", K::relative},
    {"~", K::floating},
    {"(", K::open_round},
    {")", K::close_round},
    {"[", K::open_square},
    {"]", K::close_square},
    {"{", K::open_curly},
    {"}", K::close_curly},
    {"+", K::plus},
    {"-", K::minus},
    {"*", K::times},
    {"/", K::divide},
    {"%", K::percent},
    {"<", K::less},
    {">", K::greater},
    {"!", K::logical_not},
};

class Lexer {
 public:
  Lexer(std::string_view text, std::uint32_t file, std::vector<Diagnostic>& diagnostics)
      : text_(text), file_(file), diagnostics_(diagnostics) {
    tokens_.reserve(text.size() / 4 + 1);
  }

  std::vector<Token> run() {
    while (skip_blanks(), at_ < text_.size()) read_token();
    add(K::end, 0);
    pair_brackets();
    return std::move(tokens_);
  }

 private:
  char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  bool starts(std::string_view what) const { return text_.substr(at_).starts_with(what); }

  /// Moves on, counting lines and characters.
  void advance(std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) {
      const char c = text_[at_++];
      if (c == '\n' || (c == '\r' && peek() != '\n')) {
        ++line_;
        column_ = 1;
        line_start_ = true;
      } else if ((static_cast<unsigned char>(c) & 0xc0U) != 0x80U && c != '\r') {
        ++column_;
      }
    }
  }

  void tell(Severity severity, const char* code, std::string message, std::string text = {},
            std::string suggestion = {}) {
    diagnostics_.push_back(
        {severity, code, {file_, line_, column_}, std::move(message), std::move(text), std::move(suggestion)});
  }

  void skip_blanks() {
    space_ = false;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v' || c == '\0') {
        advance(1);
      } else if (c == '#' || (c == '/' && peek(1) == '/')) {
        const std::size_t end = text_.find_first_of("\r\n", at_);
        advance((end == std::string_view::npos ? text_.size() : end) - at_);
      } else if (c == '/' && peek(1) == '*') {
        const std::size_t end = text_.find("*/", at_ + 2);
        if (end == std::string_view::npos)
          tell(Severity::error, "unclosed_comment", "this comment is never closed", "/*", "");
        advance(end == std::string_view::npos ? text_.size() - at_ : end + 2 - at_);
      } else if (static_cast<unsigned char>(c) >= 128 && skip_odd_blank()) {
      } else {
        return;
      }
      space_ = true;
    }
  }

  bool skip_odd_blank() {
    for (const std::string_view blank : kOddBlanks)
      if (starts(blank)) {
        advance(blank.size());
        return true;
      }
    return false;
  }

  void add(K kind, std::size_t bytes) {
    Token token;
    token.kind = kind;
    token.space_before = space_ || tokens_.empty();
    token.line_start = line_start_;
    token.offset = static_cast<std::uint32_t>(at_);
    token.length = static_cast<std::uint32_t>(bytes);
    token.line = line_;
    token.column = column_;
    tokens_.push_back(token);
    line_start_ = false;
    advance(bytes);
  }

  void read_token() {
    const char c = text_[at_];
    if (static_cast<unsigned char>(c) >= 128 && read_typographic()) return;
    if (is_name_start(c)) return read_name();
    if (is_digit(c) || (c == '.' && is_digit(peek(1)))) return read_number();
    if (c == '"') return read_text();
    for (const MarkText& mark : kMarks)
      if (mark.text.front() == c && starts(mark.text)) {
        // "./" before a comment is a dot.
        if (mark.kind == K::each_divide && (peek(2) == '/' || peek(2) == '*')) continue;
        return add(mark.kind, mark.text.size());
      }
    // One message for a run of them; they make no token.
    std::size_t end = at_ + 1;
    while (end < text_.size() && text_[end] == c) ++end;
    tell(Severity::error, "unknown_character", "this character means nothing here", std::string(1, c));
    advance(end - at_);
  }

  bool read_typographic() {
    for (const std::string_view quote : kTypographicQuotes)
      if (starts(quote)) {
        tell(Severity::warning, "typographic_quote", "a typographic quote is read as the mark of relative sizes",
             std::string(quote), "'");
        add(K::relative, quote.size());
        return true;
      }
    for (const std::string_view quote : kTypographicDoubleQuotes)
      if (starts(quote)) {
        tell(Severity::error, "typographic_quote", "texts stand in plain double quotes", std::string(quote), "\"");
        advance(quote.size());
        return true;
      }
    return false;
  }

  /// Whether a dot at `at` begins an element-wise operator.
  bool element_wise(std::size_t at) const {
    const std::string_view rest = text_.substr(at, 3);
    if (rest.size() < 2) return false;
    switch (rest[1]) {
      case '+':
      case '-':
      case '*':
      case '%':
      case '<':
      case '>':
        return true;
      case '/':
        return rest.size() < 3 || (rest[2] != '/' && rest[2] != '*');
      case '=':
      case '!':
        return rest.size() > 2 && rest[2] == '=';
      case '&':
        return rest.size() > 2 && rest[2] == '&';
      case '|':
        return rest.size() > 2 && rest[2] == '|';
      default:
        return false;
    }
  }

  void read_name() {
    std::size_t end = at_;
    bool dot = false, digits = false;
    const auto part = [&] {
      while (end < text_.size() && is_name_part(text_[end]) && !odd_at(end)) ++end;
    };
    part();
    while (end + 1 < text_.size() && text_[end] == '.' && is_name_part(text_[end + 1]) && !odd_at(end + 1)) {
      digits = digits || is_digit(text_[end + 1]);
      ++end;
      part();
    }
    if (end < text_.size() && text_[end] == '.' && !element_wise(end)) dot = true;
    if (digits && !told_digits_) {
      tell(Severity::warning, "digit_after_dot", "names with digits after a dot belong to versions before 2020.0",
           std::string(text_.substr(at_, end - at_)));
      told_digits_ = true;
    }
    add(K::name, end - at_);
    if (dot) {
      tokens_.back().trailing_dot = true;
      advance(1);
    }
  }

  /// Typographic marks and odd blanks end a name.
  bool odd_at(std::size_t at) const {
    if (static_cast<unsigned char>(text_[at]) < 0xc2) return false;
    const std::string_view rest = text_.substr(at, 3);
    for (const std::string_view odd : kTypographicQuotes)
      if (rest.starts_with(odd)) return true;
    for (const std::string_view odd : kOddBlanks)
      if (rest.starts_with(odd)) return true;
    for (const std::string_view odd : kTypographicDoubleQuotes)
      if (rest.starts_with(odd)) return true;
    return false;
  }

  void read_number() {
    std::size_t end = at_;
    while (end < text_.size() && is_digit(text_[end])) ++end;
    if (end < text_.size() && text_[end] == '.' && !element_wise(end) &&
        !(end + 1 < text_.size() && is_name_start(text_[end + 1]) && text_[end + 1] != 'e' && text_[end + 1] != 'E')) {
      ++end;
      while (end < text_.size() && is_digit(text_[end])) ++end;
    }
    if (end < text_.size() && (text_[end] == 'e' || text_[end] == 'E')) {
      std::size_t exponent = end + 1;
      if (exponent < text_.size() && (text_[exponent] == '+' || text_[exponent] == '-')) ++exponent;
      if (exponent < text_.size() && is_digit(text_[exponent])) {
        while (exponent < text_.size() && is_digit(text_[exponent])) ++exponent;
        end = exponent;
      }
    }
    add(K::number, end - at_);
  }

  void read_text() {
    std::size_t end = at_ + 1, line_end = 0;
    while (end < text_.size() && text_[end] != '"') {
      if (text_[end] == '\n' && line_end == 0) {
        line_end = end;
        if (unclosed_text_) break;  // One text without end was met: no other may span lines.
      }
      end += text_[end] == '\\' && end + 1 < text_.size() ? 2U : 1U;
    }
    if (end < text_.size() && text_[end] == '"') return add(K::text, end + 1 - at_);
    tell(Severity::error, "unclosed_text", "this text has no closing quote", std::string(text_.substr(at_, 20)), "");
    unclosed_text_ = true;
    add(K::text, (line_end != 0 ? line_end : text_.size()) - at_);
  }

  void pair_brackets() {
    std::vector<std::uint32_t> open;
    std::array<std::size_t, 3>
        counts{};  // How many of each kind are open: a bracket that closes nothing is left alone.
    const auto number = [](K kind) {
      return (static_cast<std::size_t>(kind) - static_cast<std::size_t>(K::open_round)) / 2;
    };
    for (std::uint32_t i = 0; i < tokens_.size(); ++i) {
      const K kind = tokens_[i].kind;
      if (kind == K::open_round || kind == K::open_square || kind == K::open_curly) {
        open.push_back(i);
        ++counts[number(kind)];
      } else if (kind == K::close_round || kind == K::close_square || kind == K::close_curly) {
        const std::size_t n = number(kind);
        if (counts[n] == 0) continue;
        while (number(tokens_[open.back()].kind) != n) {
          --counts[number(tokens_[open.back()].kind)];
          open.pop_back();
        }
        tokens_[open.back()].partner = i;
        tokens_[i].partner = open.back();
        --counts[n];
        open.pop_back();
      }
    }
  }

  std::string_view text_;
  std::uint32_t file_;
  std::vector<Diagnostic>& diagnostics_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::uint32_t line_ = 1, column_ = 1;
  bool space_ = false, line_start_ = true, told_digits_ = false, unclosed_text_ = false;
};

/// Length of the valid UTF-8 sequence at the start of `bytes`, or 0.
std::size_t sequence_length(std::string_view bytes) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 && first <= 0xf4 ? 4 : first >= 0xe0 ? 3 : first >= 0xc2 ? 2 : 0;
  if (length == 0 || first > 0xf4 || bytes.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0U) != 0x80U) return 0;
  if ((first == 0xe0 && byte(1) < 0xa0) || (first == 0xed && byte(1) > 0x9f) || (first == 0xf0 && byte(1) < 0x90) ||
      (first == 0xf4 && byte(1) > 0x8f))
    return 0;
  return length;
}

}  // namespace

std::string to_utf8(std::string_view bytes) {
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
  bool valid = true;
  for (std::size_t at = 0; at < bytes.size() && valid;) {
    const std::size_t length = sequence_length(bytes.substr(at));
    valid = length > 0;
    at += length;
  }
  if (valid) return std::string(bytes);
  std::string text;
  text.reserve(bytes.size() + bytes.size() / 8);
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      text += c;
    } else if (byte == 0x91 || byte == 0x92) {
      text += "\u2019";  // Windows' quotes stand where Latin-1 has control characters.
    } else if (byte == 0x93 || byte == 0x94) {
      text += "\u201d";
    } else {
      text += static_cast<char>(0xc0U | (byte >> 6U));
      text += static_cast<char>(0x80U | (byte & 0x3fU));
    }
  }
  return text;
}

std::vector<Token> tokens_of(std::string_view text, std::uint32_t file, std::vector<Diagnostic>& diagnostics) {
  return Lexer(text, file, diagnostics).run();
}

std::string text_value(std::string_view slice) {
  if (!slice.empty()) slice.remove_prefix(1);
  if (slice.ends_with('"')) slice.remove_suffix(1);
  std::string value;
  value.reserve(slice.size());
  for (std::size_t i = 0; i < slice.size(); ++i) {
    if (slice[i] != '\\' || i + 1 == slice.size()) {
      value += slice[i];
      continue;
    }
    switch (slice[++i]) {
      case 'n':
        value += '\n';
        break;
      case 't':
        value += '\t';
        break;
      case 'r':
        value += '\r';
        break;
      case '"':
        value += '"';
        break;
      case '\\':
        value += '\\';
        break;
      default:
        value += '\\';
        value += slice[i];
    }
  }
  return value;
}

}  // namespace blockrand::grammar
