// How a stage declares its options: what each is called and may be, which member of the struct it is, who records it.
#pragma once

#include <algorithm>
#include <charconv>
#include <concepts>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "pipeline/base/option_table.h"
#include "pipeline/base/text.h"

namespace blockrand::base {

/// Which commands know an option; bits.
enum Commands : unsigned {
  kBuild = 1,
  kInfo = 2,
  kExplain = 4,
  kValidate = 8,
  kCompare = 16,
  kDistricts = 32,
  kGrammar = 64,
  kUpdate = 128,
  kStatus = 256,
  kRollback = 512,
  kRegion = 1024,
  kCache = 2048,
  kView = 4096,
  kPublish = 8192,
  kSchedule = 16384
};
inline constexpr Commands kAllCommands[] = {kBuild,     kInfo,    kExplain, kValidate, kCompare,
                                            kDistricts, kGrammar, kUpdate,  kStatus,   kRollback,
                                            kRegion,    kCache,   kView,    kPublish,  kSchedule};
std::string_view name(Commands command);  ///< "build"

/// Where an option stands in help and reference. One with keys is a table of the config file, too, and all but the main
/// section are a member of the record in build.json.
struct OptionSection {
  std::string_view name{};   ///< "repair"
  std::string_view title{};  ///< "How far repair may go"
  bool tuning = false;       ///< left to reference and manual: the --help of a command does not list it

  bool operator==(const OptionSection&) const = default;
};
inline constexpr OptionSection kMainSection{.name = "build", .title = "What is built"};

enum class OptionType : std::uint8_t { text, path, folder, integer, number, flag, list };

/// Whether a result's own record has an option: build.json, of `compare` compare.json.
enum class OptionRecord : std::uint8_t {
  none,    ///< it changes nothing that is computed
  yes,     ///< a tile that is built alone may still have another value
  binding  ///< a tile that is built alone fits into builds with the same value only
};

/// Why a text cannot be the value of an option; the caller adds which option and where.
struct ValueError : std::runtime_error {
  ValueError(const std::string& what, std::string how) : std::runtime_error(what), remedy(std::move(how)) {}
  std::string remedy;
};

/// What people read about an option, and where. All texts outlive it: they are literals.
struct OptionDescription {
  std::string_view name{};      ///< long name without dashes; of a positional argument its name in capitals
  std::string_view letter{};    ///< short name without dash, or empty
  std::string_view key{};       ///< in the config file; empty: command line only
  std::string_view argument{};  ///< what the value is called; empty for flags
  OptionType type = OptionType::text;
  OptionSection section = kMainSection;
  unsigned commands = kBuild;
  double minimum = 0, maximum = 0;  ///< of integers and numbers
  std::string_view help{};          ///< one line, with the unit, without the default
  /// What --help of some commands says instead, where it means less or another thing to them: bits of Commands, one line.
  std::vector<std::pair<unsigned, std::string_view>> help_of{};
  std::string_view without{};          ///< of a flag that is on by default: what --no-… leaves out; one line
  bool several = false;                ///< may be given more than once: each value is set in turn
  std::string_view if_missing{};       ///< what to say when it has no value; empty: it need not have one
  unsigned optional_for = 0;           ///< commands that do without it all the same
  std::vector<std::string> choices{};  ///< words that are a value (of a list: an item), for completion
  /// Name of the option behind which it stands in help and reference, where that is one of another struct; empty:
  /// behind the one before it in its own table.
  std::string_view after{};
  /// By default the safe one: what nobody thought about is recorded and compared.
  OptionRecord record = OptionRecord::binding;
  /// In its section of the record, where not the order of the table decides: lower places first, the others behind.
  int record_place = kNoPlace;

