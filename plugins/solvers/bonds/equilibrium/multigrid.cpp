// Algebraic multigrid for blocks of cells: cells that lie together move as one rigid body on the next level,
// which is again a block matrix of bodies with six degrees of freedom each (smoothed aggregation after
// Vanek, Mandel and Brezina, Computing 56, 1996, without the smoothing of the prolongation). One symmetric
// V-cycle: forward Gauss-Seidel over blocks, coarse correction, backward Gauss-Seidel.
#include "equilibrium/linear_solver.h"

#include "model/assembly.h"

#include <Eigen/LU>

#include <array>
#include <cmath>

namespace bonds {

namespace {

/// Rigid aggregates are too stiff; their correction is lengthened (Blaheta, J. Comput. Appl. Math. 24, 1988).
constexpr double kOverCorrection = 1.5;

using Freedoms = Eigen::Matrix<double, 6, 1>;

/// Which aggregate each cell belongs to: boxes of three cells an edge, cut where cells are not joined.
std::vector<std::int32_t> aggregates(const BlockMatrix &pattern, const Places &places, double edge,
                                     std::int32_t &count)
{
   const Eigen::Vector3d low = places.rowwise().minCoeff();
   using Box = std::array<std::int64_t, 3>;
   const auto n = static_cast<std::size_t>(pattern.rows());
   std::vector<Box> box(n);
   for (std::size_t i = 0; i < n; ++i)
      for (int k = 0; k < 3; ++k)
         box[i][k] = static_cast<std::int64_t>(std::floor((places(k, i) - low[k]) / edge + 1e-6));
   std::vector<std::int32_t> out(n, -1), stack;
   count = 0;
   for (std::size_t first = 0; first < n; ++first) {
      if (out[first] >= 0)
         continue;
      out[first] = count;
      stack.assign(1, static_cast<std::int32_t>(first));
      while (!stack.empty()) {
         const std::int32_t i = stack.back();
         stack.pop_back();
         for (std::int64_t e = pattern.begin(i); e < pattern.end(i); ++e) {
            const std::int32_t j = pattern.column(e);
            if (out[j] >= 0 || box[j] != box[i])
               continue;
            out[j] = count;
            stack.push_back(j);
         }
      }
      ++count;
   }
   return out;
}

class Multigrid : public Inverse
{
public:
   Multigrid(const BlockMatrix &pattern, const Vector &free, const Places &rest);
   void compute(const sdk::Call &call, const BlockMatrix &matrix, const Places &places) override;
   void apply(const sdk::Call &call, const Vector &r, Vector &x) const override;
   bool exact() const override { return false; }

private:
   void placeAggregates(const Places &places);
   /// Rigid motion of the aggregate as seen by cell i, held degrees of freedom left out.
   Block motion(std::int64_t i) const;
   void forward(const Vector &r, Vector &x) const;
   void backward(const Vector &r, Vector &x) const;

