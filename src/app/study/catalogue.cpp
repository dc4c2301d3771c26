// SPDX-License-Identifier: MIT
#include "app/study/catalogue.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "meltray/core/errors.hpp"
#include "meltray/core/nearest.hpp"

namespace meltray::app::studies {

const std::vector<StudyScene>& study_scenes() {
  static const std::vector<StudyScene> scenes = [] {
    std::vector<StudyScene> all;
    all.push_back(
        {"heat_melting", "heat conduction with melting", heat_quantities, 2e-4, 6, {4e-5, 2e-5}, {}, {}});
    all.push_back({"seam_cooling",
                   "a seam cools after the beam is off",
                   heat_quantities,
                   1e-3,
                   6,
                   {1e-4, 5e-5},
                   {},
                   {}});
    all.push_back(
        {"taylor_green", "decaying vortices, Re 100", flow_quantities, 1e-2, 5, {0.04, 0.02}, {}, {}});
    all.push_back({"interface_shear",
                   "vortices across a layer of strong interface viscosity",
                   flow_quantities,
                   1e-5,
                   5,
                   {5e-5},
                   {},
                   {{"x1", {"flow.interface_viscosity_solid=1"}},
                    {"x50", {"flow.interface_viscosity_solid=50"}},
                    {"x500", {"flow.interface_viscosity_solid=500"}}}});
    all.push_back({"drop", "an oscillating drop", drop_quantities, 8e-6, 5, {5e-5}, {}, {}});
    all.push_back({"marangoni_cavity",
                   "a cavity driven by its surface",
                   convection_quantities,
                   1e-5,
                   5,
                   {5e-5},
                   {},
                   {}});
    all.push_back({"weld", "a short cropped weld", weld_quantities, 4e-6, 3, {5e-5}, {1, 2, 3, 4, 5}, {}});
    all.back().target = 0.1;
    all.push_back({"static_pool", "a pool at rest under recoil", no_quantities, 0, 0, {}, {}, {}});
    all.push_back(
        {"natural_convection", "a closed square heated on one side", no_quantities, 0, 0, {}, {}, {}});
    all.push_back({"dam_break", "a column of water collapses", no_quantities, 0, 0, {}, {}, {}});
    all.push_back({"dam_break_wcsph", "the same with WCSPH", no_quantities, 0, 0, {}, {}, {}});
    return all;
  }();
  return scenes;
}

const StudyScene& study_scene(const std::string& id) {
  std::vector<std::string> known;
  for (const StudyScene& s : study_scenes()) {
    if (s.id == id) return s;
    known.push_back(s.id);
  }
  throw UsageError(fmt::format("study: found '{}'; allowed {}; did you mean '{}'?", id,
                               fmt::join(known, ", "), nearest_name(id, known)));
}

}  // namespace meltray::app::studies
