// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "laser/cubes.hpp"
#include "meltray/laser/laser.hpp"

namespace meltray::laser {

namespace {

constexpr int kFewest = 100;              // rays: fewer leave gaps in the beam itself
constexpr double kForgetting = 1.0 / 16;  // of what the last trace taught

}  // namespace

double sampling_error(std::span<const Hit> hits, double edge) {
  const Cubes cubes(hits, edge);
  std::vector<std::pair<std::uint64_t, double>> signed_power;
  signed_power.reserve(hits.size());
  double total = 0;
  for (const Hit& hit : hits) {
    signed_power.emplace_back(cubes.number(hit.position), hit.ray % 2 ? -hit.power : hit.power);
    total += hit.power;
  }
  if (!(total > 0)) return 0;
  std::stable_sort(signed_power.begin(), signed_power.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  double difference = 0;
  for (std::size_t h = 0; h < signed_power.size();) {
    double sum = 0;
    const std::uint64_t cube = signed_power[h].first;
    for (; h < signed_power.size() && signed_power[h].first == cube; ++h) sum += signed_power[h].second;
    difference += std::abs(sum);
  }
  return difference / total;
}

int RayCount::next() const {
  if (constant_ <= 0) return most_;
  const double wanted = std::ceil(constant_ / (target_ * target_));
  return static_cast<int>(
      std::clamp(wanted, static_cast<double>(std::min(kFewest, most_)), static_cast<double>(most_)));
}

void RayCount::learn(double error, int rays) {
  const double found = error * error * rays;
  constant_ = constant_ > 0 ? constant_ + kForgetting * (found - constant_) : found;
}

}  // namespace meltray::laser
