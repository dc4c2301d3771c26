// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "app/repository.hpp"
#include "meltray/app/commands.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/core/nearest.hpp"
#include "meltray/materials/material.hpp"
#include "meltray/scene/case_file.hpp"

namespace meltray::app {

namespace {

using Lines = std::vector<std::pair<std::string, std::string>>;

/// The case files that come with the program; a file without a title is a base that others include.
Lines cases() {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path folder = repository_folder("cases", "MELTRAY_CASES");
  if (const fs::path near = fs::proximate(folder); *near.begin() != "..") folder = near;
  std::vector<fs::path> files;
  for (const auto& item : fs::directory_iterator(folder, error))
    if (item.path().extension() == ".toml") files.push_back(item.path());
  std::sort(files.begin(), files.end());
  Lines lines;
  for (const fs::path& file : files) {
    try {
      if (const std::string title = scene::case_title(file); !title.empty())
        lines.emplace_back(file.string(), title);
    } catch (const UsageError& e) {
      lines.emplace_back(file.string(), fmt::format("cannot be read: {}", e.what()));
    }
  }
  if (lines.empty()) lines.emplace_back("(none)", fmt::format("no case files in {}", folder.string()));
  return lines;
}

Lines materials() {
  Lines lines;
  for (const std::string& name : material_names()) lines.emplace_back(name, material_summary(name));
  return lines;
}

/// Equations are those of the paper; "auto" is decided by the stiffness of the term and can be set in
/// [splitting].
Lines terms() {
  return {
      {"conduction", "Eq. (4), heat conduction; enthalpy; auto"},
      {"viscosity", "Eq. (3), physical viscosity of the melt; velocity; auto"},
      {"interface_viscosity", "sect. 2.2.2, viscosity at free surface and solid; velocity; auto"},
      {"artificial_viscosity", "sect. 2.2.2, between particles that approach, WCSPH; velocity; explicit"},
      {"pressure",
       "Eq. (6), incompressible projection; velocity; after each step (or in every stage). Or Eqs. (2), (5), "
       "equation "
       "of state: WCSPH, flow.solver = \"wcsph\"; velocity, density; explicit"},
      {"flow.density_diffusion", "Eq. (2) of WCSPH, diffusion of density noise; density; explicit"},
      {"flow.thermal_expansion", "Eq. (7) of WCSPH, reference density over temperature; density; explicit"},
      {"flow.solid", "Eq. (9), \"elastic\": thermoelastic solid; stress, density, velocity; explicit"},
      {"flow.least_distance",
       "beside Eq. (6): melt at the surface that must not overlap; position; between steps"},
      {"flow.shifting", "keeps particles evenly spread; position, velocity; explicit"},
      {"surface_tension", "sect. 2.1, continuum surface force or surface pressure; velocity; explicit"},
      {"marangoni", "sect. 2.1, force along the surface where tension changes with T; velocity; explicit"},
      {"wetting", "sect. 2.1, contact angle on the solid; normal of the surface; explicit"},
      {"recoil", "sect. 2.1, recoil pressure of the vapour; velocity; explicit"},
      {"evaporation", "Eq. (4), q_r: heat lost with the vapour; enthalpy; auto"},
      {"radiation", "Eq. (4), q_r: heat radiated; enthalpy; with evaporation"},
      {"buoyancy", "Eq. (8), Boussinesq; velocity; explicit"},
      {"gravity", "Eq. (3), a_g; velocity; explicit"},
      {"melting", "sect. 2, melting and solidification; phase; between steps"},
      {"[laser]",
       "Eq. (4), q_s: traced rays with Fresnel absorption; enthalpy; explicit, frozen over a step"},
  };
}

Lines methods() {
  return {
      {"imex", "implicit-explicit Runge-Kutta (ARKODE), order 2 to 5; the default, with order 2"},
      {"explicit", "explicit Runge-Kutta (ARKODE), order 2 to 5"},
      {"implicit", "diagonally implicit Runge-Kutta (ARKODE), order 2 to 5"},
      {"multirate",
       "conduction in fixed slow steps, the flow in explicit fast ones (ARKODE MRIStep), order 3 and 4"},
      {"euler", "forward-backward Euler, order 1: the classical scheme"},
  };
}

Lines kernels() {
  return {
      {"wendland_c2", "Wendland C2, support of two smoothing lengths; the default"},
      {"cubic_spline", "cubic spline, support of two smoothing lengths"},
  };
}

void print(const Lines& lines) {
  std::size_t width = 0;
  for (const auto& [name, text] : lines) width = std::max(width, name.size());
  for (const auto& [name, text] : lines) fmt::print("  {:<{}}  {}\n", name, width, text);
}

}  // namespace

int list(const std::string& what) {
  if (what == "keys") {  // the reference page, cases/KEYS.md, is this output
    fmt::print("{}", scene::key_reference());
    return kExitOk;
  }
  const std::vector<std::pair<std::string, Lines (*)()>> topics = {{"cases", cases},
                                                                   {"materials", materials},
                                                                   {"terms", terms},
                                                                   {"methods", methods},
                                                                   {"kernels", kernels}};
  std::vector<std::string> names;
  for (const auto& [name, lines] : topics) names.push_back(name);
  names.emplace_back("keys");
  if (!what.empty() && std::find(names.begin(), names.end(), what) == names.end())
    throw UsageError(fmt::format(
        "list: found '{}'; allowed cases, materials, terms, methods, kernels, keys; did you mean '{}'?", what,
        nearest_name(what, names)));
  for (const auto& [name, lines] : topics) {
    if (!what.empty() && what != name) continue;
    fmt::print("{}\n", name);
    print(lines());
  }
  return kExitOk;
}

}  // namespace meltray::app
