// SPDX-License-Identifier: MIT
#include "meltray/terms/pressure/acoustic_pass.hpp"

#include <algorithm>

#include "meltray/core/memory.hpp"
#include "meltray/sph/renormalise.hpp"
#include "terms/pressure/acoustic_kernel.hpp"

namespace meltray::terms {

namespace {

static_assert(kOctetSlots == sph::kLanes && kRowsOfGroup == sph::kGroupRows);

/// Groups of rows that one task handles.
constexpr Index kGroupsPerBlock = 32;
/// Monaghan 2000: repulsion as a share of a negative pressure, and of the sum of two positive ones.
constexpr double kUnderTension = 0.2, kUnderPressure = 0.01;

enum Kind : std::uint8_t { kOther, kMelt, kWall };

const AcousticKernel& kernel_of(const Stage& s) {
  return acoustic_kernel(s.constants->dim, s.constants->kernel == sph::KernelType::cubic_spline);
}

using Loop = void (*)(const AcousticArguments&, Index, Index);

void run(Loop loop, const AcousticArguments& a, Index groups) {
  const Index blocks = (groups + kGroupsPerBlock - 1) / kGroupsPerBlock;
#pragma omp parallel for schedule(static) if (blocks > 4)
  for (Index b = 0; b < blocks; ++b)
    loop(a, b * kGroupsPerBlock, std::min(groups, (b + 1) * kGroupsPerBlock));
}

/// Calls f(slot, particle) for the particles of a set.
template <class F>
void for_particles(const sph::ClusterSet& set, F&& f) {
  parallel_for(set.slots(), [&](Index s) {
    if (const Index i = set.particle()[s]; i >= 0) f(s, i);
  });
}

template <int D>
void renormalise(Index slots, const std::array<AlignedDoubles, 6>& moments,
                 std::array<AlignedDoubles, 3>& gradient) {
  parallel_for(slots, [&](Index s) {
    Eigen::Matrix<double, D, D> moment;
    Eigen::Matrix<double, D, 1> g;
    int n = 0;
    for (int a = 0; a < D; ++a) {
      g[a] = gradient[a][s];
      for (int b = a; b < D; ++b) moment(a, b) = moment(b, a) = moments[n++][s];
    }
    g = sph::renormalisation<D>(moment) * g;
    for (int a = 0; a < D; ++a) gradient[a][s] = g[a];
  });
}

}  // namespace

void AcousticPass::Fields::pack(const Stage& s) {
  const Patch& p = *s.patch;
  const int dim = s.constants->dim;
  const Index slots = set.slots();
  for (int c = 0; c < dim; ++c) {
    x[c].resize(slots);
    v[c].resize(slots);
  }
  for (auto* field : {&density, &volume, &pressure}) field->resize(slots);
  parallel_for(slots, [&](Index slot) {
    const Index i = set.particle()[slot];
    for (int c = 0; c < dim; ++c) {
      x[c][slot] = i < 0 ? sph::kNowhere : p.x[c][i];
      v[c][slot] = i < 0 ? 0 : p.v[c][i];
    }
    density[slot] = i < 0 ? s.constants->density : p.density[i];
    volume[slot] = i < 0 ? 0 : s.volume[i];
    pressure[slot] = i < 0 ? 0 : p.pressure[i];
  });
}

AcousticFields AcousticPass::Fields::view() {
  AcousticFields f{};
  for (int c = 0; c < 3; ++c) {
    f.x[c] = x[c].data();
    f.v[c] = v[c].data();
    f.gradient[c] = gradient[c].data();
  }
  f.density = density.data();
  f.volume = volume.data();
  f.pressure = pressure.data();
  f.drag = drag.data();
  f.excess = excess.data();
  return f;
}

AcousticArguments AcousticPass::arguments(const Stage& s) {
  const SceneConstants& k = *s.constants;
  AcousticArguments a{};
  a.melt = melt_.view();
  a.wall = wall_.view();
  a.melt_melt = {melt_melt_.start(), melt_melt_.octets()};
  a.melt_wall = {melt_wall_.start(), melt_wall_.octets()};
  a.wall_melt = {wall_melt_.start(), wall_melt_.octets()};
  a.smoothing = k.smoothing;
  for (int c = 0; c < k.dim; ++c) {
    a.period[c] = period_[c];
    a.inverse_period[c] = a.period[c] > 0 ? 1 / a.period[c] : 0;
  }
  a.continuity = 1 / k.lattice.second_moment;
  a.diffusion = diffusion.coefficient * k.smoothing * state.sound_speed / k.lattice.second_moment;
  a.own_pressure = force.form == GradientForm::sum ? 1 : -1;
  if (state.tension == Tension::artificial_stress)
    sph::with_dim(k.dim, [&](auto d) {
      with_kernel<d>(k.kernel,
                     [&](auto kernel) { a.inverse_w = 1 / decltype(kernel)::w(k.spacing, 1 / k.smoothing); });
    });
  a.stress_tension = kUnderTension;
  a.stress_pressure = force.form == GradientForm::sum ? kUnderPressure : 0.0;
  a.gradients = diffusion.needs_gradients();
  a.viscosity = 2 * artificial.alpha * state.sound_speed * k.smoothing * k.lattice.second_moment;
  a.gravity = state.gravity;
  a.density_rate = density_rate_.data();
  for (int c = 0; c < 3; ++c) {
    a.force[c] = force_[c].data();
  }
  for (int m = 0; m < 6; ++m) a.moment[m] = moment_[m].data();
  a.wall_pressure = wall_.pressure.data();
  return a;
}

void AcousticPass::find_pairs(Stage& s, double skin, const std::array<double, 3>& period) {
  const SceneConstants& k = *s.constants;
  const bool listed = s.pairs->rows() == s.size();
  period_ = period;
  kind_.assign(s.size(), kOther);
  for (Index i = 0; i < s.size(); ++i)
    if (s.patch->liquid[i])
      kind_[i] = kMelt;
    else if (!listed || s.pairs->next_to_melt()[i])
      kind_[i] = kWall;
  melt_.set.sort(*s.patch, kind_, kMelt, k.spacing, period);
  wall_.set.sort(*s.patch, kind_, kWall, k.spacing, period);
  const double reach = 2 * k.smoothing + skin;
  if (!listed) {  // most walls are far from the melt
    wall_melt_.build(wall_.set, melt_.set, reach);
    for_particles(wall_.set, [&](Index slot, Index i) {
      if (wall_melt_.neighbours()[slot] == 0) kind_[i] = kOther;
    });
    wall_.set.sort(*s.patch, kind_, kWall, k.spacing, period);
  }
  melt_melt_.build(melt_.set, melt_.set, reach);
  melt_wall_.build(melt_.set, wall_.set, reach);
  wall_melt_.build(wall_.set, melt_.set, reach);
  if (!listed)
    for_particles(melt_.set, [&](Index slot, Index i) {
      const Index count = melt_melt_.neighbours()[slot] + melt_wall_.neighbours()[slot] - 1;
      s.loose[i] = k.free_surface && count < fewest_neighbours(k.dim);
    });
  density_rate_.resize(melt_.set.slots());
  melt_.set.close();
  wall_.set.close();
  const Index sloped = diffusion.needs_gradients() ? melt_.set.slots() : 0;
  for (int c = 0; c < k.dim; ++c) {
    force_[c].resize(melt_.set.slots());
    melt_.gradient[c].resize(sloped);
  }
  for (int m = 0; m < symmetric_count(k.dim); ++m) moment_[m].resize(sloped);
  if (artificial.alpha == 0) return;
  // Slip walls take no part in artificial viscosity.
  wall_.drag.assign(wall_.set.slots(), 0.0);
  for_particles(wall_.set, [&](Index slot, Index i) {
    const int wall = s.patch->wall[i];
    wall_.drag[slot] = wall && !k.faces[wall - 1].no_slip ? 0.0 : 1.0;
  });
}

void AcousticPass::gather(Stage& s) {
  melt_.pack(s);
  melt_.set.pack(s.excess, 0, melt_.excess);
  wall_.pack(s);
  run(kernel_of(s).extrapolate, arguments(s), wall_.set.groups());
  const bool pulls = state.tension != Tension::none;
  for_particles(wall_.set, [&](Index slot, Index i) {
    if (!pulls) wall_.pressure[slot] = std::max(wall_.pressure[slot], 0.0);
    s.patch->pressure[i] = wall_.pressure[slot];
  });
}

void AcousticPass::evaluate(const Stage& s) {
  const AcousticArguments a = arguments(s);
  const AcousticKernel& kernel = kernel_of(s);
  if (diffusion.needs_gradients()) {
    run(kernel.excess_gradient, a, melt_.set.groups());
    sph::with_dim(s.constants->dim,
                  [&](auto d) { renormalise<d>(melt_.set.slots(), moment_, melt_.gradient); });
  }
  run(kernel.rates, a, melt_.set.groups());
}

void AcousticPass::add_rates(const Stage& s, double* density_rate, const MutField& acceleration) const {
  const Patch& p = *s.patch;
  const int dim = s.constants->dim;
  const double relax = state.sound_speed / s.constants->smoothing,
               scale = 1 / s.constants->lattice.second_moment;
  for_particles(melt_.set, [&](Index slot, Index i) {
    double rate = density_rate_[slot];
    const double thinnest = -state.tear * (p.density[i] - s.excess[i]);
    if (s.loose[i])
      rate -= s.excess[i] * relax;
    else if (s.excess[i] < thinnest)
      rate -= (s.excess[i] - thinnest) * relax;
    density_rate[i] += rate;
    const double factor = scale * s.volume[i] / p.mass[i];
    for (int c = 0; c < dim; ++c) acceleration[c][i] -= factor * force_[c][slot];
  });
}

void AcousticPass::release() {
  free_memory(kind_, melt_, wall_, melt_melt_, melt_wall_, wall_melt_, density_rate_, force_, moment_);
}

const char* AcousticPass::instructions() {
  return acoustic_kernel(3, false).instructions;
}

std::size_t AcousticPass::Fields::bytes() const {
  return set.bytes() + held_bytes(density, volume, pressure, drag, excess) + held_bytes(x) + held_bytes(v) +
         held_bytes(gradient);
}

std::size_t AcousticPass::bytes() const {
  return melt_.bytes() + wall_.bytes() + melt_melt_.bytes() + melt_wall_.bytes() + wall_melt_.bytes() +
         held_bytes(kind_, density_rate_) + held_bytes(force_) + held_bytes(moment_);
}

}  // namespace meltray::terms
