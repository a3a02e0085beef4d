// Constants of all bonds, each set once: most bonds of a part are alike.
#pragma once

#include "model/constants.h"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace bonds {

class BondTable
{
public:
   const BondConstants &operator[](std::int64_t bond) const
   {
      return m_sets[m_setOf[static_cast<std::size_t>(bond)]];
   }
   /// Constants of the next bond.
   void push_back(const BondConstants &k)
   {
      std::array<double, 14> key{k.s[0], k.s[1]};
      for (std::size_t j = 0; j < 3; ++j) {
         key[2 + j] = k.k[j];
         key[5 + j] = k.c[j];
         key[8 + j] = k.d[j];
         key[11 + j] = k.e[j];
      }
      const auto [found, added] = m_known.try_emplace(key, static_cast<std::uint32_t>(m_sets.size()));
      if (added)
         m_sets.push_back(k);
      m_setOf.push_back(found->second);
   }
   void finish() { m_known.clear(); }

   /// The sets, whichever bonds they are of.
   auto begin() { return m_sets.begin(); }
   auto end() { return m_sets.end(); }

private:
   std::vector<std::uint32_t> m_setOf;
   std::vector<BondConstants> m_sets;
   std::map<std::array<double, 14>, std::uint32_t> m_known;
};

} // namespace bonds
