// diatom export: the geometry of a design, of cells, parts or struts, whole or by material.
#include "cli/commands.h"
#include "cli/lengths.h"
#include "cli/number_checks.h"

#include "assembly/chosen_parts.h"
#include "io/export_files.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <optional>
#include <utility>

namespace diatom::cli {

namespace {

struct ExportArguments
{
   std::string file, out, as = "cells", material, unit, parts, format, solids = "material";
   bool eachMaterial = false, ascii = false;
   int detail = -1;
   std::string strutWidth, section = "round";
   std::optional<int> sides;
   bool connections = false, overlapping = false, beams = false;
};

std::vector<std::string> unitNames()
{
   std::vector<std::string> names;
   for (const auto &[name, metres] : kLengthUnits)
      names.emplace_back(name);
   return names;
}

double metresOf(const std::string &unit)
{
   for (const auto &[name, metres] : kLengthUnits)
      if (unit == name)
         return metres;
   return 1;
}

/// 0 for all of them.
Result<MaterialIndex> materialOf(const ExportArguments &arguments, const Model &model)
{
   if (arguments.material.empty())
      return MaterialIndex{0};
   const MaterialIndex material = model.material(arguments.material);
   if (material != 0)
      return material;
   std::string known;
   for (const Material &each : *model.materials)
      if (!each.id.empty())
         known += (known.empty() ? "" : ", ") + each.id;
   return Error{ErrorCode::usage, fmt::format("{} has no material \"{}\"; it has {}", arguments.file,
                                              arguments.material, known.empty() ? "none" : known)};
}

/// Why the arguments do not go together; empty when they do.
std::string conflict(const ExportArguments &arguments, GeometryFormat format)
{
   if (arguments.ascii && format != GeometryFormat::stl)
      return "--ascii is for STL only; leave it out";
   if (arguments.solids == "one" && arguments.eachMaterial)
      return "--solids one and --each-material contradict each other; give one of them";
   const bool struts = arguments.as == "struts";
   const bool shaped = !arguments.strutWidth.empty() || arguments.sides || arguments.section != "round";
   if (!struts && (shaped || arguments.connections || arguments.overlapping || arguments.beams))
      return "--strut-..., --connections, --overlapping and --beams are for --as struts; add that";
   if (arguments.beams && format != GeometryFormat::threeMf)
      return "only 3MF knows beams; choose a .3mf file or leave --beams out";
   if (arguments.beams && (arguments.section != "round" || arguments.sides || arguments.overlapping))
      return "beams are round and without a surface; leave --strut-section, --strut-sides and --overlapping "
             "out";
   if (struts && arguments.ascii)
      return "struts are written as binary STL; leave --ascii out";
   if (arguments.section == "square" && arguments.sides)
      return "--strut-sides is for round struts; leave it or --strut-section out";
   return {};
}

using Json = nlohmann::ordered_json;

/// One export with all that it needs.
class Export
{
public:
   Export(const ExportArguments &arguments, GeometryFormat format, const Context::Input &input,
          Context &context)
       : m_arguments(arguments), m_format(format), m_hierarchy(*input.hierarchy),
         m_assembly(input.opened.design.assembly), m_context(context)
   {
      m_unitName = !arguments.unit.empty() ? arguments.unit : isGltf() ? "m" : "mm";
   }

   Result<Json> run()
   {
      const auto material = materialOf(m_arguments, m_hierarchy.model());
      if (!material)
         return material.error();
      const auto struts = strutOptions();
      if (!struts)
         return struts.error();
      ExportOptions options;
      options.format = m_format;
      options.geometry.what = m_arguments.as == "parts"    ? GeometryOptions::What::parts
                              : m_arguments.as == "struts" ? GeometryOptions::What::struts
                                                           : GeometryOptions::What::cells;
      if (*material != 0)
         options.geometry.material = *material;
      options.geometry.apart = m_arguments.solids == "material";
      options.geometry.detail = m_arguments.detail;
      options.geometry.struts = *struts;
      options.eachMaterial = m_arguments.eachMaterial;
      options.ascii = m_arguments.ascii;
      options.unit = unit();
      std::shared_ptr<const PartMaker> maker;
      if (m_arguments.as == "parts") {
         auto made = chosenParts(*m_context.catalogue(), m_assembly,
                                 fullId(*m_context.catalogue(), DIATOM_PARTS_1, m_arguments.parts),
                                 m_hierarchy.model().lattice.id, m_context.job());
         if (!made)
            return made.error();
         maker = *std::move(made);
      }
      const auto written = exportFiles(m_hierarchy, maker.get(), options, m_arguments.out, m_context.job());
      if (!written)
         return written.error();
      auto files = Json::array();
      for (const ExportedFile &file : *written)
         files.push_back(report(file));
      return Json{{"as", m_arguments.as}, {"unit", m_unitName}, {"files", std::move(files)}};
   }

private:
   bool isGltf() const { return m_format == GeometryFormat::gltf || m_format == GeometryFormat::glb; }
   double unit() const { return metresOf(m_unitName); }

