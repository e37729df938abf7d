// From one type to another (docs/rule_language.md §3.2, conversion).
#include "styles/grammar/evaluation/function_groups.h"
#include "styles/grammar/language/value_text.h"

namespace blockrand::grammar {
namespace {

double to_number(std::uint8_t value) { return value ? 1 : 0; }
double to_number(const std::string& value) { return leading_number(value); }
std::uint8_t to_truth(double value) { return value != 0; }
std::uint8_t to_truth(const std::string& value) { return truth_of(value); }
std::string to_text(double value) { return number_text(value); }
std::string to_text(std::uint8_t value) { return value ? "true" : "false"; }

FunctionResult number_of_truth(Arguments a, FunctionContext&) { return Value(truth(a[0]) ? 1.0 : 0.0); }
FunctionResult number_of_text(Arguments a, FunctionContext&) { return Value(leading_number(text(a[0]))); }
FunctionResult truth_of_number(Arguments a, FunctionContext&) { return Value(number(a[0]) != 0); }
FunctionResult truth_of_text(Arguments a, FunctionContext&) { return Value(truth_of(text(a[0]))); }
FunctionResult same(Arguments a, FunctionContext&) { return a[0]; }
FunctionResult text_of(Arguments a, FunctionContext&) { return Value(value_text(a[0])); }

template <typename To, typename From, To (*convert)(const From&)>
FunctionResult map_items(Arguments a, FunctionContext&) {
  const auto& in = std::get<Array<From>>(a[0]);
  Array<To> out{{}, in.columns};
  out.items.reserve(in.items.size());
  for (const From& item : in.items) out.items.push_back(convert(item));
  return Value(std::move(out));
}
template <typename To, typename From>
To number_item(const From& item) {
  return to_number(item);
}
template <typename To, typename From>
To truth_item(const From& item) {
  return to_truth(item);
}
template <typename To, typename From>
To text_item(const From& item) {
  return to_text(item);
}
template <typename From>
constexpr Function to_numbers = map_items<double, From, number_item<double, From>>;
template <typename From>
constexpr Function to_truths = map_items<std::uint8_t, From, truth_item<std::uint8_t, From>>;
template <typename From>
constexpr Function to_texts = map_items<std::string, From, text_item<std::string, From>>;

template <typename T>
FunctionResult empty_array(Arguments, FunctionContext&) {
  return Value(Array<T>{});
}

/// No value is ever missing here: attributes always have one.
FunctionResult never_null(Arguments, FunctionContext&) { return Value(false); }
template <typename T>
FunctionResult never_null_items(Arguments a, FunctionContext&) {
  const auto& in = std::get<Array<T>>(a[0]);
  return Value(TruthArray{std::vector<std::uint8_t>(in.items.size(), 0), in.columns});
}

}  // namespace

std::span<const FunctionEntry> conversion_functions() {
  static const FunctionEntry kTable[] = {
      {"bool", "n", truth_of_number, true},
      {"bool", "b", same},
      {"bool", "s", truth_of_text},
      {"boolArray", "", empty_array<std::uint8_t>},
      {"boolArray", "N", to_truths<double>, true},
      {"boolArray", "B", same},
      {"boolArray", "S", to_truths<std::string>},
      {"float", "n", same, true},
      {"float", "b", number_of_truth},
      {"float", "s", number_of_text},
      {"floatArray", "", empty_array<double>},
      {"floatArray", "N", same, true},
      {"floatArray", "B", to_numbers<std::uint8_t>},
      {"floatArray", "S", to_numbers<std::string>},
      {"isNull", "n", never_null, true},
      {"isNull", "b", never_null},
      {"isNull", "s", never_null},
      {"isNull", "N", never_null_items<double>, true},
      {"isNull", "B", never_null_items<std::uint8_t>},
      {"isNull", "S", never_null_items<std::string>},
      {"sel", "s", same},
      {"str", "n", text_of, true},
      {"str", "b", text_of},
      {"str", "s", same},
      {"str", "N", text_of, true},
      {"str", "B", text_of},
      {"str", "S", text_of},
      {"stringArray", "", empty_array<std::string>},
      {"stringArray", "N", to_texts<double>, true},
      {"stringArray", "B", to_texts<std::uint8_t>},
      {"stringArray", "S", same},
  };
  return kTable;
}

}  // namespace blockrand::grammar
