#include "explicit/acting.h"

#include "model/contact.h"

namespace bonds {

namespace {

/// A host that does everything in place: what reads has no other.
sdk::Call inPlace()
{
   static const diatom_call call{sizeof(diatom_call),
                                 nullptr,
                                 [](const diatom_call *, std::int32_t, const char *) {},
                                 [](const diatom_call *) { return 0; },
                                 [](const diatom_call *, double, const char *) {},
                                 [](const diatom_call *, std::int64_t count, std::int64_t,
                                    void (*body)(void *, std::int64_t, std::int64_t), void *context) {
                                    body(context, 0, count);
                                    return DIATOM_OK;
                                 },
                                 nullptr,
                                 nullptr};
   return sdk::Call(&call);
}

void add(Column &to, std::int64_t cell, Vec3 force, Vec3 torque)
{
   double *at = to.data() + 6 * cell;
   const double all[6] = {force.x, force.y, force.z, torque.x, torque.y, torque.z};
   for (int k = 0; k < 6; ++k)
      at[k] += all[k];
}

BondForces bondForces(const Assembly &assembly, const State &state, const RestShape *rest, std::int64_t bond)
{
   const Ends ends = endsOf(assembly, state, bond);
   const Vec3 restD = rest ? rest->separation(bond) : Vec3{assembly.lengthOf(bond), 0, 0},
              restPhi = rest ? rest->turn(bond) : Vec3{};
   BondForces f;
   const BondConstants &k = assembly.constants[bond];
   if (assembly.law == Law::exact)
      evaluate<true, true, Law::exact>(ends, k, restD, restPhi, f);
   else if (assembly.law == Law::simple)
      evaluate<true, true, Law::simple>(ends, k, restD, restPhi, f);
   else
      evaluate<true, true, Law::small>(ends, k, restD, restPhi, f);
   return f;
}

} // namespace

Acting actingOn(const Assembly &assembly, const Couplings &couplings, const State &state,
                const RestShape *rest, const Column &loads)
{
   Acting out;
   out.internal.assign(static_cast<std::size_t>(6 * assembly.cells), 0);
   for (std::int64_t i = 0; i < assembly.links; ++i) {
      const BondForces f = bondForces(assembly, state, rest, i);
      const Mat3 frame = assembly.frameOf(i);
      const Vec3 force = transposed(frame, f.force);
      add(out.internal, assembly.a[i], force, transposed(frame, f.torqueA));
      add(out.internal, assembly.b[i], -force, transposed(frame, f.torqueB));
   }
   if (!couplings.empty()) {
      CellForces between;
      for (Column &column : between)
         column.assign(static_cast<std::size_t>(assembly.cells), 0);
      for (const auto &coupling : couplings)
         coupling->addForces(inPlace(), state, rest, between);
      for (std::int64_t i = 0; i < assembly.cells; ++i)
         add(out.internal, i, {between[0][i], between[1][i], between[2][i]},
             {between[3][i], between[4][i], between[5][i]});
   }
   out.all = out.internal;
   for (std::size_t i = 0; i < loads.size(); ++i)
      out.all[i] += loads[i];
   State touched = assembly.hasGround ? state : State(0); // contact slips as it is looked at
   for (std::int64_t i = 0; i < assembly.cells; ++i) {
      Vec3 force, torque;
      if (assembly.hasGravity)
         force = assembly.mass[i] * Vec3{assembly.gravity[0], assembly.gravity[1], assembly.gravity[2]};
      if (assembly.hasDrag) {
         force = force - (assembly.drag * assembly.mass[i]) * state.velocityOf(i);
         torque = -(assembly.drag * spinMomentum(assembly, i, state.turnOf(i), state.spinOf(i)));
      }
      Sums sums;
      if (assembly.hasGround)
         addContact(assembly.ground, touchOf(assembly, touched, i), 0, 0, force, torque, sums);
      add(out.all, i, force, torque);
   }
   return out;
}

Column reactions(const Assembly &assembly, const State &state, const Acting &acting)
{
   Column out(acting.all.size(), 0);
   for (std::int64_t i = 0; i < assembly.cells; ++i) {
      if (assembly.fixed[i] == 0)
         continue;
      Vec3 turning; // what keeps a box spinning evenly
      if (assembly.boxes && assembly.law != Law::small) {
         const Vec3 w = state.spinOf(i);
         turning = cross(w, spinMomentum(assembly, i, state.turnOf(i), w));
      }
      const double needed[6] = {0, 0, 0, turning.x, turning.y, turning.z};
      for (int k = 0; k < 6; ++k)
         if (assembly.fixed[i] >> k & 1)
            out[6 * i + k] = needed[k] - acting.all[6 * i + k];
   }
   return out;
}

void kickBy(const Assembly &assembly, const Acting &acting, double dt, State &state)
{
   for (std::int64_t i = 0; i < assembly.cells; ++i) {
      const double *f = acting.all.data() + 6 * i;
      kickCell(assembly, i, dt, {f[0], f[1], f[2]}, {f[3], f[4], f[5]}, state);
   }
}

} // namespace bonds
