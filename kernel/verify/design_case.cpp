// Form "design": a design as it is saved, and quantities of it. For cases that need no form of their own.
#include "formats/files.h"
#include "study/quantity.h"
#include "verify/forms.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace diatom {

namespace {

using nlohmann::json;

/// What a quantity is of.
struct Wanted
{
   enum class Kind { cell, mode, elasticEnergy } kind = Kind::cell;
   Quantity quantity;    // of a cell
   std::size_t mode = 0; // counted from 1, rigid motions left out
};

Result<Wanted> wantedOf(const std::string &text)
{
   Wanted wanted;
   if (text == "elastic_energy") {
      wanted.kind = Wanted::Kind::elasticEnergy;
      return wanted;
   }
   if (text.starts_with("mode:")) {
      const int number = std::atoi(text.c_str() + 5);
      if (number < 1)
         return Error{ErrorCode::unreadable, fmt::format("\"{}\" names no mode; mode:1 is the lowest", text)};
      wanted.kind = Wanted::Kind::mode;
      wanted.mode = static_cast<std::size_t>(number);
      return wanted;
   }
   auto quantity = parseQuantity(text);
   if (!quantity)
      return quantity.error();
   if (quantity->when != Quantity::When::atTime && quantity->when != Quantity::When::atRest)
      return Error{
          ErrorCode::unreadable,
          fmt::format("\"{}\" says neither @SECONDS nor @rest, so that it is no single number", text)};
   wanted.quantity = *std::move(quantity);
   return wanted;
}

/// Answers of one model about the design, each analysis run once at most and motion only onwards.
class DesignRuns
{
public:
   DesignRuns(const Bench &bench, const Hierarchy &hierarchy, const Setup &setup, Values values)
       : m_bench(bench), m_hierarchy(hierarchy), m_setup(setup), m_values(std::move(values))
   {}

   Result<double> value(const Wanted &wanted);

private:
   Result<double> atRest(const Wanted &wanted);
   Result<double> ofMode(std::size_t mode);
   Result<double> inMotion(const Quantity &quantity);
   Result<std::unique_ptr<Scene>> flat(Analysis analysis) const
   {
      return Scene::build(m_hierarchy, m_setup, *m_bench.job, analysis);
   }
   template<typename Owner>
   Result<double> probe(const Owner &owner, const Scene &scene, const Quantity &quantity) const
   {
      const std::int64_t cell = scene.cellAt(quantity.cell);
      if (cell < 0)
         return Error{ErrorCode::invalid,
                      fmt::format("the quantity {} is of a cell that is not there", quantity.text())};
      return owner.probe(cell, quantity.channel, *m_bench.job);
   }

