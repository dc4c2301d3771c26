// SPDX-License-Identifier: MIT
#include "meltray/terms/pressure/projection.hpp"

#include <cmath>

#include "meltray/core/memory.hpp"
#include "meltray/sph/renormalise.hpp"
#include "terms/pressure/surface_part.hpp"

namespace meltray::terms {

namespace {

/// Share of what the sum of a flat face's row lacks that ties a component to the free surface.
constexpr double kAnchor = 0.3;
/// Density excess of a surface particle that disorder explains and that is not corrected.
constexpr double kTolerated = 0.03;

}  // namespace

void Projection::assemble(const Stage& s) {
  const Index n = s.size();
  const auto& pairs = *s.pairs;
  const auto& wall_of_melt = pairs.next_to_melt();
  row_of_.assign(n, -1);
  solved_volume_.assign(n, 0.0);
  melt_volume_.assign(n, 0.0);
  particle_of_.clear();
  for (Index i = 0; i < n; ++i) {
    if (s.loose[i] || !(s.patch->liquid[i] || wall_of_melt[i])) continue;
    row_of_[i] = static_cast<Index>(particle_of_.size());
    particle_of_.push_back(i);
    solved_volume_[i] = s.volume[i];
    if (s.patch->liquid[i]) melt_volume_[i] = s.volume[i];
  }
  const Index rows = static_cast<Index>(particle_of_.size());
  matrix_.diagonal.resize(rows);
  matrix_.start.resize(rows + 1);
  ghost_.resize(rows);
  matrix_.start[0] = 0;
  parallel_for(rows, [&](Index r) {
    const Index i = particle_of_[r];
    const double* const partner = partner_volume(s, i);
    Index count = 0;
    for (Index k = pairs.begin(i); k < pairs.end(i); ++k) count += partner[pairs.neighbour(k)] > 0;
    matrix_.start[r + 1] = count;
  });
  for (Index r = 0; r < rows; ++r) matrix_.start[r + 1] += matrix_.start[r];
  resize_anew(matrix_.column, matrix_.start[rows]);
  resize_anew(matrix_.off, matrix_.start[rows]);
  const auto& lattice = s.constants->lattice;
  const double scale = 2 / (s.constants->density * lattice.second_moment);
  const double full = scale * lattice.laplacian;
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    const double *const solved = solved_volume_.data(), *const melt = melt_volume_.data();
    parallel_for(rows, [&](Index r) {
      const Index i = particle_of_[r];
      const double* const partner = partner_volume(s, i);
      const double own = s.patch->liquid[i] ? 0.5 : 0.0;
      Index out = matrix_.start[r];
      double sum = 0;
      pairs.for_lanes<D>(i, [&](const sph::PairLanes<D>& p) {
        // Mean 1/m of the pair over that of the melt, times V_j.
        const sph::Lanes mobile = own * p.of(solved) + 0.5 * p.of(melt);
        std::array<float, sph::kLaneCount> a;
        sph::store(a.data(), (mobile * s.volume[i]) * (-scale * p.f));
        for (Index lane = 0; lane < sph::kLaneCount; ++lane) {
          const Index j = p.j[lane];
          if (partner[j] == 0 || j == i) continue;
          matrix_.column[out] = row_of_[j];
          matrix_.off[out++] = a[lane];
          sum += a[lane];
        }
      });
      // A pressure that is linear from the surface inwards, half a spacing away, solves the row of a flat
      // face, pressed together or not. In drops, edges and films, where the gradient of the colour vanishes
      // by symmetry, what the sum lacks is the larger.
      double open = 0;
      for (int c = 0; c < D; ++c) open += s.grad_c[c][i] * s.grad_c[c][i];
      const double ghost =
          std::max(full * (1 - s.diagonal[i]), scale * std::sqrt(open) / (0.5 * s.constants->spacing));
      ghost_[r] = s.patch->liquid[i] ? s.surface[i] * s.volume[i] * ghost : 0.0;
      matrix_.diagonal[r] = sum + ghost_[r];
    });
  });
  // A component hangs on the free surface only if some row's ghost weight is a fair share of what a flat
  // face lacks;
  // the mean of the source would else leave through one weak row. Without that, the component is a closed
  // pocket.
  anchor_.resize(rows);
  parallel_for(rows, [&](Index r) {
    const double fair = kAnchor * (1 - lattice.face_diagonal) * full * s.volume[particle_of_[r]];
    anchor_[r] = ghost_[r] >= fair ? 1.0 : 0.0;
  });
  floating_ = solve::floating_components(matrix_, anchor_, group_, scratch_);
  for (Index r = 0; r < rows; ++r)
    if (group_[r] > 0) {
      matrix_.diagonal[r] -= ghost_[r];
      ghost_[r] = 0;
    }
}

/// Of all patch particles, volumes of those that particle i has an entry with, 0 of the others: what stays
/// where it is has an infinite mass and passes no pressure on.
const double* Projection::partner_volume(const Stage& s, Index i) const {
  return s.patch->liquid[i] ? solved_volume_.data() : melt_volume_.data();
}

