// Any bytes at all are either a design, which then survives a round trip, or a sentence.
#include "formats/files.h"

#include "core/check.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
   using namespace diatom;
   const std::string_view bytes(reinterpret_cast<const char *>(data), size);
   const auto opened = readDesign(bytes, "input", Job());
   if (!opened.ok()) {
      DIATOM_CHECK(!opened.error().message.empty());
      return 0;
   }
   // Small ones only: the point is the reader.
   if (opened->design.model.root.cells.count() > 100'000)
      return 0;
   for (const bool packed : {false, true}) {
      const auto written = writeDesign(opened->design, packed, Job());
      DIATOM_CHECK(written.ok());
      const auto again = readDesign(*written, "again", Job());
      DIATOM_CHECK(again.ok());
      DIATOM_CHECK(again->design == opened->design);
      DIATOM_CHECK(again->design.hash() == opened->design.hash());
   }
   return 0;
}
