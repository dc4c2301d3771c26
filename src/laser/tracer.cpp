// SPDX-License-Identifier: MIT
// The only file that calls Embree.
#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "laser/bounce.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/laser/laser.hpp"

namespace meltray::laser {
namespace {

// Embree is single precision: coordinates are given in millimetres from the centre of the mesh.
constexpr double kMillimetres = 1e3;
// Distance of the origin of a reflected ray from the surface, over the radius of the mesh: some 60 units in
// the last place of a coordinate.
constexpr double kOffset = 4e-6;
// Rays traced between two gatherings, and hits of a ray that are kept in the first go.
constexpr std::size_t kBatch = 4096, kHitSlots = 32;

bool finite(const Vec3& v) {
  return v.allFinite();
}

struct Device {
  RTCDevice handle = rtcNewDevice("threads=1,set_affinity=0");
  Device() {
    if (!handle) throw NumericalFailure("ray tracer: Embree cannot start");
  }
  ~Device() { rtcReleaseDevice(handle); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
};

/// Triangles that Embree can take: indices in range, finite corners, an area. Wound so that the geometric
/// normal agrees with the vertex normals.
void clean(SurfaceMesh& mesh) {
  const std::size_t n = mesh.vertices.size();
  if ((!mesh.normals.empty() && mesh.normals.size() != n) ||
      (!mesh.liquid.empty() && mesh.liquid.size() != n))
    throw NumericalFailure("ray tracer: normals or liquid flags do not match the vertices of the mesh");
  std::erase_if(mesh.triangles, [&](std::array<std::int32_t, 3>& t) {
    for (const std::int32_t v : t)
      if (v < 0 || static_cast<std::size_t>(v) >= n || !finite(mesh.vertices[static_cast<std::size_t>(v)]))
        return true;
    const auto i = static_cast<std::size_t>(t[0]), j = static_cast<std::size_t>(t[1]),
               k = static_cast<std::size_t>(t[2]);
    const Vec3 ab = mesh.vertices[j] - mesh.vertices[i], ac = mesh.vertices[k] - mesh.vertices[i];
    const Vec3 area = ab.cross(ac);
    if (!(area.norm() > 1e-9 * std::max(ab.squaredNorm(), ac.squaredNorm()))) return true;
    if (!mesh.normals.empty()) {
      if (!finite(mesh.normals[i]) || !finite(mesh.normals[j]) || !finite(mesh.normals[k])) return true;
      if (area.dot(mesh.normals[i]) < 0 && area.dot(mesh.normals[j]) < 0 && area.dot(mesh.normals[k]) < 0)
        std::swap(t[1], t[2]);
    }
    return false;
  });
}

}  // namespace

struct Tracer::Impl {
  Device device;
  RTCScene scene = nullptr;
  RTCGeometry geometry = nullptr;
  bool attached = false;
  SurfaceMesh mesh;
  Vec3 centre = Vec3::Zero();
  double radius = 0, offset = 0;  // of the mesh about its centre; of ray origins [m]

