// A solver's scene, values and channels as one block of bytes without pointers, for another process. Both
// sides are of one build: the block is memory, not a file format.
#pragma once

#include "core/result.h"

#include <diatom/abi/solver.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace diatom {

/// What goes across: values for create(), and a scene or channels alone.
struct SolverInput
{
   const diatom_values *values = nullptr;
   const diatom_scene *scene = nullptr;
   const diatom_channel *channels = nullptr; // without a scene: of apply()
   std::int64_t channelCount = 0;
};

/// Bytes that packInput() will write.
std::size_t packedSize(const SolverInput &input);
/// `room` is of that size and aligned to 64.
void packInput(const SolverInput &input, std::byte *room);

/// What lies in a block, as records that point into it: the block must stay.
class UnpackedInput
{
public:
   /// Errors: offsets or counts that lead out of the block.
   static Result<std::unique_ptr<UnpackedInput>> of(std::byte *block, std::size_t bytes);

   const diatom_values &values() const { return m_values; }
   const diatom_scene &scene() const { return m_scene; }
   const std::vector<diatom_channel> &channels() const { return m_channels; }

private:
   UnpackedInput() = default;
   diatom_values m_values{};
   diatom_scene m_scene{};
   std::vector<diatom_channel> m_channels;
   std::vector<const char *> m_valueNames, m_valueTexts, m_propertyNames, m_effects;
};

} // namespace diatom
