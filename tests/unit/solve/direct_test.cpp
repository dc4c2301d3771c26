// SPDX-License-Identifier: MIT
#include "meltray/solve/direct.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "meltray/core/errors.hpp"

using namespace meltray;

namespace {

/// A sparse symmetric matrix that is built entry by entry.
struct TestMatrix {
  std::vector<std::map<Index, double>> rows;
  std::vector<std::int64_t> row_start;
  std::vector<Index> column;
  std::vector<double> value;

  explicit TestMatrix(Index n) : rows(static_cast<std::size_t>(n)) {}
  Index size() const { return static_cast<Index>(rows.size()); }

  /// Adds w (x_i - x_j)^2 to the quadratic form: a spring between two unknowns, positive semidefinite.
  void spring(Index i, Index j, double w) {
    rows[i][i] += w;
    rows[j][j] += w;
    rows[i][j] -= w;
    rows[j][i] -= w;
  }
  CsrView csr() {
    row_start = {0};
    column.clear();
    value.clear();
    for (const auto& row : rows) {
      for (const auto& [j, v] : row) column.push_back(j), value.push_back(v);
      row_start.push_back(static_cast<std::int64_t>(column.size()));
    }
    return {row_start, column, value};
  }
  std::vector<double> times(const std::vector<double>& x) const {
    std::vector<double> y(x.size(), 0);
    for (Index i = 0; i < size(); ++i)
      for (const auto& [j, v] : rows[i]) y[i] += v * x[j];
    return y;
  }
};

/// Random springs between the unknowns of a chain and across it; singular (constants) unless anchored.
TestMatrix random_network(Index n, unsigned seed) {
  TestMatrix a(n);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> weight(0.5, 2);
  std::uniform_int_distribution<Index> any(0, n - 1);
  for (Index i = 0; i + 1 < n; ++i) a.spring(i, i + 1, weight(random));
  for (Index k = 0; k < 5 * n; ++k) {
    const Index i = any(random), j = any(random);
    if (i != j) a.spring(i, j, weight(random));
  }
  return a;
}

std::vector<double> random_vector(Index n) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> entry(-1, 1);
  std::vector<double> v(static_cast<std::size_t>(n));
  for (double& x : v) x = entry(random);
  return v;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double d = 0;
  for (std::size_t i = 0; i < a.size(); ++i) d = std::max(d, std::abs(a[i] - b[i]));
  return d;
}

std::string failure(TestMatrix& a) {
  CholeskySolver solver;
  try {
    solver.factor(a.csr());
  } catch (const NumericalFailure& e) {
    return e.what();
  }
  return "no failure";
}

}  // namespace

TEST_CASE("Cholesky: residual and error of a random positive definite matrix are at round-off") {
  for (const Index n : {1, 2, 50, 1000}) {
    CAPTURE(n);
    TestMatrix a = random_network(n, 3);
    for (Index i = 0; i < n; ++i) a.rows[i][i] += 0.1;
    const auto exact = random_vector(n);
    const auto b = a.times(exact);
    std::vector<double> x(exact.size());
    CholeskySolver solver;
    CHECK(solver.factor_entries() == 0);
    solver.factor(a.csr());
    CHECK(solver.factor_entries() >= n);
    solver.solve(b, x);
    // Entries of A are of order 10 and x of order 1; the condition number is below 1e3.
    CHECK(largest_difference(a.times(x), b) < 1e-12);
    CHECK(largest_difference(x, exact) < 1e-12);
  }
}

TEST_CASE("Cholesky: new values in the old pattern, then a new pattern, and solving in place") {
  CholeskySolver solver;
  for (const unsigned seed : {1u, 1u, 2u}) {
    TestMatrix a = random_network(200, seed);
    const double anchor = solver.factor_entries() == 0 ? 1 : 3;
    for (Index i = 0; i < 200; ++i) a.rows[i][i] += anchor;
    const auto exact = random_vector(200);
    auto x = a.times(exact);
    solver.factor(a.csr());
    solver.solve(x, x);
    CHECK(largest_difference(x, exact) < 1e-12);
  }
}

TEST_CASE("Cholesky: unknowns in very different units do no harm") {
  // Row and column i times 10^(+-6): the matrix of masses or pressures in other units.
  TestMatrix a = random_network(300, 5);
  for (Index i = 0; i < 300; ++i) a.rows[i][i] += 0.1;
  const auto unit = [](Index i) { return i % 2 ? 1e6 : 1e-6; };
  for (Index i = 0; i < 300; ++i)
    for (auto& [j, v] : a.rows[i]) v *= unit(i) * unit(j);
  auto exact = random_vector(300);
  for (Index i = 0; i < 300; ++i) exact[i] /= unit(i);
  std::vector<double> x(300);
  CholeskySolver solver;
  solver.factor(a.csr());
  solver.solve(a.times(exact), x);
  for (Index i = 0; i < 300; ++i)
    CHECK(x[i] * unit(i) == Approx(exact[i] * unit(i)).margin(1e-11).epsilon(0));
}

TEST_CASE("Cholesky: a singular matrix is a clean numerical failure") {
  for (const Index n : {5, 100, 1000}) {
    CAPTURE(n);
    TestMatrix free_network = random_network(n, 4);  // constants are in the null space
    CHECK_THAT(failure(free_network),
               Catch::Contains("Cholesky factorisation") &&
                   (Catch::Contains("not positive definite") || Catch::Contains("singular")));
  }
}

TEST_CASE("Cholesky: indefinite, zero and non-finite matrices are refused, and the solver stays usable") {
  TestMatrix indefinite = random_network(50, 6);
  for (Index i = 0; i < 50; ++i) indefinite.rows[i][i] += i == 25 ? -1 : 0.01;
  CHECK_THAT(failure(indefinite), Catch::Contains("positive"));

  TestMatrix zero_row = random_network(50, 6);
  zero_row.rows[7][7] = 0;
  CHECK_THAT(failure(zero_row), Catch::Contains("diagonal entry 7 of 50 unknowns is 0"));

  TestMatrix not_a_number = random_network(50, 6);
  for (Index i = 0; i < 50; ++i) not_a_number.rows[i][i] += 1;
  not_a_number.rows[3][4] = not_a_number.rows[4][3] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THAT(failure(not_a_number), Catch::Contains("Cholesky factorisation"));

  CholeskySolver solver;
  CHECK_THROWS_AS(solver.factor(indefinite.csr()), NumericalFailure);
  CHECK(solver.factor_entries() == 0);
  TestMatrix good(2);
  good.spring(0, 1, 1);
  good.rows[0][0] += 1;
  good.rows[1][1] += 1;
  solver.factor(good.csr());
  std::vector<double> x(2);
  solver.solve(std::vector<double>{1, 2}, x);
  CHECK(x[0] == Approx(4.0 / 3));  // [2 -1; -1 2] x = [1 2]
  CHECK(x[1] == Approx(5.0 / 3));
}
