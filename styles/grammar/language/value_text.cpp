// Texts of values and values of texts, the same on every machine and in every locale.
#include "styles/grammar/language/value_text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace blockrand::grammar {
namespace {

/// Doubles hold 15 decimal digits whatever their value; the sixteenth shows the error of the last operation.
constexpr int kSignificantDigits = 15;
/// Beyond these, plain digits are longer than anyone reads.
constexpr double kLargestPlain = 1e15, kSmallestPlain = 1e-6;

std::string item_text(double value) { return number_text(value); }
std::string item_text(std::uint8_t value) { return value ? "true" : "false"; }
const std::string& item_text(const std::string& value) { return value; }

template <typename T>
std::string array_text(const Array<T>& array) {
  const std::size_t rows = array.rows();
  std::string out = "(";
  out += rows > 1 ? std::to_string(rows) + "x" + std::to_string(array.columns) : std::to_string(array.items.size());
  out += ")[";
  for (std::size_t i = 0; i < array.items.size(); ++i) {
    if (i > 0) out += i % array.columns == 0 ? ';' : ',';
    out += item_text(array.items[i]);
  }
  return out + "]";
}

}  // namespace

std::string number_text(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
  if (value == 0) return "0";
  std::array<char, 64> digits;
  const double size = std::abs(value);
  if (value == std::floor(value) && size < kLargestPlain) {
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<long long>(value)).ptr;
    return {digits.data(), end};
  }
  if (size < kSmallestPlain || size >= kLargestPlain) {
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general,
                                   kSignificantDigits)
                         .ptr;
    return {digits.data(), end};
  }
  // As many places as make 15 digits in all: zeros before the first digit do not count.
  int places = kSignificantDigits - 1;
  for (double tens = 10; tens <= size; tens *= 10) --places;
  for (double rest = size; rest < 1; rest *= 10) ++places;
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed, places).ptr;
  std::string out(digits.data(), end);
  if (out.find('.') != std::string::npos) {
    out.erase(out.find_last_not_of('0') + 1);
    if (out.back() == '.') out.pop_back();
  }
  return out;
}

std::string value_text(const Value& value) {
  switch (type_of(value)) {
    case Type::number:
      return number_text(std::get<double>(value));
    case Type::truth:
      return std::get<bool>(value) ? "true" : "false";
    case Type::text:
      return std::get<std::string>(value);
    case Type::number_array:
      return array_text(std::get<NumberArray>(value));
    case Type::truth_array:
      return array_text(std::get<TruthArray>(value));
    case Type::text_array:
      return array_text(std::get<TextArray>(value));
  }
  return {};
}

double leading_number(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return std::numeric_limits<double>::quiet_NaN();
  text.remove_prefix(first);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec == std::errc::result_out_of_range) {
    // Too large or too small: the exponent's sign tells which.
    const std::string_view used(text.data(), static_cast<std::size_t>(read.ptr - text.data()));
    const bool small = used.find("e-") != std::string_view::npos || used.find("E-") != std::string_view::npos;
    const double size = small ? 0 : std::numeric_limits<double>::infinity();
    return text[0] == '-' ? -size : size;
  }
  return read.ec == std::errc() ? value : std::numeric_limits<double>::quiet_NaN();
}

bool truth_of(std::string_view text) {
  if (text == "f" || text == "false") return false;
  double value = 1;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return !(read.ec == std::errc() && read.ptr == text.data() + text.size() && value == 0);
}

std::string_view type_name(Type type) {
  static constexpr std::array<std::string_view, 6> kNames = {"number",       "truth value", "text",
                                                             "number array", "truth array", "text array"};
  return kNames[static_cast<std::size_t>(type)];
}

}  // namespace blockrand::grammar
