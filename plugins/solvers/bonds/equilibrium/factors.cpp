// Factors L D L^T of the symmetric part of a block matrix, in an order chosen on cells.
#include "equilibrium/linear_solver.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>

namespace bonds {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// A pivot this much smaller than its diagonal is rounding: nothing holds that degree of freedom. A clamped
/// chain of 1000 cells has 1e-9, with a contrast of 10^6 some 1e-13.
constexpr double kSingular = 2e-15;

class Factors : public Inverse
{
public:
   Factors(const BlockMatrix &pattern, const Vector &free, const std::vector<std::int32_t> &order);
   void compute(const sdk::Call &call, const BlockMatrix &matrix, const Places &places) override;
   void apply(const sdk::Call &call, const Vector &r, Vector &x) const override;
   bool exact() const override { return true; }
   std::int64_t negative() const override { return m_negative; }
   std::int64_t singular() const override { return m_singular; }

private:
   Eigen::SimplicialLDLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>> m_solver;
   Sparse m_lower;
   std::vector<std::int64_t> m_freedom;             // of each row: 6 * cell + k
   std::vector<std::array<std::int64_t, 2>> m_from; // of each stored value: mirror values of the block matrix
   std::int64_t m_negative = 0, m_singular = -1;
   std::int64_t m_size = 0;
};

Factors::Factors(const BlockMatrix &pattern, const Vector &free, const std::vector<std::int32_t> &order)
    : m_size(6 * pattern.rows())
{
   std::vector<int> row(static_cast<std::size_t>(m_size), -1);
   for (const std::int32_t cell : order)
      for (int k = 0; k < 6; ++k)
         if (free[6 * cell + k] != 0) {
            row[6 * cell + k] = static_cast<int>(m_freedom.size());
            m_freedom.push_back(6 * cell + k);
         }
   struct Entry
   {
      int row;
      std::array<std::int64_t, 2> from;
   };
   std::vector<int> outer{0}, inner;
   std::vector<Entry> entries;
   for (const std::int64_t freedom : m_freedom) {
      const std::int64_t cell = freedom / 6, k = freedom % 6;
      entries.clear();
      for (std::int64_t e = pattern.begin(cell); e < pattern.end(cell); ++e) {
         const std::int64_t other = pattern.column(e), back = pattern.find(other, cell);
         for (int j = 0; j < 6; ++j)
            if (row[6 * other + j] >= row[freedom]) // (other, j) is the row, (cell, k) the column
               entries.push_back({row[6 * other + j], {36 * back + 6 * k + j, 36 * e + 6 * j + k}});
      }
      std::sort(entries.begin(), entries.end(), [](const Entry &a, const Entry &b) { return a.row < b.row; });
      for (const Entry &entry : entries) {
         inner.push_back(entry.row);
         m_from.push_back(entry.from);
      }
      outer.push_back(static_cast<int>(inner.size()));
   }
   const auto n = static_cast<Eigen::Index>(m_freedom.size());
   const std::vector<double> zero(inner.size(), 0.0);
   m_lower = Eigen::Map<const Sparse>(n, n, static_cast<Eigen::Index>(inner.size()), outer.data(),
                                      inner.data(), zero.data());
   m_solver.analyzePattern(m_lower);
}

void Factors::compute(const sdk::Call &, const BlockMatrix &matrix, const Places &)
{
   double *values = m_lower.valuePtr();
   for (std::size_t i = 0; i < m_from.size(); ++i)
      values[i] = 0.5 * (matrix.value(m_from[i][0]) + matrix.value(m_from[i][1]));
   m_solver.factorize(m_lower);
   m_negative = 0;
   m_singular = -1;
   if (m_freedom.empty())
      return;
   const auto &pivots = m_solver.vectorD();
   for (Eigen::Index i = 0; i < pivots.size(); ++i) {
      if (!(std::abs(pivots[i]) > kSingular * std::abs(m_lower.coeff(i, i)))) {
         m_singular = m_freedom[i];
         return;
      }
      if (pivots[i] < 0)
         ++m_negative;
   }
   if (m_singular < 0 && m_solver.info() != Eigen::Success)
      m_singular = m_freedom.front();
}

void Factors::apply(const sdk::Call &, const Vector &r, Vector &x) const
{
   Vector part(static_cast<Eigen::Index>(m_freedom.size()));
   for (Eigen::Index i = 0; i < part.size(); ++i)
      part[i] = r[m_freedom[i]];
   if (part.size() > 0)
      part = m_solver.solve(part).eval();
   x.setZero(m_size);
   for (Eigen::Index i = 0; i < part.size(); ++i)
      x[m_freedom[i]] = part[i];
}

} // namespace

