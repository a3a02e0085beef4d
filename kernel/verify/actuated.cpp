// Forms "bend-45deg" and "actuated-shapes": chains whose bonds want to be turned against each other.
#include "verify/actuated_scene.h"
#include "verify/forms.h"

#include <fmt/format.h>

#include <cmath>

namespace diatom {

namespace {

using nlohmann::json;

/// A chain of an even number of bonds, each with a rest turn about z, clamped at its first cell.
CaseScene bentChain(double pitch, const json &constants, int bonds, double turn)
{
   CaseScene scene(pitch);
   ActuatedRow row(scene, constants);
   row.drive(Actuation::Mode::bending, turn);
   row.fill(kOrigin, bonds + 1);
   scene.hold(kOrigin);
   return scene;
}

/// Cubes without sideways contraction, for cases in which any constants do.
json anyConstants(double pitch)
{
   const double e = 1e6, k = e * pitch, g = 0.5 * 5 / 6 * e * pitch, b = e * pitch * pitch * pitch / 12;
   return {{"axial", {k, k, k}},
           {"shear", {{"xy", g}, {"xz", g}, {"yx", g}, {"yz", g}, {"zx", g}, {"zy", g}}},
           {"bending", {b, b, b}},
           {"torsion", {b, b, b}}};
}

} // namespace

Status answerBend45(const Case &one, const Bench &bench, Findings &findings)
{
   const json &content = one.content, &tol = content.at("tol");
   const double pitch = content.at("lattice").at("pitch"), turn = content.at("rest_rotation_per_bond").at(2);
   const int n = content.at("arc").at("N");
   const json &k = content.at("materials").at("m").at("k");
   const Index tip{n, 0, 0};
   const double discrete = tol.at("discrete_mid_rel");
   const auto length = [](const json &place) { return vectorOf(place).norm(); };
   findings.skip("*continuum_residual", "how far the reference itself was solved");
   for (const std::string model : kModels) {
      const auto unloaded = balanceOf(bench, bentChain(pitch, k, n, turn), modelValues(model));
      if (!unloaded) {
         findings.fail("unloaded_tip*", unloaded.error().message);
         break;
      }
      const Vec3 place = unloaded->place(tip);
      const json &arc = content.at("unloaded_tip");
      findings.compare("unloaded_tip.discrete", {place.data(), 3}, Tolerance::relative(discrete),
                       "model " + model);
      findings.compare(
          "unloaded_tip.continuum", {place.data(), 3},
          Tolerance::of(tol.at("continuum_rel_b"), length(arc.at("continuum")), "of its distance"),
          "model " + model);
   }
   for (std::size_t s = 0; s < content.at("scenarios").size(); ++s) {
      const json &scenario = content.at("scenarios")[s], &expected = scenario.at("expected");
      const std::string path = fmt::format("scenarios.{}.expected.", s);
      for (const std::string model : kModels) {
         CaseScene scene = bentChain(pitch, k, n, turn);
         const Index loaded = indexOf(scenario.at("load").at("cell"));
         scene.load(loaded, vectorOf(scenario.at("load").at("force")));
         const auto answer = balanceOf(bench, scene, modelValues(model));
         if (!answer) {
            findings.fail(path + "*", answer.error().message);
            continue;
         }
         const Vec3 place = answer->place(loaded);
         findings.compare(path + "discrete_mid_theta_minus_theta0." + model, {place.data(), 3},
                          Tolerance::relative(discrete));
         if (model != "b")
            continue;
         const auto continuum = [&](const char *key) {
            return Tolerance::of(tol.at("continuum_rel_b"), length(expected.at(key)), "of its length");
         };
         findings.compare(path + "continuum_tip", {place.data(), 3}, continuum("continuum_tip"), "model b");
         const Vec3 moment = answer->reaction(kOrigin).moment;
         findings.compare(path + "continuum_root_torque", {moment.data(), 3},
                          continuum("continuum_root_torque"), "model b");
      }
   }
   return {};
}

Status answerActuatedShapes(const Case &one, const Bench &bench, Findings &findings)
{
   const json &content = one.content, &tol = content.at("tol");
   for (std::size_t r = 0; r < content.at("ring").size(); ++r) {
      const json &ring = content.at("ring")[r];
      const int n = ring.at("N_bonds");
      const double pitch = ring.at("pitch");
      const json k = anyConstants(pitch);
      const std::string path = fmt::format("ring.{}.", r);
      for (const std::string model : kModels) {
         const CaseScene scene = bentChain(pitch, k, n, ring.at("rest_rotation_per_bond_z"));
         const auto answer = balanceOf(bench, scene, modelValues(model));
         if (!answer) {
            findings.fail(path + "*", answer.error().message);
            continue;
         }
         const Vec3 tip = answer->place({n, 0, 0});
         findings.compare(
             path + "tip", {tip.data(), 3},
             Tolerance::of(tol.at("position_over_l_per_bond"), n * pitch, "of the pitch, per bond"),
             "model " + model);
         findings.compare(path + "energy", answer->elasticEnergy(),
                          Tolerance::of(tol.at("energy_over_k_bend"), k.at("bending").at(2), "of k_bending"),
                          "model " + model);
      }
   }
   findings.skip("helix*", "every bond both bends and twists, and an actuator has one of these only");
   return {};
}

} // namespace diatom
