// SPDX-License-Identifier: MIT
#include "laser/bounce.hpp"

#include <algorithm>
#include <cmath>

#include "meltray/core/constants.hpp"

namespace meltray::laser {
namespace {

constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15;

/// Lambert's law about a normal from two uniform numbers.
Vec3 lambert(const Vec3& normal, double u1, double u2) {
  const Vec3 helper = std::abs(normal.x()) < 0.5 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 a = normal.cross(helper).normalized(), b = normal.cross(a);
  const double r = std::sqrt(u1), angle = 2 * constants::pi * u2;
  return r * std::cos(angle) * a + r * std::sin(angle) * b + std::sqrt(1 - u1) * normal;
}

Vec3 mirror(const Vec3& d, const Vec3& normal) {
  return (d - 2 * d.dot(normal) * normal).normalized();
}

}  // namespace

SurfacePoint SurfacePoint::on(const SurfaceMesh& mesh, std::size_t triangle, double u, double v) {
  const auto& t = mesh.triangles[triangle];
  const auto i = static_cast<std::size_t>(t[0]), j = static_cast<std::size_t>(t[1]),
             k = static_cast<std::size_t>(t[2]);
  const double w = 1 - u - v;
  SurfacePoint p;
  p.position = w * mesh.vertices[i] + u * mesh.vertices[j] + v * mesh.vertices[k];
  p.flat_normal =
      (mesh.vertices[j] - mesh.vertices[i]).cross(mesh.vertices[k] - mesh.vertices[i]).normalized();
  p.smooth_normal = p.flat_normal;
  if (!mesh.normals.empty()) {
    const Vec3 sum = w * mesh.normals[i] + u * mesh.normals[j] + v * mesh.normals[k];
    const double length = sum.norm();
    if (length > 1e-6) p.smooth_normal = sum / length;
  }
  const std::size_t nearest = w >= u && w >= v ? i : (u >= v ? j : k);
  p.liquid = !mesh.liquid.empty() && mesh.liquid[nearest] != 0;
  return p;
}

Bounce::Bounce(const TraceOptions& options, const Vec3& direction, std::size_t ray_number)
    : options_(options),
      polarisation_(direction, options.polarisation_xy[0], options.polarisation_xy[1]),
      random_(kGoldenGamma * (ray_number + 1)) {}

double Bounce::reflect(const SurfacePoint& point, Vec3& direction) {
  const Vec3 in = direction;
  Vec3 normal = point.smooth_normal;
  Vec3 out = mirror(in, normal);
  // On a coarse mesh the smooth normal may face away from the ray or send it into the metal.
  if (in.dot(normal) >= 0 || out.dot(point.flat_normal) <= 0) {
    normal = point.flat_normal;
    out = mirror(in, normal);
  }
  const double taken = options_.polarisation == Polarisation::tracked
                           ? absorb_tracked(point, in, normal, out)
                           : absorb_averaged(point, -in.dot(normal));
  direction = out;
  if (options_.diffuse) {
    direction = diffuse(point);
    polarisation_.depolarise(direction);
  }
  return taken;
}

double Bounce::absorb_averaged(const SurfacePoint& point, double cosine) const {
  if (options_.fixed_absorptance) return std::clamp(*options_.fixed_absorptance, 0.0, 1.0);
  return absorptance(point.liquid ? options_.index_liquid : options_.index_solid, cosine);
}

double Bounce::absorb_tracked(const SurfacePoint& point, const Vec3& in, const Vec3& normal,
                              const Vec3& out) {
  Amplitudes r;
  if (options_.fixed_absorptance) {
    // Signs of a perfect conductor, so that the plane of polarisation turns as on a metal.
    r.p = std::sqrt(1 - std::clamp(*options_.fixed_absorptance, 0.0, 1.0));
    r.s = -r.p;
  } else {
    r = fresnel_amplitudes(point.liquid ? options_.index_liquid : options_.index_solid, -in.dot(normal));
  }
  return std::clamp(1 - polarisation_.reflect(in, normal, out, r), 0.0, 1.0);
}

Vec3 Bounce::diffuse(const SurfacePoint& point) {
  const double u1 = uniform(), u2 = uniform();
  const Vec3 out = lambert(point.smooth_normal, u1, u2);
  return out.dot(point.flat_normal) > 0 ? out : lambert(point.flat_normal, u1, u2);
}

/// SplitMix64 (Steele et al. 2014), seeded by the number of the ray.
double Bounce::uniform() {
  std::uint64_t z = (random_ += kGoldenGamma);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

}  // namespace meltray::laser
