#include "pipeline/footprints/repair/square_system.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <numeric>
#include <span>

namespace blockrand::repair {

namespace {

constexpr std::size_t kDense = 32;  // unknowns up to which a dense factorisation is faster

/// LDL^T of the normal matrix, in place. Positive definite but for unknowns that nothing holds, which stay 0.
void solve_dense(std::span<const Equation> all, std::span<const std::uint32_t> equations,
                 std::span<const std::uint32_t> members, const std::vector<std::uint32_t>& place,
                 std::vector<double>& unknown) {
  const std::size_t n = members.size();
  double a[kDense][kDense] = {}, b[kDense] = {};
  for (const std::uint32_t e : equations) {
    const Equation& q = all[e];
    for (std::uint32_t i = 0; i < q.size; ++i) {
      const std::size_t r = place[q.index[i]];
      b[r] += q.weight * q.factor[i] * q.value;
      for (std::uint32_t j = 0; j < q.size; ++j) a[r][place[q.index[j]]] += q.weight * q.factor[i] * q.factor[j];
    }
  }
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k < j; ++k) a[j][j] -= a[j][k] * a[j][k] * a[k][k];
    if (a[j][j] < 1e-12) a[j][j] = 1e300;  // nothing holds it
    for (std::size_t i = j + 1; i < n; ++i) {
      for (std::size_t k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k] * a[k][k];
      a[i][j] /= a[j][j];
    }
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
  for (std::size_t i = 0; i < n; ++i) b[i] /= a[i][i];
  for (std::size_t i = n; i-- > 0;)
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= a[k][i] * b[k];
  for (std::size_t i = 0; i < n; ++i) unknown[members[i]] = b[i];
}

void solve_sparse(std::span<const Equation> all, std::span<const std::uint32_t> equations,
                  std::span<const std::uint32_t> members, const std::vector<std::uint32_t>& place,
                  std::vector<double>& unknown) {
  const auto n = static_cast<Eigen::Index>(members.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
  for (const std::uint32_t e : equations) {
    const Equation& q = all[e];
    for (std::uint32_t i = 0; i < q.size; ++i) {
      const std::uint32_t r = place[q.index[i]];
      b[r] += q.weight * q.factor[i] * q.value;
      for (std::uint32_t j = 0; j < q.size; ++j) {
        const std::uint32_t c = place[q.index[j]];
        if (c <= r)
          entries.emplace_back(static_cast<int>(r), static_cast<int>(c), q.weight * q.factor[i] * q.factor[j]);
      }
    }
  }
  // Nothing that an equation holds feels this; what none holds stays at 0.
  for (Eigen::Index i = 0; i < n; ++i) entries.emplace_back(static_cast<int>(i), static_cast<int>(i), 1e-9);
  Eigen::SparseMatrix<double> a(n, n);
  a.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> factors(a);
  const Eigen::VectorXd x = factors.solve(b);
  for (Eigen::Index i = 0; i < n; ++i) unknown[members[static_cast<std::size_t>(i)]] = x[i];
}

}  // namespace

void Equation::add(std::uint32_t unknown, double f) {
  for (std::uint32_t k = 0; k < size; ++k)
    if (index[k] == unknown) {
      factor[k] += f;
      return;
    }
  index[size] = unknown;
  factor[size++] = f;
}

Solution solve_least_squares(const std::vector<Equation>& equations, std::uint32_t unknowns) {
  Solution out;
  out.unknown.assign(unknowns, 0);
  out.group.resize(unknowns);
  std::iota(out.group.begin(), out.group.end(), 0u);
  const auto find = [&](std::uint32_t i) {
    while (out.group[i] != i) i = out.group[i] = out.group[out.group[i]];
    return i;
  };
  for (const Equation& q : equations)
    for (std::uint32_t k = 1; k < q.size; ++k) {
      const std::uint32_t a = find(q.index[0]), b = find(q.index[k]);
      out.group[std::max(a, b)] = std::min(a, b);
    }
  for (std::uint32_t i = 0; i < unknowns; ++i) out.group[i] = find(i);

  // Members and equations of each group, by counting.
  std::vector<std::uint32_t> first(unknowns + 1, 0), member(unknowns), place(unknowns, 0);
  std::vector<std::uint32_t> equation_first(unknowns + 1, 0), equation(equations.size());
  for (std::uint32_t i = 0; i < unknowns; ++i) ++first[out.group[i] + 1];
  for (const Equation& q : equations)
    if (q.size > 0) ++equation_first[out.group[q.index[0]] + 1];
  for (std::uint32_t i = 0; i < unknowns; ++i) first[i + 1] += first[i], equation_first[i + 1] += equation_first[i];
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1),
      equation_next(equation_first.begin(), equation_first.end() - 1);
  for (std::uint32_t i = 0; i < unknowns; ++i) {
    place[i] = next[out.group[i]] - first[out.group[i]];
    member[next[out.group[i]]++] = i;
  }
  for (std::uint32_t e = 0; e < equations.size(); ++e)
    if (equations[e].size > 0) equation[equation_next[out.group[equations[e].index[0]]]++] = e;

  for (std::uint32_t g = 0; g < unknowns; ++g) {
    const std::span<const std::uint32_t> members(member.data() + first[g], first[g + 1] - first[g]);
    const std::span<const std::uint32_t> rows(equation.data() + equation_first[g],
                                              equation_first[g + 1] - equation_first[g]);
    if (members.empty() || rows.empty()) continue;
    if (members.size() == 1) {
      double a = 0, b = 0;
      for (const std::uint32_t e : rows) {
        const Equation& q = equations[e];
        a += q.weight * q.factor[0] * q.factor[0], b += q.weight * q.factor[0] * q.value;
      }
      if (a > 0) out.unknown[g] = b / a;
    } else if (members.size() <= kDense) {
      solve_dense(equations, rows, members, place, out.unknown);
    } else {
      solve_sparse(equations, rows, members, place, out.unknown);
    }
  }
  return out;
}

}  // namespace blockrand::repair
