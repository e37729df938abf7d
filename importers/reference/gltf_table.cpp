#include "importers/reference/gltf_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <span>
#include <utility>

#include "importers/reference/file_bytes.h"

namespace blockrand::importers::reference {
namespace {

using Bytes = std::span<const unsigned char>;

/// A scalar type of the metadata specification.
struct ScalarType {
  std::string_view name;
  std::size_t size;
  bool floating, is_signed;
};
constexpr ScalarType kScalars[] = {
    {"INT8", 1, false, true},   {"UINT8", 1, false, false},  {"INT16", 2, false, true}, {"UINT16", 2, false, false},
    {"INT32", 4, false, true},  {"UINT32", 4, false, false}, {"INT64", 8, false, true}, {"UINT64", 8, false, false},
    {"FLOAT32", 4, true, true}, {"FLOAT64", 8, true, true}};

const ScalarType* scalar_type(std::string_view name) {
  const auto found =
      std::find_if(std::begin(kScalars), std::end(kScalars), [&](const auto& t) { return t.name == name; });
  return found == std::end(kScalars) ? nullptr : found;
}

template <class T>
std::string shortest(T value) {
  char buffer[40];
  return {buffer, std::to_chars(buffer, buffer + sizeof(buffer), value).ptr};
}

/// One value; integers as 64 bits, so that none loses digits.
struct Scalar {
  bool floating = false;
  double real = 0;
  std::int64_t whole = 0;
  double number() const { return floating ? real : static_cast<double>(whole); }
};

Scalar scalar_at(const unsigned char* bytes, const ScalarType& type) {
  Scalar out;
  out.floating = type.floating;
  if (type.floating) {
    float narrow = 0;
    if (type.size == 4) std::memcpy(&narrow, bytes, 4);
    if (type.size == 8) std::memcpy(&out.real, bytes, 8);
    if (type.size == 4) out.real = static_cast<double>(narrow);
    return out;
  }
  std::uint64_t bits = 0;
  std::memcpy(&bits, bytes, type.size);
  const unsigned shift = static_cast<unsigned>(64 - 8 * type.size);
  out.whole = type.is_signed ? static_cast<std::int64_t>(bits << shift) >> shift : static_cast<std::int64_t>(bits);
  return out;
}

class TableReader {
 public:
  TableReader(GltfFile& file, NoteLog& notes, const Json& schema, const Json& table)
      : file_(file), notes_(notes), schema_(schema), table_(table) {}

  FeatureTable read() {
    FeatureTable out;
    const std::string class_name = text(member(table_, "class"));
    const Json& properties = member(member(member(schema_, "classes"), class_name.c_str()), "properties");
    const auto count = index(member(table_, "count"));
    if (!count) {
      notes_.add(NoteKind::bad_value, 0, "a property table without count");
      return out;
    }
    rows_ = *count;
    // Without columns a table says nothing but how many there are; that many bytes nobody has counted.
    constexpr std::size_t kMostBare = 1'000'000;
    for (const auto& [name, values] : member(table_, "properties").items()) {
      if (auto column = read_column(name, member(properties, name.c_str()), values))
        out.columns.push_back(std::move(*column));
    }
    if (out.columns.empty() && rows_ > kMostBare) {
      notes_.add(NoteKind::bad_value, 0, "a property table of " + std::to_string(rows_) + " rows without values");
      return out;
    }
    out.rows = rows_;
    return out;
  }

 private:
  std::optional<FeatureTable::Column> read_column(const std::string& name, const Json& property, const Json& values) {
    const std::string type = text(member(property, "type"));
    const auto leave_out = [&](NoteKind kind, const std::string& what) {
      notes_.add(kind, 0, "property \"" + name + "\" " + what);
      return std::nullopt;
    };
    const bool is_array = member(property, "array") == true;
    const bool known = type == "STRING" || type == "SCALAR" || type == "ENUM" || type == "BOOLEAN";
    if (is_array || !known) return leave_out(NoteKind::not_read, "of type " + type + (is_array ? " array" : ""));
    const auto bytes = file_.view(member(values, "values"));
    if (!bytes) return std::nullopt;
    FeatureTable::Column out;
    out.name = name;
    out.is_id = text(member(property, "semantic")) == "ID";
    const bool read = type == "STRING"    ? read_texts(*bytes, values, property, out)
                      : type == "BOOLEAN" ? read_truths(*bytes, out)
                      : type == "ENUM"    ? read_enum(*bytes, property, out)
                                          : read_scalars(*bytes, values, property, out);
    if (!read) return leave_out(NoteKind::bad_index, "has fewer values than the table has rows");
    return out;
  }

  bool read_texts(Bytes bytes, const Json& values, const Json& property, FeatureTable::Column& out) {
    const auto offsets = file_.view(member(values, "stringOffsets"));
    const std::string stated = text(member(values, "stringOffsetType"));
    const ScalarType* type = scalar_type(stated.empty() ? "UINT32" : stated);
    if (!offsets || type == nullptr || type->floating || offsets->size() / type->size < 1 ||
        offsets->size() / type->size - 1 < rows_)
      return false;
    const Json& no_data = member(property, "noData");
    const auto offset = [&](std::size_t i) {
      return static_cast<std::uint64_t>(scalar_at(offsets->data() + i * type->size, *type).whole);
    };
    out.rows.reserve(rows_);
    for (std::size_t i = 0; i < rows_; ++i) {
      const std::uint64_t begin = offset(i), end = offset(i + 1);
      if (begin > end || end > bytes.size()) return false;
      std::string value(reinterpret_cast<const char*>(bytes.data()) + begin, end - begin);
      const bool absent = no_data.is_string() && value == no_data.get_ref<const std::string&>();
      out.rows.push_back(absent ? std::nullopt : std::optional(std::move(value)));
    }
    return true;
  }

