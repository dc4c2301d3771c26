// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "meltray/core/archive.hpp"

namespace meltray {

/// A limit on the step and the name under which it is reported ("acoustic", "capillary", ...).
struct StepLimit {
  double seconds = 1e300;
  std::string_view name = "none";
};

/// One field of the state vector: entries [begin, begin + size) share tolerances. `active` marks the entries
/// that count in the error norm (empty: all). The norm of a state is the largest over fields of the RMS over
/// that field's active entries of e_k / (rtol |y_k| + atol), so that adding entries at rest changes nothing.
struct StateField {
  std::string name;
  std::size_t begin = 0, size = 0;
  double rtol = 1e-3, atol = 1e-6;
  std::vector<std::uint8_t> active;
};

/// y' = f_E(t, y) + f_I(t, y). Rates overwrite `rate`. To reject the step, write NaN into `rate`. Multirate
/// methods take f_E as the fast part and f_I as the slow one, both explicitly.
class OdeProblem {
 public:
  virtual ~OdeProblem() = default;
  virtual bool has_explicit() const { return true; }
  virtual bool has_implicit() const { return true; }
  virtual void explicit_rate(double t, const double* y, double* rate) = 0;
  virtual void implicit_rate(double t, const double* y, double* rate) = 0;
  /// Replaces b by the solution x of (I - gamma J) x = b with J = d f_I / dy at (t, y).
  /// Returns false when the solver does not converge (the step is then retried smaller).
  virtual bool solve_implicit(double t, const double* y, double gamma, double* b) = 0;
  /// True where f_I is linear in y (up to a constant) for the length of a step: stages are then solved by
  /// solve_linear, without Newton's method and without evaluations of f_I.
  virtual bool implicit_is_linear() const { return false; }
  /// Replaces the guess in z by the solution of z - gamma f_I(t, z) = known; called where f_I is linear.
  /// Returns false when the solver does not converge (the step is then retried smaller).
  virtual bool solve_linear(double t, double gamma, const double* known, double* z) {
    (void)t, (void)gamma, (void)known, (void)z;
    return false;
  }
  /// Largest stable step of the explicit part at (t, y), and what sets it.
  virtual StepLimit stable_step(double t, const double* y) = 0;
};

enum class Method { euler, imex, explicit_rk, implicit_rk, multirate };

struct IntegratorOptions {
  Method method = Method::imex;
  int order = 2;          ///< imex 2 to 5, explicit_rk 2 to 5, implicit_rk 2 to 5; multirate 3, 4; euler is 1
  double fixed_step = 0;  ///< > 0: constant step without error control (multirate: the slow step) [s]
  double fast_step = 0;   ///< multirate: largest fast step [s]; 0: stability limit of the fast part
  double initial_step = 0;  ///< first step [s]; 0: chosen from the stability limit
  double max_step = 1e300;  ///< [s]
  double min_step = 1e-14;  ///< below this the run fails: NumericalFailure [s]
  double safety = 0.9;      ///< of the step controller
  double max_growth = 2.0;  ///< from one step to the next
};

/// What one accepted step did.
struct StepReport {
  double t = 0;      ///< time reached [s]
  double dt = 0;     ///< its length [s]
  double error = 0;  ///< weighted norm of the local error estimate (0 without error control)
  int rejected = 0;  ///< attempts thrown away before it
  /// What set dt: a StepLimit name, "error", "growth" (max_growth), "maximum", "output" (cut to end on
  /// t_stop), "fixed", "initial", or "retry" (halved after NaN or a failed implicit solve).
  std::string_view limiter;
};

struct IntegratorCounters {
  std::int64_t steps = 0, rejected = 0, explicit_evals = 0, implicit_evals = 0, linear_solves = 0;
};

/// One-step driver around SUNDIALS ARKODE (explicit methods with its tables in a loop of our own, and
/// forward-backward Euler of our own as the yardstick).
/// It keeps no history besides the proposed next step: each call starts from the y it is given, so the caller
/// may change y, its size and its fields between calls, and a resumed run repeats the steps bit for bit.
class Integrator {
 public:
  explicit Integrator(const IntegratorOptions& options);
  ~Integrator();
  Integrator(Integrator&&) noexcept;
  Integrator& operator=(Integrator&&) noexcept;

  /// Advances y from t by one accepted step that does not pass t_stop (it ends there exactly when near).
  /// `fields` cover y without gaps. Throws NumericalFailure when no step above min_step is accepted.
  StepReport step(OdeProblem& problem, std::span<const StateField> fields, double t, double t_stop,
                  std::vector<double>& y);

  const IntegratorCounters& counters() const;
  /// Bytes of the vectors of a method, y itself left out: before the first step what a y of so many entries
  /// is going to take.
  std::size_t bytes(std::size_t entries) const;
  /// Step that the controller would take next, before stability limits [s].
  double proposed_step() const;
  /// Gives back the memory of the vectors: between steps they hold nothing that is needed.
  void release();
  /// Saves or loads everything that decides the next step (proposed step, controller memory, counters).
  void archive(Archive& a);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// "euler", "imex", "explicit", "implicit", "multirate".
std::string_view name_of(Method m);

}  // namespace meltray
