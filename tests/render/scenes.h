// Small assemblies the renderer's tests draw.
#pragma once

#include "cells/hierarchy.h"
#include "support/support.h"

#include <memory>
#include <random>
#include <string>
#include <vector>

namespace diatom::test {

inline std::vector<std::string> latticeIds()
{
   std::vector<std::string> ids;
   for (const Offer &offer : catalogue()->offers(DIATOM_LATTICE_1))
      ids.push_back(offer.provided->id);
   return ids;
}

inline std::shared_ptr<const Lattice> makeLattice(const std::string &id)
{
   LatticeSpec spec;
   spec.id = id;
   auto lattice = Lattice::make(*catalogue(), spec, Job());
   return lattice.ok() ? *lattice : nullptr;
}

inline Model emptyModel(const std::string &lattice)
{
   Model model;
   model.lattice.id = lattice;
   for (const auto &[id, color] :
        {std::pair<const char *, std::array<std::uint8_t, 3>>{"blue", {60, 120, 190}},
         std::pair<const char *, std::array<std::uint8_t, 3>>{"sand", {220, 170, 90}}})
   {
      Material material;
      material.id = material.name = id;
      material.color = color;
      if (!model.setMaterial(material).ok())
         qFatal("a material was refused");
   }
   return model;
}

/// Cells of a box, each kept with probability `density`; the seed is fixed.
inline Model randomModel(const std::string &lattice, int size, double density, unsigned seed)
{
   Model model = emptyModel(lattice);
   std::mt19937 random(seed);
   for (int x = -size; x <= size; ++x)
      for (int y = -size; y <= size; ++y)
         for (int z = 0; z <= size; ++z)
            if (double(random()) < density * 4294967295.0)
               model.root.cells.set({x, y, z}, Cell{static_cast<MaterialIndex>(1 + random() % 2), 0, 0});
   return model;
}

} // namespace diatom::test
