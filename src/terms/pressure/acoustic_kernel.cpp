// SPDX-License-Identifier: MIT
// Compiled for several instruction sets, MELTRAY_INSTRUCTIONS names the one at hand: see
// cmake/instruction_set.cmake.
#include "terms/pressure/acoustic_kernel.hpp"

#include <cmath>
#include <experimental/simd>
#ifdef __AVX512F__
#include <immintrin.h>
#endif

#include "meltray/sph/kernel.hpp"

namespace meltray::terms::MELTRAY_INSTRUCTIONS {

namespace {

constexpr Index kLanes = kOctetSlots, kRows = kRowsOfGroup;

/// A register; an octet is read in one piece or in several.
using Lanes = std::experimental::native_simd<double>;
constexpr Index kWidth = static_cast<Index>(Lanes::size());

inline Lanes load(const double* p, Index slot) {
  return Lanes(p + slot, std::experimental::vector_aligned);
}

inline double sum(const Lanes& lanes) {
  return std::experimental::reduce(lanes);
}

/// 1 / x to 42 bits at least. Where 512-bit registers share one unit for roots and quotients, that unit is
/// what a pass waits for: an estimate of 14 bits and one step of third order leave it the roots alone.
inline Lanes inverse(const Lanes& x) {
#ifdef __AVX512F__
  const Lanes first(_mm512_rcp14_pd(static_cast<__m512d>(x)));
  const Lanes error = 1 - x * first;
  return first + first * (error + error * error);
#else
  return 1 / x;
#endif
}

/// Calls f(slot) for the pieces of the octets in a list of one group.
template <class F>
inline void for_pieces(const OctetLists& lists, Index group, F&& f) {
  for (Index k = lists.start[group]; k < lists.start[group + 1]; ++k)
    for (Index lane = 0; lane < kLanes; lane += kWidth) f(lists.octet[k] * kLanes + lane);
}

/// 1/h and alpha/h^D of a kernel of sph/kernel.hpp.
template <int D, class Plain>
struct Scaled {
  double inverse_h, scale_w;
  explicit Scaled(double h) : inverse_h(1 / h), scale_w(Plain::kAlpha / (D == 2 ? h * h : h * h * h)) {}
};

/// sph::WendlandC2 over registers. The factor of its F is inside the cube.
template <int D>
struct Wendland : Scaled<D, sph::WendlandC2<D>> {
  using Base = Scaled<D, sph::WendlandC2<D>>;
  using Base::inverse_h, Base::scale_w;
  double root_f, slope_f;
  explicit Wendland(double h)
      : Base(h), root_f(std::cbrt(-5 * scale_w * inverse_h * inverse_h)), slope_f(0.5 * inverse_h * root_f) {}
  Lanes f(const Lanes& r) const {
    const Lanes t = min(root_f - slope_f * r, Lanes(0));
    return t * t * t;
  }
  Lanes w(const Lanes& r) const {
    const Lanes t = max(Lanes(1) - 0.5 * inverse_h * r, Lanes(0)), t2 = t * t;
    return scale_w * t2 * t2 * (2 * inverse_h * r + 1);
  }
};

/// sph::CubicSpline over registers.
template <int D>
struct Cubic : Scaled<D, sph::CubicSpline<D>> {
  using Base = Scaled<D, sph::CubicSpline<D>>;
  using Base::inverse_h, Base::scale_w;
  explicit Cubic(double h) : Base(h) {}
  Lanes f(const Lanes& r) const {
    const Lanes q = inverse_h * r, a = max(2 - q, Lanes(0));
    Lanes f = -0.5 * a * a / max(q, Lanes(1));
    where(q < 1, f) = 1.5 * q - 2;
    return scale_w * inverse_h * inverse_h * f;
  }
  Lanes w(const Lanes& r) const {
    const Lanes q = inverse_h * r, a = max(2 - q, Lanes(0)), b = max(1 - q, Lanes(0));
    return scale_w / 6 * (a * a * a - 4 * b * b * b);
  }
};

template <int D>
struct Vector {
  Lanes x[D];
};

template <int D>
inline Lanes dot(const Vector<D>& a, const Vector<D>& b) {
  Lanes s = a.x[0] * b.x[0];
  for (int c = 1; c < D; ++c) s += a.x[c] * b.x[c];
  return s;
}

template <bool Periodic, int D>
inline Vector<D> separation(const AcousticArguments& a, const double (&xi)[D], const Vector<D>& xj) {
  Vector<D> d;
  for (int c = 0; c < D; ++c) {
    d.x[c] = xi[c] - xj.x[c];
    if constexpr (Periodic) d.x[c] -= a.period[c] * nearbyint(d.x[c] * a.inverse_period[c]);
  }
  return d;
}

template <int D>
inline Vector<D> load(const double* const (&p)[3], Index slot) {
  Vector<D> v;
  for (int c = 0; c < D; ++c) v.x[c] = load(p[c], slot);
  return v;
}

template <int D, class Kernel, bool Periodic>
void extrapolate_of(const AcousticArguments& arguments, Index begin, Index end) {
  const AcousticArguments a = arguments;
  const Kernel kernel(a.smoothing);
  const AcousticFields& melt = a.melt;
  for (Index g = begin; g < end; ++g) {
    double xi[kRows][D];
    Lanes above[kRows]{}, below[kRows]{};
    for (Index n = 0; n < kRows; ++n)
      for (int c = 0; c < D; ++c) xi[n][c] = a.wall.x[c][g * kRows + n];
    for_pieces(a.wall_melt, g, [&](Index j) {
      const Vector<D> xj = load<D>(melt.x, j);
      const Lanes p = load(melt.pressure, j), weight = load(melt.density, j) * a.gravity;
      Lanes there = 1;
      where(load(melt.volume, j) == 0, there) = 0;
#pragma GCC unroll 2
      for (Index n = 0; n < kRows; ++n) {
        const Vector<D> d = separation<Periodic, D>(a, xi[n], xj);
        const Lanes w = there * kernel.w(sqrt(dot(d, d)));
        above[n] += w * (p - weight * d.x[D - 1]);
        below[n] += w;
      }
    });
    for (Index n = 0; n < kRows; ++n) {
      const double w = sum(below[n]);
      a.wall_pressure[g * kRows + n] = w > 0 ? sum(above[n]) / w : 0;
    }
  }
}

template <int D, class Kernel, bool Periodic>
void excess_gradient_of(const AcousticArguments& arguments, Index begin, Index end) {
  const AcousticArguments a = arguments;
  constexpr int kMoments = D * (D + 1) / 2;
  const Kernel kernel(a.smoothing);
  const AcousticFields& melt = a.melt;
  for (Index g = begin; g < end; ++g) {
    double xi[kRows][D], ei[kRows];
    Lanes gradient[kRows][D]{}, moment[kRows][kMoments]{};
    for (Index n = 0; n < kRows; ++n) {
      ei[n] = melt.excess[g * kRows + n];
      for (int c = 0; c < D; ++c) xi[n][c] = melt.x[c][g * kRows + n];
    }
    for_pieces(a.melt_melt, g, [&](Index j) {
      const Vector<D> xj = load<D>(melt.x, j);
      const Lanes ej = load(melt.excess, j), volume = load(melt.volume, j);
#pragma GCC unroll 2
      for (Index n = 0; n < kRows; ++n) {
        const Vector<D> d = separation<Periodic, D>(a, xi[n], xj);
        const Lanes vf = volume * kernel.f(sqrt(dot(d, d))), slope = vf * (ej - ei[n]);
        int m = 0;
        for (int p = 0; p < D; ++p) {
          gradient[n][p] += slope * d.x[p];
          const Lanes along = vf * d.x[p];
          for (int q = p; q < D; ++q) moment[n][m++] -= along * d.x[q];
        }
      }
    });
    for (Index n = 0; n < kRows; ++n) {
      for (int c = 0; c < D; ++c) melt.gradient[c][g * kRows + n] = sum(gradient[n][c]);
      for (int m = 0; m < kMoments; ++m) a.moment[m][g * kRows + n] = sum(moment[n][m]);
    }
  }
}

/// Terms of a pass; what is off is not in its loops.
template <bool Periodic, bool Diffusion, bool Gradients, bool Viscosity, bool Stress>
struct Terms {
  static constexpr bool periodic = Periodic, diffusion = Diffusion, gradients = Gradients,
                        viscosity = Viscosity, stress = Stress;
};

/// The particle of one row, and its sums. What all of its pairs have in common is left to the end of the row:
/// d rho/dt = rate_factor sum_j V_j F_ij rate_ij, force = sum_j V_j F_ij pair_ij x_ij.
template <class T, int D>
struct Row {
  double x[D], v[D], gradient[D], density, pressure, own_pressure, twice_excess, convection, rate_factor;
  double drag[2];  ///< (rho_i + rho_j) / (viscosity rho_i) = drag[0] + drag[1] rho_j
  Lanes rate{}, force[D]{};

