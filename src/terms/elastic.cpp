// SPDX-License-Identifier: MIT
#include "meltray/terms/elastic.hpp"

#include <cmath>

#include "terms/elastic_vectors.hpp"

namespace meltray::terms {

namespace {

template <int D>
using Matrix = Eigen::Matrix<double, D, D>;

/// Below this determinant of the moments a particle has hardly neighbours (a corner of a cube has 0.03) and
/// its gradient stays as it is.
constexpr double kWellPosed = 0.01;

template <int D>
Matrix<D> correction(const Matrix<D>& moment, double second_moment) {
  if (moment.determinant() < kWellPosed) return Matrix<D>::Identity() / second_moment;
  return moment.inverse();
}

template <int D>
Matrix<D> deviator(const Patch& patch, Index i) {
  Matrix<D> s;
  int n = 0;
  for (int a = 0; a < D; ++a)
    for (int b = a; b < D; ++b) s(a, b) = s(b, a) = patch.stress[n++][i];
  return s;
}

/// -epsilon times the tensile part of a stress in its principal frame.
template <int D>
Matrix<D> repulsion(const Matrix<D>& sigma, double epsilon) {
  if (Eigen::LLT<Matrix<D>>(-sigma).info() == Eigen::Success) return Matrix<D>::Zero();  // no tension at all
  Eigen::SelfAdjointEigenSolver<Matrix<D>> principal;
  principal.computeDirect(sigma);
  const Eigen::Matrix<double, D, 1> tension = principal.eigenvalues().cwiseMax(0.0);
  const auto& frame = principal.eigenvectors();
  return -epsilon * frame * tension.asDiagonal() * frame.transpose();
}

/// Moments and velocity gradient before renormalisation of one elastic particle.
template <int D>
struct Gradients {
  Matrix<D> moment, velocity;
};

/// What a wall adds to a gradient that took its dummies' own velocity: velocities that go on linearly behind
/// the face, for the components that the face holds; the distance of the particle is kept above half a
/// spacing.
template <int D>
void extend_behind_walls(const Stage& s, Index i, Matrix<D>& gradient) {
  s.pairs->for_row<D>(i, [&](const sph::Pair<D>& p) {
    if (!s.patch->wall[p.j]) return;
    const WallFace& face = s.constants->faces[s.patch->wall[p.j] - 1];
    const double behind = std::abs(s.patch->x[face.axis][p.j] - face.plane);
    const double before =
        std::max(std::abs(s.patch->x[face.axis][i] - face.plane), 0.5 * s.constants->spacing);
    for (int a = 0; a < D; ++a) {
      const double more = a == face.axis || face.no_slip ? behind / before : -1.0;
      const double u = s.patch->v[a][i] - s.patch->v[a][p.j];
      for (int b = 0; b < D; ++b) gradient(a, b) -= s.volume[p.j] * p.f * more * u * p.x[b];
    }
  });
}

/// Sums of a row: of the moment, which is symmetric, then of the velocity gradient.
template <int D>
inline constexpr int kGradientSums = symmetric_count(D) + (D * D);

template <int D>
Gradients<D> gradients(const Stage& s, Index i, const double* volume) {
  const auto v = view(static_cast<const Patch&>(*s.patch).v);
  const auto sums = s.pairs->sum_row<D, kGradientSums<D>>(i, [&](const sph::PairLanes<D>& p) {
    const sph::Lanes vf = p.of(volume) * p.f;
    std::array<sph::Lanes, kGradientSums<D>> out;
    int n = 0;
    for (int a = 0; a < D; ++a)
      for (int b = a; b < D; ++b) out[n++] = -vf * p.x[a] * p.x[b];
    for (int a = 0; a < D; ++a) {
      const sph::Lanes u = vf * (p.of(v[a]) - v[a][i]);
      for (int b = 0; b < D; ++b) out[n++] = u * p.x[b];
    }
    return out;
  });
  Gradients<D> out;
  int n = 0;
  for (int a = 0; a < D; ++a)
    for (int b = a; b < D; ++b) out.moment(a, b) = out.moment(b, a) = sums[n++];
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) out.velocity(a, b) = sums[n++];
  if (s.pairs->next_to_wall()[i]) extend_behind_walls<D>(s, i, out.velocity);
  return out;
}

}  // namespace

double ElasticSolid::reference_density(const SceneConstants& constants, double temperature) const {
  return constants.density * std::exp(3 * expansion * (constants.melting_temperature() - temperature));
}

double ElasticSolid::pressure(double density, double reference) const {
  return bulk_modulus * (density / reference - 1);
}

double ElasticSolid::sound_speed(double density) const {
  return std::sqrt((bulk_modulus + 4.0 / 3 * shear_modulus) / density);
}

void ElasticSolid::update(Stage& s) const {
  parallel_for(static_cast<std::ptrdiff_t>(s.elastic.size()), [&](std::ptrdiff_t k) {
    const Index i = s.elastic[k];
    s.volume[i] = s.patch->mass[i] / s.patch->density[i];
  });
}

template <int D>
void ElasticSolid::add_stress_rates(const Stage& s, const Rates& rates) const {
  const Index n = s.size();
  solid_volume_.resize(n);
  tensors_.resize(static_cast<std::size_t>(n) * 2 * kColumnsSize<D>);
  parallel_for(n, [&](Index i) { solid_volume_[i] = s.patch->liquid[i] ? 0.0 : s.volume[i]; });
  parallel_for(static_cast<std::ptrdiff_t>(s.elastic.size()), [&](std::ptrdiff_t k) {
    const Index i = s.elastic[k];
    const auto g = gradients<D>(s, i, solid_volume_.data());
    const Matrix<D> correct = correction<D>(g.moment, s.constants->lattice.second_moment);
    const Matrix<D> gradient = g.velocity * correct;
    const Matrix<D> strain = 0.5 * (gradient + gradient.transpose()), spin = gradient - strain;
    const double rho = s.patch->density[i], dilation = strain.trace();
    const Matrix<D> stress = deviator<D>(*s.patch, i);
    const Matrix<D> rate =
        2 * shear_modulus * (strain - dilation / 3 * Matrix<D>::Identity()) + spin * stress - stress * spin;
    int c = 0;
    for (int a = 0; a < D; ++a)
      for (int b = a; b < D; ++b) rates.stress[c++][i] += rate(a, b);
    rates.density[i] -= rho * dilation;

    const double p = pressure(rho, reference_density(*s.constants, s.temperature[i]));
    const Matrix<D> sigma = stress - p * Matrix<D>::Identity();
    double* const tensors = tensors_.data() + tensors_begin<D>(i);
    store_matrix<D>(sigma * correct, tensors);
    store_matrix<D>(repulsion<D>(sigma, artificial_stress), tensors + kColumnsSize<D>);
  });
}

template void ElasticSolid::add_stress_rates<2>(const Stage&, const Rates&) const;
template void ElasticSolid::add_stress_rates<3>(const Stage&, const Rates&) const;

}  // namespace meltray::terms
