#include "study/refine.h"

#include "scene/cell_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace diatom {

namespace {

constexpr const char *kCube = "org.diatom_cad.lattice.cube";
constexpr std::int64_t kMostCells = 2'000'000;

Status checkRefinable(const Hierarchy &hierarchy, const Setup &setup)
{
   const Model &model = hierarchy.model();
   if (model.lattice.id != kCube)
      return Error{ErrorCode::unsupported,
                   fmt::format("only designs of cubes can be refined, this one is on {}", model.lattice.id)};
   if (!setup.sources.empty())
      return Error{ErrorCode::unsupported,
                   "a wired design cannot be refined: its parts would touch differently"};
   if (std::any_of(setup.drives.begin(), setup.drives.end(),
                   [](const Drive &drive) { return drive.freedom >= 3; }))
      return Error{
          ErrorCode::unsupported,
          "a design with driven turns cannot be refined: a cell's parts would each turn by themselves"};
   if (std::any_of(setup.starts.begin(), setup.starts.end(), [](const Start &start) {
          return !start.about &&
                 (start.turn != std::array<double, 3>{} || start.spin != std::array<double, 3>{});
       }))
      return Error{
          ErrorCode::unsupported,
          "a design whose cells start turned or spinning about themselves cannot be refined; give the "
          "point that they turn about"};
   const auto counts = hierarchy.countByMaterial();
   for (std::size_t m = 1; m < counts.size() && m <= model.materials->size(); ++m)
      if (counts[m] > 0 && (*model.materials)[m - 1].bonds)
         return Error{
             ErrorCode::unsupported,
             fmt::format("the material '{}' is given by the bond constants of one size of cell; give "
                         "it by Young's modulus to refine the design",
                         (*model.materials)[m - 1].id)};
   return {};
}

/// The same cells, cut: one cell becomes a box of them.
Where refined(const Where &where, int times)
{
   if (const auto *cell = std::get_if<Index>(&where)) {
      const Index first = refinedIndex(*cell, times);
      return Box{first, first + Index{times - 1, times - 1, times - 1}};
   }
   if (const auto *box = std::get_if<Box>(&where))
      return Box{refinedIndex(box->min, times),
                 refinedIndex(box->max, times) + Index{times - 1, times - 1, times - 1}};
   return where;
}

Setup refinedSetup(const Setup &setup, int times, const std::array<double, 3> &shift)
{
   Setup fine = setup;
   const double parts = static_cast<double>(times) * times * times;
   for (Support &support : fine.supports)
      support.where = refined(support.where, times);
   for (Drive &drive : fine.drives)
      drive.where = refined(drive.where, times);
   for (Load &load : fine.loads) {
      load.where = refined(load.where, times);
      for (std::size_t k = 0; k < 3; ++k) {
         load.force[k] /= parts;
         load.moment[k] /= parts;
      }
   }
   for (Start &start : fine.starts) {
      start.where = refined(start.where, times);
      for (std::size_t k = 0; start.about && k < 3; ++k)
         (*start.about)[k] += shift[k];
   }
   fine.ground.stiffness /= static_cast<double>(times) * times;
   fine.ground.damping /= static_cast<double>(times) * times;
   fine.ground.height += shift[2];
   fine.step = 0;
   return fine;
}

} // namespace

Result<RefinedScene> refineScene(const std::shared_ptr<const Hierarchy> &hierarchy, const Setup &setup,
                                 const Catalogue &catalogue, int times, const Job &job)
{
   if (times == 1)
      return RefinedScene{hierarchy, setup};
   if (times < 1)
      return Error{ErrorCode::usage, "a resolution is a whole number of cells along an edge, 1 or more"};
   if (const Status can = checkRefinable(*hierarchy, setup); !can)
      return can.error();
   const std::int64_t most = kMostCells / (static_cast<std::int64_t>(times) * times * times);
   const auto cells = listCells(*hierarchy, {}, most, job);
   if (!cells)
      return cells.error();
   Model model;
   model.lattice = hierarchy->model().lattice;
   std::array<double, 3> shift{};
   for (std::size_t k = 0; k < 3; ++k)
      shift[k] = model.lattice.pitch * model.lattice.aspect[k] * (times - 1) / (2.0 * times);
   model.lattice.pitch /= times;
   model.materials = hierarchy->model().materials;
   for (std::int64_t i = 0; i < cells->count(); ++i) {
      const Index first = refinedIndex(cells->index[static_cast<std::size_t>(i)], times);
      model.root.cells.fill({first, first + Index{times - 1, times - 1, times - 1}},
                            cells->cell[static_cast<std::size_t>(i)]);
   }
   const auto lattice = Lattice::make(catalogue, model.lattice, job);
   if (!lattice)
      return lattice.error();
   return RefinedScene{std::make_shared<const Hierarchy>(*lattice, std::move(model)),
                       refinedSetup(setup, times, shift)};
}

} // namespace diatom
