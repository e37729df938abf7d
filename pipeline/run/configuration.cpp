#include "pipeline/run/configuration.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "pipeline/base/option.h"

namespace blockrand::run {
namespace {

using Json = nlohmann::ordered_json;
using BuildOption = base::Option<BuildOptions>;

template <class AnyJson>
AnyJson json_of(const base::RecordValue& value) {
  return std::visit(
      [](const auto& v) {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::monostate>)
          return AnyJson(nullptr);
        else
          return AnyJson(v);
      },
      value);
}

bool is_main(const BuildOption& option) { return option.section == base::kMainSection; }

/// Where an option stands among those that differ: what shapes most comes first, then by name.
auto rank(std::string_view key) {
  constexpr std::array<std::string_view, 4> first = {"lod", "seed", "ground_height", "terrain_height_reference"};
  return std::pair(std::ranges::find(first, key) - first.begin(), key);
}

}  // namespace

nlohmann::ordered_json configuration(const BuildOptions& options) {
  base::OptionTable<BuildOptions> table = build_options();
  std::erase_if(table, [](const BuildOption& o) { return o.record == base::OptionRecord::none; });
  Json record, sections;
  for (const BuildOption& o : table)
    if (!is_main(o)) sections[std::string(o.section.name)] = Json::object();
  std::ranges::stable_sort(table, {}, &BuildOption::record_place);
  for (const BuildOption& o : table) {
    Json& object = is_main(o) ? record : sections[std::string(o.section.name)];
    if (const std::optional<base::RecordValue> value = o.recorded(options))
      object[std::string(o.record_key())] = json_of<Json>(*value);
  }
  record.update(sections);
  return record;
}

std::string first_difference(const nlohmann::json& record, const BuildOptions& options) {
  const BuildOptions fresh;
  const BuildOption* first = nullptr;
  const auto before = [](const BuildOption& a, const BuildOption& b) {
    return a.section == b.section && rank(a.record_key()) < rank(b.record_key());
  };
  const base::OptionTable<BuildOptions> table = build_options();
  for (const BuildOption& o : table) {
    if (o.record != base::OptionRecord::binding) continue;
    const nlohmann::json& object = is_main(o) ? record : record.at(std::string(o.section.name));
    if (!object.is_object()) throw std::runtime_error("the configuration is no object");
    const auto theirs = object.find(std::string(o.record_key()));
    const auto json = [&o](const BuildOptions& of) {
      const std::optional<base::RecordValue> value = o.recorded(of);
      return value ? json_of<nlohmann::json>(*value) : nlohmann::json();
    };
    const bool same = (theirs == object.end() ? json(fresh) : *theirs) == json(options);
    if (!same && (!first || before(o, *first))) first = &o;
  }
  if (!first) return {};
  return (is_main(*first) ? "" : std::string(first->section.name) + ".") + std::string(first->record_key());
}

}  // namespace blockrand::run
