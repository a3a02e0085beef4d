#include "equilibrium/rigid_motion.h"

#include <Eigen/Eigenvalues>

#include <string>

namespace bonds {

using sdk::Failure;

namespace {

/// Resistances are sums of squares of order 1, in arms of the part's own size: below lies rounding.
constexpr double kNothing = 1e-9;

using Motion = Eigen::Matrix<double, 6, 1>; // velocity of the middle, spin times the part's size

/// Number of the part of joined cells that each cell belongs to.
std::vector<std::int32_t> partsOf(const BlockMatrix &pattern, std::int32_t &count)
{
   std::vector<std::int32_t> part(static_cast<std::size_t>(pattern.rows()), -1), stack;
   count = 0;
   for (std::int32_t first = 0; first < pattern.rows(); ++first) {
      if (part[first] >= 0)
         continue;
      part[first] = count;
      stack.assign(1, first);
      while (!stack.empty()) {
         const std::int32_t i = stack.back();
         stack.pop_back();
         for (std::int64_t e = pattern.begin(i); e < pattern.end(i); ++e)
            if (part[pattern.column(e)] < 0) {
               part[pattern.column(e)] = count;
               stack.push_back(pattern.column(e));
            }
      }
      ++count;
   }
   return part;
}

struct Part
{
   Eigen::Vector3d middle = Eigen::Vector3d::Zero();
   double cells = 0, size = 0;
   std::int64_t first = -1;
   Block resistance = Block::Zero();
};

/// How fast the motion of a part moves one degree of freedom of a cell.
Motion rateOf(int freedom, const Eigen::Vector3d &arm, double size)
{
   Motion rate = Motion::Zero();
   if (freedom >= 3) {
      rate[freedom] = 1;
      return rate;
   }
   const Eigen::Vector3d along = Eigen::Vector3d::Unit(freedom);
   rate.head<3>() = along;
   rate.tail<3>() = arm.cross(along) / size;
   return rate;
}

std::vector<Part> resistances(const Balance &balance, const State &state,
                              const std::vector<std::int32_t> &partOf, std::int32_t count)
{
   const Assembly &assembly = balance.assembly();
   std::vector<Part> parts(static_cast<std::size_t>(count));
   const auto at = [&](std::int64_t i) {
      const Vec3 u = state.displacementOf(i);
      return Eigen::Vector3d(assembly.rest[0][i] + u.x, assembly.rest[1][i] + u.y, assembly.rest[2][i] + u.z);
   };
   for (std::int64_t i = 0; i < assembly.cells; ++i) {
      Part &part = parts[partOf[i]];
      part.middle += at(i);
      part.cells += 1;
      if (part.first < 0)
         part.first = i;
   }
   for (Part &part : parts)
      part.middle /= part.cells;
   for (std::int64_t i = 0; i < assembly.cells; ++i) {
      Part &part = parts[partOf[i]];
      part.size = std::max({part.size, (at(i) - part.middle).norm(), balance.pitch()});
   }
   for (std::int64_t i = 0; i < assembly.cells; ++i) {
      Part &part = parts[partOf[i]];
      for (int k = 0; k < 6; ++k)
         if (balance.supports().held(i, k) || (k == 2 && balance.stands(state, i))) {
            const Motion rate = rateOf(k, at(i) - part.middle, part.size);
            part.resistance += rate * rate.transpose();
         }
   }
   return parts;
}

} // namespace

std::string freedomText(int freedom)
{
   const std::string axis(1, "xyz"[freedom % 3]);
   return (freedom < 3 ? "move along " : "turn about ") + axis;
}

LooseMotion findLoose(const Balance &balance, const State &state)
{
   std::int32_t count = 0;
   const std::vector<std::int32_t> partOf = partsOf(balance.pattern(), count);
   for (const Part &part : resistances(balance, state, partOf, count)) {
      const Eigen::SelfAdjointEigenSolver<Block> solver(part.resistance);
      if (solver.eigenvalues()[0] > kNothing)
         continue;
      // Of all motions in the free space the one nearest to an axis, x y z before turns.
      Eigen::Index free = 1;
      while (free < 6 && solver.eigenvalues()[free] <= kNothing)
         ++free;
      const Motion share = solver.eigenvectors().leftCols(free).rowwise().squaredNorm();
      int best = 0;
      for (int k = 1; k < 6; ++k)
         if (share[k] > share[best] + 1e-6)
            best = k;
      return {part.first, best};
   }
   return {};
}

void refuseLoose(const Balance &balance, const State &state)
{
   const LooseMotion loose = findLoose(balance, state);
   if (loose.cell >= 0)
      throw Failure(DIATOM_BAD_INPUT,
                    "the part that the cell " + balance.name(loose.cell) + " belongs to is free to " +
                        freedomText(loose.freedom) + ": fix or drive this motion of one of its cells" +
                        (balance.assembly().hasGround ? ", or set the part on the ground" : ""));
}

} // namespace bonds
