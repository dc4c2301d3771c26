// SPDX-License-Identifier: MIT
#include "laser/smooth_normals.hpp"

#include <algorithm>
#include <utility>

#include "meltray/core/parallel.hpp"

namespace meltray::laser {
namespace {

/// Vertices that share a side of a triangle with vertex v: other[start[v]] ... other[start[v + 1] - 1].
/// A side between two triangles stands there twice, a side at the rim once.
struct Neighbours {
  std::vector<std::size_t> start;
  std::vector<std::int32_t> other;

  explicit Neighbours(const SurfaceMesh& mesh) : start(mesh.vertices.size() + 1, 0) {
    for (const auto& t : mesh.triangles)
      for (const std::int32_t v : t) start[static_cast<std::size_t>(v) + 1] += 2;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) start[v + 1] += start[v];
    other.resize(start.back());
    std::vector<std::size_t> next(start.begin(), start.end() - 1);
    for (const auto& t : mesh.triangles)
      for (std::size_t e = 0; e < 3; ++e) {
        const auto v = static_cast<std::size_t>(t[e]);
        other[next[v]++] = t[(e + 1) % 3];
        other[next[v]++] = t[(e + 2) % 3];
      }
  }
};

double likeness(double cosine) {
  const double c = std::max(cosine, 0.0), c2 = c * c, c4 = c2 * c2;
  return c4 * c4;
}

}  // namespace

void smooth_normals(SurfaceMesh& mesh, int passes) {
  const Neighbours neighbours(mesh);
  std::vector<Vec3> before(mesh.normals.size());
  for (int pass = 0; pass < passes; ++pass) {
    std::swap(before, mesh.normals);
    parallel_for(static_cast<std::ptrdiff_t>(before.size()), [&](std::ptrdiff_t i) {
      const auto v = static_cast<std::size_t>(i);
      Vec3 sum = before[v];
      for (std::size_t q = neighbours.start[v]; q < neighbours.start[v + 1]; ++q) {
        const Vec3& n = before[static_cast<std::size_t>(neighbours.other[q])];
        sum += 0.5 * likeness(before[v].dot(n)) * n;
      }
      mesh.normals[v] = sum.normalized();  // never zero: no neighbour pulls backwards
    });
  }
}

}  // namespace meltray::laser
