#include "pipeline/outputs/explain/place_words.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "pipeline/base/folded_text.h"

namespace blockrand::outputs {
namespace {

/// More than that between its ends is no range of houses: a postcode, a telephone number.
constexpr long kLongestRange = 100;
/// Digits of a word that is no house number, but a postcode, where it stands behind a comma.
constexpr std::size_t kPostcodeDigits = 4;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool all_digits(std::string_view word) { return !word.empty() && std::all_of(word.begin(), word.end(), is_digit); }

/// Words for kinds of streets, folded, in one form each; the empty form: people leave it out.
std::string_view short_form(std::string_view word) {
  constexpr std::pair<std::string_view, std::string_view> kForms[] = {
      {"strase", "str"},    {"strada", "str"},     {"platz", "pl"},     {"place", "pl"},    {"street", "st"},
      {"saint", "st"},      {"sankt", "st"},       {"road", "rd"},      {"avenu", "av"},    {"avenue", "av"},
      {"ave", "av"},        {"square", "sq"},      {"squar", "sq"},     {"lane", "ln"},     {"drive", "dr"},
      {"terrace", "ter"},   {"court", "ct"},       {"sokak", "sok"},    {"sokagi", "sok"},  {"sk", "sok"},
      {"caddesi", "cad"},   {"cadde", "cad"},      {"cd", "cad"},       {"bulvari", "blv"}, {"bulvar", "blv"},
      {"boulevard", "blv"}, {"blvd", "blv"},       {"bd", "blv"},       {"namesti", "nam"}, {"ulice", ""},
      {"ulica", ""},        {"ulitsa", ""},        {"ul", ""},          {"улица", ""},      {"ул", ""},
      {"проспект", "пр"},   {"просп", "пр"},       {"переулок", "пер"}, {"площадь", "пл"},  {"бульвар", "бул"},
      {"б-р", "бул"},       {"набережная", "наб"}, {"шоссе", "ш"},      {"проезд", "прд"},  {"пр-д", "прд"},
      {"пр-т", "пр"},
  };
  for (const auto& [word_form, form] : kForms)
    if (word == word_form) return form;
  return word;
}

/// "zionskirchstrase" → "zionskirchstr".
std::string with_short_end(std::string word) {
  for (const auto& [ending, form] : {std::pair<std::string_view, std::string_view>{"strase", "str"}, {"platz", "pl"}})
    if (word.size() > ending.size() && word.ends_with(ending)) {
      word.replace(word.size() - ending.size(), ending.size(), form);
      break;
    }
  return word;
}

/// Says "number" before a number.
bool introduces_number(std::string_view word) {
  constexpr std::string_view kWords[] = {"no", "nr", "num", "hausnr", "hausnummer", "дом", "д", "d"};
  return std::find(std::begin(kWords), std::end(kWords), word) != std::end(kWords);
}

/// "a", "б"; or "bis", "ter" as in French numbers.
bool is_addition(std::string_view word) {
  if (word == "bis" || word == "ter") return true;
  const auto first = static_cast<unsigned char>(word.empty() ? 0 : word[0]);
  return (word.size() == 1 && first >= 'a' && first <= 'z') || (word.size() == 2 && (first == 0xD0 || first == 0xD1));
}

std::vector<std::string> pieces_of(std::string_view text, std::string_view separators) {
  std::vector<std::string> out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(separators), text.size());
    if (end > 0) out.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

/// Chunks between spaces as words: "karl-marx-allee" is three, "5-7" one.
std::vector<std::string> raw_words(const std::string& folded) {
  std::vector<std::string> out;
  bool joins = false;  // "3 - 7"
  for (std::string chunk : pieces_of(folded, " ")) {
    if (chunk == "-") {
      joins = !out.empty() && is_number(out.back());
      continue;
    }
    const std::size_t first = chunk.find_first_not_of("-/"), last = chunk.find_last_not_of("-/");
    if (first == std::string::npos) continue;
    chunk = chunk.substr(first, last - first + 1);
    if (is_number(chunk)) {
      if (joins)
        out.back() += "-" + chunk;
      else
        out.push_back(std::move(chunk));
    } else if (short_form(chunk) != chunk) {
      out.push_back(std::move(chunk));
    } else {
      for (std::string& piece : pieces_of(chunk, "-/")) out.push_back(std::move(piece));
    }
    joins = false;
  }
  return out;
}

/// Digits at the start, what follows them.
std::pair<long, std::string_view> split_number(std::string_view word) {
  long value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc()) return {0, word};
  return {value, word.substr(static_cast<std::size_t>(end - word.data()))};
}

/// "3-7", "3a-7".
std::optional<std::pair<long, long>> range_of(std::string_view word) {
  const std::size_t dash = word.find('-');
  if (dash == std::string_view::npos || !is_number(word.substr(dash + 1))) return std::nullopt;
  const long low = first_number(word), high = first_number(word.substr(dash + 1));
  if (low >= high || high - low > kLongestRange) return std::nullopt;
  return std::pair(low, high);
}

/// One side of a street where both ends lie on it.
bool within(const std::pair<long, long>& range, long number) {
  const bool one_side = (range.first - range.second) % 2 == 0;
  return number >= range.first && number <= range.second && (!one_side || (number - range.first) % 2 == 0);
}

std::string trimmed_text(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return std::string(text);
}

/// "Arkonaplatz 5 a" → "Arkonaplatz".
std::string without_number(std::string_view text) {
  for (std::size_t space = text.rfind(' '); space != std::string_view::npos && space > 0;
       space = text.rfind(' ', space - 1))
    if (space + 1 < text.size() && is_digit(text[space + 1])) return trimmed_text(text.substr(0, space));
  return trimmed_text(text);
}

}  // namespace

