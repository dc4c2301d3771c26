// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/listed_run.hpp"
#include "app/validate/row.hpp"

namespace meltray::app {

/// What a validation case is run with.
struct Setting {
  std::filesystem::path folder;  ///< validation/<id>: case.toml, reference table
  bool small = false;            ///< the twin that takes seconds: coarser or shorter
  std::filesystem::path out;     ///< folder of the runs that are kept (tier 3)
};

struct ValidationCase {
  int tier;  ///< 1 analytic, 2 flow benchmarks, 3 welds against experiment
  const char* id;
  const char* summary;  ///< what is compared, one line
  Rows (*run)(const Setting& setting);
  /// Tier 3: the welds that `run` compares, which must have run before; empty for the small twin.
  std::vector<ListedRun> (*welds)(const Setting& setting) = nullptr;
};

/// Every validation case, cheap and basic ones first.
const std::vector<ValidationCase>& validation_cases();

Rows fresnel_angles(const Setting& setting);
Rows wedge_absorption(const Setting& setting);
Rows gouffe_cavity(const Setting& setting);
Rows stefan_one_phase(const Setting& setting);
Rows stefan_two_phase_iron(const Setting& setting);
Rows stefan_two_phase_aluminium(const Setting& setting);
Rows surface_flux(const Setting& setting);
Rows surface_losses(const Setting& setting);
Rows rosenthal(const Setting& setting);
Rows poiseuille_startup(const Setting& setting);
Rows couette_startup(const Setting& setting);
Rows taylor_green(const Setting& setting);
Rows laplace_drop(const Setting& setting);
Rows oscillating_drop(const Setting& setting);
Rows contact_angle(const Setting& setting);
Rows marangoni_cavity(const Setting& setting);
Rows natural_convection(const Setting& setting);
Rows expansion_convection(const Setting& setting);
Rows gallium_melting(const Setting& setting);
Rows recoil_flat_plate(const Setting& setting);
Rows recoil_spot(const Setting& setting);
Rows hydrostatic(const Setting& setting);
Rows elastic_plate(const Setting& setting);
Rows constrained_expansion(const Setting& setting);
Rows sound_wave(const Setting& setting);
Rows shear_wave(const Setting& setting);
Rows dam_break_martin_moyce(const Setting& setting);
Rows dam_break_lobovsky(const Setting& setting);
Rows absorptance_nist_316l(const Setting& setting);
Rows keyhole_depth_xray(const Setting& setting);
std::vector<ListedRun> absorptance_nist_316l_welds(const Setting& setting);
std::vector<ListedRun> keyhole_depth_xray_welds(const Setting& setting);

}  // namespace meltray::app
