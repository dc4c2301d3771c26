// SPDX-License-Identifier: MIT
#include "meltray/particles/particles.hpp"

#include <string>

#include "meltray/core/memory.hpp"

namespace meltray {

void Particles::add(const Vec3& position, double enthalpy, double m, double smoothing_length,
                    std::uint8_t wall_face) {
  for (int c = 0; c < dim; ++c) {
    x[c].push_back(position[c]);
    v[c].push_back(0.0);
  }
  h.push_back(enthalpy);
  mass.push_back(m);
  smoothing.push_back(smoothing_length);
  pressure.push_back(0.0);
  temperature.push_back(0.0);
  phase.push_back(static_cast<std::uint8_t>(Phase::solid));
  flags.push_back(0);
  wall.push_back(wall_face);
}

void Particles::reserve(std::size_t n) {
  for (int c = 0; c < dim; ++c) {
    x[c].reserve(n);
    v[c].reserve(n);
  }
  for (auto* a : {&h, &mass, &smoothing, &pressure, &temperature}) a->reserve(n);
  for (auto* a : {&phase, &flags, &wall}) a->reserve(n);
}

std::size_t Particles::bytes() const {
  return held_bytes(x) + held_bytes(v) + held_bytes(stress) +
         held_bytes(h, density, mass, smoothing, pressure, temperature, phase, flags, wall);
}

void Particles::archive(Archive& a) {
  static constexpr const char* kAxis[3] = {"x", "y", "z"};
  for (int c = 0; c < dim; ++c) {
    a.values(std::string("particles/position_") + kAxis[c], x[c]);
    a.values(std::string("particles/velocity_") + kAxis[c], v[c]);
  }
  a.values("particles/enthalpy", h);
  if (!density.empty()) a.values("particles/density", density);
  for (int c = 0; c < symmetric_count(dim); ++c)
    if (!stress[c].empty()) a.values("particles/stress_" + std::to_string(c), stress[c]);
  a.values("particles/mass", mass);
  a.values("particles/smoothing_length", smoothing);
  a.values("particles/pressure", pressure);
  a.values("particles/temperature", temperature);
  a.values("particles/phase", phase);
  a.values("particles/flags", flags);
  a.values("particles/wall", wall);
}

}  // namespace meltray
