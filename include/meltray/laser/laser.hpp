// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "meltray/core/archive.hpp"
#include "meltray/core/vec.hpp"
#include "meltray/laser/beam.hpp"

namespace meltray::laser {

/// Fresnel absorptance A = 1 - (R_s + R_p)/2 and its parts, for a metal of index m = n + ik in vacuum.
/// `cosine` of the angle to the normal is clamped to [0, 1].
struct Reflectance {
  double s, p;
};
Reflectance fresnel(std::complex<double> index, double cosine);
double absorptance(std::complex<double> index, double cosine);

/// Triangles of a surface, normals pointing out of the metal.
struct SurfaceMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<Vec3> normals;         ///< smooth unit normal per vertex
  std::vector<std::uint8_t> liquid;  ///< per vertex: 1 where the nearest metal is liquid
};

/// Particles near the beam: `position` has `size` entries [m], each of the given spacing.
struct PointCloud {
  ConstField position{};
  std::size_t size = 0;
  const std::uint8_t* liquid = nullptr;  ///< 1 = liquid
  double spacing = 0;                    ///< [m]
};

struct Box {
  Vec3 min, max;
};

/// Isosurface (one half) of the smoothed volume fraction of the cloud inside `region`, as a triangle mesh on
/// a grid of two thirds of the particle spacing, with normals averaged along the surface over a spacing or
/// so. Vertices are finite; slivers are dropped. The mesh is open where the metal leaves the region: give
/// particles up to four spacings outside, or none where the metal was cropped at a side or the bottom of the
/// region (it is then continued by its mirror image). A free side of the metal must be more than a spacing
/// inside the region. The top face is never taken for a crop. A particle on its own is too small to show.
SurfaceMesh reconstruct_surface(const PointCloud& cloud, const Box& region);

enum class Polarisation { averaged, tracked };

struct TraceOptions {
  int rays = 1000;       ///< of one trace; with an error target the most of them
  double ray_error = 0;  ///< target of sampling_error(); 0: always `rays`
  Polarisation polarisation = Polarisation::averaged;
  std::optional<double> fixed_absorptance;  ///< replaces Fresnel when set
  std::complex<double> index_solid{1, 0}, index_liquid{1, 0};
  double end_fraction = 1e-4;  ///< a ray ends below this share of its own start power (residual deposited)
  int max_bounces = 1000;
  bool diffuse = false;  ///< Lambertian instead of mirror reflection (test mode for Gouffe's cavity)
  /// Tracked only: linear polarisation of the incoming beam in its cross-section, whose x is the world's x
  /// made transverse; (0, 0): unpolarised light.
  std::array<double, 2> polarisation_xy{1, 0};
};

/// One absorption event on the surface.
struct Hit {
  Vec3 position;
  double power;           ///< absorbed there [W]
  std::uint32_t ray = 0;  ///< number of the ray in its trace
};

/// in = absorbed + escaped + residual + dropped to round-off. `residual` is what rays carried when they ended
/// by end_fraction or max_bounces; it is deposited at their last hit and NOT contained in `absorbed`.
struct Ledger {
  double in = 0, absorbed = 0, escaped = 0, residual = 0, dropped = 0;  ///< [W]
  std::int64_t rays = 0, bounces = 0, dropped_rays = 0;
};

struct Trace {
  std::vector<Hit> hits;  ///< absorbed and residual power
  Ledger ledger;
};

/// Ray tracer on an Embree scene. Deterministic: rays are traced in parallel and gathered in ray order.
/// Non-finite rays are dropped and counted, never handed to Embree; nor are degenerate triangles. A ray that
/// meets a triangle from behind is in the metal (it came through the open rim) and is absorbed there. Without
/// vertex normals those of the triangles are used, without liquid flags all metal is solid.
class Tracer {
 public:
  Tracer();
  ~Tracer();
  Tracer(Tracer&&) noexcept;
  Tracer& operator=(Tracer&&) noexcept;

  /// Builds the BVH. An empty mesh is allowed: every ray then escapes. Degenerate triangles are removed and
  /// all are wound as their vertex normals ask; mesh() shows the result.
  void set_mesh(SurfaceMesh mesh);
  const SurfaceMesh& mesh() const;
  Trace trace(std::span<const Ray> rays, const TraceOptions& options) const;
  /// Closest hit of a ray, for depths and pictures; nothing if it misses.
  std::optional<Vec3> first_hit(const Ray& ray) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// How uncertain the places of a trace's hits are, from its own halves: the rays of even and of odd number
/// are two samples of the beam, and the error of both together is as large as their difference. Returns the
/// sum over cubes of edge `edge` [m] of |even - odd| over the sum of even + odd: 0 where both light the same
/// cubes alike, 1 where they never meet. 0 without hits.
double sampling_error(std::span<const Hit> hits, double edge);

/// Chooses the number of rays of each trace so that sampling_error() stays at a target. The error is taken to
/// fall with the root of the number, as that of random samples; the constant is learned from the traces.
class RayCount {
 public:
  /// `target` > 0; at most `most` rays.
  RayCount(double target, int most) : target_(target), most_(most) {}
  int next() const;
  /// After a trace of `rays` rays with hits of this sampling error.
  void learn(double error, int rays);
  void archive(Archive& a) { a.value("laser/ray_constant", constant_); }

 private:
  double target_;
  int most_;
  double constant_ = 0;  ///< mean of error^2 times rays; 0: nothing learned
};

/// Hits in a cube of edge `edge`: hits[first] ... hits[last - 1].
struct HitGroup {
  Vec3 centre;
  double edge;
  std::size_t first, last;
};

/// Sorts hits by the cubes of edge `edge` [m] they lie in (of one cube in their former order) and says where
/// each cube begins: thousands of hits lie side by side and share what is around them. Hits at no finite
/// place are dropped; their power [W] is returned in `lost`.
std::vector<HitGroup> group_hits(std::vector<Hit>& hits, double edge, double& lost);

/// Spreads each hit over the surface particles within `radius` of it, weighted by
/// (1 - r/radius)^2 and by `weight` (0 = not on the surface); a hit without any goes to the nearest particle
/// of positive weight, or, if there is none in the cloud, is returned as undeposited. `groups` are those of
/// group_hits(). Adds to `power` [W] per cloud entry. Returns the undeposited power [W].
double deposit(std::span<const Hit> hits, std::span<const HitGroup> groups, const PointCloud& cloud,
               const double* weight, double radius, double* power);

}  // namespace meltray::laser
