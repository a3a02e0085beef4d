#include "study/refine.h"

#include "scene/cell_list.h"
#include "scene/problems.h"

#include <fmt/format.h>

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

template<typename Visit>
void eachPart(Index cell, int times, const Visit &visit)
{
   const Index first = refinedIndex(cell, times);
   for (std::int32_t x = 0; x < times; ++x)
      for (std::int32_t y = 0; y < times; ++y)
         for (std::int32_t z = 0; z < times; ++z)
            visit(first + Index{x, y, z});
}

Setup refinedSetup(const Setup &setup, int times, double pitchZ)
{
   Setup fine = setup;
   const double parts = static_cast<double>(times) * times * times;
   fine.supports.clear();
   fine.loads.clear();
   for (const Support &support : setup.supports)
      eachPart(support.cell, times, [&](Index part) { fine.supports.push_back({part, support.fixed}); });
   std::sort(fine.supports.begin(), fine.supports.end(),
             [](const Support &a, const Support &b) { return a.cell < b.cell; });
   for (const Load &load : setup.loads)
      eachPart(load.cell, times, [&](Index part) {
         Load share{part, load.force, load.moment};
         for (std::size_t k = 0; k < 3; ++k) {
            share.force[k] /= parts;
            share.moment[k] /= parts;
         }
         fine.loads.push_back(share);
      });
   fine.ground.stiffness /= static_cast<double>(times) * times;
   fine.ground.damping /= static_cast<double>(times) * times;
   fine.ground.height += pitchZ * (times - 1) / (2.0 * times);
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
   const double pitchZ = model.lattice.pitch * model.lattice.aspect[2];
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
                       refinedSetup(setup, times, pitchZ)};
}

} // namespace diatom
