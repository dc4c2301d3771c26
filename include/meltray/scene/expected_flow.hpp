// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/scene/scene.hpp"

namespace meltray::scene {

/// The largest of the speeds that a scene names or implies before anything has moved [m/s]; 1 m/s where there
/// is none.
double expected_speed(const Scene& scene);

/// Largest pressure to expect of the vapour [Pa]: recoil at the temperature that the front of a weld reaches;
/// the prescribed recoil where there is one; 0 without recoil.
double expected_pressure(const Scene& scene);

/// Sound speed that keeps the density variation near 1 %: ten times the largest of expected_speed() and
/// sqrt(expected_pressure() / rho) [m/s].
double default_sound_speed(const Scene& scene);

/// Speed of sound over the largest speed of the flow that goes with density variations of 1 %.
inline constexpr double kSoundOverFlow = 10;

}  // namespace meltray::scene
