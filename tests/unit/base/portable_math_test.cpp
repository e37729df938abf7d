// Our elementary functions against the 64-bit mantissa of long double, and their special values.
#include "pipeline/base/portable_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

#include "pipeline/base/random.h"

namespace {

namespace base = blockrand::base;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kMaxUlp = 2.0;     // what the header promises
constexpr double kMaxUlpTan = 2.5;  // a quotient of two rounded numbers
constexpr int kSamples = 200000;

/// Error in units of the last place of the result.
double ulp_error(double value, long double exact) {
  const double nearest = static_cast<double>(exact);
  if (nearest == value) return std::fabs(static_cast<double>(exact - value)) > 0 ? 0.5 : 0.0;
  const double ulp = std::nextafter(std::fabs(nearest), kInfinity) - std::fabs(nearest);
  return static_cast<double>(std::fabs(exact - static_cast<long double>(value)) / ulp);
}

/// Largest error over random and evenly spread arguments of [low, high].
double worst(double low, double high, const std::function<double(double)>& f,
             const std::function<long double(long double)>& exact) {
  double largest = 0, at = low;
  for (int i = 0; i < kSamples; ++i) {
    const double even = low + (high - low) * (i / static_cast<double>(kSamples));
    const double random = low + (high - low) * base::random_unit(7, static_cast<std::uint64_t>(i), "argument");
    for (const double x : {even, random}) {
      const double error = ulp_error(f(x), exact(x));
      if (!(error <= largest)) largest = error, at = x;
    }
  }
  ::testing::Test::RecordProperty("worst_at", std::to_string(at));
  return largest;
}

using LongDouble = long double (*)(long double);

struct Range {
  const char* name;
  double (*function)(double);
  LongDouble exact;
  double low, high;
};

class UlpBound : public ::testing::TestWithParam<Range> {};

TEST_P(UlpBound, StaysWithinTwoUlp) {
  const Range& range = GetParam();
  const double error = worst(range.low, range.high, range.function, range.exact);
  RecordProperty("ulp", std::to_string(error));
  EXPECT_LE(error, range.function == base::tan ? kMaxUlpTan : kMaxUlp) << range.name;
}

INSTANTIATE_TEST_SUITE_P(
    Ranges, UlpBound,
    ::testing::Values(Range{"sin", base::sin, sinl, -7, 7}, Range{"sin_small", base::sin, sinl, -0.01, 0.01},
                      Range{"sin_large", base::sin, sinl, -1.5e6, 1.5e6}, Range{"cos", base::cos, cosl, -7, 7},
                      Range{"cos_large", base::cos, cosl, -1.5e6, 1.5e6}, Range{"tan", base::tan, tanl, -7, 7},
                      Range{"asin", base::asin, asinl, -1, 1}, Range{"asin_small", base::asin, asinl, -0.01, 0.01},
                      Range{"acos", base::acos, acosl, -0.999, 0.999}, Range{"atan", base::atan, atanl, -3, 3},
                      Range{"atan_small", base::atan, atanl, -0.1, 0.1},
                      Range{"atan_large", base::atan, atanl, -1e6, 1e6}, Range{"exp", base::exp, expl, -5, 5},
                      Range{"exp_wide", base::exp, expl, -700, 709}, Range{"log", base::log, logl, 1e-6, 3},
                      Range{"log_near_one", base::log, logl, 0.999, 1.001},
                      Range{"log_wide", base::log, logl, 1, 1e300}, Range{"log1p", base::log1p, log1pl, -0.99, 4},
                      Range{"log1p_small", base::log1p, log1pl, -1e-3, 1e-3}, Range{"sinh", base::sinh, sinhl, -3, 3},
                      Range{"sinh_wide", base::sinh, sinhl, -700, 700}, Range{"asinh", base::asinh, asinhl, -2, 2},
                      Range{"asinh_wide", base::asinh, asinhl, -1e12, 1e12},
                      Range{"atanh", base::atanh, atanhl, -0.999, 0.999},
                      Range{"atanh_small", base::atanh, atanhl, -0.1, 0.1}),
    [](const auto& info) { return info.param.name; });

TEST(PortableMath, Atan2StaysWithinTwoUlpInEveryQuadrant) {
  double largest = 0;
  for (int i = 0; i < kSamples; ++i) {
    const auto key = static_cast<std::uint64_t>(i);
    const double y = base::random_unit(1, key, "y") * 2 - 1;
    const double x = (base::random_unit(1, key, "x") * 2 - 1) * (i % 3 == 0 ? 1e-3 : 1.0);
    largest = std::max(largest, ulp_error(base::atan2(y, x), atan2l(y, x)));
  }
  EXPECT_LE(largest, kMaxUlp);
}

TEST(PortableMath, PowStaysWithinTwoUlp) {
  double largest = 0;
  for (int i = 0; i < kSamples; ++i) {
    const auto key = static_cast<std::uint64_t>(i);
    const double x = base::random_unit(2, key, "x") * (i % 2 == 0 ? 1.0 : 1000.0);
    const double y = (base::random_unit(2, key, "y") - 0.5) * (i % 3 == 0 ? 90 : 5);
    if (x > 0) largest = std::max(largest, ulp_error(base::pow(x, y), powl(x, y)));
  }
  EXPECT_LE(largest, kMaxUlp);
  EXPECT_EQ(base::pow(2, 10), 1024);
  EXPECT_EQ(base::pow(2, -1074), 0x1p-1074);
  EXPECT_EQ(base::pow(-3, 3), -27);
  EXPECT_EQ(base::pow(10, 22), 1e22);
}

TEST(PortableMath, SpecialValuesFollowTheStandard) {
  EXPECT_EQ(base::sin(0), 0);
  EXPECT_TRUE(std::signbit(base::sin(-0.0)));
  EXPECT_EQ(base::cos(0), 1);
  EXPECT_TRUE(std::isnan(base::sin(kInfinity)));
  EXPECT_TRUE(std::isnan(base::cos(kNaN)));
  EXPECT_NEAR(base::sin(1e22), -0.8522008497671888, 2.0);  // defined, if not accurate
  EXPECT_TRUE(std::isnan(base::asin(1.0000001)));
  EXPECT_EQ(base::asin(1), M_PI / 2);
  EXPECT_EQ(base::acos(-1), M_PI);
  EXPECT_EQ(base::exp(0), 1);
  EXPECT_EQ(base::exp(-kInfinity), 0);
  EXPECT_EQ(base::exp(710), kInfinity);
  EXPECT_EQ(base::exp(-750), 0);
  EXPECT_EQ(base::log(1), 0);
  EXPECT_EQ(base::log(0), -kInfinity);
  EXPECT_TRUE(std::isnan(base::log(-1)));
  EXPECT_EQ(base::log(kInfinity), kInfinity);
  EXPECT_NEAR(base::log(0x1p-1074), -744.4400719213812, 1e-12);
  EXPECT_EQ(base::log1p(-1), -kInfinity);
  EXPECT_EQ(base::sinh(kInfinity), kInfinity);
  EXPECT_EQ(base::sinh(711), kInfinity);
  EXPECT_NEAR(base::sinh(710) / 1.1169973830808557e308, 1, 1e-15);
  EXPECT_EQ(base::sinh(-kInfinity), -kInfinity);
  EXPECT_TRUE(std::isnan(base::sinh(kNaN)));
  EXPECT_EQ(base::asinh(-kInfinity), -kInfinity);
  EXPECT_TRUE(std::isnan(base::asinh(kNaN)));
  EXPECT_EQ(base::atanh(1), kInfinity);
  EXPECT_TRUE(std::isnan(base::atanh(2)));
}

TEST(PortableMath, Atan2AndPowAgreeWithLibmOnSpecialValues) {
  const double values[] = {0.0,  -0.0,  1,      -1,     2,       -2,        3,          -3,  0.5,
                           -0.5, 1e300, -1e300, 1e-310, -1e-310, kInfinity, -kInfinity, kNaN};
  const auto same = [](double a, double b) {
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
    return std::signbit(a) == std::signbit(b) && (a == b || std::fabs(a - b) <= 4e-16 * std::fabs(b));
  };
  for (const double a : values) {
    for (const double b : values) {
      EXPECT_TRUE(same(base::atan2(a, b), std::atan2(a, b))) << a << ' ' << b << ' ' << base::atan2(a, b);
      EXPECT_TRUE(same(base::pow(a, b), std::pow(a, b))) << a << ' ' << b << ' ' << base::pow(a, b);
    }
  }
}

// A sum over the bits of many results. Every x86-64 must find this number; a change of it changes every output file.
TEST(PortableMath, BitsAreTheOnesOnRecord) {
  std::uint64_t sum = 0;
  const auto eat = [&sum](double value) {
    std::uint64_t bits = 0;
    static_assert(sizeof bits == sizeof value);
    __builtin_memcpy(&bits, &value, sizeof bits);
    sum = base::mix64(sum ^ bits);
  };
  for (int i = 1; i <= 20000; ++i) {
    const double x = i * 3.7e-4;
    for (const auto f :
         {base::sin, base::cos, base::tan, base::atan, base::exp, base::log, base::log1p, base::sinh, base::asinh}) {
      eat(f(x));
    }
    eat(base::asin(x / 8));
    eat(base::atanh(x / 8));
    eat(base::pow(x, 2.4));
    eat(base::atan2(x, 1 - x));
  }
  EXPECT_EQ(sum, 18095757971825899665u);
}

}  // namespace
