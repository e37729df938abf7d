#include "pipeline/outputs/gltf/property_table.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "pipeline/outputs/gltf/glb_document.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {

static_assert(std::endian::native == std::endian::little, "buffers are copied as they lie in memory");

namespace {

using Kind = PropertyTable::Kind;
using Object = nlohmann::ordered_json;

/// The value that stands for an absent text in an enumeration of texts, and its name there.
constexpr std::uint8_t kAbsentText = 255;
constexpr std::string_view kAbsentTextName = "none";
/// Bytes of JSON around the name of a value, and around an enumeration.
constexpr std::size_t kEntryBytes = 23, kEnumBytes = 80;

std::size_t element_size(Kind kind) {
  switch (kind) {
    case Kind::int64:
    case Kind::float64:
      return 8;
    case Kind::text:
    case Kind::enumeration:
    case Kind::int8:
    case Kind::unit_interval:
      break;
  }
  return 1;
}

}  // namespace

int PropertyTable::add(Column column) {
  assert(rows_ == 0);
  Data data;
  data.column = std::move(column);
  if (data.column.kind == Kind::text) data.offsets.push_back(0);
  columns_.push_back(std::move(data));
  return static_cast<int>(columns_.size()) - 1;
}

void PropertyTable::put(Data& data, const void* value, std::size_t size) {
  assert(!data.set);
  data.bytes.append(static_cast<const char*>(value), size);
  data.set = data.any = true;
}

void PropertyTable::set_text(int column, std::string_view text) {
  if (text.empty()) return;
  Data& data = columns_[static_cast<std::size_t>(column)];
  assert(data.column.kind == Kind::text && !data.set);
  append_clean(data.bytes, text);
  data.set = data.any = true;
}

void PropertyTable::set_raw_text(int column, std::string_view text) {
  if (text.empty()) return;
  put(columns_[static_cast<std::size_t>(column)], text.data(), text.size());
}

void PropertyTable::set_enum(int column, std::uint8_t value) {
  put(columns_[static_cast<std::size_t>(column)], &value, 1);
}

void PropertyTable::set_int8(int column, std::int8_t value) {
  put(columns_[static_cast<std::size_t>(column)], &value, 1);
}

void PropertyTable::set_int64(int column, std::int64_t value) {
  put(columns_[static_cast<std::size_t>(column)], &value, 8);
}

void PropertyTable::set_float64(int column, double value) {
  if (!std::isfinite(value)) return;
  if (value == 0) value = 0;
  put(columns_[static_cast<std::size_t>(column)], &value, 8);
}

void PropertyTable::set_unit_interval(int column, double value) {
  if (std::isnan(value)) return;
  const auto byte = static_cast<std::uint8_t>(std::nearbyint(std::clamp(value, 0.0, 1.0) * 255));
  put(columns_[static_cast<std::size_t>(column)], &byte, 1);
}

void PropertyTable::end_row() {
  ++rows_;
  for (Data& data : columns_) {
    const Column& column = data.column;
    assert(data.set || !column.required);
    if (column.kind == Kind::text) {
      data.offsets.push_back(static_cast<std::uint32_t>(data.bytes.size()));
    } else if (!data.set) {
      char filler[8] = {};
      const double absent = column.no_data.value_or(0);
      if (column.kind == Kind::float64) {
        std::memcpy(filler, &absent, 8);
      } else {
        const auto integer = static_cast<std::int64_t>(absent);
        std::memcpy(filler, &integer, 8);
      }
      data.bytes.append(filler, element_size(column.kind));
    }
    data.set = false;
  }
}

void PropertyTable::code_texts() {
  for (Data& data : columns_) {
    if (data.column.kind != Kind::text || !data.any) continue;
    std::map<std::string_view, std::uint8_t> values;
    std::size_t names = 0;
    bool fits = true, absent = false;
    const auto text = [&](std::size_t row) {
      return std::string_view(data.bytes).substr(data.offsets[row], data.offsets[row + 1] - data.offsets[row]);
    };
    for (std::size_t row = 0; row < rows_ && fits; ++row) {
      absent = absent || text(row).empty();
      if (!text(row).empty() && values.try_emplace(text(row)).second) names += text(row).size() + kEntryBytes;
      fits = values.size() < kAbsentText;
    }
    const std::size_t width = data.offsets.back() <= 0xFFFF ? 2 : 4;
    if (!fits || values.contains(kAbsentTextName) ||
        names + kEnumBytes + rows_ >= data.bytes.size() + width * data.offsets.size())
      continue;
    std::uint8_t next = 0;
    for (auto& [name, value] : values) {
      value = next++;
      data.names.emplace_back(name);
    }
    std::string bytes;
    for (std::size_t row = 0; row < rows_; ++row)
      bytes += static_cast<char>(text(row).empty() ? kAbsentText : values.at(text(row)));
    data.bytes = std::move(bytes);
    data.offsets.clear();
    data.column.kind = Kind::enumeration;
    data.column.enum_type = data.column.name;
    if (absent) {
      data.column.no_data = kAbsentText;
      data.column.no_data_name = kAbsentTextName;
    }
  }
}

