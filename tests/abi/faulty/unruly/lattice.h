#pragma once

#include "fault.h"

#include <diatom/lattice.hpp>

#include <limits>
#include <memory>
#include <vector>

namespace unruly {

struct LatticeSelf
{
   explicit LatticeSelf(const diatom::sdk::Lattice &lattice) : motif(lattice) {}
   diatom::sdk::Motif motif;
   diatom_motif record{};
   std::vector<std::int32_t> noLinks;
};

inline diatom::sdk::Lattice blocks(double height)
{
   diatom::sdk::Lattice lattice;
   lattice.shape = {diatom::sdk::hull(diatom::sdk::signs({0.5, 0.5, height / 2}))};
   lattice.basis = {diatom::sdk::Vec{1, 0, 0}, {0, 1, 0}, {0, 0, height}};
   lattice.touch = diatom::sdk::Touch::face;
   return lattice;
}

inline std::int32_t createLattice(const diatom_call *call, const diatom_create *create, void **self)
{
   return diatom::sdk::guarded(call, [&] {
      begin("lattice", call, create);
      const double asked = diatom::sdk::Values(create->values).number("height");
      auto made = std::make_unique<LatticeSelf>(blocks(asked + wobble("lattice")));
      made->record = *made->motif.record();
      if (breaks("lattice.parameters") && asked > 1.5)
         made->record.basis = nullptr;
      if (breaks("lattice.contacts")) {
         made->noLinks.assign(static_cast<std::size_t>(made->record.sites) + 1, 0);
         made->record.link_start = made->noLinks.data();
      }
      *self = made.release();
   });
}

inline std::int32_t motif(void *self, const diatom_call *, const diatom_motif **record)
{
   *record = &static_cast<LatticeSelf *>(self)->record;
   return DIATOM_OK;
}

inline constexpr diatom_lattice kLattice{createLattice, motif,
                                         [](void *self) { delete static_cast<LatticeSelf *>(self); }};

} // namespace unruly