  static constexpr int kNoPlace = 1000;
  bool positional() const { return !name.empty() && name[0] >= 'A' && name[0] <= 'Z'; }
  std::string_view record_key() const { return key.empty() ? name : key; }
};

/// A value as a record has it; monostate: null.
using RecordValue = std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string,
                                 std::vector<double>, std::vector<std::string>>;

/// An option of a struct. The default is the value that a fresh struct has.
template <class Struct>
struct Option : OptionDescription {
  /// Sets the value from text; of flags "true" or "false". \throws ValueError
  std::function<void(Struct&, const std::string&)> set;
  /// The value as text that `set` understands; empty where nothing is set.
  std::function<std::string(const Struct&)> show;
  /// The value for a record; nothing: the record does without the option.
  std::function<std::optional<RecordValue>(const Struct&)> recorded;
};

// ---- Reading and showing values.

/// `text` in single quotes, as messages have it.
std::string in_quotes(std::string_view text);

/// \param remedy  what ValueError tells people to write instead
/// \throws ValueError  `text` is no finite number
double parse_number(std::string_view text, const std::string& remedy);

/// A number from minimum to maximum of the option. \param kind  "number", "whole number", for messages
/// \throws ValueError
double parse_in_range(const OptionDescription& option, const std::string& text, const char* kind);

/// "Write a whole number from 0 to 3."
std::string range_remedy(const OptionDescription& option, const char* kind);

/// The parts of `text` between separators, without spaces around them; at least one.
std::vector<std::string> split(std::string_view text, char separator);

std::string joined(const std::vector<std::string>& texts, std::string_view separator);

/// \throws ValueError  always: with all known words and the nearest one
[[noreturn]] void unknown_word(const std::string& word, const std::vector<std::string>& known);

/// Words and the values they stand for, in the order of all listings.
template <class T>
using Choices = std::vector<std::pair<std::string, T>>;

template <class T>
std::vector<std::string> words_of(const Choices<T>& choices) {
  std::vector<std::string> words;
  for (const auto& [word, value] : choices) words.push_back(word);
  return words;
}

/// The value that a word stands for. \throws ValueError  unknown word
template <class T>
T choose(const std::string& word, const Choices<T>& choices) {
  for (const auto& [known, value] : choices)
    if (known == word) return value;
  unknown_word(word, words_of(choices));
}

/// The word that stands for a value; empty where none does.
template <class T>
std::string word_of(const Choices<T>& choices, const T& value) {
  for (const auto& [word, v] : choices)
    if (v == value) return word;
  return {};
}

// ---- Entries of a table, by the kind of their member.

/// An option whose value is no plain member. `set`, `show` and `recorded` are as Option has them.
/// \param recorded  none: the text that `show` returns
template <class S>
Option<S> custom(OptionDescription d, std::type_identity_t<std::function<void(S&, const std::string&)>> set,
                 std::type_identity_t<std::function<std::string(const S&)>> show,
                 std::type_identity_t<std::function<std::optional<RecordValue>(const S&)>> recorded = {}) {
  if (!recorded) recorded = [show](const S& s) { return RecordValue(show(s)); };
  return Option<S>{std::move(d), std::move(set), std::move(show), std::move(recorded)};
}

template <class S>
Option<S> text(OptionDescription d, std::string S::*member) {
  return custom<S>(
      std::move(d), [member](S& s, const std::string& text) { s.*member = text; },
      [member](const S& s) { return s.*member; });
}

/// Text that is one of the option's choices.
template <class S>
Option<S> word(OptionDescription d, std::string S::*member) {
  std::vector<std::string> known = d.choices;
  return custom<S>(
      std::move(d),
      [member, known = std::move(known)](S& s, const std::string& text) {
        if (std::find(known.begin(), known.end(), text) == known.end()) unknown_word(text, known);
        s.*member = text;
      },
      [member](const S& s) { return s.*member; });
}

/// Texts that are given one by one.
template <class S>
Option<S> texts(OptionDescription d, std::vector<std::string> S::*member) {
  d.several = true;
  return custom<S>(
      std::move(d), [member](S& s, const std::string& text) { (s.*member).push_back(text); },
      [member](const S& s) { return joined(s.*member, " "); }, [member](const S& s) { return RecordValue(s.*member); });
}

template <class S>
Option<S> flag(OptionDescription d, bool S::*member) {
  d.type = OptionType::flag;
  return custom<S>(
      std::move(d), [member](S& s, const std::string& text) { s.*member = text == "true"; },
      [member](const S& s) { return s.*member ? "true" : "false"; },
      [member](const S& s) { return RecordValue(s.*member); });
}

template <class S, std::integral T>
Option<S> integer(OptionDescription d, T S::*member) {
  d.type = OptionType::integer;
  const OptionDescription range = d;
  return custom<S>(
      std::move(d),
      [member, range](S& s, const std::string& text) {
        T value{};
        parse_in_range(range, text, "whole number");
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size())
          throw ValueError(in_quotes(text) + " is not a whole number", range_remedy(range, "whole number"));
        s.*member = value;
      },
      [member](const S& s) { return std::to_string(s.*member); },
      [member](const S& s) {
        using Wide = std::conditional_t<std::is_signed_v<T>, std::int64_t, std::uint64_t>;
        return RecordValue(static_cast<Wide>(s.*member));
      });
}

