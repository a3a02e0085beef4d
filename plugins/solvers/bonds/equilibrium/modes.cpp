#include "equilibrium/modes.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <limits>

namespace bonds {

namespace {

/// Repeated frequencies up to this often are sure to be found; a cube has fivefold ones.
constexpr std::size_t kStarts = 6;
/// Change of a Ritz vector by the operator beyond its subspace, relative to its eigenvalue; that of the
/// eigenvalue is its square.
constexpr double kSharp = 1e-9;
constexpr std::size_t kMostVectors = 600;
/// Part of the largest eigenvalue that the shift starts at: small against most first modes, large against
/// rounding.
constexpr double kShift = 1e-9;
/// An eigenvalue this small a part of the largest cannot be told from none.
constexpr double kNone = 64 * std::numeric_limits<double>::epsilon();

/// B = L^T (K - shift M)^-1 L with M = L L^T, on free degrees of freedom.
class Inverted
{
public:
   Inverted(const sdk::Call &call, const Balance &balance, const State &state, const Loading &loading);

   /// Lowers the shift until no eigenvalue lies below it; false when none is found.
   bool shiftBelowAll(const sdk::Call &call);
   /// False where an eigenvalue turns out to lie below the shift.
   bool apply(const sdk::Call &call, const Vector &y, Vector &out) const;
   Vector shapeOf(const Vector &y) const; // L^-T y
   double shift() const { return m_shift; }
   double largest() const { return m_largest; }
   const Vector &free() const { return m_free; }

private:
   bool factor(const sdk::Call &call);

   Vector m_free;
   std::vector<Block> m_mass, m_root, m_inverseRoot; // M, L^T, L^-T
   BlockMatrix m_stiffness, m_shifted;
   Places m_places;
   std::unique_ptr<Inverse> m_inverse;
   double m_largest = 0, m_shift = 0;
};

Inverted::Inverted(const sdk::Call &call, const Balance &balance, const State &state, const Loading &loading)
    : m_free(balance.supports().free()), m_mass(massBlocks(balance, state)), m_root(m_mass.size()),
      m_inverseRoot(m_mass.size()), m_stiffness(balance.pattern()), m_shifted(m_stiffness),
      m_places(placesOf(balance.assembly(), state)),
      m_inverse(makeInverse(m_stiffness, m_free, placesOf(balance.assembly(), State(state.n))))
{
   balance.stiffness(call, state, loading, 0, m_stiffness);
   for (std::size_t i = 0; i < m_mass.size(); ++i) {
      const Eigen::LLT<Block> llt(m_mass[i]);
      m_root[i] = llt.matrixU();
      m_inverseRoot[i] = m_root[i].inverse();
   }
   for (std::int64_t i = 0; i < state.n; ++i) {
      Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
      for (std::int64_t e = m_stiffness.begin(i); e < m_stiffness.end(i); ++e)
         sum += (m_inverseRoot[i].transpose() * m_stiffness[e] * m_inverseRoot[m_stiffness.column(e)])
                    .cwiseAbs()
                    .rowwise()
                    .sum();
      m_largest = std::max(m_largest, sum.maxCoeff());
   }
}

bool Inverted::factor(const sdk::Call &call)
{
   m_shifted = m_stiffness;
   for (std::int64_t i = 0; i < m_shifted.rows(); ++i)
      m_shifted[m_shifted.diagonal(i)] -= m_shift * m_mass[i];
   m_inverse->compute(call, m_shifted, m_places);
   return m_inverse->singular() < 0 && m_inverse->negative() <= 0;
}

bool Inverted::shiftBelowAll(const sdk::Call &call)
{
   m_shift = m_shift == 0 ? -kShift * m_largest : 10 * m_shift;
   while (!factor(call)) {
      if (!(-m_shift < m_largest) || call.cancelled())
         return false;
      m_shift *= 10;
   }
   return true;
}

bool Inverted::apply(const sdk::Call &call, const Vector &y, Vector &out) const
{
   Vector right(y.size());
   for (std::size_t i = 0; i < m_root.size(); ++i)
      right.segment<6>(6 * i).noalias() = m_root[i].transpose() * y.segment<6>(6 * i);
   right.array() *= m_free.array();
   bool below = false;
   if (m_inverse->exact())
      m_inverse->apply(call, right, out);
   else
      below = conjugateGradients(call, m_shifted, m_free, *m_inverse, right, 1e-12, 2000, out).indefinite;
   for (std::size_t i = 0; i < m_root.size(); ++i)
      out.segment<6>(6 * i) = (m_root[i] * out.segment<6>(6 * i)).eval();
   out.array() *= m_free.array();
   return !below;
}

Vector Inverted::shapeOf(const Vector &y) const
{
   Vector out(y.size());
   for (std::size_t i = 0; i < m_root.size(); ++i)
      out.segment<6>(6 * i).noalias() = m_inverseRoot[i] * y.segment<6>(6 * i);
   return out.cwiseProduct(m_free);
}

/// Orthonormal vectors, and the operator seen by them.
class Krylov
{
public:
   Krylov(const Inverted &inverted, std::size_t size) : m_inverted(&inverted), m_size(size) {}

