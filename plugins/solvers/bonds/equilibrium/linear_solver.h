// Inverse of a block matrix restricted to its free degrees of freedom: exact by factors where they stay
// small, else approximate by multigrid cycles.
#pragma once

#include "equilibrium/block_matrix.h"

#include <memory>

namespace bonds {

/// A place of a cell, m: rigid motions of parts are what multigrid is built on.
using Places = Eigen::Matrix<double, 3, Eigen::Dynamic>;

class Inverse
{
public:
   virtual ~Inverse() = default;
   /// Takes the symmetric part of a matrix with the pattern that it was made for.
   virtual void compute(const sdk::Call &call, const BlockMatrix &matrix, const Places &places) = 0;
   /// x = B r with symmetric B; held degrees of freedom of r do not count, those of x are 0.
   virtual void apply(const sdk::Call &call, const Vector &r, Vector &x) const = 0;
   virtual bool exact() const = 0;
   /// Negative eigenvalues of the matrix; -1 when that is unknown.
   virtual std::int64_t negative() const { return -1; }
   /// A degree of freedom (6 * cell + k) that nothing holds; -1 when the matrix is regular.
   virtual std::int64_t singular() const { return -1; }
};

/// Cost of exact factors of a pattern.
struct Fill
{
   double blocks = 0, operations = 0;
};
Fill countFill(const BlockMatrix &matrix, const std::vector<std::int32_t> &order, double mostBlocks);
/// Order of elimination with little fill: approximate minimum degree.
std::vector<std::int32_t> eliminationOrder(const BlockMatrix &matrix);

/// `free` is 1 where free, 0 where held.
std::unique_ptr<Inverse> makeFactors(const BlockMatrix &pattern, const Vector &free,
                                     const std::vector<std::int32_t> &order);
std::unique_ptr<Inverse> makeMultigrid(const BlockMatrix &pattern, const Vector &free, const Places &rest);
/// Factors while they take a second or so, since they know unstable directions and do not mind contrast, else
/// multigrid, which is faster from some 500 dense cells on (12^3: 1.2 s by factors; 13^3: 0.06 s by
/// multigrid).
std::unique_ptr<Inverse> makeInverse(const BlockMatrix &pattern, const Vector &free, const Places &rest);

/// What ended an iteration.
struct Solution
{
   int iterations = 0;
   double residual = 0; // over that of the right side
   bool indefinite = false;
};
/// Solves A x = r for free degrees of freedom by conjugate gradients; stops early, with what it has, where A
/// curves down.
Solution conjugateGradients(const sdk::Call &call, const BlockMatrix &matrix, const Vector &free,
                            const Inverse &inverse, const Vector &r, double tolerance, int most, Vector &x);
/// The same for matrices that are not symmetric (GMRES; Saad and Schultz 1986).
Solution minimalResidual(const sdk::Call &call, const BlockMatrix &matrix, const Vector &free,
                         const Inverse &inverse, const Vector &r, double tolerance, int most, Vector &x);

} // namespace bonds
