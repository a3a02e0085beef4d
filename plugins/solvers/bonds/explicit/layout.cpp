#include "explicit/layout.h"

#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>

namespace bonds {

namespace {

/// Cells in a cross-section of a tile: what of them waits for the next plane stays in the cache.
constexpr std::size_t kSection = 1536;
constexpr std::size_t kTileCells = 10000, kMostTiles = 16;
/// Bonds of a vector that make it worth while to compute all of its places (measured with vectors of 64
/// bytes).
constexpr int fullVector(std::uint32_t lanes) { return lanes < kBlock ? 4 : 6; }

using Place = std::array<std::int64_t, 3>;

/// Positions on a fine grid, the axis along which the shape is longest first, then the shortest.
std::vector<Place> gridPlaces(const Assembly &assembly)
{
   double unit = 1e300;
   for (const double length : assembly.constants.lengths())
      unit = std::min(unit, length);
   std::array<double, 3> low, high;
   for (int k = 0; k < 3; ++k) {
      const auto [least, most] = std::minmax_element(assembly.rest[k].begin(), assembly.rest[k].end());
      low[k] = *least;
      high[k] = *most;
   }
   const double size = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2], 1e-30});
   unit = std::clamp(unit, 1e-6 * size, size) / 64;
   std::array<int, 3> order{2, 1, 0};
   std::stable_sort(order.begin(), order.end(), [&](int i, int j) {
      return std::llround((high[i] - low[i]) / unit) > std::llround((high[j] - low[j]) / unit);
   });
   std::swap(order[1], order[2]);
   std::vector<Place> places(static_cast<std::size_t>(assembly.cells));
   for (std::size_t i = 0; i < places.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
         places[i][k] = std::llround((assembly.rest[order[k]][i] - low[order[k]]) / unit);
   return places;
}

/// Numbers the cells' values of one coordinate so that each number has about `each` cells.
std::vector<std::uint32_t> parted(const std::vector<Place> &places, std::size_t axis, std::size_t parts)
{
   std::map<std::int64_t, std::size_t> count;
   for (const Place &place : places)
      ++count[place[axis]];
   std::map<std::int64_t, std::uint32_t> part;
   std::size_t before = 0;
   for (const auto &[value, cells] : count) {
      part[value] =
          static_cast<std::uint32_t>(std::min(parts - 1, (before + cells / 2) * parts / places.size()));
      before += cells;
   }
   std::vector<std::uint32_t> out;
   for (const Place &place : places)
      out.push_back(part[place[axis]]);
   return out;
}

/// A bond as the kernel takes it, from lo to hi.
struct Bond
{
   std::uint32_t lo, hi;
   std::uint32_t way; // 0 to 2 along an axis, from 3 on frames
   std::int64_t bond;
   bool reversed;
};

class Builder
{
public:
   Builder(const Assembly &assembly, const std::vector<bool> &actuated, const std::vector<bool> &still,
           std::uint32_t lanes, Layout &out)
       : m_assembly(assembly), m_actuated(actuated), m_still(still), m_lanes(lanes), m_out(out)
   {}
   void placeCells();
   void placeBonds();

private:
   std::uint32_t wayOf(std::int64_t bond, bool reversed);
   std::uint32_t tileOf(std::uint32_t place) const;
   void addBonds(std::vector<Bond> &bonds, std::size_t first, std::size_t last);
   bool isDense(const Bond *const (&lane)[kBlock]) const;
   void addRun(const Bond *const (&lane)[kBlock], bool listed);
   std::array<double, kConstants> constantsOf(const Bond &bond) const;
   void addCrossings();

   const Assembly &m_assembly;
   const std::vector<bool> &m_actuated, &m_still;
   const std::uint32_t m_lanes;
   Layout &m_out;
   std::map<std::array<std::int64_t, 9>, std::uint32_t> m_frames;
   std::map<std::array<double, kConstants>, std::uint32_t> m_sets;
};

