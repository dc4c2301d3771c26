// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/model.hpp"

/// What a failing run says of its first bad particle.
namespace meltray::scene {

namespace {

/// What each term does to a particle, with its name.
using Shares = std::vector<std::pair<double, std::string>>;

/// "pressure 3e+06 m/s^2, ...".
std::string largest_first(Shares shares, const char* unit) {
  std::sort(shares.begin(), shares.end(),
            [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
  std::string text;
  for (const auto& [size, name] : shares)
    text += fmt::format("{}{} {:.3g} {}", text.empty() ? "" : ", ", name, size, unit);
  return text;
}

}  // namespace

std::string Model::blame(Index i, double dt) {
  Shares pulls;
  const auto pull = [&](const char* name, auto&& add) {
    terms::Rates rates = cleared_rates();
    add(rates.acceleration);
    double a2 = 0;
    for (int c = 0; c < constants_.dim; ++c) a2 += acceleration_[c][i] * acceleration_[c][i];
    pulls.emplace_back(std::sqrt(a2), name);
  };
  if (viscous(false).any()) pull("explicit viscosity", [&](auto& a) { add_viscous(false, a); });
  if (viscous(true).any()) pull("implicit viscosity", [&](auto& a) { add_viscous(true, a); });
  pull("gravity and buoyancy", [&](auto& a) { buoyancy_.add_acceleration(stage, a); });
  if (scene_.terms.marangoni) pull("marangoni", [&](auto& a) { marangoni_.add_acceleration(stage, a); });
  if (shifting_.coefficient > 0)
    pull("shifting", [&](auto& a) {
      for (int c = 0; c < constants_.dim; ++c) clear(transport_[c], stage.size());
      shifting_.add_rates(stage, view(transport_), a);
    });
  update_surface_pressure();
  if (weakly_compressible()) {
    density_rate_.resize(stage.size());
    const double alpha = std::exchange(acoustic_->artificial.alpha, 0.0);
    acoustic_->evaluate(stage);
    pull("pressure", [&](auto& a) { acoustic_->add_rates(stage, density_rate_.data(), a); });
    if (needs_surface())
      pull("surface force", [&](auto& a) { acoustic_->force.add_surface_force(stage, a); });
    acoustic_->artificial.alpha = alpha;
    acoustic_->evaluate(stage);
    if (alpha > 0)
      pull("pressure with artificial viscosity",
           [&](auto& a) { acoustic_->add_rates(stage, density_rate_.data(), a); });
  } else {
    projection.assemble(stage);
  }
  if (!weakly_compressible() && projection.rows() > 0) {
    projection.divergence(stage, view(static_cast<const Patch&>(patch).v), source_);
    for (double& s : source_) s /= dt;
    projection.solve(stage, source_, projection_options_);
    pull("pressure and surface force", [&](auto& a) { add_projected_pressure(a); });
  }
  return "accelerations in the last accepted state: " + largest_first(std::move(pulls), "m/s^2");
}

std::string Model::blame_heat(Index i) {
  Shares sources;
  const auto source = [&](const char* name, auto&& add) {
    terms::Rates rates = cleared_rates();
    add(rates.heating);
    sources.emplace_back(heating_[i], name);
  };
  terms::Crossings ignored;
  if (scene_.terms.conduction)
    source("conduction", [&](double* heating) { conduction_operator().add_heating(stage, heating); });
  if (scene_.terms.evaporation || scene_.terms.radiation)
    source("evaporation and radiation",
           [&](double* heating) { losses_.add_heating(stage, heating, ignored); });
  if (!laser_power.empty()) sources.emplace_back(laser_power[i] / patch.mass[i], "laser");
  return "heating in the last accepted state: " + largest_first(std::move(sources), "W/kg");
}

}  // namespace meltray::scene
