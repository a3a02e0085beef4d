// Balances and vibrations of small scenes with couplings, solved directly.
#pragma once

#include "model/bond_tangent.h"
#include "model/energy.h"
#include "model/stable_step.h"
#include "plugins/solver_bonds_scene.h"
#include "solid/cell_coupling.h"
#include "solid/couplings.h"

#include <Eigen/Dense>
#include <Eigen/Sparse>

namespace diatom::test {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd; // six numbers for each cell: displacement, turn or force, moment

/// What the solver compiles a scene to.
class SolidModel
{
public:
   explicit SolidModel(HandScene &scene, int threads = 1, bonds::Options options = {})
       : host(threads), call(&host.call), view(&scene.view()), assembly(view, options),
         couplings(bonds::makeCouplings(view, assembly)), state(assembly.cells)
   {}
   SolidModel(const SolidModel &) = delete;
   SolidModel &operator=(const SolidModel &) = delete;

   bonds::BondEnds ends(const bonds::State &s, std::int64_t bond) const
   {
      const bonds::Ends all = endsOf(assembly, s, bond);
      const std::int64_t a = assembly.a[bond], b = assembly.b[bond];
      return {assembly.frameOf(bond) * (s.displacementOf(b) - s.displacementOf(a)),
              assembly.lengthOf(bond),
              all.qa,
              all.qb,
              all.dv,
              all.wa,
              all.wb};
   }
   /// Of couplings alone.
   Vector couplingForces(const bonds::State &s, const bonds::RestShape *rest = nullptr,
                         double *power = nullptr) const
   {
      bonds::CellForces forces;
      for (auto &column : forces)
         column.assign(static_cast<std::size_t>(assembly.cells), 0);
      double sum = 0;
      for (const auto &coupling : couplings)
         sum += coupling->addForces(call, s, rest, forces);
      if (power)
         *power = sum;
      Vector out(6 * assembly.cells);
      for (Eigen::Index i = 0; i < out.size(); ++i)
         out[i] = forces[static_cast<std::size_t>(i % 6)][static_cast<std::size_t>(i / 6)];
      return out;
   }
   Vector forces(const bonds::State &s) const
   {
      Vector out = couplingForces(s);
      for (std::int64_t i = 0; i < assembly.links; ++i) {
         const auto f = endForces(bonds::bondPoint<false>(ends(s, i), assembly.constants[i], {}, {}));
         add(out, assembly.a[i], world(i, f.force), world(i, f.torqueA));
         add(out, assembly.b[i], -world(i, f.force), world(i, f.torqueB));
      }
      return out;
   }
   double couplingEnergy(const bonds::State &s) const
   {
      double sum = 0;
      for (const auto &coupling : couplings)
         sum += coupling->energy(s, nullptr);
      return sum;
   }
   Eigen::SparseMatrix<double> couplingStiffness(const bonds::State &s) const
   {
      std::vector<Eigen::Triplet<double>> entries;
      addCouplings(s, entries);
      return matrixOf(entries);
   }
   Eigen::SparseMatrix<double> stiffness(const bonds::State &s) const
   {
      std::vector<Eigen::Triplet<double>> entries;
      addCouplings(s, entries);
      for (std::int64_t i = 0; i < assembly.links; ++i)
         addBond(s, i, entries);
      return matrixOf(entries);
   }
   Vector masses() const
   {
      Vector out(6 * assembly.cells);
      for (Eigen::Index i = 0; i < out.size(); ++i) {
         const auto cell = static_cast<std::size_t>(i / 6);
         out[i] = i % 6 < 3 ? assembly.mass[cell] : assembly.inertia[cell];
      }
      return out;
   }
   /// Squared frequencies of the free scene about `s`, ascending.
   Vector eigenvalues(const bonds::State &s) const
   {
      const Vector scale = masses().cwiseSqrt().cwiseInverse();
      const Matrix k = scale.asDiagonal() * Matrix(stiffness(s)) * scale.asDiagonal();
      return Eigen::SelfAdjointEigenSolver<Matrix>(0.5 * (k + k.transpose()), Eigen::EigenvaluesOnly)
          .eigenvalues();
   }
   /// Newton's method from rest; degrees of freedom with `held` stay. Returns the largest unbalanced force of
   /// a free one over the largest load.
   double balance(const Vector &load, const std::vector<bool> &held, int iterations)
   {
      double residual = 0;
      for (int n = 0; n < iterations; ++n) {
         Vector rest = load + forces(state);
         Eigen::SparseMatrix<double> k = stiffness(state);
         hold(held, k, rest);
         Eigen::SparseLU<Eigen::SparseMatrix<double>> factors(k);
         move(state, factors.solve(rest));
         Vector left = load + forces(state);
         for (Eigen::Index i = 0; i < left.size(); ++i)
            left[i] = held[static_cast<std::size_t>(i)] ? 0 : left[i];
         residual = left.cwiseAbs().maxCoeff() / load.cwiseAbs().maxCoeff();
      }
      return residual;
   }
   /// Displaces and turns every cell.
   static void move(bonds::State &s, const Vector &by)
   {
      for (std::int64_t i = 0; i < s.n; ++i) {
         for (int k = 0; k < 3; ++k)
            s.displacement(k)[i] += by[6 * i + k];
         s.setTurn(i, bonds::exponential({by[6 * i + 3], by[6 * i + 4], by[6 * i + 5]}) * s.turnOf(i));
      }
   }
   static void setRates(bonds::State &s, const Vector &rates)
   {
      for (std::int64_t i = 0; i < s.n; ++i)
         for (int k = 0; k < 6; ++k)
            s.column(7 + k)[i] = rates[6 * i + k];
   }

