// SPDX-License-Identifier: MIT
#include "meltray/terms/surface_forces.hpp"

namespace meltray::terms {

// Paper Eq. (8): a = g (1 - beta (T - T_0)), g along -z.
void Buoyancy::add_acceleration(const Stage& s, const MutField& acceleration) const {
  if (!gravity && !buoyant) return;
  const Material& m = s.constants->material;
  double* const az = acceleration[s.constants->dim - 1];
  parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
    const Index i = s.moving[k];
    double down = gravity ? g : 0.0;
    if (buoyant) down -= g * m.expansion * (s.temperature[i] - m.expansion_reference);
    az[i] -= down;
  });
}

}  // namespace meltray::terms
