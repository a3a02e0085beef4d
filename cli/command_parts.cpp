// diatom parts: what turns cells into parts, with the part types each offers; for a file, the list of its
// parts in every way that its lattice has.
#include "cli/commands.h"

#include "assembly/chosen_parts.h"
#include "parts/fitting_parts.h"
#include "parts/part_list.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace diatom::cli {

namespace {

nlohmann::ordered_json typesOf(const PartMaker &maker)
{
   auto types = nlohmann::ordered_json::array();
   for (const PartType &type : maker.types())
      types.push_back({{"id", type.id}, {"name", type.name}, {"share", type.share}});
   return types;
}

/// One row per thing on offer; one that cannot be created tells why in its verdict.
nlohmann::ordered_json partsRow(const Provided &provided, const Candidate &candidate, Context &context)
{
   nlohmann::ordered_json row{{"id", provided.id}, {"name", provided.name}, {"verdict", candidate.verdict}};
   if (candidate.accepted) {
      const auto maker = PartMaker::make(*context.catalogue(), provided.id, {}, "", context.job());
      if (maker) {
         row["lattices"] = (*maker)->lattices();
         row["details"] = (*maker)->details();
         row["partial"] = (*maker)->partial();
         row["types"] = typesOf(**maker);
      } else {
         row["verdict"] = maker.error().message;
      }
   }
   row["plugin"] = candidate.manifest.id;
   row["folder"] = candidate.folder.string();
   return row;
}

void listKinds(Context &context)
{
   auto rows = nlohmann::ordered_json::array();
   for (const Candidate &candidate : context.catalogue()->candidates())
      for (const Provided &provided : candidate.manifest.provides)
         if (provided.interface == DIATOM_PARTS_1)
            rows.push_back(partsRow(provided, candidate, context));
   if (!context.json)
      for (auto &row : rows) {
         std::string names;
         for (const auto &type : row.value("types", nlohmann::ordered_json::array()))
            names += (names.empty() ? "" : ", ") + type["name"].get<std::string>();
         row = {{"id", row["id"]}, {"types", names}, {"verdict", row["verdict"]}};
      }
   context.printTable(rows);
}

/// One way to make the design of parts.
Result<nlohmann::ordered_json> partList(const PartMaker &maker, const Context::Input &input, const Job &job)
{
   const auto parts = maker.decompose(*input.hierarchy, job);
   if (!parts)
      return parts.error();
   const auto counts = countParts(maker, *parts, *input.hierarchy, job);
   if (!counts)
      return counts.error();
   nlohmann::ordered_json list{{"id", maker.id()}, {"parts", parts->parts.size()}, {"mass_kg", 0.0}};
   list["cells_left"] = parts->left.size();
   list["rows"] = nlohmann::ordered_json::array();
   double mass = 0;
   for (const PartCount &row : *counts) {
      const double together = static_cast<double>(row.count) * row.mass;
      list["rows"].push_back({{"type", maker.types()[static_cast<std::size_t>(row.type)].id},
                              {"length", row.length},
                              {"material", input.hierarchy->model().material(row.material).id},
                              {"count", row.count},
                              {"volume_m3", row.volume},
                              {"mass_each_kg", row.mass},
                              {"mass_kg", together}});
      mass += together;
   }
   list["mass_kg"] = mass;
   return list;
}

/// The lists as one table for people, each closed by its sum.
nlohmann::ordered_json tableOf(const nlohmann::ordered_json &lists)
{
   auto rows = nlohmann::ordered_json::array();
   for (const auto &list : lists) {
      for (const auto &row : list["rows"])
         rows.push_back({{"parts", list["id"]},
                         {"type", row["type"]},
                         {"length", row["length"]},
                         {"material", row["material"]},
                         {"count", row["count"]},
                         {"each_kg", row["mass_each_kg"]},
                         {"mass_kg", row["mass_kg"]}});
      rows.push_back({{"parts", list["id"]},
                      {"type", "all"},
                      {"length", ""},
                      {"material", ""},
                      {"count", list["parts"]},
                      {"each_kg", ""},
                      {"mass_kg", list["mass_kg"]}});
   }
   return rows;
}

void listParts(const std::string &file, const std::string &chosen, Context &context)
{
   const auto input = context.open(file);
   if (!input)
      return;
   const std::string &lattice = input->lattice->spec().id;
   const AssemblySetup &setup = input->opened.design.assembly;
   if (!setup.parts.empty() && !context.catalogue()->offer(DIATOM_PARTS_1, setup.parts))
      context.note(
          fmt::format("the design is to be made of {}, which is not installed; `diatom plugins` lists what "
                      "there is",
                      setup.parts));
   std::vector<std::string> ids{chosen};
   if (chosen.empty()) {
      ids.clear();
      for (const auto &maker : fittingParts(*context.catalogue(), lattice, context.job()))
         ids.push_back(maker->id());
   }
   auto lists = nlohmann::ordered_json::array();
   Error problem{ErrorCode::unsupported, "no installed plugin makes parts for the lattice " + lattice +
                                             "; \"diatom parts\" lists those there are"};
   for (const std::string &id : ids) {
      const auto maker = chosenParts(*context.catalogue(), setup, id, lattice, context.job());
      const auto list = maker ? partList(**maker, *input, context.job()) : maker.error();
      if (list)
         lists.push_back(*list);
      else
         problem = list.error();
      // One of several ways may not suit this design (bricks of two materials, another height).
      if (!list && ids.size() > 1)
         context.note(problem.message);
   }
   if (lists.empty())
      context.fail(problem);
   else
      context.printTable(context.json ? lists : tableOf(lists));
}

} // namespace

void addParts(CLI::App &app, Context &context)
{
   struct Arguments
   {
      std::string file, parts;
   };
   const auto arguments = std::make_shared<Arguments>();
   auto *command =
       app.add_subcommand("parts", "List what turns cells into parts; for a file, the parts it is made of");
   command->add_option("FILE", arguments->file,
                       "Design, or file of an earlier program; - reads standard input");
   command->add_option("--parts", arguments->parts,
                       "Only this way to make it, of those that fit the lattice");
   command->callback([arguments, &context] {
      if (arguments->file.empty())
         listKinds(context);
      else
         listParts(arguments->file, arguments->parts, context);
   });
}

} // namespace diatom::cli
