#include "pipeline/georef/transverse_mercator.h"

#include <cmath>

#include "pipeline/base/portable_math.h"

namespace blockrand::georef {
namespace {

double wrap(double degrees) {
  while (degrees > 180) degrees -= 360;
  while (degrees < -180) degrees += 360;
  return degrees;
}

/// Coefficients of Karney 2011, eqs. 35 (to_rectifying) and 36.
std::array<double, 6> alpha_of(double n) {
  const double n2 = n * n, n3 = n2 * n, n4 = n2 * n2, n5 = n4 * n, n6 = n3 * n3;
  return {n / 2 - 2 * n2 / 3 + 5 * n3 / 16 + 41 * n4 / 180 - 127 * n5 / 288 + 7891 * n6 / 37800,
          13 * n2 / 48 - 3 * n3 / 5 + 557 * n4 / 1440 + 281 * n5 / 630 - 1983433 * n6 / 1935360,
          61 * n3 / 240 - 103 * n4 / 140 + 15061 * n5 / 26880 + 167603 * n6 / 181440,
          49561 * n4 / 161280 - 179 * n5 / 168 + 6601661 * n6 / 7257600,
          34729 * n5 / 80640 - 3418889 * n6 / 1995840,
          212378941 * n6 / 319334400};
}

std::array<double, 6> beta_of(double n) {
  const double n2 = n * n, n3 = n2 * n, n4 = n2 * n2, n5 = n4 * n, n6 = n3 * n3;
  return {n / 2 - 2 * n2 / 3 + 37 * n3 / 96 - n4 / 360 - 81 * n5 / 512 + 96199 * n6 / 604800,
          n2 / 48 + n3 / 15 - 437 * n4 / 1440 + 46 * n5 / 105 - 1118711 * n6 / 3870720,
          17 * n3 / 480 - 37 * n4 / 840 - 209 * n5 / 4480 + 5569 * n6 / 90720,
          4397 * n4 / 161280 - 11 * n5 / 504 - 830251 * n6 / 7257600,
          4583 * n5 / 161280 - 108847 * n6 / 3991680,
          20648693 * n6 / 638668800};
}

/// sin(2 j z) and cos(2 j z) of z = xi + i eta, advanced by the addition theorem.
struct Complex {
  double re = 0, im = 0;
};

Complex operator*(Complex a, Complex b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }

/// Sums over j of c_j sin(2 j z) and 2 j c_j cos(2 j z), given the sines and cosines of xi and eta themselves.
struct Series {
  Complex sine;    // re: added to xi, im: added to eta
  Complex cosine;  // the derivative without its leading 1
};

Series sum_series(const std::array<double, 6>& c, double sin_xi, double cos_xi, double sinh_eta, double cosh_eta) {
  const double s = 2 * sin_xi * cos_xi, co = (cos_xi - sin_xi) * (cos_xi + sin_xi);
  const double sh = 2 * sinh_eta * cosh_eta, ch = 1 + 2 * sinh_eta * sinh_eta;
  const Complex sin1{s * ch, co * sh}, cos1{co * ch, -s * sh};
  const Complex twice{2 * cos1.re, 2 * cos1.im};
  // sin((j+1) w) = 2 cos(w) sin(j w) - sin((j-1) w) with w = 2 z, and the same for cos. All |c_j| fall like n^j.
  Complex sin_before{0, 0}, sin_now = sin1, cos_before{1, 0}, cos_now = cos1;
  Series sum;
  for (int j = 1; j <= 6; ++j) {
    const double coefficient = c[static_cast<std::size_t>(j - 1)];
    sum.sine.re += coefficient * sin_now.re;
    sum.sine.im += coefficient * sin_now.im;
    sum.cosine.re += 2 * j * coefficient * cos_now.re;
    sum.cosine.im += 2 * j * coefficient * cos_now.im;
    const Complex sin_product = twice * sin_now, cos_product = twice * cos_now;
    const Complex sin_next{sin_product.re - sin_before.re, sin_product.im - sin_before.im};
    const Complex cos_next{cos_product.re - cos_before.re, cos_product.im - cos_before.im};
    sin_before = sin_now, sin_now = sin_next;
    cos_before = cos_now, cos_now = cos_next;
  }
  return sum;
}

}  // namespace

struct TransverseMercator::Intermediate {
  double xi = 0, eta = 0;     // rectified, radians
  Complex derivative;         // 1 + sum 2 j alpha_j cos(2 j z')
  double sin_lat = 0;         // of the geodetic latitude
  double conformal_root = 0;  // cos(latitude) sqrt(tau'^2 + cos^2(lambda))
};

TransverseMercator::TransverseMercator(const Parameters& parameters) : parameters_(parameters) {
  const double f = 1 / parameters.inverse_flattening;
  e2_ = f * (2 - f);
  e_ = std::sqrt(e2_);
  const double n = f / (2 - f);
  alpha_ = alpha_of(n);
  beta_ = beta_of(n);
  const double n2 = n * n;
  rectifying_ = parameters.scale / (1 + n) * (1 + n2 / 4 + n2 * n2 / 64 + n2 * n2 * n2 / 256);
  radius_ = rectifying_ * parameters.semi_major;
  northing_shift_ = parameters.false_northing;
  if (parameters.latitude_of_origin != 0) {
    northing_shift_ -= radius_ * series({parameters.central_meridian, parameters.latitude_of_origin}).xi;
  }
}

double TransverseMercator::conformal_sigma(double sin_latitude) const {
  return base::sinh(e_ * base::atanh(e_ * sin_latitude));
}

TransverseMercator::Intermediate TransverseMercator::series(LonLat p) const {
  const double lambda = wrap(p.lon - parameters_.central_meridian) * base::kRadiansPerDegree;
  const base::SinCos lat = base::sin_cos(p.lat * base::kRadiansPerDegree);
  const base::SinCos lon = base::sin_cos(lambda);
  // Eqs. 7-12, every term times cos(latitude), so that the poles need no infinite tangent.
  const double sigma = conformal_sigma(lat.sin);
  const double tau = lat.sin * std::sqrt(1 + sigma * sigma) - sigma;  // tau' cos(latitude)
  const double across = lat.cos * lon.cos;
  const double root = std::sqrt(tau * tau + across * across);
  Intermediate result;
  result.sin_lat = lat.sin;
  result.conformal_root = root;
  const double sinh_eta = lat.cos * lon.sin / root;
  const double cosh_eta = std::sqrt(1 + sinh_eta * sinh_eta);
  const Series sum = sum_series(alpha_, tau / root, across / root, sinh_eta, cosh_eta);
  result.xi = base::atan2(tau, across) + sum.sine.re;
  result.eta = base::asinh(sinh_eta) + sum.sine.im;
  result.derivative = {1 + sum.cosine.re, sum.cosine.im};
  return result;
}

model::Point2 TransverseMercator::forward(LonLat p) const {
  const Intermediate z = series(p);
  return {parameters_.false_easting + radius_ * z.eta, northing_shift_ + radius_ * z.xi};
}

LonLat TransverseMercator::inverse(model::Point2 p) const {
  const double xi = (p.y - northing_shift_) / radius_, eta = (p.x - parameters_.false_easting) / radius_;
  const double sinh_eta = base::sinh(eta);
  const base::SinCos sc = base::sin_cos(xi);
  const Series sum = sum_series(beta_, sc.sin, sc.cos, sinh_eta, std::sqrt(1 + sinh_eta * sinh_eta));
  const base::SinCos conformal = base::sin_cos(xi - sum.sine.re);
  const double across = base::sinh(eta - sum.sine.im);
  const double root = std::sqrt(across * across + conformal.cos * conformal.cos);
  const double lambda = base::atan2(across, conformal.cos);
  double latitude = 0;
  if (root == 0) {
    latitude = conformal.sin > 0 ? 90 : -90;
  } else {
    // Newton on tau'(tau) (eqs. 19-21): two steps reach the last bit, the third costs little and covers the poles.
    const double wanted = conformal.sin / root;
    double tau = wanted / (1 - e2_);
    if (std::fabs(wanted) > 70) tau = wanted * base::exp(e_ * base::atanh(e_));
    for (int step = 0; step < 3; ++step) {
      const double secant = std::sqrt(1 + tau * tau);
      const double sigma = conformal_sigma(tau / secant);
      const double now = tau * std::sqrt(1 + sigma * sigma) - sigma * secant;
      tau += (wanted - now) / std::sqrt(1 + now * now) * (1 + (1 - e2_) * tau * tau) / ((1 - e2_) * secant);
    }
    latitude = base::atan(tau) * base::kDegreesPerRadian;
  }
  return {wrap(lambda * base::kDegreesPerRadian + parameters_.central_meridian), latitude};
}

double TransverseMercator::scale(LonLat p) const {
  const Intermediate z = series(p);
  const double stretch =
      std::sqrt(z.derivative.re * z.derivative.re + z.derivative.im * z.derivative.im);  // |d zeta / d zeta'|
  return rectifying_ * stretch * std::sqrt(1 - e2_ * z.sin_lat * z.sin_lat) / z.conformal_root;
}

}  // namespace blockrand::georef
