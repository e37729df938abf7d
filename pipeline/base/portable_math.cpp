// Every series below is the function's Taylor series; the constants (parts of pi/2 and ln 2, arctangents of k/16) were
// computed with 260-bit integers from Machin-like series. Double-double steps: T. J. Dekker, A floating-point technique
// for extending the available precision, Numerische Mathematik 18 (1971).
#include "pipeline/base/portable_math.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace blockrand::base {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

constexpr double kHalfPiHigh = 0x1.921fb54442d18p+0, kHalfPiLow = 0x1.1a62633145c07p-54;
constexpr double kLn2High = 0x1.62e42fee00000p-1;  // 32 bits: exact when multiplied by any exponent
constexpr double kLn2Low = 0x1.a39ef35793c76p-33;

/// An unevaluated sum: about 106 bits.
struct Pair {
  double high = 0, low = 0;
};

// Requires |a| >= |b| or a == 0.
Pair quick_two_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}

Pair two_sum(double a, double b) {
  const double s = a + b;
  const double bb = s - a;
  return {s, (a - (s - bb)) + (b - bb)};
}

Pair two_product(double a, double b) {
  constexpr double kSplitter = 0x1p27 + 1;
  const double ca = kSplitter * a, cb = kSplitter * b;
  const double a1 = ca - (ca - a), b1 = cb - (cb - b);
  const double a2 = a - a1, b2 = b - b1;
  const double p = a * b;
  return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
}

Pair add(Pair a, Pair b) {
  const Pair s = two_sum(a.high, b.high);
  return quick_two_sum(s.high, s.low + (a.low + b.low));
}

Pair multiply(Pair a, Pair b) {
  const Pair p = two_product(a.high, b.high);
  return quick_two_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

/// Nearest integer for |x| < 2^51: adding 1.5 * 2^52 leaves no bits for a fraction.
double round_to_integer(double x) {
  constexpr double kShift = 0x1.8p52;
  return (x + kShift) - kShift;
}

/// 2^n for -1022 <= n <= 1023.
double power_of_two(int n) { return std::bit_cast<double>(static_cast<std::uint64_t>(n + 1023) << 52); }

/// x * 2^n for any n that exp and pow can meet; two steps, because 2^1024 and 2^-1074 are no normal numbers.
double scale(double x, int n) {
  const int half = n / 2;
  return x * power_of_two(half) * power_of_two(n - half);
}

/// x = 2^exponent * mantissa, mantissa in [sqrt(1/2), sqrt(2)). Requires x > 0 and finite.
struct Parts {
  double mantissa = 1;
  int exponent = 0;
};

Parts split_exponent(double x) {
  int exponent = 0;
  if (x < std::numeric_limits<double>::min()) {
    x *= 0x1p54;
    exponent = -54;
  }
  const auto bits = std::bit_cast<std::uint64_t>(x);
  exponent += static_cast<int>(bits >> 52) - 1023;
  double mantissa = std::bit_cast<double>((bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL);
  constexpr double kSqrt2 = 0x1.6a09e667f3bcdp+0;
  if (mantissa >= kSqrt2) {
    mantissa *= 0.5;
    ++exponent;
  }
  return {mantissa, exponent};
}

/// sin(x) for |x| <= pi/4 + a little, given as a pair. Next term: x^19/19! < 1e-19 x.
double sine_series(double x, double low) {
  const double z = x * x;
  const double s =
      -1.0 / 6 +
      z * (1.0 / 120 +
           z * (-1.0 / 5040 + z * (1.0 / 362880 + z * (-1.0 / 39916800 + z * (1.0 / 6227020800.0 +
                                                                              z * (-1.0 / 1307674368000.0 +
                                                                                   z * (1.0 / 355687428096000.0)))))));
  return x + (x * z * s + low * (1.0 - 0.5 * z));
}

/// cos(x) on the same range. 1 - z/2 is rounded; what rounding lost is added back.
double cosine_series(double x, double low) {
  const double z = x * x;
  const double c =
      1.0 / 24 +
      z * (-1.0 / 720 +
           z * (1.0 / 40320 +
                z * (-1.0 / 3628800 +
                     z * (1.0 / 479001600.0 + z * (-1.0 / 87178291200.0 +
                                                   z * (1.0 / 20922789888000.0 + z * (-1.0 / 6402373705728000.0)))))));
  const double half = 0.5 * z;
  const double w = 1.0 - half;
  return w + (((1.0 - w) - half) + (z * z * c - x * low));
}

/// atan(k/16) as pairs.
constexpr Pair kAtan[17] = {
    {0x0.0p+0, 0x0.0p+0},
    {0x1.ff55bb72cfdeap-5, -0x1.c934d86d23f1dp-60},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
    {0x1.7b97b4bce5b02p-3, 0x1.347b0b4f881cap-58},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.362773707ebccp-2, -0x1.963a544b672d8p-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
    {0x1.a64eec3cc23fdp-2, -0x1.24dec1b50b7ffp-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.0657e94db30d0p-1, -0x1.d5b495f6349e6p-56},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.345f01cce37bbp-1, 0x1.1021137c71102p-55},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.5d58987169b18p-1, 0x1.0028e4bc5e7cap-57},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.819d0b7158a4dp-1, -0x1.bf76229d3b917p-56},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
};

