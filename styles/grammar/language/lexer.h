// Rule text into tokens (docs/rule_language.md §1.1).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "styles/grammar/language/source.h"

namespace blockrand::grammar {

enum class TokenKind : std::uint8_t {
  end,
  name,  ///< with all its parts: scope.sx, imp.Rule
  number,
  text,     ///< a string; its slice includes the quotes
  arrow,    ///< -->
  define,   ///< :=
  connect,  ///< =:
  assign,   ///< =
  colon,
  comma,
  semicolon,
  bar,
  at,
  dot,
  relative /* ' */,
  floating /* ~ */,
  open_round,
  close_round,
  open_square,
  close_square,
  open_curly,
  close_curly,
  plus,
  minus,
  times,
  divide,
  percent,
  equal,
  not_equal,
  less,
  less_equal,
  greater,
  greater_equal,
  logical_not,
  logical_and,
  logical_or,
  each_plus,
  each_minus,
  each_times,
  each_divide,
  each_percent,
  each_equal,
  each_not_equal,
  each_less,
  each_less_equal,
  each_greater,
  each_greater_equal,
  each_and,
  each_or,
};

struct Token {
  TokenKind kind = TokenKind::end;
  bool space_before = false;             ///< blanks, comments or a new line stand before it
  bool line_start = false;               ///< nothing but blanks stands before it in its line
  bool trailing_dot = false;             ///< name: `Name.`; the slice leaves the dot out
  std::uint32_t offset = 0, length = 0;  ///< bytes of the text
  std::uint32_t line = 1, column = 1;
  /// Brackets: the token that closes (or opens) it; 0xffffffff where there is none.
  std::uint32_t partner = 0xffffffffU;
};

/// The bytes of a file as UTF-8: a byte order mark is left out, and a file that is not valid UTF-8 is read as Latin-1.
std::string to_utf8(std::string_view bytes);

/// The last token is always `end`.
/// \param file         number for locations
/// \param diagnostics  what is odd is added
std::vector<Token> tokens_of(std::string_view text, std::uint32_t file, std::vector<Diagnostic>& diagnostics);

/// What a string token says: without quotes, escapes resolved (\n, \t, \r, \", \\; other backslashes stay).
std::string text_value(std::string_view slice);

}  // namespace blockrand::grammar