void Builder::placeCells()
{
   const std::vector<Place> places = gridPlaces(m_assembly);
   const std::size_t n = places.size();
   std::int64_t planes = 1;
   {
      std::vector<std::int64_t> outer;
      for (const Place &place : places)
         outer.push_back(place[0]);
      std::sort(outer.begin(), outer.end());
      planes = std::unique(outer.begin(), outer.end()) - outer.begin();
   }
   const std::size_t strips = std::max<std::size_t>(1, n / static_cast<std::size_t>(planes) / kSection);
   const std::size_t wanted = std::clamp<std::size_t>(n / kTileCells, 1, kMostTiles);
   const std::size_t slabs =
       std::clamp<std::size_t>(wanted / strips, 1, static_cast<std::size_t>((planes + 3) / 4));
   const auto strip = parted(places, 1, strips), slab = parted(places, 0, slabs);
   std::vector<std::int64_t> order(n);
   std::iota(order.begin(), order.end(), 0);
   const auto tile = [&](std::int64_t i) { return slab[i] * static_cast<std::uint32_t>(strips) + strip[i]; };
   std::sort(order.begin(), order.end(), [&](std::int64_t i, std::int64_t j) {
      return std::tuple(tile(i), places[i], i) < std::tuple(tile(j), places[j], j);
   });
   m_out.place.resize(n);
   std::uint32_t last = ~0u;
   for (const std::int64_t i : order) {
      if (tile(i) != last) {
         while (m_out.cell.size() % kBlock != 0)
            m_out.cell.push_back(-1);
         if (!m_out.tiles.empty())
            m_out.tiles.back().cellsEnd = static_cast<std::uint32_t>(m_out.cell.size());
         last = tile(i);
         m_out.tiles.push_back({});
         m_out.tiles.back().cells = static_cast<std::uint32_t>(m_out.cell.size());
      }
      m_out.place[i] = static_cast<std::uint32_t>(m_out.cell.size());
      m_out.cell.push_back(static_cast<std::int32_t>(i));
   }
   while (m_out.cell.size() % kBlock != 0)
      m_out.cell.push_back(-1);
   m_out.tiles.back().cellsEnd = static_cast<std::uint32_t>(m_out.cell.size());
   m_out.places = m_out.cell.size();
}

std::uint32_t Builder::tileOf(std::uint32_t place) const
{
   const auto next = std::upper_bound(m_out.tiles.begin(), m_out.tiles.end(), place,
                                      [](std::uint32_t p, const Tile &tile) { return p < tile.cells; });
   return static_cast<std::uint32_t>(next - m_out.tiles.begin() - 1);
}

std::uint32_t Builder::wayOf(std::int64_t bond, bool reversed)
{
   const int axis = m_assembly.axisOf(bond);
   if (axis < 3 && !reversed)
      return static_cast<std::uint32_t>(axis);
   Mat3 frame = m_assembly.frameOf(bond);
   if (reversed) { // half a turn about the third axis
      frame.r0 = -frame.r0;
      frame.r1 = -frame.r1;
   }
   const double rows[9] = {frame.r0.x, frame.r0.y, frame.r0.z, frame.r1.x, frame.r1.y,
                           frame.r1.z, frame.r2.x, frame.r2.y, frame.r2.z};
   std::array<std::int64_t, 9> key;
   for (std::size_t k = 0; k < 9; ++k)
      key[k] = std::llround(rows[k] * 1e12); // parallel bonds differ by rounding
   const auto [found, added] = m_frames.try_emplace(key, static_cast<std::uint32_t>(m_frames.size()));
   if (added)
      m_out.frames.insert(m_out.frames.end(), rows, rows + 9);
   return 3 + found->second;
}

std::array<double, kConstants> Builder::constantsOf(const Bond &bond) const
{
   const BondConstants &k = m_assembly.constants[bond.bond];
   std::array<double, kConstants> out{};
   out[kLength] = m_assembly.lengthOf(bond.bond);
   for (std::size_t j = 0; j < 3; ++j) {
      out[kAxial + j] = k.k[j];
      out[kTorsion + j] = k.c[j];
      out[kDamping + j] = k.d[j];
      out[kDamping + 3 + j] = k.e[j];
   }
   for (std::size_t j = 0; j < 2; ++j)
      out[kCoupling + j] = bond.reversed ? -k.turn[j] : k.turn[j];
   return out;
}

