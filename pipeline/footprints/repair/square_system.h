// Least squares over corners that lie on walls of given direction. Internal to squaring.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::repair {

/// weight * (sum of factor[k] * unknown[index[k]] - value)^2.
struct Equation {
  std::uint32_t size = 0;
  std::uint32_t index[6] = {};
  double factor[6] = {};
  double value = 0;
  double weight = 1;
  /// Adds a term; terms of one unknown are summed.
  void add(std::uint32_t unknown, double f);
};

/// Minimises the sum of the equations. Unknowns that no equation ties together are solved apart: one alone in closed
/// form, few by a dense, many by a sparse LDL^T factorisation (Eigen, AMD ordering). `group[i]` is the least unknown
/// that i is tied to, directly or not. An unknown in no equation is 0.
struct Solution {
  std::vector<double> unknown;
  std::vector<std::uint32_t> group;
};
Solution solve_least_squares(const std::vector<Equation>& equations, std::uint32_t unknowns);

}  // namespace blockrand::repair
