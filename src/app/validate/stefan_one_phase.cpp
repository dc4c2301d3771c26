// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "app/validate/melting_strip.hpp"

namespace meltray::app {

Rows stefan_one_phase(const Setting& setting) {
  constexpr double kFront = 4e-4;  // final X [m]
  const scene::Scene base = scene::read_case(setting.folder / "case.toml");
  const Material& m = base.material;
  const std::vector<double> numbers =
      setting.small ? std::vector<double>{1} : std::vector<double>{0.041, 0.1, 0.5, 1, 2, 2.85};
  const std::vector<double> per_front =
      setting.small ? std::vector<double>{10, 20} : std::vector<double>{10, 20, 40};
  Rows rows;
  for (const double stefan : numbers) {
    // St = c (T_w - T_m) / L
    const double excess = stefan * m.latent_heat_fusion / m.heat_capacity_liquid;
    Neumann exact = neumann(base, melting_point(m));
    exact.wall = exact.melting + excess;
    const double end = std::pow(kFront / (2 * exact.lambda()), 2) / exact.diffusivity_liquid();
    const std::string name = fmt::format("St {}", stefan);
    std::vector<double> scales;
    Rows fronts, profiles, budgets;
    for (const double count : per_front) {
      const MeltedStrip s = melt_strip(setting, kFront / count, end,
                                       {fmt::format("faces.x_min.temperature_k={}", exact.wall),
                                        fmt::format("time.atol_temperature_k={}", 5e-3 * excess)});
      const Measured how{fmt::format("X/dx {}", count), s.seconds, "Stefan's similarity solution"};
      scales.push_back(s.spacing);
      fronts.push_back(relative_row(name + ": front [m]", s.front, s.exact_front, 0.02, how));
      fronts.back().goal = 0.005;
      profiles.push_back(limit_row(name + ": profile in the liquid, L2", s.liquid, 0.015, how));
      budgets.push_back(limit_row(name + ": heat stored = heat from the wall", s.budget, 1e-3, how));
    }
    add_series(rows, scales, fronts);
    add_series(rows, scales, profiles);
    rows.insert(rows.end(), budgets.begin(), budgets.end());
  }
  return rows;
}

}  // namespace meltray::app