/// atan(y / x) for 0 <= y <= x, x > 0, both far from overflow.
Pair atan_ratio(double y, double x) {
  const double q = y / x;
  if (q < 0x1p-30) return {q, 0};  // q - q^3/3 rounds to q
  const Pair product = two_product(q, x);
  const double q_low = ((y - product.high) - product.low) / x;
  // Below 3/32 the series needs no help; from there on the argument is at most a third of the result, so that the
  // rounding of t costs half an ulp and no more.
  int k = 0;
  double t = q, t_low = q_low;
  if (q >= 3.0 / 32) {
    k = static_cast<int>(q * 16 + 0.5);
    const double c = k * 0.0625;
    t = (q - c) / (1.0 + q * c);
    t_low = q_low / (1.0 + q * q);
  }
  const double z = t * t;
  const double s =
      -1.0 / 3 +
      z * (1.0 / 5 + z * (-1.0 / 7 + z * (1.0 / 9 + z * (-1.0 / 11 +
                                                         z * (1.0 / 13 + z * (-1.0 / 15 + z * (1.0 / 17 - z / 19)))))));
  const double correction = t_low + t * z * s;
  if (k == 0) return quick_two_sum(t, correction);
  const Pair sum = two_sum(kAtan[k].high, t);
  return quick_two_sum(sum.high, sum.low + (kAtan[k].low + correction));
}

/// exp(high + low) for |high| < 746.
double exp_pair(double high, double low) {
  const double n = round_to_integer(high * 0x1.71547652b82fep+0);
  const Pair r = two_sum(high - n * kLn2High, low - n * kLn2Low);
  const double x = r.high;
  // 1/2 + x/6 + ... + x^12/14!; the next term is below 1e-18.
  const double p =
      1.0 / 2 +
      x * (1.0 / 6 +
           x * (1.0 / 24 +
                x * (1.0 / 120 +
                     x * (1.0 / 720 +
                          x * (1.0 / 5040 +
                               x * (1.0 / 40320 + x * (1.0 / 362880 +
                                                       x * (1.0 / 3628800 + x * (1.0 / 39916800 +
                                                                                 x * (1.0 / 479001600.0 +
                                                                                      x * (1.0 / 6227020800.0 +
                                                                                           x / 87178291200.0)))))))))));
  const double value = 1.0 + (x + (x * x * p + r.low * (1.0 + x)));
  return scale(value, static_cast<int>(n));
}

/// e^a / 2 for a >= 40, which may be finite where e^a is not.
double half_exp(double a) {
  if (a != a) return a;
  if (a > 710.5) return kInfinity;
  const Pair x = two_sum(a, -kLn2High);
  return exp_pair(x.high, x.low - kLn2Low);
}

/// f - log(1 + f) for 1 + f in [sqrt(1/2), sqrt(2)].
///
/// With s = f / (2 + f): log(1 + f) = 2 artanh(s) = 2s + s R, R = 2 (s^2/3 + s^4/5 + ...), and 2s = f - s f.
double log_deficit(double f) {
  const double s = f / (2.0 + f);
  const double z = s * s;
  const double r =
      2.0 * z *
      (1.0 / 3 +
       z * (1.0 / 5 +
            z * (1.0 / 7 +
                 z * (1.0 / 9 +
                      z * (1.0 / 11 + z * (1.0 / 13 + z * (1.0 / 15 + z * (1.0 / 17 + z * (1.0 / 19 + z / 21)))))))));
  return s * (f - r);
}