void Builder::addRun(const Bond *const (&lane)[kBlock], bool listed)
{
   Run run;
   const Bond *some = nullptr, *last = nullptr;
   bool uniform = true, coupled = false, actuated = false, ascending = listed, plain[2] = {true, true};
   for (std::size_t i = 0; i < kBlock; ++i) {
      if (!lane[i])
         continue;
      if (!some)
         some = lane[i];
      ascending = ascending && (!last || (last->lo < lane[i]->lo && last->hi < lane[i]->hi));
      last = lane[i];
      run.lanes = static_cast<std::uint16_t>(run.lanes | 1u << i);
      run.lo = lane[i]->lo - static_cast<std::uint32_t>(i);
      run.hi = lane[i]->hi - static_cast<std::uint32_t>(i);
      const BondConstants &k = m_assembly.constants[lane[i]->bond];
      const bool stepped = k.s[0] != 0 || k.s[1] != 0,
                 driven = !m_actuated.empty() && m_actuated[lane[i]->bond];
      coupled = coupled || stepped;
      actuated = actuated || driven;
      plain[i / (kBlock / 2)] = plain[i / (kBlock / 2)] && !stepped && !driven;
      uniform = uniform && constantsOf(*lane[i]) == constantsOf(*some);
   }
   run.axis = static_cast<std::uint8_t>(std::min<std::uint32_t>(some->way, 3));
   run.frame = some->way < 3 ? 0 : some->way - 3;
   const std::pair<bool, std::uint8_t> flags[] = {{uniform, Run::uniform},     {listed, Run::listed},
                                                  {coupled, Run::coupled},     {actuated, Run::actuated},
                                                  {ascending, Run::ascending}, {plain[0], Run::plainFirst},
                                                  {plain[1], Run::plainSecond}};
   for (const auto &[is, flag] : flags)
      run.flags = static_cast<std::uint8_t>(run.flags | (is ? flag : 0));
   if (uniform) {
      const auto set = constantsOf(*some);
      const auto [found, added] = m_sets.try_emplace(set, static_cast<std::uint32_t>(m_out.pool.size()));
      if (added)
         m_out.pool.insert(m_out.pool.end(), set.begin(), set.begin() + m_out.constants);
      run.constants = found->second;
   } else {
      run.constants = static_cast<std::uint32_t>(m_out.pool.size());
      m_out.pool.resize(m_out.pool.size() + static_cast<std::size_t>(m_out.constants) * kBlock);
      for (std::size_t i = 0; i < kBlock; ++i) {
         const auto set = constantsOf(lane[i] ? *lane[i] : *some);
         for (int j = 0; j < m_out.constants; ++j)
            m_out.pool[run.constants + static_cast<std::size_t>(j) * kBlock + i] = set[j];
      }
   }
   if (actuated) {
      run.rest = static_cast<std::uint32_t>(m_out.restPlaces);
      m_out.restPlaces += 6 * kBlock;
      for (std::size_t i = 0; i < kBlock; ++i)
         if (lane[i] && m_actuated[lane[i]->bond])
            m_out.rests.push_back({lane[i]->bond, run.rest + i, lane[i]->reversed});
   }
   if (listed) {
      run.lo = run.hi = static_cast<std::uint32_t>(m_out.listLo.size());
      for (const Bond *one : lane) {
         m_out.listLo.push_back(one ? one->lo : last->lo);
         m_out.listHi.push_back(one ? one->hi : last->hi);
      }
   }
   m_out.runs.push_back(run);
}

/// Whether the vectors that a run takes are full enough.
bool Builder::isDense(const Bond *const (&lane)[kBlock]) const
{
   int bonds = 0, vectors = 0;
   for (std::uint32_t at = 0; at < kBlock; at += m_lanes) {
      const int some = static_cast<int>(m_lanes - std::count(lane + at, lane + at + m_lanes, nullptr));
      bonds += some;
      vectors += some > 0;
   }
   return bonds >= vectors * fullVector(m_lanes);
}

/// Runs of the bonds of one chunk, which come sorted by block, way, and offset.
void Builder::addBonds(std::vector<Bond> &bonds, std::size_t first, std::size_t last)
{
   std::map<std::uint32_t, std::vector<const Bond *>> rest;
   for (std::size_t i = first; i < last;) {
      const Bond &head = bonds[i];
      const Bond *lane[kBlock] = {};
      std::size_t j = i;
      for (; j < last && bonds[j].lo / kBlock == head.lo / kBlock && bonds[j].way == head.way &&
             bonds[j].hi - bonds[j].lo == head.hi - head.lo;
           ++j)
         lane[bonds[j].lo % kBlock] = &bonds[j];
      // Two bonds between the same cells take a place each.
      const bool twice = std::count(std::begin(lane), std::end(lane), nullptr) + static_cast<int>(j - i) >
                         static_cast<int>(kBlock);
      if (!twice && isDense(lane))
         addRun(lane, false);
      else
         for (std::size_t k = i; k < j; ++k)
            rest[head.way].push_back(&bonds[k]);
      i = j;
   }
   for (auto &[way, list] : rest) {
      std::sort(list.begin(), list.end(), [](const Bond *x, const Bond *y) {
         return std::tuple(x->lo, x->hi, x->bond) < std::tuple(y->lo, y->hi, y->bond);
      });
      for (std::size_t i = 0; i < list.size(); i += kBlock) {
         const Bond *lane[kBlock] = {};
         std::copy(list.begin() + static_cast<std::ptrdiff_t>(i),
                   list.begin() + static_cast<std::ptrdiff_t>(std::min(list.size(), i + kBlock)), lane);
         addRun(lane, true);
      }
   }
}

