// A symmetric matrix over the masses of a scene: its eigenvalues are those of K x = w^2 M x.
#pragma once

#include "equilibrium/ritz.h"

namespace bonds {

/// Symmetric mass of every cell, 6 x 6: that of spins turns with the cell. `free` cuts held ones out.
std::vector<Block> massBlocks(const Balance &balance, const State &state);

/// A mass matrix M = L L^T of blocks on the diagonal.
struct MassRoot
{
   explicit MassRoot(const std::vector<Block> &mass);
   /// L^-T y
   Vector shapeOf(const Vector &y) const;

   std::vector<Block> root, inverse; // L^T, L^-T
};

/// L^-1 A L^-T on free degrees of freedom.
class MassScaled : public SymmetricOperator
{
public:
   MassScaled(const Balance &balance, const State &state, BlockMatrix matrix)
       : m_free(balance.supports().free()), m_root(massBlocks(balance, state)), m_matrix(std::move(matrix))
   {}

   bool apply(const sdk::Call &call, const Vector &y, Vector &out) const override;
   Vector shapeOf(const Vector &y) const { return m_root.shapeOf(y).cwiseProduct(m_free); }
   const Vector &free() const override { return m_free; }

private:
   Vector m_free;
   MassRoot m_root;
   BlockMatrix m_matrix;
};

} // namespace bonds
