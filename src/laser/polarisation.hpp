// SPDX-License-Identifier: MIT
#pragma once

#include <complex>

#include "laser/fresnel.hpp"
#include "meltray/core/vec.hpp"

namespace meltray::laser {

/// State of polarisation of a ray: its coherency matrix <E_i E_j*> of unit trace in a transverse frame
/// (Born & Wolf 1999, sect. 10.9.1). It holds polarised, partly polarised and unpolarised light alike.
class PolarisationState {
 public:
  /// Linear along (x, y) of the cross-section, where x is the world's x made transverse; (0, 0): unpolarised.
  PolarisationState(const Vec3& direction, double x, double y) {
    Vec3 e = Vec3::UnitX() - direction.x() * direction;
    if (e.squaredNorm() < 1e-12) e = Vec3::UnitY() - direction.y() * direction;
    first_ = e.normalized();
    const double norm2 = x * x + y * y;
    if (norm2 > 0) set(x * x / norm2, y * y / norm2, x * y / norm2);
  }

  /// Turns the frame into the plane of incidence of `normal`, reflects, and returns the reflected share of
  /// the power. The state is then that of the ray along `out`.
  double reflect(const Vec3& in, const Vec3& normal, const Vec3& out, const Amplitudes& r) {
    Vec3 s = in.cross(normal);
    const double sine = s.norm();
    s = sine > 1e-9 ? Vec3(s / sine) : first_;  // normal incidence: every plane will do
    const Vec3 second = first_.cross(in);
    const double c = first_.dot(s), d = second.dot(s);
    // In the basis (s, s x in); that basis is (first, first x in) turned by the angle of s.
    const double ss = c * c * aa_ + d * d * bb_ + 2 * c * d * ab_.real();
    const double pp = c * c * bb_ + d * d * aa_ - 2 * c * d * ab_.real();
    const std::complex<double> sp{c * d * (bb_ - aa_) + (c * c - d * d) * ab_.real(), ab_.imag()};
    const double ss_out = std::norm(r.s) * ss, pp_out = std::norm(r.p) * pp;
    const double share = ss_out + pp_out;
    first_ = (s - s.dot(out) * out).normalized();
    if (share > 0) set(ss_out / share, pp_out / share, r.s * std::conj(r.p) * sp / share);
    return share;
  }

  /// Diffuse reflection depolarises.
  void depolarise(const Vec3& direction) { *this = PolarisationState(direction, 0, 0); }

 private:
  void set(double aa, double bb, std::complex<double> ab) { aa_ = aa, bb_ = bb, ab_ = ab; }

  Vec3 first_;  ///< transverse unit vector; the second of the frame is first x direction
  double aa_ = 0.5, bb_ = 0.5;
  std::complex<double> ab_ = 0;
};

}  // namespace meltray::laser
