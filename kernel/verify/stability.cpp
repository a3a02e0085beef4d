// Forms "column-buckling" and "lee-frame": loads that a shape can just carry.
#include "verify/forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace diatom {

namespace {

using nlohmann::json;

CaseScene column(const Case &one, const json &scenario, double load)
{
   CaseScene scene(one.content.at("lattice").at("pitch"));
   scene.boxes(scenario.at("cells"), scene.materialOf(one.content.at("materials").at("m")));
   scene.hold(kOrigin);
   scene.load({scenario.at("N_bonds").get<int>(), 0, 0}, -load * Vec3::Unit(0));
   return scene;
}

Result<double> lowestEigenvalue(const Case &one, const json &scenario, const Bench &bench,
                                const std::string &model, double load)
{
   Values values = modelValues(model);
   values["modes"] = 1.0;
   const auto found = modesOf(bench, column(one, scenario, load), values);
   if (!found)
      return found.error();
   return found->modes.front().eigenvalue;
}

/// Where the lowest eigenvalue passes zero: it falls almost evenly with the load. `low` and `high` are loads
/// below and above.
Result<double> criticalLoad(const Case &one, const json &scenario, const Bench &bench,
                            const std::string &model, double low, double high)
{
   const auto at = [&](double load) { return lowestEigenvalue(one, scenario, bench, model, load); };
   const auto first = at(low), second = at(high);
   if (!first || !second)
      return first ? second.error() : first.error();
   double a = *first, b = *second, load = low;
   for (int i = 0; i < 20 && a != b; ++i) {
      load = low - a * (high - low) / (b - a);
      if (std::abs(high - low) < 1e-9 * load)
         break;
      const auto value = at(load);
      if (!value)
         return value.error();
      if (*value == 0)
         break;
      // The farther of the two ends makes way.
      (std::abs(load - low) > std::abs(load - high) ? low : high) = load;
      (low == load ? a : b) = *value;
   }
   return load;
}

} // namespace

Status answerColumnBuckling(const Case &one, const Bench &bench, Findings &findings)
{
   const json &content = one.content, &tol = content.at("tol");
   const double l = content.at("lattice").at("pitch"), most = tol.at("eigenvalue_rel");
   const double stiffness = content.at("materials").at("m").at("k").at("bending").at(1);
   for (std::size_t s = 0; s < content.at("scenarios").size(); ++s) {
      const json &scenario = content.at("scenarios")[s];
      const std::string path = fmt::format("scenarios.{}.", s);
      const double n = scenario.at("N_bonds");
      // pi^2 E I / (4 L^2)
      const double euler = std::pow(std::numbers::pi / (2 * n * l), 2) * stiffness * l;
      findings.compare(path + "euler", euler, Tolerance::relative(most), "closed form, no run");
      for (const std::string model : kModels) {
         const double expected = scenario.at("expected_critical_load").at(model);
         const double below = tol.at("stable_below"), above = tol.at("unstable_above");
         const auto critical = criticalLoad(one, scenario, bench, model, below * expected, above * expected);
         if (!critical) {
            findings.fail(path + "*." + model, critical.error().message);
            continue;
         }
         findings.compare(path + "expected_critical_load." + model, *critical, Tolerance::relative(most));
         findings.compare(path + "relative_to_euler." + model, *critical / euler - 1,
                          Tolerance::absolute(most));
         for (const double factor : {below, above}) {
            const auto value = lowestEigenvalue(one, scenario, bench, model, factor * expected);
            const bool stable = factor < 1;
            findings.check(fmt::format("{}, model {}: {} at {} of the critical load",
                                       scenario.value("name", ""), model, stable ? "stable" : "unstable",
                                       factor),
                           value && (*value > 0) == stable ? 0 : 1, 0);
         }
      }
   }
   return {};
}

namespace {

/// Lee's frame pushed down step by step: the force that it takes, also where it is less than before.
class LeeFrame
{
public:
   LeeFrame(const Case &one, const Bench &bench, const std::string &model, double deepest);

