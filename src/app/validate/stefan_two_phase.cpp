// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "app/validate/melting_strip.hpp"

namespace meltray::app {
namespace {

/// Rows of one start temperature over all resolutions, coarse to fine.
void add_rows(const std::string& name, const std::vector<MeltedStrip>& strips, Rows& rows) {
  std::vector<double> scales;
  Rows fronts, liquids, solids, budgets;
  for (const MeltedStrip& s : strips) {
    const Measured how{resolution_text(s.spacing), s.seconds, "Neumann's two-phase similarity solution"};
    scales.push_back(s.spacing);
    fronts.push_back(relative_row(name + ": front [m]", s.front, s.exact_front, 0.02, how));
    liquids.push_back(limit_row(name + ": profile in the liquid, L2", s.liquid, 0.015, how));
    if (s.solid > 0) solids.push_back(limit_row(name + ": profile in the solid, L2", s.solid, 0.015, how));
    budgets.push_back(limit_row(name + ": heat stored = heat from the wall", s.budget, 1e-3, how));
    budgets.back().goal = 1e-6;
  }
  add_series(rows, scales, fronts);
  add_series(rows, scales, liquids);
  add_series(rows, scales, solids);
  rows.insert(rows.end(), budgets.begin(), budgets.end());
}

std::vector<MeltedStrip> over_resolutions(const Setting& setting, double initial, double end,
                                          const std::vector<double>& spacings) {
  std::vector<MeltedStrip> strips;
  for (const double spacing : spacings)
    strips.push_back(melt_strip(setting, spacing, end, {fmt::format("bodies.0.temperature_k={}", initial)}));
  return strips;
}

}  // namespace

Rows stefan_two_phase_iron(const Setting& setting) {
  // The small twin ends at 2.5 ms with 20 um: the front has then passed as many particles as with 40 um at 10
  // ms.
  const double end = setting.small ? 2.5e-3 : 10e-3;
  const std::vector<double> spacings =
      setting.small ? std::vector<double>{4e-5, 2e-5} : std::vector<double>{4e-5, 2e-5, 1e-5};
  Rows rows;
  const auto cold = over_resolutions(setting, 1300, end, spacings);
  add_rows("T_0 = 1300 K", cold, rows);
  if (!setting.small) {
    // Latent heat cannot be stepped over: a step control ten times tighter gives the same front.
    const MeltedStrip& judged = cold.back();
    const MeltedStrip fine = melt_strip(setting, judged.spacing, end,
                                        {"bodies.0.temperature_k=1300", "time.atol_temperature_k=0.5"});
    rows.push_back(relative_row(
        fmt::format("T_0 = 1300 K: front, {} against {} steps [m]", judged.steps, fine.steps), judged.front,
        fine.front, 0.01,
        {resolution_text(fine.spacing), fine.seconds, "the same with a tenth of the error per step"}));
  }
  // At the lower end of the melting band: solid, and within 0.1 K of the melting point.
  add_rows("T_0 = T_m", over_resolutions(setting, 1810.9, end, spacings), rows);
  return rows;
}

Rows stefan_two_phase_aluminium(const Setting& setting) {
  const double end = setting.small ? 2.5e-3 : 10e-3;
  const std::vector<double> spacings =
      setting.small ? std::vector<double>{8e-5, 4e-5} : std::vector<double>{8e-5, 4e-5, 2e-5};
  Rows rows;
  add_rows("T_0 = T_m", over_resolutions(setting, 933.37, end, spacings), rows);
  return rows;
}

}  // namespace meltray::app
