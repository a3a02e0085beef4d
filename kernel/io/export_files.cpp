#include "io/export_files.h"

#include "io/stl.h"

namespace diatom {

namespace {

/// Cells up to which contacts of an STL export are counted: a surface that takes a second and some 100 MB.
constexpr std::uint64_t kMostCounted = 1'000'000;

Result<std::vector<ExportedFile>> streamed(const Hierarchy &hierarchy, const PartMaker *maker,
                                           const ExportOptions &options, const std::filesystem::path &out,
                                           const Job &job)
{
   StlOptions how;
   how.what = options.geometry.what == GeometryOptions::What::parts ? StlOptions::What::parts
                                                                    : StlOptions::What::cells;
   how.material = options.geometry.material;
   how.ascii = options.ascii;
   how.detail = options.geometry.detail;
   how.unit = options.unit;
   how.contacts = hierarchy.cells() <= kMostCounted;
   std::vector<StlReport> reports;
   if (options.eachMaterial) {
      auto all = writeStlByMaterial(hierarchy, maker, how, out, job);
      if (!all)
         return all.error();
      reports = *std::move(all);
   } else {
      auto one = writeStl(hierarchy, maker, how, out, job);
      if (!one)
         return one.error();
      reports.push_back(*std::move(one));
   }
   std::vector<ExportedFile> files;
   for (const StlReport &report : reports) {
      ExportedFile file;
      file.file = report.file;
      file.material = report.material;
      file.triangles = report.triangles;
      file.bytes = report.bytes;
      file.cells = report.cells;
      file.parts = report.parts;
      file.edgeContacts = report.edgeContacts;
      file.vertexContacts = report.vertexContacts;
      files.push_back(std::move(file));
   }
   return files;
}

Result<ExportedFile> indexedFile(const Hierarchy &hierarchy, const PartMaker *maker,
                                 const ExportOptions &options, std::optional<MaterialIndex> material,
                                 const std::filesystem::path &path, const Job &job)
{
   GeometryOptions what = options.geometry;
   what.material = material;
   what.apart = what.apart && options.format != GeometryFormat::stl;
   const auto geometry = makeGeometry(hierarchy, maker, what, job);
   if (!geometry)
      return geometry.error();
   const auto bytes = writeGeometry(*geometry, options.format, options.unit, path, job);
   if (!bytes)
      return bytes.error();
   ExportedFile file;
   file.file = path;
   file.material = material;
   file.solids = geometry->solids.size() + geometry->beams.size();
   file.triangles = geometry->triangles();
   file.bytes = *bytes;
   file.cells = geometry->cells;
   file.parts = geometry->parts;
   file.struts = geometry->struts;
   file.edgeContacts = geometry->edgeContacts();
   file.vertexContacts = geometry->vertexContacts();
   return file;
}

Result<std::vector<ExportedFile>> indexed(const Hierarchy &hierarchy, const PartMaker *maker,
                                          const ExportOptions &options, const std::filesystem::path &out,
                                          const Job &job)
{
   std::vector<ExportedFile> files;
   if (!options.eachMaterial) {
      auto file = indexedFile(hierarchy, maker, options, options.geometry.material, out, job);
      if (!file)
         return file.error();
      files.push_back(*std::move(file));
      return files;
   }
   if (out == "-")
      return Error{ErrorCode::usage, "a file per material cannot go to standard output; give a file name"};
   const auto counts = hierarchy.countByMaterial();
   for (std::size_t material = 1; material < counts.size(); ++material) {
      if (counts[material] == 0)
         continue;
      const auto index = static_cast<MaterialIndex>(material);
      const auto name =
          out.stem().string() + "." + hierarchy.model().material(index).id + out.extension().string();
      auto file = indexedFile(hierarchy, maker, options, index, out.parent_path() / name, job);
      if (!file)
         return file.error();
      files.push_back(*std::move(file));
   }
   return files;
}

} // namespace

Result<std::vector<ExportedFile>> exportFiles(const Hierarchy &hierarchy, const PartMaker *maker,
                                              const ExportOptions &options, const std::filesystem::path &out,
                                              const Job &job)
{
   const bool stream =
       options.format == GeometryFormat::stl && options.geometry.what != GeometryOptions::What::struts;
   return stream ? streamed(hierarchy, maker, options, out, job)
                 : indexed(hierarchy, maker, options, out, job);
}

} // namespace diatom
