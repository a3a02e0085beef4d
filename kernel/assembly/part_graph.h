// Parts as the planner sees them: the cells of each, how high they lie, which part can hold which, what rests
// on the plate.
#pragma once

#include "assembly/columns.h"
#include "parts/decomposition.h"

#include <cstdint>
#include <span>
#include <vector>

namespace diatom {

/// Numbers indices in the order they were first added. Open addressing; nothing depends on the hash order.
class IndexTable
{
public:
   explicit IndexTable(std::size_t expected);
   std::int32_t add(Index index);
   /// -1 when it was never added.
   std::int32_t find(Index index) const;
   const std::vector<Index> &indices() const { return m_indices; }

private:
   std::size_t slot(Index index) const;
   std::vector<Index> m_indices;
   std::vector<std::int32_t> m_slots; // -1 = free
   std::size_t m_mask = 0;
};

/// Immutable once made. Parts are numbered as in the decomposition; cells are numbered here. Several parts
/// may share a cell (three triangles of one octahedron): the first placed holds the others.
class PartGraph
{
public:
   PartGraph(const Lattice &lattice, const Decomposition &parts);

   std::size_t parts() const { return m_partStart.size() - 1; }
   std::size_t cells() const { return m_cells.indices().size(); }
   Index index(std::int32_t cell) const { return m_cells.indices()[static_cast<std::size_t>(cell)]; }
   const std::vector<Index> &indices() const { return m_cells.indices(); }
   /// Height of the cell's centre, m.
   double height(std::int32_t cell) const { return m_height[static_cast<std::size_t>(cell)]; }
   /// Heights that differ by less are the same.
   double tolerance() const { return m_tolerance; }

   std::span<const std::int32_t> cellsOf(std::int32_t part) const;
   std::span<const std::int32_t> partsOf(std::int32_t cell) const;
   bool onPlate(std::int32_t part) const { return m_onPlate[static_cast<std::size_t>(part)] != 0; }
   /// Place in the order layer by layer, within a layer row by row.
   std::int32_t rank(std::int32_t part) const { return m_rank[static_cast<std::size_t>(part)]; }
   std::int32_t partAt(std::int32_t rank) const { return m_byRank[static_cast<std::size_t>(rank)]; }

   /// Calls visit(other) for every part that `part`, once placed, holds from below or beside. May repeat.
   template<typename Visit>
   void held(std::int32_t part, Visit &&visit) const
   {
      linked(part, true, visit);
   }
   /// The same for every part joined to it, whichever is higher.
   template<typename Visit>
   void joined(std::int32_t part, Visit &&visit) const
   {
      linked(part, false, visit);
   }

private:
   struct Step
   {
      Index offset;
      bool down; // the neighbour's centre lies lower
   };
   void addCells(const Decomposition &parts);
   void findSteps(const Lattice &lattice);
   void rankParts();

   template<typename Visit>
   void linked(std::int32_t part, bool upOnly, Visit &&visit) const
   {
      for (const std::int32_t cell : cellsOf(part)) {
         for (const std::int32_t other : partsOf(cell))
            if (other != part)
               visit(other);
         for (const Step &step : m_steps[static_cast<std::size_t>(m_site[static_cast<std::size_t>(cell)])]) {
            if (upOnly && step.down)
               continue;
            const std::int32_t neighbour = m_cells.find(index(cell) + step.offset);
            if (neighbour < 0)
               continue;
            for (const std::int32_t other : partsOf(neighbour))
               if (other != part)
                  visit(other);
         }
      }
   }

   double m_tolerance;
   IndexTable m_cells;
   std::vector<std::int32_t> m_site;
   std::vector<double> m_height;
   std::vector<std::int32_t> m_partCells; // cells by part
   std::vector<std::int64_t> m_partStart;
   std::vector<std::int32_t> m_cellParts; // parts by cell
   std::vector<std::int64_t> m_cellStart;
   std::vector<std::uint8_t> m_onPlate;
   std::vector<std::int32_t> m_rank, m_byRank;
   std::vector<std::vector<Step>> m_steps; // joined links, by site
};

} // namespace diatom
