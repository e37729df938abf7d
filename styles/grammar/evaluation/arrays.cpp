// Making arrays and taking elements out of them.
#include "styles/grammar/evaluation/arrays.h"

#include <algorithm>
#include <cmath>

#include "styles/grammar/evaluation/function_groups.h"
#include "styles/grammar/language/value_text.h"

namespace blockrand::grammar {
namespace {

/// Relative to the step: a range's last element may lie this far beyond the limit, since 0.1 is not a tenth.
constexpr double kRangeTolerance = 1e-9;

template <typename T>
struct Single {
  using type = T;
};
template <>
struct Single<std::uint8_t> {
  using type = bool;
};

template <typename T>
Value element(const Array<T>& array, long long index) {
  using Out = typename Single<T>::type;
  if (index < 0 || index >= static_cast<long long>(array.items.size())) return Value(Out{});
  return Value(static_cast<Out>(array.items[static_cast<std::size_t>(index)]));
}

/// An element that may be missing.
template <typename T>
T element_or_default(const Array<T>& array, long long row, long long column) {
  if (row < 0 || column < 0 || row >= static_cast<long long>(array.rows()) ||
      column >= static_cast<long long>(array.columns))
    return T{};
  return array.items[static_cast<std::size_t>(row) * array.columns + static_cast<std::size_t>(column)];
}

/// Which elements an index means; numbers are cut to whole ones.
tl::expected<std::vector<long long>, std::string> places(const Value& index) {
  std::vector<long long> out;
  if (const auto* one = std::get_if<double>(&index)) {
    out.push_back(static_cast<long long>(std::floor(std::isfinite(*one) ? std::clamp(*one, -1e15, 1e15) : -1)));
  } else if (const auto* many = std::get_if<NumberArray>(&index)) {
    for (const double item : many->items)
      out.push_back(static_cast<long long>(std::floor(std::isfinite(item) ? std::clamp(item, -1e15, 1e15) : -1)));
  } else if (const auto* mask = std::get_if<TruthArray>(&index)) {
    for (std::size_t i = 0; i < mask->items.size(); ++i)
      if (mask->items[i]) out.push_back(static_cast<long long>(i));
  } else {
    return failure("an index is a number, an array of numbers or of truth values, not a " +
                   std::string(type_name(type_of(index))));
  }
  return out;
}

/// Calls `with(array)` with the array in `value`, or fails.
template <typename With>
ValueResult with_array(const Value& value, const With& with) {
  switch (type_of(value)) {
    case Type::number_array:
      return with(std::get<NumberArray>(value));
    case Type::truth_array:
      return with(std::get<TruthArray>(value));
    case Type::text_array:
      return with(std::get<TextArray>(value));
    case Type::number:
    case Type::truth:
    case Type::text:
      break;
  }
  return failure("a " + std::string(type_name(type_of(value))) + " has no elements");
}

template <typename T>
void append_part(const Value& value, std::vector<const Array<T>*>& parts, std::vector<Array<T>>& singles) {
  if (const auto* array = std::get_if<Array<T>>(&value)) {
    parts.push_back(array);
    return;
  }
  singles.push_back({{static_cast<T>(std::get<typename Single<T>::type>(value))}, 1});
  parts.push_back(&singles.back());
}

template <typename T>
ValueResult joined_rows(std::span<const std::vector<Value>> rows) {
  std::vector<Array<T>> done;
  std::size_t columns = 0, total_rows = 0;
  for (const auto& row : rows) {
    std::vector<Array<T>> singles;
    singles.reserve(row.size());
    std::vector<const Array<T>*> parts;
    for (const Value& value : row) append_part(value, parts, singles);
    std::size_t height = 0, width = 0;
    for (const auto* part : parts) {
      height = std::max(height, part->rows());
      width += part->columns;
    }
    if (height * width > kMostArrayItems) return failure("the array has too many elements");
    Array<T> line;
    line.columns = width;
    for (std::size_t y = 0; y < height; ++y)
      for (const auto* part : parts)
        for (std::size_t x = 0; x < part->columns; ++x)
          line.items.push_back(y < part->rows() ? part->items[y * part->columns + x] : T{});
    columns = std::max(columns, width);
    total_rows += height;
    done.push_back(std::move(line));
  }
  if (columns * total_rows > kMostArrayItems) return failure("the array has too many elements");
  if constexpr (std::is_same_v<T, std::string>) {
    std::size_t bytes = 0;
    for (const Array<T>& line : done)
      for (const std::string& item : line.items) bytes += item.size();
    if (bytes > kMostTextBytes) return failure("the texts of the array become too long");
  }
  Array<T> out;
  for (const Array<T>& line : done)
    for (std::size_t y = 0; y < line.rows(); ++y)
      for (std::size_t x = 0; x < columns; ++x)
        out.items.push_back(x < line.columns ? line.items[y * line.columns + x] : T{});
  out.columns = out.items.empty() ? 0 : columns;
  return Value(std::move(out));
}

}  // namespace

Value default_value(Type type) {
  switch (type) {
    case Type::number:
      return 0.0;
    case Type::truth:
      return false;
    case Type::text:
      return std::string();
    case Type::number_array:
      return NumberArray{};
    case Type::truth_array:
      return TruthArray{};
    case Type::text_array:
      return TextArray{};
  }
  return 0.0;
}

Type item_type(Type type) { return type >= Type::number_array ? static_cast<Type>(static_cast<int>(type) - 3) : type; }
Type array_type(Type type) { return type < Type::number_array ? static_cast<Type>(static_cast<int>(type) + 3) : type; }

ValueResult make_range(double base, double step, double limit) {
  if (!std::isfinite(base) || !std::isfinite(step) || !std::isfinite(limit))
    return failure("the bounds of a range must be finite");
  NumberArray out;
  if (step != 0) {
    const double count = std::floor((limit - base) / step + kRangeTolerance) + 1;
    if (count > static_cast<double>(kMostArrayItems)) return failure("the range has too many elements");
    for (double i = 0; i < count; ++i) out.items.push_back(base + i * step);
  }
  out.columns = out.items.size();
  return Value(std::move(out));
}

ValueResult make_array(std::span<const std::vector<Value>> rows) {
  std::optional<Type> type;
  for (const auto& row : rows)
    for (const Value& value : row) {
      const Type found = item_type(type_of(value));
      if (type && *type != found)
        return failure("an array holds " + std::string(type_name(*type)) + "s or " + std::string(type_name(found)) +
                       "s, not both");
      type = found;
    }
  switch (type.value_or(Type::number)) {
    case Type::truth:
      return joined_rows<std::uint8_t>(rows);
    case Type::text:
      return joined_rows<std::string>(rows);
    case Type::number:
    case Type::number_array:
    case Type::truth_array:
    case Type::text_array:
      break;
  }
  return joined_rows<double>(rows);
}

ValueResult index_value(const Value& array, const Value& index) {
  const auto found = places(index);
  if (!found) return failure(found.error());
  return with_array(array, [&](const auto& in) -> ValueResult {
    if (type_of(index) == Type::number) return element(in, found->front());
    auto out = in;
    out.items.clear();
    for (const long long at : *found)
      out.items.push_back(at >= 0 && at < static_cast<long long>(in.items.size())
                              ? in.items[static_cast<std::size_t>(at)]
                              : typename std::decay_t<decltype(in.items)>::value_type{});
    const auto* shaped = std::get_if<NumberArray>(&index);
    out.columns = shaped != nullptr ? shaped->columns : out.items.size();
    return Value(std::move(out));
  });
}

ValueResult index_value(const Value& array, const Value& row, const Value& column) {
  const auto rows = places(row), columns = places(column);
  if (!rows) return failure(rows.error());
  if (!columns) return failure(columns.error());
  if (rows->size() * columns->size() > kMostArrayItems) return failure("the array has too many elements");
  return with_array(array, [&](const auto& in) -> ValueResult {
    auto out = in;
    out.items.clear();
    for (const long long y : *rows)
      for (const long long x : *columns) out.items.push_back(element_or_default(in, y, x));
    if (type_of(row) == Type::number && type_of(column) == Type::number) return element(out, 0);
    out.columns = out.items.empty() ? 0 : columns->size();
    return Value(std::move(out));
  });
}

}  // namespace blockrand::grammar
