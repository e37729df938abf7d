#include "pipeline/base/toml_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>

#include "pipeline/base/error.h"
#include "pipeline/base/text.h"

namespace blockrand::base {
namespace {

constexpr std::size_t kListedKeys = 16;  // a longer list helps nobody

std::string place(const toml::source_position& position) {
  return position.line == 0 ? "" : std::to_string(position.line) + ":" + std::to_string(position.column);
}

std::string kind_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
      return "the integer " + std::to_string(node.ref<std::int64_t>());
    case toml::node_type::floating_point:
      return "the number " + shortest(node.ref<double>());
    case toml::node_type::boolean:
      return "a boolean";
    case toml::node_type::none:
    case toml::node_type::date:
    case toml::node_type::time:
    case toml::node_type::date_time:
      break;
  }
  return "a date or time";
}

/// A number node as a double. toml++'s own value<double>() has none for whole numbers that a double rounds.
double as_double(const toml::node& number) {
  return number.is_integer() ? static_cast<double>(number.ref<std::int64_t>()) : number.ref<double>();
}

std::string range_text(const std::string& minimum, const std::string& maximum) {
  return "Write a number from " + minimum + " to " + maximum + ".";
}

char folded(char c) {
  if (c >= 'A' && c <= 'Z') return static_cast<char>(c - 'A' + 'a');
  return c == '_' ? '-' : c;
}

/// toml++ makes, walks and frees a table for each part of a dotted key by recursion.
constexpr int kMostKeyParts = 64;

/// \throws InputError  a dotted key, of a header, a line or an inline table, has more parts than the parser bears
void refuse_deep_keys(std::string_view text, const std::string& name) {
  int line = 1, dots = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' || c == '\'') {  // to the end of the string: of one line, or of several between three quotes
      const std::string_view rest = text.substr(i);
      const bool several = rest.size() > 2 && rest[1] == c && rest[2] == c;
      std::size_t end = several ? i + 3 : i + 1;
      for (; end < text.size(); ++end) {
        if (text[end] == '\n') {
          if (!several) break;  // the parser will say so
          ++line;
        }
        if (text[end] == '\\' && c == '"') {
          ++end;
        } else if (text[end] == c && (!several || text.substr(end, 3) == std::string(3, c))) {
          break;
        }
      }
      i = std::min(text.size(), several ? end + 2 : end);
      if (i < text.size() && text[i] == '\n') --i;
    } else if (c == '#') {
      i = std::min(text.size(), text.find('\n', i)) - 1;
    } else if (c == '.') {
      if (++dots >= kMostKeyParts)
        throw InputError(name, std::to_string(line), "a key has more than " + std::to_string(kMostKeyParts) + " parts",
                         "No option is that deep.");
    } else if (std::string_view("=,{}[]\n").find(c) != std::string_view::npos) {
      dots = 0;
      if (c == '\n') ++line;
    }
  }
}

}  // namespace

struct TomlTable::Data {
  std::shared_ptr<const toml::table> root;
  const toml::table* table = nullptr;
  std::string file;
  std::string path;  ///< dotted, with a dot at the end; empty for the root
  toml::source_position position;
  std::set<std::string, std::less<>> asked;

  const toml::node* ask(std::string_view key) {
    asked.emplace(key);
    return table->get(key);
  }
  /// `node` is a table.
  std::unique_ptr<Data> below(const toml::node& node, std::string path_of_keys) const {
    auto data = std::make_unique<Data>();
    data->root = root;
    data->table = node.as_table();
    data->file = file;
    data->path = std::move(path_of_keys);
    data->position = node.source().begin;
    return data;
  }
  [[noreturn]] void fail(const toml::node& node, std::string_view key, const std::string& what,
                         const std::string& remedy) const {
    throw InputError(file, place(node.source().begin), path + std::string(key) + " " + what, remedy);
  }
};

TomlTable::TomlTable(std::unique_ptr<Data> data) : data_(std::move(data)) {}
TomlTable::TomlTable(const TomlTable& other) : data_(std::make_unique<Data>(*other.data_)) {}
TomlTable::TomlTable(TomlTable&&) noexcept = default;
TomlTable& TomlTable::operator=(TomlTable&&) noexcept = default;
TomlTable::~TomlTable() = default;

