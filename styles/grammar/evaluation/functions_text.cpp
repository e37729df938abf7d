// Functions of texts. Positions count characters, not bytes.
#include <algorithm>
#include <regex>

#include "styles/grammar/evaluation/function_groups.h"
#include "styles/grammar/evaluation/pattern.h"
#include "styles/grammar/language/value_text.h"

namespace blockrand::grammar {
namespace {

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }
bool plain(std::string_view s) {
  return std::none_of(s.begin(), s.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80; });
}
/// Characters of UTF-8; stray bytes count as one each at least.
std::size_t length(std::string_view s) {
  return static_cast<std::size_t>(std::count_if(s.begin(), s.end(), [](char c) { return !continues(c); }));
}
/// Byte at which character `index` begins.
std::size_t byte_of(std::string_view s, std::size_t index) {
  if (plain(s)) return std::min(index, s.size());
  std::size_t at = 0;
  for (; at < s.size(); ++at)
    if (!continues(s[at]) && index-- == 0) break;
  return at;
}
double index_of(std::string_view s, std::size_t byte) {
  return byte == std::string_view::npos ? -1 : static_cast<double>(length(s.substr(0, byte)));
}

/// Byte of occurrence number `n`; occurrences do not overlap.
std::size_t occurrence(std::string_view s, std::string_view match, long long n) {
  if (match.empty() || n < 0) return std::string_view::npos;
  std::size_t at = s.find(match);
  for (; at != std::string_view::npos && n > 0; --n) at = s.find(match, at + match.size());
  return at;
}

FunctionResult count(Arguments a, FunctionContext&) {
  const std::string_view s = text(a[0]), match = text(a[1]);
  double found = 0;
  if (!match.empty())
    for (std::size_t at = s.find(match); at != std::string_view::npos; at = s.find(match, at + match.size())) ++found;
  return Value(found);
}
FunctionResult find(Arguments a, FunctionContext&) {
  return Value(index_of(text(a[0]), occurrence(text(a[0]), text(a[1]), a.size() > 2 ? whole(number(a[2])) : 0)));
}
FunctionResult find_first(Arguments a, FunctionContext&) {
  return Value(index_of(text(a[0]), occurrence(text(a[0]), text(a[1]), 0)));
}
FunctionResult find_last(Arguments a, FunctionContext&) {
  return Value(text(a[1]).empty() ? -1.0 : index_of(text(a[0]), text(a[0]).rfind(text(a[1]))));
}
FunctionResult text_length(Arguments a, FunctionContext&) { return Value(static_cast<double>(length(text(a[0])))); }

FunctionResult substring(Arguments a, FunctionContext&) {
  const std::string& s = text(a[0]);
  const auto characters = static_cast<long long>(length(s));
  const long long from = std::clamp(whole(number(a[1])), 0LL, characters);
  const long long to = a.size() > 2 ? std::clamp(whole(number(a[2])), 0LL, characters) : characters;
  if (to <= from) return Value(std::string());
  const std::size_t first = byte_of(s, static_cast<std::size_t>(from));
  return Value(s.substr(first, byte_of(s, static_cast<std::size_t>(to)) - first));
}

