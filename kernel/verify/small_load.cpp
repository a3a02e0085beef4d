// Forms "cantilever" and "composite-bonds": chains under loads so small that answers are proportional to
// them.
#include "verify/forms.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace diatom {

namespace {

using nlohmann::json;

/// What is read at the tip of a chain along x.
struct Tip
{
   Vec3 moved, turned;
   Wrench root; // that the support supplies
};

Result<Tip> tipOf(const Bench &bench, const CaseScene &scene, int last, const char *model)
{
   const auto answer = balanceOf(bench, scene, modelValues(model));
   if (!answer)
      return answer.error();
   const Index tip{last, 0, 0};
   return Tip{answer->displacement(tip), rotationVector(answer->turn(tip)), answer->reaction(kOrigin)};
}

bool startsWith(const std::string &text, std::string_view start) { return text.starts_with(start); }

/// One scenario of a cantilever: the chain under each of its loads.
class Cantilever
{
public:
   Cantilever(const Case &one, const json &scenario, const Bench &bench, const char *model)
       : m_case(one.content), m_scenario(scenario), m_bench(bench), m_model(model),
         m_last(scenario.at("n_cells").get<int>() - 1)
   {
      const auto direction = scenario.at("load_P").at("direction").get<std::string>();
      m_axis = direction == "y" ? 1 : 2;
      m_load = scenario.at("load_P").at("P");
   }

   Status run();
   /// The value that the case calls so; nothing for others.
   std::optional<double> value(const std::string &quantity) const;
   double deflection() const { return m_bent.moved[m_axis]; }

private:
   CaseScene chain() const
   {
      CaseScene scene(m_case.at("lattice").at("pitch"));
      scene.boxes(m_scenario.at("cells"), scene.materialOf(m_case.at("materials").at("mat")));
      scene.hold(kOrigin);
      return scene;
   }

   const json &m_case, &m_scenario;
   const Bench &m_bench;
   const char *m_model;
   int m_last = 0, m_axis = 2;
   double m_load = 0;
   Tip m_bent, m_weighed, m_pulled, m_twisted;
};

Status Cantilever::run()
{
   const Index tip{m_last, 0, 0};
   CaseScene bent = chain(), weighed = chain(), pulled = chain(), twisted = chain();
   bent.load(tip, m_load * Vec3::Unit(m_axis));
   pulled.load(tip, 1000 * m_load * Vec3::Unit(0));
   twisted.load(tip, Vec3::Zero(), m_load * bent.pitch() * Vec3::Unit(0));
   weighed.setup().gravity[static_cast<std::size_t>(m_axis)] = m_scenario.at("gravity_case").at("g");
   for (const auto &[scene, to] : {std::pair{&bent, &m_bent}, std::pair{&weighed, &m_weighed},
                                   std::pair{&pulled, &m_pulled}, std::pair{&twisted, &m_twisted}})
   {
      const auto found = tipOf(m_bench, *scene, m_last, m_model);
      if (!found)
         return found.error();
      *to = *found;
   }
   return {};
}

std::optional<double> Cantilever::value(const std::string &quantity) const
{
   const int across = 3 - m_axis; // the axis that it turns about
   if (startsWith(quantity, "tip displacement under self weight"))
      return m_weighed.moved[m_axis];
   if (startsWith(quantity, "tip displacement along"))
      return deflection();
   if (startsWith(quantity, "tip rotation about"))
      return m_bent.turned[across];
   // The case's sign is that of the support for loads along z, that of the ground for loads along y.
   if (startsWith(quantity, "root reaction torque about"))
      return m_axis == 1 ? -m_bent.root.moment[across] : m_bent.root.moment[across];
   if (startsWith(quantity, "axial tip displacement"))
      return m_pulled.moved.x();
   if (startsWith(quantity, "tip twist"))
      return m_twisted.turned.x();
   return std::nullopt;
}

void compareCantilever(const json &expected, const std::string &path, const Cantilever &chain,
                       const std::string &model, double timoshenko, double most, Findings &findings)
{
   const auto quantity = expected.at("quantity").get<std::string>();
   const std::string own = path + ".models." + model;
   if (startsWith(quantity, "relative deviation from Timoshenko")) {
      findings.compare(own, chain.deflection() / timoshenko - 1, Tolerance::absolute(most));
      return;
   }
   const auto value = chain.value(quantity);
   if (!value)
      return;
   findings.compare(own, *value, Tolerance::relative(most));
   // Two of the models are beam theories to the last digit, for any number of cells.
   if (model == "b")
      findings.compare(path + ".continuum.timoshenko", *value, Tolerance::relative(most), "model b");
   if (model == "c")
      findings.compare(path + ".continuum.euler_bernoulli", *value, Tolerance::relative(most), "model c");
}

} // namespace

