// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/study/job.hpp"
#include "app/validate/row.hpp"
#include "meltray/core/errors.hpp"

namespace meltray::app::studies {
namespace {

/// A point is shown where its error is this many times what is known of the reference; of chaotic scenes,
/// where only the mean over seeds is compared, once.
constexpr double kReferenceFactor = 100;
/// Steps of the finest points over those of the reference, which is of fourth order; of chaotic scenes only
/// means over seeds are known, and finer steps do not make them more certain.
constexpr double kFiner = 8, kFinerChaotic = 4;

struct Point {
  std::string method;
  double step, error, evaluations, cpu_seconds;
};

/// Work of the cheapest point of a method that is at least this accurate; infinite where there is none.
double cheapest(const std::vector<Point>& points, const std::string& method, double level,
                double Point::*work) {
  double least = INFINITY;
  for (const Point& p : points)
    if (p.method == method && p.error <= level) least = std::min(least, p.*work);
  return least;
}

class Study {
 public:
  explicit Study(const Job& job) : job_(job) {}

  Findings run() {
    std::vector<scene::Overrides> bases;
    for (double spacing : job_.definition.spacings)
      bases.push_back({fmt::format("domain.spacing_m={}", spacing)});
    if (bases.empty()) bases.emplace_back();
    if (job_.small) bases.resize(1);
    for (const scene::Overrides& base : bases) resolution(base);
    return std::move(findings_);
  }

 private:
  void resolution(const scene::Overrides& base) {
    const scene::Scene scene = job_.scene(base);
    const auto variants = method_variants(scene, job_.small || !job_.definition.seeds.empty());
    const auto steps = halved_steps(job_.definition.longest_step, job_.small ? 4 : job_.definition.halvings);
    points_.clear();
    const Reference r = find_reference(scene, base, steps.back());
    if (r.quantities.empty()) return;
    for (const Variant& v : variants) {
      for (double step : steps) point(scene, v, r, base, fixed_step(step), step, 0);
      if (v.name.starts_with("euler") || v.name.starts_with("multirate")) continue;
      for (double factor : job_.small ? std::vector<double>{1} : std::vector<double>{10, 1, 0.1, 0.01})
        point(scene, v, r, base, tolerances(scene, factor), 0, factor);
    }
    conclude(scene.domain.spacing, variants);
  }

  /// One reference judges both projections. That in every stage belongs to the ODE and has a limit for small
  /// steps; the weld, which it does not carry through, is judged by that of its own default.
  Reference find_reference(const scene::Scene& scene, const scene::Overrides& base, double finest) {
    const bool chaotic = !job_.definition.seeds.empty();
    const std::string model = !projects(scene) ? "" : chaotic ? "step" : "stage";
    try {
      return reference(job_, model, base, finest / (chaotic ? kFinerChaotic : kFiner), findings_);
    } catch (const NumericalFailure& e) {
      findings_.conclusions.push_back(
          fmt::format("dx {:.3g}: no reference: {}", scene.domain.spacing, e.what()));
      return {};
    }
  }

  void point(const scene::Scene& scene, const Variant& v, const Reference& r, const scene::Overrides& base,
             const scene::Overrides& control, double step, double factor) {
    const Cell cell = run_seeds(job_, joined(base, joined(v.overrides, control)));
    for (std::size_t q = 0; q < r.quantities.size(); ++q) {
      const double error = cell.finished ? relative_error(cell.quantities[q], r.quantities[q]) : NAN;
      const bool chaotic = !job_.definition.seeds.empty();
      // Of the difference of two means of so many seeds.
      const double known = chaotic ? r.spread[q] * std::sqrt(2.0 / static_cast<double>(job_.seeds()))
                                   : kReferenceFactor * r.uncertainty[q];
      const bool trusted = std::isfinite(error) && error >= known;
      findings_.rows.push_back({{"spacing_m", scene.domain.spacing},
                                {"projection", v.model},
                                {"method", v.name},
                                {"step_s", step},
                                {"tolerance_factor", factor},
                                {"quantity", r.quantities[q].name},
                                {"error", std::isfinite(error) ? Json(error) : Json(nullptr)},
                                {"trusted", trusted},
                                {"evaluations", cell.evaluations},
                                {"solver_iterations", cell.iterations},
                                {"pressure_iterations", cell.pressure_iterations},
                                {"steps", cell.steps},
                                {"rejected", cell.rejected},
                                {"cpu_seconds", cell.cpu_seconds},
                                {"seconds", cell.seconds},
                                {"outcome", cell.finished ? "finished" : failed_term(cell.failure)}});
      if (q == 0 && trusted)
        points_.push_back({v.name, step, error, static_cast<double>(cell.evaluations), cell.cpu_seconds});
    }
  }

  /// Observed orders of the first quantity, and who is cheapest at each level of error, by both measures of
  /// work.
  void conclude(double spacing, const std::vector<Variant>& variants) {
    for (const Variant& v : variants) {
      const Point *coarse = nullptr, *fine = nullptr;
      for (const Point& p : points_)
        if (p.method == v.name && p.step > 0) coarse = std::exchange(fine, &p);
      if (coarse == nullptr || fine == nullptr) continue;
      if (const auto order = observed_order(coarse->error, fine->error, coarse->step / fine->step))
        findings_.conclusions.push_back(
            fmt::format("dx {:.3g}: {}: order {:.2f} from steps of {:.3g} to {:.3g} s", spacing, v.name,
                        *order, coarse->step, fine->step));
    }
    for (int decade = 1; decade <= 9; ++decade) {
      const double level = std::pow(10.0, -decade);
      const auto best = [&](double Point::*work) {
        const Variant* winner = nullptr;
        double least = INFINITY;
        for (const Variant& v : variants)
          if (const double w = cheapest(points_, v.name, level, work); w < least) {
            least = w;
            winner = &v;
          }
        return winner;
      };
      const Variant *by_count = best(&Point::evaluations), *by_time = best(&Point::cpu_seconds);
      if (by_count == nullptr) continue;
      const double count = cheapest(points_, by_count->name, level, &Point::evaluations);
      const double time = cheapest(points_, by_time->name, level, &Point::cpu_seconds);
      findings_.conclusions.push_back(
          by_count == by_time
              ? fmt::format("dx {:.3g}: error {:.0e}: {} wins in both, {} evaluations and {:.3g} s", spacing,
                            level, by_count->name, count, time)
              : fmt::format("dx {:.3g}: error {:.0e}: no winner; {} with {} evaluations, {} with {:.3g} s",
                            spacing, level, by_count->name, count, by_time->name, time));
    }
  }

  const Job& job_;
  Findings findings_;
  std::vector<Point> points_;
};

}  // namespace

Findings work_precision(const Job& job) {
  return Study(job).run();
}

}  // namespace meltray::app::studies
