// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "app/doubtful_settings.hpp"
#include "app/known_limits.hpp"
#include "app/run_estimate.hpp"
#include "meltray/app/commands.hpp"
#include "meltray/core/constants.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/core/parallel.hpp"
#include "meltray/scene/case_file.hpp"
#include "meltray/scene/elastic.hpp"
#include "meltray/scene/expected_flow.hpp"
#include "meltray/scene/optics.hpp"
#include "meltray/scene/presets.hpp"
#include "meltray/scene/simulation.hpp"

namespace meltray::app {
namespace {

using scene::Scene;
using scene::Simulation;

/// Speed of melt in a developed weld pool, for limits and estimates before there is one [m/s].
constexpr double kPoolSpeed = 5;
/// Resident size of a run without particles to speak of [MB].
constexpr double kProgramMegabytes = 24;

bool is_inside(const scene::Body& b, const Vec3& x, int dim, double slack) {
  double r2 = 0;
  for (int c = 0; c < dim; ++c) {
    if (b.shape == scene::ShapeKind::box && (x[c] < b.min[c] - slack || x[c] > b.max[c] + slack))
      return false;
    if (b.shape == scene::ShapeKind::ball) r2 += std::pow((x[c] - b.center[c]) / (b.radii[c] + slack), 2);
  }
  return r2 <= 1;
}

void print_terms(const Simulation& simulation) {
  heading("terms: partition, or why skipped");
  for (const auto& term : simulation.terms()) line(term.name, term.partition);
}

void print_particles(const Simulation& simulation) {
  heading("particles");
  const Scene& s = simulation.scene();
  const Particles& p = simulation.particles();
  const double slack = s.domain.jitter * s.domain.spacing;
  std::vector<std::size_t> count(s.domain.bodies.size(), 0);
  std::size_t dummies = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_wall(i)) {
      ++dummies;
      continue;
    }
    Vec3 x = Vec3::Zero();
    for (int c = 0; c < p.dim; ++c) x[c] = p.x[c][i];
    // Later bodies replace earlier ones; jittered particles may stand a little outside.
    for (const double tolerance : {0.0, slack}) {
      auto b = count.size();
      while (b > 0 && !is_inside(s.domain.bodies[b - 1], x, p.dim, tolerance)) --b;
      if (b == 0) continue;
      ++count[b - 1];
      break;
    }
  }
  line("all", fmt::format("{}", p.size()));
  for (std::size_t b = 0; b < count.size(); ++b)
    line(fmt::format("body {} ({})", b, s.domain.bodies[b].shape == scene::ShapeKind::box ? "box" : "ball"),
         fmt::format("{} at {:g} K", count[b], s.domain.bodies[b].temperature));
  line("wall dummies", fmt::format("{}", dummies));
  line("liquid at t = 0", fmt::format("{}", simulation.liquid_count()));
  line("in the state vector at t = 0", fmt::format("{}", simulation.active_count()));
}

/// What a run takes at most with the particles of its start. A checkpoint stands in memory before it is
/// written, in place of the lists and fields of the steps.
void print_memory(const Simulation& simulation) {
  heading("memory with the particles of t = 0 [MB]");
  std::map<std::string, double> mega;
  double sum = kProgramMegabytes;
  line("program and libraries", fmt::format("{:.1f}", kProgramMegabytes));
  for (const auto& [name, bytes] : simulation.memory()) {
    mega[name] = bytes / 1e6;
    sum += mega[name];
    line(name, fmt::format("{:.1f}", mega[name]));
  }
  const double file = mega["particles"], given_back = mega["patch and stage"] + mega["pair lists"] +
                                                      mega["acoustic pass"] + mega["bulk conduction"] +
                                                      mega["state vectors"];
  line("a checkpoint before it is written", fmt::format("{:.1f}", file));
  const double peak = sum + std::max(0.0, file - given_back);
  line("at most", fmt::format("{:.0f}, {:.0f} bytes per particle", peak,
                              1e6 * peak / static_cast<double>(simulation.particles().size())));
}

struct Limit {
  std::string name;
  double seconds;
};

/// Limit of elastic solid at rest [s].
double elastic_step(const Scene& s) {
  return s.time.cfl_acoustic * s.domain.smoothing_ratio * s.domain.spacing /
         scene::elastic_solid(s).acoustic_speed(s.material.density);
}

