// SPDX-License-Identifier: MIT
#include "meltray/solve/conjugate_gradient.hpp"

#include <omp.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>

#include "meltray/core/parallel.hpp"
#include "meltray/solve/direct.hpp"

using namespace meltray;
using namespace meltray::solve;

namespace {

/// Laplacian of random springs on a grid of n x n nodes; `anchor` is added to the diagonal of the first row
/// of nodes. Springs between the columns left and right of `cut` are left out.
SymmetricMatrix network(int n, double anchor, int cut = -1) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> weight(0.1, 10);
  std::vector<std::map<Index, double>> springs(static_cast<std::size_t>(n) * n);
  const auto node = [n](int i, int j) { return static_cast<Index>(j * n + i); };
  const auto connect = [&](Index a, Index b) { springs[a][b] = springs[b][a] = weight(random); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      if (i + 1 < n && i != cut) connect(node(i, j), node(i + 1, j));
      if (j + 1 < n) connect(node(i, j), node(i, j + 1));
    }
  SymmetricMatrix a;
  for (int r = 0; r < n * n; ++r) {
    double sum = r < n ? anchor : 0;
    for (const auto& [j, w] : springs[r]) {
      a.column.push_back(j);
      a.off.push_back(static_cast<float>(w));
      sum += a.off.back();
    }
    a.diagonal.push_back(sum);
    a.start.push_back(static_cast<Index>(a.column.size()));
  }
  return a;
}

std::vector<double> random_vector(Index n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> entry(-1, 1);
  std::vector<double> v(n);
  for (double& x : v) x = entry(random);
  return v;
}

std::vector<double> by_cholesky(const SymmetricMatrix& a, const std::vector<double>& b) {
  std::vector<std::int64_t> start{0};
  std::vector<Index> column;
  std::vector<double> value;
  for (Index i = 0; i < a.rows(); ++i) {
    std::map<Index, double> row{{i, a.diagonal[i]}};
    for (Index k = a.start[i]; k < a.start[i + 1]; ++k) row[a.column[k]] -= a.off[k];
    for (const auto& [j, v] : row) column.push_back(j), value.push_back(v);
    start.push_back(static_cast<std::int64_t>(column.size()));
  }
  CholeskySolver solver;
  solver.factor({start, column, value});
  std::vector<double> x(b.size());
  solver.solve(b, x);
  return x;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double d = 0;
  for (std::size_t i = 0; i < a.size(); ++i) d = std::max(d, std::abs(a[i] - b[i]));
  return d;
}

double mean(const std::vector<double>& v, const std::vector<Index>* group = nullptr, Index which = 0) {
  double sum = 0;
  int n = 0;
  for (std::size_t i = 0; i < v.size(); ++i)
    if (!group || (*group)[i] == which) sum += v[i], ++n;
  return sum / n;
}

}  // namespace

TEST_CASE("conjugate gradients agree with the Cholesky solution") {
  for (int n : {1, 2, 7, 40}) {
    CAPTURE(n);
    const auto a = network(n, 1.0);
    const auto b = random_vector(a.rows(), 2);
    const auto exact = by_cholesky(a, b);
    auto x = random_vector(a.rows(), 3);
    ConjugateGradient cg;
    const auto report = cg.solve(a, b, x, 1e-13, 5000);
    CHECK(report.converged);
    CHECK(report.residual <= 1e-13);
    double size = 0;
    for (double v : exact) size = std::max(size, std::abs(v));
    // Condition number up to 1e5: a residual of 1e-13 leaves at most 1e-8.
    CHECK(largest_difference(x, exact) < 1e-8 * size);
    // From the solution there is nothing left to do.
    CHECK(cg.solve(a, b, x, 1e-9, 5000).iterations == 0);
  }
}

