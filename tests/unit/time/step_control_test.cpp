// SPDX-License-Identifier: MIT
// Error control, stability limits, landing on output times, failures.
#include <catch2/catch.hpp>

#include "meltray/core/errors.hpp"
#include "meltray/core/parallel.hpp"
#include "problems.hpp"

namespace meltray {
namespace {

IntegratorOptions explicit2() {
  IntegratorOptions o;
  o.method = Method::explicit_rk;
  o.order = 2;
  o.initial_step = 0.1;
  return o;
}

}  // namespace

TEST_CASE("control: the global error follows the tolerance") {
  const int order = GENERATE(2, 3, 4, 5);
  double previous = 1;
  for (const double tol : {1e-4, 1e-6, 1e-8}) {
    IntegratorOptions o;
    o.order = order;
    Integrator integrator(o);
    test::Manufactured problem;
    const auto fields = test::one_field(2, tol, tol);
    const auto start = test::Manufactured::exact(0);
    std::vector<double> y(start.begin(), start.end());
    double t = 0;
    while (t < 2) {
      const StepReport r = integrator.step(problem, fields, t, 2, y);
      CHECK(r.error <= 1);
      t = r.t;
    }
    const double error = test::Manufactured::error(2, y);
    CAPTURE(order, tol, error, integrator.counters().steps, integrator.counters().rejected);
    // Local errors of size tol add up over the steps; the problem damps them.
    CHECK(error < 20 * tol);
    CHECK(error < previous / 10);
    CHECK(integrator.counters().rejected < integrator.counters().steps / 4 + 3);
    previous = error;
  }
}

TEST_CASE("control: error norm is the largest field RMS with that field's tolerances") {
  // Heun-Euler on y' = -a y: the estimate is (h a)^2 y / 2.
  test::Decay problem({1.0, 1.0, 2.0});
  const double h = 0.1;
  std::vector<double> y{3.0, 4.0, 5.0};
  const std::vector<StateField> fields{{"u", 0, 2, 1e-2, 0.5, {}}, {"v", 2, 1, 1e-3, 1.0, {}}};
  Integrator integrator(explicit2());
  const StepReport r = integrator.step(problem, fields, 0, 10, y);
  REQUIRE(r.dt == h);
  const auto scaled = [](double e, double y0, double rtol, double atol) { return e / (rtol * y0 + atol); };
  const double u0 = scaled(h * h * 3 / 2, 3, 1e-2, 0.5), u1 = scaled(h * h * 4 / 2, 4, 1e-2, 0.5);
  const double v = scaled(4 * h * h * 5 / 2, 5, 1e-3, 1.0);
  CHECK(r.error == Approx(std::max(std::sqrt((u0 * u0 + u1 * u1) / 2), v)).epsilon(1e-12));
}

TEST_CASE("control: entries at rest do not change the error estimate") {
  const auto error_of = [](std::size_t idle, bool marked) {
    std::vector<double> rates(20, 1.0), y(20, 2.0);
    std::vector<std::uint8_t> active(20, 1);
    rates.resize(20 + idle, 0.0);
    y.resize(20 + idle, 300.0);
    active.resize(20 + idle, 0);
    test::Decay problem(rates);
    std::vector<StateField> fields = test::one_field(y.size(), 1e-3, 0.1);
    if (marked) fields[0].active = active;
    Integrator integrator(explicit2());
    return integrator.step(problem, fields, 0, 10, y).error;
  };
  const double alone = error_of(0, true);
  // Zeros change the order of summation at most.
  CHECK(error_of(5000, true) == Approx(alone).epsilon(1e-14));
  CHECK(error_of(5000, false) == Approx(alone * std::sqrt(20.0 / 5020.0)).epsilon(1e-12));
}

TEST_CASE("control: steps end exactly on the output time, without a tiny last one") {
  const double stop = GENERATE(1.0, 0.95, 1.0001, 0.3333);
  const bool fixed = GENERATE(true, false);
  IntegratorOptions o = explicit2();
  o.fixed_step = fixed ? 0.1 : 0;
  o.max_step = 0.1;
  Integrator integrator(o);
  test::Decay problem({1.0});
  const auto fields = test::one_field(1, 1e-1, 1e-1);
  std::vector<double> y{1.0};
  double t = 0;
  StepReport r;
  while (t < stop) {
    r = integrator.step(problem, fields, t, stop, y);
    CAPTURE(stop, fixed, t, r.dt, r.limiter);
    CHECK(r.dt <= 0.1 * (1 + 1e-8));
    CHECK(r.dt >= 0.05);
    t = r.t;
  }
  CHECK(t == stop);
  CHECK(y[0] == Approx(std::exp(-stop)).epsilon(2e-3));
  if (stop != 1.0) CHECK(r.limiter == "output");
  // The cut does not shorten what comes after.
  CHECK(integrator.proposed_step() >= 0.1 * (1 - 1e-8));
}

TEST_CASE("control: stability limit and other bounds are respected and named") {
  test::Decay problem({1.0});
  const auto fields = test::one_field(1, 1.0, 1.0);
  std::vector<double> y{1.0};
  SECTION("limit of the problem") {
    problem.limit = {0.01, "acoustic"};
    IntegratorOptions o = explicit2();
    o.initial_step = 0;
    Integrator integrator(o);
    double t = 0;
    for (int k = 0; k < 5; ++k) {
      const StepReport r = integrator.step(problem, fields, t, 100, y);
      CHECK(r.dt == 0.01);
      CHECK(r.limiter == "acoustic");
      t = r.t;
    }
    problem.limit = {1.0, "capillary"};
    const StepReport r = integrator.step(problem, fields, t, 100, y);
    CHECK(r.dt == Approx(0.02).epsilon(1e-12));
    CHECK(r.limiter == "growth");
  }
  SECTION("limit of the problem with Euler, which has no error estimate") {
    problem.limit = {0.02, "viscous"};
    IntegratorOptions o;
    o.method = Method::euler;
    Integrator integrator(o);
    const StepReport r = integrator.step(problem, fields, 0, 100, y);
    CHECK(r.dt == 0.02);
    CHECK(r.limiter == "viscous");
    CHECK(r.error == 0);
    CHECK(y[0] == Approx(0.98).epsilon(1e-15));
  }
  SECTION("maximum and initial step") {
    IntegratorOptions o = explicit2();
    o.max_step = 0.15;
    Integrator integrator(o);
    StepReport r = integrator.step(problem, fields, 0, 100, y);
    CHECK(r.dt == 0.1);
    CHECK(r.limiter == "initial");
    r = integrator.step(problem, fields, r.t, 100, y);
    CHECK(r.dt == 0.15);
    CHECK(r.limiter == "maximum");
  }
  SECTION("error") {
    Integrator integrator(explicit2());
    const auto tight = test::one_field(1, 0, 1e-6);
    const StepReport r = integrator.step(problem, tight, 0, 100, y);
    CHECK(r.limiter == "error");
    CHECK(r.rejected > 0);
    CHECK(r.error <= 1);
    // Estimate h^2 y / 2 at most atol.
    CHECK(r.dt <= std::sqrt(2e-6));
    CHECK(integrator.counters().rejected == r.rejected);
  }
}

TEST_CASE("control: NaN rejects the step and halves it") {
  test::Decay problem({1.0});
  const auto fields = test::one_field(1, 1.0, 1.0);
  std::vector<double> y{1.0};
  SECTION("once, at any evaluation of the step") {
    const int at = GENERATE(0, 1);
    const bool euler = GENERATE(false, true);
    IntegratorOptions o = explicit2();
    if (euler) o.method = Method::euler;
    Integrator integrator(o);
    if (at == 0) problem.nan_calls = 1;
    if (at == 1) problem.nan_after = 0.06;
    const StepReport r = integrator.step(problem, fields, 0, 100, y);
    if (at == 1 && euler) {
      CHECK(r.dt == 0.1);  // Euler does not look at the end of the step
    } else {
      CHECK(r.dt == 0.05);
      CHECK(r.rejected == 1);
      CHECK(r.limiter == "retry");
    }
    CHECK(std::isfinite(y[0]));
  }
  SECTION("persistent: the run ends with a message") {
    Integrator integrator(explicit2());
    problem.nan_after = -1;
    CHECK_THROWS_WITH(integrator.step(problem, fields, 0, 100, y),
                      Catch::Contains("below the smallest") && Catch::Contains("NaN"));
    CHECK(y[0] == 1.0);
  }
  SECTION("fixed step") {
    IntegratorOptions o = explicit2();
    o.fixed_step = 0.1;
    Integrator integrator(o);
    problem.nan_calls = 1;
    CHECK_THROWS_AS(integrator.step(problem, fields, 0, 100, y), NumericalFailure);
    // The same integrator goes on from the unchanged state.
    CHECK(y[0] == 1.0);
    CHECK(integrator.step(problem, fields, 0, 100, y).dt == 0.1);
  }
}

TEST_CASE("control: NaN in the implicit part, at any evaluation, rejects the step") {
  struct Faulty : test::Manufactured {
    int good_calls = 0;
    void implicit_rate(double t, const double* y, double* f) override {
      Manufactured::implicit_rate(t, y, f);
      if (good_calls-- == 0) f[1] = std::numeric_limits<double>::quiet_NaN();
    }
    bool solve_linear(double t, double gamma, const double* known, double* z) override {
      const int left = good_calls--;
      good_calls = -1;  // not in the rates that the solve itself takes
      const bool solved = Manufactured::solve_linear(t, gamma, known, z);
      good_calls = left - 1;
      if (left == 0) z[1] = std::numeric_limits<double>::quiet_NaN();
      return solved;
    }
  } problem;
  problem.good_calls = GENERATE(0, 1, 2, 3);
  problem.linear = GENERATE(false, true);
  IntegratorOptions o;
  o.method = GENERATE(Method::imex, Method::euler);
  o.initial_step = 0.1;
  // Where the implicit part is linear, one solve a stage takes the place of the evaluations.
  if (problem.linear && problem.good_calls > 1) return;
  if (o.method == Method::euler && problem.good_calls > 0) return;
  const auto fields = test::one_field(2, 1.0, 1.0);
  std::vector<double> y{1.0, 1.0};
  Integrator integrator(o);
  const StepReport r = integrator.step(problem, fields, 0, 1, y);
  CHECK(r.dt == 0.05);
  CHECK(r.rejected == 1);
  // As if the longer step had not been tried.
  o.initial_step = 0.05;
  std::vector<double> same{1.0, 1.0};
  Integrator(o).step(problem, fields, 0, 1, same);
  CHECK(y == same);
}

TEST_CASE("control: a failing implicit solve is retried smaller, then reported") {
  struct Stubborn : test::Stiff {
    double works_below = 0;
    bool solve_implicit(double t, const double* y, double gamma, double* x) override {
      return gamma < works_below && Stiff::solve_implicit(t, y, gamma, x);
    }
    bool solve_linear(double t, double gamma, const double* known, double* z) override {
      return gamma < works_below && Stiff::solve_linear(t, gamma, known, z);
    }
  } problem;
  const auto fields = test::one_field(2, 1.0, 1.0);
  std::vector<double> y{1.0, 1.0};
  IntegratorOptions o;
  o.initial_step = 0.1;
  const bool euler = GENERATE(false, true);
  if (euler) o.method = Method::euler;
  Integrator integrator(o);
  CHECK_THROWS_WITH(integrator.step(problem, fields, 0, 1, y), Catch::Contains("implicit solve"));
  problem.works_below = 0.01;
  const StepReport r = integrator.step(problem, fields, 0, 1, y);
  CHECK(r.limiter == "retry");
  CHECK(r.dt == (euler ? 0.1 / 16 : 0.1 / 4));  // gamma is dt, or 0.293 dt
}

TEST_CASE("control: smallest step") {
  test::Decay problem({1.0});
  const auto fields = test::one_field(1, 1.0, 1.0);
  std::vector<double> y{1.0};
  IntegratorOptions o = explicit2();
  o.min_step = 1e-3;
  Integrator integrator(o);
  problem.limit = {1e-4, "capillary"};
  CHECK_THROWS_AS(integrator.step(problem, fields, 0, 1, y), NumericalFailure);
  CHECK_THROWS_WITH(integrator.step(problem, fields, 0, 1, y), Catch::Contains("capillary"));
  problem.limit = {};
  const auto tight = test::one_field(1, 0, 1e-12);
  CHECK_THROWS_WITH(integrator.step(problem, tight, 0, 1, y), Catch::Contains("error estimate"));
  // A short rest before an output time is not a failure.
  CHECK(integrator.step(problem, fields, 0, 1e-5, y).t == 1e-5);
}

TEST_CASE("control: exceptions of the problem pass through") {
  struct Throwing : test::Decay {
    using Decay::Decay;
    void explicit_rate(double, const double*, double*) override { throw IoError("probe"); }
  } problem({1.0});
  const auto fields = test::one_field(1, 1.0, 1.0);
  std::vector<double> y{1.0};
  Integrator integrator(explicit2());
  CHECK_THROWS_AS(integrator.step(problem, fields, 0, 1, y), IoError);
}

TEST_CASE("control: fields that do not fit the state are refused") {
  test::Decay problem({1.0, 1.0});
  std::vector<double> y{1.0, 1.0};
  Integrator integrator(explicit2());
  CHECK_THROWS_AS(integrator.step(problem, test::one_field(1, 1.0, 1.0), 0, 1, y), UsageError);
  CHECK_THROWS_AS(integrator.step(problem, test::one_field(2, 1e-3, 0.0), 0, 1, y), UsageError);
  std::vector<StateField> gap{{"u", 0, 1, 1, 1, {}}, {"v", 2, 1, 1, 1, {}}};
  CHECK_THROWS_AS(integrator.step(problem, gap, 0, 1, y), UsageError);
}

}  // namespace meltray
