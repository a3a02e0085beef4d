// Any bytes at all are either a manifest, whose defaults then are values it accepts, or a sentence.
#include "plugins/manifest.h"
#include "plugins/values.h"

#include "core/check.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
   using namespace diatom;
   const auto manifest = parseManifest({reinterpret_cast<const char *>(data), size}, "folder");
   if (!manifest.ok()) {
      DIATOM_CHECK(!manifest.error().message.empty());
      return 0;
   }
   for (const Provided &provided : manifest->provides) {
      const auto values = completeValues(provided.parameters, {});
      if (values.ok())
         DIATOM_CHECK(completeValues(provided.parameters, *values).ok());
   }
   return 0;
}