TEST_CASE("the reported residual is that of the equation, and the limit on iterations is told") {
  const auto a = network(40, 1.0);
  const auto b = random_vector(a.rows(), 2);
  std::vector<double> x(b.size(), 0.0), ax(b.size());
  ConjugateGradient cg;
  const auto report = cg.solve(a, b, x, 1e-12, 25);
  CHECK_FALSE(report.converged);
  CHECK(report.iterations == 25);
  multiply(a, x, ax);
  double r2 = 0, b2 = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    r2 += (b[i] - ax[i]) * (b[i] - ax[i]) / a.diagonal[i];
    b2 += b[i] * b[i] / a.diagonal[i];
  }
  CHECK(report.residual == Approx(std::sqrt(r2 / b2)).epsilon(1e-8));
}

TEST_CASE("a zero right-hand side gives zero, whatever the start") {
  const auto a = network(5, 1.0);
  std::vector<double> b(a.rows(), 0.0), x = random_vector(a.rows(), 1);
  ConjugateGradient cg;
  CHECK(cg.solve(a, b, x, 1e-10, 10).converged);
  CHECK(largest_difference(x, b) == 0);
}

TEST_CASE("a singular consistent system: the solution with the mean of the start vector") {
  const auto a = network(30, 0.0);
  auto b = random_vector(a.rows(), 4);
  const double shift = mean(b);
  for (double& v : b) v -= shift;
  std::vector<double> x(b.size(), 0.0), ax(b.size());
  ConjugateGradient cg;
  CHECK(cg.solve(a, b, x, 1e-12, 5000).converged);
  multiply(a, x, ax);
  CHECK(largest_difference(ax, b) < 1e-10);
  // Against Cholesky with one weak anchor, compared up to a constant: the anchor carries no force.
  auto anchored = a;
  anchored.diagonal[0] += 1.0;
  auto exact = by_cholesky(anchored, b);
  const double offset = mean(exact) - mean(x);
  for (double& v : exact) v -= offset;
  CHECK(largest_difference(x, exact) < 1e-8);
}

TEST_CASE("the solution does not depend on the number of threads, bit for bit") {
  const auto a = network(120, 0.3);
  const auto b = random_vector(a.rows(), 9);
  const int before = threads();
  std::vector<std::vector<double>> x;
  for (int n : {1, 2, 4}) {
    set_threads(n);
    x.emplace_back(b.size(), 0.0);
    ConjugateGradient cg;
    cg.solve(a, b, x.back(), 1e-8, 2000);
  }
  set_threads(before);
  CHECK(x[0] == x[1]);
  CHECK(x[0] == x[2]);
}

TEST_CASE("floating components: groups without an anchored row are numbered from 1") {
  const int n = 12;
  const auto a = network(n, 0.0, 4);  // columns 0 to 4 and 5 to 11 are not connected
  std::vector<double> anchored(a.rows(), 0.0);
  std::vector<Index> group, scratch;
  CHECK(floating_components(a, anchored, group, scratch) == 2);
  std::size_t wrong = 0;
  for (Index r = 0; r < a.rows(); ++r) wrong += group[r] != (r % n <= 4 ? 1 : 2);
  CHECK(wrong == 0);

  anchored[2] = 1e-9;  // in the left part
  CHECK(floating_components(a, anchored, group, scratch) == 1);
  wrong = 0;
  for (Index r = 0; r < a.rows(); ++r) wrong += group[r] != (r % n <= 4 ? 0 : 1);
  CHECK(wrong == 0);

  anchored[5 * n + 7] = 1;
  CHECK(floating_components(a, anchored, group, scratch) == 0);
  CHECK(*std::max_element(group.begin(), group.end()) == 0);
}

TEST_CASE("floating components: a link of weight zero is no link, a row of its own is a component") {
  SymmetricMatrix a;
  a.start = {0, 1, 2, 2};
  a.column = {1, 0};
  a.off = {0, 0};
  a.diagonal = {1, 1, 0};
  std::vector<Index> group, scratch;
  CHECK(floating_components(a, {1, 0, 0}, group, scratch) == 2);
  CHECK(group == std::vector<Index>{0, 1, 2});
}
