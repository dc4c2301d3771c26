// SPDX-License-Identifier: MIT
#include <cmath>

#include "meltray/core/errors.hpp"
#include "unit/time/problems.hpp"

namespace meltray {
namespace {

double error_with(test::Manufactured& problem, int order, int steps, double fast_step) {
  IntegratorOptions o;
  o.method = Method::multirate;
  o.order = order;
  o.fixed_step = 1.0 / steps;
  o.fast_step = fast_step;
  Integrator integrator(o);
  const auto fields = test::one_field(2, 1e-10, 1e-10);
  std::vector<double> y{1.0, 1.0};
  for (double t = 0; t < 1;) t = integrator.step(problem, fields, t, 1.0, y).t;
  const auto exact = test::Manufactured::exact(1.0);
  return std::hypot(y[0] - exact[0], y[1] - exact[1]);
}

}  // namespace

TEST_CASE("multirate: observed order, with fast steps as long as the slow stages and much shorter") {
  struct Case {
    int order, steps;
    double fast_share;
  };
  const auto c = GENERATE(Case{3, 20, 1}, Case{3, 20, 0.05}, Case{4, 20, 1}, Case{4, 10, 0.05});
  test::Manufactured problem;
  const double coarse = error_with(problem, c.order, c.steps, c.fast_share / c.steps);
  const double fine = error_with(problem, c.order, 2 * c.steps, c.fast_share / (2 * c.steps));
  const double observed = std::log2(coarse / fine);
  CAPTURE(c.order, c.fast_share, coarse, fine, observed);
  CHECK(std::abs(observed - c.order) < 0.25);
}

TEST_CASE(
    "multirate: slow rates are evaluated once a slow stage, fast ones as often as their step asks for") {
  IntegratorOptions o;
  o.method = Method::multirate;
  o.order = 3;
  o.fixed_step = 0.1;
  o.fast_step = 0.001;
  Integrator integrator(o);
  test::Manufactured problem;
  const auto fields = test::one_field(2, 1e-6, 1e-6);
  std::vector<double> y{1.0, 1.0};
  integrator.step(problem, fields, 0, 1, y);
  // Three slow stages and 3 x 34 fast steps of 3 used stages. What ARKODE asks for besides, before and after
  // a step, is not evaluated.
  CHECK(integrator.counters().implicit_evals == 3);
  CHECK(integrator.counters().explicit_evals == 3 * 34 * 3);
}

TEST_CASE("multirate: what makes no sense is refused") {
  IntegratorOptions o;
  o.method = Method::multirate;
  o.order = 3;
  CHECK_THROWS_AS(Integrator(o), UsageError);  // no slow step
  o.fixed_step = 0.1;
  o.order = 2;
  CHECK_THROWS_AS(Integrator(o), UsageError);
  o.order = 3;
  Integrator integrator(o);
  test::Manufactured problem;
  problem.with_implicit = false;
  const auto fields = test::one_field(2, 1e-6, 1e-6);
  std::vector<double> y{1.0, 1.0};
  CHECK_THROWS_AS(integrator.step(problem, fields, 0, 1, y), UsageError);
}

TEST_CASE("multirate: a limit of the fast step that is no step fails with its name") {
  using Catch::Matchers::Contains;
  struct Limited : test::Manufactured {
    double limit = 0;
    StepLimit stable_step(double, const double*) override { return {limit, "sound"}; }
  } problem;
  IntegratorOptions o;
  o.method = Method::multirate;
  o.order = 3;
  o.fixed_step = 0.1;
  o.min_step = 1e-3;
  const auto fields = test::one_field(2, 1e-6, 1e-6);
  std::vector<double> y{1.0, 1.0};
  const auto step = [&] { return Integrator(o).step(problem, fields, 0, 1, y); };
  problem.limit = GENERATE(0.0, -1.0, std::nan(""), 0.9e-3);
  CHECK_THROWS_AS(step(), NumericalFailure);
  CHECK_THROWS_WITH(step(), Contains("'sound'"));
  CHECK(y == std::vector<double>{1.0, 1.0});
  // Shorter slow stages make shorter fast steps than their limit: what counts is the limit.
  problem.limit = 1.1e-3;
  CHECK(step().dt == o.fixed_step);
  o.fast_step = 0.9e-3;
  CHECK_THROWS_AS(step(), NumericalFailure);
}

TEST_CASE("multirate: NaN in either part fails the step with a message") {
  struct Broken : test::Manufactured {
    bool slow = false;
    void explicit_rate(double t, const double* y, double* f) override {
      Manufactured::explicit_rate(t, y, f);
      if (!slow && t > 0.05) f[0] = std::nan("");
    }
    void implicit_rate(double t, const double* y, double* f) override {
      Manufactured::implicit_rate(t, y, f);
      if (slow && t > 0.05) f[1] = std::nan("");
    }
  } problem;
  problem.slow = GENERATE(false, true);
  IntegratorOptions o;
  o.method = Method::multirate;
  o.order = 3;
  o.fixed_step = 0.1;
  o.fast_step = 0.01;
  Integrator integrator(o);
  const auto fields = test::one_field(2, 1e-6, 1e-6);
  std::vector<double> y{1.0, 1.0};
  CHECK_THROWS_AS(integrator.step(problem, fields, 0, 1, y), NumericalFailure);
  CHECK(y == std::vector<double>{1.0, 1.0});
}

}  // namespace meltray
