// Eigenpairs at the upper end of a symmetric operator, from a block Krylov space (Saad, Numerical Methods for
// Large Eigenvalue Problems, 2011, chapter 6) that keeps all its vectors.
#pragma once

#include "equilibrium/balance.h"

namespace bonds {

/// Symmetric on the free degrees of freedom and nothing elsewhere.
class SymmetricOperator
{
public:
   virtual ~SymmetricOperator() = default;
   /// False where the operator turns out not to be what it should be.
   virtual bool apply(const sdk::Call &call, const Vector &y, Vector &out) const = 0;
   virtual const Vector &free() const = 0;
};

/// Orthonormal vectors, and the operator seen by them.
class RitzSpace
{
public:
   /// `size` of the whole space. Eigenvalues that repeat are sure to be found as often as there are `starts`.
   /// A vector is sharp where the operator takes it beyond the subspace by no more
   /// than `sharpness` of its eigenvalue; the eigenvalue is then that close, and mostly by the square.
   RitzSpace(const SymmetricOperator &symmetric, std::size_t size, std::size_t starts, double sharpness)
       : m_operator(&symmetric), m_size(size), m_starts(starts), m_sharpness(sharpness)
   {}

   /// Takes the operator to one more vector; false where it fails.
   bool grow(const sdk::Call &call);
   bool full() const { return m_done >= m_size; }
   std::size_t done() const { return m_done; }
   /// Ritz values, descending, and their vectors in the subspace; returns how many of the first are sharp.
   std::size_t sharp(Eigen::VectorXd &values, Eigen::MatrixXd &vectors) const;
   Vector combine(const Eigen::VectorXd &part) const;

private:
   bool append(Vector w, double scale, Column *coefficients);
   void appendRandom();

   const SymmetricOperator *m_operator;
   std::size_t m_size, m_starts;
   double m_sharpness;
   std::vector<Vector> m_basis;
   std::vector<Column> m_column; // of the operator, for each vector that is done
   std::size_t m_done = 0;
   unsigned m_random = 1;
};

} // namespace bonds
