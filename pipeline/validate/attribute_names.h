// The names of the attributes that every body has.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace blockrand::validate {

/// In the order of model::for_each_attribute.
const std::vector<std::string>& attribute_names();

/// A column of property tables with the attribute profile `people`.
struct PeopleColumn {
  std::string_view name;
  double step = 0;  ///< what numbers are rounded to; 0 for texts
};
/// Nothing where the profile leaves the attribute out. \param name  of an attribute, or "style_confidence"
const PeopleColumn* people_column(std::string_view name);

/// "tag", "implied" …
bool is_source(std::string_view name);

/// The number that `text` is; not a number where it is none.
double to_number(std::string_view text);

/// Shortest text of the number that `text` is, or empty where it is none.
std::string number_text(std::string_view text);

}  // namespace blockrand::validate
