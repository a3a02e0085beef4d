// What a parts plugin hands over while it decomposes: checked piece by piece, then as a whole for coverage.
#pragma once

#include "parts/decomposition.h"
#include "parts/gathered_cells.h"

#include <string>
#include <vector>

namespace diatom {

class PartBatches
{
public:
   PartBatches(const GatheredCells &cells, std::vector<PartType> types);

   /// For the plugin; valid as long as this object stays where it is.
   diatom_part_sink sink();
   /// Why a batch was refused; empty when none was.
   const std::string &fault() const { return m_fault; }
   /// Checks that every cell is covered exactly once (or, when `partial`, at most once) and orders the parts
   /// by their first cell.
   Result<Decomposition> finish(bool partial) const;

private:
   static std::int32_t take(const diatom_part_sink *sink, const diatom_part_batch *batch);
   void add(const diatom_part_batch &batch);
   std::string faultOf(const diatom_part_batch &batch, std::int64_t part) const;
   std::string cellName(std::int64_t cell) const;
   Status checkCoverage(bool partial, std::vector<Index> &left) const;

   const GatheredCells &m_cells;
   std::vector<PartType> m_types;
   std::vector<Part> m_parts;
   std::vector<std::int64_t> m_covered; // by part, places in m_cells in ascending order
   std::string m_fault;
};

} // namespace diatom