Status answerCantilever(const Case &one, const Bench &bench, Findings &findings)
{
   const json &content = one.content;
   const double most = content.at("tol").at("discrete_rel");
   const json &k = content.at("materials").at("mat").at("k");
   std::map<int, double> deflection; // of model b, by cells
   for (std::size_t s = 0; s < content.at("scenarios").size(); ++s) {
      const json &scenario = content.at("scenarios")[s];
      const std::string path = fmt::format("scenarios.{}.expected", s);
      const json &expected = scenario.at("expected");
      double timoshenko = 0;
      for (const json &row : expected)
         if (row.contains("continuum") && timoshenko == 0)
            timoshenko = row.at("continuum").at("timoshenko");
      for (const char *model : kModels) {
         Cantilever chain(one, scenario, bench, model);
         if (const Status done = chain.run(); !done) {
            findings.fail(fmt::format("{}.*.{}", path, model), done.error().message);
            continue;
         }
         if (model == std::string("b"))
            deflection[scenario.at("n_cells")] = chain.deflection();
         for (std::size_t row = 0; row < expected.size(); ++row)
            compareCantilever(expected[row], fmt::format("{}.{}", path, row), chain, model, timoshenko, most,
                              findings);
      }
      // 12 E I / (G A_s l2), from the constants of the bending plane.
      const bool y = scenario.at("load_P").at("direction") == "y";
      const double l = content.at("lattice").at("pitch");
      const double phi = 12 * k.at("bending").at(y ? 2 : 1).get<double>() /
                         (k.at("shear").at(y ? "xy" : "xz").get<double>() * l * l);
      for (std::size_t row = 0; row < expected.size(); ++row)
         findings.compare(fmt::format("{}.{}.phi", path, row), phi, Tolerance::relative(most));
   }
   // Its numbers are those of another program; how far model b is from them is information, not a bar.
   findings.skip("calculix*.seconds", "the time of another program on another machine");
   findings.skip("calculix*.n", "given, not asked");
   findings.skip("calculix*",
                 "CalculiX's own answer; the case expects 1 to 2 % from model b, the limit of beam theory, "
                 "at 8 cells");
   return {};
}

