// What accuracy costs on a scene: error and time of a named quantity over integrators, steps, precisions,
// gradients, beam theories and resolutions, against an exact answer or a converged run.
#pragma once

#include "document/design.h"
#include "study/convergence.h"
#include "study/settings.h"
#include "study/trial.h"

#include <optional>
#include <string>
#include <vector>

namespace diatom {

struct AccuracyRequest
{
   double until = 0; // s; 0 = long enough to see the scene move and turn back
   std::optional<Quantity>
       quantity;                    // nothing = that of the design's reference, else the cell that moves most
   double tolerance = 0.01;         // relative error to stay within
   double budget = 60;              // s of wall time, roughly; what does not fit is left out and told
   int repeats = 3;                 // timings per row, of which the median counts
   std::vector<int> resolutions{1}; // cells along an edge that each cell becomes
   std::vector<CellModel> models;   // to try beside the scene's own, where nothing moves
};

/// Answers that rows are held against.
struct AccuracyReference
{
   bool exact = false;             // from the design, else a converged run of this study
   double value = 0;               // at the end, or the quantity's one value
   std::string source;             // who says so, or which run
   std::optional<double> ownError; // relative, of a converged run: by Richardson
   std::optional<double> order;    // observed
   bool asymptotic = false;        // the runs that it comes from do converge
   /// Relative, of a run that others do not converge to: what the finest runs differ by. Errors below it mean
   /// nothing.
   std::optional<double> disagreement;
   std::string doubt; // why not
};

struct AccuracyRow
{
   std::string analysis; // "dynamics", "statics", "modes"
   std::string setting;  // for people
   Values values;
   int resolution = 1;
   double fraction = 0; // of the stable step; 0 where there is none
   double step = 0;     // s
   std::int64_t steps = 0, cells = 0;
   double value = 0;            // of the quantity at the end
   std::optional<double> error; // relative; nothing where the run failed
   double seconds = 0;          // median of the repeats
   double nsPerCellStep = 0;
   int repeats = 0;
   bool onFront = false;
   std::string note; // why there is no error
};

struct AccuracyStudy
{
   std::string scene;
   Quantity quantity;
   double until = 0, tolerance = 0, scale = 0; // s; relative; the value that errors are relative to
   AccuracyReference reference;
   std::vector<AccuracyRow> rows;
   int cheapest = -1; // row within the tolerance in the least time; -1 when there is none
   /// What a careful user without a study would take: the finest resolution, the scene's own integrator and
   /// precision, and a ninth of the stable step. Where nothing moves at the end and cells are cut, the
   /// balance of forces at the finest resolution.
   int careful = -1;
   /// How much more the result changes than what a scene is made of, of which one part in 10^9 was changed;
   /// nothing where it was not tried.
   std::optional<double> sensitivity;
   double seconds = 0;             // the study took
   std::vector<std::string> notes; // what was left out, and why

   /// How many times faster the cheapest row is than the careful one.
   std::optional<double> gain() const;
};

/// Sensitivity from which a scene is called chaotic: an error of single precision, 1e-7, becomes one of 1e-3.
inline constexpr double kChaotic = 1e4;

/// Errors: nothing moves; the quantity's cell missing; the scene cannot be run at all; cancelled.
Result<AccuracyStudy> studyAccuracy(const std::shared_ptr<const Catalogue> &catalogue, const Design &design,
                                    const AccuracyRequest &request, const Job &job);

} // namespace diatom
