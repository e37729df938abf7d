#include "pipeline/validate/property_table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <set>

#include "pipeline/base/option.h"
#include "pipeline/base/text.h"
#include "pipeline/validate/ids.h"

namespace blockrand::validate {
namespace {

bool identifier(std::string_view s) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  return !s.empty() && letter(s[0]) &&
         std::all_of(s.begin(), s.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

/// A type of numbers in a table.
struct Component {
  const char* name;
  std::size_t size;
  bool integer, is_signed;
};
constexpr Component kComponents[] = {
    {"INT8", 1, true, true},     {"UINT8", 1, true, false},   {"INT16", 2, true, true}, {"UINT16", 2, true, false},
    {"INT32", 4, true, true},    {"UINT32", 4, true, false},  {"INT64", 8, true, true}, {"UINT64", 8, true, false},
    {"FLOAT32", 4, false, true}, {"FLOAT64", 8, false, true},
};
const Component* component(std::string_view name) {
  for (const Component& c : kComponents)
    if (name == c.name) return &c;
  return nullptr;
}

struct Number {
  double value = 0;
  std::int64_t integer = 0;
};

Number read(const Component& c, std::string_view bytes, std::size_t i) {
  char raw[8] = {};
  std::memcpy(raw, bytes.data() + i * c.size, c.size);
  Number n;
  if (c.integer) {
    std::memcpy(&n.integer, raw, 8);
    if (c.is_signed && c.size < 8) {
      const int unused = 64 - static_cast<int>(8 * c.size);
      n.integer = static_cast<std::int64_t>(static_cast<std::uint64_t>(n.integer) << unused) >> unused;
    }
    n.value = static_cast<double>(n.integer);
  } else if (c.size == 4) {
    float f = 0;
    std::memcpy(&f, raw, 4);
    n.value = static_cast<double>(f);
  } else {
    std::memcpy(&n.value, raw, 8);
  }
  return n;
}

/// How many bytes the UTF-8 sequence at `at` has; 0 where it is none.
std::size_t utf8_length(std::string_view s, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(at + i < s.size() ? s[at + i] : 0); };
  const unsigned char a = byte(0), b = byte(1);
  const auto tail = [&](std::size_t i) { return (byte(i) & 0xC0) == 0x80; };
  if (a < 0x80) return 1;
  if (a >= 0xC2 && a <= 0xDF) return tail(1) ? 2 : 0;
  if (a >= 0xE0 && a <= 0xEF) {
    if (!tail(1) || !tail(2) || (a == 0xE0 && b < 0xA0) || (a == 0xED && b > 0x9F)) return 0;
    return 3;
  }
  if (a >= 0xF0 && a <= 0xF4) {
    if (!tail(1) || !tail(2) || !tail(3) || (a == 0xF0 && b < 0x90) || (a == 0xF4 && b > 0x8F)) return 0;
    return 4;
  }
  return 0;
}

bool is_utf8(std::string_view s) {
  for (std::size_t i = 0; i < s.size();) {
    const std::size_t n = utf8_length(s, i);
    if (n == 0) return false;
    i += n;
  }
  return true;
}

class Table {
 public:
  explicit Table(const GlbContainer& glb) : glb_(glb) {}

  std::vector<TableRow> read() {
    const Json* extension = member(member(glb_.json(), "extensions"), "EXT_structural_metadata");
    if (!extension) return {};
    schema_ = member(extension, "schema");
    check_schema();
    const Json* tables = member(extension, "propertyTables");
    if (!tables || !tables->is_array() || tables->empty()) {
      wrong("", "no property table");
      return {};
    }
    if (tables->size() > 1) wrong("", "more than one property table");
    read_table((*tables)[0]);
    return std::move(rows_);
  }

 private:
  void wrong(const std::string& where, const std::string& what) {
    glb_.found(Check::metadata_rule, where.empty() ? what : where + ": " + what);
  }

  void check_schema() {
    if (!schema_) return wrong("schema", "missing");
    if (!identifier(text(member(schema_, "id")))) wrong("schema", "id is no identifier");
    if (const Json* enums = member(schema_, "enums"); enums && enums->is_object())
      for (const auto& [name, e] : enums->items()) check_enum(name, e);
    const Json* classes = member(schema_, "classes");
    if (!classes || !classes->is_object()) return wrong("schema", "no classes");
    for (const auto& [name, c] : classes->items()) {
      if (!identifier(name)) wrong("class " + name, "is no identifier");
      if (const Json* properties = member(c, "properties"); properties && properties->is_object())
        for (const auto& [property, p] : properties->items()) check_property(property, p);
    }
  }

