// What has to be made: parts counted by type, length and material, with their mass.
#pragma once

#include "parts/decomposition.h"

namespace diatom {

/// Equal parts.
struct PartCount
{
   int type = 0, length = 1;
   MaterialIndex material = 0;
   std::int64_t count = 0;
   double volume = 0; // m3, of one, by its finest mesh
   double mass = 0;   // kg, of one
};

/// By type, then length, then material. Each kind of part is meshed once.
Result<std::vector<PartCount>> countParts(const PartMaker &maker, const Decomposition &parts,
                                          const Hierarchy &hierarchy, const Job &job);

} // namespace diatom
