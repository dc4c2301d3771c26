// SPDX-License-Identifier: MIT
#include "meltray/particles/particles.hpp"

#include <string>

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
