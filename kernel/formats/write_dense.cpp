#include "formats/write_dense.h"

#include <utility>

namespace diatom {

namespace {

constexpr double kMostPlaces = 2e7;

} // namespace

nlohmann::ordered_json xyz(Index i) { return {{"x", i.x}, {"y", i.y}, {"z", i.z}}; }

Status DenseCells::check(const Box &bounds)
{
   if (bounds.volume() > kMostPlaces)
      return Error{ErrorCode::invalid,
                   "files of the earlier programs spell out every place of the box around the cells, "
                   "which is too large here; write a part of the design"};
   return {};
}

DenseCells::DenseCells(const Box &bounds) : m_bounds(bounds)
{
   using Rows = nlohmann::ordered_json;
   const Index size = bounds.empty() ? Index{1, 1, 1} : bounds.max - bounds.min + Index{1, 1, 1};
   const Rows row(static_cast<std::size_t>(size.z), Rows());
   const Rows plane(static_cast<std::size_t>(size.y), row);
   m_cells = Rows(static_cast<std::size_t>(size.x), plane);
}

nlohmann::ordered_json &DenseCells::at(Index i)
{
   const Index from = i - m_bounds.min;
   return m_cells[static_cast<std::size_t>(from.x)][static_cast<std::size_t>(from.y)]
                 [static_cast<std::size_t>(from.z)];
}

void DenseCells::put(nlohmann::ordered_json &to) &&
{
   const bool empty = m_bounds.empty();
   to["cellsMin"] = empty ? nlohmann::ordered_json() : xyz(m_bounds.min);
   to["cellsMax"] = empty ? nlohmann::ordered_json() : xyz(m_bounds.max);
   to["sparseCells"] = std::move(m_cells);
}

} // namespace diatom
