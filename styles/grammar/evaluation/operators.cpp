// Operators of single values, and the ones with a dot, element by element.
#include <cmath>
#include <functional>

#include "styles/grammar/evaluation/arrays.h"
#include "styles/grammar/evaluation/functions.h"
#include "styles/grammar/language/value_text.h"

namespace blockrand::grammar {
namespace {

ValueResult wrong(const char* sign, const Value& left, const Value& right) {
  return failure(std::string(sign) + " does not go with a " + std::string(type_name(type_of(left))) + " and a " +
                 std::string(type_name(type_of(right))));
}

const char* sign_of(Operator op) {
  static constexpr const char* kSigns[] = {"?",  "-",  "+",   "!",   "+",  "-",   "*",  "/",   "%",   "==",
                                           "!=", "<",  "<=",  ">",   ">=", "&&",  "||", ".+",  ".-",  ".*",
                                           "./", ".%", ".==", ".!=", ".<", ".<=", ".>", ".>=", ".&&", ".||"};
  return kSigns[static_cast<std::size_t>(op)];
}

/// -1, 0, 1 as the reference orders arrays: the first row that differs decides, then the columns, then the rows.
template <typename T>
int order(const Array<T>& a, const Array<T>& b) {
  const std::size_t rows = std::min(a.rows(), b.rows()), columns = std::min(a.columns, b.columns);
  for (std::size_t y = 0; y < rows; ++y) {
    for (std::size_t x = 0; x < columns; ++x) {
      const T &left = a.items[y * a.columns + x], &right = b.items[y * b.columns + x];
      if (left < right) return -1;
      if (right < left) return 1;
    }
    if (a.columns != b.columns) return a.columns < b.columns ? -1 : 1;
  }
  return a.rows() == b.rows() ? 0 : a.rows() < b.rows() ? -1 : 1;
}

template <typename T>
ValueResult compare_arrays(Operator op, const Array<T>& a, const Array<T>& b) {
  if (op == Operator::equal) return Value(a == b);
  if (op == Operator::not_equal) return Value(!(a == b));
  return Value(compare(op, order(a, b), 0));
}

/// The operator on single values behind one with a dot.
Operator single(Operator op) {
  return static_cast<Operator>(static_cast<int>(op) - static_cast<int>(Operator::each_add) +
                               (op >= Operator::each_and
                                    ? static_cast<int>(Operator::logical_and) -
                                          (static_cast<int>(Operator::each_and) - static_cast<int>(Operator::each_add))
                                    : static_cast<int>(Operator::add)));
}

std::size_t size_of(const Value& value) {
  switch (type_of(value)) {
    case Type::number_array:
      return std::get<NumberArray>(value).items.size();
    case Type::truth_array:
      return std::get<TruthArray>(value).items.size();
    case Type::text_array:
      return std::get<TextArray>(value).items.size();
    case Type::number:
    case Type::truth:
    case Type::text:
      break;
  }
  return 1;
}
std::size_t columns_of(const Value& value) {
  switch (type_of(value)) {
    case Type::number_array:
      return std::get<NumberArray>(value).columns;
    case Type::truth_array:
      return std::get<TruthArray>(value).columns;
    case Type::text_array:
      return std::get<TextArray>(value).columns;
    case Type::number:
    case Type::truth:
    case Type::text:
      break;
  }
  return 0;
}
bool is_array(const Value& value) { return type_of(value) >= Type::number_array; }
Value item(const Value& value, std::size_t i) {
  switch (type_of(value)) {
    case Type::number_array:
      return std::get<NumberArray>(value).items[i];
    case Type::truth_array:
      return std::get<TruthArray>(value).items[i] != 0;
    case Type::text_array:
      return std::get<TextArray>(value).items[i];
    case Type::number:
    case Type::truth:
    case Type::text:
      break;
  }
  return value;
}

ValueResult apply_each(Operator op, const Value& left, const Value& right) {
  const Operator plain = single(op);
  const bool left_many = is_array(left), right_many = is_array(right);
  if (!left_many && !right_many) return apply_binary(plain, left, right);
  if (left_many && right_many && (size_of(left) != size_of(right) || columns_of(left) != columns_of(right)))
    return failure(std::string(sign_of(op)) + " needs arrays with the same rows and columns");
  const Value& shape = left_many ? left : right;
  const std::size_t count = size_of(shape), columns = columns_of(shape);
  Type type = item_type(type_of(left));
  if (is_comparison(plain) || plain == Operator::logical_and || plain == Operator::logical_or)
    type = Type::truth;
  else if (item_type(type_of(right)) == Type::text)
    type = Type::text;
  Value out = default_value(array_type(type));
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < count; ++i) {
    auto one = apply_binary(plain, item(left, i), item(right, i));
    if (!one) return one;
    if (const auto* text = std::get_if<std::string>(&*one)) bytes += text->size();
    if (bytes > kMostTextBytes) return failure("the texts become too long");
    if (auto* numbers = std::get_if<NumberArray>(&out))
      numbers->items.push_back(std::get<double>(*one));
    else if (auto* truths = std::get_if<TruthArray>(&out))
      truths->items.push_back(std::get<bool>(*one));
    else
      std::get<TextArray>(out).items.push_back(std::move(std::get<std::string>(*one)));
  }
  std::visit(
      [&](auto& array) {
        if constexpr (requires { array.columns; }) array.columns = columns;
      },
      out);
  return out;
}

}  // namespace

