// Pages from templates: files in the language Mustache (https://mustache.github.io/mustache.5.html) beside the code that
// fills them, part of the program as assets.
//   {{name}}   the value, escaped for XML and HTML, in texts and in attributes with double quotes
//   {{{name}}} the value as it stands: markup that was made elsewhere, such as a map or a picture
//   {{#name}} … {{/name}}  once for each entry of a list, or once where a flag is set or a text is not empty
//   {{^name}} … {{/name}}  where the list is empty, the flag not set, the text empty, or nothing of that name given
//   {{> report/head.html}}  another asset, filled with the same values
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace blockrand::base {

/// What a template is filled with, by name. Names of an inner list hide those outside of it.
class Values {
 public:
  struct Item;
  using List = std::vector<Values>;

  /// A text, UTF-8; stands for "no" in a section where it is empty.
  Values& set(std::string_view name, std::string text);
  Values& set(std::string_view name, std::string_view text) { return set(name, std::string(text)); }
  Values& set(std::string_view name, const char* text) { return set(name, std::string(text)); }
  Values& set(std::string_view name, bool flag);
  /// A list, also an empty one.
  Values& set(std::string_view name, List list);
  /// One more entry of a list, which begins with the first.
  Values& add(std::string_view name, Values entry);

 private:
  friend std::string filled(std::string_view (*)(std::string_view), std::string_view, Values);
  friend struct TemplateData;
  Item& item(std::string_view name);
  std::vector<Item> items_;
};

struct Values::Item {
  std::string name;
  std::variant<bool, std::string, List> value;
};

/// The page. \param asset  finds the template and those it takes in, as blockrand_assets makes it
/// \throws std::logic_error  the template is no Mustache, or names an asset that does not exist
std::string filled(std::string_view (*asset)(std::string_view name), std::string_view name, Values values);

}  // namespace blockrand::base
