// Located TOML: every value that is read knows file, line and column; every key that nobody asks for is an error.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace blockrand::base {

/// What may be a number or a calculation.
using NumberOrText = std::variant<double, std::string>;

/// A table of a TOML file. Errors are InputErrors that name file, line, column, the key, and the nearest known key.
/// The readers return nothing where the key is absent.
class TomlTable {
 public:
  /// \throws InputError when the file cannot be read or is not TOML
  static TomlTable read(const std::string& path);
  /// \param name  what messages call the text
  static TomlTable parse(std::string_view text, const std::string& name);

  /// A copy remembers which keys were asked for, but learns nothing from the original afterwards.
  TomlTable(const TomlTable&);
  TomlTable(TomlTable&&) noexcept;
  TomlTable& operator=(TomlTable&&) noexcept;
  ~TomlTable();

  bool has(std::string_view key) const;
  std::optional<double> number(std::string_view key, double minimum, double maximum);  ///< integers are taken too
  std::optional<std::int64_t> integer(std::string_view key, std::int64_t minimum, std::int64_t maximum);
  std::optional<bool> boolean(std::string_view key);
  std::optional<std::string> text(std::string_view key);
  std::optional<std::vector<std::string>> texts(std::string_view key);
  std::optional<std::vector<double>> numbers(std::string_view key);
  std::optional<TomlTable> table(std::string_view key);
  /// The tables of an array of tables ([[key]]), in the order of the file; of a single table that one; empty: absent.
  std::vector<TomlTable> tables(std::string_view key);
  /// An array of pairs of numbers, [[1, 2], [3, 4]].
  std::optional<std::vector<std::pair<double, double>>> pairs(std::string_view key);
  std::optional<NumberOrText> number_or_text(std::string_view key);
  std::optional<std::vector<NumberOrText>> numbers_or_texts(std::string_view key);
  /// An array of pairs of both, [[1, "w / 2"], [3, 4]].
  std::optional<std::vector<std::pair<NumberOrText, NumberOrText>>> pairs_of_numbers_or_texts(std::string_view key);
  bool holds_table(std::string_view key) const;
  bool holds_number(std::string_view key) const;
  bool holds_boolean(std::string_view key) const;
  bool holds_text(std::string_view key) const;
  /// Line of `key` in the file, from 1; without such a key that of the table; 0 for the root.
  int line(std::string_view key = {}) const;
  /// Keys of this table in alphabetical order.
  std::vector<std::string> keys() const;
  /// The value of `key` as the user would write it on a command line: text without quotes, numbers and booleans as
  /// text, arrays as their elements joined by commas.
  std::optional<std::string> plain(std::string_view key);

  /// Call when all known keys were asked for: an InputError for the first key that was not, with the nearest that was.
  void finish() const;
  /// An InputError at the place of `key` (or of the table).
  [[noreturn]] void fail(std::string_view key, const std::string& what, const std::string& remedy) const;

 private:
  struct Data;
  explicit TomlTable(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

/// The entry of `known` nearest to `word` (edit distance with swaps of neighbours, at most a third of the word's
/// length, upper and lower case and `-` and `_` being the same), or empty. Of equally near ones the first.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

}  // namespace blockrand::base