std::vector<std::int32_t> eliminationOrder(const BlockMatrix &matrix)
{
   using Graph = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
   const auto n = static_cast<Eigen::Index>(matrix.rows());
   std::vector<int> outer{0}, inner;
   for (std::int64_t i = 0; i < n; ++i) {
      for (std::int64_t e = matrix.begin(i); e < matrix.end(i); ++e)
         inner.push_back(matrix.column(e));
      outer.push_back(static_cast<int>(inner.size()));
   }
   const std::vector<double> ones(inner.size(), 1.0);
   const Graph graph = Eigen::Map<const Graph>(n, n, static_cast<Eigen::Index>(inner.size()), outer.data(),
                                               inner.data(), ones.data());
   Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
   Eigen::AMDOrdering<int>()(graph, permutation);
   return {permutation.indices().data(), permutation.indices().data() + n};
}

/// Rows of the factor by the elimination tree (Liu, SIAM J. Matrix Anal. 11, 1990): row i of L has the
/// columns met on the way from each lower neighbour up to i.
Fill countFill(const BlockMatrix &matrix, const std::vector<std::int32_t> &order, double mostBlocks)
{
   const auto n = static_cast<std::size_t>(matrix.rows());
   std::vector<std::int32_t> place(n), parent(n, -1), seen(n, -1), count(n, 1);
   for (std::size_t i = 0; i < n; ++i)
      place[order[i]] = static_cast<std::int32_t>(i);
   Fill fill;
   fill.blocks = static_cast<double>(n);
   for (std::size_t i = 0; i < n; ++i) {
      const auto row = static_cast<std::int32_t>(i);
      seen[i] = row;
      for (std::int64_t e = matrix.begin(order[i]); e < matrix.end(order[i]); ++e) {
         for (std::int32_t j = place[matrix.column(e)]; j < row && seen[j] != row; j = parent[j]) {
            if (parent[j] < 0)
               parent[j] = row;
            seen[j] = row;
            ++count[j];
            fill.blocks += 1;
         }
         if (fill.blocks > mostBlocks) {
            fill.operations = std::numeric_limits<double>::infinity();
            return fill;
         }
      }
   }
   for (const double blocks : count)
      fill.operations += 216 * blocks * blocks; // multiply-adds
   return fill;
}

std::unique_ptr<Inverse> makeFactors(const BlockMatrix &pattern, const Vector &free,
                                     const std::vector<std::int32_t> &order)
{
   return std::make_unique<Factors>(pattern, free, order);
}

std::unique_ptr<Inverse> makeInverse(const BlockMatrix &pattern, const Vector &free, const Places &rest)
{
   constexpr double kMostBlocks = 3e6;     // some 1.5 GB
   constexpr double kMostOperations = 2e9; // a second or so
   const std::vector<std::int32_t> order = eliminationOrder(pattern);
   const Fill fill = countFill(pattern, order, kMostBlocks);
   if (fill.operations <= kMostOperations)
      return makeFactors(pattern, free, order);
   return makeMultigrid(pattern, free, rest);
}

} // namespace bonds
