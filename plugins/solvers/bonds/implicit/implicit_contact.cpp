#include "implicit/implicit_contact.h"

namespace bonds {

namespace {

/// How the contact point moves along the ground with the cell's displacement and turn.
Eigen::Matrix<double, 2, 6> slipBy(const Assembly &assembly, std::int64_t cell)
{
   const double h = assembly.halfHeight[cell];
   Eigen::Matrix<double, 2, 6> out;
   out << 1, 0, 0, 0, -h, 0, 0, 1, 0, h, 0, 0;
   return out;
}

} // namespace

ContactForce contactForce(const Assembly &assembly, const State &from, const State &to, std::int64_t cell,
                          const double *increment)
{
   ContactForce out;
   const Ground &ground = assembly.ground;
   const double depth = penetration(assembly, to, cell);
   if (!(depth > 0))
      return out;
   out.normal = std::max(0.0, ground.stiffness * depth - ground.damping * to.column(9)[cell]);
   if (!assembly.hasFriction)
      return out;
   const auto speed = slipVelocity(assembly, to, cell);
   const double h = assembly.halfHeight[cell];
   const double slip[2] = {increment[0] - h * increment[4], increment[1] + h * increment[3]};
   for (int j = 0; j < 2; ++j) {
      out.grip[j] = from.grip[j][cell] + slip[j];
      out.tried[j] = out.along[j] = -ground.stiffness * out.grip[j] - ground.damping * speed[j];
   }
   const double size = std::hypot(out.tried[0], out.tried[1]), most = ground.friction * out.normal;
   out.slips = size > most;
   for (int j = 0; j < 2 && out.slips; ++j) {
      out.along[j] *= most / size;
      out.grip[j] = -out.along[j] / ground.stiffness;
   }
   return out;
}

void addContactTangent(const Assembly &assembly, const ContactForce &force, std::int64_t cell, double speedBy,
                       Eigen::Map<Block> to)
{
   if (!(force.normal > 0))
      return;
   const Ground &ground = assembly.ground;
   const double stiff = ground.stiffness + speedBy * ground.damping;
   to(2, 2) += stiff;
   if (!assembly.hasFriction)
      return;
   const Eigen::Matrix<double, 2, 6> slip = slipBy(assembly, cell);
   if (!force.slips) {
      to += stiff * slip.transpose() * slip;
      return;
   }
   const Eigen::Vector2d tried(force.tried[0], force.tried[1]), way = tried.normalized();
   const double most = ground.friction * force.normal;
   to += stiff * most / tried.norm() * slip.transpose() *
         (Eigen::Matrix2d::Identity() - way * way.transpose()) * slip;
   to.col(2) += ground.friction * stiff * slip.transpose() * way;
}

} // namespace bonds
