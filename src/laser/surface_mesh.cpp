// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numeric>

#include "laser/cloud_selection.hpp"
#include "laser/smooth_normals.hpp"
#include "laser/smoothed_field.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/core/parallel.hpp"
#include "meltray/laser/laser.hpp"

namespace meltray::laser {
namespace {

using Cell = SmoothedField::Cell;
constexpr double kSurface = 0.5;  // value of the field on the surface
constexpr double kReach = 4;      // spacings: how far particles and mirror images act
// Per step; below it (films of one particle) the gradient has no direction.
constexpr double kFlatGradient = 0.01;
constexpr double kSliver = 1e-3;  // height over longest side
// With these, walls of disordered particles are as smooth as under a Gaussian of 1.1 spacings.
constexpr int kNormalPasses = 4;

/// Surface nets (Gibson 1998): one vertex in each cell that the surface crosses, one quadrangle around each
/// edge of the grid that it crosses. Unlike in Gibson's relaxation, vertices are moved onto the isosurface.
class SurfaceNets {
 public:
  explicit SurfaceNets(const SmoothedField& field) : field_(field), n_(field.cells()), rows_(n_[1] * n_[2]) {
    find_rows();
    place_vertices();
    connect();
  }
  SurfaceMesh take() { return std::move(mesh_); }

 private:
  struct Crossings {
    Vec3 centre;   // mean of the points where the surface cuts the edges, in [0, 1]^3
    Vec3 outward;  // rough direction out of the metal
  };

  bool metal(std::ptrdiff_t i, std::ptrdiff_t j, std::ptrdiff_t k) const {
    return field_.at_corner(i, j, k) > kSurface;
  }
  bool crossed(const Cell& c) const {
    const bool first = metal(c[0], c[1], c[2]);
    for (int corner = 1; corner < 8; ++corner)
      if (metal(c[0] + (corner & 1), c[1] + (corner >> 1 & 1), c[2] + (corner >> 2)) != first) return true;
    return false;
  }
  std::size_t cell_index(const Cell& c) const {
    return static_cast<std::size_t>((c[2] * n_[1] + c[1]) * n_[0] + c[0]);
  }

  /// Marks the rows of cells that the surface crosses: most are all metal or all void.
  void find_rows() {
    enum : std::uint8_t { kVoid, kMetal, kMixed };
    std::vector<std::uint8_t> corners(static_cast<std::size_t>((n_[1] + 1) * (n_[2] + 1)));
    parallel_for((n_[1] + 1) * (n_[2] + 1), [&](std::ptrdiff_t row) {
      std::ptrdiff_t inside = 0;
      for (std::ptrdiff_t i = 0; i <= n_[0]; ++i) inside += metal(i, row % (n_[1] + 1), row / (n_[1] + 1));
      corners[static_cast<std::size_t>(row)] = inside == 0 ? kVoid : (inside == n_[0] + 1 ? kMetal : kMixed);
    });
    mixed_.resize(static_cast<std::size_t>(rows_));
    for (std::ptrdiff_t row = 0; row < rows_; ++row) {
      const std::uint8_t* c = corners.data() + row / n_[1] * (n_[1] + 1) + row % n_[1];
      const std::uint8_t* above = c + n_[1] + 1;
      mixed_[static_cast<std::size_t>(row)] =
          c[0] == kMixed || c[1] != c[0] || above[0] != c[0] || above[1] != c[0];
    }
  }

  /// Runs f(cell) over a row of cells along x, if the surface crosses it.
  template <class F>
  void for_row(std::ptrdiff_t row, F&& f) const {
    if (!mixed_[static_cast<std::size_t>(row)]) return;
    Cell c{0, row % n_[1], row / n_[1]};
    for (; c[0] < n_[0]; ++c[0]) f(c);
  }
  /// Turns counts per row into the first index of each row; returns the total.
  static std::size_t starts(std::vector<std::size_t>& per_row) {
    std::exclusive_scan(per_row.begin(), per_row.end(), per_row.begin(), std::size_t{0});
    return per_row.back();
  }

  Crossings crossings(const Cell& c) const {
    Crossings x{Vec3::Zero(), Vec3::Zero()};
    int count = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (int side = 0; side < 4; ++side) {
        Cell a = c;
        a[static_cast<std::size_t>(u)] += side & 1;
        a[static_cast<std::size_t>(v)] += side >> 1;
        Cell b = a;
        ++b[static_cast<std::size_t>(axis)];
        const double fa = field_.at_corner(a[0], a[1], a[2]), fb = field_.at_corner(b[0], b[1], b[2]);
        if ((fa > kSurface) == (fb > kSurface)) continue;
        Vec3 point;
        point[axis] = (fa - kSurface) / (fa - fb);
        point[u] = side & 1;
        point[v] = side >> 1;
        x.centre += point;
        x.outward[axis] += fa > fb ? 1 : -1;
        ++count;
      }
    }
    x.centre /= count;
    return x;
  }

  void place(const Cell& c, std::size_t id) {
    const Crossings x = crossings(c);
    const SmoothedField::Sample s = field_.sample(c, x.centre);
    const double slope = s.gradient.norm();
    Vec3 local = x.centre;
    if (slope >= kFlatGradient) {
      // Newton's step, kept in the cell: neighbouring vertices cannot change places then.
      local = (local + s.gradient * ((kSurface - s.value) / (slope * slope))).cwiseMax(0.0).cwiseMin(1.0);
      mesh_.normals[id] = -s.gradient / slope;
    } else {
      mesh_.normals[id] = x.outward.squaredNorm() > 0 ? Vec3(x.outward.normalized()) : Vec3(Vec3::UnitZ());
    }
    mesh_.vertices[id] = field_.corner(c) + field_.step() * local;
    mesh_.liquid[id] = field_.liquid(c, local);
  }

