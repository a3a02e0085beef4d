// The pieces of a .vox file that reading and writing share.
#pragma once

#include "core/index.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace diatom::vox {

using Dictionary = std::map<std::string, std::string>;
/// Colours 1 to 255; element 0 is unused.
using Palette = std::array<std::array<std::uint8_t, 3>, 256>;

/// Little-endian numbers and texts out of a file. Past the end it gives zeros and failed() tells.
class Bytes
{
public:
   explicit Bytes(std::string_view bytes, std::size_t start = 0) : m_bytes(bytes), m_start(start) {}

   std::size_t start() const { return m_start; }
   std::size_t at() const { return m_start + m_at; }
   bool atEnd() const { return m_at >= m_bytes.size(); }
   bool failed() const { return m_failed; }

   std::string_view take(std::size_t count);
   void skip(std::size_t count) { take(count); }
   Bytes part(std::size_t count);
   std::int32_t number();
   Dictionary dictionary();

private:
   std::string_view m_bytes;
   std::size_t m_start, m_at = 0;
   bool m_failed = false;
};

/// A turn by quarters with mirroring, and a shift.
struct Pose
{
   std::array<std::array<int, 3>, 3> turn{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; // rows
   Index shift;

   friend Pose operator*(const Pose &outer, const Pose &inner);
   /// Where a cell of a model comes to lie: models are put by the middle of their box, rounded down.
   Index cell(Index at, Index size) const;
};

/// From "_r" and "_t" of a frame; nothing when they make no sense.
std::optional<Pose> poseOf(const Dictionary &frame);

Palette defaultPalette();
Palette readPalette(Bytes &in);

/// "color-N", and N back from it; 0 for other ids.
std::string materialId(int color);
int colorOf(std::string_view materialId);

} // namespace diatom::vox
