// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "app/validate/sampling.hpp"
#include "app/validate/scenes.hpp"
#include "app/validate/table.hpp"

namespace meltray::app {
namespace {

/// Early front x* at which both columns have been seen; the times there tell when they were released.
constexpr double kSeen = 1.45, kSeenWithin = 0.05;

struct Trace {
  std::vector<double> time, front;  ///< t* = t sqrt(n^2 g / a), x* = x / a
  double seconds = 0;
};

/// Position of the front along the floor: half a spacing before the foremost particle that is not loose
/// spray.
double front_of(const Particles& p, double spacing) {
  std::vector<double> x;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (p.is_liquid(i) && !p.has(i, kRemoved) && p.x[1][i] < 4 * spacing) x.push_back(p.x[0][i]);
  std::sort(x.begin(), x.end());
  // Spray: gaps wider than the support ahead of the body of the melt.
  std::size_t last = x.size() - 1;
  while (last > 0 && x[last] - x[last - 1] > 2 * spacing) --last;
  return x[last] + 0.5 * spacing;
}

Trace run(const Setting& setting, const scene::Overrides& overrides, double spacing) {
  const Watch watch;
  scene::Overrides all = overrides;
  all.push_back(fmt::format("domain.spacing_m={}", spacing));
  const auto simulation = start(setting, all);
  Trace trace;
  const double end = simulation->scene().time.end;
  advance(*simulation, end, [&] {
    trace.time.push_back(simulation->time() * std::sqrt(2.0));
    trace.front.push_back(front_of(simulation->particles(), spacing));
  });
  trace.seconds = watch.seconds();
  return trace;
}

/// Front at a time, between the steps; NaN after the end.
double at(const Trace& trace, double time) {
  for (std::size_t k = 1; k < trace.time.size(); ++k) {
    if (trace.time[k] < time) continue;
    const double share = (time - trace.time[k - 1]) / (trace.time[k] - trace.time[k - 1]);
    return trace.front[k - 1] + share * (trace.front[k] - trace.front[k - 1]);
  }
  return std::nan("");
}

/// By how much the columns are later than the simulation where the front has come to kSeen: the release of
/// the experiment takes time, and the zero of its clock is not known any better. In t*.
double delay(const Trace& trace, const Table& reference) {
  double sum = 0;
  int points = 0;
  for (std::size_t k = 0; k < reference.rows(); ++k) {
    const double front = reference.number(k, "front");
    if (std::abs(front - kSeen) > kSeenWithin) continue;
    std::size_t n = 1;
    while (n + 1 < trace.front.size() && trace.front[n] < front) ++n;
    const double share = (front - trace.front[n - 1]) / (trace.front[n] - trace.front[n - 1]);
    sum += reference.number(k, "time") - trace.time[n - 1] - share * (trace.time[n] - trace.time[n - 1]);
    ++points;
  }
  return sum / points;
}

/// Mean of |x* / measured - 1| over the points up to `end`, with the simulation begun `late` in t*.
double mean_deviation(const Trace& trace, const Table& reference, double end, double late) {
  double sum = 0;
  int points = 0;
  for (std::size_t k = 0; k < reference.rows(); ++k) {
    const double time = reference.number(k, "time");
    if (time > end) continue;
    sum += std::abs(at(trace, time - late) / reference.number(k, "front") - 1);
    ++points;
  }
  return sum / points;
}

/// Speed of the front between two times, simulated and measured: lines through it at the measured times, for
/// it speeds up at first and the measured points are not spread evenly.
Row speed_row(const std::string& model, const Trace& trace, const Table& reference, double from, double until,
              double tolerance, const Measured& how) {
  std::map<double, double> simulated, measured;
  for (std::size_t k = 0; k < reference.rows(); ++k) {
    const double time = reference.number(k, "time");
    if (time < from || time > until) continue;
    simulated[time] = at(trace, time);
    measured[time] = reference.number(k, "front");
  }
  return relative_row(model + ": mean speed of the front", slope_of_line(simulated), slope_of_line(measured),
                      tolerance, how);
}

}  // namespace

Rows dam_break_martin_moyce(const Setting& setting) {
  const Table reference(setting.folder / "reference.csv");
  const double spacing = setting.small ? 0.05 : 0.025;
  const double end = setting.small ? 1.7 : 5.4;  // of the points that count, in t*
  Rows rows;
  for (const Model& m : collapse_models()) {
    scene::Overrides overrides = m.overrides;
    overrides.push_back(fmt::format("time.end_s={}", end / std::sqrt(2.0) + 0.05));
    const Trace trace = run(setting, overrides, spacing);
    const Measured how{resolution_text(spacing), trace.seconds, reference.source()};
    for (std::size_t k = 0; k < reference.rows(); ++k) {
      const double time = reference.number(k, "time"), measured = reference.number(k, "front");
      if (time > end) continue;
      const double front = at(trace, time);
      Row row = relative_row(
          fmt::format("{}: x* at t* = {:.3f} (a = {} in)", m.name, time, reference.text(k, "column_in")),
          front, measured, 0.05, how);
      row.judged = false;
      rows.push_back(row);
    }
    const double late = delay(trace, reference);
    rows.push_back(limit_row(m.name + ": delay of the columns, t*", late, 0.3, how));
    rows.back().judged = false;
    rows.push_back(limit_row(m.name + ": mean deviation of x* by the simulation's clock",
                             mean_deviation(trace, reference, end, 0), 0.05, how));
    rows.back().judged = !setting.small;
    rows.push_back(limit_row(m.name + ": mean deviation of x* by the columns' clock",
                             mean_deviation(trace, reference, end, late), 0.05, how));
    rows.back().judged = !setting.small;
    rows.push_back(speed_row(m.name, trace, reference, 1.2, setting.small ? 1.65 : 3.0,
                             setting.small ? 0.15 : 0.05, how));
  }
  return rows;
}

}  // namespace meltray::app
