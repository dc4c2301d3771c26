// SPDX-License-Identifier: MIT
#include "meltray/terms/pressure/weakly_compressible.hpp"

#include "terms/pressure/surface_part.hpp"

namespace meltray::terms {

void PressureForce::add_surface_force(const Stage& s, const MutField& acceleration) const {
  const auto& lattice = s.constants->lattice;
  const double scale = form == GradientForm::sum ? 2 / lattice.second_moment : surface_part(lattice);
  parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
    const Index i = s.moving[k];
    const double jump = form == GradientForm::sum
                            ? s.surface_pressure[i]
                            : s.surface[i] * (s.surface_pressure[i] - s.patch->pressure[i]);
    const double factor = scale * jump * s.volume[i] / s.patch->mass[i];
    for (int c = 0; c < s.constants->dim; ++c) acceleration[c][i] += factor * s.grad_c[c][i];
  });
}

}  // namespace meltray::terms
