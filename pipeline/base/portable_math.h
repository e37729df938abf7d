// Elementary functions whose last bit is the same on every x86-64 (ARCHITECTURE.md, law 3).
//
// The C library picks its sin, exp, ... by the CPU (with and without fused multiply-add), so their last bits travel
// from machine to machine. These use + - * / and sqrt alone, which IEEE 754 rounds in one way, and steps that are
// exact. Measured against long double they stay within 2 units in the last place
// (tests/unit/base/portable_math_test.cpp).
#pragma once

namespace blockrand::base {

inline constexpr double kPi = 0x1.921fb54442d18p+1;
inline constexpr double kRadiansPerDegree = 0x1.1df46a2529d39p-6;  ///< pi / 180, correctly rounded
inline constexpr double kDegreesPerRadian = 0x1.ca5dc1a63c1f8p+5;  ///< 180 / pi, correctly rounded

struct SinCos {
  double sin = 0, cos = 1;
};

/// Sine and cosine of an angle in radians, for the price of one reduction.
///
/// Cody-Waite reduction by pi/2 in four parts, Taylor series on [-pi/4, pi/4]. At most 1 ulp for |x| <= 1.6e6 rad;
/// beyond, x is first taken modulo the double nearest 2 pi, so that the result is repeatable but not accurate.
/// NaN for infinities and NaN.
SinCos sin_cos(double x);

double sin(double x);  ///< as sin_cos
double cos(double x);  ///< as sin_cos
double tan(double x);  ///< sin / cos

double asin(double x);  ///< radians in [-pi/2, pi/2]; NaN for |x| > 1
double acos(double x);  ///< radians in [0, pi]; NaN for |x| > 1
double atan(double x);  ///< radians in [-pi/2, pi/2]

/// Angle of the vector (x, y) in radians, in [-pi, pi]; signs of zero and infinities as in C11 F.10.1.4.
///
/// atan(q) = atan(c) + atan((q - c) / (1 + q c)) with c the nearest multiple of 1/16, then Gregory's series.
double atan2(double y, double x);

/// e^x. exp(n ln 2 + r) = 2^n exp(r), Taylor series on |r| <= ln(2) / 2. Overflows to infinity, underflows to 0.
double exp(double x);

/// Natural logarithm. 2 artanh(f / (2 + f)) on [sqrt(1/2), sqrt(2)] (Mercator/Gregory series). -inf at 0, NaN below.
double log(double x);
double log1p(double x);  ///< log(1 + x), accurate near 0

double sinh(double x);
double asinh(double x);
double atanh(double x);  ///< infinite at -1 and 1, NaN beyond

/// x to the power y; special values as in C11 F.10.4.4. The logarithm is carried in two doubles (Dekker 1971).
double pow(double x, double y);

}  // namespace blockrand::base
