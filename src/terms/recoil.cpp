// SPDX-License-Identifier: MIT
#include "meltray/core/constants.hpp"
#include "meltray/terms/surface_forces.hpp"

namespace meltray::terms {

double Recoil::pressure(const Material& m, double temperature, double t) const {
  if (prescribed > 0) return prescribed * (prescribed_ramp > 0 ? std::min(1.0, t / prescribed_ramp) : 1.0);
  const double p = coefficient * m.saturation_pressure(temperature);
  switch (onset) {
    case RecoilOnset::smooth:
      return p;
    case RecoilOnset::cutoff:
      return temperature >= m.boiling_temperature ? p : 0.0;
    case RecoilOnset::ambient:
      return std::max(0.0, p - constants::standard_atmosphere);
  }
  return p;
}

}  // namespace meltray::terms
