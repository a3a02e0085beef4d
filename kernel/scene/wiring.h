// The cells that take part in a design's wiring, and what touches what: the raw material of networks.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "core/result.h"
#include "core/vec.h"
#include "scene/cell_list.h"

#include <cstdint>
#include <vector>

namespace diatom {

inline constexpr std::uint8_t kAllPorts = 0x3f;

enum class WiringPart : std::uint8_t { conductor, twoTerminalSource, actuator };

/// A conductor at a terminal of an actuator or of a two-terminal source.
struct TerminalContact
{
   std::int32_t owner = 0, conductor = 0;
   Vec3 direction = Vec3::Zero(); // from the owner, world, unit
   int port = -1; // of the owner, in its own frame; -1 where the lattice's cells have no ports
};

/// All arrays run over the same cells.
struct Wiring
{
   CellList cells; // conductors, sources and actuators
   std::vector<WiringPart> part;
   std::vector<std::uint8_t> ports; // open ones, in the cell's own frame
   std::vector<std::uint8_t> met;   // those that meet an open one
   std::vector<bool> box;           // six faces, so that ports have a meaning
   std::vector<int> group;          // of conductors that hang together, by smallest cell; -1 = no conductor
   int groups = 0;
   std::vector<TerminalContact> contacts; // sorted by owner

   std::vector<TerminalContact> contactsOf(std::int32_t cell) const;
};

/// Errors: too many electrical cells to look at one by one, cancelled.
Result<Wiring> findWiring(const Hierarchy &hierarchy, const Job &job);

/// World axis of a unit direction, -1 when it is along none.
int axisOfDirection(const Vec3 &direction);

} // namespace diatom
