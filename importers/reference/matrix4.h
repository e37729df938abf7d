// 4 x 4 matrices as glTF and 3D Tiles write them. Internal to this folder.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "importers/reference/json_access.h"
#include "pipeline/model/point.h"

namespace blockrand::importers::reference {

/// Column by column.
using Matrix4 = std::array<double, 16>;

inline constexpr Matrix4 kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
/// glTF's y up to z up: (x, y, z) becomes (x, -z, y).
inline constexpr Matrix4 kYUpToZUp{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};
/// The same for x up, which 3D Tiles 1.0 knew.
inline constexpr Matrix4 kXUpToZUp{0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1};

/// First `b`, then `a`.
inline Matrix4 operator*(const Matrix4& a, const Matrix4& b) {
  Matrix4 out{};
  for (std::size_t column = 0; column < 4; ++column)
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t k = 0; k < 4; ++k) out[4 * column + row] += a[4 * k + row] * b[4 * column + k];
  return out;
}

inline model::Point3 apply(const Matrix4& m, const model::Point3& p) {
  const auto row = [&](std::size_t r) { return m[r] * p.x + m[4 + r] * p.y + m[8 + r] * p.z + m[12 + r]; };
  return {row(0), row(1), row(2)};
}

/// Whether it turns left into right. \param m  column by column or row by row
inline bool mirrors(std::span<const double, 16> m) {
  return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) +
             m[8] * (m[1] * m[6] - m[2] * m[5]) <
         0;
}

/// Scale, then rotation (a quaternion x, y, z, w of any length but 0), then translation.
Matrix4 from_parts(const std::array<double, 3>& translation, const std::array<double, 4>& rotation,
                   const std::array<double, 3>& scale);

/// How far the last row may be from 0 0 0 1: matrices that are multiplied in single precision, or written with few
/// digits. Beyond, it is no rounding.
inline constexpr double kMatrixRounding = 1e-5;

/// 16 numbers whose last row is 0 0 0 1 but for rounding, which is taken out; nothing where they are not.
inline std::optional<Matrix4> matrix_of(const Json& value) {
  Matrix4 out{};
  if (length(value) != out.size()) return std::nullopt;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto v = number(value[i]);
    if (!v) return std::nullopt;
    out[i] = *v;
  }
  for (const std::size_t i : {3, 7, 11})
    if (std::fabs(out[i]) > kMatrixRounding) return std::nullopt;
  if (std::fabs(out[15] - 1) > kMatrixRounding) return std::nullopt;
  // Not divided by: it is rounding, and places measured from the earth's centre would move by it.
  out[3] = out[7] = out[11] = 0;
  out[15] = 1;
  return out;
}

}  // namespace blockrand::importers::reference
