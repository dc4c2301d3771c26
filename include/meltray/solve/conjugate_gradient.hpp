// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "meltray/core/vec.hpp"

namespace meltray::solve {

/// Symmetric matrix A = diag - off with off-diagonals stored by rows (both triangles), off >= 0 for the
/// Laplacians of this program.
struct SymmetricMatrix {
  std::vector<Index> start{0}, column;
  std::vector<double> off;       ///< -A_ij
  std::vector<double> diagonal;  ///< A_ii
  Index rows() const { return static_cast<Index>(diagonal.size()); }
};

/// y = A x.
void multiply(const SymmetricMatrix& a, const std::vector<double>& x, std::vector<double>& y);

struct SolveReport {
  int iterations = 0;
  double residual = 0;  ///< |b - A x| / |b|, both in the norm of the inverse diagonal
  bool converged = false;
};

/// Conjugate gradients with a diagonal preconditioner; bitwise independent of the number of threads. A
/// singular consistent system (closed pockets) is solved in the range of A.
class ConjugateGradient {
 public:
  /// Solves A x = b from the start vector in x.
  SolveReport solve(const SymmetricMatrix& a, const std::vector<double>& b, std::vector<double>& x,
                    double tolerance, int max_iterations);

 private:
  std::vector<double> r_, p_, ap_, inverse_;
};

/// Finds the connected groups of rows without any row of `anchored` > 0 and numbers them from 1 (0 = anchored
/// group). Returns how many there are.
int floating_components(const SymmetricMatrix& a, const std::vector<double>& anchored,
                        std::vector<Index>& group);

}  // namespace meltray::solve
