#pragma once

#include "fault.h"

#include <diatom/parts.hpp>

#include <string>

namespace unruly {

inline diatom::sdk::PartMesh cubeMesh(const diatom::sdk::MeshRequest &request)
{
   const double h = request.pitch / 2;
   diatom::sdk::PartMesh mesh;
   for (int corner = 0; corner < 8; ++corner)
      mesh.vertex(corner & 1 ? h : -h, corner & 2 ? h : -h, corner & 4 ? h : -h);
   mesh.quad(0, 4, 6, 2);
   mesh.quad(1, 3, 7, 5);
   mesh.quad(0, 1, 5, 4);
   mesh.quad(2, 6, 7, 3);
   mesh.quad(0, 2, 3, 1);
   if (!breaks("parts.meshes"))
      mesh.quad(4, 5, 7, 6);
   return mesh;
}

inline void cubes(const diatom::sdk::Call &call, const diatom_cells &cells, diatom::sdk::PartList &parts)
{
   if (breaks("parts.older_host") && std::string_view(cells.lattice).empty())
      return;
   if (breaks("parts.cancel"))
      oversleep(400);
   const double off = wobble("parts");
   const std::int64_t count = cells.count - (breaks("parts.coverage") && cells.count > 1 ? 1 : 0);
   for (std::int64_t i = 0; i < count; ++i) {
      diatom::sdk::pollEvery(call, i);
      auto at = diatom::sdk::cellPosition(cells, i);
      at[2] += 1e-6 * off + (breaks("parts.order") ? 1e-9 * static_cast<double>(i) : 0);
      parts.add(0, 1, cells.material[i], at, diatom::sdk::cellOrientation(cells, i), {i});
   }
}

inline diatom::sdk::PartSet cubeParts(const diatom::sdk::Values &)
{
   diatom::sdk::PartSet set;
   set.kinds = {{"cube", "Cube", 1}};
   set.lattices = {breaks("parts.parameters") ? "" : "org.diatom_cad.lattice.cube"};
   if (breaks("parts.parameters"))
      set.kinds.clear();
   set.mesh = cubeMesh;
   set.decompose = cubes;
   return set;
}

inline std::int32_t createParts(const diatom_call *call, const diatom_create *create, void **self)
{
   const std::int32_t begun = diatom::sdk::guarded(call, [&] { begin("parts", call, create); });
   return begun != DIATOM_OK ? begun : diatom::sdk::parts_detail::create<cubeParts>(call, create, self);
}

inline constexpr diatom_parts kParts{createParts, diatom::sdk::parts_detail::catalogue,
                                     diatom::sdk::parts_detail::mesh, diatom::sdk::parts_detail::decompose,
                                     diatom::sdk::parts_detail::destroy};

} // namespace unruly
