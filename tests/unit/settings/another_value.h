// A value for any option that differs from the one it has.
#pragma once

#include <string>

#include "pipeline/base/option.h"

namespace blockrand {

template <class Struct>
std::string another_value(const base::Option<Struct>& o, const Struct& s) {
  using base::OptionType;
  const std::string value = o.show(s);
  if (o.name == "formats") return value == "gltf" ? "citygml" : "gltf";
  if (o.name == "bbox") return "1,2,3,4";
  if (o.argument == "EPSG:CODE") return "EPSG:25833";
  if (o.argument == "LON,LAT,H") return "1,2,3";
  if (o.argument == "PERCENT") return "5%";
  if (o.argument == "NAME=VALUE") return "height=12";
  if (!o.choices.empty()) return o.choices.back() == value ? o.choices.front() : o.choices.back();
  if (o.type == OptionType::flag) return value == "true" ? "false" : "true";
  if (o.type == OptionType::integer)
    return o.minimum > 2 ? std::to_string(static_cast<int>(o.minimum)) : value == "1" ? "2" : "1";
  if (o.type == OptionType::number) return value == "0.5" ? "0.25" : o.maximum > 6 ? "6" : "0.5";
  return "x";
}

}  // namespace blockrand
