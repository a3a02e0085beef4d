// A lattice of cubes whose motif is spoilt on its way out.
#pragma once

#include <diatom/lattice.hpp>

#include <cstdint>
#include <cstring>
#include <limits>

namespace false_answers {

inline diatom::sdk::Lattice cube(const diatom::sdk::Values &)
{
   diatom::sdk::Lattice lattice;
   lattice.shape = {diatom::sdk::hull(diatom::sdk::signs({0.5, 0.5, 0.5}))};
   lattice.touch = diatom::sdk::Touch::face;
   return lattice;
}

using Right = diatom::sdk::LatticeModule<&cube>;

struct FalseLattice
{
   void *right = nullptr;
   std::string fault;
   std::vector<double> offset{0, 0, 0}, basis{0.5, 0, 0, 0, 1, 0, 0, 0, 1};
   std::vector<std::int32_t> steps;
   std::vector<std::int32_t> step{1, 0, 0};
   diatom_motif record{};

   static std::int32_t create(const diatom_call *call, const diatom_create *given, void **self)
   {
      return diatom::sdk::guarded(call, [&] {
         auto made = std::make_unique<FalseLattice>();
         made->fault = diatom::sdk::Values(given->values).text("fault");
         if (const std::int32_t status = Right::create(call, given, &made->right); status != DIATOM_OK)
            throw diatom::sdk::Failure(status, "no lattice");
         *self = made.release();
      });
   }
   static std::int32_t motif(void *self, const diatom_call *call, const diatom_motif **record)
   {
      return diatom::sdk::guarded(call, [&] {
         auto &lattice = *static_cast<FalseLattice *>(self);
         const diatom_motif *spotless = nullptr;
         if (Right::motif(lattice.right, call, &spotless) != DIATOM_OK)
            throw diatom::sdk::Failure(DIATOM_INTERNAL, "no motif");
         lattice.record = *spotless;
         lattice.spoil();
         *record = &lattice.record;
      });
   }
   static void destroy(void *self)
   {
      Right::destroy(static_cast<FalseLattice *>(self)->right);
      delete static_cast<FalseLattice *>(self);
   }

   void spoil()
   {
      if (fault == "not finite") {
         offset[1] = std::numeric_limits<double>::quiet_NaN();
         record.offset = offset.data();
      } else if (fault == "counts") {
         record.sites = 7;
      } else if (fault == "tiling") {
         record.basis = basis.data();
      } else if (fault == "one way") {
         steps.assign(record.link_offset, record.link_offset + 3 * record.link_start[1]);
         for (std::size_t k = 0; k < 3; ++k)
            steps[k] *= 2;
         record.link_offset = steps.data();
      } else if (fault == "limits") {
         record.supercell_step = step.data();
         record.supercell_longest = -3;
         record.supercell_default = 2;
      } else if (fault == "crash") {
         const volatile std::uintptr_t hidden = 8; // not 0, which UBSan ends in a way of its own
         const std::uintptr_t nowhere = hidden;
         volatile int *at = nullptr;
         std::memcpy(&at, &nowhere, sizeof at);
         *at = 1;
      } else if (fault == "throws") {
         throw std::runtime_error("the motif is lost");
      }
   }

   static constexpr diatom_lattice table() { return {create, motif, destroy}; }
};

} // namespace false_answers
