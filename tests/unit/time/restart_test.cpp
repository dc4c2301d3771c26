// SPDX-License-Identifier: MIT
// Steps depend on nothing but what is archived: size changes, restart, number of threads; and cost no
// allocations.
#include <catch2/catch.hpp>

#include <atomic>
#include <cstdlib>
#include <map>
#include <new>
#include <string>

#include "meltray/core/archive.hpp"
#include "meltray/core/parallel.hpp"
#include "problems.hpp"

namespace {
std::atomic<long> allocations{0};
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size > 0 ? size : 1)) return p;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size > 0 ? size : 1);
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}

namespace meltray {
namespace {

/// Keeps what an Archive writes in maps.
class MemoryArchive : public Archive {
 public:
  bool loading() const override { return loading_; }
  void load() { loading_ = true; }
  void value(std::string_view name, double& v) override { put(doubles_, name, v); }
  void value(std::string_view name, std::int64_t& v) override { put(integers_, name, v); }
  void value(std::string_view name, std::string& v) override { put(strings_, name, v); }
  void values(std::string_view, std::vector<double>&) override { FAIL("not expected"); }
  void values(std::string_view, std::vector<std::uint8_t>&) override { FAIL("not expected"); }
  void values(std::string_view, std::vector<std::int32_t>&) override { FAIL("not expected"); }

 private:
  template <class T>
  void put(std::map<std::string, T>& map, std::string_view name, T& v) {
    if (loading_)
      v = map.at(std::string(name));
    else
      map[std::string(name)] = v;
  }
  bool loading_ = false;
  std::map<std::string, double> doubles_;
  std::map<std::string, std::int64_t> integers_;
  std::map<std::string, std::string> strings_;
};

/// For any number of unknowns: y_i' = 50 (1 + i mod 7) (0.5 - y_i) + sin(y_i y_{i+1}), the first term
/// implicit.
struct Reaction : OdeProblem {
  std::size_t n = 0;
  StepLimit limit{0.2, "reaction"};
  bool implicit_is_linear() const override { return true; }
  static double k(std::size_t i) { return 50.0 * static_cast<double>(1 + i % 7); }
  void explicit_rate(double, const double* y, double* f) override {
    parallel_for(static_cast<std::ptrdiff_t>(n), [&](std::ptrdiff_t i) {
      f[i] = std::sin(y[i] * y[static_cast<std::size_t>(i + 1) == n ? 0 : i + 1]);
    });
  }
  void implicit_rate(double, const double* y, double* f) override {
    for (std::size_t i = 0; i < n; ++i) f[i] = k(i) * (0.5 - y[i]);
  }
  bool solve_implicit(double, const double*, double gamma, double* x) override {
    for (std::size_t i = 0; i < n; ++i) x[i] /= 1 + gamma * k(i);
    return true;
  }
  bool solve_linear(double, double gamma, const double* known, double* z) override {
    for (std::size_t i = 0; i < n; ++i) z[i] = (known[i] + gamma * 0.5 * k(i)) / (1 + gamma * k(i));
    return true;
  }
  StepLimit stable_step(double, const double*) override { return limit; }
};

std::vector<double> initial(std::size_t n) {
  std::vector<double> y(n);
  for (std::size_t i = 0; i < n; ++i) y[i] = std::cos(0.1 * static_cast<double>(i));
  return y;
}

struct Run {
  double t = 0;
  std::vector<double> y;
  std::vector<StepReport> reports;

  void go(Integrator& integrator, OdeProblem& problem, int steps, double output) {
    const auto fields = test::one_field(y.size(), 1e-5, 1e-5);
    for (int s = 0; s < steps; ++s) {
      const double stop = output * (std::floor(t / output * (1 + 1e-12)) + 1);
      reports.push_back(integrator.step(problem, fields, t, stop, y));
      t = reports.back().t;
    }
  }
};

}  // namespace

TEST_CASE("restart: a restored run repeats the uninterrupted one bit for bit") {
  const auto method = GENERATE(Method::imex, Method::euler, Method::explicit_rk);
  const int order = GENERATE(2, 3);
  IntegratorOptions o;
  o.method = method;
  o.order = order;
  Reaction problem;
  problem.n = 300;
  if (method == Method::explicit_rk) problem.limit.seconds = 0.004;
  Run whole;
  whole.y = initial(problem.n);
  Integrator first(o);
  whole.go(first, problem, 7, 0.037);

  MemoryArchive archive;
  first.archive(archive);
  first.release();
  Run rest;
  rest.t = whole.t;
  rest.y = whole.y;
  whole.go(first, problem, 25, 0.037);

  archive.load();
  Integrator second(o);
  second.archive(archive);
  CHECK(second.counters().steps == 7);
  rest.go(second, problem, 25, 0.037);

  CHECK(rest.t == whole.t);
  CHECK(rest.y == whole.y);
  for (std::size_t s = 0; s < rest.reports.size(); ++s) {
    const StepReport &a = whole.reports[s + 7], &b = rest.reports[s];
    CHECK(a.dt == b.dt);
    CHECK(a.error == b.error);
    CHECK(a.rejected == b.rejected);
    CHECK(a.limiter == b.limiter);
  }
  CHECK(second.proposed_step() == first.proposed_step());
  CHECK(second.counters().implicit_evals == first.counters().implicit_evals);
  CHECK(second.counters().explicit_evals == first.counters().explicit_evals);
}

TEST_CASE("restart: the size of the state may change between steps") {
  const auto method = GENERATE(Method::imex, Method::euler);
  IntegratorOptions o;
  o.method = method;
  o.initial_step = 1e-3;
  Reaction problem;
  Integrator travelled(o);
  for (const std::size_t n : {50, 101, 7, 3000, 400}) {
    problem.n = n;
    Run with_history, fresh;
    with_history.y = fresh.y = initial(n);
    // The same controller state, but new memory in the second one.
    MemoryArchive archive;
    travelled.archive(archive);
    archive.load();
    Integrator blank(o);
    blank.archive(archive);
    with_history.go(travelled, problem, 4, 0.5);
    fresh.go(blank, problem, 4, 0.5);
    CHECK(with_history.y == fresh.y);
    CHECK(with_history.t == fresh.t);
  }
}

TEST_CASE("restart: the number of threads does not change a bit") {
  Reaction problem;
  problem.n = 50000;
  IntegratorOptions o;
  o.order = GENERATE(2, 3);
  const int before = threads();
  Run runs[2];
  for (int k = 0; k < 2; ++k) {
    set_threads(k + 1);
    runs[k].y = initial(problem.n);
    Integrator integrator(o);
    runs[k].go(integrator, problem, 4, 0.5);
  }
  set_threads(before);
  CHECK(runs[0].y == runs[1].y);
  CHECK(runs[0].reports.back().error == runs[1].reports.back().error);
}

TEST_CASE("restart: steps allocate nothing while the size stays") {
  const auto method = GENERATE(Method::imex, Method::euler);
  Reaction problem;
  problem.n = 2000;
  IntegratorOptions o;
  o.method = method;
  Integrator integrator(o);
  const auto fields = test::one_field(problem.n, 1e-7, 1e-7);
  auto y = initial(problem.n);
  double t = 0;
  for (int s = 0; s < 3; ++s) t = integrator.step(problem, fields, t, 10, y).t;
  const long before = allocations;
  for (int s = 0; s < 20; ++s) {
    if (s == 10) problem.limit.seconds = 1e-4;
    t = integrator.step(problem, fields, t, 10, y).t;
  }
  CHECK(allocations == before);
}

}  // namespace meltray
