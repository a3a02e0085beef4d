// What the vector kernel is given: bonds in blocks of sixteen, cells in chunks, plain arrays for both.
#pragma once

#include "model/assembly.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bonds {

/// Bonds of a block lie side by side or are listed. All instruction sets sum in the order of blocks, so that
/// none changes a bit.
inline constexpr std::uint32_t kBlock = 16;
/// Cells whose forces are added up before they move.
inline constexpr std::uint32_t kChunk = 64;

/// Up to sixteen bonds along one direction between cells lo + i and hi + i, or places lo + i of the list.
struct Run
{
   std::uint32_t lo = 0, hi = 0;
   std::uint32_t constants = 0; // place in the pool
   std::uint32_t rest = 0;      // place in the actuated rest shape
   std::uint32_t frame = 0;     // number of the bond's frame; only askew
   std::uint16_t lanes = 0;     // bit by bit, the bonds that are there
   std::uint8_t axis = 0;       // 3 = askew
   std::uint8_t flags = 0;

   static constexpr std::uint8_t uniform = 1; // one set of constants for all
   static constexpr std::uint8_t listed = 2;  // what is not there comes last
   static constexpr std::uint8_t coupled = 4, actuated = 8;
   static constexpr std::uint8_t ascending = 16; // listed in ascending order at both ends, none twice
   /// The first half, or the second, has no bond that is coupled or actuated.
   static constexpr std::uint8_t plainFirst = 32, plainSecond = 64;
};

/// Constants of a bond in the pool, in this order; each takes one place, or sixteen where the run is not
/// uniform.
enum Constant : std::uint8_t { kLength, kAxial, kTorsion = 4, kCoupling = 7, kDamping = 9, kConstants = 15 };

/// Forces that cross from another tile are added to cells cell + i.
struct Crossing
{
   std::int32_t cell = 0; // below 0 where only later lanes are there
   std::uint32_t slot = 0;
   std::uint16_t lanes = 0;
   std::uint8_t atHi = 0;
};

struct Chunk
{
   std::uint32_t cells = 0; // first cell
   std::uint32_t runs = 0, crossings = 0;
};

/// Cells that one thread moves at a time; its chunks are [chunks, next tile's chunks).
struct Tile
{
   std::uint32_t chunks = 0, chunksEnd = 0;
   std::uint32_t cells = 0, cellsEnd = 0; // without padding
   std::uint32_t cross = 0, crossEnd = 0; // runs to other tiles
};

/// Where forces at the far ends of a tile's bonds wait; it moves on with the chunks, unless it holds all.
struct Window
{
   Window(const Tile &tile, std::size_t span) : reach(span + kChunk + 2 * kBlock)
   {
      const std::size_t all = tile.cellsEnd - tile.cells + 2 * kBlock, most = 3 * reach + 5 * kBlock;
      moves = all > most;
      stride = moves ? most : all;
   }
   std::size_t reach;  // places from a chunk's first cell to the last that its bonds reach
   std::size_t stride; // of six columns
   bool moves;
};

/// Of cells that are no cubes: inertia of a ball and its inverse; an axis x y z at rest, how much more the
/// inertia is about it, and how much more the inverse; another such axis. Two axes are enough for any
/// inertia, one where two of its principal values are alike.
enum BoxColumn : std::uint8_t { kBall, kFirstAxis = 2, kSecondAxis = 7, kBoxColumns = 12 };

/// What a step does with the forces.
struct Move
{
   double kick = 0, drift = 0; // s
   bool predict = false;       // kicked velocities go to `rate` only

   /// A stage (stages.h) instead: what it weighs in the step, and how far the next one is ahead
   /// of the start (s); the last one ends the step of `drift`.
   bool stage = false, first = false, last = false;
   double weight = 0, next = 0;
};

/// Places of the state: displacement, turn (w x y z), velocity, spin, each `stride` apart.
template<typename T>
struct SweepWork
{
   const Run *runs = nullptr;
   const Chunk *chunks = nullptr; // and one past the last
   const Crossing *crossings = nullptr;
   const std::uint32_t *listLo = nullptr, *listHi = nullptr;
   const T *pool = nullptr, *rest = nullptr, *frames = nullptr;

   T *state = nullptr;
   std::size_t stride = 0;
   T *rate = nullptr;                  // velocities and spins that dampers see: six columns, `stride` apart
   T *start = nullptr, *sum = nullptr; // of stages: columns like those of the state
   const T *inverseMass = nullptr, *inverseInertia = nullptr;
   const std::uint8_t *held = nullptr;
   const T *boxes = nullptr; // of cells that are no cubes: columns by BoxColumn; else null
   bool twoAxes = false;     // whether boxes have a second axis
   const T *loads = nullptr; // six columns, null without loads
   T gravity[3]{}, drag = 0;

   T *slots = nullptr; // forces of crossing bonds: 6 at lo, 6 at hi, each `slotStride` apart
   std::size_t slotStride = 0;
   std::uint32_t firstCross = 0; // run; each later one has sixteen slots
   std::uint32_t span = 0;       // most places between the two ends of a bond

   /// Called with the chunk's cells and forces (six columns at lo, kChunk apart; at hi, hiStride apart)
   /// before the kick, and after it; null without.
   void (*beforeKick)(void *, std::uint32_t, std::uint32_t, T *, const T *, std::size_t) = nullptr;
   void (*afterKick)(void *, std::uint32_t, std::uint32_t) = nullptr;
   void *context = nullptr;
};

struct SweepSums
{
   double power = 0; // W that bonds dissipate
   double drag = 0;  // W that drag dissipates
   double load = 0;  // W that loads do, at the velocities of the drift
};

template<typename T>
struct SweepKernel
{
   /// Forces of the tile's bonds, then its cells move. `room`: six columns of the tile's Window.
   void (*tile)(const SweepWork<T> &, const Tile &, const Move &, T *room, SweepSums &);
   /// Forces of bonds to other tiles.
   void (*cross)(const SweepWork<T> &, const Tile &, SweepSums &);
   /// The tile's cells move on without forces.
   void (*drift)(const SweepWork<T> &, const Tile &, double dt);
   const char *instructions;
};

/// Which of the kernels that were built: `fused` ones multiply and add with one rounding.
struct KernelChoice
{
   bool damped = false, small = false, fused = true; // small: turns count to first order only
   Options::Instructions atMost = Options::Instructions::best;
};

/// The kernel for the best instructions that this machine has and that are allowed, and their name.
template<typename T>
SweepKernel<T> sweepKernel(const KernelChoice &choice);
template<>
SweepKernel<float> sweepKernel<float>(const KernelChoice &choice);
template<>
SweepKernel<double> sweepKernel<double>(const KernelChoice &choice);

} // namespace bonds
