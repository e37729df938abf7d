// Every name that the language brings with it: one table for the parser, the evaluator, checks and documentation.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "styles/grammar/language/ast.h"
#include "styles/grammar/language/value.h"

namespace blockrand::grammar {

enum class NameKind : std::uint8_t {
  operation,
  function,   ///< built-in functions and the utility library
  attribute,  ///< read as bare names: scope.sx, split.index …
  selector,   ///< of components, in blocks
  word,       ///< bare keywords as arguments: world.up, byHeight, adjust …
  annotation,
  keyword,
  syntax,  ///< forms of the language, by the names of docs/rule_language.md §6.2: "case/else (rule)"
};

/// The order of building of docs/rule_language.md §6.3.
enum class Tier : std::uint8_t { a, b, c, d, e, f, g };

enum class Status : std::uint8_t {
  runs,
  default_answer,  ///< runs, with an answer that does not depend on the scene: touches() is false
  not_yet,         ///< told by name where a file uses it; the shape stays as it is
};

struct BuiltIn {
  NameKind kind = NameKind::operation;
  std::string_view name;
  /// Alternatives separated by " | ". Each: parameters separated by blanks, and for functions and attributes "-> type"
  /// at the end. A parameter is a type letter, or words in angle brackets; "?" after it: it and what follows may be
  /// left out; "+": once or more. Types: n number, b truth, s text, N B S arrays, v any single value, V any array, a
  /// any value, r a number that may have ' or ~, e what selects components. "<axis>" is a set of words (word_set).
  std::string_view signature = "";
  Tier tier = Tier::b;
  Status status = Status::runs;
  BlockKind block = BlockKind::none;  ///< operations: what stands in the braces
  bool settable = false;              ///< attributes: `set` may change them
  std::uint32_t corpus_files = 0;     ///< how many published files use it (docs/rule_language.md §6.2); 0: none or not
                                      ///< counted
};

/// All of them, ordered by kind and name; the position of a name is its number (Target::index).
std::span<const BuiltIn> built_ins();
/// \returns nullptr where there is none
const BuiltIn* find_built_in(NameKind kind, std::string_view name);
std::uint32_t built_in_number(const BuiltIn& entry);

/// The words of a set that signatures name: word_set("axis") → x, y, z. Empty: unknown set.
std::span<const std::string_view> word_set(std::string_view name);

/// One way to call a built-in.
struct Signature {
  struct Item {
    char type = 'a';                          ///< as in BuiltIn::signature; 'w': words only
    std::span<const std::string_view> words;  ///< that may stand there
    bool repeats = false;
  };
  std::vector<Item> items;
  std::size_t least = 0, most = 0;  ///< arguments
  char result = 0;                  ///< type letter, 0 for operations
  const Item& item(std::size_t argument) const { return items[argument < items.size() ? argument : items.size() - 1]; }
};
/// BuiltIn::signature taken apart; computed once for all names.
std::span<const Signature> signatures(const BuiltIn& entry);

/// Whether a first part of a name belongs to the language, so that no import can be called so
/// (docs/rule_language.md §7.2, 20).
bool is_reserved_prefix(std::string_view name);

/// Whether a first part of a name stands for values that the program gives about the building, its storey, its edge,
/// its roof or its row (DeriveOptions::source): "bay", "building", "edge", "storey", "roof", "row". An import of the same name
/// goes before.
bool is_engine_prefix(std::string_view name);

/// The prefix of our own operations: blockrand.window(…).
inline constexpr std::string_view kExtensionPrefix = "blockrand";

/// The entry of `known` nearest to `word` by letters changed, added, left out or swapped (upper and lower case being
/// the same), at most a third of the word's length; empty when none is near. Of equally near ones the first.
std::string_view nearest_name(std::string_view word, std::span<const std::string_view> known);
/// The nearest among the built-ins of a kind.
std::string_view nearest_built_in(NameKind kind, std::string_view word);

}  // namespace blockrand::grammar
