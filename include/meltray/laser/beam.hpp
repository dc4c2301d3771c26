// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "meltray/core/vec.hpp"

namespace meltray::laser {

enum class Modulation { constant, sine, table };
enum class Profile { gaussian, top_hat };
enum class Tilt { leading, trailing };

/// Description of the beam, SI units, angles in degrees where the name says so.
struct BeamSpec {
  Modulation modulation = Modulation::constant;
  double power = 0;                              ///< constant power, or mean of the sine [W]
  double amplitude = 0;                          ///< of the sine [W]
  double frequency = 0;                          ///< of the sine [Hz]
  double phase_deg = 0;                          ///< P(t) = power + amplitude sin(2 pi f t + phase)
  std::vector<std::pair<double, double>> table;  ///< (time s, power W), linear in between, end values held
  double on_time = 0, off_time = 1e300;          ///< the beam is dark outside [on_time, off_time) [s]
  Profile profile = Profile::gaussian;
  double focal_diameter = 2e-4;     ///< at 1/e^2 of the intensity (gaussian) or full width (top-hat) [m]
  double focus_z = 0;               ///< height of the focal plane [m]; the workpiece top is z = 0
  double rayleigh_length = 1e300;   ///< [m]; 1e300: no divergence
  double incidence_deg = 0;         ///< angle between the axis and the vertical, in the x-z plane
  Tilt tilt = Tilt::leading;        ///< leading: the beam points along the feed as it goes down
  double start_x = 0, start_y = 0;  ///< where the axis meets z = focus_z at t = 0 [m]
  double feed = 0;                  ///< speed along +x [m/s]
};

struct Ray {
  Vec3 origin;
  Vec3 direction;  ///< unit length
  double power;    ///< [W]
};

/// Power over time and the rays that carry it.
class Beam {
 public:
  /// Throws UsageError where the description makes no beam (no spot, level or upward rays, bad table).
  explicit Beam(BeamSpec spec);
  const BeamSpec& spec() const { return spec_; }
  double power(double t) const;        ///< [W], never negative
  double next_switch(double t) const;  ///< time after t when it goes on or off; infinity: none [s]
  Vec3 axis() const;                   ///< unit vector of propagation (downwards)
  Vec3 focus(double t) const;          ///< where the axis meets the focal plane [m]
  double radius(double distance_from_focus) const;  ///< beam radius at a distance along the axis [m]
  /// `count` rays of equal power power(t)/count, stratified over the profile by a low-discrepancy sequence,
  /// starting above z = start_height. Sets of other numbers (>= 0) have their rays at other places, evenly
  /// spread in between, so that many traces of few rays light what one of many would. Divergent beams get
  /// hyperboloid rays whose envelope is radius(). A gaussian is cut at 2.5 radii of 1/e^2 and renormalised.
  std::vector<Ray> rays(double t, int count, double start_height, std::int64_t set = 0) const;
  /// A small bundle along the axis (the axis itself and a ring at a quarter of the focal radius), zero power.
  std::vector<Ray> axis_bundle(double t, double start_height) const;

 private:
  BeamSpec spec_;
};

}  // namespace meltray::laser
