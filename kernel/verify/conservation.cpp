// Form "conservation": free bodies that spin, against Euler's top.
#include "verify/forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace diatom {

namespace {

using nlohmann::json;

void spin(CaseScene &scene, Where where, const Vec3 &omega, const std::optional<Vec3> &about = {})
{
   Start start;
   start.where = std::move(where);
   start.spin = {omega.x(), omega.y(), omega.z()};
   if (about)
      start.about = {about->x(), about->y(), about->z()};
   scene.setup().starts.push_back(std::move(start));
}

struct Spin
{
   Vec3 body; // rad/s, in the cell's own axes
   Quat turn;
};

Result<Spin> spinOf(const Simulation &motion, std::int64_t cell, const Job &job)
{
   const auto velocity = motion.run().read("angular_velocity", cell, 1, job),
              turn = motion.run().read("rotation", cell, 1, job);
   if (!velocity || !turn)
      return velocity ? turn.error() : velocity.error();
   const Quat q(turn->at(0), turn->at(1), turn->at(2), turn->at(3));
   return Spin{q.conjugate() * Vec3(velocity->at(0), velocity->at(1), velocity->at(2)), q};
}

std::array<double, 4> fourOf(Quat turn, const json &wanted)
{
   if (turn.dot(turnOf(wanted)) < 0)
      turn.coeffs() = -turn.coeffs();
   return {turn.x(), turn.y(), turn.z(), turn.w()};
}

Status freeCube(const Case &one, const Bench &bench, Findings &findings)
{
   const json &cube = one.content.at("free_cube");
   CaseScene scene(1e-3);
   scene.cell(kOrigin, scene.add({}));
   spin(scene, kOrigin, vectorOf(cube.at("omega")));
   scene.setup().step = 1e-3;
   const auto motion = motionOf(bench, scene, {});
   if (!motion)
      return motion.error();
   if (Status moved = (*motion)->advance(cube.at("t"), *bench.job); !moved)
      return moved;
   const auto found = spinOf(**motion, 0, *bench.job);
   if (!found)
      return found.error();
   findings.compare("free_cube.quaternion_xyzw_from_identity",
                    fourOf(found->turn, cube.at("quaternion_xyzw_from_identity")),
                    Tolerance::absolute(one.content.at("tol").at("free_cube")));
   return {};
}

/// A single cell that is a box: the lattice is stretched along its axes.
Status freeBox(const Case &one, const json &box, const std::string &path, const Bench &bench,
               const std::string &integrator, const std::string &key, Findings &findings)
{
   const Vec3 edges = vectorOf(box.at("box_dimensions"));
   CaseScene scene(edges.x());
   scene.stretch({1, edges.y() / edges.x(), edges.z() / edges.x()});
   Material material;
   material.density = box.at("mass").get<double>() / edges.prod();
   scene.cell(kOrigin, scene.add(material));
   spin(scene, kOrigin, vectorOf(box.at("omega0_body")));
   // The case's bars are those of 1000 steps a period. Near the intermediate axis every error grows as the
   // body tumbles, and the bars want shorter steps than that.
   const double step = integrator == "rk4" ? 5e-4 : 1e-4;
   scene.setup().step = step;
   const auto motion = motionOf(bench, scene, {{"integrator", integrator}});
   if (!motion)
      return motion.error();
   const Tolerance tolerance =
       Tolerance::of(one.content.at("tol").at("free_box_rel_1000_steps_per_period").at(key),
                     vectorOf(box.at("omega0_body")).norm(), "of the spin");
   const std::string note = fmt::format("{}, steps of {:g} s", integrator, step);
   Tolerance turn = tolerance;
   turn.scale = 1;
   turn.words = "absolute";
   for (std::size_t i = 0; i < box.at("t").size(); ++i) {
      if (Status moved = (*motion)->advance(box.at("t")[i], *bench.job); !moved)
         return moved;
      const auto found = spinOf(**motion, 0, *bench.job);
      if (!found)
         return found.error();
      findings.compare(fmt::format("{}.omega_body.{}", path, i), {found->body.data(), 3}, tolerance,
                       integrator);
      findings.compare(fmt::format("{}.quaternion_xyzw.{}", path, i),
                       fourOf(found->turn, box.at("quaternion_xyzw").at(i)), turn, note);
   }
   return {};
}

/// Stiff cells that spin together: almost the rigid body, for some turns.
Status assemblyTop(const Case &one, const Bench &bench, Findings &findings)
{
   const json &top = one.content.at("assembly_top");
   CaseScene scene(top.at("lattice").at("pitch"));
   scene.boxes(top.at("cells"), scene.materialOf(top.at("materials").at("m")));
   const json &box = top.at("cells").at(0).at("box");
   const Vec3 middle = 0.5 * scene.pitch() * (vectorOf(box.at(0)) + vectorOf(box.at(1)));
   spin(scene, Box{indexOf(box.at(0)), indexOf(box.at(1))}, vectorOf(top.at("omega0")), middle);
   const auto motion = motionOf(bench, scene, {{"integrator", "verlet"}});
   if (!motion)
      return motion.error();
   const auto before = (*motion)->momentum(*bench.job);
   if (!before)
      return before.error();
   const double speed = vectorOf(top.at("omega0")).norm(),
                most = one.content.at("tol").at("assembly_one_period");
   double momentum = 0;
   for (std::size_t i = 0; i < top.at("t").size(); ++i) {
      const double time = top.at("t")[i];
      if (Status moved = (*motion)->advance(time, *bench.job); !moved)
         return moved;
      Vec3 omega = Vec3::Zero();
      Quat turn = Quat(0, 0, 0, 0);
      const std::int64_t cells = (*motion)->scene().cells();
      for (std::int64_t cell = 0; cell < cells; ++cell) {
         const auto found = spinOf(**motion, cell, *bench.job);
         if (!found)
            return found.error();
         omega += found->body / static_cast<double>(cells);
         const double sign = turn.dot(found->turn) < 0 ? -1 : 1;
         turn.coeffs() += sign * found->turn.coeffs();
      }
      turn.normalize();
      // The body is elastic: its deviation grows with the turns it has made.
      const double allowed = most * std::max(1.0, time / top.at("period").get<double>());
      findings.compare(fmt::format("assembly_top.omega_body_rigid.{}", i), {omega.data(), 3},
                       Tolerance::of(allowed, speed, "of the spin"), "mean of the cells");
      findings.compare(fmt::format("assembly_top.quaternion_rigid.{}", i),
                       fourOf(turn, top.at("quaternion_rigid").at(i)), Tolerance::absolute(allowed),
                       "mean of the cells");
      const auto now = (*motion)->momentum(*bench.job);
      if (!now)
         return now.error();
      momentum = std::max(momentum, (now->angular - before->angular).norm() / before->angular.norm());
   }
   findings.check("assembly_top: drift of the angular momentum over the run, of itself", momentum,
                  one.content.at("tol").at("momentum_rel_per_1e6_steps"));
   return {};
}

} // namespace

Status answerConservation(const Case &one, const Bench &bench, Findings &findings)
{
   if (const Status done = freeCube(one, bench, findings); !done)
      findings.fail("free_cube*", done.error().message);
   const json &boxes = one.content.at("free_box_cells");
   for (std::size_t b = 0; b < boxes.size(); ++b)
      for (const auto &[integrator, key] : {std::pair{"verlet", "order2+"}, std::pair{"rk4", "rk4"}}) {
         const std::string path = fmt::format("free_box_cells.{}", b);
         if (const Status done = freeBox(one, boxes[b], path, bench, integrator, key, findings); !done)
            findings.fail(path + "*", done.error().message);
      }
   if (const Status done = assemblyTop(one, bench, findings); !done)
      findings.fail("assembly_top*", done.error().message);
   return {};
}

} // namespace diatom
