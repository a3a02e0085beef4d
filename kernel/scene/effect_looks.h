// What the rows of the effects table look at, and the rows that depend on materials alone.
#pragma once

#include "scene/effects.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace diatom {

inline constexpr std::size_t kEvidence = 3;

struct Look
{
   const Hierarchy &hierarchy;
   const Setup &setup;
   const Networks &networks;
   Analysis analysis;
};

struct Verdict
{
   bool on = false;
   std::string why;
   std::vector<Index> evidence;
};

/// Up to a few cells; one that turns up late in a very large design is not found.
std::vector<Index> cellsWhere(const Look &look, const std::function<bool(Cell)> &wanted);

/// Materials in use for which `holds`, with up to a few cells of them.
struct MaterialEvidence
{
   std::vector<std::string> ids;
   std::vector<Index> cells;

   std::string names() const;
};

MaterialEvidence materialsWhere(const Look &look, bool (*holds)(const Material &));

/// Damping and drag slow motion, which an analysis of the balance does not have.
std::optional<Verdict> withoutMotion(const Look &look);

Verdict lookDamping(const Look &look);
Verdict lookOrientation(const Look &look);
Verdict lookSolid(const Look &look);
Verdict lookPoisson(const Look &look);

} // namespace diatom
