// Bricks of 16^3 cells: palette, packed numbers, count and tight bounds.
#include "cells/tree.h"

#include <algorithm>
#include <bit>

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

bool Brick::findPalette(const std::uint32_t *cells, std::uint8_t *numbers)
{
   palette.clear();
   for (unsigned c = 0; c < kBrickCells;) {
      const std::uint32_t value = cells[c];
      unsigned end = c + 1;
      while (end < kBrickCells && cells[end] == value)
         ++end;
      std::size_t n = 0;
      while (n < palette.size() && palette[n].value != value)
         ++n;
      if (n == 256)
         return false;
      if (n == palette.size())
         palette.push_back({value, 0});
      palette[n].uses += end - c;
      std::fill(numbers + c, numbers + end, static_cast<std::uint8_t>(n));
      c = end;
   }
   return true;
}

void Brick::encode(const std::uint32_t *cells, Coord origin)
{
   std::array<std::uint8_t, kBrickCells> numbers;
   const bool raw = !findPalette(cells, numbers.data());
   if (raw)
      palette.clear();
   const std::size_t n = palette.size();
   allocate(raw ? kRaw : n <= 2 ? 0 : n <= 4 ? 1 : n <= 16 ? 2 : 3);
   const unsigned width = 1U << widthLog, perWord = 64 / width;
   for (unsigned c = 0, w = 0; c < kBrickCells; ++w) {
      std::uint64_t word = 0;
      for (unsigned k = 0; k < perWord; ++k, ++c)
         word |= std::uint64_t{raw ? cells[c] : numbers[c]} << (k * width);
      words[w] = word;
   }
   measure(cells, origin);
}

void Brick::measure(const std::uint32_t *cells, Coord origin)
{
   count = 0;
   bounds = Box();
   unsigned xs = 0, ys = 0, zs = 0; // bit v: some cell has coordinate v
   for (unsigned row = 0; row < 256; ++row, cells += 16) {
      unsigned bits = 0;
      for (unsigned z = 0; z < 16; ++z)
         bits |= static_cast<unsigned>(cells[z] != 0) << z;
      if (bits == 0)
         continue;
      count += static_cast<unsigned>(std::popcount(bits));
      zs |= bits;
      xs |= 1U << (row >> 4);
      ys |= 1U << (row & 15);
   }
   if (count == 0)
      return;
   const auto low = [](unsigned v) { return static_cast<unsigned>(std::countr_zero(v)); };
   const auto high = [](unsigned v) { return 31U - static_cast<unsigned>(std::countl_zero(v)); };
   bounds = {unbiased({origin.x + low(xs), origin.y + low(ys), origin.z + low(zs)}),
             unbiased({origin.x + high(xs), origin.y + high(ys), origin.z + high(zs)})};
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
   if (added > 0 && !bounds.contains(i))
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
