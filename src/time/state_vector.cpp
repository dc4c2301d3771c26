// SPDX-License-Identifier: MIT
#include "time/state_vector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <utility>
#include <vector>

#include "meltray/core/memory.hpp"
#include "meltray/core/parallel.hpp"
#include "time/sweep.hpp"

namespace meltray::integration {

/// The operations that ARKODE calls; each is one pass over the logical length.
struct VectorOps {
  static VectorSpace& space(N_Vector v) { return *VectorSpace::content(v).space; }
  static double* data(N_Vector v) {
    VectorSpace::Content& c = VectorSpace::content(v);
    if (c.data == nullptr) c.allocate();
    return c.data;
  }
  static std::size_t size(N_Vector v) { return space(v).length(); }

  static N_Vector_ID id(N_Vector) { return SUNDIALS_NVEC_CUSTOM; }
  static N_Vector clone(N_Vector v) {
    try {
      return space(v).take();
    } catch (const std::bad_alloc&) {
      return nullptr;
    }
  }
  static void destroy(N_Vector v) {
    if (v != nullptr) space(v).give_back(v);
  }
  static void storage(N_Vector v, sunindextype* reals, sunindextype* integers) {
    *reals = length(v);
    *integers = 1;
  }
  static sunindextype length(N_Vector v) { return static_cast<sunindextype>(size(v)); }

  static void linear_sum(double a, N_Vector vx, double b, N_Vector vy, N_Vector vz) {
    const double *x = data(vx), *y = data(vy);
    double* z = data(vz);
    sweep(size(vz), [=](std::ptrdiff_t i) { z[i] = a * x[i] + b * y[i]; });
  }
  static void constant(double c, N_Vector vz) {
    double* z = data(vz);
    sweep(size(vz), [=](std::ptrdiff_t i) { z[i] = c; });
  }
  static void scale(double c, N_Vector vx, N_Vector vz) {
    const double* x = data(vx);
    double* z = data(vz);
    if (x == z && c == 1.0) return;
    sweep(size(vz), [=](std::ptrdiff_t i) { z[i] = c * x[i]; });
  }
  static void product(N_Vector vx, N_Vector vy, N_Vector vz) {
    const double *x = data(vx), *y = data(vy);
    double* z = data(vz);
    sweep(size(vz), [=](std::ptrdiff_t i) { z[i] = x[i] * y[i]; });
  }
  static void quotient(N_Vector vx, N_Vector vy, N_Vector vz) {
    const double *x = data(vx), *y = data(vy);
    double* z = data(vz);
    sweep(size(vz), [=](std::ptrdiff_t i) { z[i] = x[i] / y[i]; });
  }
  static void absolute(N_Vector vx, N_Vector vz) {
    const double* x = data(vx);
    double* z = data(vz);
    sweep(size(vz), [=](std::ptrdiff_t i) { z[i] = std::abs(x[i]); });
  }
  static void inverse(N_Vector vx, N_Vector vz) {
    const double* x = data(vx);
    double* z = data(vz);
    sweep(size(vz), [=](std::ptrdiff_t i) { z[i] = 1.0 / x[i]; });
  }
  static void add_constant(N_Vector vx, double b, N_Vector vz) {
    const double* x = data(vx);
    double* z = data(vz);
    sweep(size(vz), [=](std::ptrdiff_t i) { z[i] = x[i] + b; });
  }
  static double dot(N_Vector vx, N_Vector vy) {
    const double *x = data(vx), *y = data(vy);
    return parallel_sum(length(vx), [=](std::ptrdiff_t i) { return x[i] * y[i]; });
  }
  static double largest(N_Vector vx) {
    const double* x = data(vx);
    return parallel_max(length(vx), 0.0, [=](std::ptrdiff_t i) { return std::abs(x[i]); });
  }
  static double smallest(N_Vector vx) {
    const double* x = data(vx);
    return -parallel_max(length(vx), -std::numeric_limits<double>::max(),
                         [=](std::ptrdiff_t i) { return -x[i]; });
  }
  static double weighted_rms(N_Vector vx, N_Vector vw) { return space(vx).norm()(data(vx), data(vw)); }

  /// z = sum c_k x_k over a number of terms that the compiler knows.
  template <std::size_t... K>
  static void combine_few(const double* c, const double* const* x, N_Vector vz, std::index_sequence<K...>) {
    double* z = data(vz);
    const std::array<double, sizeof...(K)> factor{c[K]...};
    const std::array<const double*, sizeof...(K)> from{x[K]...};
    sweep(size(vz), [=](std::ptrdiff_t i) { z[i] = (0.0 + ... + (factor[K] * from[K][i])); });
  }