   /// Leaves of `k` and `rest` what the degrees of freedom with `held` do not take.
   static void hold(const std::vector<bool> &held, Eigen::SparseMatrix<double> &k, Vector &rest)
   {
      k.prune([&](Eigen::Index row, Eigen::Index column, double) {
         return row == column ||
                (!held[static_cast<std::size_t>(row)] && !held[static_cast<std::size_t>(column)]);
      });
      for (Eigen::Index i = 0; i < rest.size(); ++i)
         rest[i] = held[static_cast<std::size_t>(i)] ? 0 : rest[i];
   }

   Host host;
   bonds::sdk::Call call;
   bonds::sdk::SceneView view;
   bonds::Assembly assembly;
   bonds::Couplings couplings;
   bonds::State state;

private:
   bonds::Vec3 world(std::int64_t bond, bonds::Vec3 v) const { return transposed(assembly.frameOf(bond), v); }
   static void add(Vector &out, std::int64_t cell, bonds::Vec3 force, bonds::Vec3 moment)
   {
      const double all[6] = {force.x, force.y, force.z, moment.x, moment.y, moment.z};
      for (int k = 0; k < 6; ++k)
         out[6 * cell + k] += all[k];
   }
   Eigen::SparseMatrix<double> matrixOf(const std::vector<Eigen::Triplet<double>> &entries) const
   {
      Eigen::SparseMatrix<double> out(6 * assembly.cells, 6 * assembly.cells);
      out.setFromTriplets(entries.begin(), entries.end());
      return out;
   }
   void addCouplings(const bonds::State &s, std::vector<Eigen::Triplet<double>> &entries) const
   {
      for (const auto &coupling : couplings)
         coupling->addStiffness(s, nullptr, [&](std::int64_t row, std::int64_t column, const double *block) {
            for (int k = 0; k < 36; ++k)
               entries.emplace_back(6 * row + k / 6, 6 * column + k % 6, block[k]);
         });
   }
   void addBond(const bonds::State &s, std::int64_t bond, std::vector<Eigen::Triplet<double>> &entries) const
   {
      const auto point = bonds::bondPoint<false>(ends(s, bond), assembly.constants[bond], {}, {});
      const bonds::Mat3 frame = assembly.frameOf(bond);
      const std::int64_t cell[2] = {assembly.a[bond], assembly.b[bond]};
      for (int column = 0; column < 12; ++column) {
         Vector unit = Vector::Zero(12);
         unit[column] = 1;
         const auto local = [&](int at) {
            return transposed(point.middle, frame * bonds::Vec3{unit[at], unit[at + 1], unit[at + 2]});
         };
         const auto change =
             forceChange(point, assembly.constants[bond], local(6) - local(0), local(3), local(9));
         const auto back = [&](bonds::Vec3 v) { return world(bond, point.middle * v); };
         const bonds::Vec3 all[4] = {back(change.force), back(change.torqueA), -back(change.force),
                                     back(change.torqueB)};
         for (int row = 0; row < 12; ++row) {
            const bonds::Vec3 v = all[row / 3];
            entries.emplace_back(6 * cell[row / 6] + row % 6, 6 * cell[column / 6] + column % 6,
                                 -(row % 3 == 0   ? v.x
                                   : row % 3 == 1 ? v.y
                                                  : v.z));
         }
      }
   }
};

/// Rubber, unless told otherwise.
inline std::map<std::string, double> solidMaterial(double poissonRatio, double youngsModulus = 5e6,
                                                   double dampingRatio = 0, double model = 2)
{
   return {{"density", 1100},
           {"youngs_modulus", youngsModulus},
           {"poisson_ratio", poissonRatio},
           {"damping_ratio", dampingRatio},
           {"cell_model", model}};
}

} // namespace diatom::test
