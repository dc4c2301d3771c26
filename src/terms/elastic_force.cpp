// SPDX-License-Identifier: MIT
#include <cmath>

#include "meltray/terms/elastic.hpp"
#include "terms/elastic_vectors.hpp"

/// Forces on elastic solid: by its own stress, its artificial viscosity, walls and melt.
namespace meltray::terms {

namespace {

template <int D>
using Vector = Eigen::Matrix<double, D, 1>;
template <int D>
using Matrix = Eigen::Matrix<double, D, D>;

/// Vector number `which` of some that follow one another.
template <int D, std::size_t N>
Vector<D> vector(const std::array<double, N>& sums, int which = 0) {
  return Eigen::Map<const Vector<D>>(sums.data() + which * D);
}

/// Mean of (W / W(dx))^4 over the pairs of a lattice, each with its share -F x^2 in a stress: the artificial
/// stress less this mean pushes near neighbours apart without making the lattice softer.
template <int D, class Kernel>
double mean_repulsion(const SceneConstants& k) {
  const double inverse_h = 1 / k.smoothing, unit = Kernel::w(k.spacing, inverse_h);
  const int reach = static_cast<int>(std::ceil(2 * k.smoothing / k.spacing));
  double sum = 0, all = 0;
  for (int a = -reach; a <= reach; ++a)
    for (int b = -reach; b <= reach; ++b)
      for (int c = D == 3 ? -reach : 0; c <= (D == 3 ? reach : 0); ++c) {
        const double r = k.spacing * std::sqrt(a * a + b * b + c * c);
        const double share = -Kernel::f(r, inverse_h) * a * a, f = Kernel::w(r, inverse_h) / unit;
        sum += share * f * f * f * f;
        all += share;
      }
  return sum / all;
}

/// Factors of the neighbours' stress and artificial stress in the sums of one row.
struct PairFactors {
  std::vector<double> stress, repulsion;
  void resize(Index pairs) {
    for (auto* factor : {&stress, &repulsion}) factor->resize(static_cast<std::size_t>(pairs));
  }
};

/// Force per volume by the stress of elastic neighbours.
template <int D>
Vector<D> stress_of_neighbours(const Stage& s, Index i, const PairFactors& of_pair, const double* tensors) {
  const std::uint8_t* const elastic = s.patch->elastic.data();
  const Index first = s.pairs->begin(i);
  std::array<Lane<D>, D> sum;  // D sums that do not wait for each other
  sum.fill(0);
  s.pairs->for_row<D>(i, [&](const sph::Pair<D>& p) {
    if (!elastic[p.j]) return;
    const double stress = of_pair.stress[p.k - first], repulsion = of_pair.repulsion[p.k - first];
    const double* const t = tensors + tensors_begin<D>(p.j);
    for (int b = 0; b < D; ++b)
      sum[b] += p.x[b] * (stress * load_lane<D>(t + b * kWidth<D>) +
                          repulsion * load_lane<D>(t + (D + b) * kWidth<D>));
  });
  for (int b = 1; b < D; ++b) sum[0] += sum[b];
  Vector<D> force;
  for (int c = 0; c < D; ++c) force[c] = sum[0][c];
  return force;
}

/// Force per volume by which stress behind slip faces differs from that of particle i: the images of its
/// tractions are turned round in the shear along the face.
template <int D>
Vector<D> along_slip_faces(const Stage& s, Index i, const Matrix<D>& traction) {
  Vector<D> force = Vector<D>::Zero();
  s.pairs->for_row<D>(i, [&](const sph::Pair<D>& p) {
    if (!s.patch->wall[p.j]) return;
    const WallFace& face = s.constants->faces[s.patch->wall[p.j] - 1];
    if (face.no_slip) return;
    Matrix<D> turned = Matrix<D>::Zero();
    turned.row(face.axis) = -2 * traction.row(face.axis);
    turned.col(face.axis) = -2 * traction.col(face.axis);
    turned(face.axis, face.axis) = 0;
    force += s.volume[p.j] * p.f * (turned * vector<D>(p.x));
  });
  return force;
}

/// Force per volume by the pressure of the melt, with that which the solid shows to the melt.
template <int D>
Vector<D> pressure_of_melt(const Stage& s, Index i) {
  const double *const p = s.patch->pressure.data(), *const volume = s.volume.data();
  const std::uint8_t* const liquid = s.patch->liquid.data();
  const double own = p[i];
  const auto sum = s.pairs->sum_row<D, D>(i, [&](const sph::PairLanes<D>& q) {
    const sph::Lanes g = -q.of(liquid) * q.of(volume) * q.f * (own + q.of(p));
    std::array<sph::Lanes, D> out;
    for (int c = 0; c < D; ++c) out[c] = g * q.x[c];
    return out;
  });
  return vector<D>(sum) / s.constants->lattice.second_moment;
}

}  // namespace

void ElasticSolid::add_rates(const Stage& s, const Rates& rates) const {
  sph::with_dim(s.constants->dim, [&](auto d) {
    add_stress_rates<d>(s, rates);
    add_acceleration<d>(s, rates.acceleration);
  });
}

/// Per patch particle: how often its volume counts with the stress of the particle that it acts on (once in
/// the solid, twice where it has none of its own), and its mass times the strength of its drag.
void ElasticSolid::weigh(const Stage& s) const {
  const double own_drag = viscosity * sound_speed(s.constants->density);
  own_weight_.resize(s.size());
  drag_.resize(s.size());
  parallel_for(s.size(), [&](Index j) {
    const int wall = s.patch->wall[j];
    own_weight_[j] = solid_volume_[j] * (s.patch->elastic[j] ? 1 : 2);
    drag_[j] = s.patch->mass[j] * (s.patch->liquid[j] ? melt_drag : own_drag);
    if (wall && !s.constants->faces[wall - 1].no_slip) drag_[j] = 0;
  });
}

template <int D>
void ElasticSolid::add_acceleration(const Stage& s, const MutField& acceleration) const {
  weigh(s);
  const Patch& patch = *s.patch;
  const double h = s.constants->smoothing, softening = 0.01 * h * h;
  const double *const own_weight = own_weight_.data(), *const drag_of = drag_.data(),
                      *const density = patch.density.data();
  const auto v = view(patch.v);
  with_kernel<D>(s.constants->kernel, [&](auto kernel) {
    using Kernel = decltype(kernel);
    const double inverse_w = 1 / Kernel::w(s.constants->spacing, 1 / h);
    const double mean = mean_repulsion<D, Kernel>(*s.constants);
    parallel_for(static_cast<std::ptrdiff_t>(s.elastic.size()), [&](std::ptrdiff_t k) {
      const Index i = s.elastic[k];
      if (patch.elastic[i] != static_cast<std::uint8_t>(Elastic::free)) return;
      const double rho = patch.density[i];
      thread_local PairFactors of_pair;
      const Index first = s.pairs->begin(i);
      of_pair.resize(s.pairs->filled_end(i) - first);
      double *const stress = of_pair.stress.data(), *const repulsion = of_pair.repulsion.data();
      // Vectors that meet the stress and the artificial stress of i, and the drag.
      const auto sums = s.pairs->sum_row<D, 3 * D>(i, [&](const sph::PairLanes<D>& p) {
        const sph::Lanes f = p.w * inverse_w, f2 = f * f;
        const sph::Lanes own = p.of(own_weight) * p.f, near = own * (f2 * f2 - mean);
        sph::store(stress + (p.k - first), own);
        sph::store(repulsion + (p.k - first), near);
        sph::Lanes along = 0;
        for (int c = 0; c < D; ++c) along += (patch.v[c][i] - p.of(v[c])) * p.x[c];
        const sph::Lanes mean_density = 0.5 * (rho + p.of(density));
        const sph::Lanes drag =
            p.of(drag_of) * p.f * min(along, sph::Lanes(0)) / (mean_density * (p.r2() + softening));
        std::array<sph::Lanes, 3 * D> out;
        for (int c = 0; c < D; ++c) {
          out[c] = own * p.x[c];
          out[D + c] = near * p.x[c];
          out[2 * D + c] = drag * p.x[c];
        }
        return out;
      });
      const double* const tensors = tensors_.data() + tensors_begin<D>(i);
      const Matrix<D> traction = load_matrix<D>(tensors),
                      artificial = load_matrix<D>(tensors + kColumnsSize<D>);
      Vector<D> force = traction * vector<D>(sums, 0) + artificial * vector<D>(sums, 1) +
                        stress_of_neighbours<D>(s, i, of_pair, tensors_.data());
      if (s.pairs->next_to_wall()[i]) force += along_slip_faces<D>(s, i, traction);
      if (s.pairs->next_to_melt()[i]) force += pressure_of_melt<D>(s, i);
      for (int c = 0; c < D; ++c) acceleration[c][i] += force[c] / rho + h * sums[2 * D + c];
      acceleration[D - 1][i] -= gravity;
    });
  });
}

}  // namespace meltray::terms