void Builder::placeBonds()
{
   m_out.constants = m_assembly.damped ? kConstants : m_assembly.coupled ? kDamping : kCoupling;
   std::vector<Bond> inner, outer;
   for (std::int64_t i = 0; i < m_assembly.links; ++i) {
      if (m_still[m_assembly.a[i]] && m_still[m_assembly.b[i]])
         continue;
      const std::uint32_t a = m_out.place[m_assembly.a[i]], b = m_out.place[m_assembly.b[i]];
      const Bond bond{std::min(a, b), std::max(a, b), wayOf(i, a > b), i, a > b};
      const bool same = tileOf(a) == tileOf(b);
      if (same)
         m_out.span = std::max(m_out.span, bond.hi - bond.lo);
      (same ? inner : outer).push_back(bond);
   }
   for (auto *bonds : {&inner, &outer})
      std::sort(bonds->begin(), bonds->end(), [](const Bond &x, const Bond &y) {
         return std::tuple(x.lo / kBlock, x.way, x.hi - x.lo, x.lo, x.bond) <
                std::tuple(y.lo / kBlock, y.way, y.hi - y.lo, y.lo, y.bond);
      });
   std::size_t at = 0;
   for (Tile &tile : m_out.tiles) {
      tile.chunks = static_cast<std::uint32_t>(m_out.chunks.size());
      for (std::uint32_t cell = tile.cells; cell < tile.cellsEnd; cell += kChunk) {
         m_out.chunks.push_back({cell, static_cast<std::uint32_t>(m_out.runs.size()), 0});
         const std::uint32_t end = std::min(cell + kChunk, tile.cellsEnd);
         const std::size_t first = at;
         while (at < inner.size() && inner[at].lo < end)
            ++at;
         addBonds(inner, first, at);
      }
      tile.chunksEnd = static_cast<std::uint32_t>(m_out.chunks.size());
   }
   m_out.firstCross = static_cast<std::uint32_t>(m_out.runs.size());
   m_out.chunks.push_back({static_cast<std::uint32_t>(m_out.places), m_out.firstCross, 0});
   at = 0;
   for (Tile &tile : m_out.tiles) {
      tile.cross = static_cast<std::uint32_t>(m_out.runs.size());
      const std::size_t first = at;
      while (at < outer.size() && outer[at].lo < tile.cellsEnd)
         ++at;
      addBonds(outer, first, at);
      tile.crossEnd = static_cast<std::uint32_t>(m_out.runs.size());
   }
   addCrossings();
}

void Builder::addCrossings()
{
   std::map<std::tuple<std::size_t, std::uint32_t, std::uint8_t, std::int32_t>, std::uint16_t> found;
   const auto chunkOf = [&](std::uint32_t cell) {
      const auto next = std::upper_bound(m_out.chunks.begin(), m_out.chunks.end() - 1, cell,
                                         [](std::uint32_t p, const Chunk &chunk) { return p < chunk.cells; });
      return static_cast<std::size_t>(next - m_out.chunks.begin() - 1);
   };
   for (std::size_t r = m_out.firstCross; r < m_out.runs.size(); ++r) {
      const Run &run = m_out.runs[r];
      const auto slot = static_cast<std::uint32_t>((r - m_out.firstCross) * kBlock);
      for (std::uint32_t i = 0; i < kBlock; ++i) {
         if (!(run.lanes >> i & 1))
            continue;
         const bool listed = run.flags & Run::listed;
         for (std::uint8_t atHi = 0; atHi < 2; ++atHi) {
            const std::uint32_t cell =
                listed ? (atHi ? m_out.listHi : m_out.listLo)[run.lo + i] : (atHi ? run.hi : run.lo) + i;
            auto &lanes = found[{chunkOf(cell), slot, atHi, static_cast<std::int32_t>(cell - i)}];
            lanes = static_cast<std::uint16_t>(lanes | 1u << i);
         }
      }
   }
   std::size_t chunk = 0;
   for (const auto &[key, lanes] : found) {
      const auto &[at, slot, atHi, cell] = key;
      for (; chunk <= at; ++chunk)
         m_out.chunks[chunk].crossings = static_cast<std::uint32_t>(m_out.crossings.size());
      m_out.crossings.push_back({cell, slot, lanes, atHi});
   }
   for (; chunk < m_out.chunks.size(); ++chunk)
      m_out.chunks[chunk].crossings = static_cast<std::uint32_t>(m_out.crossings.size());
}

} // namespace

Layout::Layout(const Assembly &assembly, const std::vector<bool> &actuated, const std::vector<bool> &still,
               std::uint32_t lanes)
{
   Builder builder(assembly, actuated, still, lanes, *this);
   builder.placeCells();
   builder.placeBonds();
}

} // namespace bonds
