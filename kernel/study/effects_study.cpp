#include "study/effects_study.h"

#include "core/clock.h"
#include "core/text.h"
#include "plugins/warnings.h"
#include "study/effects_scenes.h"
#include "study/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace diatom {

namespace {

constexpr double kLeastTurn = 2e-3; // s, of the fastest scene of a row: a clock's own error is nothing to it
constexpr double kStep = 0.45;      // of the shortest stable step of a row's scenes: no accuracy is asked for

Result<Subject> subjectOf(const std::shared_ptr<const Catalogue> &catalogue, const Design &design,
                          const Job &job)
{
   const auto lattice = Lattice::make(*catalogue, design.model.lattice, job);
   if (!lattice)
      return lattice.error();
   return Subject{catalogue, std::make_shared<const Hierarchy>(*lattice, design.model), design.setup, 1};
}

/// Simulations that take turns, so that a busy moment of the machine falls on all alike.
class Race
{
public:
   Race(const std::shared_ptr<const Catalogue> &catalogue, const EffectsRequest &request, const Job &job)
       : m_catalogue(catalogue), m_request(request), m_job(job)
   {}

   Status enter(const Design &design);
   Status run();
   std::int64_t cells() const { return m_simulations.front()->scene().cells(); }
   /// ns per cell-step, median over the turns.
   double cost(std::size_t runner) const
   {
      return 1e9 * median(m_seconds[runner]) / static_cast<double>(cells());
   }
   Result<EffectTiming> against(std::size_t runner, std::size_t base) const;

private:
   const std::shared_ptr<const Catalogue> &m_catalogue;
   const EffectsRequest &m_request;
   const Job &m_job;
   std::vector<Subject> m_subjects;
   std::vector<std::unique_ptr<Simulation>> m_simulations;
   std::vector<std::vector<double>> m_seconds; // of a step, by runner and turn
   RemarksMuted m_muted;                       // a scene without rotation is run to see what rotation costs
};

Status Race::enter(const Design &design)
{
   auto subject = subjectOf(m_catalogue, design, m_job);
   if (!subject)
      return subject.error();
   // Made to see whether it can be, and for its stable step.
   auto simulation = startTrial(*subject, {}, 0, m_job);
   if (!simulation)
      return simulation.error();
   m_simulations.push_back(*std::move(simulation));
   m_subjects.push_back(*std::move(subject));
   return {};
}

Status Race::run()
{
   double step = 0;
   for (const auto &one : m_simulations)
      step = step > 0 ? std::min(step, kStep * one->stableStep()) : kStep * one->stableStep();
   if (!(step > 0))
      return Error{ErrorCode::usage,
                   "the cost of effects is told by explicit steps; choose such an integrator"};
   for (std::size_t k = 0; k < m_subjects.size(); ++k) {
      auto simulation = startTrial(m_subjects[k], {}, step, m_job);
      if (!simulation)
         return simulation.error();
      m_simulations[k] = *std::move(simulation);
   }
   double fastest = std::numeric_limits<double>::infinity(), slowest = 0;
   for (const Subject &subject : m_subjects) {
      const auto time = timeStep(subject, {}, step, 1e9 * step, kLeastTurn, m_job);
      if (!time)
         return time.error();
      fastest = std::min(fastest, *time);
      slowest = std::max(slowest, *time);
   }
   const double steps =
       std::max(m_request.turnSeconds / slowest, std::min(m_request.turnSeconds, kLeastTurn) / fastest);
   const double stretch = step * std::max(1.0, std::round(steps));
   m_seconds.assign(m_simulations.size(), {});
   for (int turn = 0; turn <= m_request.turns; ++turn)
      for (std::size_t k = 0; k < m_simulations.size(); ++k) {
         Simulation &one = *m_simulations[k];
         const std::int64_t before = one.steps();
         const double start = one.wallSeconds();
         if (Status advanced = one.advance((turn + 1) * stretch, m_job); !advanced)
            return advanced;
         const double seconds = one.wallSeconds() - start;
         if (turn > 0) // the first warms up
            m_seconds[k].push_back(seconds / static_cast<double>(one.steps() - before));
      }
   return {};
}

Result<EffectTiming> Race::against(std::size_t runner, std::size_t base) const
{
   EffectTiming timing;
   std::vector<double> ratios;
   for (std::size_t turn = 0; turn < m_seconds[base].size(); ++turn)
      ratios.push_back(m_seconds[runner][turn] / m_seconds[base][turn]);
   timing.ratio = median(ratios);
   timing.sameBits = m_simulations[runner]->steps() == m_simulations[base]->steps();
   for (const char *name : {"position", "rotation", "velocity", "angular_velocity"}) {
      const auto a = m_simulations[base]->output(name, m_job), b = m_simulations[runner]->output(name, m_job);
      if (!a || !b)
         return a ? b.error() : a.error();
      timing.sameBits = timing.sameBits && *a == *b;
   }
   return timing;
}

Design with(const Design &design, const std::string &effect, bool on)
{
   Design other = design;
   other.setup.effects[effect] = on;
   return other;
}

/// Runs one pair of scenes; a variant that cannot be run is told in the row's note.
Result<EffectRow> study(const std::shared_ptr<const Catalogue> &catalogue, const EffectScene &scene,
                        bool switches, const EffectsRequest &request, const Job &job)
{
   EffectRow row;
   row.effect = scene.effect;
   row.scene = scene.what;
   Race race(catalogue, request, job);
   if (const Status entered = race.enter(scene.without); !entered)
      return entered.error();
   row.cells = race.cells();
   int places = 1, called = -1, ruledOut = -1, forcedOn = -1;
   const auto enter = [&](const Design &design, int &place) {
      const Status entered = race.enter(design);
      if (entered)
         place = places++;
      else if (&place != &forcedOn) // what only a scene can call for is not to be had for nothing
         row.note = entered.error().message;
   };
   enter(scene.calledFor, called);
   if (called > 0 && switches) {
      enter(with(scene.calledFor, scene.effect, false), ruledOut);
      if (scene.nothing)
         enter(with(scene.without, scene.effect, true), forcedOn);
   }
   if (const Status ran = race.run(); !ran)
      return ran.error();
   row.without = race.cost(0);
   if (called > 0)
      row.calledFor = race.cost(static_cast<std::size_t>(called));
   for (const auto &[place, timing] :
        {std::pair{ruledOut, &row.ruledOut}, std::pair{forcedOn, &row.forcedOn}}) {
      if (place < 0)
         continue;
      const auto found = race.against(static_cast<std::size_t>(place), 0);
      if (!found)
         return found.error();
      *timing = *found;
   }
   return row;
}

std::string timingText(const std::optional<EffectTiming> &timing)
{
   return timing ? fmt::format("{:.4f},{}", timing->ratio, timing->sameBits ? 1 : 0) : ",";
}

nlohmann::ordered_json timingJson(const std::optional<EffectTiming> &timing)
{
   return timing ? nlohmann::ordered_json{{"time_ratio", timing->ratio}, {"same_bits", timing->sameBits}}
                 : nlohmann::ordered_json();
}

/// Effects whose names planEffects() knows, but that no solver here has.
void addMissing(EffectsStudy &study)
{
   for (const std::string &name : effectNames())
      if (std::none_of(study.rows.begin(), study.rows.end(),
                       [&](const EffectRow &row) { return row.effect == name; }))
      {
         EffectRow row;
         row.effect = name;
         row.note = "not available in this version: nothing is run";
         study.rows.push_back(std::move(row));
      }
}

} // namespace