/// Limits of a pool that is not there yet; explicit terms as if they were explicit, with coefficients at h:
/// Morris et al. 1997, 0.25 sqrt(rho h^3/(2 pi sigma)) and 0.125 h^2/nu, with the case's own Courant numbers.
std::vector<Limit> developed_limits(const Scene& s) {
  const Material& m = s.material;
  const double h = s.domain.smoothing_ratio * s.domain.spacing;
  std::vector<Limit> out;
  const auto viscous = [h](double nu) { return 0.125 * h * h / nu; };
  const bool weak = s.terms.pressure && s.flow.solver == scene::FlowSolver::wcsph;
  if (weak) {
    const double alpha = s.terms.artificial_viscosity ? s.flow.artificial_viscosity : 0.0;
    out.push_back(
        {"acoustic", s.time.cfl_acoustic * h / (s.flow.sound_speed * (1 + 0.6 * alpha) + kPoolSpeed)});
  }
  if (scene::is_elastic(s)) out.push_back({"elastic", elastic_step(s)});
  if (s.terms.pressure) out.push_back({"advective", s.time.cfl_advective * h / kPoolSpeed});
  if (s.terms.surface_tension)
    out.push_back({"capillary", s.time.cfl_capillary * std::sqrt(m.density * h * h * h /
                                                                 (2 * constants::pi * m.sigma(m.liquidus)))});
  if (s.terms.interface_viscosity) {
    const double alpha = std::max(s.flow.interface_viscosity_free, s.flow.interface_viscosity_solid);
    const double nu = alpha * h * s.flow.reference_speed / (2 * (s.domain.dimension + 2));
    out.push_back({"interface viscosity, if explicit", viscous(nu)});
  }
  if (s.terms.viscosity)
    out.push_back({"viscosity, if explicit", viscous(m.viscosity(m.liquidus) / m.density)});
  if (s.terms.conduction) out.push_back({"conduction, if explicit", viscous(m.thermal_diffusivity_max())});
  if (s.laser && s.laser->beam.feed > 0)
    out.push_back({"beam", s.time.beam_travel * 0.5 * s.laser->beam.focal_diameter / s.laser->beam.feed});
  return out;
}

/// Prints limits, shortest first, and returns the shortest of those that bind whatever the partition.
double print_limits(const char* title, std::vector<Limit> limits) {
  heading(title);
  std::sort(limits.begin(), limits.end(),
            [](const Limit& a, const Limit& b) { return a.seconds < b.seconds; });
  double binding = 0;
  for (const Limit& l : limits) {
    const bool optional = l.name.find("if explicit") != std::string::npos;
    const bool binds = binding == 0 && !optional;
    if (binds) binding = l.seconds;
    line(l.name, fmt::format("{:.3g}{}", l.seconds, binds ? "   <- binds" : ""));
  }
  if (limits.empty()) line("none", "error control or time.max_step_s sets the step");
  return binding;
}

void print_derived(const Scene& s) {
  heading("derived numbers");
  const scene::Domain& d = s.domain;
  const Material& m = s.material;
  const double h = d.smoothing_ratio * d.spacing;
  int neighbours = 0;
  const int reach = static_cast<int>(std::ceil(2 * d.smoothing_ratio));
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j)
      for (int k = d.dimension == 3 ? -reach : 0; k <= (d.dimension == 3 ? reach : 0); ++k)
        neighbours += i * i + j * j + k * k < 4 * d.smoothing_ratio * d.smoothing_ratio;
  line("smoothing length h [m]", fmt::format("{:.4g}", h));
  line("support radius 2h [m]", fmt::format("{:.4g}", 2 * h));
  line("lattice neighbours", fmt::format("{}", neighbours - 1));
  line("thermal diffusivity [m^2/s]", fmt::format("{:.3g}", m.thermal_diffusivity_max()));
  if (s.laser && s.laser->beam.feed > 0)
    line("Peclet number, feed and spot radius",
         fmt::format("{:.3g}",
                     s.laser->beam.feed * 0.5 * s.laser->beam.focal_diameter / m.thermal_diffusivity_max()));
  if (s.terms.recoil && s.surface.recoil_pressure == 0) {
    const double p = s.surface.recoil_coefficient * m.saturation_pressure(m.boiling_temperature);
    line("recoil pressure at T_b [Pa]", fmt::format("{:.4g}", p));
    line("recoil velocity sqrt(2 p/rho) [m/s]", fmt::format("{:.3g}", std::sqrt(2 * p / m.density)));
  }
  if (s.laser && s.terms.surface_tension)
    line("sigma / spot radius [Pa]",
         fmt::format("{:.4g}", m.sigma(m.liquidus) / (0.5 * s.laser->beam.focal_diameter)));
}

/// Why the sound speed is what it is, and what it costs.
void print_compressibility(const Scene& s) {
  if (!s.terms.pressure || s.flow.solver != scene::FlowSolver::wcsph) return;
  heading("weak compressibility");
  const double rho = s.material.density, c = s.flow.sound_speed;
  const double speed = scene::expected_speed(s), pressure = scene::expected_pressure(s);
  line("sound speed [m/s]", fmt::format("{:.4g}", c));
  line("expected speed [m/s]", fmt::format("{:.3g}, Mach {:.3g}", speed, speed / c));
  line("expected pressure [Pa]", fmt::format("{:.4g}", pressure));
  const double variation = std::max(pressure / (rho * c * c), speed * speed / (c * c));
  line("expected density variation", fmt::format("{:.2g} %{}", 100 * variation,
                                                 variation > scene::DensityVariation::kAllowed
                                                     ? ", more than 3 %: raise flow.sound_speed_m_s"
                                                     : ""));
  line("sound speed for 1 % [m/s]",
       fmt::format("{:.3g}; steps shrink with its inverse", scene::default_sound_speed(s)));
}

