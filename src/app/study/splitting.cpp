// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "app/study/job.hpp"
#include "app/validate/row.hpp"
#include "meltray/core/errors.hpp"

namespace meltray::app::studies {
namespace {

/// A run of so many steps shows whether a step is stable: just beyond the limit an error grows by a fifth a
/// step.
constexpr int kStableSteps = 100;
/// The largest step that is tried is this share of the scene's time.
constexpr double kLargestShare = 0.1;
/// A stable run keeps within this factor of the reference's largest speed, and this share of its range of
/// temperature.
constexpr double kSpeedBound = 2, kTemperatureBound = 0.1;
/// Share of the largest stable step at which the halvings begin, and the longest run they may take.
constexpr double kFirstStep = 0.7;
constexpr double kMostSteps = 4000;
constexpr int kMostHalvings = 10;
/// What `auto` chooses is as good as the best where it costs at most this share more.
constexpr double kAsGood = 0.1;
/// The reference's step is this much finer than the finest; errors count from this many times what is known
/// of it. (Of a projection once a step it is itself only of first order.)
constexpr double kFiner = 8, kReferenceFactor = 5;

struct Result {
  std::string assignment, model;
  double stable_step = 0;
  bool bounded = false;  // an even larger step might be stable
  std::optional<double> order, error;
  double target_step = 0;  // largest that reaches the target
  double work =
      INFINITY;  // passes over the pairs per simulated time at the target: rates and iterations of solves
  double evaluations = 0, cpu_seconds = 0;  // the same
};

class Study {
 public:
  /// One seed is enough: assignments are compared on one and the same start.
  explicit Study(const Job& job) : job_(job) { job_.definition.seeds.clear(); }

  Findings run() {
    auto strengths = job_.definition.strengths;
    if (strengths.empty()) strengths.push_back({"x1", {}});
    if (job_.small) strengths.resize(1);
    for (const auto& strength : strengths) study(strength);
    return std::move(findings_);
  }

 private:
  void study(const StudyScene::Strength& strength) {
    const scene::Scene scene = job_.scene(strength.overrides);
    std::map<std::string, std::vector<Result>> by_model;
    std::map<std::string, std::optional<Reference>> references;
    const double finest = std::ldexp(job_.definition.longest_step, -job_.definition.halvings);
    for (const Variant& v : splitting_variants(scene)) {
      if (!references.contains(v.model))
        references[v.model] = find_reference(v.model, strength.overrides, finest);
      Result r;
      r.assignment = v.name;
      r.model = v.model;
      const auto overrides = joined(strength.overrides, v.overrides);
      largest_stable_step(scene, overrides, r);
      if (references[v.model] && r.stable_step > 0) accuracy(scene, overrides, *references[v.model], r);
      by_model[v.model].push_back(r);
    }
    for (const auto& [model, results] : by_model) report(strength, scene, results);
  }

  std::optional<Reference> find_reference(const std::string& model, const scene::Overrides& base,
                                          double finest) {
    try {
      const Variant v = reference_variant(job_.scene(base), model);
      bounds_ = job_.run(joined(base, joined(v.overrides, fixed_step(finest))));
      return reference(job_, model, base, finest / kFiner, findings_);
    } catch (const NumericalFailure& e) {
      findings_.conclusions.push_back(fmt::format("{}: {}", model, e.what()));
      return std::nullopt;
    }
  }

  /// Runs `steps` steps or to the scene's end, whichever is sooner.
  Cell short_run(const scene::Scene& scene, const scene::Overrides& overrides, double step) const {
    const double end = std::min(scene.time.end, kStableSteps * step);
    return job_.run(joined(overrides, joined(fixed_step(step), {fmt::format("time.end_s={}", end)})));
  }

  bool stable(const Cell& cell) const {
    const double range = bounds_.highest_temperature - bounds_.lowest_temperature;
    return cell.finished && !(cell.top_speed > kSpeedBound * bounds_.top_speed) &&
           cell.lowest_temperature >= bounds_.lowest_temperature - kTemperatureBound * range - 1e-6 &&
           cell.highest_temperature <= bounds_.highest_temperature + kTemperatureBound * range + 1e-6;
  }

  void largest_stable_step(const scene::Scene& scene, const scene::Overrides& overrides, Result& r) const {
    const auto holds = [&](double step) { return stable(short_run(scene, overrides, step)); };
    double unstable = kLargestShare * scene.time.end, step = unstable;
    for (int tries = 0; !holds(step); ++tries) {
      if (tries == 10) return;
      unstable = step;
      step /= 4;
    }
    r.bounded = step == kLargestShare * scene.time.end;
    while (!r.bounded && unstable > 1.05 * step) {
      const double middle = std::sqrt(step * unstable);
      (holds(middle) ? step : unstable) = middle;
    }
    r.stable_step = step;
  }

