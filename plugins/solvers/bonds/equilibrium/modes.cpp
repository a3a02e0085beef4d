#include "equilibrium/modes.h"

#include "equilibrium/mass_scaled.h"

#include <limits>

namespace bonds {

namespace {

/// Of the inverse's and of the stiffness' vectors: the highest eigenvalues lie close together, and half this
/// is the most that their frequencies can be wrong by.
constexpr double kSharp = 1e-9, kSharpHighest = 1e-6;
constexpr std::size_t kMostVectors = 600;
/// Copies of an eigenvalue that are looked for; a cube has fivefold ones.
constexpr std::size_t kMostCopies = 6;
/// Vectors between two looks, at least.
constexpr std::size_t kLookEvery = 6;
/// Part of the largest eigenvalue that the shift starts at: small against most first modes, large against
/// rounding.
constexpr double kShift = 1e-9;
/// An eigenvalue this small a part of the largest cannot be told from none.
constexpr double kNone = 64 * std::numeric_limits<double>::epsilon();

/// B = L^T (K - shift M)^-1 L on free degrees of freedom.
class Inverted : public SymmetricOperator
{
public:
   Inverted(const sdk::Call &call, const Balance &balance, const State &state, const Loading &loading);

   /// Lowers the shift until no eigenvalue lies below it; false when none is found.
   bool shiftBelowAll(const sdk::Call &call);
   /// False where an eigenvalue turns out to lie below the shift.
   bool apply(const sdk::Call &call, const Vector &y, Vector &out) const override;
   Vector shapeOf(const Vector &y) const { return m_root.shapeOf(y).cwiseProduct(m_free); }
   double shift() const { return m_shift; }
   double largest() const { return m_largest; }
   const Vector &free() const override { return m_free; }

private:
   bool factor(const sdk::Call &call);

   Vector m_free;
   std::vector<Block> m_mass;
   MassRoot m_root;
   BlockMatrix m_stiffness, m_shifted;
   Places m_places;
   std::unique_ptr<Inverse> m_inverse;
   double m_largest = 0, m_shift = 0;
};

Inverted::Inverted(const sdk::Call &call, const Balance &balance, const State &state, const Loading &loading)
    : m_free(balance.supports().free()), m_mass(massBlocks(balance, state)), m_root(m_mass),
      m_stiffness(balance.pattern()), m_shifted(m_stiffness), m_places(placesOf(balance.assembly(), state)),
      m_inverse(makeInverse(m_stiffness, m_free, placesOf(balance.assembly(), State(state.n))))
{
   balance.stiffness(call, state, loading, 0, m_stiffness);
   for (std::int64_t i = 0; i < state.n; ++i) {
      Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
      for (std::int64_t e = m_stiffness.begin(i); e < m_stiffness.end(i); ++e)
         sum += (m_root.inverse[i].transpose() * m_stiffness[e] * m_root.inverse[m_stiffness.column(e)])
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
   for (std::size_t i = 0; i < m_root.root.size(); ++i)
      right.segment<6>(6 * i).noalias() = m_root.root[i].transpose() * y.segment<6>(6 * i);
   right.array() *= m_free.array();
   bool below = false;
   if (m_inverse->exact())
      m_inverse->apply(call, right, out);
   else
      below = conjugateGradients(call, m_shifted, m_free, *m_inverse, right, 1e-12, 2000, out).indefinite;
   for (std::size_t i = 0; i < m_root.root.size(); ++i)
      out.segment<6>(6 * i) = (m_root.root[i] * out.segment<6>(6 * i)).eval();
   out.array() *= m_free.array();
   return !below;
}

/// The first Ritz vectors as shapes; `eigenvalueOf` takes a Ritz value to what it stands for.
template<typename Operator, typename Eigenvalue>
ModeShapes shapesOf(const Operator &from, const RitzSpace &space, std::size_t wanted,
                    const Eigenvalue &eigenvalueOf)
{
   ModeShapes out;
   Eigen::VectorXd values;
   Eigen::MatrixXd vectors;
   out.complete = space.sharp(values, vectors) >= wanted || space.full();
   for (Eigen::Index k = 0; k < std::min<Eigen::Index>(values.size(), static_cast<Eigen::Index>(wanted)); ++k)
   {
      out.eigenvalue.push_back(eigenvalueOf(values[k]));
      Vector shape = from.shapeOf(space.combine(vectors.col(k)));
      Eigen::Index largest = 0;
      shape.cwiseAbs().maxCoeff(&largest);
      if (shape[largest] < 0) // a sign must be chosen
         shape = -shape;
      out.shape.push_back(std::move(shape));
   }
   return out;
}

/// More starts than modes are wanted find nothing that is, and the fewer there are the faster a space of so
/// many vectors converges.
std::size_t startsFor(std::size_t wanted) { return std::min(wanted + 1, kMostCopies); }

/// Grows the space until so many are sharp; false where the operator fails.
bool growUntilSharp(const sdk::Call &call, RitzSpace &space, std::size_t wanted)
{
   Eigen::VectorXd values;
   Eigen::MatrixXd vectors;
   std::size_t look = wanted + kLookEvery;
   while (!call.cancelled() && !space.full() && space.done() < kMostVectors) {
      if (!space.grow(call))
         return false;
      if (space.done() >= look) {
         if (space.sharp(values, vectors) >= wanted + 1)
            break; // one more than asked for: none before has been overlooked
         // A look costs the cube of what is there; looked at ever later, all of them cost little.
         look = space.done() + std::max(kLookEvery, space.done() / 8);
      }
      call.progress(std::min(1.0, static_cast<double>(space.done()) / static_cast<double>(8 * wanted)),
                    "seeking modes");
   }
   return true;
}

} // namespace

ModeShapes lowestModes(const sdk::Call &call, const Balance &balance, const State &state,
                       const Loading &loading, std::int64_t wanted)
{
   Inverted inverted(call, balance, state, loading);
   const auto size = static_cast<std::size_t>(inverted.free().sum());
   const std::size_t modes = std::min(static_cast<std::size_t>(wanted), size);
   ModeShapes out;
   while (modes > 0 && inverted.shiftBelowAll(call)) {
      RitzSpace space(inverted, size, startsFor(modes), kSharp);
      if (growUntilSharp(call, space, modes) && space.done() > 0) {
         out = shapesOf(inverted, space, modes, [&](double ritz) {
            const double value = 1 / ritz + inverted.shift();
            return std::abs(value) < kNone * inverted.largest() ? 0 : value;
         });
         break;
      }
   }
   out.complete = out.complete && out.eigenvalue.size() == modes;
   out.cancelled = call.cancelled();
   return out;
}

ModeShapes highestModes(const sdk::Call &call, const Balance &balance, const State &state,
                        const Loading &loading, std::int64_t wanted)
{
   BlockMatrix stiffness = balance.pattern();
   balance.stiffness(call, state, loading, 0, stiffness);
   const MassScaled direct(balance, state, std::move(stiffness));
   const auto size = static_cast<std::size_t>(direct.free().sum());
   const std::size_t modes = std::min(static_cast<std::size_t>(wanted), size);
   ModeShapes out;
   if (modes > 0) {
      RitzSpace space(direct, size, startsFor(modes), kSharpHighest);
      growUntilSharp(call, space, modes);
      out = shapesOf(direct, space, modes, [](double ritz) { return ritz; });
      std::reverse(out.eigenvalue.begin(), out.eigenvalue.end());
      std::reverse(out.shape.begin(), out.shape.end());
   }
   out.complete = out.complete && out.eigenvalue.size() == modes;
   out.cancelled = call.cancelled();
   return out;
}

} // namespace bonds