TomlTable TomlTable::read(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  bool readable = file.is_open();
  try {
    if (readable) text.assign(std::istreambuf_iterator<char>(file), {});
  } catch (const std::ios_base::failure&) {
    // libstdc++ throws from the buffer itself for a folder, which can be opened but not read.
    readable = false;
  }
  if (!readable)
    throw InputError(path, "", errno != 0 ? std::strerror(errno) : "cannot be read",
                     "Check the path and the file's permissions.");
  return parse(text, path);
}

TomlTable TomlTable::parse(std::string_view text, const std::string& name) {
  refuse_deep_keys(text, name);
  try {
    auto data = std::make_unique<Data>();
    data->root = std::make_shared<const toml::table>(toml::parse(text, name));
    data->table = data->root.get();
    data->file = name;
    return TomlTable(std::move(data));
  } catch (const toml::parse_error& error) {
    throw InputError(name, place(error.source().begin), "not valid TOML: " + std::string(error.description()),
                     "See https://toml.io for the syntax.");
  }
}

bool TomlTable::has(std::string_view key) const { return data_->table->contains(key); }

std::optional<double> TomlTable::number(std::string_view key, double minimum, double maximum) {
  const toml::node* node = data_->ask(key);
  if (!node) return std::nullopt;
  const std::string remedy = range_text(shortest(minimum), shortest(maximum));
  if (!node->is_number()) data_->fail(*node, key, "must be a number, not " + kind_name(*node), remedy);
  const double value = as_double(*node);
  // Written so that NaN fails, too.
  if (!(value >= minimum && value <= maximum)) data_->fail(*node, key, "is out of range: " + shortest(value), remedy);
  return value;
}

std::optional<std::int64_t> TomlTable::integer(std::string_view key, std::int64_t minimum, std::int64_t maximum) {
  const toml::node* node = data_->ask(key);
  if (!node) return std::nullopt;
  const std::string remedy =
      "Write a whole number from " + std::to_string(minimum) + " to " + std::to_string(maximum) + ".";
  if (!node->is_integer()) data_->fail(*node, key, "must be a whole number, not " + kind_name(*node), remedy);
  const std::int64_t value = node->ref<std::int64_t>();
  if (value < minimum || value > maximum) data_->fail(*node, key, "is out of range: " + std::to_string(value), remedy);
  return value;
}

std::optional<bool> TomlTable::boolean(std::string_view key) {
  const toml::node* node = data_->ask(key);
  if (!node) return std::nullopt;
  if (!node->is_boolean()) data_->fail(*node, key, "must be true or false, not " + kind_name(*node), "");
  return node->ref<bool>();
}

std::optional<std::string> TomlTable::text(std::string_view key) {
  const toml::node* node = data_->ask(key);
  if (!node) return std::nullopt;
  if (!node->is_string()) data_->fail(*node, key, "must be a text in quotes, not " + kind_name(*node), "");
  return node->ref<std::string>();
}

std::optional<std::vector<std::string>> TomlTable::texts(std::string_view key) {
  const toml::node* node = data_->ask(key);
  if (!node) return std::nullopt;
  const std::string remedy = "Write it like [\"a\", \"b\"].";
  if (!node->is_array()) data_->fail(*node, key, "must be an array of texts, not " + kind_name(*node), remedy);
  std::vector<std::string> values;
  for (const toml::node& entry : *node->as_array()) {
    if (!entry.is_string()) data_->fail(entry, key, "must hold texts only, not " + kind_name(entry), remedy);
    values.push_back(entry.ref<std::string>());
  }
  return values;
}

std::optional<std::vector<double>> TomlTable::numbers(std::string_view key) {
  const toml::node* node = data_->ask(key);
  if (!node) return std::nullopt;
  const std::string remedy = "Write it like [1, 2.5].";
  if (!node->is_array()) data_->fail(*node, key, "must be an array of numbers, not " + kind_name(*node), remedy);
  std::vector<double> values;
  for (const toml::node& entry : *node->as_array()) {
    if (!entry.is_number()) data_->fail(entry, key, "must hold numbers only, not " + kind_name(entry), remedy);
    values.push_back(as_double(entry));
    if (!std::isfinite(values.back())) data_->fail(entry, key, "must hold finite numbers only", remedy);
  }
  return values;
}

