#include "formats/foreign.h"

#include "core/file.h"
#include "formats/earlier_programs.h"
#include "formats/vox.h"
#include "formats/voxcad.h"

#include <fmt/format.h>

#include <algorithm>

namespace diatom {

namespace {

template<bool world>
Result<std::string> voxcad(const Design &design, const Hierarchy &hierarchy, std::vector<std::string> &notes,
                           const Job &job)
{
   return writeVoxcad(design, hierarchy, world, notes, job);
}

constexpr ForeignFormat kFormats[] = {
    {"vox", ".vox", "MagicaVoxel", writeVox},         {"vxc", ".vxc", "VoxCAD", voxcad<false>},
    {"vxa", ".vxa", "VoxCAD", voxcad<true>},          {"amoeba", ".json", "AMOEBA", writeAmoeba},
    {"dmdesign", ".json", "DMDesign", writeDmdesign},
};

} // namespace

std::span<const ForeignFormat> foreignFormats() { return kFormats; }

const ForeignFormat *foreignFormat(std::string_view name, const std::filesystem::path &file)
{
   const std::string suffix = file.extension().string();
   const ForeignFormat *found = nullptr;
   for (const ForeignFormat &format : kFormats) {
      if (!name.empty() ? name == format.name : suffix == format.suffix) {
         if (found)
            return nullptr; // several programs share it
         found = &format;
      }
   }
   return found;
}

Status writeForeign(const Design &design, const Hierarchy &hierarchy, const ForeignFormat &format,
                    const std::filesystem::path &file, std::vector<std::string> &notes, const Job &job)
{
   if (!design.referenceMeshes.empty())
      notes.push_back(fmt::format("{} reference meshes are left out: {} has none",
                                  design.referenceMeshes.size(), format.program));
   const auto bytes = format.write(design, hierarchy, notes, job);
   const Status saved = bytes ? writeFileAtomic(file, *bytes) : Status(bytes.error());
   if (!saved)
      return Error{saved.error().code, fmt::format("{}: {}", file.string(), saved.error().message)};
   return {};
}

} // namespace diatom
