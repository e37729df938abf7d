// Functions of numbers: angles in degrees, rounding, random numbers (docs/rule_language.md §3.2).
#include <algorithm>
#include <array>
#include <limits>

#include "pipeline/base/portable_math.h"
#include "styles/grammar/evaluation/function_groups.h"

namespace blockrand::grammar {
namespace {

/// ln 10, correctly rounded.
constexpr double kNaturalLogOfTen = 0x1.26bb1bbb55516p+1;

/// Sine of an angle in degrees, exact at multiples of 30 degrees where it is rational.
double sine(double degrees) {
  double angle = std::fmod(degrees, 360.0);
  double sign = 1;
  if (angle < 0) {
    angle = -angle;
    sign = -sign;
  }
  if (angle >= 180) {
    angle -= 180;
    sign = -sign;
  }
  if (angle > 90) angle = 180 - angle;
  if (angle == 0) return 0;
  if (angle == 30) return sign * 0.5;
  if (angle == 90) return sign;
  // Near 90 degrees the cosine of what is left is the more exact one.
  return sign *
         (angle <= 45 ? base::sin(angle * base::kRadiansPerDegree) : base::cos((90 - angle) * base::kRadiansPerDegree));
}

double cosine(double degrees) {
  const double angle = std::abs(std::fmod(degrees, 360.0));
  return sine(90 - angle);
}

double log10(double value) {
  const double result = base::log(value) / kNaturalLogOfTen;
  const double nearest = std::nearbyint(result);
  return std::abs(result - nearest) < 1e-12 && base::pow(10, nearest) == value ? nearest : result;
}

/// The functions of one number, for numbers and element by element.
template <double (*f)(double)>
FunctionResult map_number(Arguments a, FunctionContext&) {
  return Value(f(number(a[0])));
}
template <double (*f)(double)>
FunctionResult map_array(Arguments a, FunctionContext&) {
  NumberArray out = std::get<NumberArray>(a[0]);
  for (double& item : out.items) item = f(item);
  return Value(std::move(out));
}
template <bool (*f)(double)>
FunctionResult test_number(Arguments a, FunctionContext&) {
  return Value(f(number(a[0])));
}
template <bool (*f)(double)>
FunctionResult test_array(Arguments a, FunctionContext&) {
  const auto& in = std::get<NumberArray>(a[0]);
  TruthArray out{{}, in.columns};
  for (const double item : in.items) out.items.push_back(f(item));
  return Value(std::move(out));
}

double absolute(double value) { return std::abs(value); }
double ceiling(double value) { return std::ceil(value); }
double floor_of(double value) { return std::floor(value); }
/// Ties go to the even neighbour (docs/rule_language.md §3.2, inferred).
double nearest(double value) { return std::nearbyint(value); }
double tangent(double degrees) { return sine(degrees) / cosine(degrees); }
double arc_tangent(double value) { return base::atan(value) * base::kDegreesPerRadian; }
bool is_nan(double value) { return std::isnan(value); }
bool is_infinite(double value) { return std::isinf(value); }

FunctionResult outside(const char* name, Arguments a, FunctionContext& context) {
  context.warn(std::string(name) + " of " + std::to_string(number(a[0])) + " is not defined; the result is nan");
  return Value(std::numeric_limits<double>::quiet_NaN());
}
FunctionResult arc_sine(Arguments a, FunctionContext& context) {
  if (std::abs(number(a[0])) > 1) return outside("asin", a, context);
  return Value(base::asin(number(a[0])) * base::kDegreesPerRadian);
}
FunctionResult arc_cosine(Arguments a, FunctionContext& context) {
  if (std::abs(number(a[0])) > 1) return outside("acos", a, context);
  return Value(base::acos(number(a[0])) * base::kDegreesPerRadian);
}
FunctionResult square_root(Arguments a, FunctionContext& context) {
  if (number(a[0]) < 0) return outside("sqrt", a, context);
  return Value(std::sqrt(number(a[0])));
}
FunctionResult angle_of(Arguments a, FunctionContext&) {
  return Value(base::atan2(number(a[0]), number(a[1])) * base::kDegreesPerRadian);
}
FunctionResult power(Arguments a, FunctionContext&) { return Value(base::pow(number(a[0]), number(a[1]))); }
FunctionResult least(Arguments a, FunctionContext&) { return Value(std::min(number(a[0]), number(a[1]))); }
FunctionResult greatest(Arguments a, FunctionContext&) { return Value(std::max(number(a[0]), number(a[1]))); }
/// The lower bound wins where the bounds are crossed.
FunctionResult clamped(Arguments a, FunctionContext&) {
  return Value(std::max(number(a[1]), std::min(number(a[0]), number(a[2]))));
}

FunctionResult random_unit(Arguments, FunctionContext& context) { return Value(context.draw()); }
FunctionResult random_below(Arguments a, FunctionContext& context) { return Value(context.draw() * number(a[0])); }
FunctionResult random_between(Arguments a, FunctionContext& context) {
  return Value(number(a[0]) + context.draw() * (number(a[1]) - number(a[0])));
}
/// Draws whatever the probability is, so that a changed one leaves the later draws alone.
FunctionResult chance(Arguments a, FunctionContext& context) { return Value(context.draw() < number(a[0])); }

}  // namespace

std::span<const FunctionEntry> maths_functions() {
  static constexpr FunctionEntry kTable[] = {
      {"abs", "n", map_number<absolute>},
      {"abs", "N", map_array<absolute>},
      {"acos", "n", arc_cosine},
      {"asin", "n", arc_sine},
      {"atan", "n", map_number<arc_tangent>},
      {"atan2", "nn", angle_of},
      {"ceil", "n", map_number<ceiling>},
      {"ceil", "N", map_array<ceiling>},
      {"clamp", "nnn", clamped},
      {"cos", "n", map_number<cosine>},
      {"exp", "n", map_number<base::exp>},
      {"floor", "n", map_number<floor_of>},
      {"floor", "N", map_array<floor_of>},
      {"isinf", "n", test_number<is_infinite>, true},
      {"isinf", "N", test_array<is_infinite>, true},
      {"isnan", "n", test_number<is_nan>, true},
      {"isnan", "N", test_array<is_nan>, true},
      {"ln", "n", map_number<base::log>},
      {"log10", "n", map_number<log10>},
      {"max", "nn", greatest},
      {"min", "nn", least},
      {"p", "n", chance},
      {"pow", "nn", power},
      {"rand", "", random_unit},
      {"rand", "n", random_below},
      {"rand", "nn", random_between},
      {"rint", "n", map_number<nearest>},
      {"rint", "N", map_array<nearest>},
      {"sin", "n", map_number<sine>},
      {"sqrt", "n", square_root},
      {"tan", "n", map_number<tangent>},
  };
  return kTable;
}

}  // namespace blockrand::grammar
