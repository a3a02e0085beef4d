// Small designs for tests: random blobs, boxes and composites on any of the lattices.
#pragma once

#include "cells/hierarchy.h"
#include "support/support.h"

#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace diatom::test {

inline const std::vector<std::string> kLattices = {"org.diatom_cad.lattice.cube",
                                                   "org.diatom_cad.lattice.gik",
                                                   "org.diatom_cad.lattice.octahedron_edge",
                                                   "org.diatom_cad.lattice.kelvin",
                                                   "org.diatom_cad.lattice.octahedron_face",
                                                   "org.diatom_cad.lattice.octahedron_edge_flat",
                                                   "org.diatom_cad.lattice.octahedron_vertex",
                                                   "org.diatom_cad.lattice.tetrahedron_stacked",
                                                   "org.diatom_cad.lattice.tetrahedron_vertex",
                                                   "org.diatom_cad.lattice.cuboctahedron",
                                                   "org.diatom_cad.lattice.kelvin_body_centred",
                                                   "org.diatom_cad.lattice.honeycomb",
                                                   "org.diatom_cad.lattice.honeycomb_rotated",
                                                   "org.diatom_cad.lattice.rhombic_dodecahedron",
                                                   "org.diatom_cad.lattice.octet"};

/// A model on its lattice with three materials: a, b, c are 1, 2, 3.
struct Scene
{
   std::shared_ptr<const Lattice> lattice;
   Model model;

   explicit Scene(const std::string &id, double pitch = 1e-3, Values values = {})
   {
      model.lattice.id = id;
      model.lattice.values = std::move(values);
      model.lattice.pitch = pitch;
      auto made = Lattice::make(*catalogue(), model.lattice, Job());
      if (!made)
         qFatal("%s", made.error().message.c_str());
      lattice = *std::move(made);
      for (const char *name : {"a", "b", "c"}) {
         Material material;
         material.id = material.name = name;
         if (const auto added = model.setMaterial(material); !added)
            qFatal("%s", added.error().message.c_str());
      }
   }
   Hierarchy hierarchy() const { return Hierarchy(lattice, model); }
};

/// Volume of all cells, or those of one material; they differ where a lattice has several shapes, and count
/// once where instances overlap.
inline double cellVolume(const Hierarchy &hierarchy, MaterialIndex material = 0)
{
   double volume = 0;
   std::set<Index> seen;
   const Lattice &lattice = hierarchy.lattice();
   hierarchy.visit(hierarchy.bounds(), [&](Index i, Cell cell) {
      if ((material == 0 || cell.material == material) && seen.insert(i).second)
         volume += lattice.shape(lattice.site(i)).volume;
      return true;
   });
   return volume;
}

/// `count` connected cells around `start`: each new one touches one that is there.
inline std::vector<Index> blob(const Lattice &lattice, std::size_t count, unsigned seed, Index start = {})
{
   std::mt19937 random(seed);
   std::vector<Index> cells{start};
   std::set<Index> known{start};
   while (cells.size() < count) {
      const Index from = cells[random() % cells.size()];
      const auto links = lattice.links(lattice.site(from));
      const Index to = from + links[random() % links.size()].offset;
      if (inRange(to) && known.insert(to).second)
         cells.push_back(to);
   }
   return cells;
}

/// Cells of the box from `min` to `max` that are not inside the box one cell smaller on each side.
inline std::vector<Index> hollowBox(Index min, Index max)
{
   std::vector<Index> cells;
   for (int x = min.x; x <= max.x; ++x)
      for (int y = min.y; y <= max.y; ++y)
         for (int z = min.z; z <= max.z; ++z)
            if (x == min.x || x == max.x || y == min.y || y == max.y || z == min.z || z == max.z)
               cells.push_back({x, y, z});
   return cells;
}

} // namespace diatom::test