bool is_number(std::string_view word) { return !word.empty() && is_digit(word[0]); }

long first_number(std::string_view word) { return split_number(word).first; }

std::vector<std::string> place_words(std::string_view text) {
  const std::vector<std::string> raw = raw_words(base::folded(text));
  std::vector<std::string> out;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const std::string& word = raw[i];
    const bool number_follows = i + 1 < raw.size() && is_number(raw[i + 1]);
    if (is_number(word)) {
      out.push_back(word);
      if (all_digits(word) && i + 1 < raw.size() && is_addition(raw[i + 1])) out.back() += raw[++i];
      continue;
    }
    if (number_follows && introduces_number(word)) continue;
    std::string form = with_short_end(std::string(short_form(word)));
    if (!form.empty()) out.push_back(std::move(form));
  }
  return out;
}

std::string joined(const std::vector<std::string>& words, std::size_t first, std::size_t end) {
  std::string out;
  for (std::size_t i = first; i < end; ++i) out += words[i];
  return out;
}

PlaceAddresses place_addresses(std::string_view text) {
  PlaceAddresses out;
  for (const std::string& piece : pieces_of(text, ";")) {
    const std::vector<std::string> parts = pieces_of(piece, ",");
    if (parts.empty()) continue;
    std::vector<std::string> words = place_words(parts[0]);
    PlaceAddress address;
    if (words.size() == 1 && all_digits(words[0]) && words[0].size() >= kPostcodeDigits) {  // a postcode alone
      out.locality.push_back(words[0]);
      continue;
    }
    if (!words.empty() && is_number(words.back())) {
      address.numbers.push_back(words.back());
      words.pop_back();
    }
    address.street = joined(words, 0, words.size());
    address.shown_street = without_number(parts[0]);
    if (address.street.empty() && !out.all.empty()) {  // "Arkonaplatz 5; 7": the street before
      address.street = out.all.back().street;
      address.shown_street = out.all.back().shown_street;
    }
    std::size_t next = 1;
    for (; next < parts.size(); ++next) {  // "Arkonaplatz 5, 7"
      const std::vector<std::string> more = place_words(parts[next]);
      if (more.size() != 1 || !is_number(more[0]) || (all_digits(more[0]) && more[0].size() >= kPostcodeDigits)) break;
      address.numbers.push_back(more[0]);
    }
    for (; next < parts.size(); ++next)
      for (std::string& word : place_words(parts[next])) out.locality.push_back(std::move(word));
    out.all.push_back(std::move(address));
  }
  // "1; Lange Straße 2": numbers without a street before the first that has one.
  const auto with_street =
      std::find_if(out.all.begin(), out.all.end(), [](const PlaceAddress& a) { return !a.street.empty(); });
  if (with_street != out.all.end())
    for (auto before = out.all.begin(); before != with_street; ++before) {
      before->street = with_street->street;
      before->shown_street = with_street->shown_street;
    }
  return out;
}

NumberMatch match_numbers(std::string_view wanted, std::string_view there) {
  if (wanted == there) return NumberMatch::same;
  if (const std::vector<std::string> both = pieces_of(there, "/"); both.size() > 1 && all_digits(both[1]))
    for (const std::string& one : both)
      if (one == wanted) return NumberMatch::half;
  const auto range = range_of(there), wanted_range = range_of(wanted);
  const long number = first_number(there), wanted_number = first_number(wanted);
  if (range && !wanted_range && within(*range, wanted_number)) return NumberMatch::beside;
  if (wanted_range && !range && within(*wanted_range, number)) return NumberMatch::beside;
  return number == wanted_number && number > 0 ? NumberMatch::beside : NumberMatch::none;
}

}  // namespace blockrand::outputs
