// SPDX-License-Identifier: MIT
#include "meltray/sph/kernel.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <numbers>

#include "meltray/sph/lattice.hpp"

using namespace meltray::sph;

namespace {

/// Integral over [a, b] by Gauss's two-point rule on many panels; integrands here are piecewise polynomials.
double integral(double a, double b, const std::function<double(double)>& f) {
  constexpr int panels = 4000;
  const double width = (b - a) / panels, offset = 0.5 * width / std::sqrt(3.0);
  double sum = 0;
  for (int k = 0; k < panels; ++k) {
    const double mid = a + (k + 0.5) * width;
    sum += 0.5 * width * (f(mid - offset) + f(mid + offset));
  }
  return sum;
}

template <int D>
double shell(double r) {
  return D == 2 ? 2 * std::numbers::pi * r : 4 * std::numbers::pi * r * r;
}

template <class Kernel, int D>
void check_kernel(double h) {
  CAPTURE(D, h);
  const double inv_h = 1 / h;
  CHECK(integral(0, 2 * h, [&](double r) { return shell<D>(r) * Kernel::w(r, inv_h); }) ==
        Approx(1).epsilon(1e-9));
  // By parts: the integral of -F r^2 over the volume is D times that of W.
  CHECK(integral(0, 2 * h, [&](double r) { return -shell<D>(r) * Kernel::f(r, inv_h) * r * r; }) ==
        Approx(D).epsilon(1e-9));
  const double w0 = Kernel::w(0, inv_h), d = 1e-5 * h;
  for (double q : {0.1, 0.4, 0.75, 0.99, 1.01, 1.3, 1.7, 1.95}) {
    CAPTURE(q);
    const double r = q * h;
    // Central differences: error of order (d/h)^2 = 1e-10, round-off 1e-16 / 1e-5.
    CHECK((Kernel::w(r + d, inv_h) - Kernel::w(r - d, inv_h)) / (2 * d) ==
          Approx(r * Kernel::f(r, inv_h)).epsilon(1e-7).margin(1e-9 * w0 / h));
    CHECK(Kernel::f(r, inv_h) < 0);
  }
  for (double r : {2 * h, 2.5 * h, 10 * h}) {
    CHECK(Kernel::w(r, inv_h) == Approx(0).margin(1e-14 * w0));
    CHECK(Kernel::f(r, inv_h) == Approx(0).margin(1e-14 * w0 / (h * h)));
  }
  // F at the centre is the limit of W'/r.
  const double e = 1e-4 * h;
  CHECK(Kernel::f(0, inv_h) == Approx((Kernel::w(e, inv_h) - w0) / (0.5 * e * e)).epsilon(1e-3));
}

}  // namespace

TEST_CASE("kernels are normalised and their derivatives are those of W") {
  for (double h : {1.0, 6.5e-5}) {
    check_kernel<WendlandC2<2>, 2>(h);
    check_kernel<WendlandC2<3>, 3>(h);
    check_kernel<CubicSpline<2>, 2>(h);
    check_kernel<CubicSpline<3>, 3>(h);
  }
}

TEST_CASE("lattice sums: values by hand for a support of the nearest neighbours only") {
  // h = 0.6 dx: support 1.2 dx holds the 2 D neighbours at distance dx and the particle itself.
  const double dx = 2e-3, h = 0.6 * dx, inv_h = 1 / h;
  const auto two = lattice_sums(KernelType::wendland_c2, 2, dx, h);
  using K2 = WendlandC2<2>;
  CHECK(two.shepard == Approx(dx * dx * (K2::w(0, inv_h) + 4 * K2::w(dx, inv_h))));
  CHECK(two.laplacian == Approx(-dx * dx * 4 * K2::f(dx, inv_h)));
  CHECK(two.second_moment == Approx(-dx * dx * 2 * K2::f(dx, inv_h) * dx * dx));
  CHECK(two.face_gradient == Approx(-2 * dx * dx * K2::f(dx, inv_h) * dx * dx));
  // The outermost row has three of the four neighbours; along the face all of the second moment is its own.
  CHECK(two.neighbours == 4);
  CHECK(two.face_moment == Approx(1));
  CHECK(two.layer_moment == Approx(1));
  using K3 = CubicSpline<3>;
  const auto three = lattice_sums(KernelType::cubic_spline, 3, dx, h);
  CHECK(three.shepard == Approx(dx * dx * dx * (K3::w(0, inv_h) + 6 * K3::w(dx, inv_h))));
  CHECK(three.laplacian == Approx(-dx * dx * dx * 6 * K3::f(dx, inv_h)));
  CHECK(three.second_moment == Approx(-dx * dx * dx * 2 * K3::f(dx, inv_h) * dx * dx));
}

TEST_CASE("lattice sums approach the integrals of the kernel as the support grows") {
  for (auto kernel : {KernelType::wendland_c2, KernelType::cubic_spline})
    for (int dim : {2, 3}) {
      const double dx = 1e-4;
      const auto s = lattice_sums(kernel, dim, dx, 4 * dx);
      CAPTURE(dim, static_cast<int>(kernel));
      // A sum over a lattice is spectrally close to the integral for smooth kernels; 4 dx leaves below 1e-3.
      CHECK(s.shepard == Approx(1).epsilon(1e-3));
      CHECK(s.second_moment == Approx(1).epsilon(1e-3));
    }
}

TEST_CASE("face distance: the colour of a slab of lattice tells how far over it a point lies") {
  const double dx = 1e-4, h = 1.3 * dx, reach = 2 * h - 0.5 * dx;
  const FaceDistance distance(KernelType::wendland_c2, 3, dx, h);
  const double full = lattice_sums(KernelType::wendland_c2, 3, dx, h).shepard;
  for (double height : {0.25, 0.5, 1.0, 1.5}) {
    double sum = 0;
    for (int i = -3; i <= 3; ++i)
      for (int j = -3; j <= 3; ++j)
        for (int k = 0; k <= 3; ++k)
          sum += dx * dx * dx * WendlandC2<3>::w(dx * std::hypot(i, j, k + 0.5 + height), 1 / h);
    CHECK(distance(sum / full) == Approx(height * dx).epsilon(2e-3));
  }
  CHECK(distance(0) == Approx(reach));
  CHECK(distance(-1) == Approx(reach));
  CHECK(std::abs(distance(0.5)) < 1e-3 * dx);
  CHECK(distance(0.9) == distance(0.5));
}
