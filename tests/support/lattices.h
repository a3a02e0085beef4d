// All lattices that come with the program, by the names of their folders.
#pragma once

#include "lattice/lattice.h"
#include "support/support.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

namespace diatom::test {

inline std::vector<std::string> latticeNames()
{
   std::vector<std::string> names;
   for (const auto &entry : std::filesystem::directory_iterator(sourceDir() / "plugins" / "lattices"))
      if (std::filesystem::exists(entry.path() / "plugin.json"))
         names.push_back(entry.path().filename().string());
   std::sort(names.begin(), names.end());
   return names;
}

/// Null, with a warning, when it cannot be made.
inline std::shared_ptr<const Lattice> namedLattice(const std::string &name, double pitch = 1,
                                                   std::array<double, 3> aspect = {1, 1, 1})
{
   LatticeSpec spec;
   spec.id = "org.diatom_cad.lattice." + name;
   spec.pitch = pitch;
   spec.aspect = aspect;
   const auto made = Lattice::make(*catalogue(), spec, Job());
   if (!made)
      qWarning("%s", made.error().message.c_str());
   return made ? *made : nullptr;
}

/// The cell of a site within the first period.
inline Index siteIndex(const Lattice &lattice, int site)
{
   const auto period = lattice.period();
   return {site / (period[1] * period[2]), site / period[2] % period[1], site % period[2]};
}

} // namespace diatom::test
