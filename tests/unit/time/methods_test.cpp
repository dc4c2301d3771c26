// SPDX-License-Identifier: MIT
// Every Butcher table shows its order in our driver, and the stiff ones are stable far beyond explicit
// limits.
#include <catch2/catch.hpp>

#include "meltray/core/errors.hpp"
#include "problems.hpp"

namespace meltray {
namespace {

double error_with(OdeProblem& problem, Method method, int order, int steps) {
  IntegratorOptions o;
  o.method = method;
  o.order = order;
  o.fixed_step = 2.0 / steps;
  Integrator integrator(o);
  // Tight tolerances: in fixed-step mode they only steer Newton's method.
  const auto fields = test::one_field(2, 1e-11, 1e-11);
  const auto start = test::Manufactured::exact(0);
  std::vector<double> y(start.begin(), start.end());
  double t = 0;
  while (t < 2) t = integrator.step(problem, fields, t, 2, y).t;
  CHECK(integrator.counters().steps == steps);
  return test::Manufactured::error(2, y);
}

struct Case {
  Method method;
  int order, steps;
  bool with_explicit, with_implicit, linear;
};

}  // namespace

TEST_CASE("methods: observed order on a nonlinear problem with known solution") {
  // Steps: fine enough for the asymptotic range, errors well above rounding.
  const auto c =
      GENERATE(Case{Method::euler, 1, 200, true, true, false}, Case{Method::euler, 1, 200, true, true, true},
               Case{Method::imex, 2, 100, true, true, false}, Case{Method::imex, 2, 100, true, true, true},
               Case{Method::imex, 3, 40, true, true, false}, Case{Method::imex, 3, 40, true, true, true},
               Case{Method::imex, 4, 20, true, true, false}, Case{Method::imex, 4, 20, true, true, true},
               Case{Method::imex, 5, 20, true, true, false}, Case{Method::imex, 5, 20, true, true, true},
               Case{Method::imex, 2, 100, true, false, false}, Case{Method::imex, 2, 100, false, true, false},
               Case{Method::explicit_rk, 2, 100, true, true, false},
               Case{Method::explicit_rk, 3, 60, true, true, false},
               Case{Method::explicit_rk, 4, 40, true, true, false},
               Case{Method::explicit_rk, 5, 40, true, true, false},
               Case{Method::implicit_rk, 2, 100, false, true, false},
               Case{Method::implicit_rk, 3, 40, false, true, false},
               Case{Method::implicit_rk, 4, 40, false, true, false},
               Case{Method::implicit_rk, 5, 20, false, true, false});
  test::Manufactured problem;
  problem.with_explicit = c.with_explicit;
  problem.with_implicit = c.with_implicit;
  problem.linear = c.linear;
  const double coarse = error_with(problem, c.method, c.order, c.steps);
  const double fine = error_with(problem, c.method, c.order, 2 * c.steps);
  const double observed = std::log2(coarse / fine);
  CAPTURE(name_of(c.method), c.order, c.with_explicit, c.with_implicit, c.linear, coarse, fine, observed);
  CHECK(std::abs(observed - c.order) < 0.2);
}

TEST_CASE("methods: a stiff implicit part is stable far beyond the explicit limit") {
  const int order = GENERATE(1, 2, 3, 4, 5);
  IntegratorOptions o;
  o.method = order == 1 ? Method::euler : Method::imex;
  o.order = order;
  o.fixed_step = 0.05;  // 25,000 times the explicit limit 2 / L
  Integrator integrator(o);
  test::Stiff problem;
  const auto fields = test::one_field(2, 1e-9, 1e-9);
  std::vector<double> y{1.0, 1.0};
  double t = 0;
  while (t < 5) t = integrator.step(problem, fields, t, 5, y).t;
  CAPTURE(order, y[0] - std::cos(5.0), y[1] - (1 + std::sin(5.0) / 2));
  // Stiff unknown: what the explicit weights differ from those of the last stage stays undamped, O(h^3) here.
  CHECK(std::abs(y[0] - std::cos(5.0)) < 4 * std::pow(o.fixed_step, 3));
  // Non-stiff unknown: h^1 for Euler, else second order or better.
  CHECK(std::abs(y[1] - (1 + std::sin(5.0) / 2)) < (order == 1 ? 5e-2 : 5e-3));
}

TEST_CASE("methods: work per step of the second-order IMEX pair") {
  IntegratorOptions o;
  o.fixed_step = 0.1;
  Integrator integrator(o);
  test::Manufactured problem;
  problem.linear = true;
  const auto fields = test::one_field(2, 1e-6, 1e-6);
  std::vector<double> y{1.0, 1.0};
  integrator.step(problem, fields, 0, 1, y);
  // Two explicit rates (nothing uses that of the last stage); implicit stages are solved without any.
  CHECK(integrator.counters().explicit_evals == 2);
  CHECK(integrator.counters().implicit_evals == 0);
  CHECK(integrator.counters().linear_solves == 2);
}

TEST_CASE("methods: what does not exist is refused") {
  IntegratorOptions o;
  o.order = 6;
  CHECK_THROWS_AS(Integrator(o), UsageError);
  o.order = 2;
  o.method = Method::implicit_rk;
  Integrator integrator(o);
  test::Manufactured problem;
  const auto fields = test::one_field(2, 1e-6, 1e-6);
  std::vector<double> y{1.0, 1.0};
  CHECK_THROWS_AS(integrator.step(problem, fields, 0, 1, y), UsageError);
}

}  // namespace meltray
