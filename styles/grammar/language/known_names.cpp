#include "styles/grammar/language/known_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "styles/grammar/language/name_tables.h"

namespace blockrand::grammar {

namespace {

struct Table {
  std::vector<BuiltIn> rows;
  std::vector<std::vector<Signature>> signatures;
  /// Looked up by name only: its order reaches no result.
  std::array<std::unordered_map<std::string_view, std::uint32_t>, 8> numbers;
};

Signature::Item read_item(std::string_view word) {
  Signature::Item item;
  if (word.ends_with('+')) {
    item.repeats = true;
    word.remove_suffix(1);
  }
  item.type = word.starts_with('<') ? 'w' : word.front();
  const std::size_t open = word.find('<');
  if (open != std::string_view::npos) item.words = word_set(word.substr(open + 1, word.size() - open - 2));
  return item;
}

Signature read_signature(std::string_view text) {
  Signature signature;
  bool optional = false;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == ' ') {
      ++at;
      continue;
    }
    const std::size_t end = std::min(text.find(' ', at), text.size());
    std::string_view word = text.substr(at, end - at);
    at = end;
    if (word == "->") {
      signature.result = text[text.find_first_not_of(' ', at)];
      break;
    }
    if (word.ends_with('?')) {
      optional = true;
      word.remove_suffix(1);
    }
    signature.items.push_back(read_item(word));
    if (!optional) signature.least = signature.items.size();
  }
  constexpr std::size_t kAnyNumber = 1000;
  signature.most = !signature.items.empty() && signature.items.back().repeats ? kAnyNumber : signature.items.size();
  return signature;
}

std::vector<Signature> read_signatures(std::string_view text) {
  std::vector<Signature> all;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('|', at), text.size());
    all.push_back(read_signature(text.substr(at, end - at)));
    at = end + 1;
  }
  return all;
}

Table make_table() {
  Table table;
  for (const auto rows : {tables::operation_rows(), tables::function_rows(), tables::other_rows()})
    table.rows.insert(table.rows.end(), rows.begin(), rows.end());
  std::sort(table.rows.begin(), table.rows.end(),
            [](const BuiltIn& a, const BuiltIn& b) { return std::tie(a.kind, a.name) < std::tie(b.kind, b.name); });
  for (std::uint32_t i = 0; i < table.rows.size(); ++i) {
    table.signatures.push_back(read_signatures(table.rows[i].signature));
    table.numbers[static_cast<std::size_t>(table.rows[i].kind)].emplace(table.rows[i].name, i);
  }
  return table;
}

const Table& table() {
  static const Table made = make_table();
  return made;
}

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

/// Letters changed, added, left out or swapped with their neighbour; more than `limit`: limit + 1.
std::size_t distance(std::string_view a, std::string_view b, std::size_t limit) {
  if (a.size() > b.size() + limit || b.size() > a.size() + limit) return limit + 1;
  std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before = std::exchange(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]))
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::span<const BuiltIn> built_ins() { return table().rows; }

const BuiltIn* find_built_in(NameKind kind, std::string_view name) {
  const auto& numbers = table().numbers[static_cast<std::size_t>(kind)];
  const auto found = numbers.find(name);
  return found == numbers.end() ? nullptr : &table().rows[found->second];
}

std::uint32_t built_in_number(const BuiltIn& entry) { return static_cast<std::uint32_t>(&entry - table().rows.data()); }

std::span<const std::string_view> word_set(std::string_view name) {
  for (const tables::WordSet& set : tables::word_sets())
    if (set.name == name) return set.words;
  return {};
}

std::span<const Signature> signatures(const BuiltIn& entry) { return table().signatures[built_in_number(entry)]; }

bool is_reserved_prefix(std::string_view name) {
  constexpr std::string_view kReserved[] = {"scope",        "split",    "comp",   "material",      "geometry",
                                            "world",        "object",   "street", "trim",          "pivot",
                                            "initialShape", "edgeAttr", "uv",     kExtensionPrefix};
  return std::find(std::begin(kReserved), std::end(kReserved), name) != std::end(kReserved);
}

bool is_engine_prefix(std::string_view name) {
  constexpr std::string_view kEngine[] = {"bay", "building", "edge", "storey", "roof", "row"};
  return std::find(std::begin(kEngine), std::end(kEngine), name) != std::end(kEngine);
}

std::string_view nearest_name(std::string_view word, std::span<const std::string_view> known) {
  constexpr std::size_t kLongest = 64;  // No name of the language is longer; what is, has no near one.
  if (word.size() > kLongest) return {};
  std::size_t best = word.size() / 3 + 1;
  std::string_view nearest;
  for (const std::string_view candidate : known) {
    if (best == 0) break;
    const std::size_t d = distance(word, candidate, best - 1);
    if (d < best) {
      best = d;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string_view nearest_built_in(NameKind kind, std::string_view word) {
  std::vector<std::string_view> names;
  for (const BuiltIn& entry : built_ins())
    if (entry.kind == kind) names.push_back(entry.name);
  return nearest_name(word, names);
}

}  // namespace blockrand::grammar
