// The runs behind an accuracy study: which are made, in what order, within which time.
#pragma once

#include "study/accuracy_probe.h"
#include "study/accuracy_study.h"
#include "study/still_trial.h"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace diatom {

struct AccuracyPlan
{
   AccuracyRequest request;
   Quantity quantity;
   double until = 0; // s
};

/// A scene as it is or cut finer, and modelled as it is or otherwise.
struct SubjectVariant
{
   Subject subject;
   std::string model; // "" = as it is
};

struct AccuracyRun
{
   AccuracyRow row;
   std::size_t ladder = 0;
   std::int64_t perSample = 1;  // steps per sample
   std::optional<double> value; // the quantity's, where it has a single one
   std::optional<TrialRun> run; // of a motion
   std::vector<double> seconds; // one for each time it was run
   bool done() const { return !seconds.empty(); }
};

/// A setting: one run where nothing moves, else runs at several step lengths.
struct AccuracyLadder
{
   std::size_t variant = 0;
   Values values;
   std::string setting;
   Analysis analysis = Analysis::dynamics;
   bool own = false;              // its model is the scene's own, so that it may serve as reference
   double limit = 0;              // s, stable step; 0 = none
   double coarsest = 0;           // s, longest step tried
   std::vector<std::size_t> rows; // coarse to fine
   Convergence convergence;       // of the three finest
};

/// All runs of one study: plan(), then runAll().
class AccuracyRuns
{
public:
   AccuracyRuns(Subject subject, AccuracyPlan plan);

   /// Errors: a resolution that the scene cannot have; the solver refuses the scene.
   Status plan(const Job &job);
   /// Runs everything once, then again for timing as long as the budget lasts. Errors: cancelled; nothing
   /// could be run.
   Status runAll(const Job &job);

   const AccuracyPlan &request() const { return m_plan; }
   const std::vector<SubjectVariant> &variants() const { return m_variants; }
   std::vector<AccuracyLadder> &ladders() { return m_ladders; }
   std::vector<AccuracyRun> &runs() { return m_runs; }
   const std::vector<std::string> &notes() const { return m_notes; }
   double spent() const; // s since the plan was made
   /// The value a history gives for the quantity.
   std::optional<double> valueOf(const History &history) const;

private:
   Status addVariants(const Job &job);
   void planStill(std::size_t variant);
   Status planMotion(std::size_t variant, const Job &job);
   /// `longest` stable step of all, s; 0 without any.
   void addSteps(double longest);
   Status run(AccuracyRun &one, const Job &job);
   double predictedSeconds(const AccuracyRun &one) const;
   const SubjectVariant &variantOf(const AccuracyLadder &ladder) const { return m_variants[ladder.variant]; }

   std::vector<SubjectVariant> m_variants;
   AccuracyPlan m_plan;
   std::vector<Choice> m_choices;
   std::vector<AccuracyLadder> m_ladders;
   std::vector<AccuracyRun> m_runs;
   std::int64_t m_samples = 1;
   std::vector<std::string> m_notes;
   std::chrono::steady_clock::time_point m_start;
};

} // namespace diatom
