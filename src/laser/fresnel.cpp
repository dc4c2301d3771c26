// SPDX-License-Identifier: MIT
#include "laser/fresnel.hpp"

#include <algorithm>

#include "meltray/laser/laser.hpp"

namespace meltray::laser {

// Born & Wolf 1999, sect. 14.2: q = sqrt(m^2 - sin^2), r_s = (cos - q)/(cos + q),
// r_p = (m^2 cos - q)/(m^2 cos + q).
Amplitudes fresnel_amplitudes(std::complex<double> index, double cosine) {
  const double c = std::clamp(cosine, 0.0, 1.0);
  const std::complex<double> m2 = index * index;
  const std::complex<double> q = std::sqrt(m2 - (1 - c * c));
  return {(c - q) / (c + q), (m2 * c - q) / (m2 * c + q)};
}

Reflectance fresnel(std::complex<double> index, double cosine) {
  // As above, but without complex divisions.
  const double c = std::clamp(cosine, 0.0, 1.0);
  const std::complex<double> m2 = index * index, q = std::sqrt(m2 - (1 - c * c)), m2c = m2 * c;
  return {std::norm(c - q) / std::norm(c + q), std::norm(m2c - q) / std::norm(m2c + q)};
}

double absorptance(std::complex<double> index, double cosine) {
  const Reflectance r = fresnel(index, cosine);
  return std::clamp(1 - 0.5 * (r.s + r.p), 0.0, 1.0);
}

}  // namespace meltray::laser
