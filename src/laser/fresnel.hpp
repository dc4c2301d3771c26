// SPDX-License-Identifier: MIT
#pragma once

#include <complex>

namespace meltray::laser {

/// Complex reflection coefficients of the field, perpendicular (s) and parallel (p) to the plane of
/// incidence. The p directions of the incoming and the reflected ray are s x direction.
struct Amplitudes {
  std::complex<double> s, p;
};
Amplitudes fresnel_amplitudes(std::complex<double> index, double cosine);

}  // namespace meltray::laser
