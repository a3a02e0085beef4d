#include "equilibrium/ritz.h"

#include <Eigen/Eigenvalues>

namespace bonds {

/// Makes w orthogonal to the basis, twice (once loses digits), and adds it unless nothing is left of it.
bool RitzSpace::append(Vector w, double scale, Column *coefficients)
{
   Column h(m_basis.size(), 0);
   for (int pass = 0; pass < 2; ++pass)
      for (std::size_t i = 0; i < m_basis.size(); ++i) {
         const double part = w.dot(m_basis[i]);
         h[i] += part;
         w -= part * m_basis[i];
      }
   const double left = w.norm();
   const bool more = m_basis.size() < m_size && left > 1e-12 * scale;
   if (more) {
      m_basis.push_back(w / left);
      h.push_back(left);
   }
   if (coefficients)
      *coefficients = std::move(h);
   return more;
}

void RitzSpace::appendRandom()
{
   Vector w(m_operator->free().size());
   for (double &x : w) {
      m_random = m_random * 1664525 + 1013904223; // Numerical Recipes' generator: the same on all machines
      x = static_cast<double>(m_random >> 8) / (1 << 24) - 0.5;
   }
   w.array() *= m_operator->free().array();
   const double scale = w.norm();
   append(std::move(w), scale, nullptr);
}

bool RitzSpace::grow(const sdk::Call &call)
{
   while (m_basis.size() < std::min(m_starts, m_size) || m_basis.size() == m_done)
      appendRandom();
   Vector w;
   if (!m_operator->apply(call, m_basis[m_done], w))
      return false;
   Column coefficients;
   const double scale = w.norm();
   append(std::move(w), scale, &coefficients);
   m_column.push_back(std::move(coefficients));
   ++m_done;
   return true;
}

std::size_t RitzSpace::sharp(Eigen::VectorXd &values, Eigen::MatrixXd &vectors) const
{
   const auto n = static_cast<Eigen::Index>(m_done), all = static_cast<Eigen::Index>(m_basis.size());
   Eigen::MatrixXd h = Eigen::MatrixXd::Zero(all, n);
   for (Eigen::Index j = 0; j < n; ++j)
      for (std::size_t i = 0; i < m_column[j].size(); ++i)
         h(static_cast<Eigen::Index>(i), j) = m_column[j][i];
   const Eigen::MatrixXd square = h.topRows(n);
   const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (square + square.transpose()));
   values = solver.eigenvalues().reverse();
   vectors = solver.eigenvectors().rowwise().reverse();
   const Eigen::MatrixXd beyond = h.bottomRows(all - n) * vectors;
   std::size_t count = 0;
   while (count < m_done && beyond.col(static_cast<Eigen::Index>(count)).norm() <=
                                m_sharpness * std::abs(values[static_cast<Eigen::Index>(count)]))
      ++count;
   return count;
}

Vector RitzSpace::combine(const Eigen::VectorXd &part) const
{
   Vector out = Vector::Zero(m_basis.front().size());
   for (Eigen::Index i = 0; i < part.size(); ++i)
      out += part[i] * m_basis[i];
   return out;
}

} // namespace bonds
