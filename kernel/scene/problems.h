// What is wrong with a design before anything is simulated: supports, loads and sources where no cell is,
// loose bodies.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "core/result.h"
#include "scene/networks.h"
#include "scene/setup.h"
#include "scene/where.h"

#include <string>
#include <vector>

namespace diatom {

/// Cells that hang together through the lattice's own connections; each body's cells sorted, bodies by
/// smallest cell.
using Bodies = std::vector<std::vector<Index>>;

/// Errors: more than `limit` cells, cancelled.
Result<Bodies> findBodies(const Hierarchy &hierarchy, const Job &job, std::int64_t limit = 20'000'000);

/// Errors "support-without-cell" (and drive-, load-, start-, field-, source-), "not-a-number",
/// "bad-curve", "bad-field", "driven-twice", and "held-and-driven".
std::vector<Problem> findSetupProblems(const Hierarchy &hierarchy, const Setup &setup);

/// Warnings "floating-body": bodies that fall for ever, as there is gravity but neither ground nor a support
/// on them.
std::vector<Problem> findFloatingBodies(const Hierarchy &hierarchy, const Bodies &bodies, const Setup &setup);

/// Warnings "not-held" and "may-turn": bodies that supports and drives leave free to move, or only to turn,
/// as a whole; the text says how. A body that may turn can still have a static balance, like a pendulum. None
/// where a ground may hold them.
std::vector<Problem> findUnheldBodies(const Hierarchy &hierarchy, const Bodies &bodies, const Setup &setup,
                                      const Job &job);

/// Refuses what has no balance of its own, before a solver is asked: ErrorCode::invalid. What may have one
/// all the same, as bodies that may turn, comes as warnings. Set-ups with problems pass: building the scene
/// tells those.
Result<std::vector<Problem>> checkHeld(const Hierarchy &hierarchy, const Setup &setup, const Job &job);

/// Up to four cells: "(1, 2, 3), (4, 5, 6) and 7 more".
std::string indicesText(const std::vector<Index> &cells);

} // namespace diatom
