// One pass over a tile: the bonds of a chunk of cells, each once, then the chunk moves while it is still in
// the cache. Bonds reach forward only, so that a chunk's forces are complete when its own bonds are done.
// Included once per instruction set and type.
#if defined(BONDS_SWEEP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BONDS_SWEEP_INL_H
#undef BONDS_SWEEP_INL_H
#else
#define BONDS_SWEEP_INL_H
#endif

#include "explicit/moves-inl.h"
#include "explicit/runs-inl.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace bonds::HWY_NAMESPACE {

template<class K, typename T>
void drift(const SweepWork<T> &work, const Tile &tile, double dt)
{
   const Lanes<T> d;
   for (std::size_t cell = tile.cells; cell < tile.cellsEnd; cell += hn::Lanes(d)) {
      T *const at = work.state + cell;
      driftCells<K>(d, work, cell, three(d, at + 7 * work.stride, work.stride, kWorld),
                    three(d, at + 10 * work.stride, work.stride, kWorld), dt);
   }
}

template<class D, typename T = hn::TFromD<D>>
void addCrossings(D d, const SweepWork<T> &work, const Chunk *chunk, T *atLo)
{
   constexpr std::uint16_t kAll = 0xffff;
   for (std::uint32_t c = chunk[0].crossings; c < chunk[1].crossings; ++c) {
      const Crossing &one = work.crossings[c];
      const T *slot = work.slots + one.slot + (one.atHi ? 6 * work.slotStride : 0);
      const std::ptrdiff_t to = one.cell - static_cast<std::ptrdiff_t>(chunk->cells);
      for (std::size_t k = 0; one.lanes == kAll && k < 6; ++k)
         for (std::size_t i = 0; i < kBlock; i += hn::Lanes(d)) {
            T *const at = atLo + k * kChunk + to + i;
            hn::StoreU(hn::Add(hn::LoadU(d, at), hn::LoadU(d, slot + k * work.slotStride + i)), d, at);
         }
      for (int k = 0; one.lanes != kAll && k < 6; ++k)
         for (std::size_t i = 0; i < kBlock; ++i)
            if (one.lanes >> i & 1)
               atLo[k * kChunk + to + static_cast<std::ptrdiff_t>(i)] += slot[k * work.slotStride + i];
   }
}

/// Brings what a later chunk touches first into the cache: places at the far ends of its longest bonds,
/// velocities and masses. So many columns are more than the processor follows by itself, and asked for all at
/// once they fill its queue of misses: a few go with each run.
template<typename T>
class Ahead
{
public:
   Ahead(const SweepWork<T> &work, std::size_t first, std::uint32_t runs, bool damped)
       : m_each((kColumns + runs) / (runs + 1))
   {
      const std::size_t far = first + work.span;
      for (std::size_t k = 0; k < 13; ++k)
         m_columns[k] = work.state + k * work.stride + (k < 7 || damped ? far : first);
      m_columns[13] = work.inverseMass + first;
      m_columns[14] = work.inverseInertia + first;
   }
   HWY_INLINE void fetchSome()
   {
      for (const std::size_t end = std::min(m_at + m_each, kColumns); m_at < end; ++m_at)
         for (std::size_t i = 0; i < kChunk; i += 64 / sizeof(T))
            hwy::Prefetch(m_columns[m_at] + i);
   }

private:
   static constexpr std::size_t kColumns = 15;
   std::size_t m_each, m_at = 0;
   const T *m_columns[kColumns];
};