  void check_enum(const std::string& name, const Json& e) {
    const std::string where = "enum " + name;
    if (!identifier(name)) wrong(where, "is no identifier");
    const Json* values = member(e, "values");
    if (!values || !values->is_array() || values->empty()) return wrong(where, "no values");
    std::set<std::string> names;
    std::set<double> numbers;
    for (const Json& v : *values) {
      const auto value = number(member(v, "value"));
      if (!value) return wrong(where, "a value is no number");
      names.insert(text(member(v, "name")));
      numbers.insert(*value);
    }
    if (names.size() != values->size() || numbers.size() != values->size()) wrong(where, "a name or value twice");
    const Component* type = enum_component(e);
    if (!type || !type->integer) return wrong(where, "valueType is no integer");
    const double limit = std::ldexp(1.0, static_cast<int>(8 * type->size) - (type->is_signed ? 1 : 0));
    for (const double v : numbers)
      if (v != std::floor(v) || v >= limit || v < (type->is_signed ? -limit : 0))
        wrong(where, "a value does not fit its type");
  }

  static const Component* enum_component(const Json& e) {
    const Json* type = member(e, "valueType");
    return component(type ? text(type) : "UINT16");
  }

  const Json* enum_of(const Json& property) const {
    return member(member(schema_, "enums"), text(member(property, "enumType")));
  }

  void check_property(const std::string& name, const Json& p) {
    const std::string where = "property " + name, type = text(member(p, "type"));
    if (!identifier(name)) wrong(where, "is no identifier");
    const Json* no_data = member(p, "noData");
    if (type == "ENUM") {
      const Json* e = enum_of(p);
      if (!e) {
        wrong(where, "enumType does not exist");
      } else if (no_data) {
        bool known = false;
        if (const Json* values = member(e, "values"); values && values->is_array())
          for (const Json& v : *values)
            known = known || (no_data->is_string() && text(member(v, "name")) == text(no_data));
        if (!known) wrong(where, "noData is not in the enum");
      }
    } else if (type == "SCALAR") {
      const Component* c = component(text(member(p, "componentType")));
      if (!c) wrong(where, "unknown componentType");
      if (is_true(member(p, "normalized")) && c && !c->integer) wrong(where, "normalised, but no integer");
      if (no_data && !no_data->is_number()) wrong(where, "noData is no number");
    } else if (type == "STRING") {
      if (member(p, "componentType") || member(p, "enumType")) wrong(where, "a STRING has no component type");
      if (no_data && !no_data->is_string()) wrong(where, "noData is no text");
    } else {
      wrong(where, "unknown type");
    }
    if (is_true(member(p, "required")) && (no_data || member(p, "default")))
      wrong(where, "required together with noData");
    if (name.ends_with("_source") && text(member(p, "enumType")) != "Source") wrong(where, "is no Source");
  }

  void read_table(const Json& table) {
    const Json* definition = member(member(member(schema_, "classes"), text(member(table, "class"))), "properties");
    if (!definition || !definition->is_object()) return wrong("table", "its class does not exist");
    const auto count = whole(member(table, "count"));
    // No table has more rows than bytes.
    if (!count || *count < 1 || *count > glb_.bin().size()) return wrong("table", "its count is impossible");
    rows_.resize(*count);
    const Json* columns = member(table, "properties");
    for (const auto& [name, p] : definition->items())
      if (is_true(member(p, "required")) && !member(columns, name)) wrong("column " + name, "is required, but missing");
    if (columns && columns->is_object())
      for (const auto& [name, column] : columns->items()) {
        const Json* property = member(definition, name);
        if (!property)
          wrong("column " + name, "is not in the class");
        else
          read_column(name, *property, column);
      }
    check_rows();
  }

  std::optional<std::string_view> column_bytes(const std::string& where, const Json* index, std::size_t alignment) {
    const auto bytes = glb_.view(index);
    if (!bytes)
      wrong(where, "its buffer view does not exist or leaves the buffer");
    else if (glb_.view_offset(index) % alignment != 0)
      wrong(where, fmt::format("starts at byte {}, no multiple of {}", glb_.view_offset(index), alignment));
    return bytes;
  }

