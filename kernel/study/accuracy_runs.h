// The runs behind an accuracy study: which are made, in what order, within which time, and what each errs by.
#pragma once

#include "study/accuracy_probe.h"
#include "study/accuracy_study.h"

#include <chrono>
#include <map>
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

/// One study's runs, in three steps: planRows(), runAll(), judged().
class AccuracyRuns
{
public:
   AccuracyRuns(Subject subject, AccuracyPlan plan);

   /// Errors: a resolution that the scene cannot have; the solver refuses the scene.
   Status planRows(const Job &job);
   /// Runs every row once, then again for timing as long as the budget lasts. Errors: cancelled; nothing
   /// could be run.
   Status runAll(const Job &job);
   /// Errors against the reference, and everything but the front.
   AccuracyStudy judged();

private:
   /// A setting at several step lengths.
   struct Ladder
   {
      std::size_t resolution = 0; // into m_subjects
      Values values;
      std::string setting;
      bool reference = false;        // its model is the scene's own, so that it may serve as reference
      double limit = 0;              // s, stable step; 0 = none
      std::int64_t perSample = 1;    // steps per sample at the coarsest
      std::vector<std::size_t> rows; // into m_rows, coarse to fine
      Convergence convergence;       // of the three finest
   };
   struct Row
   {
      AccuracyRow row;
      std::size_t ladder = 0;
      std::int64_t perSample = 1;
      std::optional<TrialRun> run;
      std::vector<double> seconds;
   };

   void addLadder(Ladder ladder);
   Status runRow(Row &row, const Job &job);
   double predictedSeconds(const Row &row) const;
   double spent() const;
   void judgeLadders();
   std::optional<double> valueOf(const History &history) const;
   Convergence convergenceOfRows(const Row &a, const Row &b, const Row &c) const;
   /// The ladder whose finest run is surest, -1 when none converges.
   int surestLadder() const;
   AccuracyReference findReference();
   std::optional<double> errorOf(const Row &row) const;

   std::vector<Subject> m_subjects; // by resolution
   AccuracyPlan m_plan;
   std::vector<Choice> m_choices;
   std::vector<Ladder> m_ladders;
   std::vector<Row> m_rows;
   std::int64_t m_samples = 1;
   std::optional<double> m_referenceValue; // a single one
   std::optional<History> m_referenceHistory;
   double m_scale = 0;
   std::vector<std::string> m_notes;
   std::chrono::steady_clock::time_point m_start;
};

} // namespace diatom