template <class S>
Option<S> number(OptionDescription d, double S::*member) {
  d.type = OptionType::number;
  const OptionDescription range = d;
  return custom<S>(
      std::move(d),
      [member, range](S& s, const std::string& text) { s.*member = parse_in_range(range, text, "number"); },
      [member](const S& s) { return shortest(s.*member); }, [member](const S& s) { return RecordValue(s.*member); });
}

/// A number that need not be given.
template <class S>
Option<S> number(OptionDescription d, std::optional<double> S::*member) {
  d.type = OptionType::number;
  const OptionDescription range = d;
  return custom<S>(
      std::move(d),
      [member, range](S& s, const std::string& text) { s.*member = parse_in_range(range, text, "number"); },
      [member](const S& s) { return s.*member ? shortest(*(s.*member)) : ""; },
      [member](const S& s) { return s.*member ? RecordValue(*(s.*member)) : RecordValue(); });
}

/// One of several values, by its word.
template <class S, class T>
Option<S> choice(OptionDescription d, const Choices<T>& choices, T S::*member) {
  d.choices = words_of(choices);
  return custom<S>(
      std::move(d), [member, choices](S& s, const std::string& text) { s.*member = choose(text, choices); },
      [member, choices](const S& s) { return word_of(choices, s.*member); });
}

// ---- Tables of structs that hold others.

/// An option of the struct that is a member of another, as an option of that other.
template <class Outer, class S>
Option<Outer> of_member(const Option<S>& option, S Outer::*member) {
  const OptionDescription& description = option;
  return custom<Outer>(
      description, [member, set = option.set](Outer& outer, const std::string& text) { set(outer.*member, text); },
      [member, show = option.show](const Outer& outer) { return show(outer.*member); },
      [member, recorded = option.recorded](const Outer& outer) { return recorded(outer.*member); });
}

template <class Outer, class S>
OptionTable<Outer> of_member(const OptionTable<S>& table, S Outer::*member) {
  OptionTable<Outer> lifted;
  for (const Option<S>& option : table) lifted.push_back(of_member(option, member));
  return lifted;
}

/// The table with all its entries in one section.
template <class S>
OptionTable<S> in_section(const OptionSection& section, OptionTable<S> table) {
  for (Option<S>& option : table) option.section = section;
  return table;
}

/// All entries of several tables, one table after the other.
template <class S>
OptionTable<S> concatenated(std::initializer_list<OptionTable<S>> tables) {
  OptionTable<S> all;
  for (const OptionTable<S>& table : tables) all.insert(all.end(), table.begin(), table.end());
  return all;
}

}  // namespace blockrand::base
