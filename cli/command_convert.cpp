// diatom convert: any readable file to a .diatom document or a file of another program; meshes become
// cells of a lattice on the way.
#include "cli/commands.h"
#include "cli/lengths.h"
#include "cli/number_checks.h"

#include "core/file.h"
#include "formats/foreign.h"
#include "formats/import_mesh.h"
#include "io/mesh_read.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <map>
#include <memory>

namespace diatom::cli {

namespace {

struct ConvertOptions
{
   std::string in, out, format;
   bool packed = false;
   // Of meshes:
   MeshImport mesh;
   LatticeSpec lattice;
   std::string rule = "centre";
   std::vector<std::string> inside;
   bool pitchGiven = false;
};

const std::map<std::string, BoundaryRule> kRules = {
    {"centre", BoundaryRule::centre}, {"touch", BoundaryRule::touch}, {"fraction", BoundaryRule::fraction}};

Result<Opened> fillMesh(Context &context, const ConvertOptions &options)
{
   if (!options.pitchGiven)
      return Error{
          ErrorCode::usage,
          fmt::format("{}: a mesh becomes cells of a pitch: give one, e.g. --pitch 1mm", options.in)};
   MeshImport how = options.mesh;
   how.rule = kRules.at(options.rule);
   for (const std::string &text : options.inside) {
      const auto equals = text.rfind('=');
      if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
         return Error{ErrorCode::usage, fmt::format("--inside takes MESH=MATERIAL, not \"{}\"", text)};
      how.inside.emplace_back(text.substr(0, equals), text.substr(equals + 1));
   }
   LatticeSpec spec = options.lattice;
   spec.id = fullId(*context.catalogue(), DIATOM_LATTICE_1, spec.id);
   const auto lattice = Lattice::make(*context.catalogue(), spec, context.job());
   if (!lattice)
      return lattice.error();
   return importMesh(options.in, how, **lattice, context.job());
}

/// A file of another program, which needs the cells and not only the document.
void convertForeign(Context &context, Opened opened, const ForeignFormat &format, const std::string &out)
{
   const auto input = context.prepare(std::move(opened));
   if (!input)
      return;
   std::vector<std::string> notes;
   const Status saved =
       writeForeign(input->opened.design, *input->hierarchy, format, out, notes, context.job());
   for (const std::string &text : notes)
      context.note(text);
   if (!saved)
      context.fail(saved.error());
}

/// To a .diatom document it opens without a lattice: one whose lattice is not installed converts all the
/// same.
void convert(Context &context, const ConvertOptions &options)
{
   const auto suffix = std::filesystem::path(options.out).extension().string();
   const ForeignFormat *foreign = foreignFormat(options.format, options.out);
   if (!foreign && options.out != "-" && suffix != ".diatom") {
      context.fail(
          {ErrorCode::usage,
           fmt::format(
               "{}: documents end in .diatom, files of other programs in .vox, .vxc, .vxa, or in .json "
               "with --format amoeba or dmdesign; for meshes use `diatom export`",
               options.out)});
      return;
   }
   auto opened = isMeshFile(options.in) ? fillMesh(context, options) : openDesign(options.in, context.job());
   if (!opened) {
      context.fail(opened.error());
      return;
   }
   for (const auto &text : opened->notes)
      context.note(text);
   if (foreign) {
      convertForeign(context, *std::move(opened), *foreign, options.out);
      return;
   }
   Status saved;
   if (options.packed) {
      const auto bytes = writeDesign(opened->design, true, context.job());
      saved = bytes ? writeFileAtomic(options.out, *bytes) : Status(bytes.error());
   } else {
      saved = saveDesign(opened->design, options.out, context.job());
   }
   if (!saved)
      context.fail(saved.error());
}

} // namespace

void addConvert(CLI::App &app, Context &context)
{
   auto *command = app.add_subcommand(
       "convert", "Turn any readable file into a .diatom document or a file of another program");
   const auto options = std::make_shared<ConvertOptions>();
   command
       ->add_option(
           "IN", options->in,
           "a .diatom document, a file of AMOEBA, DMDesign, MagicaVoxel or VoxCAD, or a mesh (stl, obj, "
           "ply, 3mf, gltf, ...); - "
           "reads standard input, but no mesh")
       ->required();
   command
       ->add_option(
           "OUT", options->out,
           "the .diatom document, or the .vox, .vxc, .vxa or .json file of another program; - writes "
           "to standard output")
       ->required();
   std::vector<std::string> formats;
   for (const ForeignFormat &format : foreignFormats())
      formats.emplace_back(format.name);
   command
       ->add_option("--format", options->format, "another program's format, where the suffix does not say it")
       ->check(CLI::IsMember(formats));
   command->add_flag("--packed", options->packed, "write the packed form even when small");

   auto *meshes = command->add_option_group("meshes", "How a mesh becomes cells");
   meshes->add_option("--lattice", options->lattice.id, "the lattice of the cells: see diatom lattices")
       ->capture_default_str();
   auto *pitch = meshes->add_option("--pitch", options->lattice.pitch, "length of a lattice unit, e.g. 1mm")
                     ->transform(kLength);
   meshes->add_option("--unit", options->mesh.unit, "what a number of the mesh stands for, e.g. mm or 25.4mm")
       ->transform(kLength);
   meshes
       ->add_option("--size", options->mesh.size,
                    "scale the mesh so that its longest side is this, e.g. 60mm")
       ->transform(kLength);
   meshes->add_flag("--keep-place", options->mesh.keepPlace,
                    "leave the mesh where it is; else it is moved to cell 0,0,0");
   meshes->add_option("--material", options->mesh.material,
                      "id of the material of all cells; else one per piece or colour of the mesh");
   meshes
       ->add_option("--inside", options->inside,
                    "MESH=MATERIAL: cells inside that other mesh are of this material; repeats")
       ->allow_extra_args(false);
   meshes
       ->add_option("--rule", options->rule,
                    "which cells of the boundary belong: by centre, by touch, or by fraction")
       ->check(CLI::IsMember({"centre", "touch", "fraction"}))
       ->capture_default_str();
   meshes->add_option("--fraction", options->mesh.fraction, "of a cell's volume that must be inside")
       ->check(CLI::Range(1.0 / 64, 1.0))
       ->capture_default_str();
   command->footer(
       "Example:\n  diatom convert bunny.stl bunny.diatom --lattice kelvin --pitch 2mm --size 100mm");
   command->callback([&context, options, pitch] {
      options->pitchGiven = pitch->count() > 0;
      convert(context, *options);
   });
}

} // namespace diatom::cli