  void read_column(const std::string& name, const Json& property, const Json& column) {
    const std::string where = "column " + name, type = text(member(property, "type"));
    if (type == "STRING") return read_texts(name, property, column);
    const bool is_enum = type == "ENUM";
    const Json* entries = is_enum ? enum_of(property) : nullptr;
    if (is_enum && !entries) return;
    const Component* c = is_enum ? enum_component(*entries) : component(text(member(property, "componentType")));
    if (!c) return;
    const auto bytes = column_bytes(where, member(column, "values"), c->size);
    if (!bytes) return;
    if (bytes->size() != rows_.size() * c->size)
      return wrong(where, fmt::format("{} bytes for {} rows", bytes->size(), rows_.size()));
    std::map<double, std::string> names;
    if (is_enum)
      if (const Json* values = member(entries, "values"); values && values->is_array())
        for (const Json& v : *values) names.emplace(number(member(v, "value")).value_or(-1), text(member(v, "name")));
    const Json* no_data = member(property, "noData");
    const auto absent = number(no_data);
    const std::string absent_name = text(no_data);
    const bool normalised = is_true(member(property, "normalized"));
    const double largest = std::ldexp(1.0, static_cast<int>(8 * c->size) - (c->is_signed ? 1 : 0)) - 1;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Number n = validate::read(*c, *bytes, i);
      if (is_enum) {
        const auto found = names.find(n.value);
        if (found == names.end())
          wrong(where, fmt::format("row {}: {} is not in the enum", i, n.integer));
        else if (!no_data || found->second != absent_name)
          rows_[i][name] = found->second;
        continue;
      }
      if (!std::isfinite(n.value)) {
        wrong(where, fmt::format("row {}: no finite number", i));
        continue;
      }
      if (absent && *absent == n.value) continue;
      rows_[i][name] = normalised   ? base::shortest(n.value / largest)
                       : c->integer ? std::to_string(n.integer)
                                    : base::shortest(n.value);
    }
  }

  void read_texts(const std::string& name, const Json& property, const Json& column) {
    const std::string where = "column " + name;
    const Json* type = member(column, "stringOffsetType");
    const Component* c = component(type ? text(type) : "UINT32");
    if (!c || !c->integer || c->is_signed) return wrong(where, "unknown stringOffsetType");
    const auto bytes = column_bytes(where, member(column, "values"), 1);
    const auto offsets = column_bytes(where, member(column, "stringOffsets"), c->size);
    if (!bytes || !offsets) return;
    if (offsets->size() != (rows_.size() + 1) * c->size)
      return wrong(where, fmt::format("{} bytes of offsets for {} rows", offsets->size(), rows_.size()));
    const std::string absent = text(member(property, "noData"));
    const bool has_absent = member(property, "noData") != nullptr;
    std::uint64_t last = static_cast<std::uint64_t>(validate::read(*c, *offsets, 0).integer);
    if (last != 0) return wrong(where, "the first offset is not 0");
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const auto next = static_cast<std::uint64_t>(validate::read(*c, *offsets, i + 1).integer);
      if (next < last || next > bytes->size())
        return wrong(where, fmt::format("row {}: its offset is out of order or beyond the text", i));
      const std::string_view value = bytes->substr(last, next - last);
      if (!is_utf8(value))
        wrong(where, fmt::format("row {} is not UTF-8", i));
      else if (!has_absent || value != absent)
        rows_[i][name] = value;
      last = next;
    }
    if (last != bytes->size()) wrong(where, fmt::format("{} bytes behind the last text", bytes->size() - last));
  }

  /// What Blockrand promises of its own class.
  void check_rows() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      TableRow& row = rows_[i];
      const std::string where = fmt::format("row {}", i), id = row["id"], building = row["building"];
      if (!is_body_id(id)) wrong(where, fmt::format("\"{}\" is no id", id));
      if (id != building && !id.starts_with(building + "."))
        wrong(where, fmt::format("{} does not belong to {}", id, building));
      for (const char* name : {"tags", "building_tags", "evidence"})
        if (const auto found = row.find(name); found != row.end()) {
          const auto parsed = parse_json(found->second);
          if (!parsed || !parsed->is_object()) wrong(where, fmt::format("{} is no JSON object", name));
        }
      if (const auto sources = row.find("sources"); sources != row.end()) read_sources(row, sources->second, where);
    }
  }

  /// "tag: use, storeys; default: height" as `use_source` and so on.
  void read_sources(TableRow& row, const std::string& text, const std::string& where) {
    for (const std::string& group : base::split(text, ';')) {
      const std::size_t colon = group.find(':');
      if (colon == std::string::npos)
        return wrong(where, fmt::format("sources: \"{}\" is no source with its columns", group));
      for (const std::string& name : base::split(std::string_view(group).substr(colon + 1), ','))
        if (!identifier(name))
          wrong(where, fmt::format("sources: \"{}\" is no column", name));
        else if (!row.emplace(name + "_source", group.substr(0, colon)).second)
          wrong(where, fmt::format("sources: {} has two", name));
    }
  }

  const GlbContainer& glb_;
  const Json* schema_ = nullptr;
  std::vector<TableRow> rows_;
};

}  // namespace

std::vector<TableRow> read_property_table(const GlbContainer& glb) { return Table(glb).read(); }

}  // namespace blockrand::validate
