// Form "time-step-limits": highest frequencies of free blocks, and the longest steps that they allow.
#include "verify/forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace diatom {

namespace {

using nlohmann::json;

/// The thesis' rule (5.26): the highest frequency of a single bond, as if its cell hung on it alone.
double thesisOmega(const json &material)
{
   const double mass = material.at("mass"), inertia = material.at("inertia").at(0);
   double most = 0;
   const auto consider = [&](const json &constants, double inertial) {
      for (const auto &value : constants)
         most = std::max(most, std::sqrt(value.get<double>() / inertial));
   };
   const json &k = material.at("k");
   consider(k.at("axial"), mass);
   consider(k.at("shear"), mass);
   consider(k.at("bending"), inertia);
   consider(k.at("torsion"), inertia);
   return most;
}

struct BlockLimit
{
   double omega = 0; // highest, rad/s
   double step = 0;  // that the solver takes for stable with the semi-implicit integrator, s
};

Result<BlockLimit> limitOf(const Case &one, const json &material, const json &shape, const Bench &bench,
                           const std::string &model)
{
   CaseScene scene(one.content.at("lattice").at("pitch"));
   scene.box({0, 0, 0}, indexOf(shape) + Index{-1, -1, -1}, scene.materialOf(material));
   Values values = modelValues(model);
   const auto motion = motionOf(bench, scene, values);
   if (!motion)
      return motion.error();
   values["modes"] = 1.0;
   values["modes_from"] = "highest";
   const auto found = modesOf(bench, scene, values);
   if (!found)
      return found.error();
   return BlockLimit{std::sqrt(found->modes.back().eigenvalue), (*motion)->stableStep()};
}

std::string shapeText(const json &shape)
{
   const Index n = indexOf(shape);
   return fmt::format("{} x {} x {}", n.x, n.y, n.z);
}

void compareBlock(const std::string &path, const BlockLimit &limit, double thesisStep, const json &tol,
                  const std::string &what, Findings &findings)
{
   const auto tolerance = Tolerance::relative(tol.at("omega_max_rel"));
   findings.compare(path + "omega_max", limit.omega, tolerance);
   findings.compare(path + "dt_crit_symplectic_euler_and_verlet", 2 / limit.omega, tolerance);
   findings.compare(path + "dt_crit_rk4", 2 * std::numbers::sqrt2 / limit.omega, tolerance);
   findings.compare(path + "thesis_dt_over_true_limit", thesisStep * limit.omega / 2, tolerance);
   // The case allows an estimate to be half too careful, and never too bold.
   findings.check("the solver's stable step over the true limit, " + what, limit.step * limit.omega / 2,
                  1 + tol.at("estimate_may_fall_short_by").get<double>());
   findings.check("the true limit over the solver's stable step, " + what, 2 / (limit.omega * limit.step),
                  1 + tol.at("estimate_may_exceed_by").get<double>());
}

} // namespace

Status answerTimeStepLimits(const Case &one, const Bench &bench, Findings &findings)
{
   const json &content = one.content, &tol = content.at("tol");
   findings.skip("*infinite_lattice*",
                 "of a lattice without end, which a scene is not; blocks approach it from below");
   findings.skip("scalar_limits*forward_euler",
                 "the solver has no forward Euler, which is unstable without damping");
   findings.skip("scalar_limits*.zeta", "given, not asked");
   findings.skip("scalar_limits*",
                 "closed forms of one oscillator, with nothing of the solver in them; its own limits "
                 "with damping are held by its tests");
   for (std::size_t r = 0; r < content.at("results").size(); ++r) {
      const json &result = content.at("results")[r];
      const json &material = content.at("materials").at(result.at("material").get<std::string>());
      const std::string path = fmt::format("results.{}.", r);
      const double omega = thesisOmega(material), step = 1 / (2 * std::numbers::pi * omega);
      findings.compare(path + "thesis_omega_n_max", omega, Tolerance::relative(1e-9), "closed form, no run");
      findings.compare(path + "thesis_dt_1_over_2pi_omega", step, Tolerance::relative(1e-9),
                       "closed form, no run");
      for (const auto &[model, of] : result.at("models").items())
         for (std::size_t b = 0; b < of.at("blocks").size(); ++b) {
            const json &block = of.at("blocks")[b];
            const std::string own = fmt::format("{}models.{}.blocks.{}.", path, model, b);
            const auto limit = limitOf(one, material, block.at("shape"), bench, model);
            if (limit)
               compareBlock(own, *limit, step, tol,
                            fmt::format("{}, model {}, {}", result.at("material").get<std::string>(), model,
                                        shapeText(block.at("shape"))),
                            findings);
            else
               findings.fail(own + "*", limit.error().message);
         }
   }
   return {};
}

} // namespace diatom
