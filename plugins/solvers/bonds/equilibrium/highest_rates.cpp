#include "equilibrium/highest_rates.h"

#include "equilibrium/mass_scaled.h"

namespace bonds {

namespace {

/// Of the eigenvalue, that an eigenvector may be out by, and what its eigenvalue is raised by.
constexpr double kSharpness = 1e-4, kMargin = 1e-4;
/// Two of them find an eigenvalue that is there twice.
constexpr std::size_t kStarts = 2;
constexpr std::size_t kLookEvery = 8, kMostVectors = 400;

/// Springs k under a cell as the ground pushes and, where it rubs, drags its lowest point: along
/// u + turn x (0, 0, -h).
void addGround(const Assembly &assembly, std::int64_t cell, double k, bool pushes, Eigen::Map<Block> own)
{
   using Row = Eigen::Matrix<double, 6, 1>;
   const double h = assembly.halfHeight[cell];
   if (pushes)
      own(2, 2) += k;
   if (!assembly.hasFriction)
      return;
   const Row along = (Row() << 1, 0, 0, 0, -h, 0).finished(), across = (Row() << 0, 1, 0, h, 0, 0).finished();
   own += k * (along * along.transpose() + across * across.transpose());
}

/// Raised by what it may lack; nothing when cancelled.
std::optional<double> highest(const sdk::Call &call, const MassScaled &matrix, const char *what)
{
   const auto size = static_cast<std::size_t>(matrix.free().sum());
   if (size == 0)
      return 0;
   RitzSpace space(matrix, size, kStarts, kSharpness);
   Eigen::VectorXd values;
   Eigen::MatrixXd vectors;
   while (!space.full() && space.done() < kMostVectors) {
      if (call.cancelled())
         return {};
      space.grow(call);
      if (space.done() % kLookEvery != 0)
         continue;
      if (space.sharp(values, vectors) > 0)
         break;
      call.progress(static_cast<double>(space.done()) / kMostVectors, what);
   }
   if (space.sharp(values, vectors) == 0 && !space.full())
      throw sdk::Failure(DIATOM_LIMIT, "the highest eigenvalue was not found; use the stable step's bound");
   return std::max(0.0, values[0]) * (1 + kMargin);
}

} // namespace

std::optional<HighestRates> highestRates(const sdk::Call &call, const Balance &balance)
{
   const Assembly &assembly = balance.assembly();
   const State rest(assembly.cells);
   const Loading unloaded = balance.unloaded(rest);
   BlockMatrix stiffness = balance.pattern();
   balance.stiffness(call, rest, unloaded, 0, stiffness);
   std::optional<BlockMatrix> damping;
   if (assembly.damped || (assembly.hasGround && assembly.ground.damping > 0)) {
      damping.emplace(stiffness);
      balance.stiffness(call, rest, unloaded, assembly.damped ? 1 : 0, *damping);
      damping->subtract(stiffness);
   }
   for (std::int64_t i = 0; assembly.hasGround && i < assembly.cells; ++i) {
      addGround(assembly, i, assembly.ground.stiffness, !balance.stands(rest, i),
                stiffness[stiffness.diagonal(i)]);
      if (damping)
         addGround(assembly, i, assembly.ground.damping, true, (*damping)[damping->diagonal(i)]);
   }
   HighestRates out;
   const auto fastest =
       highest(call, MassScaled(balance, rest, std::move(stiffness)), "seeking the fastest vibration");
   if (!fastest)
      return {};
   out.stiffness = *fastest;
   if (!damping)
      return out;
   const auto strongest =
       highest(call, MassScaled(balance, rest, *std::move(damping)), "seeking the strongest damping");
   if (!strongest)
      return {};
   out.damping = *strongest;
   return out;
}

} // namespace bonds
