// Lists written as one text, each item followed by ";" (docs/rule_language.md §3.3).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace blockrand::grammar {

/// The items; a last one without ";" counts. Empty items between two ";" count too.
std::vector<std::string_view> list_items(std::string_view list);

std::string list_of(const std::vector<std::string_view>& items);

/// Whether `item` is `pattern`, whose leading and trailing "*" stand for anything.
bool matches(std::string_view item, std::string_view pattern);

}  // namespace blockrand::grammar
