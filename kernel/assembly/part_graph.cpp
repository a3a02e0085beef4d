#include "assembly/part_graph.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace diatom {

IndexTable::IndexTable(std::size_t expected)
{
   std::size_t slots = 16;
   while (slots < 2 * expected)
      slots *= 2;
   m_slots.assign(slots, -1);
   m_mask = slots - 1;
   m_indices.reserve(expected);
}

std::size_t IndexTable::slot(Index index) const
{
   const auto word = [](std::int32_t v) { return std::uint64_t{static_cast<std::uint32_t>(v)}; };
   std::uint64_t h = (word(index.x) | word(index.y) << 32) * 0x9e3779b97f4a7c15u;
   h = ((h ^ (h >> 29)) + word(index.z)) * 0xbf58476d1ce4e5b9u;
   std::size_t at = static_cast<std::size_t>(h ^ (h >> 32)) & m_mask;
   while (m_slots[at] >= 0 && m_indices[static_cast<std::size_t>(m_slots[at])] != index)
      at = (at + 1) & m_mask;
   return at;
}

std::int32_t IndexTable::add(Index index)
{
   std::int32_t &number = m_slots[slot(index)];
   if (number < 0) {
      number = static_cast<std::int32_t>(m_indices.size());
      m_indices.push_back(index);
   }
   return number;
}

std::int32_t IndexTable::find(Index index) const { return m_slots[slot(index)]; }

PartGraph::PartGraph(const Lattice &lattice, const Decomposition &parts)
    : m_tolerance(1e-3 * lattice.radius()), m_cells(parts.covered.size())
{
   addCells(parts);
   findSteps(lattice);

   // Bottoms, not centres, decide what rests on the plate: cells of different shape may stand side by side.
   std::vector<double> underside;
   for (int site = 0; site < lattice.sites(); ++site) {
      double lowest = std::numeric_limits<double>::max();
      for (const Vec3 &corner : lattice.corners(site))
         lowest = std::min(lowest, corner.z());
      underside.push_back(lowest);
   }
   double plate = std::numeric_limits<double>::max();
   std::vector<double> bottom;
   bottom.reserve(cells());
   for (const Index cell : indices()) {
      const int site = lattice.site(cell);
      m_site.push_back(site);
      m_height.push_back(lattice.position(cell).z());
      bottom.push_back(m_height.back() + underside[static_cast<std::size_t>(site)]);
      plate = std::min(plate, bottom.back());
   }
   m_onPlate.assign(this->parts(), 0);
   for (std::size_t part = 0; part < this->parts(); ++part)
      for (const std::int32_t cell : cellsOf(static_cast<std::int32_t>(part)))
         if (bottom[static_cast<std::size_t>(cell)] < plate + m_tolerance)
            m_onPlate[part] = 1;
   rankParts();
}

void PartGraph::addCells(const Decomposition &parts)
{
   m_partStart.push_back(0);
   for (const Part &part : parts.parts) {
      for (std::int64_t i = part.firstCell; i < part.firstCell + part.cells; ++i)
         m_partCells.push_back(m_cells.add(parts.covered[static_cast<std::size_t>(i)]));
      m_partStart.push_back(static_cast<std::int64_t>(m_partCells.size()));
   }
   m_cellStart.assign(cells() + 1, 0);
   for (const std::int32_t cell : m_partCells)
      ++m_cellStart[static_cast<std::size_t>(cell) + 1];
   std::partial_sum(m_cellStart.begin(), m_cellStart.end(), m_cellStart.begin());
   m_cellParts.resize(m_partCells.size());
   std::vector<std::int64_t> next(m_cellStart.begin(), m_cellStart.end() - 1);
   for (std::size_t part = 0; part < this->parts(); ++part)
      for (const std::int32_t cell : cellsOf(static_cast<std::int32_t>(part)))
         m_cellParts[static_cast<std::size_t>(next[static_cast<std::size_t>(cell)]++)] =
             static_cast<std::int32_t>(part);
}

void PartGraph::findSteps(const Lattice &lattice)
{
   const auto period = lattice.period();
   for (std::int32_t x = 0; x < period[0]; ++x)
      for (std::int32_t y = 0; y < period[1]; ++y)
         for (std::int32_t z = 0; z < period[2]; ++z) { // in the order of site numbers
            const Index here{x, y, z};
            auto &steps = m_steps.emplace_back();
            for (const Link &link : lattice.links(lattice.site(here))) {
               const double rise = lattice.position(here + link.offset).z() - lattice.position(here).z();
               if (link.joined)
                  steps.push_back({link.offset, rise < -m_tolerance});
            }
         }
}

void PartGraph::rankParts()
{
   struct Place
   {
      double height;
      std::int32_t layer;
      Index first;
      std::int32_t part;
   };
   std::vector<Place> places;
   places.reserve(parts());
   for (std::size_t part = 0; part < parts(); ++part) {
      const auto number = static_cast<std::int32_t>(part);
      Place place{std::numeric_limits<double>::max(), 0, index(cellsOf(number).front()), number};
      for (const std::int32_t cell : cellsOf(number))
         place.height = std::min(place.height, height(cell));
      places.push_back(place);
   }
   std::sort(places.begin(), places.end(), [](const Place &a, const Place &b) {
      return std::tie(a.height, a.part) < std::tie(b.height, b.part);
   });
   for (std::size_t i = 1; i < places.size(); ++i) {
      const bool sameLayer = places[i].height - places[i - 1].height < m_tolerance;
      places[i].layer = places[i - 1].layer + (sameLayer ? 0 : 1);
   }
   std::sort(places.begin(), places.end(), [](const Place &a, const Place &b) {
      return std::tie(a.layer, a.first.y, a.first.x, a.first.z, a.part) <
             std::tie(b.layer, b.first.y, b.first.x, b.first.z, b.part);
   });
   m_rank.resize(parts());
   for (const Place &place : places) {
      m_rank[static_cast<std::size_t>(place.part)] = static_cast<std::int32_t>(m_byRank.size());
      m_byRank.push_back(place.part);
   }
}

std::span<const std::int32_t> PartGraph::cellsOf(std::int32_t part) const
{
   const auto p = static_cast<std::size_t>(part);
   return {m_partCells.data() + m_partStart[p], m_partCells.data() + m_partStart[p + 1]};
}

std::span<const std::int32_t> PartGraph::partsOf(std::int32_t cell) const
{
   const auto c = static_cast<std::size_t>(cell);
   return {m_cellParts.data() + m_cellStart[c], m_cellParts.data() + m_cellStart[c + 1]};
}

} // namespace diatom
