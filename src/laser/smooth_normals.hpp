// SPDX-License-Identifier: MIT
#pragma once

#include "meltray/laser/laser.hpp"

namespace meltray::laser {

/// Averages the unit normals of a mesh `passes` times with those of the vertices that share a triangle side,
/// weighted by the eighth power of the cosine between them: after Yagou et al. 2002 and, for the weight,
/// Zheng et al. 2011. Light feels the mean slope of a few spacings, not the disorder of the particles; the
/// weight keeps the two walls of a groove apart, which are as close in space as neighbours on one wall.
void smooth_normals(SurfaceMesh& mesh, int passes);

}  // namespace meltray::laser
