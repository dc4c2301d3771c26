// SPDX-License-Identifier: MIT
#include "laser/cloud_selection.hpp"

#include <optional>

#include "meltray/core/collect.hpp"
#include "meltray/core/parallel.hpp"

namespace meltray::laser {
namespace {

/// Layers beyond a face that must be there for the surface at the face to be undisturbed.
constexpr double kLayers = 3;

/// Particles in the layer before a face and in the one some layers beyond it.
struct Layers {
  std::size_t before = 0, beyond = 0;
  double sum = 0;  ///< of the coordinates of those before
};

/// Where the metal ends at a face of the region: half a spacing beyond the layer before the face; nothing if
/// there is no metal at the face, or enough of it beyond.
std::optional<double> crop_plane(const std::vector<Vec3>& position, int axis, double face, int outward,
                                 double spacing) {
  const auto count = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    Layers found;
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const double x = position[static_cast<std::size_t>(i)][axis], layer = outward * (x - face) / spacing;
      if (layer > -1 && layer <= 0) {
        ++found.before;
        found.sum += x;
      }
      found.beyond += layer > kLayers - 1 && layer <= kLayers;
    }
    return found;
  };
  const Layers all = parallel_reduce(static_cast<std::ptrdiff_t>(position.size()), Layers{}, count,
                                     [](const Layers& a, const Layers& b) {
                                       return Layers{a.before + b.before, a.beyond + b.beyond, a.sum + b.sum};
                                     });
  if (all.before == 0 || 2 * all.beyond >= all.before) return std::nullopt;
  return all.sum / static_cast<double>(all.before) + 0.5 * outward * spacing;
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
  const Vec3 low = region.min.array() - margin, high = region.max.array() + margin;
  const auto at = [&](std::size_t i) {
    return Vec3(cloud.position[0][i], cloud.position[1][i], cloud.position[2][i]);
  };
  std::vector<std::size_t> chosen;
  parallel_collect(static_cast<std::ptrdiff_t>(cloud.size), kLight.size, chosen,
                   [&](std::ptrdiff_t i, std::vector<std::size_t>& found) {
                     const Vec3 x = at(static_cast<std::size_t>(i));
                     // A comparison with NaN is false.
                     if ((x.array() >= low.array()).all() && (x.array() <= high.array()).all())
                       found.push_back(static_cast<std::size_t>(i));
                   });
  CloudSelection s;
  s.position.resize(chosen.size());
  s.liquid.resize(chosen.size());
  parallel_for(static_cast<std::ptrdiff_t>(chosen.size()), [&](std::ptrdiff_t k) {
    const auto q = static_cast<std::size_t>(k);
    s.position[q] = at(chosen[q]);
    s.liquid[q] = cloud.liquid ? cloud.liquid[chosen[q]] : 0;
  });
  if (s.position.empty()) return s;
  const Box first{s.position.front(), s.position.front()};
  s.bounds = parallel_reduce(
      static_cast<std::ptrdiff_t>(s.position.size()), first,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Box part = first;
        for (std::ptrdiff_t k = begin; k < end; ++k) {
          const Vec3& x = s.position[static_cast<std::size_t>(k)];
          part = {part.min.cwiseMin(x), part.max.cwiseMax(x)};
        }
        return part;
      },
      [](const Box& a, const Box& b) {
        return Box{a.min.cwiseMin(b.min), a.max.cwiseMax(b.max)};
      });
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
