// Functions of arrays (docs/rule_language.md §3.2, arrays).
#include <algorithm>
#include <numeric>

#include "styles/grammar/evaluation/arrays.h"
#include "styles/grammar/evaluation/function_groups.h"
#include "styles/grammar/language/value_text.h"

namespace blockrand::grammar {
namespace {

template <typename T>
const Array<T>& array(const Value& value) {
  return std::get<Array<T>>(value);
}

template <typename T>
FunctionResult size(Arguments a, FunctionContext&) {
  return Value(static_cast<double>(array<T>(a[0]).items.size()));
}
template <typename T>
FunctionResult rows(Arguments a, FunctionContext&) {
  return Value(static_cast<double>(array<T>(a[0]).rows()));
}
template <typename T>
FunctionResult columns(Arguments a, FunctionContext&) {
  return Value(static_cast<double>(array<T>(a[0]).columns));
}
template <typename T>
FunctionResult transpose(Arguments a, FunctionContext&) {
  const auto& in = array<T>(a[0]);
  Array<T> out;
  for (std::size_t x = 0; x < in.columns; ++x)
    for (std::size_t y = 0; y < in.rows(); ++y) out.items.push_back(in.items[y * in.columns + x]);
  out.columns = in.rows();
  return Value(std::move(out));
}
template <typename T>
FunctionResult sum(Arguments a, FunctionContext&) {
  double out = 0;
  for (const T item : array<T>(a[0]).items) out += static_cast<double>(item);
  return Value(out);
}

template <typename T, typename Same>
FunctionResult first_where(const Array<T>& in, const Same& same) {
  const auto found = std::find_if(in.items.begin(), in.items.end(), same);
  return Value(found == in.items.end() ? -1.0 : static_cast<double>(found - in.items.begin()));
}
FunctionResult find_number(Arguments a, FunctionContext&) {
  const double epsilon = a.size() > 2 ? number(a[2]) : 0;
  return first_where(array<double>(a[0]), [&](double item) { return std::abs(item - number(a[1])) <= epsilon; });
}
FunctionResult find_truth(Arguments a, FunctionContext&) {
  return first_where(array<std::uint8_t>(a[0]), [&](std::uint8_t item) { return (item != 0) == truth(a[1]); });
}
FunctionResult find_text(Arguments a, FunctionContext&) {
  return first_where(array<std::string>(a[0]), [&](const std::string& item) { return item == text(a[1]); });
}

FunctionResult numbered(std::vector<std::size_t> order) {
  NumberArray out;
  for (const std::size_t at : order) out.items.push_back(static_cast<double>(at));
  out.columns = out.items.size();
  return Value(std::move(out));
}
/// Equal ones keep their order.
template <typename T>
FunctionResult sort_indices(Arguments a, FunctionContext&) {
  const auto& in = array<T>(a[0]);
  std::vector<std::size_t> order(in.items.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return in.items[x] < in.items[y]; });
  return numbered(std::move(order));
}
template <typename T>
FunctionResult sort_rows(Arguments a, FunctionContext&) {
  const auto& in = array<T>(a[0]);
  std::vector<std::size_t> order(in.rows());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto row = [&](std::size_t y) { return in.items.begin() + static_cast<std::ptrdiff_t>(y * in.columns); };
  const auto width = static_cast<std::ptrdiff_t>(in.columns);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) {
    return std::lexicographical_compare(row(x), row(x) + width, row(y), row(y) + width);
  });
  return numbered(std::move(order));
}

/// Elements named by an index or a mask.
std::vector<long long> places(const Value& value) {
  std::vector<long long> out;
  if (const auto* one = std::get_if<double>(&value)) out.push_back(whole(*one));
  if (const auto* many = std::get_if<NumberArray>(&value))
    for (const double item : many->items) out.push_back(whole(item));
  if (const auto* mask = std::get_if<TruthArray>(&value))
    for (std::size_t i = 0; i < mask->items.size(); ++i)
      if (mask->items[i]) out.push_back(static_cast<long long>(i));
  return out;
}

template <typename T>
T single(const Value& value) {
  if constexpr (std::is_same_v<T, std::uint8_t>)
    return truth(value);
  else
    return std::get<T>(value);
}
/// Makes room for `rows` rows and `columns` columns, filled with defaults. \returns false: too many elements
template <typename T>
bool grow(Array<T>& array, std::size_t rows, std::size_t columns) {
  rows = std::max(rows, array.rows());
  columns = std::max(columns, array.columns);
  if (rows > kMostArrayItems || columns > kMostArrayItems || rows * columns > kMostArrayItems) return false;
  if (columns != array.columns) {
    std::vector<T> items(rows * columns);
    for (std::size_t i = 0; i < array.items.size(); ++i)
      items[i / array.columns * columns + i % array.columns] = std::move(array.items[i]);
    array.items = std::move(items);
    array.columns = columns;
  }
  array.items.resize(rows * columns);
  return true;
}