   /// Takes the operator to one more vector; false where the shift is not below all eigenvalues.
   bool grow(const sdk::Call &call);
   bool full() const { return m_done >= m_size; }
   std::size_t done() const { return m_done; }
   /// Ritz values, descending, and their vectors in the subspace; returns how many of the first are sharp.
   std::size_t sharp(Eigen::VectorXd &values, Eigen::MatrixXd &vectors) const;
   Vector combine(const Eigen::VectorXd &part) const;

private:
   bool append(Vector w, double scale, Column *coefficients);
   void appendRandom();

   const Inverted *m_inverted;
   std::size_t m_size; // of the whole space
   std::vector<Vector> m_basis;
   std::vector<Column> m_column; // of the operator, for each vector that is done
   std::size_t m_done = 0;
   unsigned m_random = 1;
};

/// Makes w orthogonal to the basis, twice (once loses digits), and adds it unless nothing is left of it.
bool Krylov::append(Vector w, double scale, Column *coefficients)
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

void Krylov::appendRandom()
{
   Vector w(m_inverted->free().size());
   for (double &x : w) {
      m_random = m_random * 1664525 + 1013904223; // Numerical Recipes' generator: the same on all machines
      x = static_cast<double>(m_random >> 8) / (1 << 24) - 0.5;
   }
   w.array() *= m_inverted->free().array();
   const double scale = w.norm();
   append(std::move(w), scale, nullptr);
}

bool Krylov::grow(const sdk::Call &call)
{
   while (m_basis.size() < std::min(kStarts, m_size) || m_basis.size() == m_done)
      appendRandom();
   Vector w;
   if (!m_inverted->apply(call, m_basis[m_done], w))
      return false;
   Column coefficients;
   const double scale = w.norm();
   append(std::move(w), scale, &coefficients);
   m_column.push_back(std::move(coefficients));
   ++m_done;
   return true;
}

std::size_t Krylov::sharp(Eigen::VectorXd &values, Eigen::MatrixXd &vectors) const
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
                                kSharp * std::abs(values[static_cast<Eigen::Index>(count)]))
      ++count;
   return count;
}

Vector Krylov::combine(const Eigen::VectorXd &part) const
{
   Vector out = Vector::Zero(m_basis.front().size());
   for (Eigen::Index i = 0; i < part.size(); ++i)
      out += part[i] * m_basis[i];
   return out;
}

ModeShapes shapesOf(const Inverted &inverted, const Krylov &krylov, std::size_t wanted)
{
   ModeShapes out;
   Eigen::VectorXd values;
   Eigen::MatrixXd vectors;
   out.complete = krylov.sharp(values, vectors) >= wanted || krylov.full();
   for (Eigen::Index k = 0; k < std::min<Eigen::Index>(values.size(), static_cast<Eigen::Index>(wanted)); ++k)
   {
      const double value = 1 / values[k] + inverted.shift();
      out.eigenvalue.push_back(std::abs(value) < kNone * inverted.largest() ? 0 : value);
      Vector shape = inverted.shapeOf(krylov.combine(vectors.col(k)));
      Eigen::Index largest = 0;
      shape.cwiseAbs().maxCoeff(&largest);
      if (shape[largest] < 0) // a sign must be chosen
         shape = -shape;
      out.shape.push_back(std::move(shape));
   }
   return out;
}

} // namespace

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

ModeShapes lowestModes(const sdk::Call &call, const Balance &balance, const State &state,
                       const Loading &loading, std::int64_t wanted)
{
   Inverted inverted(call, balance, state, loading);
   const auto size = static_cast<std::size_t>(inverted.free().sum());
   const std::size_t modes = std::min(static_cast<std::size_t>(wanted), size);
   ModeShapes out;
   while (modes > 0 && inverted.shiftBelowAll(call)) {
      Krylov krylov(inverted, size);
      bool below = false;
      Eigen::VectorXd values;
      Eigen::MatrixXd vectors;
      while (!below && !call.cancelled() && !krylov.full() && krylov.done() < kMostVectors) {
         below = !krylov.grow(call);
         if (krylov.done() % kStarts == 0 && krylov.done() >= modes + kStarts &&
             krylov.sharp(values, vectors) >= modes + 1)
            break; // one more than asked for: none below has been overlooked
         call.progress(std::min(1.0, static_cast<double>(krylov.done()) / static_cast<double>(8 * modes)),
                       "seeking modes");
      }
      if (!below && krylov.done() > 0) {
         out = shapesOf(inverted, krylov, modes);
         break;
      }
   }
   out.complete = out.complete && out.eigenvalue.size() == modes;
   out.cancelled = call.cancelled();
   return out;
}

} // namespace bonds
