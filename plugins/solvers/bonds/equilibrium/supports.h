// What holds the cells: degrees of freedom fixed, or driven along curves.
#pragma once

#include "equilibrium/block_matrix.h"
#include "model/state.h"

#include <span>

namespace bonds {

/// Linear between its points, constant outside.
struct Curve
{
   Column time, value;
   double at(double t) const;
};

/// A degree of freedom (x y z rx ry rz) that follows a curve: displacement since rest, or turn about the
/// world axis, built up of spins.
struct Driven
{
   std::int64_t cell = 0;
   int freedom = 0;
   std::int64_t curve = 0;
};

class Supports
{
public:
   Supports(const sdk::SceneView &scene, const Assembly &assembly);

   bool held(std::int64_t cell, int freedom) const { return m_free[6 * cell + freedom] == 0; }
   /// 1 where free, 0 where held.
   const Vector &free() const { return m_free; }
   const std::vector<Driven> &driven() const { return m_driven; }
   /// Where the curves have the driven degrees of freedom at a time.
   Column targets(double time) const;
   double valueOf(const Driven &driven, double time) const { return m_curves[driven.curve].at(time); }
   /// Largest magnitude on the way of a driven degree of freedom.
   double farthest(const Driven &driven) const;
   void setCurves(std::span<const diatom_channel> channels);

private:
   Vector m_free;
   std::vector<Driven> m_driven;
   std::vector<Curve> m_curves;
};

/// The channel "pose": displacement and turn that the cells start with.
void startPose(const sdk::SceneView &scene, State &state);

} // namespace bonds
