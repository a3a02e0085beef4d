// Cells that decompositions are tried on: blocks, random sets, bricks and composites of each lattice they
// fit.
#pragma once

#include "cells/hierarchy.h"
#include "parts/decomposition.h"
#include "plugin_check/findings.h"
#include "plugin_check/subject.h"

#include <memory>
#include <string>
#include <vector>

namespace diatom::check {

inline constexpr double kSamplePitch = 1e-3; // m

struct Sample
{
   std::string label;
   std::shared_ptr<const Hierarchy> hierarchy;
};

/// Makes samples on one lattice.
class Sampler
{
public:
   Sampler(const Subject &subject, const std::string &lattice);

   /// Why there are no samples; empty when there are.
   const std::string &why() const { return m_why; }

   Sample block(Index size) const;
   /// Cells of two materials, each there with a chance.
   Sample scattered(double chance, int number) const;
   /// A composite in a composite, beside cells of the whole.
   Sample nested() const;
   /// Runs of three cells that are placed as one, apart from each other; of lattices that have such.
   Sample bricks() const;
   std::vector<Sample> all() const;

private:
   Sample of(std::string label, Model model) const;

   const Subject &m_subject;
   Model m_empty;
   std::shared_ptr<const Lattice> m_lattice;
   std::string m_why;
};

/// Of the first lattice that the parts fit; the cube's for those that fit any.
Sampler firstSampler(const PartMaker &maker, const Subject &subject);

/// Samples of every lattice that the parts fit and that is installed; then the author's own designs.
std::vector<Sample> samplesFor(const PartMaker &maker, const Subject &subject, Findings &findings);

} // namespace diatom::check
