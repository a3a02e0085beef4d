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
   std::vector<Index> actuators; // driven by it
   /// Into Setup::sources: those that are part of the net or touch it with their + terminal.
   std::vector<int> sources;
   /// Into Setup::sources: those that touch it with their - terminal and drive it inverted.
   std::vector<int> returns;

   /// What sets its potential: index into Setup::sources, -1 when nothing does or several sources are in
   /// conflict.
   int source() const
   {
      if (sources.size() + returns.size() != 1)
         return -1;
      return sources.empty() ? returns.front() : sources.front();
   }
   bool inverted() const { return sources.empty() && !returns.empty(); }
};

struct DrivenActuator
{
   Index cell;
   int axis = 0; // world axis 0 1 2 of its two terminals
   /// At the - and + terminal; one and the same when the net's potential drives it against ground.
   int netA = -1, netB = -1;
};

struct Networks
{
   std::vector<Network> nets; // ordered by their smallest cell
   std::vector<DrivenActuator> actuators;
   std::vector<Problem> problems;
};

/// Cells conduct to each other where the lattice joins them and, on cells that are boxes, where both have a
/// port. One-net rule of the earlier programs (amoeba.md 5.1): an actuator whose axis comes from its wires
/// and that lies between two conductors of one and the same net is driven by that net's potential against
/// ground; between two nets, by their difference. An actuator with terminals of its own must lie between two
/// nets. A source with exactly two ports has two terminals and is no part of a net; any other is a conductor
/// of its net. A design that cannot be examined (too many electrical cells, cancelled) gives no nets and the
/// problem "not-examined".
Networks findNetworks(const Hierarchy &hierarchy, const Setup &setup, const Job &job);

/// Potential of a source at a time (amoeba.md 5.3): V, within +-amplitude / 2.
double sourceVoltage(const Source &source, double time);
/// Potential of a net at a time; 0 where nothing drives it.
double netVoltage(const Network &net, const Setup &setup, double time);

} // namespace diatom
