// Designs built in memory from what cases say, and the solver's answers about them.
#pragma once

#include "core/job.h"
#include "core/vec.h"
#include "document/design.h"
#include "scene/balance.h"
#include "scene/modes.h"
#include "scene/simulation.h"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

/// What every run of a case needs.
struct Bench
{
   std::shared_ptr<const Catalogue> catalogue;
   const Job *job = nullptr;
};

/// Solver values of the models that cases name: a, b and c are the three beam theories with the mean of
/// unlike cells' constants, b_exact joins two half beams.
Values modelValues(std::string_view model);
inline constexpr const char *kModels[] = {"a", "b", "c"};
/// Of the cell that most cases hold, or are about.
inline constexpr Index kOrigin{0, 0, 0};

/// A design of cubes that cases fill, and hold, drive and load.
class CaseScene
{
public:
   explicit CaseScene(double pitch);

   /// A material of given constants: an object of "axial", "shear", "bending" and "torsion"; `mass` of a
   /// cell.
   MaterialIndex material(const nlohmann::json &constants, double mass = 0);
   /// As the cases' materials say it: "k", and "mass" where that matters.
   MaterialIndex materialOf(const nlohmann::json &material);
   MaterialIndex add(Material material);
   void change(MaterialIndex material, const std::function<void(Material &)> &how);
   void cell(Index at, MaterialIndex material, std::uint8_t orientation = 0);
   void box(const Index &low, const Index &high, MaterialIndex material);
   /// Boxes of cells: [{"box": [[x, y, z], [x, y, z]]}, ...].
   void boxes(const nlohmann::json &cells, MaterialIndex material);

   void hold(Index at, std::uint8_t freedoms = kAllFreedoms);
   /// Moves a freedom evenly, from nothing at 0 s to `value` at 1 s.
   void drive(Index at, int freedom, double value);
   /// Puts a cell where it is wanted, turned as wanted since rest.
   void place(Index at, const Vec3 &displacement, const Quat &turn);
   void load(Index at, const Vec3 &force, const Vec3 &moment = Vec3::Zero());

   /// Scales places and cells along x, y and z.
   void stretch(const std::array<double, 3> &aspect) { m_design.model.lattice.aspect = aspect; }
   double pitch() const { return m_design.model.lattice.pitch; }
   const Model &model() const { return m_design.model; }
   Setup &setup() { return m_design.setup; }
   const Setup &setup() const { return m_design.setup; }

private:
   Design m_design;
};

/// A run and how to read it cell by cell.
class Answer
{
public:
   Answer(std::unique_ptr<SolverRun> run, Setup setup, const Job &job);

   /// Errors: there is no such cell, or the solver does not tell.
   Status read();
   Vec3 place(Index at) const { return three(m_position, at, 3); }
   Vec3 displacement(Index at) const { return place(at) - rest(at); }
   Vec3 rest(Index at) const;
   Quat turn(Index at) const; // since rest
   /// Force and moment about its own centre that the bonds of a cell exert on it.
   Wrench internal(Index at) const { return wrench(m_internal, at); }
   /// The same that what holds or drives it supplies.
   Wrench reaction(Index at) const { return wrench(m_reaction, at); }
   double elasticEnergy() const { return m_energy.size() == 6 ? m_energy[1] : 0; }
   SolverRun &run() { return *m_run; }
   std::int64_t number(Index at) const { return m_run->scene().cellAt(at); }

private:
   Vec3 three(const std::vector<double> &rows, Index at, std::size_t stride, std::size_t from = 0) const;
   Wrench wrench(const std::vector<double> &rows, Index at) const;

   std::unique_ptr<SolverRun> m_run;
   Setup m_setup;
   const Job *m_job;
   std::vector<double> m_position, m_rotation, m_internal, m_reaction, m_energy;
};

/// The balance at 1 s, where drives have arrived. `tolerance` as in BalanceRequest.
Result<Answer> balanceOf(const Bench &bench, const CaseScene &scene, const Values &values,
                         double tolerance = 1e-12);
/// All eigenvalues (rad2/s2) that the values ask for, ascending, about the balance at 1 s.
Result<Modes> modesOf(const Bench &bench, const CaseScene &scene, const Values &values);

/// Motion from what the scene's set-up says.
Result<std::unique_ptr<Simulation>> motionOf(const Bench &bench, const CaseScene &scene,
                                             const Values &values);
/// Since rest, read without the digits that a place would cost.
Result<Vec3> displacementOf(const Simulation &motion, Index at, const Job &job);

Index indexOf(const nlohmann::json &three);
Vec3 vectorOf(const nlohmann::json &three);
/// From [x, y, z, w].
Quat turnOf(const nlohmann::json &four);
Vec3 rotationVector(const Quat &turn);
Quat turnBy(const Vec3 &rotationVector);

} // namespace diatom
