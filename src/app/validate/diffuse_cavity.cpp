// SPDX-License-Identifier: MIT
#include "app/validate/diffuse_cavity.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "meltray/core/constants.hpp"

namespace meltray::app {
namespace {

constexpr int kBands = 400;

double area(const Circle& c) {
  return constants::pi * c.radius * c.radius;
}

double band_area(const Circle& a, const Circle& b) {
  return constants::pi * (a.radius + b.radius) * std::hypot(b.radius - a.radius, b.z - a.z);
}

/// Area of one disc times the view factor from it to the other.
double exchange(const Circle& a, const Circle& b) {
  const double h = std::abs(a.z - b.z);
  if (h == 0) return std::min(area(a), area(b));
  if (a.radius == 0 || b.radius == 0) return 0;
  const double x = a.radius / h, y = b.radius / h, s = 1 + (1 + y * y) / (x * x);
  return 0.5 * area(a) * (s - std::sqrt(s * s - 4 * (y * y) / (x * x)));
}

/// Points on the profile, bands of even length along it.
CavityProfile divided(const CavityProfile& profile) {
  double length = 0;
  for (std::size_t k = 1; k < profile.size(); ++k)
    length += std::hypot(profile[k].z - profile[k - 1].z, profile[k].radius - profile[k - 1].radius);
  CavityProfile out{profile.front()};
  for (std::size_t k = 1; k < profile.size(); ++k) {
    const double dz = profile[k].z - profile[k - 1].z, dr = profile[k].radius - profile[k - 1].radius;
    const int parts = std::max(1, static_cast<int>(std::lround(kBands * std::hypot(dz, dr) / length)));
    for (int p = 1; p <= parts; ++p)
      out.push_back({profile[k - 1].z + dz * p / parts, profile[k - 1].radius + dr * p / parts});
  }
  return out;
}

}  // namespace

CavityProfile cylinder(double depth, double diameter) {
  return {{0, 0}, {0, 0.5 * diameter}, {depth, 0.5 * diameter}};
}

CavityProfile cone(double depth, double diameter) {
  return {{0, 0}, {depth, 0.5 * diameter}};
}

CavityProfile sphere(double diameter, double height) {
  constexpr int kParts = 48;
  const double radius = 0.5 * diameter, end = std::acos(1 - height / radius);
  CavityProfile out{{0, 0}};
  for (int k = 1; k <= kParts; ++k) {
    const double angle = end * k / kParts;
    out.push_back({radius * (1 - std::cos(angle)), radius * std::sin(angle)});
  }
  return out;
}

double radiosity_absorptance(const CavityProfile& profile, double wall) {
  const CavityProfile c = divided(profile);
  const auto bands = static_cast<Eigen::Index>(c.size() - 1);
  const auto at = [&](Eigen::Index k) -> const Circle& { return c[static_cast<std::size_t>(k)]; };
  // Power in = light of the beam + what the bands send, (1 - A0) of what falls on them.
  Eigen::MatrixXd system = Eigen::MatrixXd::Identity(bands, bands);
  Eigen::VectorXd beam(bands);
  for (Eigen::Index i = 0; i < bands; ++i) {
    beam[i] = (area(at(i + 1)) - area(at(i))) / area(c.back());
    for (Eigen::Index j = 0; j < bands; ++j) {
      double flow;  // from band j to band i, times the area of j
      if (i == j)
        flow = band_area(at(i), at(i + 1)) - area(at(i)) - area(at(i + 1)) + 2 * exchange(at(i), at(i + 1));
      else
        flow = std::abs(exchange(at(i), at(j)) - exchange(at(i), at(j + 1)) - exchange(at(i + 1), at(j)) +
                        exchange(at(i + 1), at(j + 1)));
      system(i, j) -= (1 - wall) * flow / band_area(at(j), at(j + 1));
    }
  }
  return wall * system.partialPivLu().solve(beam).sum();
}

double gouffe_absorptance(const CavityProfile& profile, double wall) {
  const double opening = area(profile.back()), depth = profile.back().z - profile.front().z;
  double whole = opening;
  for (std::size_t k = 1; k < profile.size(); ++k) whole += band_area(profile[k - 1], profile[k]);
  const double share = opening / whole, first = opening / (constants::pi * depth * depth);
  return wall * (1 + (1 - wall) * (share - first)) / (wall * (1 - share) + share);
}

}  // namespace meltray::app