/// What the modulus of elastic solid costs in steps, and what a softer one means.
void print_elastic(const Scene& s) {
  if (!scene::is_elastic(s)) return;
  heading("elastic solid");
  const terms::ElasticSolid solid = scene::elastic_solid(s);
  const double rho = s.material.density, scale = s.flow.elastic_modulus_scale, step = elastic_step(s);
  line("K, G [Pa]", fmt::format("{:.4g}, {:.4g}", solid.bulk_modulus, solid.shear_modulus));
  line("longitudinal sound [m/s]", fmt::format("{:.4g}", solid.sound_speed(rho)));
  line("elastic step [s]", fmt::format("{:.3g}", step));
  if (scale < 1)
    line("modulus scale",
         fmt::format("{:g}: steps {:.3g} times those of the full modulus ({:.3g} s), strains "
                     "under load {:.3g} times; stresses are not the material's",
                     scale, 1 / std::sqrt(scale), step * std::sqrt(scale), 1 / scale));
  else
    line("modulus scale",
         "1; 0.01 would make steps ten times longer and strains under load 100 times larger");
}

void print_laser(const Scene& s) {
  if (!s.laser) return;
  heading("laser");
  const laser::BeamSpec& b = s.laser->beam;
  const laser::TraceOptions& t = s.laser->trace;
  line("power [W]",
       b.modulation == laser::Modulation::sine    ? fmt::format("{:g} + {:g} sin(2 pi {:g} Hz t + {:g} deg)",
                                                                b.power, b.amplitude, b.frequency, b.phase_deg)
       : b.modulation == laser::Modulation::table ? fmt::format("table of {} rows", b.table.size())
                                                  : fmt::format("{:g}", b.power));
  line("profile", fmt::format("{}, focal diameter {:g} m, focus at z = {:g} m",
                              b.profile == laser::Profile::gaussian ? "gaussian" : "top-hat",
                              b.focal_diameter, b.focus_z));
  line("Rayleigh length [m]",
       b.rayleigh_length < 1e299 ? fmt::format("{:g}", b.rayleigh_length) : "no divergence");
  line("incidence [deg], feed [m/s]", fmt::format("{:g}, {:g}", b.incidence_deg, b.feed));
  if (t.fixed_absorptance)
    line("absorptance", fmt::format("{:g} at every bounce", *t.fixed_absorptance));
  else
    line("absorptance at normal incidence",
         fmt::format("solid {:.3f}, liquid {:.3f} (Fresnel, optics {})",
                     laser::absorptance(scene::laser_index(s).solid, 1),
                     laser::absorptance(scene::laser_index(s).liquid, 1), scene::name_of(s.laser->optics)));
  line("rays, retrace at latest every [s]",
       fmt::format("{}{}, {:g}", t.rays,
                   t.ray_error > 0 ? fmt::format(" or as many as an error of {:g} takes", t.ray_error) : "",
                   s.laser->retrace_interval));
}

void print_warnings(const char* title, const std::vector<std::string>& found) {
  if (found.empty()) return;
  heading(title);
  for (const std::string& text : found) fmt::print("  {}\n", text);
}

}  // namespace

int check(const std::filesystem::path& case_file, const std::vector<std::string>& set) {
  const Scene scene = scene::read_case(case_file, set);
  Simulation simulation(scene);
  heading("resolved case");
  fmt::print("{}", scene::write_case(scene));
  heading("model");
  line("row of Table 1", scene::row_of_table(scene));
  std::vector<Limit> limits;
  for (const StepLimit& l : simulation.step_limits()) limits.push_back({std::string(l.name), l.seconds});
  print_terms(simulation);
  print_particles(simulation);
  print_memory(simulation);
  double step = print_limits("step limits at t = 0 [s]", std::move(limits));
  if (simulation.liquid_count() == 0 && scene.terms.melting) {
    const std::string title =
        fmt::format("step limits with a developed pool, melt at {:g} m/s [s] (estimated)", kPoolSpeed);
    const double developed = print_limits(title.c_str(), developed_limits(scene));
    if (developed > 0) step = step > 0 ? std::min(step, developed) : developed;
  }
  print_derived(scene);
  print_compressibility(scene);
  print_elastic(scene);
  print_laser(scene);
  print_run_time(simulation, step);
  print_warnings("warning: hardly meant", doubtful_settings(scene));
  print_warnings("warning: beyond what validation/studies found stable", beyond_known_limits(scene));
  return kExitOk;
}

}  // namespace meltray::app
