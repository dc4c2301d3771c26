// SPDX-License-Identifier: MIT
#include "meltray/scene/expected_flow.hpp"
#include "scene/keys_build.hpp"

namespace meltray::scene {

Need solved_by(FlowSolver solver) {
  const char* name = solver == FlowSolver::isph ? "isph" : "wcsph";
  return {std::string("flow.solver = \"") + name + "\"",
          {"flow.solver", "model"},
          [solver](const Scene& s, int) { return s.flow.solver == solver; }};
}

std::vector<Key> solver_keys() {
  const Need pressure = term("pressure", &Terms::pressure);
  const Need wcsph = solved_by(FlowSolver::wcsph);
  const Need diffusing = {
      "flow.density_diffusion other than \"none\"", {"flow.density_diffusion"}, [](const Scene& s, int) {
        return s.flow.density_diffusion != DensityDiffusion::none;
      }};
  Key solid = word<SolidModel>("flow.solid", {{"fixed", SolidModel::fixed}, {"elastic", SolidModel::elastic}},
                               MELTRAY_AT(flow.solid),
                               "Solid that rests where it is, or a thermoelastic one, Eq. (9).");
  return {
      of_row(word<FlowSolver>("flow.solver", {{"isph", FlowSolver::isph}, {"wcsph", FlowSolver::wcsph}},
                              MELTRAY_AT(flow.solver),
                              "Pressure from a projection, Eq. (6), or from an equation of state, Eq. (5)."),
             "isph", &Preset::solver, MELTRAY_AT(flow.solver))
          .only_if(pressure),
      of_row(std::move(solid), "fixed", &Preset::solid, MELTRAY_AT(flow.solid)).only_if(pressure),
      number("flow.sound_speed_m_s", "m/s", at_least(0), MELTRAY_AT(flow.sound_speed),
             "Numerical speed of sound: density varies by p / (rho c^2), steps shrink with 1 / c.")
          .otherwise("ten times the speeds that the scene implies",
                     [](Scene& s, int, const Document&) { s.flow.sound_speed = default_sound_speed(s); })
          .only_if(wcsph),
      of_row(boolean("flow.thermal_expansion", MELTRAY_AT(flow.thermal_expansion),
                     "Reference density follows the temperature, Eq. (7); replaces terms.buoyancy."),
             "false", &Preset::thermal_expansion, MELTRAY_AT(flow.thermal_expansion))
          .only_if(wcsph),
      word<GradientForm>(
          "flow.pressure_gradient", {{"difference", GradientForm::difference}, {"sum", GradientForm::sum}},
          MELTRAY_AT(flow.pressure_gradient),
          "Pressure gradient inside the melt: differences, at rest under uniform pressure "
          "whatever the disorder, or sums as in Eq. (3), which conserve momentum pair by pair.")
          .only_if(wcsph),
      word<Tension>("flow.tension",
                    {{"full", Tension::full},
                     {"none", Tension::none},
                     {"artificial_stress", Tension::artificial_stress}},
                    MELTRAY_AT(flow.tension),
                    "Negative pressure: as it is, counted as zero, or with the repulsion of Monaghan 2000.")
          .only_if(wcsph),
      word<DensityDiffusion>("flow.density_diffusion",
                             {{"antuono", DensityDiffusion::antuono},
                              {"molteni_colagrossi", DensityDiffusion::molteni_colagrossi},
                              {"none", DensityDiffusion::none}},
                             MELTRAY_AT(flow.density_diffusion),
                             "Diffusion of density noise: less the linear profile (antuono), or all of it.")
          .only_if(wcsph),
      number("flow.density_diffusion_coefficient", "", above_to(0, 0.5),
             MELTRAY_AT(flow.diffusion_coefficient), "Coefficient delta of the density diffusion.")
          .only_if(wcsph)
          .only_if(diffusing),
      number("flow.artificial_viscosity", "", above_to(0, 2), MELTRAY_AT(flow.artificial_viscosity),
             "Coefficient alpha of the artificial viscosity; 1 is of the strength of interface viscosity.")
          .only_if({"terms.artificial_viscosity = true",
                    {"terms.artificial_viscosity", "model"},
                    [](const Scene& s, int) { return s.terms.artificial_viscosity; }}),
  };
}

}  // namespace meltray::scene
