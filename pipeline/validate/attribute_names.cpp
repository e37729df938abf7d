#include "pipeline/validate/attribute_names.h"

#include <charconv>
#include <cmath>

#include "pipeline/base/text.h"
#include "pipeline/model/building.h"

namespace blockrand::validate {

const std::vector<std::string>& attribute_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    const model::Attributes attributes;
    const auto note = [&](std::string_view name, std::string_view, const auto&...) { out.emplace_back(name); };
    model::for_each_attribute(attributes, note, note);
    return out;
  }();
  return names;
}

const PeopleColumn* people_column(std::string_view name) {
  static constexpr PeopleColumn kColumns[] = {{"use"},
                                              {"ground_floor_use"},
                                              {"construction_date"},
                                              {"era"},
                                              {"style"},
                                              {"substyle"},
                                              {"style_confidence", 0.01},
                                              {"storeys", 0.1},
                                              {"height", 0.1},
                                              {"eaves_height", 0.1},
                                              {"roof_storeys", 0.1},
                                              {"roof_height", 0.1},
                                              {"roof_pitch", 1},
                                              {"roof_material"},
                                              {"roof_colour"},
                                              {"wall_material"},
                                              {"wall_colour"},
                                              {"built_roof"},
                                              {"lod"},
                                              {"fallbacks"}};
  for (const PeopleColumn& column : kColumns)
    if (column.name == name) return &column;
  return nullptr;
}

bool is_source(std::string_view name) {
  for (int i = 0; i < model::kSourceCount; ++i)
    if (model::name(static_cast<model::Source>(i)) == name) return true;
  return false;
}

double to_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : std::nan("");
}

std::string number_text(std::string_view text) {
  const double value = to_number(text);
  return std::isfinite(value) ? base::shortest(value) : std::string();
}

}  // namespace blockrand::validate