template<class K, typename T>
void tile(const SweepWork<T> &work, const Tile &one, const Move &move, T *room, SweepSums &sums)
{
   const Lanes<T> d;
   const Window window(one, work.span);
   const std::size_t hiStride = window.stride;
   std::fill_n(room, 6 * hiStride, T(0));
   HWY_ALIGN T atLo[6 * kChunk + 2 * kBlock]; // with room for vectors that reach beyond the last
   LaneSums<T> lanes;
   std::uint32_t first = one.cells;
   for (std::uint32_t c = one.chunks; c < one.chunksEnd; ++c) {
      const Chunk *chunk = work.chunks + c;
      const std::uint32_t begin = chunk->cells, end = std::min(begin + kChunk, one.cellsEnd);
      if (window.moves && begin - first + window.reach > hiStride) {
         const std::size_t done = begin - first;
         for (int k = 0; k < 6; ++k) {
            T *column = room + k * hiStride;
            std::memmove(column, column + done, (hiStride - done) * sizeof(T));
            std::fill(column + (hiStride - done), column + hiStride, T(0));
         }
         first = begin;
      }
      Ahead<T> ahead(work, begin + 2 * kChunk, chunk[1].runs - chunk[0].runs, K::damped);
      std::memset(atLo, 0, sizeof atLo);
      for (std::uint32_t r = chunk[0].runs; r < chunk[1].runs; ++r) {
         ahead.fetchSome();
         addRun<K>(d, work, work.runs[r], atLo, kChunk, room, hiStride, begin, first, lanes.power);
      }
      ahead.fetchSome();
      if (chunk[0].crossings != chunk[1].crossings)
         addCrossings(d, work, chunk, atLo);
      const T *atHi = room + (begin - first);
      if (work.beforeKick)
         work.beforeKick(work.context, begin, end, atLo, atHi, hiStride);
      const std::size_t step = hn::Lanes(d);
      for (std::size_t cell = begin; cell < end; cell += step)
         moveCells<K>(d, work, cell, move, atLo + (cell - begin), atHi + (cell - begin), hiStride, lanes,
                      (cell - begin) % kBlock);
      if (work.afterKick && !move.predict && !move.stage) {
         work.afterKick(work.context, begin, end);
         if (move.drift > 0)
            for (std::size_t cell = begin; cell < end; cell += step) {
               T *const at = work.state + cell;
               driftCells<K>(d, work, cell, three(d, at + 7 * work.stride, work.stride, kWorld),
                             three(d, at + 10 * work.stride, work.stride, kWorld), move.drift);
            }
      }
      if constexpr (K::damped)
         sums.power += total(lanes.power);
      if (work.drag != 0)
         sums.drag += total(lanes.drag);
      if (work.loads)
         sums.load += total(lanes.load);
   }
}

template<class K, typename T>
void cross(const SweepWork<T> &work, const Tile &tile, SweepSums &sums)
{
   const Lanes<T> d;
   HWY_ALIGN T power[kBlock] = {};
   for (std::uint32_t r = tile.cross; r < tile.crossEnd; ++r) {
      const Run &run = work.runs[r];
      T *lo = work.slots + static_cast<std::size_t>(r - work.firstCross) * kBlock,
        *hi = lo + 6 * work.slotStride;
      for (int k = 0; k < 12; ++k)
         std::fill_n(lo + k * work.slotStride, kBlock, T(0));
      if (run.flags & Run::listed)
         listedRun<K>(d, work, run, lo, work.slotStride, hi, work.slotStride, 0, 0, true, power);
      else
         addRun<K>(d, work, run, lo, work.slotStride, hi, work.slotStride, run.lo, run.hi, power);
   }
   sums.power += total(power);
}

template<typename T, class K>
SweepKernel<T> kernelWith()
{
   return {&tile<K, T>, &cross<K, T>, &drift<K, T>, hwy::TargetName(HWY_TARGET)};
}

template<typename T, bool kDamped, bool kSmall>
SweepKernel<T> kernelWith(bool fused)
{
   return fused ? kernelWith<T, Kind<kDamped, kSmall, true>>()
                : kernelWith<T, Kind<kDamped, kSmall, false>>();
}

template<typename T>
SweepKernel<T> kernelOf(const KernelChoice &choice)
{
   if (choice.small)
      return choice.damped ? kernelWith<T, true, true>(choice.fused)
                           : kernelWith<T, false, true>(choice.fused);
   return choice.damped ? kernelWith<T, true, false>(choice.fused)
                        : kernelWith<T, false, false>(choice.fused);
}

} // namespace bonds::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