/// log(x) with about 65 right bits. Requires x > 0 and finite.
Pair log_pair(double x) {
  const Parts parts = split_exponent(x);
  const double f = parts.mantissa - 1.0;  // exact (Sterbenz)
  const double d = 2.0 + f;
  const double d_low = f - (d - 2.0);
  const double s_high = f / d;
  const Pair back = two_product(s_high, d);
  const Pair s = quick_two_sum(s_high, (((f - back.high) - back.low) - s_high * d_low) / d);
  const Pair z = multiply(s, s);
  // Terms from s^6/7 on are below 2^-15 of the sum: plain doubles will do.
  const double u = z.high;
  const double tail =
      1.0 / 7 +
      u * (1.0 / 9 +
           u * (1.0 / 11 +
                u * (1.0 / 13 +
                     u * (1.0 / 15 + u * (1.0 / 17 + u * (1.0 / 19 + u * (1.0 / 21 + u * (1.0 / 23 + u / 25))))))));
  constexpr Pair kThird{0x1.5555555555555p-2, 0x1.5555555555555p-56};
  constexpr Pair kFifth{0x1.999999999999ap-3, -0x1.999999999999ap-57};
  const Pair inner = add(kFifth, multiply(z, {tail, 0}));
  const Pair outer = add(kThird, multiply(z, inner));
  Pair sum = add(s, multiply(multiply(s, z), outer));
  sum = {2 * sum.high, 2 * sum.low};
  const double k = parts.exponent;
  return add(two_sum(k * kLn2High, k * kLn2Low), sum);
}

}  // namespace