/// `setElems(array, [rows,] columns, values)` (page func_setElems): negative places are passed over, larger ones
/// enlarge.
template <typename T>
FunctionResult set_elements(Arguments a, FunctionContext&) {
  Array<T> out = array<T>(a[0]);
  const bool table = a.size() == 4;
  const std::vector<long long> columns = places(a[table ? 2 : 1]);
  const std::vector<long long> rows = table ? places(a[1]) : std::vector<long long>{0};
  const Value& given = a.back();
  const auto* many = std::get_if<Array<T>>(&given);
  if (many != nullptr && many->items.size() != rows.size() * columns.size())
    return failure("setElems needs one value, or as many as there are places");
  const auto value_at = [&](std::size_t i) { return many != nullptr ? many->items[i] : single<T>(given); };
  for (std::size_t y = 0; y < rows.size(); ++y)
    for (std::size_t x = 0; x < columns.size(); ++x) {
      if (rows[y] < 0 || columns[x] < 0) continue;
      const auto row = static_cast<std::size_t>(rows[y]), column = static_cast<std::size_t>(columns[x]);
      std::size_t at = row * out.columns + column;
      if (table ? row >= out.rows() || column >= out.columns : at >= out.items.size()) {
        const bool one_row = !table && out.rows() > 1;  // numbers beyond the end add rows to a table
        const std::size_t need = one_row ? column / out.columns + 1 : row + 1;
        if (!grow(out, need, one_row ? out.columns : column + 1)) return failure("the array has too many elements");
        at = row * out.columns + column;
      }
      out.items[at] = value_at(y * columns.size() + x);
    }
  return Value(std::move(out));
}

/// setElems takes an index of any kind and one or many values.
std::vector<FunctionEntry> set_elements_entries() {
  std::vector<FunctionEntry> out;
  static constexpr std::string_view kNumbers[] = {"Nnn",  "NNn",  "NBn",  "NnN",  "NNN",  "NBN",  "Nnnn", "NnNn",
                                                  "NNnn", "NNNn", "NBnn", "NnBn", "NBNn", "NNBn", "NBBn", "NnnN",
                                                  "NnNN", "NNnN", "NNNN", "NBnN", "NnBN", "NBNN", "NNBN", "NBBN"};
  static constexpr std::string_view kTruths[] = {"Bnb",  "BNb",  "BBb",  "BnB",  "BNB",  "BBB",  "Bnnb", "BnNb",
                                                 "BNnb", "BNNb", "BBnb", "BnBb", "BBNb", "BNBb", "BBBb", "BnnB",
                                                 "BnNB", "BNnB", "BNNB", "BBnB", "BnBB", "BBNB", "BNBB", "BBBB"};
  static constexpr std::string_view kTexts[] = {"Sns",  "SNs",  "SBs",  "SnS",  "SNS",  "SBS",  "Snns", "SnNs",
                                                "SNns", "SNNs", "SBns", "SnBs", "SBNs", "SNBs", "SBBs", "SnnS",
                                                "SnNS", "SNnS", "SNNS", "SBnS", "SnBS", "SBNS", "SNBS", "SBBS"};
  for (const auto parameters : kNumbers) out.push_back({"setElems", parameters, set_elements<double>});
  for (const auto parameters : kTruths) out.push_back({"setElems", parameters, set_elements<std::uint8_t>});
  for (const auto parameters : kTexts) out.push_back({"setElems", parameters, set_elements<std::string>});
  return out;
}

}  // namespace

std::span<const FunctionEntry> array_functions() {
  static const std::vector<FunctionEntry> kTable = [] {
    std::vector<FunctionEntry> out = {
        {"findFirst", "Nn", find_number},
        {"findFirst", "Nnn", find_number},
        {"findFirst", "Bb", find_truth},
        {"findFirst", "Ss", find_text},
        {"nColumns", "N", columns<double>},
        {"nColumns", "B", columns<std::uint8_t>},
        {"nColumns", "S", columns<std::string>},
        {"nRows", "N", rows<double>},
        {"nRows", "B", rows<std::uint8_t>},
        {"nRows", "S", rows<std::string>},
        {"size", "N", size<double>},
        {"size", "B", size<std::uint8_t>},
        {"size", "S", size<std::string>},
        {"sortIndices", "N", sort_indices<double>},
        {"sortIndices", "S", sort_indices<std::string>},
        {"sortRowIndices", "N", sort_rows<double>},
        {"sortRowIndices", "S", sort_rows<std::string>},
        {"sum", "N", sum<double>},
        {"sum", "B", sum<std::uint8_t>},
        {"transpose", "N", transpose<double>},
        {"transpose", "B", transpose<std::uint8_t>},
        {"transpose", "S", transpose<std::string>},
    };
    const auto more = set_elements_entries();
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }();
  return kTable;
}

}  // namespace blockrand::grammar
