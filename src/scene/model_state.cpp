// SPDX-License-Identifier: MIT
#include <algorithm>

#include "scene/model.hpp"

/// Where the fields of a patch stand in the state vector: positions, velocities and, where it is part of the
/// state, density of the moving particles, enthalpy of the heated ones, what elastic solid adds
/// (model_elastic.cpp), and what has crossed the boundary.
namespace meltray::scene {

namespace {

/// True where a field has, at some particles, the values that follow one another in y.
bool holds(const std::vector<double>& field, const std::vector<Index>& particles, const double* y) {
  return std::all_of(particles.begin(), particles.end(), [&](Index i) { return field[i] == *y++; });
}

}  // namespace

std::size_t Model::enthalpy_begin() const {
  const std::size_t fields = 2 * constants_.dim + (weakly_compressible() ? 1 : 0);
  return flows() ? fields * stage.moving.size() : 0;
}

std::size_t Model::crossings_begin() const {
  return elastic_begin() + elastic_size();
}

void Model::pack(std::vector<double>& y, std::vector<StateField>& fields) {
  const std::size_t nm = flows() ? stage.moving.size() : 0, nh = stage.heated.size();
  const int dim = constants_.dim;
  y.resize(crossings_begin() + terms::Crossings::kCount);
  const std::size_t h = enthalpy_begin();
  parallel_for(static_cast<std::ptrdiff_t>(nm), [&](std::ptrdiff_t k) {
    const Index i = stage.moving[k];
    for (int c = 0; c < dim; ++c) {
      y[c * nm + k] = patch.x[c][i];
      y[(dim + c) * nm + k] = patch.v[c][i];
    }
    if (weakly_compressible()) y[2 * dim * nm + k] = patch.density[i];
  });
  parallel_for(static_cast<std::ptrdiff_t>(nh),
               [&](std::ptrdiff_t k) { y[h + k] = patch.h[stage.heated[k]]; });
  std::fill(y.begin() + crossings_begin(), y.end(), 0.0);
  if (has_elastic_solid()) pack_elastic(y);
  packed_ = y.data();

  const Time& time = scene_.time;
  fields.clear();
  const auto add = [&](const char* name, std::size_t begin, std::size_t size, double rtol, double atol) {
    if (size > 0) fields.push_back({name, begin, size, rtol, atol, {}});
  };
  // Positions and enthalpies have no natural zero: their error counts absolutely.
  add("position", 0, dim * nm, 0.0, time.atol_position * constants_.spacing);
  add("velocity", dim * nm, dim * nm, time.rtol, time.atol_velocity);
  if (weakly_compressible()) add("density", 2 * dim * nm, nm, 0.0, time.atol_density * constants_.density);
  add("enthalpy", h, nh, 0.0, time.atol_temperature * constants_.material.heat_capacity_solid);
  if (has_elastic_solid()) add_elastic_fields(fields);
  add("crossings", crossings_begin(), terms::Crossings::kCount, 0.0, 1e100);
}

void Model::unpack(const double* y) {
  if (y != packed_) packed_ = nullptr;
  const std::size_t nm = flows() ? stage.moving.size() : 0;
  const int dim = constants_.dim;
  parallel_for(static_cast<std::ptrdiff_t>(nm), [&](std::ptrdiff_t k) {
    const Index i = stage.moving[k];
    for (int c = 0; c < dim; ++c) {
      patch.x[c][i] = y[c * nm + k];
      patch.v[c][i] = y[(dim + c) * nm + k];
    }
    if (weakly_compressible()) patch.density[i] = y[2 * dim * nm + k];
  });
  const double* const h = y + enthalpy_begin();
  parallel_for(static_cast<std::ptrdiff_t>(stage.heated.size()),
               [&](std::ptrdiff_t k) { patch.h[stage.heated[k]] = h[k]; });
  if (has_elastic_solid()) unpack_elastic(y);
}

/// True where the patch's positions are those of y.
bool Model::holds_positions(const double* y) const {
  const std::size_t nm = flows() ? stage.moving.size() : 0, ne = stage.elastic.size();
  const double* const elastic = y + elastic_begin();
  for (int c = 0; c < constants_.dim; ++c)
    if ((nm > 0 && !holds(patch.x[c], stage.moving, y + c * nm)) ||
        !holds(patch.x[c], stage.elastic, elastic + c * ne))
      return false;
  return true;
}

/// The same of enthalpies.
bool Model::holds_enthalpies(const double* y) const {
  return holds(patch.h, stage.heated, y + enthalpy_begin());
}

/// The same of velocities, densities and stresses.
bool Model::holds_rest(const double* y) const {
  const int dim = constants_.dim;
  const std::size_t nm = flows() ? stage.moving.size() : 0, ne = stage.elastic.size();
  const double *v = y + dim * nm, *elastic = y + elastic_begin() + dim * ne;
  for (int c = 0; c < dim; ++c, v += nm, elastic += ne)
    if ((nm > 0 && !holds(patch.v[c], stage.moving, v)) || !holds(patch.v[c], stage.elastic, elastic))
      return false;
  if (nm > 0 && weakly_compressible() && !holds(patch.density, stage.moving, v)) return false;
  if (ne == 0) return true;
  if (!holds(patch.density, stage.elastic, elastic)) return false;
  for (int c = 0; c < symmetric_count(dim); ++c)
    if (!holds(patch.stress[c], stage.elastic, elastic += ne)) return false;
  return true;
}

void Model::finish_rates(const double* y, double* rate, const terms::Crossings& crossings, bool transport) {
  const std::size_t nm = flows() ? stage.moving.size() : 0;
  const int dim = constants_.dim;
  const bool shifted = transport && shifting_.coefficient > 0;
  parallel_for(static_cast<std::ptrdiff_t>(nm), [&](std::ptrdiff_t k) {
    const Index i = stage.moving[k];
    for (int c = 0; c < dim; ++c) {
      rate[c * nm + k] = transport ? y[(dim + c) * nm + k] + (shifted ? transport_[c][i] : 0.0) : 0.0;
      rate[(dim + c) * nm + k] = acceleration_[c][i];
    }
    if (weakly_compressible()) rate[2 * dim * nm + k] = transport ? density_rate_[i] : 0.0;
  });
  double* const dh = rate + enthalpy_begin();
  parallel_for(static_cast<std::ptrdiff_t>(stage.heated.size()),
               [&](std::ptrdiff_t k) { dh[k] = heating_[stage.heated[k]]; });
  if (has_elastic_solid()) finish_elastic_rates(y, rate, transport);
  crossings.write(rate + crossings_begin());
}

}  // namespace meltray::scene
