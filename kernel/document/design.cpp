#include "document/design.h"

#include "document/format.h"
#include "document/json_text.h"

#include <filesystem>

namespace diatom {

Hash Design::hash() const
{
   Hasher hasher;
   hasher.add(std::string_view(name));
   const Hash cells = model.hash();
   hasher.add(cells.high);
   hasher.add(cells.low);
   // The rest is small, and its text is the same for equal values.
   hasher.add(std::string_view(jsonLine(setupJson(setup))));
   hasher.add(std::string_view(assembly.parts));
   hasher.add(std::string_view(jsonLine(valuesJson(assembly.partsValues))));
   hasher.add(std::string_view(assembly.machine));
   hasher.add(std::string_view(jsonLine(valuesJson(assembly.machineValues))));
   for (ReferenceMesh reference : referenceMeshes) {
      // Where its file lies is no part of what the design is.
      reference.file = std::filesystem::path(reference.file).filename().string();
      hasher.add(std::string_view(jsonLine(referenceMeshJson(reference))));
   }
   hasher.add(std::string_view(jsonLine(unknown)));
   return hasher.finish();
}

} // namespace diatom
