// Forms "elastica-tip-force", "end-moment", "twist-helix" and "right-angle-frame": slender structures bent
// and twisted far.
#include "verify/forms.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace diatom {

namespace {

using nlohmann::json;

CaseScene clampedChain(const Case &one, const json &material, int bonds)
{
   CaseScene scene(one.content.at("lattice").at("pitch"));
   scene.box(kOrigin, {bonds, 0, 0}, scene.materialOf(material));
   scene.hold(kOrigin);
   return scene;
}

/// Turn about -y, in (-180, 180] degrees, of a cell that stays in the plane.
double planeAngle(const Quat &turn)
{
   return 2 * std::atan2(-turn.y() * (turn.w() < 0 ? -1 : 1), std::abs(turn.w()));
}

/// The whole turn that is nearest to what is looked for, which a pose alone does not tell.
double nearestTurn(double angle, double wanted)
{
   const double whole = 2 * std::numbers::pi;
   return angle + whole * std::round((wanted - angle) / whole);
}

struct PlaneTip
{
   double x = 0, z = 0, angle = 0;
};

void compareTip(const std::string &path, const PlaneTip &tip, double most, double length, Findings &findings,
                const std::string &note = "")
{
   const auto tolerance = Tolerance::of(most, length, "of the chain's length");
   findings.compare(path + ".tip_x", tip.x, tolerance, note);
   findings.compare(path + ".tip_z", tip.z, tolerance, note);
   findings.compare(path + ".tip_angle", tip.angle, Tolerance::relative(most), note);
}

/// The first number in a text like "N>=8".
bool holdsFor(const std::string &words, int n)
{
   return words.starts_with("N>=") && n >= std::atoi(words.c_str() + 3);
}

double continuumTolerance(const json &tol, int n, const std::string &model)
{
   for (const auto &[words, models] : tol.at("continuum_rel").items())
      if (holdsFor(words, n))
         return models.at(model);
   return 0;
}

} // namespace

Status answerElastica(const Case &one, const Bench &bench, Findings &findings)
{
   const json &content = one.content, &tol = content.at("tol");
   const json &material = content.at("materials").at("m");
   const double l = content.at("lattice").at("pitch");
   findings.skip("*b_chord*",
                 "the solver's bonds have the middle frame; a frame along the chord is another bond");
   findings.skip("*continuum_elastica*",
                 "of a bar that neither shears nor stretches, which cubes do; the case keeps it "
                 "for slender constants");
   for (std::size_t s = 0; s < content.at("scenarios").size(); ++s) {
      const json &scenario = content.at("scenarios")[s];
      const json &load = scenario.at("load"), &expected = scenario.at("expected");
      const int n = load.at("cell").at(0);
      for (const std::string model : kModels) {
         CaseScene scene = clampedChain(one, material, n);
         scene.load({n, 0, 0}, vectorOf(load.at("force")));
         const auto answer = balanceOf(bench, scene, modelValues(model));
         if (!answer) {
            findings.fail(fmt::format("scenarios.{}.*.{}*", s, model), answer.error().message);
            continue;
         }
         const Index at{n, 0, 0};
         const PlaneTip tip{answer->place(at).x(), answer->place(at).z(), planeAngle(answer->turn(at))};
         const std::string path = fmt::format("scenarios.{}.", s);
         compareTip(path + "expected.discrete_mid_conservative." + model, tip, tol.at("discrete_mid_rel"),
                    n * l, findings);
         const json &reissner = expected.at("continuum_reissner");
         findings.compare(path + "relative_tip_z_vs_reissner." + model,
                          tip.z / reissner.at("tip_z").get<double>() - 1,
                          Tolerance::absolute(tol.at("discrete_mid_rel")));
         compareTip(path + "expected.continuum_reissner", tip, continuumTolerance(tol, n, model), n * l,
                    findings, "model " + model);
      }
   }
   findings.skip("dimensionless_exact*",
                 "of a bar that neither shears nor stretches; the scenarios hold cubes against "
                 "the bar that does");
   return {};
}

Status answerEndMoment(const Case &one, const Bench &bench, Findings &findings)
{
   const json &content = one.content;
   const double most = content.at("tol").at("position_over_chain_length"),
                l = content.at("lattice").at("pitch");
   findings.skip("*.mid_cell", "given, not asked");
   for (std::size_t s = 0; s < content.at("scenarios").size(); ++s) {
      const json &scenario = content.at("scenarios")[s], &expected = scenario.at("expected_all_models");
      const int n = scenario.at("N_bonds"), middle = expected.at("mid_cell");
      const std::string path = fmt::format("scenarios.{}.expected_all_models", s);
      for (const std::string model : kModels) {
         CaseScene scene = clampedChain(one, content.at("materials").at("m"), n);
         scene.load({n, 0, 0}, Vec3::Zero(), vectorOf(scenario.at("tip_torque")));
         const auto answer = balanceOf(bench, scene, modelValues(model));
         if (!answer) {
            findings.fail(fmt::format("scenarios.{}.*", s), answer.error().message);
            continue;
         }
         const Index tip{n, 0, 0};
         const double angle = expected.at("tip_angle"), turned = planeAngle(answer->turn(tip));
         compareTip(path, {answer->place(tip).x(), answer->place(tip).z(), nearestTurn(turned, angle)}, most,
                    n * l, findings, "model " + model);
         const Vec3 half = answer->place({middle, 0, 0});
         const auto tolerance = Tolerance::of(most, n * l, "of the chain's length");
         findings.compare(path + ".mid_x", half.x(), tolerance, "model " + model);
         findings.compare(path + ".mid_z", half.z(), tolerance, "model " + model);
         // The arc that the polygon goes around: its sides are longer by 1/(24 (N / angle)^2).
         const double beyond = std::pow(angle / n, 2) / 24;
         const auto around = Tolerance::of(beyond + most, n * l, "of the chain's length");
         findings.compare(fmt::format("scenarios.{}.continuum.tip_x", s), answer->place(tip).x(), around,
                          "model " + model + "; the polygon goes around the arc");
         findings.compare(fmt::format("scenarios.{}.continuum.tip_z", s), answer->place(tip).z(), around,
                          "model " + model + "; the polygon goes around the arc");
      }
   }
   return {};
}