/// What the tangential velocity of the melt around a fixed particle adds to its divergence, for a field u.
/// Where the melt ends, as at the front of a film that runs over a dry floor, melt on one side only would
/// look as if it were compressed, and the pressure of that would hold the front back. Away from the free
/// surface nothing is taken off: there a linear pressure is exact, corners included.
template <int D>
double Projection::sliding(const Stage& s, Index i, const ConstField& u) const {
  using Vector = Eigen::Matrix<double, D, 1>;
  // Sums over the melt: velocity, gradient of its share, the share itself and that of its surface; and the
  // gradient of the share of what is fixed.
  const auto sum = s.pairs->sum_row<D, 3 * D + 2>(i, [&](const sph::PairLanes<D>& p) {
    const sph::Lanes volume = p.of(s.volume.data()), melt = p.of(s.patch->liquid.data()),
                     share = volume * p.w * melt, slope = volume * p.f, slope_of_melt = slope * melt;
    std::array<sph::Lanes, 3 * D + 2> out;
    for (int c = 0; c < D; ++c) {
      out[c] = share * (p.of(u[c]) - u[c][i]);
      out[D + c] = slope_of_melt * p.x[c];
      out[2 * D + c] = (slope - slope_of_melt) * p.x[c];
    }
    out[3 * D] = share;
    out[3 * D + 1] = share * p.of(s.surface.data());
    return out;
  });
  const double weight = sum[3 * D], at_surface = sum[3 * D + 1];
  if (at_surface == 0) return 0;
  Vector velocity(sum.data()), open(sum.data() + D), normal(sum.data() + 2 * D);
  // Dummies end where the box ends: their normal is that of their face.
  if (s.patch->wall[i]) normal = Vector::Unit(s.constants->faces[s.patch->wall[i] - 1].axis);
  velocity /= weight;
  if (normal.squaredNorm() > 0) velocity -= velocity.dot(normal) / normal.squaredNorm() * normal;
  return at_surface / weight * velocity.dot(open);
}

void Projection::divergence(const Stage& s, const ConstField& u, std::vector<double>& out) const {
  out.resize(particle_of_.size());
  const double scale = 1 / s.constants->lattice.second_moment;
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    const double* const volume = s.volume.data();
    parallel_for(rows(), [&](Index r) {
      const Index i = particle_of_[r];
      double ui[D];
      for (int c = 0; c < D; ++c) ui[c] = u[c][i];
      const auto sum = s.pairs->sum_row<D, 1>(i, [&](const sph::PairLanes<D>& p) {
        sph::Lanes dot = 0;
        for (int c = 0; c < D; ++c) dot += (p.of(u[c]) - ui[c]) * p.x[c];
        return std::array<sph::Lanes, 1>{p.of(volume) * p.f * dot};
      });
      // Fixed particles stop what comes along their normal; what slides past them they let pass.
      out[r] = scale * (s.patch->liquid[i] ? sum[0] : sum[0] - sliding<D>(s, i, u));
    });
  });
}

void Projection::divergence_rate(const Stage& s, const ConstField& v, std::vector<double>& out) const {
  // D(div v)/Dt = div a - d_a v_b d_b v_a, with a renormalised gradient: the exact derivative of the discrete
  // divergence counts strain along the lattice a fifth too much at h = 1.3 dx.
  out.resize(particle_of_.size());
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    using Matrix = Eigen::Matrix<double, D, D>;
    constexpr int kEntries = D * D;
    parallel_for(rows(), [&](Index r) {
      const Index i = particle_of_[r];
      const auto sum = s.pairs->sum_row<D, kEntries + symmetric_count(D)>(i, [&](const sph::PairLanes<D>& p) {
        const sph::Lanes vf = p.of(s.volume.data()) * p.f;
        std::array<sph::Lanes, kEntries + symmetric_count(D)> out;
        for (int a = 0; a < D; ++a) {
          const sph::Lanes du = vf * (p.of(v[a]) - v[a][i]);
          for (int b = 0; b < D; ++b) out[a * D + b] = du * p.x[b];
        }
        sph::moments<D>(vf, p, out.data() + kEntries);
        return out;
      });
      const Matrix moment = sph::symmetric<D>(sum.data() + kEntries),
                   gradient = Eigen::Map<const Eigen::Matrix<double, D, D, Eigen::RowMajor>>(sum.data()) *
                              sph::renormalisation<D>(moment);
      out[r] = -(gradient * gradient).trace();
    });
  });
}

