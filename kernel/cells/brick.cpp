// Bricks of 16^3 cells: palette, packed numbers, count and tight bounds.
#include "cells/tree.h"

#include <algorithm>

namespace diatom::detail {

namespace {

constexpr std::size_t wordsFor(int log) { return (std::size_t{kBrickCells} << log) / 64; }

/// Whether a cell of the slab [low, high] of brick coordinates is not empty.
bool occupied(const Brick &brick, const std::array<unsigned, 3> &low, const std::array<unsigned, 3> &high)
{
   for (unsigned x = low[0]; x <= high[0]; ++x)
      for (unsigned y = low[1]; y <= high[1]; ++y)
         for (unsigned z = low[2]; z <= high[2]; ++z)
            if (brick.at(x << 8 | y << 4 | z) != 0)
               return true;
   return false;
}

} // namespace

Brick::Brick(std::uint32_t value, Coord origin) : Node(0)
{
   allocate(0);
   palette.reserve(2);
   palette.push_back({value, kBrickCells});
   if (value != 0) {
      count = kBrickCells;
      bounds = blockBox(origin, 0);
   }
}

Brick::Brick(const std::uint32_t *cells, Coord origin) : Node(0) { encode(cells, origin); }

Brick::Brick(const Brick &other) : Node(0), palette(other.palette), mask(other.mask), widthLog(other.widthLog)
{
   count = other.count;
   bounds = other.bounds;
   words = std::make_unique_for_overwrite<std::uint64_t[]>(wordsFor(widthLog));
   std::copy_n(other.words.get(), wordsFor(widthLog), words.get());
}

void Brick::allocate(int log)
{
   widthLog = log;
   mask = log == kRaw ? ~std::uint32_t{0} : (1U << (1U << log)) - 1;
   words = std::make_unique<std::uint64_t[]>(wordsFor(log));
}

void Brick::put(unsigned cell, std::uint32_t number)
{
   const unsigned bit = cell << widthLog;
   std::uint64_t &word = words[bit >> 6];
   word = (word & ~(std::uint64_t{mask} << (bit & 63))) | (std::uint64_t{number} << (bit & 63));
}

void Brick::decode(std::uint32_t *cells) const
{
   const unsigned width = 1U << widthLog, perWord = 64 / width;
   for (std::size_t w = 0; w < wordsFor(widthLog); ++w) {
      std::uint64_t word = words[w];
      for (unsigned k = 0; k < perWord; ++k, word >>= width) {
         const std::uint32_t n = static_cast<std::uint32_t>(word) & mask;
         *cells++ = widthLog == kRaw ? n : palette[n].value;
      }
   }
}

void Brick::encode(const std::uint32_t *cells, Coord origin)
{
   std::array<std::uint8_t, kBrickCells> numbers{};
   palette.clear();
   std::size_t last = 0;
   bool raw = false;
   count = 0;
   bounds = Box();
   for (unsigned c = 0; c < kBrickCells; ++c) {
      const std::uint32_t value = cells[c];
      if (value != 0) {
         ++count;
         bounds.extend(brickIndex(origin, c));
      }
      if (raw)
         continue;
      if (palette.empty() || palette[last].value != value) {
         last = static_cast<std::size_t>(
            std::find_if(palette.begin(), palette.end(), [&](const Entry &e) { return e.value == value; }) -
            palette.begin());
         if (last == palette.size() && last == 256) {
            raw = true;
            continue;
         }
         if (last == palette.size())
            palette.push_back({value, 0});
      }
      ++palette[last].uses;
      numbers[c] = static_cast<std::uint8_t>(last);
   }
   if (raw)
      palette.clear();
   const std::size_t n = palette.size();
   allocate(raw ? kRaw : n <= 2 ? 0 : n <= 4 ? 1 : n <= 16 ? 2 : 3);
   for (unsigned c = 0; c < kBrickCells; ++c)
      put(c, raw ? cells[c] : numbers[c]);
}

void Brick::widen()
{
   const auto old = std::move(words);
   const int oldLog = widthLog;
   const std::uint32_t oldMask = mask;
   allocate(oldLog == 3 ? kRaw : oldLog + 1);
   for (unsigned c = 0; c < kBrickCells; ++c) {
      const unsigned bit = c << oldLog;
      const std::uint32_t n = static_cast<std::uint32_t>(old[bit >> 6] >> (bit & 63)) & oldMask;
      put(c, widthLog == kRaw ? palette[n].value : n);
   }
   if (widthLog == kRaw)
      palette.clear();
}

std::uint32_t Brick::entryFor(std::uint32_t value)
{
   std::size_t unused = palette.size();
   for (std::size_t n = 0; n < palette.size(); ++n) {
      if (palette[n].value == value)
         return static_cast<std::uint32_t>(n);
      if (palette[n].uses == 0)
         unused = n;
   }
   if (unused == palette.size()) {
      if (palette.size() > mask)
         widen();
      if (widthLog == kRaw)
         return value;
      palette.push_back({});
   }
   palette[unused] = {value, 0};
   return static_cast<std::uint32_t>(unused);
}

Change Brick::set(unsigned cell, Index i, std::uint32_t value)
{
   const std::uint32_t oldNumber = number(cell);
   const std::uint32_t old = widthLog == kRaw ? oldNumber : palette[oldNumber].value;
   if (old == value)
      return {};
   if (widthLog != kRaw)
      --palette[oldNumber].uses;
   const std::uint32_t n = widthLog == kRaw ? value : entryFor(value);
   put(cell, n);
   if (widthLog != kRaw)
      ++palette[n].uses;
   const int added = (value != 0) - (old != 0);
   count += static_cast<std::uint64_t>(static_cast<std::int64_t>(added));
   if (added > 0)
      bounds.extend(i);
   else if (added < 0)
      shrinkBounds(i);
   return {true, added};
}

void Brick::shrinkBounds(Index erased)
{
   if (count == 0) {
      bounds = Box();
      return;
   }
   const Coord low = biased(bounds.min), high = biased(bounds.max), at = biased(erased);
   std::array<unsigned, 3> a{low.x & 15, low.y & 15, low.z & 15}, b{high.x & 15, high.y & 15, high.z & 15};
   const std::array<unsigned, 3> e{at.x & 15, at.y & 15, at.z & 15};
   const Index origin = unbiased(blockOrigin(at, 0));
   for (unsigned axis = 0; axis < 3; ++axis) {
      if (e[axis] == b[axis]) {
         auto from = a;
         for (from[axis] = b[axis]; !occupied(*this, from, b); from[axis] = b[axis])
            --b[axis];
      }
      if (e[axis] == a[axis]) {
         auto to = b;
         for (to[axis] = a[axis]; !occupied(*this, a, to); to[axis] = a[axis])
            ++a[axis];
      }
   }
   const auto index = [&](const std::array<unsigned, 3> &v) {
      return origin + Index{static_cast<int>(v[0]), static_cast<int>(v[1]), static_cast<int>(v[2])};
   };
   bounds = {index(a), index(b)};
}

bool Brick::isUniform(std::uint32_t &value) const
{
   if (count != 0 && count != kBrickCells)
      return false;
   value = at(0);
   if (widthLog != kRaw)
      return palette[number(0)].uses == kBrickCells;
   for (unsigned c = 1; c < kBrickCells; ++c)
      if (at(c) != value)
         return false;
   return true;
}

std::uint64_t Brick::bytes() const
{
   return sizeof *this + palette.capacity() * sizeof(Entry) + wordsFor(widthLog) * sizeof(std::uint64_t);
}

} // namespace diatom::detail
