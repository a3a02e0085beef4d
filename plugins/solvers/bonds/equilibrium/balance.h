// Forces of a scene and how they change with its shape: what statics, modes and implicit steps share.
#pragma once

#include "equilibrium/supports.h"
#include "model/actuation.h"
#include "model/coupling.h"

namespace bonds {

/// What pulls and pushes at one moment.
struct Loading
{
   Vec3 gravity;
   Column force; // 6 a cell; empty without loads
   RestShape rest;
   Column driven; // value of each driven degree of freedom
};

/// a + f (b - a)
Loading blend(const Loading &a, const Loading &b, double f);

/// How far from balance.
struct Measure
{
   double unbalanced = 0, atWork = 0; // N; moments count over the pitch
   double rounding = 0;               // N: what the last digits of the displacements are worth
   std::int64_t cell = -1;            // the worst
   bool within(double tolerance) const { return unbalanced <= std::max(tolerance * atWork, rounding); }
   double relative() const { return atWork > 0 ? unbalanced / atWork : 0; }
};

class Balance
{
public:
   Balance(const sdk::SceneView &scene, const Options &options);
   Balance(const Balance &) = delete;
   Balance &operator=(const Balance &) = delete;

   const Assembly &assembly() const { return m_assembly; }
   const Supports &supports() const { return m_supports; }
   const Couplings &couplings() const { return m_couplings; }
   double pitch() const { return m_pitch; }
   /// "(x, y, z)", for messages.
   std::string name(std::int64_t cell) const;

   /// Loads, signals and curves as they are at a time.
   Loading loadingAt(double time) const;
   /// The scene before anything pulls at it, with the driven degrees of freedom where `state` has them.
   Loading unloaded(const State &state) const;
   /// New loads, curves or signals; throws Failure(DIATOM_UNSUPPORTED) for what needs a new run.
   void apply(std::span<const diatom_channel> channels);
   const Actuation &actuation() const { return m_actuation; }

   /// Force and moment of bonds and couplings on every cell; `rates` counts damping. Returns the power that
   /// damping takes (W); `measure` gets the largest of the single forces and their rounding. One thread at a
   /// time: it works in the object's own room.
   double internal(const sdk::Call &call, const State &state, const Loading &loading, bool rates, Vector &out,
                   Measure &measure) const;
   /// Gravity, loads and ground.
   void external(const State &state, const Loading &loading, Vector &out, Measure &measure) const;
   /// The largest unbalanced force of free degrees of freedom.
   void weigh(const Vector &residual, Measure &measure) const;

   /// Whether a cell touches the ground: one that lies on it unloaded counts.
   bool stands(const State &state, std::int64_t cell) const;

   BlockMatrix pattern() const;
   /// Exact derivative of the negative forces by displacement and spin. `dampingOverTime` (1/s) times the
   /// damping is added to the stiffness: implicit steps need both at once.
   void stiffness(const sdk::Call &call, const State &state, const Loading &loading, double dampingOverTime,
                  BlockMatrix &out) const;

   // J
   double elasticEnergy(const State &state, const RestShape &rest) const;
   double contactEnergy(const State &state) const;
   double gravityEnergy(const State &state) const;

private:
   void setLoads(const sdk::Channel &loads);
   std::int64_t bondsEnd(std::int64_t cell) const { return m_assembly.first[cell + 1]; }
   /// What a bond does to its cells, in world axes.
   struct BondLoad
   {
      Vec3 force; // on a; b gets the opposite
      Vec3 torqueA, torqueB;
   };
   double bondLoad(std::int64_t bond, const State &state, const RestShape &rest, bool rates, BondLoad &out,
                   Measure &measure) const;
   void cellStiffness(std::int64_t cell, const State &state, const RestShape &rest, double dampingOverTime,
                      BlockMatrix &out) const;

   Assembly m_assembly;
   double m_pitch;
   std::vector<std::array<std::int32_t, 3>> m_index;
   Actuation m_actuation;
   Supports m_supports;
   Couplings m_couplings;
   Column m_force;
   mutable std::vector<BondLoad> m_bondLoads; // room for internal()
};

/// Moves by `factor` times the displacements and spins in `change`.
void advance(const State &from, const Vector &change, double factor, State &to);

} // namespace bonds
