// SPDX-License-Identifier: MIT
#include "laser/cloud_selection.hpp"

#include <optional>

namespace meltray::laser {
namespace {

/// Layers beyond a face that must be there for the surface at the face to be undisturbed.
constexpr double kLayers = 3;

/// Where the metal ends at a face of the region: half a spacing beyond the layer before the face; nothing if
/// there is no metal at the face, or enough of it beyond.
std::optional<double> crop_plane(const std::vector<Vec3>& position, int axis, double face, int outward,
                                 double spacing) {
  std::size_t before = 0, beyond = 0;
  double sum = 0;
  for (const Vec3& x : position) {
    const double layer = outward * (x[axis] - face) / spacing;
    if (layer > -1 && layer <= 0) {
      ++before;
      sum += x[axis];
    }
    beyond += layer > kLayers - 1 && layer <= kLayers;
  }
  if (before == 0 || 2 * beyond >= before) return std::nullopt;
  return sum / static_cast<double>(before) + 0.5 * outward * spacing;
}

/// Replaces what lies beyond the plane by the image of what lies before it.
void mirror(CloudSelection& s, int axis, double plane, int outward, double reach) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    if (outward * (s.position[i][axis] - plane) >= 0) continue;
    s.position[kept] = s.position[i];
    s.liquid[kept++] = s.liquid[i];
  }
  s.position.resize(kept);
  s.liquid.resize(kept);
  for (std::size_t i = 0; i < kept; ++i) {
    if (outward * (plane - s.position[i][axis]) > reach) continue;
    Vec3 image = s.position[i];
    image[axis] = 2 * plane - image[axis];
    s.position.push_back(image);
    s.liquid.push_back(s.liquid[i]);
  }
}

}  // namespace

CloudSelection select_cloud(const PointCloud& cloud, const Box& region, double margin) {
  CloudSelection s;
  s.position.reserve(cloud.size);
  s.liquid.reserve(cloud.size);
  const Vec3 low = region.min.array() - margin, high = region.max.array() + margin;
  for (std::size_t i = 0; i < cloud.size; ++i) {
    const Vec3 x(cloud.position[0][i], cloud.position[1][i], cloud.position[2][i]);
    // A comparison with NaN is false.
    if (!((x.array() >= low.array()).all() && (x.array() <= high.array()).all())) continue;
    s.position.push_back(x);
    s.liquid.push_back(cloud.liquid ? cloud.liquid[i] : 0);
    s.bounds.min = s.position.size() == 1 ? x : Vec3(s.bounds.min.cwiseMin(x));
    s.bounds.max = s.position.size() == 1 ? x : Vec3(s.bounds.max.cwiseMax(x));
  }
  // One axis after the other, so that edges and corners are continued too.
  for (int axis = 0; axis < 3; ++axis) {
    const auto low_plane = crop_plane(s.position, axis, region.min[axis], -1, cloud.spacing);
    const auto high_plane =
        axis == 2 ? std::nullopt : crop_plane(s.position, axis, region.max[axis], 1, cloud.spacing);
    if (low_plane) mirror(s, axis, *low_plane, -1, margin);
    if (high_plane) mirror(s, axis, *high_plane, 1, margin);
  }
  return s;
}

}  // namespace meltray::laser