std::optional<double> EffectRow::cost() const
{
   return calledFor ? std::optional(*calledFor - without) : std::nullopt;
}

Result<EffectsStudy> studyEffects(const std::shared_ptr<const Catalogue> &catalogue,
                                  const EffectsRequest &request, const Job &job)
{
   const auto start = Clock::now();
   EffectsStudy found;
   const auto scenes = effectScenes();
   for (const EffectScene &scene : scenes) {
      job.progress(static_cast<double>(found.rows.size()) / static_cast<double>(scenes.size()), scene.effect);
      const bool switches = scene.effect != "rotation" && !scene.byMaterial;
      auto row = study(catalogue, scene, switches, request, job);
      if (!row)
         return row.error();
      found.rows.push_back(*std::move(row));
   }
   addMissing(found);
   found.seconds = secondsSince(start);
   return found;
}

Result<EffectsStudy> studyEffectsOf(const std::shared_ptr<const Catalogue> &catalogue, const Design &design,
                                    const EffectsRequest &request, const Job &job)
{
   const auto start = Clock::now();
   const auto subject = subjectOf(catalogue, design, job);
   if (!subject)
      return subject.error();
   const auto scene = Scene::build(*subject->hierarchy, subject->setup, job);
   if (!scene)
      return scene.error();
   EffectsStudy found;
   for (const Effect &effect : (*scene)->effects()) {
      if (!effect.on || !effectIsForSolver(effect.name))
         continue;
      const EffectScene pair{effect.name, effect.why, with(design, effect.name, false), design};
      auto row = study(catalogue, pair, false, request, job);
      if (!row && row.error().code == ErrorCode::cancelled)
         return row.error();
      if (row)
         found.rows.push_back(*std::move(row));
      else {
         EffectRow failed;
         failed.effect = effect.name;
         failed.note = row.error().message;
         found.rows.push_back(std::move(failed));
      }
   }
   found.seconds = secondsSince(start);
   return found;
}

std::string effectsCsv(const EffectsStudy &study)
{
   std::string csv =
       "effect,scene,cells,ns per cell-step without,ns with,cost (ns),ruled out: time ratio,ruled "
       "out: same bits,switched on for nothing: time ratio,switched on for nothing: same "
       "bits,note\n";
   for (const EffectRow &row : study.rows)
      csv += fmt::format("{},\"{}\",{},{:.2f},{},{},{},{},\"{}\"\n", row.effect, row.scene, row.cells,
                         row.without, row.calledFor ? fmt::format("{:.2f}", *row.calledFor) : "",
                         row.cost() ? fmt::format("{:.2f}", *row.cost()) : "", timingText(row.ruledOut),
                         timingText(row.forcedOn), row.note);
   return csv;
}

nlohmann::ordered_json effectsJson(const EffectsStudy &study)
{
   nlohmann::ordered_json json{{"study", "effects"}, {"seconds", study.seconds}};
   json["rows"] = nlohmann::ordered_json::array();
   for (const EffectRow &row : study.rows) {
      nlohmann::ordered_json one{
          {"effect", row.effect}, {"scene", row.scene}, {"cells", row.cells}, {"ns_without", row.without}};
      one["ns_with"] = row.calledFor ? nlohmann::ordered_json(*row.calledFor) : nlohmann::ordered_json();
      one["cost_ns"] = row.cost() ? nlohmann::ordered_json(*row.cost()) : nlohmann::ordered_json();
      one["ruled_out"] = timingJson(row.ruledOut);
      one["forced_on"] = timingJson(row.forcedOn);
      if (!row.note.empty())
         one["note"] = row.note;
      json["rows"].push_back(std::move(one));
   }
   return json;
}

} // namespace diatom