FunctionResult prefix(Arguments a, FunctionContext&) {
  const std::size_t at = occurrence(text(a[0]), text(a[1]), 0);
  return Value(at == std::string::npos ? std::string() : text(a[0]).substr(0, at));
}
FunctionResult suffix(Arguments a, FunctionContext&) {
  const std::size_t at = text(a[1]).empty() ? std::string::npos : text(a[0]).rfind(text(a[1]));
  return Value(at == std::string::npos ? std::string() : text(a[0]).substr(at + text(a[1]).size()));
}
/// From the end of the first left match to the beginning of the last right one; "" when they overlap or one is missing.
FunctionResult range(Arguments a, FunctionContext&) {
  const std::string &s = text(a[0]), &left = text(a[1]), &right = text(a[2]);
  const std::size_t from = left.empty() ? 0 : s.find(left), to = right.empty() ? s.size() : s.rfind(right);
  if (from == std::string::npos || to == std::string::npos || to < from + left.size()) return Value(std::string());
  return Value(s.substr(from + left.size(), to - from - left.size()));
}
FunctionResult replace(Arguments a, FunctionContext&) {
  const std::string &s = text(a[0]), &match = text(a[1]), &by = text(a[2]);
  if (match.empty()) return a[0];
  std::string out;
  std::size_t done = 0;
  for (std::size_t at = s.find(match); at != std::string::npos; at = s.find(match, done)) {
    out.append(s, done, at - done).append(by);
    done = at + match.size();
  }
  return Value(out.append(s, done));
}

tl::expected<std::vector<std::string>, std::string> split_by_pattern(const std::string& s, const std::string& pattern) {
  if (s.size() > kLongestForPattern) return failure("the text is too long for a split by a pattern");
  const auto read = read_pattern(pattern);
  if (!read) return failure(read.error());
  const std::regex& by = *read;
  try {
    std::vector<std::string> out;
    std::size_t done = 0, look = 0;
    std::cmatch found;
    while (look <= s.size() &&
           std::regex_search(s.data() + look, s.data() + s.size(), found, by,
                             look > 0 ? std::regex_constants::match_prev_avail : std::regex_constants::match_default)) {
      const std::size_t at = look + static_cast<std::size_t>(found.position());
      const auto width = static_cast<std::size_t>(found.length());
      if (width == 0 && (at == done || at == s.size())) {  // an empty match splits between characters only
        look = at + 1;
        continue;
      }
      out.push_back(s.substr(done, at - done));
      done = look = at + width;
      if (out.size() > kMostArrayItems) return failure("the text has too many parts");
    }
    out.push_back(s.substr(done));
    return out;
  } catch (const std::regex_error&) {
    return failure("'" + pattern + "' is no pattern that is understood here");
  }
}

FunctionResult split_text(Arguments a, FunctionContext&) {
  const std::string &s = text(a[0]), &by = text(a[1]);
  std::vector<std::string> out;
  if (by.size() > 1 && by[0] == '$') {
    auto parts = split_by_pattern(s, by.substr(1));
    if (!parts) return failure(parts.error());
    out = std::move(*parts);
  } else if (by.empty()) {  // an empty part, each character, an empty part (page func_splitString)
    out.emplace_back();
    for (std::size_t at = 0; at < s.size();) {
      std::size_t end = at + 1;
      while (end < s.size() && continues(s[end])) ++end;
      out.push_back(s.substr(at, end - at));
      at = end;
      if (out.size() > kMostArrayItems) return failure("the text has too many parts");
    }
    out.emplace_back();
  } else {
    std::size_t done = 0;
    for (std::size_t at = s.find(by); at != std::string::npos; at = s.find(by, done)) {
      out.push_back(s.substr(done, at - done));
      done = at + by.size();
      if (out.size() > kMostArrayItems) return failure("the text has too many parts");
    }
    out.push_back(s.substr(done));
  }
  const std::size_t parts = out.size();
  return Value(TextArray{std::move(out), parts});
}

}  // namespace

std::span<const FunctionEntry> text_functions() {
  static constexpr FunctionEntry kTable[] = {
      {"count", "ss", count},
      {"find", "ss", find},
      {"find", "ssn", find},
      {"findFirst", "ss", find_first},
      {"findLast", "ss", find_last},
      {"getPrefix", "ss", prefix},
      {"getRange", "sss", range},
      {"getSuffix", "ss", suffix},
      {"len", "s", text_length},
      {"replace", "sss", replace},
      {"splitString", "ss", split_text},
      {"substring", "sn", substring},
      {"substring", "snn", substring},
  };
  return kTable;
}

}  // namespace blockrand::grammar
