// SPDX-License-Identifier: MIT
#include "app/validate/optics.hpp"

#include <cmath>

namespace meltray::app {

double ledger_error(const laser::Ledger& l) {
  return std::abs(l.in - l.absorbed - l.escaped - l.residual - l.dropped) / l.in;
}

laser::TraceOptions metal(std::complex<double> index, laser::Polarisation polarisation) {
  laser::TraceOptions options;
  options.index_solid = options.index_liquid = index;
  options.polarisation = polarisation;
  options.polarisation_xy = {0, 0};
  return options;
}

void Cloud::add(const Vec3& p) {
  for (int c = 0; c < 3; ++c) x[static_cast<std::size_t>(c)].push_back(p[c]);
}

laser::PointCloud Cloud::view() const {
  return {meltray::view(x), x[0].size(), nullptr, spacing};
}

double Noise::operator()() {  // xorshift64*, Vigna 2016
  state_ ^= state_ >> 12;
  state_ ^= state_ << 25;
  state_ ^= state_ >> 27;
  return static_cast<double>((state_ * 0x2545f4914f6cdd1dULL) >> 11) * (2.0 / 9007199254740992.0) - 1;
}

}  // namespace meltray::app
