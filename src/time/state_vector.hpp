// SPDX-License-Identifier: MIT
#pragma once

#include <sundials/sundials_context.h>
#include <sundials/sundials_nvector.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "time/error_norm.hpp"

namespace meltray::integration {

/// All vectors that ARKODE works with. They share one logical length and one norm, which live here: a change
/// of the state's size reaches every vector at once (no ARKStepResize, nothing to re-attach), and memory
/// grows only when the capacity is exceeded. Destroyed vectors are kept for the next clone, so that steps do
/// not allocate. ARKODE asks for more vectors than a method uses: memory comes with the first access.
/// (Debian's own vectors are compiled without optimisation and about ten times slower.)
class VectorSpace {
 public:
  explicit VectorSpace(SUNContext context);
  ~VectorSpace();
  VectorSpace(const VectorSpace&) = delete;
  VectorSpace& operator=(const VectorSpace&) = delete;

  /// New length, fields and tolerances of all vectors; their entries are undefined (but finite) after growth.
  void shape(std::span<const StateField> fields, std::size_t length);

  N_Vector take();           ///< a vector with memory of its own
  void give_back(N_Vector);  ///< counterpart of take(); also what N_VDestroy does
  /// The vector through which ARKODE reads foreign memory: points it at `data` (of the space's length).
  N_Vector view(double* data);

  const ErrorNorm& norm() const { return norm_; }
  std::size_t length() const { return norm_.length(); }
  std::size_t bytes() const;
  /// Gives back the memory of all vectors; their entries are zero at the next access.
  void release();

 private:
  struct FreeEmpty {
    void operator()(N_Vector v) const { N_VFreeEmpty(v); }
  };
  using Shell = std::unique_ptr<_generic_N_Vector, FreeEmpty>;
  struct Content {
    VectorSpace* space;
    double* data;
    std::vector<double> memory;
    Shell shell;
    void allocate();
  };
  Content* add();
  static Content& content(N_Vector v) { return *static_cast<Content*>(v->content); }
  friend struct VectorOps;

  SUNContext context_;
  ErrorNorm norm_;
  std::size_t capacity_ = 0;
  std::vector<std::unique_ptr<Content>> all_;
  std::vector<N_Vector> spare_;
  Content* view_;
};

/// Entries of a vector of ours.
double* entries(N_Vector v);

/// Returns a vector to its space at the end of a scope.
struct GiveBack {
  void operator()(N_Vector v) const { N_VDestroy(v); }
};
using OwnedVector = std::unique_ptr<_generic_N_Vector, GiveBack>;

}  // namespace meltray::integration
