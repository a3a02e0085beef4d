// How a body can still move as a whole: the motions that no held freedom of its cells resists.
#include "scene/holding.h"
#include "scene/problems.h"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>

namespace diatom {

namespace {

/// Held directions are told from free ones by their share of the best held one's square; positions are scaled
/// to the extent of what is held, so that only rounding lies below.
constexpr double kNothing = 1e-9;

using Motions = Eigen::MatrixXd; // a column each

/// Orthonormal directions that a symmetric non-negative matrix takes to nothing.
Motions nullSpace(const Eigen::MatrixXd &matrix)
{
   const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
   const double most = std::max(solver.eigenvalues().maxCoeff(), 1.0);
   Eigen::Index free = 0;
   while (free < matrix.rows() && solver.eigenvalues()[free] < kNothing * most)
      ++free;
   return solver.eigenvectors().leftCols(free);
}

/// "x and z" for directions that axes span, else "(0.7, 0.7, 0)".
std::string directionsText(const Motions &directions)
{
   std::string axes, vectors;
   Eigen::Index found = 0;
   for (Eigen::Index axis = 0; axis < 3; ++axis)
      if (directions.row(axis).squaredNorm() > 1 - 1e-6) {
         axes += fmt::format("{}{}", found++ > 0 ? " and " : "", "xyz"[axis]);
      }
   if (found == directions.cols())
      return axes;
   for (Eigen::Index k = 0; k < directions.cols(); ++k)
      vectors += fmt::format("{}({:.2g}, {:.2g}, {:.2g})", k > 0 ? " and " : "", directions(0, k),
                             directions(1, k), directions(2, k));
   return vectors;
}

struct HeldCell
{
   Vec3 position;
   unsigned mask;
};

/// Sum over the held freedoms of the square of how fast a rigid motion (velocity, then spin times the extent)
/// moves them.
Eigen::Matrix<double, 6, 6> resistance(const std::vector<HeldCell> &held)
{
   Vec3 middle = Vec3::Zero();
   for (const HeldCell &cell : held)
      middle += cell.position / static_cast<double>(held.size());
   double extent = 0;
   for (const HeldCell &cell : held)
      extent = std::max(extent, (cell.position - middle).norm());
   Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
   for (const HeldCell &cell : held) {
      const Vec3 arm = extent > 0 ? Vec3((cell.position - middle) / extent) : Vec3::Zero();
      for (int k = 0; k < 6; ++k) {
         if ((cell.mask & (1U << static_cast<unsigned>(k))) == 0)
            continue;
         Eigen::Matrix<double, 6, 1> moved = Eigen::Matrix<double, 6, 1>::Zero();
         moved[k] = 1;
         if (k < 3)
            moved.tail<3>() = arm.cross(Vec3::Unit(k));
         sum += moved * moved.transpose();
      }
   }
   return sum;
}

struct FreeMotions
{
   bool moves = false; // along some direction, and not only turns
   std::string text;   // "move along x and turn about y and z", "" when it is held
};

FreeMotions freeMotions(const std::vector<HeldCell> &held)
{
   const auto sum = resistance(held);
   const Motions all = nullSpace(sum);
   if (all.cols() == 0)
      return {};
   if (all.cols() == 6)
      return {true, "move and turn freely"};
   const Motions slides = nullSpace(sum.topLeftCorner<3, 3>());
   FreeMotions free{slides.cols() > 0, slides.cols() > 0 ? "move along " + directionsText(slides) : ""};
   if (all.cols() > slides.cols()) {
      const Eigen::MatrixXd spins = all.bottomRows<3>();
      const Motions still = nullSpace(spins * spins.transpose());
      const Motions turns = nullSpace(still * still.transpose());
      free.text += (free.moves ? " and turn about " : "turn about ") + directionsText(turns);
   }
   return free;
}

Problem unheld(const std::vector<Index> &body, const FreeMotions &free)
{
   const char *then = free.moves ? "so that it has no static balance of its own"
                                 : "so that it has a static balance only where loads hold it upright, as "
                                   "weight does a pendulum";
   return {Problem::Severity::warning,
           free.moves ? "not-held" : "may-turn",
           fmt::format("the body of {} cells at {} can {} as a whole, {}: support more of it", body.size(),
                       indexText(body.front()), free.text, then),
           {body.front()}};
}

} // namespace

std::vector<Problem> findUnheldBodies(const Hierarchy &hierarchy, const Bodies &bodies, const Setup &setup,
                                      const Job &job)
{
   std::vector<Problem> problems;
   const bool falls = setup.gravity != std::array<double, 3>{};
   if (setup.ground.present ||
       (!falls && setup.supports.empty() && setup.drives.empty() && setup.loads.empty()))
      return problems;
   const Holding holding(hierarchy, setup);
   for (const auto &body : bodies) {
      std::vector<Index> cells;
      std::copy_if(body.begin(), body.end(), std::back_inserter(cells),
                   [&](Index cell) { return holding.freedoms(cell) != 0; });
      std::vector<double> positions(3 * cells.size());
      hierarchy.lattice().positions(cells, positions, job);
      std::vector<HeldCell> held;
      for (std::size_t i = 0; i < cells.size(); ++i)
         held.push_back({Eigen::Map<const Vec3>(positions.data() + 3 * i), holding.freedoms(cells[i])});
      const bool floats =
          std::none_of(held.begin(), held.end(), [](const HeldCell &cell) { return (cell.mask & 7U) != 0; });
      if (falls && floats)
         continue; // that it falls is told elsewhere
      if (const FreeMotions free = freeMotions(held); !free.text.empty())
         problems.push_back(unheld(body, free));
   }
   return problems;
}

Result<std::vector<Problem>> checkHeld(const Hierarchy &hierarchy, const Setup &setup, const Job &job)
{
   if (!findSetupProblems(hierarchy, setup).empty() || hierarchy.cells() == 0)
      return std::vector<Problem>();
   const auto bodies = findBodies(hierarchy, job);
   if (!bodies)
      return bodies.error();
   for (const Problem &problem : findFloatingBodies(hierarchy, *bodies, setup))
      return Error{ErrorCode::invalid, "there is no static balance: " + problem.text};
   std::vector<Problem> loose = findUnheldBodies(hierarchy, *bodies, setup, job);
   for (const Problem &problem : loose)
      if (problem.kind == "not-held")
         return Error{ErrorCode::invalid, "there is no static balance: " + problem.text};
   return loose;
}

} // namespace diatom