nlohmann::json PropertyTable::text_enums() const {
  nlohmann::json out = nlohmann::json::object();
  for (const Data& data : columns_) {
    if (data.names.empty()) continue;
    nlohmann::json values = nlohmann::json::array();
    const auto add_value = [&](const std::string& name, std::size_t value) {
      nlohmann::json entry;
      entry.emplace("name", name);
      entry.emplace("value", value);
      values.push_back(std::move(entry));
    };
    for (std::size_t i = 0; i < data.names.size(); ++i) add_value(data.names[i], i);
    if (!data.column.no_data_name.empty()) add_value(data.column.no_data_name, kAbsentText);
    nlohmann::json enumeration;
    enumeration.emplace("valueType", "UINT8");
    enumeration.emplace("values", std::move(values));
    out.emplace(data.column.enum_type, std::move(enumeration));
  }
  return out;
}

std::set<int> PropertyTable::values_used(std::string_view enum_type) const {
  std::set<int> out;
  for (const Data& data : columns_)
    if (data.column.kind == Kind::enumeration && data.column.enum_type == enum_type)
      for (const char value : data.bytes) out.insert(static_cast<std::uint8_t>(value));
  return out;
}

std::vector<const PropertyTable::Data*> PropertyTable::listed() const {
  std::vector<const Data*> all;
  for (const Data& data : columns_) all.push_back(&data);
  if (order_ == Order::by_name)
    std::ranges::sort(all, {}, [](const Data* data) -> const std::string& { return data->column.name; });
  return all;
}

nlohmann::ordered_json PropertyTable::class_properties() const {
  Object properties = Object::object();
  for (const Data* data : listed()) {
    const Column& column = data->column;
    nlohmann::json property;  // its keys in the order of the alphabet
    switch (column.kind) {
      case Kind::text:
        property.emplace("type", "STRING");
        break;
      case Kind::enumeration:
        property.emplace("type", "ENUM");
        property.emplace("enumType", column.enum_type);
        break;
      case Kind::int8:
      case Kind::int64:
      case Kind::float64:
      case Kind::unit_interval:
        property.emplace("type", "SCALAR");
        property.emplace("componentType", column.kind == Kind::int8      ? "INT8"
                                          : column.kind == Kind::int64   ? "INT64"
                                          : column.kind == Kind::float64 ? "FLOAT64"
                                                                         : "UINT8");
        if (column.kind == Kind::unit_interval) property.emplace("normalized", true);
    }
    if (!column.description.empty()) property.emplace("description", column.description);
    // The specification forbids noData together with required.
    if (column.required) {
      property.emplace("required", true);
    } else if (column.kind == Kind::text) {
      property.emplace("noData", "");
    } else if (column.kind == Kind::enumeration) {
      if (!column.no_data_name.empty()) property.emplace("noData", column.no_data_name);
    } else if (column.no_data) {
      property.emplace("noData", static_cast<int>(*column.no_data));
    }
    properties.emplace(column.name, std::move(property));
  }
  return properties;
}

nlohmann::ordered_json PropertyTable::write(GlbDocument& document, const std::string& class_name) const {
  Object properties = Object::object();
  // Buffer views in the order in which columns were added, whatever the order of the list.
  std::map<const Data*, nlohmann::json> views;
  for (const Data& data : columns_) {
    if (!data.any) continue;
    assert(!data.bytes.empty());
    nlohmann::json& property = views[&data];
    property.emplace("values", document.add_view(data.bytes));
    if (data.column.kind == Kind::text) {
      // The smallest type that holds the last offset: most texts of a tile are short.
      const std::uint32_t last = data.offsets.back();
      std::string offsets;
      const auto append = [&](const auto& numbers) {
        offsets.assign(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(numbers[0]));
      };
      if (last <= 0xFFFF)
        append(std::vector<std::uint16_t>(data.offsets.begin(), data.offsets.end()));
      else
        append(data.offsets);
      property.emplace("stringOffsets", document.add_view(std::move(offsets)));
      if (last <= 0xFFFF) property.emplace("stringOffsetType", "UINT16");
    }
  }
  for (const Data* data : listed())
    if (const auto found = views.find(data); found != views.end())
      properties.emplace(data->column.name, std::move(found->second));
  Object table;
  table.emplace("class", class_name);
  table.emplace("count", static_cast<int>(rows_));
  table.emplace("properties", std::move(properties));
  return table;
}

}  // namespace blockrand::outputs