  Impl() {
    scene = rtcNewScene(device.handle);
    rtcSetSceneFlags(scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC));
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
    geometry = rtcNewGeometry(device.handle, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
    check("set-up");
  }
  ~Impl() {
    rtcReleaseGeometry(geometry);
    rtcReleaseScene(scene);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void check(const char* what) const {
    const RTCError error = rtcGetDeviceError(device.handle);
    if (error != RTC_ERROR_NONE)
      throw NumericalFailure(std::string("ray tracer: Embree failed in ") + what + ", error " +
                             std::to_string(static_cast<int>(error)));
  }

  void build() {
    clean(mesh);
    if (attached) rtcDetachGeometry(scene, 0);
    attached = false;
    if (mesh.triangles.empty()) {
      rtcCommitScene(scene);
      return;
    }
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const auto& t : mesh.triangles)
      for (const std::int32_t v : t) {
        low = low.cwiseMin(mesh.vertices[static_cast<std::size_t>(v)]);
        high = high.cwiseMax(mesh.vertices[static_cast<std::size_t>(v)]);
      }
    centre = 0.5 * (low + high);
    radius = 0.5 * (high - low).norm();
    offset = kOffset * radius;

    auto* xyz = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices.size()));
    auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.triangles.size()));
    check("allocation");
    for (const Vec3& v : mesh.vertices)
      for (int a = 0; a < 3; ++a)
        *xyz++ = finite(v) ? static_cast<float>((v[a] - centre[a]) * kMillimetres) : 0.0F;
    for (const auto& t : mesh.triangles)
      for (const std::int32_t v : t) *index++ = static_cast<unsigned>(v);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, 0);
    attached = true;
    rtcCommitScene(scene);
    check("building the tree");
  }

  /// Nearest hit along a finite ray, d of unit length.
  std::optional<SurfacePoint> intersect(Vec3 o, const Vec3& d) const {
    if (mesh.triangles.empty()) return std::nullopt;
    // A far origin costs digits: start near the mesh.
    const double far = (centre - o).dot(d) - 1.5 * radius;
    if (far > 0) o += far * d;
    const Vec3 local = (o - centre) * kMillimetres;
    RTCRayHit q;
    q.ray.org_x = static_cast<float>(local.x());
    q.ray.org_y = static_cast<float>(local.y());
    q.ray.org_z = static_cast<float>(local.z());
    q.ray.dir_x = static_cast<float>(d.x());
    q.ray.dir_y = static_cast<float>(d.y());
    q.ray.dir_z = static_cast<float>(d.z());
    q.ray.tnear = 0;
    q.ray.tfar = std::numeric_limits<float>::infinity();
    q.ray.time = 0;
    q.ray.mask = ~0U;
    q.ray.id = 0;
    q.ray.flags = 0;
    q.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    q.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    if (!std::isfinite(q.ray.org_x + q.ray.org_y + q.ray.org_z)) return std::nullopt;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &q);
    if (q.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return SurfacePoint::on(mesh, q.hit.primID, static_cast<double>(q.hit.u), static_cast<double>(q.hit.v));
  }

  /// What became of one ray.
  struct Fate {
    double absorbed = 0, escaped = 0, residual = 0, dropped = 0;
    std::int64_t bounces = 0;
    bool is_dropped = false;
    std::size_t hits = 0;  // may exceed the capacity of the place for them
  };

  Fate follow(const Ray& ray, std::size_t number, const TraceOptions& options, std::span<Hit> out) const {
    Fate fate;
    const double length = ray.direction.norm();
    if (!finite(ray.origin) || !(length > 0) || !std::isfinite(length) || !std::isfinite(ray.power) ||
        ray.power < 0) {
      fate.dropped = std::isfinite(ray.power) ? ray.power : 0;
      fate.is_dropped = true;
      return fate;
    }
    const auto record = [&](const Vec3& where, double power) {
      if (power <= 0) return;
      if (fate.hits < out.size()) out[fate.hits] = {where, power, static_cast<std::uint32_t>(number)};
      ++fate.hits;
    };
    Vec3 origin = ray.origin, direction = ray.direction / length;
    double power = ray.power;
    const double end = options.end_fraction * ray.power;
    Bounce bounce(options, direction, number);
    for (;;) {
      const auto point = intersect(origin, direction);
      if (!point) {
        fate.escaped = power;
        return fate;
      }
      if (direction.dot(point->flat_normal) >= 0) {
        // From behind: the ray is in the metal (it came through the open rim of the mesh), which is opaque.
        record(point->position, power);
        fate.absorbed += power;
        return fate;
      }
      ++fate.bounces;
      const double taken = power * bounce.reflect(*point, direction);
      record(point->position, taken);
      fate.absorbed += taken;
      power -= taken;
      if (power <= end || fate.bounces >= options.max_bounces) {
        record(point->position, power);
        fate.residual = power;
        return fate;
      }
      origin = point->position + offset * point->flat_normal;
      if (!finite(direction) || !finite(origin)) {
        fate.dropped = power;
        fate.is_dropped = true;
        return fate;
      }
    }
  }
};

Tracer::Tracer() : impl_(std::make_unique<Impl>()) {}
Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;

void Tracer::set_mesh(SurfaceMesh mesh) {
  impl_->mesh = std::move(mesh);
  impl_->build();
}

const SurfaceMesh& Tracer::mesh() const {
  return impl_->mesh;
}

Trace Tracer::trace(std::span<const Ray> rays, const TraceOptions& options) const {
  Trace result;
  const std::size_t batch = std::min(rays.size(), kBatch);
  std::vector<Impl::Fate> fates(batch);
  const auto slots = std::make_unique_for_overwrite<Hit[]>(batch * kHitSlots);
  const auto place = [&](std::size_t i) { return std::span<Hit>(slots.get() + i * kHitSlots, kHitSlots); };
  Ledger& ledger = result.ledger;
  ledger.rays = static_cast<std::int64_t>(rays.size());
  for (std::size_t begin = 0; begin < rays.size(); begin += batch) {
    const std::size_t count = std::min(batch, rays.size() - begin);
    // A ray is worth some hundred rows of a pair loop: shared out even if there are few.
#pragma omp parallel for schedule(dynamic, 8)
    for (std::size_t i = 0; i < count; ++i)
      fates[i] = impl_->follow(rays[begin + i], begin + i, options, place(i));
    for (std::size_t i = 0; i < count; ++i) {
      const Impl::Fate& f = fates[i];
      const double in = rays[begin + i].power;
      ledger.in += std::isfinite(in) ? in : 0;
      ledger.absorbed += f.absorbed;
      ledger.escaped += f.escaped;
      ledger.residual += f.residual;
      ledger.dropped += f.dropped;
      ledger.bounces += f.bounces;
      ledger.dropped_rays += f.is_dropped;
      const std::size_t old = result.hits.size();
      if (f.hits <= kHitSlots) {
        result.hits.insert(result.hits.end(), place(i).begin(), place(i).begin() + static_cast<long>(f.hits));
      } else {  // rare: follow the ray again, now with room for all its hits
        result.hits.resize(old + f.hits);
        impl_->follow(rays[begin + i], begin + i, options, std::span(result.hits).subspan(old));
      }
    }
  }
  return result;
}

std::optional<Vec3> Tracer::first_hit(const Ray& ray) const {
  const double length = ray.direction.norm();
  if (!finite(ray.origin) || !(length > 0) || !std::isfinite(length)) return std::nullopt;
  const auto point = impl_->intersect(ray.origin, ray.direction / length);
  if (!point) return std::nullopt;
  return point->position;
}

}  // namespace meltray::laser
