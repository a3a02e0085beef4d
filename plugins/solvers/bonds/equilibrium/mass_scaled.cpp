#include "equilibrium/mass_scaled.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace bonds {

MassRoot::MassRoot(const std::vector<Block> &mass) : root(mass.size()), inverse(mass.size())
{
   for (std::size_t i = 0; i < mass.size(); ++i) {
      const Eigen::LLT<Block> llt(mass[i]);
      root[i] = llt.matrixU();
      inverse[i] = root[i].inverse();
   }
}

Vector MassRoot::shapeOf(const Vector &y) const
{
   Vector out(y.size());
   for (std::size_t i = 0; i < root.size(); ++i)
      out.segment<6>(6 * i).noalias() = inverse[i] * y.segment<6>(6 * i);
   return out;
}

bool MassScaled::apply(const sdk::Call &call, const Vector &y, Vector &out) const
{
   m_matrix.multiply(call, shapeOf(y), out);
   out.array() *= m_free.array();
   for (std::size_t i = 0; i < m_root.inverse.size(); ++i)
      out.segment<6>(6 * i) = (m_root.inverse[i].transpose() * out.segment<6>(6 * i)).eval();
   out.array() *= m_free.array();
   return true;
}

std::vector<Block> massBlocks(const Balance &balance, const State &state)
{
   const Assembly &assembly = balance.assembly();
   const Vector &free = balance.supports().free();
   std::vector<Block> out(static_cast<std::size_t>(state.n), Block::Zero());
   for (std::int64_t i = 0; i < state.n; ++i) {
      Block &block = out[i];
      for (int k = 0; k < 3; ++k) {
         const Vec3 unit{k == 0 ? 1.0 : 0, k == 1 ? 1.0 : 0, k == 2 ? 1.0 : 0};
         const Vec3 momentum = spinMomentum(assembly, i, state.turnOf(i), unit);
         block(k, k) = assembly.mass[i];
         block.col(3 + k).tail<3>() << momentum.x, momentum.y, momentum.z;
      }
      for (int k = 3; k < 6; ++k)
         for (int j = 3; j < 6; ++j)
            if (j != k)
               block(k, j) *= free[6 * i + k] * free[6 * i + j];
   }
   return out;
}

} // namespace bonds