   /// Load and sideways displacement of the loaded cell, where it is pushed down by v.
   Result<std::array<double, 2>> at(double v);
   /// The first load that is not surpassed near v, and where.
   Result<std::array<double, 2>> limitNear(double v);

private:
   const Bench &m_bench;
   std::string m_model;
   CaseScene m_scene;
   Index m_loaded;
   double m_deepest = 0;
};

LeeFrame::LeeFrame(const Case &one, const Bench &bench, const std::string &model, double deepest)
    : m_bench(bench), m_model(model),
      m_scene(one.content.at("lattice").at("pitch").get<double>()), m_loaded{one.content.at("nl").get<int>(),
                                                                             0,
                                                                             one.content.at("N").get<int>()},
      m_deepest(deepest)
{
   m_scene.boxes(one.content.at("cells"), m_scene.materialOf(one.content.at("materials").at("m")));
   constexpr std::uint8_t kPlane = 0x2a; // y, rx and rz held
   const int n = m_loaded.z;
   m_scene.setup().supports = {
       {Index{0, 0, 0}, 0x2f}, {Index{n, 0, n}, 0x2f}, {Box{{0, 0, 0}, {n, 0, n}}, kPlane}};
}

Result<std::array<double, 2>> LeeFrame::at(double v)
{
   CaseScene scene = m_scene;
   scene.drive(m_loaded, 2, -v);
   const auto answer = balanceOf(m_bench, scene, modelValues(m_model), 1e-10);
   if (!answer)
      return answer.error();
   return std::array{-answer->reaction(m_loaded).force.z(), answer->displacement(m_loaded).x()};
}

/// Golden section: the load is smooth and has one peak there.
Result<std::array<double, 2>> LeeFrame::limitNear(double v)
{
   const double golden = 0.5 * (std::sqrt(5.0) - 1);
   double low = 0.9 * v, high = std::min(1.1 * v, m_deepest);
   double a = high - golden * (high - low), b = low + golden * (high - low);
   auto fa = at(a), fb = at(b);
   while (fa && fb && high - low > 1e-4 * v) {
      if ((*fa)[0] > (*fb)[0]) {
         high = b;
         b = a;
         fb = fa;
         a = high - golden * (high - low);
         fa = at(a);
      } else {
         low = a;
         a = b;
         fa = fb;
         b = low + golden * (high - low);
         fb = at(b);
      }
   }
   if (!fa || !fb)
      return fa ? fb.error() : fa.error();
   return std::array{std::max((*fa)[0], (*fb)[0]), 0.5 * (low + high)};
}

void comparePath(const json &points, const std::string &path, LeeFrame &frame, const Tolerance &tolerance,
                 const std::string &note, Findings &findings)
{
   for (std::size_t i = 0; i < points.size(); ++i) {
      const double v = points[i].at(0);
      const auto found = frame.at(v);
      const std::string own = fmt::format("{}.{}", path, i);
      if (!found) {
         findings.fail(own, found.error().message);
         continue;
      }
      const double all[3] = {v, (*found)[0], (*found)[1]};
      findings.compare(own, all, tolerance, note);
   }
}

} // namespace

Status answerLeeFrame(const Case &one, const Bench &bench, Findings &findings)
{
   const json &expected = one.content.at("expected"), &tol = one.content.at("tol");
   const double limitTolerance = tol.at("limit_load_rel"), where = tol.at("v_at_limit_rel"),
                along = tol.at("path_load_rel");
   const json &continuum = expected.at("continuum");
   for (const std::string model : kModels) {
      const json &own = expected.at("discrete_mid_conservative").at(model);
      const std::string path = "expected.discrete_mid_conservative." + model;
      const double v = own.at("v_at_limit");
      LeeFrame frame(one, bench, model, 1.2 * v);
      const auto limit = frame.limitNear(v);
      if (!limit) {
         findings.fail(path + "*", limit.error().message);
         continue;
      }
      findings.compare(path + ".limit_load", (*limit)[0], Tolerance::relative(limitTolerance));
      findings.compare(path + ".v_at_limit", (*limit)[1], Tolerance::relative(where));
      comparePath(own.at("path_v_P_u"), path + ".path_v_P_u", frame, Tolerance::each(1e-6), "v is given",
                  findings);
      if (model != "b")
         continue;
      Tolerance load = Tolerance::each(along);
      load.first = 2;
      findings.compare("expected.continuum.limit_load", (*limit)[0], Tolerance::relative(limitTolerance),
                       "model b");
      findings.compare("expected.continuum.v_at_limit", (*limit)[1], Tolerance::relative(where), "model b");
      comparePath(continuum.at("path_v_P_u"), "expected.continuum.path_v_P_u", frame, load,
                  "model b; v is given, and the case has a bar for the load alone", findings);
   }
   return {};
}

} // namespace diatom
