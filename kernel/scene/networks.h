// Conductor networks: which cells are wired together, what drives each, and what is wrong with the wiring.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "scene/setup.h"

#include <string>
#include <vector>

namespace diatom {

/// A fault or doubt in a design, with the cells that show it and what to do.
struct Problem
{
   enum class Severity { warning, error };
   Severity severity = Severity::warning;
   std::string kind; // stable word, e.g. "two-sources", "floating-actuator"
   std::string text; // one sentence with the remedy
   std::vector<Index> cells;
};

struct Network
{
   std::vector<Index> cells;     // sorted
   std::vector<int> sources;     // into Setup::sources
   std::vector<Index> actuators; // driven by it
};

struct DrivenActuator
{
   Index cell;
   int axis = 0;             // world axis 0 1 2 of its two terminals
   int netA = -1, netB = -1; // at the - and + terminal
};

struct Networks
{
   std::vector<Network> nets; // ordered by their smallest cell
   std::vector<DrivenActuator> actuators;
   std::vector<Problem> problems;
};

/// One-net rule of the earlier programs (amoeba.md 5.1): an actuator between two conductors of one and the
/// same net is driven by that net's potential against ground; between two nets, by their difference.
Networks findNetworks(const Hierarchy &hierarchy, const Setup &setup, const Job &job);

} // namespace diatom
