#include "pipeline/base/template.h"

#include <algorithm>
#include <kainjow/mustache.hpp>
#include <map>
#include <stdexcept>

#include "pipeline/base/markup.h"

namespace blockrand::base {

namespace mustache = kainjow::mustache;

/// Values as the library has them.
struct TemplateData {
  static mustache::data of(Values&& values) {
    mustache::data object(mustache::data::type::object);
    for (Values::Item& item : values.items_) object[item.name] = of(std::move(item.value));
    return object;
  }
  static mustache::data of(std::variant<bool, std::string, Values::List>&& value) {
    if (const bool* flag = std::get_if<bool>(&value)) return mustache::data(*flag);
    if (const std::string* text = std::get_if<std::string>(&value)) return mustache::data(*text);
    mustache::data list(mustache::data::type::list);
    for (Values& entry : std::get<Values::List>(value)) list.push_back(of(std::move(entry)));
    return list;
  }
};

namespace {

/// Where names are looked up: values from the inside outwards, and assets.
class Context : public mustache::basic_context<std::string> {
 public:
  Context(const mustache::data* data, std::string_view (*asset)(std::string_view)) : asset_(asset) { push(data); }
  void push(const mustache::data* data) override { open_.push_back(data); }
  void pop() override { open_.pop_back(); }
  const mustache::data* get(const std::string& name) const override {
    if (name == ".") return open_.back();
    for (auto data = open_.rbegin(); data != open_.rend(); ++data)
      if (const mustache::data* found = (*data)->get(name)) return found;
    return nullptr;
  }
  const mustache::data* get_partial(const std::string& name) const override {
    const auto found = partials_.find(name);
    if (found != partials_.end()) return &found->second;
    // A file ends its last line; whoever takes it in goes on or ends the line itself.
    std::string_view text = asset_(name);
    if (text.ends_with('\n')) text.remove_suffix(1);
    return &partials_.emplace(name, mustache::data(std::string(text))).first->second;
  }

 private:
  std::vector<const mustache::data*> open_;
  std::string_view (*asset_)(std::string_view);
  mutable std::map<std::string, mustache::data> partials_;
};

}  // namespace

Values::Item& Values::item(std::string_view name) {
  const auto found = std::find_if(items_.begin(), items_.end(), [&](const Item& i) { return i.name == name; });
  if (found != items_.end()) return *found;
  return items_.emplace_back(Item{std::string(name), false});
}
Values& Values::set(std::string_view name, std::string text) {
  if (text.empty())
    item(name).value = false;
  else
    item(name).value = std::move(text);
  return *this;
}
Values& Values::set(std::string_view name, bool flag) {
  item(name).value = flag;
  return *this;
}
Values& Values::set(std::string_view name, List list) {
  item(name).value = std::move(list);
  return *this;
}
Values& Values::add(std::string_view name, Values entry) {
  Item& list = item(name);
  if (!std::holds_alternative<List>(list.value)) list.value = List();
  std::get<List>(list.value).push_back(std::move(entry));
  return *this;
}

std::string filled(std::string_view (*asset)(std::string_view), std::string_view name, Values values) {
  mustache::mustache page{std::string(asset(name))};
  page.set_custom_escape([](const std::string& text) { return escaped(text); });
  const mustache::data data = TemplateData::of(std::move(values));
  Context context(&data, asset);
  std::string out;
  // The library hands on one line after the other.
  struct Lines {
    std::string& out;
    Lines& operator<<(const std::string& line) {
      out += line;
      return *this;
    }
  } lines{out};
  if (page.is_valid()) page.render(context, lines);
  if (!page.is_valid()) throw std::logic_error("template " + std::string(name) + ": " + page.error_message());
  return out;
}

}  // namespace blockrand::base