Status answerTwistHelix(const Case &one, const Bench &bench, Findings &findings)
{
   const json &content = one.content, &tol = content.at("tol");
   const double l = content.at("lattice").at("pitch");
   const int n = content.at("cells").at(0).at("box").at(1).at(0);
   const Index tip{n, 0, 0};
   for (std::size_t s = 0; s < content.at("scenarios").size(); ++s) {
      const json &scenario = content.at("scenarios")[s], &expected = scenario.at("expected_all_models");
      const bool helix = scenario.contains("tip_torque_world_dead");
      const std::string path = fmt::format("scenarios.{}.expected_all_models.", s);
      for (const std::string model : kModels) {
         CaseScene scene = clampedChain(one, content.at("materials").at(helix ? "h" : "m"), n);
         scene.load(tip, Vec3::Zero(), vectorOf(scenario.at(helix ? "tip_torque_world_dead" : "tip_torque")));
         const auto answer = balanceOf(bench, scene, modelValues(model));
         if (!answer) {
            findings.fail(fmt::format("scenarios.{}.*", s), answer.error().message);
            continue;
         }
         const Vec3 place = answer->place(tip);
         findings.compare(path + "tip", {place.data(), 3},
                          Tolerance::of(tol.at("position_over_chain_length"), n * l, "of the chain's length"),
                          "model " + model);
         Quat turn = answer->turn(tip);
         const json &wanted = expected.at("tip_quaternion_xyzw_up_to_sign");
         if (turn.dot(turnOf(wanted)) < 0)
            turn.coeffs() = -turn.coeffs();
         const double four[4] = {turn.x(), turn.y(), turn.z(), turn.w()};
         // Whole turns bring the error of all bonds together, as for places.
         findings.compare(path + "tip_quaternion_xyzw_up_to_sign", four,
                          Tolerance::of(tol.at("position_over_chain_length"), 1, "absolute"),
                          "model " + model);
         findings.compare(path + "energy", answer->elasticEnergy(), Tolerance::relative(tol.at("energy_rel")),
                          "model " + model);
         if (!expected.contains("per_bond_rotation"))
            continue;
         const Vec3 bond = rotationVector(answer->turn({0, 0, 0}).conjugate() * answer->turn({1, 0, 0}));
         findings.compare(path + "per_bond_rotation", bond.norm(), Tolerance::relative(tol.at("energy_rel")),
                          "model " + model);
      }
   }
   return {};
}

Status answerRightAngleFrame(const Case &one, const Bench &bench, Findings &findings)
{
   const json &content = one.content, &tol = content.at("tol");
   findings.skip("*continuum_residual", "how far the reference itself was solved");
   for (std::size_t s = 0; s < content.at("scenarios").size(); ++s) {
      const json &scenario = content.at("scenarios")[s], &expected = scenario.at("expected");
      const std::string path = fmt::format("scenarios.{}.", s);
      for (const std::string model : kModels) {
         CaseScene scene(content.at("lattice").at("pitch"));
         scene.boxes(content.at("cells"), scene.materialOf(content.at("materials").at("m")));
         scene.hold(kOrigin);
         const Index loaded = indexOf(scenario.at("load").at("cell"));
         scene.load(loaded, vectorOf(scenario.at("load").at("force")));
         const auto answer = balanceOf(bench, scene, modelValues(model));
         if (!answer) {
            findings.fail(fmt::format("scenarios.{}.*{}", s, model), answer.error().message);
            continue;
         }
         const Vec3 tip = answer->place(loaded), rod = vectorOf(expected.at("continuum_tip"));
         const Vec3 wanted = vectorOf(expected.at("discrete_mid_conservative_tip").at(model));
         const double moved = (wanted - answer->rest(loaded)).norm(),
                      far = (rod - answer->rest(loaded)).norm();
         findings.compare(
             path + "expected.discrete_mid_conservative_tip." + model, {tip.data(), 3},
             Tolerance::of(tol.at("discrete_mid_over_displacement"), moved, "of the displacement"));
         findings.compare(
             path + "expected.continuum_tip", {tip.data(), 3},
             Tolerance::of(tol.at("continuum_over_displacement").at(model), far, "of the displacement"),
             "model " + model);
         findings.compare(path + "relative_error_of_tip_displacement_vs_continuum." + model,
                          (tip - rod).norm() / far,
                          Tolerance::absolute(tol.at("discrete_mid_over_displacement")));
      }
   }
   findings.skip("calculix*",
                 "CalculiX's own answer, whose corner and torsion constant differ; the case keeps it as a "
                 "sanity check, not as the bar");
   return {};
}

} // namespace diatom