std::optional<TomlTable> TomlTable::table(std::string_view key) {
  const toml::node* node = data_->ask(key);
  if (!node) return std::nullopt;
  if (!node->is_table())
    data_->fail(*node, key, "must be a table, not " + kind_name(*node),
                "Write it as a section: [" + data_->path + std::string(key) + "].");
  return TomlTable(data_->below(*node, data_->path + std::string(key) + "."));
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
  std::vector<TomlTable> out;
  const toml::node* node = data_->ask(key);
  if (!node) return out;
  if (node->is_table()) {
    out.push_back(TomlTable(data_->below(*node, data_->path + std::string(key) + ".")));
    return out;
  }
  const std::string remedy = "Write each as a section: [[" + data_->path + std::string(key) + "]].";
  if (!node->is_array()) data_->fail(*node, key, "must be an array of tables, not " + kind_name(*node), remedy);
  for (const toml::node& entry : *node->as_array()) {
    if (!entry.is_table()) data_->fail(entry, key, "must hold tables only, not " + kind_name(entry), remedy);
    out.push_back(TomlTable(data_->below(entry, data_->path + std::string(key) + ".")));
  }
  return out;
}

std::optional<std::vector<std::pair<double, double>>> TomlTable::pairs(std::string_view key) {
  const toml::node* node = data_->ask(key);
  if (!node) return std::nullopt;
  const std::string remedy = "Write it like [[1, 2], [3, 4]].";
  if (!node->is_array()) data_->fail(*node, key, "must be an array of pairs, not " + kind_name(*node), remedy);
  std::vector<std::pair<double, double>> values;
  for (const toml::node& entry : *node->as_array()) {
    const toml::array* pair = entry.as_array();
    if (!pair || pair->size() != 2 || !(*pair)[0].is_number() || !(*pair)[1].is_number())
      data_->fail(entry, key, "must hold pairs of numbers only", remedy);
    values.emplace_back(as_double((*pair)[0]), as_double((*pair)[1]));
    if (!std::isfinite(values.back().first) || !std::isfinite(values.back().second))
      data_->fail(entry, key, "must hold finite numbers only", remedy);
  }
  return values;
}

namespace {

/// Nothing for other types, and numbers that are none.
std::optional<NumberOrText> either(const toml::node& node) {
  if (node.is_string()) return node.ref<std::string>();
  if (!node.is_number() || !std::isfinite(as_double(node))) return std::nullopt;
  return as_double(node);
}

}  // namespace

std::optional<NumberOrText> TomlTable::number_or_text(std::string_view key) {
  const toml::node* node = data_->ask(key);
  if (!node) return std::nullopt;
  const auto value = either(*node);
  if (!value) data_->fail(*node, key, "must be a number or a text, not " + kind_name(*node), "");
  return value;
}

std::optional<std::vector<NumberOrText>> TomlTable::numbers_or_texts(std::string_view key) {
  const toml::node* node = data_->ask(key);
  if (!node) return std::nullopt;
  const std::string remedy = "Write it like [1, \"w / 2\"].";
  if (!node->is_array()) data_->fail(*node, key, "must be an array, not " + kind_name(*node), remedy);
  std::vector<NumberOrText> values;
  for (const toml::node& entry : *node->as_array()) {
    const auto value = either(entry);
    if (!value) data_->fail(entry, key, "must hold numbers and texts only, not " + kind_name(entry), remedy);
    values.push_back(*value);
  }
  return values;
}

std::optional<std::vector<std::pair<NumberOrText, NumberOrText>>> TomlTable::pairs_of_numbers_or_texts(
    std::string_view key) {
  const toml::node* node = data_->ask(key);
  if (!node) return std::nullopt;
  const std::string remedy = "Write it like [[1, 2], [3, \"w / 2\"]].";
  if (!node->is_array()) data_->fail(*node, key, "must be an array of pairs, not " + kind_name(*node), remedy);
  std::vector<std::pair<NumberOrText, NumberOrText>> values;
  for (const toml::node& entry : *node->as_array()) {
    const toml::array* pair = entry.as_array();
    const bool two = pair && pair->size() == 2;
    const auto a = two ? either((*pair)[0]) : std::nullopt, b = two ? either((*pair)[1]) : std::nullopt;
    if (!a || !b) data_->fail(entry, key, "must hold pairs of numbers and texts only", remedy);
    values.emplace_back(*a, *b);
  }
  return values;
}