  void place_vertices() {
    std::vector<std::size_t> start(static_cast<std::size_t>(rows_) + 1, 0);
    vertex_.assign(static_cast<std::size_t>(rows_ * n_[0]), -1);
    parallel_for(rows_, [&](std::ptrdiff_t row) {
      for_row(row, [&](const Cell& c) { start[static_cast<std::size_t>(row)] += crossed(c); });
    });
    const std::size_t total = starts(start);
    mesh_.vertices.resize(total);
    mesh_.normals.resize(total);
    mesh_.liquid.resize(total);
    parallel_for(rows_, [&](std::ptrdiff_t row) {
      std::size_t id = start[static_cast<std::size_t>(row)];
      if (id == start[static_cast<std::size_t>(row) + 1]) return;
      for_row(row, [&](const Cell& c) {
        if (!crossed(c)) return;
        vertex_[cell_index(c)] = static_cast<std::int32_t>(id);
        place(c, id++);
      });
    });
  }

  /// Calls f(axis, rises) for the grid edges at the lower corner of a cell that the surface cuts and that
  /// have all four cells around them; `rises`: metal at the lower end.
  template <class F>
  void for_edges(const Cell& c, F&& f) const {
    if (vertex_[cell_index(c)] < 0) return;
    const bool here = metal(c[0], c[1], c[2]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (c[(axis + 1) % 3] == 0 || c[(axis + 2) % 3] == 0) continue;
      Cell next = c;
      ++next[axis];
      if (metal(next[0], next[1], next[2]) != here) f(axis, here);
    }
  }

  bool sliver(const std::array<std::int32_t, 3>& t) const {
    const Vec3& a = mesh_.vertices[static_cast<std::size_t>(t[0])];
    const Vec3& b = mesh_.vertices[static_cast<std::size_t>(t[1])];
    const Vec3& c = mesh_.vertices[static_cast<std::size_t>(t[2])];
    const double longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return !((b - a).cross(c - a).norm() > kSliver * longest2);
  }

  void connect() {
    std::vector<std::size_t> start(static_cast<std::size_t>(rows_) + 1, 0);
    parallel_for(rows_, [&](std::ptrdiff_t row) {
      for_row(row, [&](const Cell& c) {
        for_edges(c, [&](std::size_t, bool) { start[static_cast<std::size_t>(row)] += 2; });
      });
    });
    mesh_.triangles.resize(starts(start));
    parallel_for(rows_, [&](std::ptrdiff_t row) {
      std::size_t id = start[static_cast<std::size_t>(row)];
      if (id == start[static_cast<std::size_t>(row) + 1]) return;
      for_row(row, [&](const Cell& c) {
        for_edges(c, [&](std::size_t axis, bool metal_below) {
          add_quad(c, axis, metal_below, &mesh_.triangles[id]);
          id += 2;
        });
      });
    });
    std::erase_if(mesh_.triangles, [this](const auto& t) { return sliver(t); });
  }

  void add_quad(const Cell& c, std::size_t axis, bool metal_below, std::array<std::int32_t, 3>* out) const {
    Cell u = c, v = c;
    --u[(axis + 1) % 3];
    --v[(axis + 2) % 3];
    Cell uv = u;
    --uv[(axis + 2) % 3];
    // Counter-clockwise seen from the upper end of the edge.
    std::array<std::int32_t, 4> q = {vertex_[cell_index(uv)], vertex_[cell_index(v)], vertex_[cell_index(c)],
                                     vertex_[cell_index(u)]};
    if (!metal_below) std::swap(q[1], q[3]);
    const auto distance2 = [&](int a, int b) {
      return (mesh_.vertices[static_cast<std::size_t>(q[static_cast<std::size_t>(a)])] -
              mesh_.vertices[static_cast<std::size_t>(q[static_cast<std::size_t>(b)])])
          .squaredNorm();
    };
    if (distance2(0, 2) <= distance2(1, 3)) {
      out[0] = {q[0], q[1], q[2]};
      out[1] = {q[0], q[2], q[3]};
    } else {
      out[0] = {q[0], q[1], q[3]};
      out[1] = {q[1], q[2], q[3]};
    }
  }

  const SmoothedField& field_;
  Cell n_;
  std::ptrdiff_t rows_;
  std::vector<std::uint8_t> mixed_;   // by row of cells: 1 where the surface crosses it
  std::vector<std::int32_t> vertex_;  // of each cell; -1: the surface does not cross it
  SurfaceMesh mesh_;
};

}  // namespace

SurfaceMesh reconstruct_surface(const PointCloud& cloud, const Box& region) {
  const double dx = cloud.spacing;
  if (!(dx > 0)) throw NumericalFailure("surface mesh: the particle spacing must be positive");
  const CloudSelection selected = select_cloud(cloud, region, kReach * dx);
  if (selected.position.empty()) return {};
  // No surface is further than two spacings from a particle. Vertices stand near the middle of cells, so half
  // a cell more makes the mesh reach the faces of the region. At the top the mesh closes a cloud that was cut
  // there: a lid, not a view into the metal.
  const Vec3 half = Vec3::Constant(0.5 * SmoothedField::kStep * dx), two = Vec3::Constant(2 * dx);
  const Box extent{(region.min - half).cwiseMax(selected.bounds.min - two),
                   (region.max + half + Vec3(0, 0, 2 * dx)).cwiseMin(selected.bounds.max + two)};
  if (!(extent.min.array() < extent.max.array()).all()) return {};
  SurfaceMesh mesh = SurfaceNets(SmoothedField(selected, dx, extent)).take();
  smooth_normals(mesh, kNormalPasses);
  return mesh;
}

}  // namespace meltray::laser
