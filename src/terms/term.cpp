// SPDX-License-Identifier: MIT
#include "meltray/terms/term.hpp"

namespace meltray::terms {

namespace {

constexpr Vec3 Crossings::*kForces[5] = {&Crossings::gravity, &Crossings::surface, &Crossings::viscosity,
                                         &Crossings::shifting, &Crossings::pressure};
constexpr double Crossings::*kPowers[5] = {&Crossings::evaporation, &Crossings::radiation,
                                           &Crossings::boundary, &Crossings::laser,
                                           &Crossings::evaporated_mass};

}  // namespace

void Crossings::write(double* out) const {
  for (auto power : kPowers) *out++ = this->*power;
  for (auto force : kForces)
    for (int c = 0; c < 3; ++c) *out++ = (this->*force)[c];
}

Crossings Crossings::read(const double* in) {
  Crossings x;
  for (auto power : kPowers) x.*power = *in++;
  for (auto force : kForces)
    for (int c = 0; c < 3; ++c) (x.*force)[c] = *in++;
  return x;
}

}  // namespace meltray::terms
