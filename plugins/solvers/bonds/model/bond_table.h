// Constants and lengths of all bonds, each set once: most bonds of a part are alike.
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
   double length(std::int64_t bond) const { return m_lengths[m_setOf[static_cast<std::size_t>(bond)]]; }
   /// Of the next bond.
   void push_back(const BondConstants &k, double length)
   {
      Key key{k.s[0], k.s[1]};
      key.back() = length;
      for (std::size_t j = 0; j < 3; ++j) {
         key[2 + j] = k.k[j];
         key[5 + j] = k.c[j];
         key[8 + j] = k.d[j];
         key[11 + j] = k.e[j];
      }
      const auto [found, added] = m_known.try_emplace(key, static_cast<std::uint32_t>(m_sets.size()));
      if (added) {
         m_sets.push_back(k);
         m_lengths.push_back(length);
      }
      m_setOf.push_back(found->second);
   }
   void finish() { m_known.clear(); }

   /// The sets, whichever bonds they are of.
   auto begin() { return m_sets.begin(); }
   auto end() { return m_sets.end(); }
   const std::vector<double> &lengths() const { return m_lengths; }

private:
   using Key = std::array<double, 15>;
   std::vector<std::uint32_t> m_setOf;
   std::vector<BondConstants> m_sets;
   std::vector<double> m_lengths; // of sets
   std::map<Key, std::uint32_t> m_known;
};

} // namespace bonds