  /// The same for any number, in one pass with the partial sums in cache.
  static void combine_many(const std::vector<double>& c, const std::vector<const double*>& x, N_Vector vz) {
    constexpr std::ptrdiff_t kChunk = 512;
    double* z = data(vz);
    sweep_blocks(size(vz), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      double sum[kChunk];
      for (std::ptrdiff_t at = begin; at < end; at += kChunk) {
        const std::ptrdiff_t n = std::min(kChunk, end - at);
        std::fill_n(sum, n, 0.0);
        for (std::size_t k = 0; k < c.size(); ++k) {
          const double ck = c[k];
          const double* xk = x[k] + at;
#pragma omp simd
          for (std::ptrdiff_t i = 0; i < n; ++i) sum[i] += ck * xk[i];
        }
        std::copy_n(sum, n, z + at);
      }
    });
  }

  /// z = sum c_k x_k; z may be any of the x. Butcher tables are full of zeros: such terms are left out.
  static int combine(int count, double* c, N_Vector* vx, N_Vector vz) {
    thread_local std::vector<double> factor;
    thread_local std::vector<const double*> x;
    factor.clear();
    x.clear();
    for (int k = 0; k < count; ++k)
      if (c[k] != 0.0) {
        factor.push_back(c[k]);
        x.push_back(data(vx[k]));
      }
    const auto few = [&]<std::size_t... N>(std::index_sequence<N...>) {
      return ((factor.size() == N + 1 &&
               (combine_few(factor.data(), x.data(), vz, std::make_index_sequence<N + 1>{}), true)) ||
              ...);
    };
    if (!few(std::make_index_sequence<4>{})) combine_many(factor, x, vz);
    return 0;
  }

  static void fill(N_Vector_Ops ops) {
    ops->nvgetvectorid = id;
    ops->nvclone = clone;
    ops->nvdestroy = destroy;
    ops->nvspace = storage;
    ops->nvgetarraypointer = data;
    ops->nvgetlength = length;
    ops->nvlinearsum = linear_sum;
    ops->nvconst = constant;
    ops->nvprod = product;
    ops->nvdiv = quotient;
    ops->nvscale = scale;
    ops->nvabs = absolute;
    ops->nvinv = inverse;
    ops->nvaddconst = add_constant;
    ops->nvdotprod = dot;
    ops->nvmaxnorm = largest;
    ops->nvmin = smallest;
    ops->nvwrmsnorm = weighted_rms;
    ops->nvlinearcombination = combine;
  }
};

void VectorSpace::Content::allocate() {
  memory.assign(space->capacity_, 0.0);
  data = memory.data();
}

VectorSpace::VectorSpace(SUNContext context) : context_(context), view_(add()) {}

VectorSpace::~VectorSpace() = default;

VectorSpace::Content* VectorSpace::add() {
  auto c = std::make_unique<Content>();
  c->shell.reset(N_VNewEmpty(context_));
  if (c->shell == nullptr) throw std::bad_alloc();
  c->space = this;
  c->data = nullptr;
  c->shell->content = c.get();
  VectorOps::fill(c->shell->ops);
  all_.push_back(std::move(c));
  spare_.reserve(all_.size());
  return all_.back().get();
}

void VectorSpace::shape(std::span<const StateField> fields, std::size_t length) {
  norm_.set(fields, length);
  if (length <= capacity_) return;
  // A quarter more than needed: particles are split one refinement at a time.
  capacity_ = capacity_ == 0 ? length : length + length / 4;
  release();
}

void VectorSpace::release() {
  for (const auto& c : all_) {
    if (c.get() == view_) continue;
    free_memory(c->memory);
    c->data = nullptr;
  }
}

N_Vector VectorSpace::take() {
  if (!spare_.empty()) {
    N_Vector v = spare_.back();
    spare_.pop_back();
    return v;
  }
  return add()->shell.get();
}

void VectorSpace::give_back(N_Vector v) {
  spare_.push_back(v);
}

N_Vector VectorSpace::view(double* data) {
  view_->data = data;
  return view_->shell.get();
}

std::size_t VectorSpace::bytes() const {
  std::size_t doubles = 0;
  for (const auto& c : all_) doubles += c->memory.capacity();
  return doubles * sizeof(double);
}

double* entries(N_Vector v) {
  return VectorOps::data(v);
}

}  // namespace meltray::integration