void Projection::compression(const Stage& s, std::vector<double>& out) const {
  out.resize(particle_of_.size());
  const auto& lattice = s.constants->lattice;
  const double open = 1 - lattice.face_fill;
  const double full = 2 / (s.constants->density * lattice.second_moment) * lattice.laplacian;
  parallel_for(rows(), [&](Index r) {
    const Index i = particle_of_[r];
    if (s.patch->wall[i]) {
      // Dummies lack neighbours where the box ends.
      out[r] = std::max(0.0, s.fill[i] - 1);
    } else if (!s.constants->free_surface) {
      out[r] = s.fill[i] - 1;
    } else {
      // What the open side of a flat face lacks is added, so that a pressed surface layer shows; anything
      // emptier than that is shape, not density.
      const double excess = s.fill[i] + open * s.exposure[i] - 1;
      const bool inside = s.surface[i] == 0 && s.fill[i] > 0.97;
      out[r] = inside ? s.fill[i] - 1 : std::max(0.0, excess - kTolerated);
    }
    // Of what surrounds a fixed particle only the melt can give way.
    if (!s.patch->liquid[i]) out[r] *= 2 * matrix_.diagonal[r] / (full * s.volume[i]);
  });
}

solve::SolveReport Projection::solve(const Stage& s, const std::vector<double>& source,
                                     const ProjectionOptions& options) {
  rhs_.resize(rows());
  x_.resize(rows());
  parallel_for(rows(), [&](Index r) {
    const Index i = particle_of_[r];
    rhs_[r] = -s.volume[i] * source[r] + ghost_[r] * s.surface_pressure[i];
    x_[r] = s.patch->pressure[i];
  });
  // A closed pocket: its source has no sum, its pressure no mean. Rows take up the sum by their coupling, for
  // a fixed particle that hardly touches the melt cannot take a whole share.
  const auto remove = [&](std::vector<double>& a, auto&& share) {
    group_sum_.assign(floating_ + 1, 0.0);
    group_share_.assign(floating_ + 1, 0.0);
    for (Index r = 0; r < rows(); ++r) {
      group_sum_[group_[r]] += a[r];
      group_share_[group_[r]] += share(r);
    }
    for (Index r = 0; r < rows(); ++r)
      if (group_[r] > 0 && share(r) > 0) a[r] -= group_sum_[group_[r]] * share(r) / group_share_[group_[r]];
  };
  if (floating_ > 0) remove(rhs_, [&](Index r) { return matrix_.diagonal[r]; });
  const auto report = options.solver == PressureSolver::cholesky
                          ? solve_exactly()
                          : cg_.solve(matrix_, rhs_, x_, options.tolerance, options.max_iterations);
  if (floating_ > 0) remove(x_, [](Index) { return 1.0; });
  std::fill(s.patch->pressure.begin(), s.patch->pressure.end(), 0.0);
  parallel_for(rows(), [&](Index r) { s.patch->pressure[particle_of_[r]] = x_[r]; });
  return report;
}

solve::SolveReport Projection::solve_exactly() {
  if (!direct_) direct_.emplace();
  std::vector<Index> held;  // the first row of each pocket
  std::vector<bool> seen(static_cast<std::size_t>(floating_) + 1, false);
  for (Index r = 0; r < rows(); ++r)
    if (group_[r] > 0 && !seen[group_[r]]) {
      seen[group_[r]] = true;
      held.push_back(r);
    }
  return direct_->solve(matrix_, rhs_, held, x_);
}

void Projection::add_acceleration(const Stage& s, SurfaceEntry entry, const MutField& acceleration) const {
  const double rho = s.constants->density;
  const double plain = 1 / s.constants->lattice.second_moment;
  sph::with_dim(s.constants->dim, [&](auto d) {
    constexpr int D = d;
    using Vector = Eigen::Matrix<double, D, 1>;
    const double *const p = s.patch->pressure.data(), *const volume = s.volume.data();
    const double* const solved = solved_volume_.data();
    parallel_for(static_cast<std::ptrdiff_t>(s.moving.size()), [&](std::ptrdiff_t k) {
      const Index i = s.moving[k];
      if (row_of_[i] < 0) return;
      const double pi = p[i];
      // Partners outside the system (deeper solid, loose drops) have no pressure: zero normal derivative.
      const auto sum = s.pairs->sum_row<D, D>(i, [&](const sph::PairLanes<D>& q) {
        const sph::Lanes g = q.of(solved) * q.f * (q.of(p) - pi);
        std::array<sph::Lanes, D> out;
        for (int c = 0; c < D; ++c) out[c] = g * q.x[c];
        return out;
      });
      Vector gradient;
      for (int c = 0; c < D; ++c) gradient[c] = sum[c];
      if (entry == SurfaceEntry::pressure && s.surface[i] > 0) {
        const auto moment = s.pairs->sum_row<D, symmetric_count(D)>(i, [&](const sph::PairLanes<D>& q) {
          std::array<sph::Lanes, symmetric_count(D)> out;
          sph::moments<D>(q.of(volume) * q.f, q, out.data());
          return out;
        });
        gradient = sph::renormalisation<D>(sph::symmetric<D>(moment.data())) * gradient;
      } else {
        gradient *= plain;
      }
      if (entry == SurfaceEntry::csf) {
        const double jump =
            surface_part(s.constants->lattice) * s.surface[i] * (p[i] - s.surface_pressure[i]);
        for (int c = 0; c < D; ++c) gradient[c] += jump * s.grad_c[c][i];
      }
      for (int c = 0; c < D; ++c) acceleration[c][i] -= gradient[c] / rho;
    });
  });
}

}  // namespace meltray::terms
