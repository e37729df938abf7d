#include "pipeline/export/gltf/property_table.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>

#include "pipeline/export/text.h"

namespace blockrand::export_ {

static_assert(std::endian::native == std::endian::little, "buffers are copied as they lie in memory");

namespace {

using Kind = PropertyTable::Kind;
using Object = tinygltf::Value::Object;

std::size_t element_size(Kind kind) {
  switch (kind) {
    case Kind::int64:
    case Kind::float64:
      return 8;
    default:
      return 1;
  }
}

tinygltf::Value text_value(std::string_view text) { return tinygltf::Value(std::string(text)); }

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

tinygltf::Value PropertyTable::class_properties() const {
  Object properties;
  for (const Data& data : columns_) {
    const Column& column = data.column;
    Object property;
    switch (column.kind) {
      case Kind::text:
        property.emplace("type", text_value("STRING"));
        break;
      case Kind::enumeration:
        property.emplace("type", text_value("ENUM"));
        property.emplace("enumType", text_value(column.enum_type));
        break;
      default:
        property.emplace("type", text_value("SCALAR"));
        property.emplace("componentType", text_value(column.kind == Kind::int8      ? "INT8"
                                                     : column.kind == Kind::int64   ? "INT64"
                                                     : column.kind == Kind::float64 ? "FLOAT64"
                                                                                    : "UINT8"));
        if (column.kind == Kind::unit_interval) property.emplace("normalized", tinygltf::Value(true));
    }
    if (!column.description.empty()) property.emplace("description", text_value(column.description));
    // The specification forbids noData together with required.
    if (column.required) {
      property.emplace("required", tinygltf::Value(true));
    } else if (column.kind == Kind::text) {
      property.emplace("noData", text_value(""));
    } else if (column.kind == Kind::enumeration) {
      if (!column.no_data_name.empty()) property.emplace("noData", text_value(column.no_data_name));
    } else if (column.no_data) {
      property.emplace("noData", tinygltf::Value(static_cast<int>(*column.no_data)));
    }
    properties.emplace(column.name, tinygltf::Value(std::move(property)));
  }
  return tinygltf::Value(std::move(properties));
}

tinygltf::Value PropertyTable::write(tinygltf::Model& model, const std::string& class_name) const {
  Object properties;
  for (const Data& data : columns_) {
    if (!data.any) continue;
    assert(!data.bytes.empty());
    Object property;
    property.emplace("values", tinygltf::Value(add_buffer_view(model, data.bytes.data(), data.bytes.size())));
    if (data.column.kind == Kind::text) {
      // The smallest type that holds the last offset: most texts of a tile are short.
      const std::uint32_t last = data.offsets.back();
      int view = 0;
      if (last <= 0xFFFF) {
        const std::vector<std::uint16_t> narrow(data.offsets.begin(), data.offsets.end());
        view = add_buffer_view(model, narrow.data(), narrow.size() * sizeof(narrow[0]));
      } else {
        view = add_buffer_view(model, data.offsets.data(), data.offsets.size() * sizeof(data.offsets[0]));
      }
      property.emplace("stringOffsets", tinygltf::Value(view));
      if (last <= 0xFFFF) property.emplace("stringOffsetType", text_value("UINT16"));
    }
    properties.emplace(data.column.name, tinygltf::Value(std::move(property)));
  }
  Object table;
  table.emplace("class", text_value(class_name));
  table.emplace("count", tinygltf::Value(static_cast<int>(rows_)));
  table.emplace("properties", tinygltf::Value(std::move(properties)));
  return tinygltf::Value(std::move(table));
}

int add_buffer_view(tinygltf::Model& model, const void* bytes, std::size_t size, int target, int stride) {
  std::vector<unsigned char>& buffer = model.buffers.front().data;
  buffer.resize((buffer.size() + 7) / 8 * 8);
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = buffer.size();
  view.byteLength = size;
  view.byteStride = static_cast<std::size_t>(stride);
  view.target = target;
  const auto* first = static_cast<const unsigned char*>(bytes);
  buffer.insert(buffer.end(), first, first + size);
  model.bufferViews.push_back(std::move(view));
  return static_cast<int>(model.bufferViews.size()) - 1;
}

}  // namespace blockrand::export_