   const Bench &m_bench;
   const Hierarchy &m_hierarchy;
   const Setup &m_setup;
   Values m_values;
   std::unique_ptr<Balance> m_balance;
   std::unique_ptr<Modes> m_modes;
   std::unique_ptr<Simulation> m_motion;
};

Result<double> DesignRuns::value(const Wanted &wanted)
{
   if (wanted.kind == Wanted::Kind::mode)
      return ofMode(wanted.mode);
   if (wanted.kind == Wanted::Kind::cell && wanted.quantity.when == Quantity::When::atTime)
      return inMotion(wanted.quantity);
   return atRest(wanted);
}

Result<double> DesignRuns::atRest(const Wanted &wanted)
{
   if (!m_balance) {
      auto scene = flat(Analysis::statics);
      if (!scene)
         return scene.error();
      BalanceRequest request;
      request.tolerance = 1e-12;
      auto found =
          solveStatics(m_bench.catalogue, *std::move(scene), m_setup, m_values, request, *m_bench.job);
      if (!found)
         return found.error();
      m_balance = std::make_unique<Balance>(*std::move(found));
   }
   const SolverRun &run = *m_balance->run;
   if (wanted.kind == Wanted::Kind::cell)
      return probe(run, run.scene(), wanted.quantity);
   const auto energy = run.output("energy", *m_bench.job);
   if (!energy)
      return energy.error();
   return energy->at(1);
}

Result<double> DesignRuns::ofMode(std::size_t mode)
{
   if (!m_modes) {
      auto scene = flat(Analysis::modes);
      if (!scene)
         return scene.error();
      auto found = findModes(m_bench.catalogue, *std::move(scene), m_setup, m_values, {}, *m_bench.job);
      if (!found)
         return found.error();
      m_modes = std::make_unique<Modes>(*std::move(found));
   }
   std::size_t left = mode;
   for (const Mode &one : m_modes->modes)
      if (one.kind == Mode::Kind::vibration && --left == 0)
         return one.hertz;
   return Error{ErrorCode::invalid,
                fmt::format("fewer than {} modes of vibration were sought; raise the solver's "
                            "value \"modes\" in the design",
                            mode)};
}

Result<double> DesignRuns::inMotion(const Quantity &quantity)
{
   if (!m_motion || m_motion->time() > quantity.time) {
      auto scene = flat(Analysis::dynamics);
      if (!scene)
         return scene.error();
      auto started = Simulation::start(m_bench.catalogue, *std::move(scene), m_setup, m_values, *m_bench.job);
      if (!started)
         return started.error();
      m_motion = *std::move(started);
   }
   if (const Status moved = m_motion->advance(quantity.time, *m_bench.job); !moved)
      return moved.error();
   return probe(*m_motion, m_motion->scene(), quantity);
}

/// "relative" or "absolute" and how much; relative 1e-6 where nothing is said.
Tolerance toleranceOf(const json &quantity, const json &tol)
{
   for (const json &from : {quantity.value("tolerance", json::object()), tol}) {
      if (from.contains("absolute"))
         return Tolerance::absolute(from.at("absolute"));
      if (from.contains("relative"))
         return Tolerance::relative(from.at("relative"));
   }
   return Tolerance::relative(1e-6);
}

Status answerQuantities(const json &content, const Bench &bench, const Hierarchy &hierarchy,
                        const Setup &setup, Findings &findings)
{
   std::map<std::string, DesignRuns> runs;
   const auto runsOf = [&](const std::string &model) -> DesignRuns & {
      Values values = setup.solverValues;
      if (!model.empty())
         for (const auto &[name, value] : modelValues(model))
            values.insert_or_assign(name, value);
      return runs.try_emplace(model, bench, hierarchy, setup, std::move(values)).first->second;
   };
   const json &quantities = content.at("quantities");
   for (std::size_t q = 0; q < quantities.size(); ++q) {
      const json &quantity = quantities[q], &expected = quantity.at("expected");
      const auto wanted = wantedOf(quantity.at("quantity"));
      if (!wanted)
         return wanted.error();
      const auto one = [&](const std::string &path, const std::string &model) {
         const auto value = runsOf(model).value(*wanted);
         if (value)
            findings.compare(path, *value, toleranceOf(quantity, content.value("tol", json::object())));
         else
            findings.fail(path, value.error().message);
      };
      const std::string path = fmt::format("quantities.{}.expected", q);
      if (expected.is_number())
         one(path, "");
      else
         for (const auto &[model, number] : expected.items())
            one(path + "." + model, model);
   }
   return {};
}

} // namespace

Status answerDesign(const Case &one, const Bench &bench, Findings &findings)
{
   const auto opened = readDesign(one.content.at("design").dump(), one.file.string(), *bench.job);
   if (!opened)
      return opened.error();
   const auto lattice = Lattice::make(*bench.catalogue, opened->design.model.lattice, *bench.job);
   if (!lattice)
      return lattice.error();
   const Hierarchy hierarchy(*lattice, opened->design.model);
   return answerQuantities(one.content, bench, hierarchy, opened->design.setup, findings);
}

} // namespace diatom