   BlockMatrix m_matrix; // held rows and columns are those of 1
   Vector m_free;
   std::vector<Block> m_diagonal; // inverses
   std::vector<std::int32_t> m_aggregate;
   Places m_arm;                       // from the aggregate's middle to the cell
   Places m_middle;                    // of each aggregate
   Column m_members;                   // of each aggregate
   std::vector<std::int64_t> m_target; // coarse block of each block
   BlockMatrix m_coarse;
   std::unique_ptr<Inverse> m_next;
};

/// Mean distance of joined cells.
double spacing(const BlockMatrix &pattern, const Places &places)
{
   double sum = 0;
   for (std::int64_t i = 0; i < pattern.rows(); ++i)
      for (std::int64_t e = pattern.begin(i); e < pattern.end(i); ++e)
         sum += (places.col(i) - places.col(pattern.column(e))).norm();
   return sum / static_cast<double>(std::max<std::int64_t>(1, pattern.blocks() - pattern.rows()));
}

Multigrid::Multigrid(const BlockMatrix &pattern, const Vector &free, const Places &rest)
    : m_matrix(pattern), m_free(free), m_diagonal(static_cast<std::size_t>(pattern.rows())),
      m_arm(3, pattern.rows())
{
   std::int32_t count = 0;
   m_aggregate = aggregates(pattern, rest, 3 * spacing(pattern, rest), count);
   m_members.assign(static_cast<std::size_t>(count), 0);
   for (const std::int32_t g : m_aggregate)
      m_members[g] += 1;
   m_middle.resize(3, count);
   placeAggregates(rest);
   std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
   for (std::int64_t i = 0; i < pattern.rows(); ++i)
      for (std::int64_t e = pattern.begin(i); e < pattern.end(i); ++e)
         if (const std::int32_t g = m_aggregate[i], h = m_aggregate[pattern.column(e)]; g < h)
            pairs.emplace_back(g, h);
   m_coarse = BlockMatrix(count, pairs);
   m_target.resize(static_cast<std::size_t>(pattern.blocks()));
   for (std::int64_t i = 0; i < pattern.rows(); ++i)
      for (std::int64_t e = pattern.begin(i); e < pattern.end(i); ++e)
         m_target[e] = m_coarse.find(m_aggregate[i], m_aggregate[pattern.column(e)]);
   m_next = makeInverse(m_coarse, Vector::Ones(6 * count), m_middle);
}

void Multigrid::placeAggregates(const Places &places)
{
   m_middle.setZero();
   for (std::int64_t i = 0; i < m_matrix.rows(); ++i)
      m_middle.col(m_aggregate[i]) += places.col(i) / m_members[m_aggregate[i]];
   for (std::int64_t i = 0; i < m_matrix.rows(); ++i)
      m_arm.col(i) = places.col(i) - m_middle.col(m_aggregate[i]);
}

Block Multigrid::motion(std::int64_t i) const
{
   Block p = Block::Identity();
   const auto arm = m_arm.col(i);
   p.topRightCorner<3, 3>() << 0, arm[2], -arm[1], -arm[2], 0, arm[0], arm[1], -arm[0], 0;
   return m_free.segment<6>(6 * i).asDiagonal() * p;
}

void Multigrid::compute(const sdk::Call &call, const BlockMatrix &matrix, const Places &places)
{
   placeAggregates(places);
   for (std::int64_t g = 0; g < m_coarse.rows(); ++g)
      m_coarse.clearRow(g);
   forPieces(call, matrix.rows(), [&](std::int64_t from, std::int64_t to, std::int64_t) {
      for (std::int64_t i = from; i < to; ++i) {
         const auto free = m_free.segment<6>(6 * i);
         for (std::int64_t e = matrix.begin(i); e < matrix.end(i); ++e)
            m_matrix[e] =
                free.asDiagonal() * matrix[e] * m_free.segment<6>(6 * matrix.column(e)).asDiagonal();
         auto own = m_matrix[matrix.diagonal(i)];
         own = (0.5 * (own + own.transpose())).eval();
         own.diagonal() += Freedoms::Ones() - free;
         m_diagonal[i] = own.inverse();
         if (!m_diagonal[i].allFinite())
            m_diagonal[i].setIdentity();
      }
   });
   for (std::int64_t i = 0; i < matrix.rows(); ++i) {
      const Block left = motion(i).transpose();
      for (std::int64_t e = matrix.begin(i); e < matrix.end(i); ++e)
         m_coarse[m_target[e]].noalias() += left * m_matrix[e] * motion(matrix.column(e));
   }
   // Motions that no cell of an aggregate can make, or that others already are, must not make it singular.
   for (std::int64_t g = 0; g < m_coarse.rows(); ++g)
      for (int k = 0; k < 6; ++k) {
         double &diagonal = m_coarse[m_coarse.diagonal(g)](k, k);
         diagonal = diagonal > 0 ? diagonal * (1 + 1e-12) : 1;
      }
   m_next->compute(call, m_coarse, m_middle);
}

void Multigrid::forward(const Vector &r, Vector &x) const
{
   for (std::int64_t i = 0; i < m_matrix.rows(); ++i) {
      Freedoms sum = r.segment<6>(6 * i);
      for (std::int64_t e = m_matrix.begin(i); e < m_matrix.diagonal(i); ++e)
         sum.noalias() -= m_matrix[e] * x.segment<6>(6 * m_matrix.column(e));
      x.segment<6>(6 * i).noalias() = m_diagonal[i] * sum;
   }
}

void Multigrid::backward(const Vector &r, Vector &x) const
{
   for (std::int64_t i = m_matrix.rows(); i-- > 0;) {
      Freedoms sum = r.segment<6>(6 * i);
      for (std::int64_t e = m_matrix.begin(i); e < m_matrix.end(i); ++e)
         if (e != m_matrix.diagonal(i))
            sum.noalias() -= m_matrix[e] * x.segment<6>(6 * m_matrix.column(e));
      x.segment<6>(6 * i).noalias() = m_diagonal[i] * sum;
   }
}

void Multigrid::apply(const sdk::Call &call, const Vector &r0, Vector &x) const
{
   const Vector r = r0.cwiseProduct(m_free);
   x.setZero(r.size());
   forward(r, x);
   // After a forward sweep from zero what is left is minus the upper triangle times x.
   Vector coarse = Vector::Zero(6 * m_coarse.rows()), lift;
   for (std::int64_t i = 0; i < m_matrix.rows(); ++i) {
      Freedoms left = Freedoms::Zero();
      for (std::int64_t e = m_matrix.diagonal(i) + 1; e < m_matrix.end(i); ++e)
         left.noalias() -= m_matrix[e] * x.segment<6>(6 * m_matrix.column(e));
      coarse.segment<6>(6 * m_aggregate[i]).noalias() += motion(i).transpose() * left;
   }
   m_next->apply(call, coarse, lift);
   for (std::int64_t i = 0; i < m_matrix.rows(); ++i)
      x.segment<6>(6 * i).noalias() += kOverCorrection * (motion(i) * lift.segment<6>(6 * m_aggregate[i]));
   backward(r, x);
}

} // namespace

std::unique_ptr<Inverse> makeMultigrid(const BlockMatrix &pattern, const Vector &free, const Places &rest)
{
   return std::make_unique<Multigrid>(pattern, free, rest);
}

} // namespace bonds
