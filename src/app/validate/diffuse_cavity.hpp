// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace meltray::app {

/// A circle around the axis of a cavity; the wall between two of them is a band (disc, annulus, cylinder or
/// frustum).
struct Circle {
  double z, radius;  ///< [m]
};

/// Profile of a convex cavity of revolution, from the point on the axis at its bottom to the rim of its
/// opening.
using CavityProfile = std::vector<Circle>;

CavityProfile cylinder(double depth, double diameter);
CavityProfile cone(double depth, double diameter);
/// Sphere of the given diameter, cut at the height above its lowest point.
CavityProfile sphere(double diameter, double height);

/// Share of light parallel to the axis that a cavity with matt walls of absorptance `wall` takes up: balance
/// of radiation between 400 bands, whose view factors follow from those of coaxial discs (Howell, Menguc &
/// Siegel 2016, config. C-41); exact but for the width of the bands.
double radiosity_absorptance(const CavityProfile& profile, double wall);

/// Gouffe 1945: A0 [1 + (1 - A0)(s/S - s/S0)] / [A0 (1 - s/S) + s/S], s the opening, S the walls and the
/// opening, S0 = pi L^2 for the depth L. Light spreads evenly after its first reflection, which is exact for
/// a sphere only.
double gouffe_absorptance(const CavityProfile& profile, double wall);

}  // namespace meltray::app
