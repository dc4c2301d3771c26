// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "app/validate/cases.hpp"
#include "app/validate/optics.hpp"
#include "app/validate/scenes.hpp"
#include "app/validate/table.hpp"
#include "meltray/core/constants.hpp"

namespace meltray::app {
namespace {

constexpr double kDegree = constants::pi / 180;
constexpr std::array<int, 9> kAngles = {0, 45, 60, 70, 75, 80, 84, 86, 88};

double at_degrees(std::complex<double> index, double degrees) {
  return laser::absorptance(index, std::cos(degrees * kDegree));
}

/// Angle of the largest absorptance [deg], by golden section between 60 and 89.9 degrees.
double peak_angle(std::complex<double> index) {
  const double g = 0.5 * (std::sqrt(5.0) - 1);
  double a = 60, b = 89.9;
  while (b - a > 1e-6) {
    const double c = b - g * (b - a), d = a + g * (b - a);
    if (at_degrees(index, c) > at_degrees(index, d))
      b = d;
    else
      a = c;
  }
  return 0.5 * (a + b);
}

void formula(const Table& table, Rows& rows) {
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const std::complex<double> index(table.number(r, "n"), table.number(r, "k"));
    const Measured how{"", 0, table.source()};
    const std::string metal = table.text(r, "metal");
    Row worst;
    for (const int angle : kAngles) {
      const double reference = table.number(r, fmt::format("a{}", angle));
      const Row row = absolute_row(fmt::format("{}: formula, worst of 9 angles", metal),
                                   at_degrees(index, angle), reference, 1e-3, how);
      if (worst.quantity.empty() || row.error > worst.error) worst = row;
    }
    rows.push_back(worst);
    const double peak = peak_angle(index);
    rows.push_back(absolute_row(metal + ": peak absorptance", at_degrees(index, peak),
                                table.number(r, "peak"), 1e-3, how));
    rows.push_back(
        absolute_row(metal + ": angle of the peak [deg]", peak, table.number(r, "peak_deg"), 0.1, how));
  }
}

/// Slab of particles below z = 0, each moved by up to 0.15 spacings.
Cloud rough_plate(double spacing) {
  Cloud cloud;
  cloud.spacing = spacing;
  Noise noise;
  const int nx = static_cast<int>(std::lround(1.2e-3 / spacing)), ny = nx / 3, layers = 7;
  for (int k = 0; k < layers; ++k)
    for (int j = -ny; j < ny; ++j)
      for (int i = -nx; i < nx; ++i) {
        Vec3 p = spacing * Vec3(i + 0.5, j + 0.5, -k - 0.5);
        for (int c = 0; c < 3; ++c) p[c] += 0.15 * spacing * noise();
        cloud.add(p);
      }
  return cloud;
}

void traced_plate(double spacing, Rows& rows) {
  const Cloud cloud = rough_plate(spacing);
  laser::Tracer tracer;
  tracer.set_mesh(
      laser::reconstruct_surface(cloud.view(), {{-1.0e-3, -0.3e-3, -2 * spacing}, {1.0e-3, 0.3e-3, 2e-4}}));
  double worst_ledger = 0;
  Watch watch;
  for (const double degrees : {0.0, 10.0, 45.0, 60.0, 70.0, 75.0, 80.0}) {
    laser::BeamSpec spec;
    spec.power = 1;
    spec.focal_diameter = 1e-4;
    spec.incidence_deg = degrees;
    const auto rays = laser::Beam(spec).rays(0, 5000, 1e-3);
    const auto trace = tracer.trace(rays, metal(kIron, laser::Polarisation::averaged));
    worst_ledger = std::max(worst_ledger, ledger_error(trace.ledger));
    rows.push_back(relative_row(fmt::format("Fe 1.07 um: plate of particles at {} deg", degrees),
                                trace.ledger.absorbed, at_degrees(kIron, degrees), 0.01,
                                {resolution_text(spacing), watch.seconds(), "Fresnel's formula"}));
  }
  rows.push_back(
      limit_row("ledger of the traces", worst_ledger, 1e-9, {resolution_text(spacing), 0, "energy balance"}));
}

/// Power that the particles of a scene take up from a beam at 10 degrees.
void scene_plate(const Setting& setting, Rows& rows) {
  const Watch watch;
  const auto simulation = start(setting);
  const scene::Scene& scene = simulation->scene();
  advance(*simulation, scene.time.end);
  const double expected =
      at_degrees(scene.material.index_solid, 10) * scene.laser->beam.power * scene.time.end;
  const Measured how{resolution_text(scene.domain.spacing), watch.seconds(), "A(10 deg) P t"};
  Row row = relative_row("energy in the particles, beam at 10 deg [J]", simulation->energy().laser, expected,
                         0.01, how);
  row.goal = 1e-3;
  rows.push_back(row);
  const auto energy = simulation->energy();
  rows.push_back(relative_row("enthalpy gained = energy deposited [J]", energy.stored - energy.initial,
                              energy.laser, 1e-9, how));
  rows.push_back(limit_row("ledger of the scene", simulation->laser_budget().worst, 1e-9, how));
}

}  // namespace

Rows fresnel_angles(const Setting& setting) {
  Rows rows;
  formula(Table(setting.folder / "reference.csv"), rows);
  traced_plate(5e-5, rows);
  scene_plate(setting, rows);
  return rows;
}

}  // namespace meltray::app