namespace {

/// Largest turn of a scene whose answers are to be proportional to its loads: the square is what it misses.
constexpr double kSmallTurn = 1e-5;

/// A chain whose cells' letters say what they are made of.
CaseScene chainOf(const Case &one, const std::string &letters, const std::map<char, json> &constants)
{
   CaseScene scene(one.content.at("lattice").at("pitch"));
   std::map<char, MaterialIndex> materials;
   for (const auto &[letter, k] : constants)
      materials[letter] = scene.material(k);
   for (std::size_t i = 0; i < letters.size(); ++i)
      scene.cell({static_cast<std::int32_t>(i), 0, 0}, materials.at(letters[i]));
   scene.hold(kOrigin);
   return scene;
}

json divided(json constants, double ratio)
{
   for (const char *key : {"axial", "bending", "torsion", "shear"})
      for (auto &value : constants.at(key))
         value = value.get<double>() / ratio;
   return constants;
}

struct Compliances
{
   double stretch = 0, twist = 0, bend = 0, lift = 0, across = 0;
};

/// Per unit of force at the tip, and of force times pitch as moment, like the case has it.
Result<Compliances> compliances(const Case &one, const json &scenario, const Bench &bench, const char *model)
{
   const double ratio = scenario.at("ratio_E_A_over_E_B");
   const json &a = one.content.at("materials").at("A").at("k");
   const auto letters = scenario.at("sequence").get<std::string>();
   const std::map<char, json> constants{{'A', a}, {'B', divided(a, ratio)}};
   const int last = static_cast<int>(letters.size()) - 1;
   const Index tip{last, 0, 0};
   const CaseScene chain = chainOf(one, letters, constants);
   const double l = chain.pitch();
   // About what a bar of the softer half turns.
   const double turn = l / (a.at("bending").at(0).get<double>() / ratio) * last;
   const double force = kSmallTurn / turn / last;
   CaseScene pulled = chain, twisted = chain, bent = chain, pushed = chain;
   pulled.load(tip, force * last * Vec3::Unit(0));
   twisted.load(tip, Vec3::Zero(), force * l * Vec3::Unit(0));
   bent.load(tip, Vec3::Zero(), force * l * Vec3::Unit(1));
   pushed.load(tip, force * Vec3::Unit(2));
   const auto stretch = tipOf(bench, pulled, last, model), twist = tipOf(bench, twisted, last, model),
              bend = tipOf(bench, bent, last, model), push = tipOf(bench, pushed, last, model);
   for (const auto *found : {&stretch, &twist, &bend, &push})
      if (!*found)
         return found->error();
   return Compliances{stretch->moved.x() / force / last, twist->turned.x() / force, bend->turned.y() / force,
                      -bend->moved.z() / force, push->moved.z() / force};
}

double toleranceOf(const json &tol, double ratio)
{
   return tol.at("direct_rel").at(ratio <= 1e3 ? "ratio<=1e3" : "ratio<=1e6");
}

void compareComposite(const json &scenario, const std::string &path, const std::string &model,
                      const Compliances &found, double load, double most, Findings &findings)
{
   const auto tolerance = Tolerance::relative(most);
   if (model == "b_exact") { // the stepped beam is the true bar
      findings.compare(path + ".true_bar_timoshenko.transverse_tip_per_P", found.across * load, tolerance,
                       "model b_exact");
      findings.compare(path + ".true_bar_timoshenko.tip_deflection_per_end_moment", found.lift * load,
                       tolerance, "model b_exact");
      return;
   }
   findings.compare(path + ".expected_transverse_tip_per_P." + model, found.across * load, tolerance);
   const std::string all = path + ".expected_all_models.";
   findings.compare(all + "axial tip per F=P", found.stretch * load, tolerance, "model " + model);
   findings.compare(all + "twist per T=P*l", found.twist * load, tolerance, "model " + model);
   findings.compare(all + "tip rotation per end moment M=P*l", found.bend * load, tolerance,
                    "model " + model);
   findings.compare(all + "tip deflection per end moment M=P*l", found.lift * load, tolerance,
                    "model " + model);
   if (model != "b")
      return;
   const json &bar = scenario.at("true_bar_timoshenko");
   findings.compare(path + ".composite_rule_error.transverse_b",
                    found.across * load / bar.at("transverse_tip_per_P").get<double>() - 1,
                    Tolerance::absolute(most), "of model b");
   findings.compare(path + ".composite_rule_error.end_moment_deflection",
                    found.lift * load / bar.at("tip_deflection_per_end_moment").get<double>() - 1,
                    Tolerance::absolute(most), "of model b");
}

/// A leg with one hinge whose far end moves across but does not turn: its compliance.
Result<double> guidedLeg(const Case &one, const json &row, const Bench &bench, const char *model)
{
   const json &a = one.content.at("materials").at("A").at("k");
   json hinge = a;
   for (auto &value : hinge.at("bending"))
      value = value.get<double>() / row.at("bending_ratio").get<double>();
   CaseScene scene = chainOf(one, "SHSHS", {{'S', a}, {'H', hinge}});
   const Index tip{4, 0, 0};
   const double turn = scene.pitch() / hinge.at("bending").at(0).get<double>();
   const double force = kSmallTurn / turn;
   scene.hold(tip, 0x38);
   scene.load(tip, force * Vec3::Unit(2));
   const auto found = tipOf(bench, scene, 4, model);
   if (!found)
      return found.error();
   return found->moved.z() / force;
}

void answerHinges(const Case &one, const Bench &bench, Findings &findings)
{
   const json &leg = one.content.at("hinge_in_stiff_leg");
   const double load = leg.at("P");
   for (std::size_t i = 0; i < leg.at("rows").size(); ++i) {
      const json &row = leg.at("rows")[i];
      const std::string path = fmt::format("hinge_in_stiff_leg.rows.{}", i);
      const double most = toleranceOf(one.content.at("tol"), row.at("bending_ratio"));
      const auto mean = guidedLeg(one, row, bench, "b"), stepped = guidedLeg(one, row, bench, "b_exact");
      if (!mean || !stepped) {
         findings.fail(path + ".*", mean ? stepped.error().message : mean.error().message);
         continue;
      }
      findings.compare(path + ".guided_tip_per_P.b", *mean * load, Tolerance::relative(most));
      findings.compare(path + ".guided_tip_per_P.exact", *stepped * load, Tolerance::relative(most),
                       "model b_exact");
      findings.compare(path + ".stiffness_error_of_composite_rule", *stepped / *mean - 1,
                       Tolerance::absolute(most));
   }
}

} // namespace

Status answerCompositeBonds(const Case &one, const Bench &bench, Findings &findings)
{
   const json &scenarios = one.content.at("scenarios");
   for (std::size_t s = 0; s < scenarios.size(); ++s) {
      const json &scenario = scenarios[s];
      const std::string path = fmt::format("scenarios.{}", s);
      const double most = toleranceOf(one.content.at("tol"), scenario.at("ratio_E_A_over_E_B"));
      for (const std::string model : {"a", "b", "c", "b_exact"}) {
         const auto found = compliances(one, scenario, bench, model.c_str());
         if (found)
            compareComposite(scenario, path, model, *found, scenario.at("P"), most, findings);
         else
            findings.fail(path + ".*", found.error().message);
      }
   }
   answerHinges(one, bench, findings);
   return {};
}

} // namespace diatom
