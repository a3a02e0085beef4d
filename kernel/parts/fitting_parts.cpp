#include "parts/fitting_parts.h"

#include <algorithm>

namespace diatom {

std::vector<std::shared_ptr<const PartMaker>> fittingParts(const Catalogue &catalogue,
                                                           const std::string &lattice, const Job &job)
{
   std::vector<std::shared_ptr<const PartMaker>> makers;
   for (const Offer &offer : catalogue.offers(DIATOM_PARTS_1))
      if (auto maker = PartMaker::make(catalogue, offer.provided->id, {}, lattice, job))
         makers.push_back(*std::move(maker));
   std::stable_partition(makers.begin(), makers.end(), [&](const auto &maker) {
      const auto &named = maker->lattices();
      return std::find(named.begin(), named.end(), lattice) != named.end();
   });
   return makers;
}

} // namespace diatom
