// SPDX-License-Identifier: MIT
#include <cmath>

#include "scene/model.hpp"

/// The elastic solid of a Model: its part of the state, y = [x | v | rho | S] of the elastic particles, all
/// explicit.
namespace meltray::scene {

std::size_t Model::elastic_begin() const {
  return enthalpy_begin() + stage.heated.size();
}

std::size_t Model::elastic_size() const {
  return (2 * constants_.dim + 1 + symmetric_count(constants_.dim)) * stage.elastic.size();
}

void Model::pack_elastic(std::vector<double>& y) const {
  const int dim = constants_.dim;
  std::size_t at = elastic_begin();
  const auto copy = [&](const std::vector<double>& field) {
    for (const Index i : stage.elastic) y[at++] = field[i];
  };
  for (int c = 0; c < dim; ++c) copy(patch.x[c]);
  for (int c = 0; c < dim; ++c) copy(patch.v[c]);
  copy(patch.density);
  for (int c = 0; c < symmetric_count(dim); ++c) copy(patch.stress[c]);
}

void Model::add_elastic_fields(std::vector<StateField>& fields) const {
  const std::size_t ne = stage.elastic.size();
  if (ne == 0) return;
  const int dim = constants_.dim, stresses = symmetric_count(dim);
  const Time& time = scene_.time;
  std::size_t begin = elastic_begin();
  const auto add = [&](const char* name, std::size_t size, double rtol, double atol) {
    fields.push_back({name, begin, size, rtol, atol, {}});
    begin += size;
  };
  // A strain counts alike whether it changes the volume or the shape.
  add("position of solid", dim * ne, 0.0, time.atol_position * constants_.spacing);
  add("velocity of solid", dim * ne, time.rtol, time.atol_velocity);
  add("density of solid", ne, 0.0, time.atol_density * constants_.density);
  add("stress", stresses * ne, 0.0, 2 * elastic_->shear_modulus * time.atol_density);
}

void Model::unpack_elastic(const double* y) {
  const double* from = y + elastic_begin();
  const auto copy = [&](std::vector<double>& field) {
    parallel_for(static_cast<std::ptrdiff_t>(stage.elastic.size()),
                 [&](std::ptrdiff_t k) { field[stage.elastic[k]] = from[k]; });
    from += stage.elastic.size();
  };
  for (int c = 0; c < constants_.dim; ++c) copy(patch.x[c]);
  for (int c = 0; c < constants_.dim; ++c) copy(patch.v[c]);
  copy(patch.density);
  for (int c = 0; c < symmetric_count(constants_.dim); ++c) copy(patch.stress[c]);
}

void Model::add_elastic_rates(terms::Rates& rates) {
  for (int c = 0; c < symmetric_count(constants_.dim); ++c) {
    stress_rate_[c].assign(stage.size(), 0.0);
    rates.stress[c] = stress_rate_[c].data();
  }
  elastic_->add_rates(stage, rates);
}

void Model::finish_elastic_rates(const double* y, double* rate, bool transport) const {
  const auto count = static_cast<std::ptrdiff_t>(stage.elastic.size());
  if (!transport) {
    std::fill_n(rate + elastic_begin(), elastic_size(), 0.0);
    return;
  }
  const int dim = constants_.dim;
  const double* const v = y + elastic_begin() + dim * count;
  double* to = rate + elastic_begin();
  std::copy_n(v, dim * count, to);
  to += dim * count;
  const auto write = [&](const std::vector<double>& field) {
    parallel_for(count, [&](std::ptrdiff_t k) { to[k] = field[stage.elastic[k]]; });
    to += count;
  };
  for (int c = 0; c < dim; ++c) write(acceleration_[c]);
  write(density_rate_);
  for (int c = 0; c < symmetric_count(dim); ++c) write(stress_rate_[c]);
}

double Model::elastic_step() const {
  return scene_.time.cfl_acoustic * constants_.smoothing /
         (elastic_->acoustic_speed(constants_.density) + largest_speed(stage.elastic, true));
}

double Model::density_of_solid(double temperature) const {
  return has_elastic_solid() ? elastic_->reference_density(constants_, temperature) : constants_.density;
}

}  // namespace meltray::scene
