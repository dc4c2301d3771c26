// SPDX-License-Identifier: MIT
#include "meltray/laser/beam.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meltray/core/constants.hpp"
#include "meltray/core/errors.hpp"

namespace meltray::laser {
namespace {

// A gaussian is cut where exp(-2 r^2/w^2) is 3.7e-6.
constexpr double kGaussianCut = 2.5;
// Fractional part of the golden ratio: successive angles of a sunflower spiral.
constexpr double kGolden = 0.61803398874989484820;
// From one set of rays to the next: place in the stratum and turn, a plane sequence of low discrepancy
// (powers of the inverse plastic number, the real root of x^3 = x + 1).
constexpr double kSetTurn = 0.75487766624669276, kSetPlace = 0.56984029099805327;
constexpr int kRingRays = 8;

double largest_radius(const BeamSpec& s) {
  return (s.profile == Profile::gaussian ? kGaussianCut : 1.0) * 0.5 * s.focal_diameter;
}

void check(const BeamSpec& s) {
  if (!(s.focal_diameter > 0)) throw UsageError("laser: the focal diameter must be positive");
  if (!(s.rayleigh_length > 0)) throw UsageError("laser: the Rayleigh length must be positive");
  if (!(s.incidence_deg >= 0 && s.incidence_deg < 90))
    throw UsageError("laser: the incidence angle must lie in [0, 90) degrees");
  const double angle = s.incidence_deg * constants::pi / 180;
  if (std::cos(angle) <= std::sin(angle) * largest_radius(s) / s.rayleigh_length)
    throw UsageError("laser: with this incidence and divergence some rays would not travel downwards");
  if (s.modulation != Modulation::table) return;
  if (s.table.empty()) throw UsageError("laser: the power table is empty");
  const auto later = [](const auto& a, const auto& b) { return !(a.first < b.first); };
  if (std::adjacent_find(s.table.begin(), s.table.end(), later) != s.table.end())
    throw UsageError("laser: the times of the power table must increase");
}

double table_power(const std::vector<std::pair<double, double>>& table, double t) {
  if (t <= table.front().first) return table.front().second;
  if (t >= table.back().first) return table.back().second;
  const auto next = std::upper_bound(table.begin(), table.end(), t,
                                     [](double time, const auto& row) { return time < row.first; });
  const auto& [t1, p1] = *next;
  const auto& [t0, p0] = *std::prev(next);
  return p0 + (p1 - p0) * (t - t0) / (t1 - t0);
}

}  // namespace

Beam::Beam(BeamSpec spec) : spec_(std::move(spec)) {
  check(spec_);
}

double Beam::power(double t) const {
  if (t < spec_.on_time || t >= spec_.off_time) return 0;
  double p = spec_.power;
  if (spec_.modulation == Modulation::sine)
    p += spec_.amplitude *
         std::sin(2 * constants::pi * spec_.frequency * t + spec_.phase_deg * constants::pi / 180);
  if (spec_.modulation == Modulation::table) p = table_power(spec_.table, t);
  return std::max(p, 0.0);
}

double Beam::next_switch(double t) const {
  for (const double at : {spec_.on_time, spec_.off_time})
    if (at > t) return at;
  return std::numeric_limits<double>::infinity();
}

Vec3 Beam::axis() const {
  const double angle = spec_.incidence_deg * constants::pi / 180;
  const double along = spec_.tilt == Tilt::leading ? std::sin(angle) : -std::sin(angle);
  return {along, 0, -std::cos(angle)};
}

Vec3 Beam::focus(double t) const {
  return {spec_.start_x + spec_.feed * t, spec_.start_y, spec_.focus_z};
}

double Beam::radius(double distance_from_focus) const {
  return 0.5 * spec_.focal_diameter * std::hypot(1.0, distance_from_focus / spec_.rayleigh_length);
}

std::vector<Ray> Beam::rays(double t, int count, double start_height, std::int64_t set) const {
  std::vector<Ray> rays;
  if (count <= 0) return rays;
  rays.reserve(static_cast<std::size_t>(count));
  const double share = power(t) / count;
  const double waist = 0.5 * spec_.focal_diameter;
  const double inside = -std::expm1(-2 * kGaussianCut * kGaussianCut);  // power within the cut
  const Vec3 centre = focus(t), along = axis();
  const Vec3 e1(-along.z(), 0, along.x()), e2 = Vec3::UnitY();  // cross-section; e1 is +x without tilt
  const double place = std::fmod(0.5 + static_cast<double>(set) * kSetPlace, 1.0),
               turn = std::fmod(static_cast<double>(set) * kSetTurn, 1.0);
  for (int i = 0; i < count; ++i) {
    // Inverse of the encircled power at some place of the i-th stratum, in set 0 its middle; golden angle
    // around the axis.
    const double u = (i + place) / count;
    const double r = spec_.profile == Profile::gaussian ? waist * std::sqrt(-0.5 * std::log1p(-u * inside))
                                                        : waist * std::sqrt(u);
    const double angle = 2 * constants::pi * std::fmod(i * kGolden + turn, 1.0);
    const Vec3 outward = std::cos(angle) * e1 + std::sin(angle) * e2;
    const Vec3 around = std::cos(angle) * e2 - std::sin(angle) * e1;
    // Skew line of a one-sheeted hyperboloid: at distance s its radius is r sqrt(1 + s^2/z_R^2), as the
    // beam's (ISO 11146). Alternating twist leaves no net rotation.
    const double slope = (i % 2 ? -r : r) / spec_.rayleigh_length;
    const Vec3 direction = (along + slope * around).normalized();
    const Vec3 waist_point = centre + r * outward;
    const Vec3 origin = waist_point + direction * ((start_height - waist_point.z()) / direction.z());
    rays.push_back({origin, direction, share});
  }
  return rays;
}

std::vector<Ray> Beam::axis_bundle(double t, double start_height) const {
  const Vec3 centre = focus(t), along = axis();
  const Vec3 e1(-along.z(), 0, along.x());
  const auto start = [&](const Vec3& p) -> Vec3 { return p + along * ((start_height - p.z()) / along.z()); };
  std::vector<Ray> bundle{{start(centre), along, 0}};
  for (int i = 0; i < kRingRays; ++i) {
    const double angle = 2 * constants::pi * i / kRingRays;
    const Vec3 offset =
        0.125 * spec_.focal_diameter * (std::cos(angle) * e1 + std::sin(angle) * Vec3::UnitY());
    bundle.push_back({start(centre + offset), along, 0});
  }
  return bundle;
}

}  // namespace meltray::laser