  bool read_truths(Bytes bytes, FeatureTable::Column& out) const {
    if (bytes.size() < rows_ / 8 + (rows_ % 8 != 0)) return false;
    for (std::size_t i = 0; i < rows_; ++i)
      out.rows.emplace_back((bytes[i / 8] >> (i % 8) & 1) != 0 ? "true" : "false");
    return true;
  }

  bool read_enum(Bytes bytes, const Json& property, FeatureTable::Column& out) const {
    const std::string enum_name = text(member(property, "enumType"));
    const Json& stated = member(member(schema_, "enums"), enum_name.c_str());
    const std::string value_type = text(member(stated, "valueType"));
    const ScalarType* type = scalar_type(value_type.empty() ? "UINT16" : value_type);
    if (type == nullptr || type->floating || bytes.size() / type->size < rows_) return false;
    std::map<std::int64_t, std::string> names;
    for (const Json& value : member(stated, "values"))
      if (const auto number_of_value = number(member(value, "value"));
          number_of_value && std::fabs(*number_of_value) < 9e15)
        names.emplace(static_cast<std::int64_t>(*number_of_value), text(member(value, "name")));
    const std::string no_data = text(member(property, "noData"));
    for (std::size_t i = 0; i < rows_; ++i) {
      const std::int64_t value = scalar_at(bytes.data() + i * type->size, *type).whole;
      const auto named = names.find(value);
      std::string name = named != names.end() ? named->second : shortest(value);
      const bool absent = !no_data.empty() && name == no_data;
      out.rows.push_back(absent ? std::nullopt : std::optional(std::move(name)));
    }
    return true;
  }

  bool read_scalars(Bytes bytes, const Json& values, const Json& property, FeatureTable::Column& out) const {
    const std::string component = text(member(property, "componentType"));
    const ScalarType* type = scalar_type(component);
    if (type == nullptr || bytes.size() / type->size < rows_) return false;
    const bool normalized = member(property, "normalized") == true && !type->floating;
    const double steps = std::ldexp(1.0, static_cast<int>(8 * type->size) - (type->is_signed ? 1 : 0)) - 1;
    const auto own_or = [&](const char* name) {
      const auto own = number(member(values, name));
      return own ? own : number(member(property, name));
    };
    const auto offset = own_or("offset"), scale = own_or("scale"), no_data = number(member(property, "noData"));
    for (std::size_t i = 0; i < rows_; ++i) {
      const Scalar raw = scalar_at(bytes.data() + i * type->size, *type);
      std::optional<std::string> value;
      if (!normalized && !offset && !scale) {
        value = raw.floating      ? shortest(raw.real)
                : type->is_signed ? shortest(raw.whole)
                                  : shortest(static_cast<std::uint64_t>(raw.whole));
      } else {
        const double fraction = normalized ? std::max(raw.number() / steps, -1.0) : raw.number();
        value = shortest(fraction * scale.value_or(1) + offset.value_or(0));
      }
      const bool absent = (no_data && raw.number() == *no_data) || (raw.floating && !std::isfinite(raw.real));
      out.rows.push_back(absent ? std::nullopt : std::move(value));
    }
    return true;
  }

  GltfFile& file_;
  NoteLog& notes_;
  const Json& schema_;
  const Json& table_;
  std::size_t rows_ = 0;
};

/// "measured_height" and "measuredHeight" are the same.
std::string plain(std::string_view name) {
  std::string out;
  for (const char c : name)
    if (c != '_' && c != ' ' && c != ':' && c != '-')
      out += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return out;
}

}  // namespace

const FeatureTable::Column* FeatureTable::column(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names)
    for (const Column& c : columns)
      if (plain(c.name) == plain(name)) return &c;
  return nullptr;
}

std::vector<FeatureTable> read_tables(GltfFile& file, const std::string& path, NoteLog& notes) {
  const Json& metadata = member(member(file.json(), "extensions"), "EXT_structural_metadata");
  const Json* schema = &member(metadata, "schema");
  Json external;
  if (const std::string uri = text(member(metadata, "schemaUri")); schema->is_null() && !uri.empty()) {
    const std::string other = file_of_uri(std::filesystem::path(path).parent_path().string(), uri);
    std::error_code error;
    if (!other.empty() && std::filesystem::is_regular_file(other, error)) {
      external = parse_json(other, all_bytes(other));
      schema = &external;
    } else {
      notes.add(NoteKind::unresolved_link, 0, "the schema of the metadata: " + uri);
    }
  }
  std::vector<FeatureTable> out;
  for (const Json& table : member(metadata, "propertyTables"))
    out.push_back(TableReader(file, notes, *schema, table).read());
  return out;
}

}  // namespace blockrand::importers::reference
