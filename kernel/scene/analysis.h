// What can be asked of a solver about a scene.
#pragma once

#include <cstddef>
#include <cstdint>

namespace diatom {

enum class Analysis : std::uint8_t {
   dynamics, // motion in time
   statics,  // the balance of forces
   modes     // vibrations about that balance
};

/// As solvers know it.
constexpr const char *analysisName(Analysis analysis)
{
   constexpr const char *kNames[] = {"dynamics", "statics", "modes"};
   return kNames[static_cast<std::size_t>(analysis)];
}

} // namespace diatom