  Row(const AcousticArguments& a, Index slot) {
    const AcousticFields& melt = a.melt;
    for (int c = 0; c < D; ++c) {
      x[c] = melt.x[c][slot];
      v[c] = melt.v[c][slot];
      if (T::gradients) gradient[c] = melt.gradient[c][slot];
    }
    density = melt.density[slot];
    pressure = melt.pressure[slot];
    own_pressure = a.own_pressure * pressure;
    twice_excess = 2 * melt.excess[slot];
    rate_factor = T::diffusion ? -a.diffusion : a.continuity * density;
    convection = T::diffusion ? a.continuity * density / rate_factor : 1;
    if (T::viscosity) drag[1] = 1 / (a.viscosity * density);
    if (T::viscosity) drag[0] = drag[1] * density;
  }
};

/// A piece of an octet of neighbours: continuity, density diffusion (melt only), pressure and artificial
/// viscosity.
template <class T, int D, bool Melt, class Kernel>
[[gnu::always_inline]] inline void add_piece(const AcousticArguments& a, const AcousticFields& field,
                                             const Kernel& kernel, Index j, Row<T, D> (&row)[kRows]) {
  const double softening = 0.01 * a.smoothing * a.smoothing;
  const Vector<D> xj = load<D>(field.x, j), vj = load<D>(field.v, j);
  const Lanes volume = load(field.volume, j), pj = load(field.pressure, j);
#pragma GCC unroll 2
  for (Row<T, D>& i : row) {
    const Vector<D> d = separation<T::periodic, D>(a, i.x, xj);
    const Lanes r2 = dot(d, d), r = sqrt(r2), vf = volume * kernel.f(r);
    Vector<D> u;
    for (int c = 0; c < D; ++c) u.x[c] = i.v[c] - vj.x[c];
    const Lanes along = dot(u, d);

    Lanes rate = along;
    if constexpr (T::diffusion) rate *= i.convection;
    if constexpr (Melt && T::diffusion) {
      rate += 2 * load(field.excess, j) - i.twice_excess;
      if constexpr (T::gradients)
        for (int c = 0; c < D; ++c) rate += (load(field.gradient[c], j) + i.gradient[c]) * d.x[c];
    }
    i.rate += vf * rate;

    Lanes pair = i.own_pressure + pj;
    if constexpr (T::stress) {
      const Lanes ratio = a.inverse_w * kernel.w(r), ratio2 = ratio * ratio;
      const Lanes pull = min(pj, Lanes(0)) + (i.pressure < 0 ? i.pressure : 0.0);
      Lanes repulsion = a.stress_pressure * (i.pressure + pj);
      where(pull < 0, repulsion) = -a.stress_tension * pull;
      pair += ratio2 * ratio2 * repulsion;
    }
    if constexpr (T::viscosity) {
      const Lanes density = load(field.density, j);
      Lanes approach = density * min(along, Lanes(0));
      if constexpr (!Melt) approach *= load(field.drag, j);
      pair -= approach * inverse((i.drag[0] + i.drag[1] * density) * (r2 + softening));
    }
    const Lanes force = vf * pair;
    for (int c = 0; c < D; ++c) i.force[c] += force * d.x[c];
  }
}

template <int D, class Kernel, class T>
void rates_of(const AcousticArguments& arguments, Index begin, Index end) {
  const AcousticArguments a = arguments;  // a copy, which no store can change
  const Kernel kernel(a.smoothing);
  for (Index g = begin; g < end; ++g) {
    Row<T, D> row[kRows] = {{a, g * kRows}, {a, g * kRows + 1}};
    for_pieces(a.melt_melt, g, [&](Index j) { add_piece<T, D, true>(a, a.melt, kernel, j, row); });
    for_pieces(a.melt_wall, g, [&](Index j) { add_piece<T, D, false>(a, a.wall, kernel, j, row); });
    for (Index n = 0; n < kRows; ++n) {
      const Index i = g * kRows + n;
      a.density_rate[i] = row[n].rate_factor * sum(row[n].rate);
      for (int c = 0; c < D; ++c) a.force[c][i] = sum(row[n].force[c]);
    }
  }
}

/// Calls f(Terms<...>) for switches known at run time.
template <bool... Known, class F>
inline void with_terms(F&& f) {
  f(Terms<Known...>{});
}
template <bool... Known, class F, class... More>
inline void with_terms(F&& f, bool next, More... more) {
  if (next)
    with_terms<Known..., true>(f, more...);
  else
    with_terms<Known..., false>(f, more...);
}

bool is_periodic(const AcousticArguments& a) {
  return a.period[0] > 0 || a.period[1] > 0 || a.period[2] > 0;
}

template <int D, class Kernel>
void extrapolate(const AcousticArguments& a, Index begin, Index end) {
  return is_periodic(a) ? extrapolate_of<D, Kernel, true>(a, begin, end)
                        : extrapolate_of<D, Kernel, false>(a, begin, end);
}

template <int D, class Kernel>
void excess_gradient(const AcousticArguments& a, Index begin, Index end) {
  return is_periodic(a) ? excess_gradient_of<D, Kernel, true>(a, begin, end)
                        : excess_gradient_of<D, Kernel, false>(a, begin, end);
}

template <int D, class Kernel>
void rates(const AcousticArguments& a, Index begin, Index end) {
  with_terms([&](auto terms) { rates_of<D, Kernel, decltype(terms)>(a, begin, end); }, is_periodic(a),
             a.diffusion > 0, a.gradients, a.viscosity > 0, a.inverse_w > 0);
}

template <int D, class Kernel>
constexpr AcousticKernel kLoops{MELTRAY_INSTRUCTIONS_NAME, extrapolate<D, Kernel>, excess_gradient<D, Kernel>,
                                rates<D, Kernel>};

}  // namespace

const AcousticKernel& choose(int dim, bool cubic_spline) {
  if (cubic_spline) return dim == 2 ? kLoops<2, Cubic<2>> : kLoops<3, Cubic<3>>;
  return dim == 2 ? kLoops<2, Wendland<2>> : kLoops<3, Wendland<3>>;
}

}  // namespace meltray::terms::MELTRAY_INSTRUCTIONS