SinCos sin_cos(double x) {
  if (!std::isfinite(x)) return {kNaN, kNaN};
  constexpr double kReducible = 1.6e6;  // the quotient has at most 20 bits, so that its products below are exact
  if (std::fabs(x) > kReducible) x = std::fmod(x, 2 * kPi);
  if (std::fabs(x) <= kPi / 4) return {x == 0 ? x : sine_series(x, 0), cosine_series(x, 0)};
  constexpr double kPart1 = 0x1.921fb54400000p+0, kPart2 = 0x1.0b4611a600000p-34;  // pi/2 in pieces of 33 bits
  constexpr double kPart3 = 0x1.3198a2e000000p-69, kPart4 = 0x1.b839a252049c1p-104;
  const double n = round_to_integer(x * 0x1.45f306dc9c883p-1);
  const Pair a = two_sum(x - n * kPart1, -n * kPart2);
  const Pair b = two_sum(a.high, -n * kPart3);
  const Pair r = quick_two_sum(b.high, a.low + b.low - n * kPart4);
  const double s = sine_series(r.high, r.low), c = cosine_series(r.high, r.low);
  switch (static_cast<long long>(n) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

double sin(double x) { return sin_cos(x).sin; }
double cos(double x) { return sin_cos(x).cos; }

double tan(double x) {
  const SinCos sc = sin_cos(x);
  return sc.sin / sc.cos;
}

double atan2(double y, double x) {
  if (x != x || y != y) return kNaN;
  double ax = std::fabs(x), ay = std::fabs(y);
  const bool x_negative = std::signbit(x);
  Pair angle;  // of (|x|, |y|)
  if (ay == 0) {
    angle = {0, 0};
  } else if (ax == kInfinity && ay == kInfinity) {
    angle = kAtan[16];
  } else if (ax == kInfinity) {
    angle = {0, 0};
  } else if (ay == kInfinity || ax == 0) {
    angle = {kHalfPiHigh, kHalfPiLow};
  } else {
    const double larger = ax > ay ? ax : ay;
    if (larger > 0x1p900) {  // room for the splitting in two_product
      ax *= 0x1p-200;
      ay *= 0x1p-200;
    } else if (larger < 0x1p-700) {
      ax *= 0x1p300;
      ay *= 0x1p300;
    }
    if (ay <= ax) {
      angle = atan_ratio(ay, ax);
    } else {
      const Pair co = atan_ratio(ax, ay);
      angle = add({kHalfPiHigh, kHalfPiLow}, {-co.high, -co.low});
    }
  }
  if (x_negative) angle = add({2 * kHalfPiHigh, 2 * kHalfPiLow}, {-angle.high, -angle.low});
  return std::copysign(angle.high + angle.low, y);
}

double atan(double x) { return atan2(x, 1.0); }
double asin(double x) { return std::fabs(x) > 1 ? kNaN : atan2(x, std::sqrt((1.0 - x) * (1.0 + x))); }
double acos(double x) { return std::fabs(x) > 1 ? kNaN : atan2(std::sqrt((1.0 - x) * (1.0 + x)), x); }

double exp(double x) {
  if (x != x) return x;
  if (x > 709.8) return kInfinity;
  if (x < -745.2) return 0;
  return exp_pair(x, 0);
}

double log(double x) {
  if (x != x || x < 0) return kNaN;
  if (x == 0) return -kInfinity;
  if (x == kInfinity) return x;
  const Parts parts = split_exponent(x);
  const double f = parts.mantissa - 1.0;
  const double k = parts.exponent;
  return k * kLn2High + (f - (log_deficit(f) - k * kLn2Low));
}

double log1p(double x) {
  if (x != x || x < -1) return kNaN;
  if (x > -0.29 && x < 0.41) return x == 0 ? x : x - log_deficit(x);
  const double w = 1.0 + x;
  if (w == 0 || w == kInfinity) return log(w);
  const double lost = x > 1 ? 1.0 - (w - x) : x - (w - 1.0);
  return log(w) + lost / w;
}

double sinh(double x) {
  const double a = std::fabs(x);
  if (!(a > 1.0)) {  // also NaN. Next term: 1/21! < 2e-20.
    const double z = x * x;
    const double s =
        1.0 / 6 +
        z * (1.0 / 120 +
             z * (1.0 / 5040 + z * (1.0 / 362880 + z * (1.0 / 39916800 + z * (1.0 / 6227020800.0 +
                                                                              z * (1.0 / 1307674368000.0 +
                                                                                   z * (1.0 / 355687428096000.0 +
                                                                                        z / 121645100408832000.0)))))));
    return x + x * z * s;
  }
  if (a < 40) {
    const double e = exp(a);
    return std::copysign(0.5 * (e - 1.0 / e), x);
  }
  return std::copysign(half_exp(a), x);
}

double asinh(double x) {
  const double a = std::fabs(x);
  if (!(a > 0) || a == kInfinity) return x;
  constexpr double kLn2 = 0x1.62e42fefa39efp-1;
  const double z = a * a;
  const double value = a > 0x1p28 ? log(a) + kLn2 : log1p(a + z / (1.0 + std::sqrt(1.0 + z)));
  return std::copysign(value, x);
}

double atanh(double x) {
  const double a = std::fabs(x);
  if (a != a || a > 1) return kNaN;
  if (a == 1) return std::copysign(kInfinity, x);
  if (a > 0.17) return std::copysign(0.5 * log1p(2.0 * a / (1.0 - a)), x);
  const double z = x * x;
  const double s =
      1.0 / 3 +
      z * (1.0 / 5 +
           z * (1.0 / 7 +
                z * (1.0 / 9 +
                     z * (1.0 / 11 + z * (1.0 / 13 + z * (1.0 / 15 + z * (1.0 / 17 + z * (1.0 / 19 + z / 21))))))));
  return x + x * z * s;
}

double pow(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (x != x || y != y) return kNaN;
  const double ax = std::fabs(x), ay = std::fabs(y);
  const bool y_integer = ay >= 0x1p52 || round_to_integer(ay) == ay;
  const bool y_odd = y_integer && ay < 0x1p53 && (static_cast<std::uint64_t>(ay) & 1) == 1;
  const double sign = std::signbit(x) && y_odd ? -1.0 : 1.0;
  if (ax == 0) return y > 0 ? sign * 0.0 : sign * kInfinity;
  if (ax == 1 && ay == kInfinity) return 1;
  if (ax == kInfinity) return y > 0 ? sign * kInfinity : sign * 0.0;
  if (x < 0 && ay != kInfinity && !y_integer) return kNaN;
  if (ax == 1) return sign;
  if (ay > 0x1p80) return (ax > 1) == (y > 0) ? sign * kInfinity : sign * 0.0;
  if (ay < 0x1p-80) return sign;
  const Pair product = multiply(log_pair(ax), {y, 0});
  if (product.high > 709.8) return sign * kInfinity;
  if (product.high < -745.2) return sign * 0.0;
  return sign * exp_pair(product.high, product.low);
}

}  // namespace blockrand::base
