#include "implicit/inertia.h"

namespace bonds {

Eigen::Matrix3d inertiaOf(const Assembly &assembly, std::int64_t cell, Quat turn)
{
   Eigen::Matrix3d out;
   constexpr Vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
   for (int k = 0; k < 3; ++k) {
      const Vec3 column = spinMomentum(assembly, cell, turn, unit[k]);
      out.col(k) << column.x, column.y, column.z;
   }
   return out;
}

void inertiaForce(const Assembly &assembly, const State &state, std::int64_t cell, const double *rate,
                  double *out)
{
   const Quat turn = state.turnOf(cell);
   const Vec3 w = state.spinOf(cell);
   Vec3 torque = spinMomentum(assembly, cell, turn, {rate[3], rate[4], rate[5]});
   if (assembly.boxes)
      torque = torque + cross(w, spinMomentum(assembly, cell, turn, w));
   for (int k = 0; k < 3; ++k)
      out[k] = assembly.mass[cell] * rate[k];
   out[3] = torque.x;
   out[4] = torque.y;
   out[5] = torque.z;
}

void accelerate(const Assembly &assembly, const State &state, std::int64_t cell, const double *free,
                const double *force, double *rate)
{
   const double still[6]{};
   double spinning[6];
   inertiaForce(assembly, state, cell, still, spinning);
   for (int k = 0; k < 3; ++k)
      rate[k] = free[k] != 0 ? force[k] / assembly.mass[cell] : 0;
   Eigen::Matrix3d inertia = inertiaOf(assembly, cell, state.turnOf(cell));
   Eigen::Vector3d torque;
   for (int k = 0; k < 3; ++k) {
      torque[k] = force[3 + k] - spinning[3 + k];
      if (free[3 + k] != 0)
         continue;
      inertia.row(k).setZero();
      inertia.col(k).setZero();
      inertia(k, k) = 1;
      torque[k] = 0;
   }
   Eigen::Map<Eigen::Vector3d>(rate + 3) = inertia.inverse() * torque;
}

} // namespace bonds
