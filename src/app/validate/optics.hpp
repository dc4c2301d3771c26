// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "meltray/laser/laser.hpp"

namespace meltray::app {

inline constexpr std::complex<double> kIron{2.927, 4.377}, kAluminium{1.3998, 9.8914};

/// |in - absorbed - escaped - residual - dropped| / in.
double ledger_error(const laser::Ledger& ledger);

/// Options for metal of one index, solid and liquid; tracked light is unpolarised.
laser::TraceOptions metal(std::complex<double> index, laser::Polarisation polarisation);

/// Positions of particles, in a form that the surface reconstruction takes.
struct Cloud {
  Components x;
  double spacing = 0;
  void add(const Vec3& p);
  laser::PointCloud view() const;
};

/// Uniform in [-1, 1), the same on every machine.
class Noise {
 public:
  double operator()();

 private:
  std::uint64_t state_ = 1;
};

}  // namespace meltray::app
