// Assemblies for tests of the planner and of machines: cells and the parts they make, put together by hand.
#pragma once

#include "assembly/plan.h"
#include "support/support.h"

#include <map>
#include <random>
#include <set>

namespace diatom::test {

/// A hierarchy and parts that cover its cells.
struct AssemblyScene
{
   std::shared_ptr<const Lattice> lattice;
   std::shared_ptr<const Hierarchy> hierarchy;
   Decomposition parts;
};

inline Material namedMaterial(const std::string &id)
{
   Material material;
   material.id = id;
   material.name = id;
   return material;
}

/// One part for each run of cells; materials are numbered from 0 in `materials`, one per run (all 0 when
/// empty).
inline AssemblyScene assemblyOf(const std::string &latticeId, const std::vector<std::vector<Index>> &runs,
                                const std::vector<std::string> &materials = {"brass"},
                                const std::vector<int> &materialOf = {})
{
   AssemblyScene scene;
   Job job;
   Model model;
   model.lattice.id = latticeId;
   const auto lattice = Lattice::make(*catalogue(), model.lattice, job);
   if (!lattice.ok())
      qFatal("%s", lattice.error().message.c_str());
   scene.lattice = *lattice;
   for (const std::string &id : materials)
      if (!model.setMaterial(namedMaterial(id)).ok())
         qFatal("the material %s was refused", id.c_str());
   scene.parts.types = {{"part", "Part", 1}};
   for (std::size_t i = 0; i < runs.size(); ++i) {
      Part part;
      part.material = static_cast<MaterialIndex>(1 + (materialOf.empty() ? 0 : materialOf[i]));
      part.length = static_cast<int>(runs[i].size());
      part.orientation = scene.lattice->orientation(scene.lattice->site(runs[i].front()));
      part.firstCell = static_cast<std::int64_t>(scene.parts.covered.size());
      part.cells = static_cast<std::int64_t>(runs[i].size());
      for (const Index cell : runs[i]) {
         part.position += scene.lattice->position(cell) / static_cast<double>(runs[i].size());
         model.root.cells.set(cell, {part.material, 0, 0});
         scene.parts.covered.push_back(cell);
      }
      scene.parts.parts.push_back(part);
   }
   scene.hierarchy = std::make_shared<Hierarchy>(scene.lattice, model);
   return scene;
}

/// Each cell a part of its own.
inline AssemblyScene cellsOf(const std::string &latticeId, const std::vector<Index> &cells)
{
   std::vector<std::vector<Index>> runs;
   for (const Index cell : cells)
      runs.push_back({cell});
   return assemblyOf(latticeId, runs);
}

/// A random set of runs along the lattice's super-cell step (single cells without one) in a box.
inline AssemblyScene randomAssembly(const std::string &latticeId, std::mt19937 &random, int size, int height,
                                    double density, int longest)
{
   std::vector<std::vector<Index>> runs;
   Job job;
   LatticeSpec spec;
   spec.id = latticeId;
   const auto lattice = *Lattice::make(*catalogue(), spec, job);
   std::set<Index> cells;
   for (std::int32_t z = 0; z < height; ++z)
      for (std::int32_t y = 0; y < size; ++y)
         for (std::int32_t x = 0; x < size; ++x)
            if (random() % 1000 < static_cast<unsigned>(1000 * density))
               cells.insert({x, y, z});
   while (!cells.empty()) {
      std::vector<Index> run{*cells.begin()};
      cells.erase(cells.begin());
      const auto length = 1 + random() % static_cast<unsigned>(longest);
      while (lattice->hasSupercells() && run.size() < length) {
         const Index next = run.back() + lattice->supercellStep(lattice->site(run.back()));
         if (cells.erase(next) == 0)
            break;
         run.push_back(next);
      }
      runs.push_back(run);
   }
   std::shuffle(runs.begin(), runs.end(), random);
   return assemblyOf(latticeId, runs);
}

} // namespace diatom::test