ValueResult apply_unary(Operator op, const Value& value) {
  if (op == Operator::logical_not) {
    if (const auto* one = std::get_if<bool>(&value)) return Value(!*one);
    if (const auto* many = std::get_if<TruthArray>(&value)) {
      TruthArray out = *many;
      for (auto& item : out.items) item = !item;
      return Value(std::move(out));
    }
  } else {
    const double sign = op == Operator::negate ? -1 : 1;
    if (const auto* one = std::get_if<double>(&value)) return Value(sign * *one);
    if (const auto* many = std::get_if<NumberArray>(&value)) {
      NumberArray out = *many;
      for (double& item : out.items) item *= sign;
      return Value(std::move(out));
    }
  }
  return failure(std::string(sign_of(op)) + " does not go with a " + std::string(type_name(type_of(value))));
}

ValueResult apply_binary(Operator op, const Value& left, const Value& right) {
  const auto *a = std::get_if<double>(&left), *b = std::get_if<double>(&right);
  if (a != nullptr && b != nullptr) {
    if (is_arithmetic(op)) return Value(calculate(op, *a, *b));
    if (is_comparison(op)) return Value(compare(op, *a, *b));
  }
  if (op >= Operator::each_add) return apply_each(op, left, right);
  const Type type = type_of(left);
  if (op == Operator::add && (type == Type::text || type_of(right) == Type::text)) {
    std::string joined = value_text(left) + value_text(right);
    if (joined.size() > kMostTextBytes) return failure("the text becomes too long");
    return Value(std::move(joined));
  }
  if (type == type_of(right)) {
    if (type == Type::truth) {
      const bool x = std::get<bool>(left), y = std::get<bool>(right);
      if (op == Operator::equal || op == Operator::not_equal) return Value(compare(op, x, y));
      if (op == Operator::logical_and) return Value(x && y);
      if (op == Operator::logical_or) return Value(x || y);
    }
    if (type == Type::text && is_comparison(op))
      return Value(compare(op, std::get<std::string>(left), std::get<std::string>(right)));
    if (type == Type::number_array && is_comparison(op))
      return compare_arrays(op, std::get<NumberArray>(left), std::get<NumberArray>(right));
    if (type == Type::text_array && is_comparison(op))
      return compare_arrays(op, std::get<TextArray>(left), std::get<TextArray>(right));
    if (type == Type::truth_array && (op == Operator::equal || op == Operator::not_equal))
      return compare_arrays(op, std::get<TruthArray>(left), std::get<TruthArray>(right));
  }
  return wrong(sign_of(op), left, right);
}

}  // namespace blockrand::grammar
