#include "equilibrium/block_matrix.h"

namespace bonds {

BlockMatrix::BlockMatrix(std::int64_t rows, const std::vector<std::pair<std::int32_t, std::int32_t>> &pairs)
    : m_first(static_cast<std::size_t>(rows) + 1, 0), m_diagonal(static_cast<std::size_t>(rows))
{
   std::vector<std::pair<std::int32_t, std::int32_t>> all;
   all.reserve(2 * pairs.size() + static_cast<std::size_t>(rows));
   for (std::int32_t i = 0; i < rows; ++i)
      all.emplace_back(i, i);
   for (const auto &[a, b] : pairs) {
      all.emplace_back(a, b);
      all.emplace_back(b, a);
   }
   std::sort(all.begin(), all.end());
   all.erase(std::unique(all.begin(), all.end()), all.end());
   m_column.reserve(all.size());
   for (const auto &[row, column] : all) {
      ++m_first[row + 1];
      if (row == column)
         m_diagonal[row] = static_cast<std::int64_t>(m_column.size());
      m_column.push_back(column);
   }
   for (std::int64_t i = 0; i < rows; ++i)
      m_first[i + 1] += m_first[i];
   m_value.assign(36 * m_column.size(), 0);
}

std::int64_t BlockMatrix::find(std::int64_t row, std::int64_t column) const
{
   const auto first = m_column.begin() + m_first[row], last = m_column.begin() + m_first[row + 1];
   return std::lower_bound(first, last, column) - m_column.begin();
}

void BlockMatrix::clearRow(std::int64_t row)
{
   std::fill(m_value.begin() + 36 * m_first[row], m_value.begin() + 36 * m_first[row + 1], 0.0);
}

void BlockMatrix::subtract(const BlockMatrix &other)
{
   for (std::size_t i = 0; i < m_value.size(); ++i)
      m_value[i] -= other.m_value[i];
}

void BlockMatrix::multiply(const sdk::Call &call, const Vector &x, Vector &y) const
{
   y.resize(6 * rows());
   forPieces(call, rows(), [&](std::int64_t from, std::int64_t to, std::int64_t) {
      for (std::int64_t i = from; i < to; ++i) {
         Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
         for (std::int64_t e = begin(i); e < end(i); ++e)
            sum.noalias() += (*this)[e] * x.segment<6>(6 * m_column[e]);
         y.segment<6>(6 * i) = sum;
      }
   });
}

} // namespace bonds
