// The utility library's lists, which are texts: "a;b;c;" (docs/rule_language.md §3.3).
#include <algorithm>

#include "styles/grammar/evaluation/function_groups.h"
#include "styles/grammar/evaluation/text_list.h"
#include "styles/grammar/language/value_text.h"

namespace blockrand::grammar {

std::vector<std::string_view> list_items(std::string_view list) {
  std::vector<std::string_view> out;
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(';'), list.size());
    out.push_back(list.substr(0, end));
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return out;
}

std::string list_of(const std::vector<std::string_view>& items) {
  std::string out;
  for (const std::string_view item : items) out.append(item).push_back(';');
  return out;
}

bool matches(std::string_view item, std::string_view pattern) {
  const bool before = !pattern.empty() && pattern.front() == '*';
  if (before) pattern.remove_prefix(1);
  const bool after = !pattern.empty() && pattern.back() == '*';
  if (after) pattern.remove_suffix(1);
  if (before && (after || pattern.empty())) return item.find(pattern) != std::string_view::npos;
  if (before) return item.ends_with(pattern);
  return after ? item.starts_with(pattern) : item == pattern;
}

namespace {

std::string terminated(const std::string& list) { return list.empty() || list.back() == ';' ? list : list + ";"; }

/// The items for which `keep(item)` holds.
template <typename Keep>
std::string filtered(const std::string& list, const Keep& keep) {
  std::vector<std::string_view> out;
  for (const std::string_view item : list_items(list))
    if (keep(item)) out.push_back(item);
  return list_of(out);
}

/// "" for what is not there (docs/rule_language.md §7.2, 16).
std::string item_at(const std::string& list, long long index) {
  const auto items = list_items(list);
  if (index < 0 || index >= static_cast<long long>(items.size())) return {};
  return std::string(items[static_cast<std::size_t>(index)]);
}

FunctionResult add(Arguments a, FunctionContext&) { return Value(terminated(text(a[0])) + terminated(text(a[1]))); }
FunctionResult clean(Arguments a, FunctionContext&) {
  return Value(filtered(text(a[0]), [](std::string_view item) { return !item.empty(); }));
}
FunctionResult count(Arguments a, FunctionContext&) {
  const auto items = list_items(text(a[0]));
  return Value(static_cast<double>(
      std::count_if(items.begin(), items.end(), [&](std::string_view item) { return matches(item, text(a[1])); })));
}
FunctionResult first(Arguments a, FunctionContext&) { return Value(item_at(text(a[0]), 0)); }
FunctionResult last(Arguments a, FunctionContext&) {
  const auto items = list_items(text(a[0]));
  return Value(items.empty() ? std::string() : std::string(items.back()));
}
FunctionResult index(Arguments a, FunctionContext&) {
  const auto items = list_items(text(a[0]));
  for (std::size_t i = 0; i < items.size(); ++i)
    if (matches(items[i], text(a[1]))) return Value(static_cast<double>(i));
  return Value(-1.0);
}
FunctionResult item(Arguments a, FunctionContext&) { return Value(item_at(text(a[0]), whole(number(a[1])))); }
FunctionResult any(Arguments a, FunctionContext& context) {
  const double drawn = context.draw();
  return Value(item_at(text(a[0]), static_cast<long long>(drawn * static_cast<double>(list_items(text(a[0])).size()))));
}
FunctionResult range(Arguments a, FunctionContext&) {
  auto items = list_items(text(a[0]));
  const auto size = static_cast<long long>(items.size());
  const long long from = std::clamp(whole(number(a[1])), 0LL, size),
                  to = a.size() > 2 ? std::clamp(whole(number(a[2])), 0LL, size) : size;
  if (to <= from) return Value(std::string());
  return Value(list_of({items.begin() + from, items.begin() + to}));
}
/// Only the first that matches goes.
FunctionResult remove(Arguments a, FunctionContext&) {
  bool removed = false;
  return Value(filtered(text(a[0]), [&](std::string_view item) {
    if (removed || !matches(item, text(a[1]))) return true;
    removed = true;
    return false;
  }));
}
FunctionResult remove_all(Arguments a, FunctionContext&) {
  return Value(filtered(text(a[0]), [&](std::string_view item) { return !matches(item, text(a[1])); }));
}
FunctionResult retain_all(Arguments a, FunctionContext&) {
  return Value(filtered(text(a[0]), [&](std::string_view item) { return matches(item, text(a[1])); }));
}
FunctionResult size(Arguments a, FunctionContext&) { return Value(static_cast<double>(list_items(text(a[0])).size())); }
FunctionResult terminate(Arguments a, FunctionContext&) { return Value(terminated(text(a[0]))); }
FunctionResult to_array(Arguments a, FunctionContext&) {
  const auto items = list_items(text(a[0]));
  return Value(TextArray{{items.begin(), items.end()}, items.size()});
}
template <typename T, typename Text>
std::string joined(const Array<T>& array, const Text& item_text) {
  std::string out;
  for (const T& item : array.items) out.append(item_text(item)).push_back(';');
  return out;
}
FunctionResult from_numbers(Arguments a, FunctionContext&) {
  return Value(joined(std::get<NumberArray>(a[0]), number_text));
}
FunctionResult from_truths(Arguments a, FunctionContext&) {
  return Value(joined(std::get<TruthArray>(a[0]), [](std::uint8_t item) { return item ? "true" : "false"; }));
}
FunctionResult from_texts(Arguments a, FunctionContext&) {
  return Value(joined(std::get<TextArray>(a[0]), [](const std::string& item) { return item; }));
}

}  // namespace

std::span<const FunctionEntry> list_functions() {
  static constexpr FunctionEntry kTable[] = {
      {"listAdd", "ss", add},
      {"listClean", "s", clean},
      {"listCount", "ss", count},
      {"listFirst", "s", first},
      {"listFromArray", "N", from_numbers, true},
      {"listFromArray", "B", from_truths},
      {"listFromArray", "S", from_texts},
      {"listIndex", "ss", index},
      {"listItem", "sn", item},
      {"listLast", "s", last},
      {"listRandom", "s", any},
      {"listRange", "sn", range},
      {"listRange", "snn", range},
      {"listRemove", "ss", remove},
      {"listRemoveAll", "ss", remove_all},
      {"listRetainAll", "ss", retain_all},
      {"listSize", "s", size},
      {"listTerminate", "s", terminate},
      {"listToArray", "s", to_array},
  };
  return kTable;
}

}  // namespace blockrand::grammar
