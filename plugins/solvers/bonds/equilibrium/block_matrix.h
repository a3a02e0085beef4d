// A square matrix of 6 x 6 blocks: how the force and moment on one cell change with the displacement and
// spin of another. Compressed rows, all blocks of a row in ascending order of column.
#pragma once

#include "equilibrium/pieces.h"

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace bonds {

using Vector = Eigen::VectorXd; // 6 numbers a cell
using Block = Eigen::Matrix<double, 6, 6>;

class BlockMatrix
{
public:
   BlockMatrix() = default;
   /// Zero, with room for the diagonal and for each pair both ways.
   BlockMatrix(std::int64_t rows, const std::vector<std::pair<std::int32_t, std::int32_t>> &pairs);

   std::int64_t rows() const { return static_cast<std::int64_t>(m_diagonal.size()); }
   std::int64_t begin(std::int64_t row) const { return m_first[row]; }
   std::int64_t end(std::int64_t row) const { return m_first[row + 1]; }
   std::int64_t blocks() const { return static_cast<std::int64_t>(m_column.size()); }
   std::int32_t column(std::int64_t block) const { return m_column[block]; }
   std::int64_t diagonal(std::int64_t row) const { return m_diagonal[row]; }
   /// The block's number; it must exist.
   std::int64_t find(std::int64_t row, std::int64_t column) const;

   Eigen::Map<Block> operator[](std::int64_t block) { return Eigen::Map<Block>(m_value.data() + 36 * block); }
   Eigen::Map<const Block> operator[](std::int64_t block) const
   {
      return Eigen::Map<const Block>(m_value.data() + 36 * block);
   }
   double value(std::int64_t index) const { return m_value[index]; }

   void clearRow(std::int64_t row);
   /// A -= B, of the same pattern.
   void subtract(const BlockMatrix &other);
   /// y = A x
   void multiply(const sdk::Call &call, const Vector &x, Vector &y) const;

private:
   std::vector<std::int64_t> m_first, m_diagonal;
   std::vector<std::int32_t> m_column;
   std::vector<double> m_value; // column-major in each block
};

} // namespace bonds