bool TomlTable::holds_number(std::string_view key) const {
  const toml::node* node = data_->table->get(key);
  return node && node->is_number();
}

bool TomlTable::holds_boolean(std::string_view key) const {
  const toml::node* node = data_->table->get(key);
  return node && node->is_boolean();
}

bool TomlTable::holds_table(std::string_view key) const {
  const toml::node* node = data_->table->get(key);
  return node && node->is_table();
}

bool TomlTable::holds_text(std::string_view key) const {
  const toml::node* node = data_->table->get(key);
  return node && node->is_string();
}

int TomlTable::line(std::string_view key) const {
  if (!key.empty())
    if (const toml::node* node = data_->table->get(key)) return static_cast<int>(node->source().begin.line);
  return static_cast<int>(data_->position.line);
}

std::optional<std::string> TomlTable::plain(std::string_view key) {
  const toml::node* node = data_->ask(key);
  if (!node) return std::nullopt;
  const auto scalar = [&](const toml::node& value) -> std::string {
    if (value.is_string()) return value.ref<std::string>();
    if (value.is_integer()) return std::to_string(value.ref<std::int64_t>());
    if (value.is_floating_point()) return shortest(value.ref<double>());
    if (value.is_boolean()) return value.ref<bool>() ? "true" : "false";
    data_->fail(value, key, "cannot be " + kind_name(value), "Write a text, a number or an array of them.");
  };
  if (!node->is_array()) return scalar(*node);
  std::string joined;
  bool first = true;
  for (const toml::node& entry : *node->as_array()) {
    if (!first) joined += ',';
    first = false;
    joined += scalar(entry);
  }
  return joined;
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> keys;
  for (const auto& [key, value] : *data_->table) keys.emplace_back(key.str());
  std::sort(keys.begin(), keys.end());
  return keys;
}

void TomlTable::finish() const {
  const toml::key* unknown = nullptr;
  for (const auto& [key, value] : *data_->table) {
    if (data_->asked.contains(key.str())) continue;
    const auto before = [](const toml::key& a, const toml::key& b) {
      const toml::source_position x = a.source().begin, y = b.source().begin;
      return x.line != y.line ? x.line < y.line : x.column < y.column;
    };
    if (!unknown || before(key, *unknown)) unknown = &key;
  }
  if (!unknown) return;
  const std::vector<std::string> known(data_->asked.begin(), data_->asked.end());
  std::string remedy;
  if (const std::string near = nearest(unknown->str(), known); !near.empty()) {
    remedy = "Did you mean " + data_->path + near + "?";
  } else if (!known.empty() && known.size() <= kListedKeys) {
    remedy = "Known keys here:";
    for (const std::string& key : known) remedy += " " + key;
    remedy += ".";
  }
  throw InputError(data_->file, place(unknown->source().begin),
                   "unknown key " + data_->path + std::string(unknown->str()), remedy);
}

void TomlTable::fail(std::string_view key, const std::string& what, const std::string& remedy) const {
  if (const toml::node* node = data_->table->get(key)) data_->fail(*node, key, what, remedy);
  throw InputError(data_->file, place(data_->position), data_->path + std::string(key) + " " + what, remedy);
}

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
  std::size_t best = (word.size() + 2) / 3 + 1;  // even a short word may have one slip
  std::string found;
  for (const std::string& candidate : known) {
    // Optimal string alignment (Damerau-Levenshtein without repeated edits), three rows.
    std::vector<std::size_t> before, last(candidate.size() + 1), row(candidate.size() + 1);
    for (std::size_t j = 0; j <= candidate.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= word.size(); ++i) {
      row[0] = i;
      for (std::size_t j = 1; j <= candidate.size(); ++j) {
        const char a = folded(word[i - 1]), b = folded(candidate[j - 1]);
        row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a == b ? 0 : 1)});
        if (i > 1 && j > 1 && a == folded(candidate[j - 2]) && folded(word[i - 2]) == b)
          row[j] = std::min(row[j], before[j - 2] + 1);
      }
      before = last;
      last = row;
    }
    if (last[candidate.size()] < best) {
      best = last[candidate.size()];
      found = candidate;
    }
  }
  return found;
}

}  // namespace blockrand::base