   Result<StrutOptions> strutOptions() const
   {
      StrutOptions options;
      options.connections = m_arguments.connections;
      options.overlapping = m_arguments.overlapping;
      options.beams = m_arguments.beams;
      options.sides = m_arguments.section == "square" ? 4 : m_arguments.sides.value_or(options.sides);
      if (!m_arguments.strutWidth.empty()) {
         const auto width = parseLength(m_arguments.strutWidth, metresOf(m_unitName));
         if (!width)
            return Error{ErrorCode::usage,
                         fmt::format("--strut-width {}: give a positive length, as 0.4 or 0.4mm",
                                     m_arguments.strutWidth)};
         options.width = *width;
      }
      return options;
   }

   Json report(const ExportedFile &written) const
   {
      Json file{{"file", written.file.string()}};
      if (written.material)
         file["material"] = m_hierarchy.model().material(*written.material).id;
      if (written.solids > 0)
         file["solids"] = written.solids;
      file["triangles"] = written.triangles;
      file["bytes"] = written.bytes;
      file["cells"] = written.cells;
      if (m_arguments.as == "parts")
         file["parts"] = written.parts;
      if (m_arguments.as == "struts") {
         file["struts"] = written.struts.struts;
         file["nodes"] = written.struts.nodes;
         file["strut_width"] = written.struts.width / unit();
         if (written.struts.widest > 0)
            file["widest"] = written.struts.widest / unit();
      }
      if (written.edgeContacts)
         file["edge_contacts"] = *written.edgeContacts;
      if (written.vertexContacts)
         file["vertex_contacts"] = *written.vertexContacts;
      return file;
   }

   const ExportArguments &m_arguments;
   GeometryFormat m_format;
   const Hierarchy &m_hierarchy;
   const AssemblySetup &m_assembly;
   Context &m_context;
   std::string m_unitName;
};

/// By --format, else by the suffix; STL on standard output.
Result<GeometryFormat> formatOf(const ExportArguments &arguments)
{
   if (!arguments.format.empty())
      return *geometryFormat("x." + arguments.format);
   if (arguments.out == "-")
      return GeometryFormat::stl;
   if (const auto format = geometryFormat(arguments.out))
      return *format;
   return Error{ErrorCode::usage,
                fmt::format("{}: the format is told by the suffix, one of {}; or give --format",
                            arguments.out, geometrySuffixes())};
}

void run(const ExportArguments &arguments, Context &context)
{
   const auto format = formatOf(arguments);
   if (!format)
      return context.fail(format.error());
   if (const std::string why = conflict(arguments, *format); !why.empty())
      return context.fail({ErrorCode::usage, why});
   const auto input = context.open(arguments.file);
   if (!input)
      return;
   const auto report = Export(arguments, *format, *input, context).run();
   if (!report)
      return context.fail(report.error());
   if (arguments.out != "-") // standard output carries the file itself
      context.print(*report);
}

} // namespace

void addExport(CLI::App &app, Context &context)
{
   auto arguments = std::make_shared<ExportArguments>();
   auto *command = app.add_subcommand("export", "Write a design as STL, 3MF, OBJ, PLY or glTF");
   command->add_option("FILE", arguments->file, "A design, - for standard input")->required();
   command
       ->add_option("OUT", arguments->out, "The file, its format told by the suffix; - for standard output")
       ->required();
   command
       ->add_option("--as", arguments->as,
                    "Cells as their polyhedra, the parts that are really made, or the edges as struts")
       ->check(CLI::IsMember({"cells", "parts", "struts"}))
       ->capture_default_str();
   auto *material = command->add_option("--material", arguments->material, "Only the material of this id");
   command->add_flag("--each-material", arguments->eachMaterial, "One file per material: OUT.MATERIAL.stl")
       ->excludes(material);
   command
       ->add_option("--solids", arguments->solids,
                    "In all but STL: a solid for each material, or one without walls between materials")
       ->check(CLI::IsMember({"material", "one"}))
       ->capture_default_str();
   command->add_option("--parts", arguments->parts,
                       "Which parts, when several fit the lattice: see diatom parts");
   command->add_option("--detail", arguments->detail, "Mesh detail of parts, 0 coarse; the finest by default")
       ->check(kNonNegative);
   command->add_option("--format", arguments->format, "Instead of the suffix's")
       ->check(CLI::IsMember({"stl", "3mf", "obj", "ply", "gltf", "glb"}));
   command->add_flag("--ascii", arguments->ascii, "ASCII instead of binary STL");
   command->add_option("--unit", arguments->unit, "Length of one unit; mm by default, glTF always has m")
       ->check(CLI::IsMember(unitNames()));
   command->add_option("--strut-width", arguments->strutWidth,
                       "Diameter or side of struts, as 0.4mm; chosen for the design by default");
   command->add_option("--strut-section", arguments->section, "Of struts")
       ->check(CLI::IsMember({"round", "square"}))
       ->capture_default_str();
   command
       ->add_option("--strut-sides", arguments->sides, "Flat sides of a round strut, 3 to 64; 8 by default")
       ->check(CLI::Range(3, 64));
   command->add_flag("--connections", arguments->connections,
                     "Struts from centre to centre of joined cells instead of edges");
   command->add_flag("--overlapping", arguments->overlapping,
                     "Struts as shells that overlap at nodes: quick, at any width");
   command->add_flag("--beams", arguments->beams,
                     "In 3MF: struts by their axes (the beam lattice extension)");
   command->callback([arguments, &context] { run(*arguments, context); });
}

} // namespace diatom::cli
