// Form "damping": oscillators and a released chain whose motion is known in closed form.
#include "verify/forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace diatom {

namespace {

using nlohmann::json;

constexpr Index kSecond{1, 0, 0};

/// Integrators with the step (parts of a radian of the oscillator) and the tolerance that the case gives.
struct Way
{
   const char *integrator, *key;
};
constexpr Way kWays[] = {{"semi_implicit", "symplectic_euler dt=0.01/omega"},
                         {"verlet", "verlet dt=0.01/omega"},
                         {"rk4", "rk4 dt=0.01/omega"}};
constexpr double kStep = 0.01;

BondConstants filled(double axial, double torsion)
{
   BondConstants out;
   out.axial = {axial, axial, axial};
   out.torsion = {torsion, torsion, torsion};
   return out;
}

/// The fifteen stiffnesses times beta.
BondConstants proportional(const BondConstants &k, double beta)
{
   BondConstants out = k;
   for (auto *constants :
        {&out.axial, &out.bending, &out.torsion, &out.shear[0], &out.shear[1], &out.shear[2]})
      for (double &value : *constants)
         value *= beta;
   return out;
}

/// Two cells along x; their displacement or turn about x at the asked times.
Result<std::vector<double>> swing(const Case &one, const Bench &bench, const json &asked,
                                  const char *integrator, double damping, bool turns, bool held, double omega,
                                  double start)
{
   CaseScene scene(one.content.at("lattice").at("pitch"));
   const MaterialIndex material = scene.materialOf(one.content.at("materials").at("m"));
   scene.box(kOrigin, kSecond, material);
   if (damping > 0)
      scene.change(material,
                   [&](Material &own) { own.dampings = turns ? filled(0, damping) : filled(damping, 0); });
   const auto begin = [&](Index at, double amount) {
      Start first;
      first.where = at;
      (turns ? first.turn : first.displacement)[0] = amount;
      scene.setup().starts.push_back(first);
   };
   begin(kSecond, start);
   if (held)
      scene.hold(kOrigin);
   else
      begin(kOrigin, -start);
   scene.setup().step = kStep / omega;
   Values values = modelValues("b");
   values["integrator"] = integrator;
   const auto motion = motionOf(bench, scene, values);
   if (!motion)
      return motion.error();
   const std::int64_t cell = (*motion)->scene().cellAt(kSecond);
   std::vector<double> out;
   for (const json &time : asked) {
      if (const Status moved = (*motion)->advance(time, *bench.job); !moved)
         return moved.error();
      const auto value = (*motion)->probe(cell, turns ? "rx" : "x", *bench.job);
      if (!value)
         return value.error();
      out.push_back(*value);
   }
   return out;
}

/// A chain let go of from its balance under a tip load, as weak as to be proportional to it.
class Release
{
public:
   Release(const Case &one, const Bench &bench, const json &released)
       : m_case(one), m_bench(bench), m_released(released), m_last(released.at("N").get<int>())
   {}
   Result<std::vector<double>> tip(const json &row) const;

private:
   static constexpr double kSmall = 1e-3;
   CaseScene chain(double beta) const;

   const Case &m_case;
   const Bench &m_bench;
   const json &m_released;
   int m_last;
};

CaseScene Release::chain(double beta) const
{
   CaseScene scene(m_case.content.at("lattice").at("pitch"));
   const MaterialIndex material = scene.materialOf(m_case.content.at("materials").at("m"));
   scene.boxes(m_released.at("cells"), material);
   if (beta > 0)
      scene.change(material, [&](Material &own) { own.dampings = proportional(*own.bonds, beta); });
   scene.hold(kOrigin);
   return scene;
}

Result<std::vector<double>> Release::tip(const json &row) const
{
   const Index tip{m_last, 0, 0};
   CaseScene scene = chain(row.at("beta"));
   CaseScene bent = scene;
   bent.load(tip, kSmall * m_released.at("P_tip_z").get<double>() * Vec3::Unit(2));
   Values values = modelValues(row.at("model").get<std::string>());
   const auto balance = balanceOf(m_bench, bent, values);
   if (!balance)
      return balance.error();
   for (int x = 1; x <= m_last; ++x) {
      const Vec3 moved = balance->displacement({x, 0, 0}), turned = rotationVector(balance->turn({x, 0, 0}));
      Start start;
      start.where = Index{x, 0, 0};
      start.displacement = {moved.x(), moved.y(), moved.z()};
      start.turn = {turned.x(), turned.y(), turned.z()};
      scene.setup().starts.push_back(start);
   }
   values["integrator"] = "rk4";
   values["safety"] = 0.3;
   const auto motion = motionOf(m_bench, scene, values);
   if (!motion)
      return motion.error();
   std::vector<double> out;
   for (const json &time : row.at("t")) {
      if (const Status moved = (*motion)->advance(time, *m_bench.job); !moved)
         return moved.error();
      const auto u = displacementOf(**motion, tip, *m_bench.job);
      if (!u)
         return u.error();
      out.push_back(u->z() / kSmall);
   }
   return out;
}

} // namespace

Status answerDamping(const Case &one, const Bench &bench, Findings &findings)
{
   const json &content = one.content, &tol = content.at("tol").at("over_amplitude");
   const auto compare = [&](const std::string &path, const Result<std::vector<double>> &x, const Way &way,
                            double amplitude) {
      if (x)
         findings.compare(path, *x, Tolerance::of(tol.at(way.key), amplitude, "of the amplitude"),
                          way.integrator);
      else
         findings.fail(path, x.error().message);
   };
   for (std::size_t s = 0; s < content.at("single").size(); ++s) {
      const json &single = content.at("single")[s];
      const bool turns = single.at("dof") == "rx";
      for (const Way &way : kWays)
         compare(fmt::format("single.{}.x", s),
                 swing(one, bench, single.at("t"), way.integrator, single.at("d_required"), turns, true,
                       single.at("omega"), single.at("x0")),
                 way, single.at("x0"));
   }
   const json &pair = content.at("free_pair"), &m = content.at("materials").at("m");
   // "d as above with zeta = 0.1"
   const double damping =
       2 * 0.1 * std::sqrt(m.at("k").at("axial").at(0).get<double>() * m.at("mass").get<double>());
   for (const Way &way : kWays)
      compare("free_pair.x2",
              swing(one, bench, pair.at("t"), way.integrator, damping, false, false, pair.at("omega"),
                    pair.at("x0")),
              way, pair.at("x0"));
   const json &released = content.at("chain_release");
   const Release release(one, bench, released);
   for (std::size_t c = 0; c < released.at("cases").size(); ++c) {
      const json &row = released.at("cases")[c];
      const std::string path = fmt::format("chain_release.cases.{}.tip_z", c);
      const auto tip = release.tip(row);
      // The case's bar for the second-order method; Runge-Kutta's own is for one oscillator.
      if (tip)
         findings.compare(
             path, *tip,
             Tolerance::of(tol.at("verlet dt=0.01/omega"), row.at("tip_z_initial"), "of the amplitude"),
             "rk4 at 0.3 of its stable step");
      else
         findings.fail(path, tip.error().message);
   }
   return {};
}

} // namespace diatom