  /// Errors over halved steps: the observed order, and what the target costs.
  void accuracy(const scene::Scene& scene, const scene::Overrides& overrides, const Reference& ref,
                Result& r) const {
    const double end = scene.time.end;
    // Stable steps, all of which divide the scene's time.
    const double first = std::min(job_.definition.longest_step, kFirstStep * r.stable_step);
    double coarse_error = 0;
    // At least four halvings, and as many more as the target asks for.
    int halvings = 0;
    for (double step : halved_steps(end / std::ceil(end / first), kMostHalvings)) {
      if (end / step > kMostSteps || (halvings++ > 4 && r.target_step > 0)) break;
      const Cell cell = job_.run(joined(overrides, fixed_step(step)));
      if (!cell.finished) continue;
      const double error = relative_error(cell.quantities[0], ref.quantities[0]);
      const bool known = error >= kReferenceFactor * ref.uncertainty[0];
      if (known && coarse_error > 0) r.order = observed_order(coarse_error, error, 2);
      coarse_error = known ? error : 0;
      if (!r.error) r.error = error;
      if (error <= job_.definition.target && r.target_step == 0) cost(cell, step, end, r);
    }
    // Too many steps to run: stability asks for far smaller steps than accuracy.
    if (end / first > kMostSteps) {
      const Cell cell = short_run(scene, overrides, first);
      cost(cell, first, cell.reached, r);
    }
  }

  static void cost(const Cell& cell, double step, double time, Result& r) {
    r.target_step = step;
    r.evaluations = static_cast<double>(cell.evaluations) / time;
    r.work = static_cast<double>(cell.evaluations + cell.iterations + cell.pressure_iterations) / time;
    r.cpu_seconds = cell.cpu_seconds / time;
  }

  void report(const StudyScene::Strength& strength, const scene::Scene& scene,
              const std::vector<Result>& results) {
    const Result& explicit_one = results.front();  // no term implicit
    const Result* best = nullptr;
    for (const Result& r : results) {
      if (std::isfinite(r.work) && (best == nullptr || r.work < best->work)) best = &r;
      const auto optional = [](const std::optional<double>& x) {
        return x && std::isfinite(*x) ? Json(*x) : Json(nullptr);
      };
      const bool reached = r.target_step > 0;
      const auto if_reached = [&](double x) { return reached ? Json(x) : Json(nullptr); };
      findings_.rows.push_back(
          {{"strength", strength.name},
           {"projection", r.model},
           {"assignment", r.assignment},
           {"order", optional(r.order)},
           {"error_at_first_step", optional(r.error)},
           {"largest_stable_step_s", r.stable_step},
           {"larger_not_tried", r.bounded},
           {"gain_over_all_explicit",
            explicit_one.stable_step > 0 ? Json(r.stable_step / explicit_one.stable_step) : Json(nullptr)},
           {"target_error", job_.definition.target},
           {"step_at_target_s", if_reached(r.target_step)},
           {"evaluations_per_s", if_reached(r.evaluations)},
           {"passes_per_s", if_reached(r.work)},
           {"cpu_seconds_per_s", if_reached(r.cpu_seconds)}});
    }
    if (best == nullptr) {
      findings_.conclusions.push_back(fmt::format("{} {}: no assignment reaches an error of {:.0e}",
                                                  strength.name, results.front().model,
                                                  job_.definition.target));
      return;
    }
    recommend(strength, scene, results, *best);
  }

  /// Compares the best with what "auto" chooses at the step of the best.
  void recommend(const StudyScene::Strength& strength, const scene::Scene& scene,
                 const std::vector<Result>& results, const Result& best) {
    scene::Overrides automatic = joined(strength.overrides, fixed_step(best.target_step));
    automatic.push_back("time.method=imex");
    if (!best.model.empty()) automatic.push_back("splitting.projection=" + best.model);
    scene::Simulation simulation(job_.scene(automatic));
    simulation.step(scene.time.end);
    const std::string chosen = assignment_of(simulation.terms());
    const auto same =
        std::find_if(results.begin(), results.end(), [&](const Result& r) { return r.assignment == chosen; });
    const double excess = same == results.end() ? INFINITY : same->work / best.work - 1;
    findings_.conclusions.push_back(fmt::format(
        "{} {}: recommended for an error of {:.0e}: {} with steps of {:.3g} s; auto chooses {}: {}",
        strength.name, best.model, job_.definition.target, best.assignment, best.target_step, chosen,
        chosen == best.assignment ? "agrees"
        : excess <= kAsGood       ? "agrees, as cheap"
        : std::isfinite(excess)   ? fmt::format("differs, {:.0f} % more passes over the pairs", 100 * excess)
                                  : "differs, and does not reach the error"));
  }

  Job job_;
  Findings findings_;
  Cell bounds_;
};

}  // namespace

Findings splitting(const Job& job) {
  return Study(job).run();
}

}  // namespace meltray::app::studies
