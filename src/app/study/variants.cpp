// SPDX-License-Identifier: MIT
#include "app/study/variants.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "meltray/scene/simulation.hpp"

namespace meltray::app::studies {
namespace {

/// Terms that can stand on either side, as [splitting] calls them.
std::vector<std::string> stiff_terms(const scene::Scene& s) {
  std::vector<std::string> out;
  if (s.terms.conduction) out.emplace_back("conduction");
  if (s.terms.viscosity) out.emplace_back("viscosity");
  if (s.terms.interface_viscosity) out.emplace_back("interface_viscosity");
  if (s.terms.evaporation || s.terms.radiation) out.emplace_back("evaporation");
  return out;
}

/// Models of a scene: with a projected pressure one for each projection.
std::vector<std::string> models(const scene::Scene& s) {
  if (!projects(s)) return {""};
  return {"step", "stage"};
}

scene::Overrides assign(const std::vector<std::string>& terms, const char* side) {
  scene::Overrides out;
  for (const std::string& term : terms) out.push_back(fmt::format("splitting.{}={}", term, side));
  return out;
}

Variant variant(const std::string& method, int order, const std::string& model,
                const scene::Overrides& sides) {
  Variant v{method == "euler" ? method : fmt::format("{} {}", method, order), model, sides};
  if (!model.empty()) {
    v.name += ", " + model;
    v.overrides.push_back("splitting.projection=" + model);
  }
  v.overrides.push_back("time.method=" + method);
  v.overrides.push_back(fmt::format("time.order={}", order));
  return v;
}

}  // namespace

bool projects(const scene::Scene& s) {
  return s.terms.pressure && s.flow.solver == scene::FlowSolver::isph;
}

std::vector<Variant> method_variants(const scene::Scene& s, bool few) {
  const auto terms = stiff_terms(s);
  std::vector<Variant> out;
  for (const std::string& model : models(s)) {
    if (!s.terms.pressure || projects(s))  // Euler's steps amplify sound
      out.push_back(variant("euler", 1, model, assign(terms, "implicit")));
    for (int order = 2; order <= 5; ++order) {
      if (!few || order % 2 == 0) out.push_back(variant("imex", order, model, assign(terms, "implicit")));
      if (!few || order == 2) out.push_back(variant("explicit", order, model, assign(terms, "explicit")));
      // A fully implicit method has no place for a pressure, which is eliminated explicitly.
      if (!s.terms.pressure && !s.laser && (!few || order == 2))
        out.push_back(variant("implicit", order, model, assign(terms, "implicit")));
      // Multirate needs something slow and, where there is a pressure, one that belongs to the ODE.
      if (s.terms.conduction && model != "step" && (order == 3 || (order == 4 && !few)))
        out.push_back(variant("multirate", order, model, {}));
    }
  }
  return out;
}

std::vector<Variant> splitting_variants(const scene::Scene& s) {
  const auto terms = stiff_terms(s);
  std::vector<Variant> out;
  for (const std::string& model : models(s)) {
    for (std::size_t mask = 0; mask < (std::size_t{1} << terms.size()); ++mask) {
      scene::Overrides sides;
      std::vector<std::string> implicit;
      for (std::size_t k = 0; k < terms.size(); ++k) {
        const bool in = (mask >> k & 1) != 0;
        sides.push_back(fmt::format("splitting.{}={}", terms[k], in ? "implicit" : "explicit"));
        if (in) implicit.push_back(terms[k]);
      }
      Variant v = variant("imex", 2, model, sides);
      v.name = implicit.empty() ? "all explicit" : fmt::format("implicit {}", fmt::join(implicit, " + "));
      out.push_back(std::move(v));
    }
    if (s.terms.conduction && model != "step") {
      out.push_back(variant("multirate", 3, model, {}));
      out.back().name = "slow conduction (multirate 3)";
    }
  }
  return out;
}

std::string assignment_of(const std::vector<scene::TermInfo>& terms) {
  std::vector<std::string> implicit;
  for (const scene::TermInfo& term : terms) {
    if (!term.active || !term.partition.starts_with("implicit")) continue;
    const std::string name = term.name == "radiation" ? "evaporation" : term.name;
    if (std::find(implicit.begin(), implicit.end(), name) == implicit.end()) implicit.push_back(name);
  }
  return implicit.empty() ? "all explicit" : fmt::format("implicit {}", fmt::join(implicit, " + "));
}

scene::Overrides fixed_step(double step) {
  return {fmt::format("time.fixed_step_s={}", step)};
}

scene::Overrides tolerances(const scene::Scene& s, double factor) {
  scene::Overrides all = {"time.fixed_step_s=0",
                          fmt::format("time.rtol={}", std::min(0.5, factor * s.time.rtol)),
                          fmt::format("time.atol_position={}", factor * s.time.atol_position),
                          fmt::format("time.atol_velocity_m_s={}", factor * s.time.atol_velocity),
                          fmt::format("time.atol_temperature_k={}", factor * s.time.atol_temperature)};
  if (s.flow.solver == scene::FlowSolver::wcsph)
    all.push_back(fmt::format("time.atol_density={}", factor * s.time.atol_density));
  return all;
}

Variant reference_variant(const scene::Scene& s, const std::string& model) {
  return variant("imex", model == "step" ? 2 : 4, model, assign(stiff_terms(s), "implicit"));
}

scene::Overrides joined(scene::Overrides a, const scene::Overrides& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace meltray::app::studies
