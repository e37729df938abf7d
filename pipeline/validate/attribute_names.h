// The names of the attributes that every body has.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace blockrand::validate {

/// In the order of model::for_each_attribute.
const std::vector<std::string>& attribute_names();

/// "tag", "implied" …
bool is_source(std::string_view name);

/// The number that `text` is; not a number where it is none.
double to_number(std::string_view text);

/// Shortest text of the number that `text` is, or empty where it is none.
std::string number_text(std::string_view text);

}  // namespace blockrand::validate
