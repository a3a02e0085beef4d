// diatom parts: what turns cells into parts, with the part types each offers.
#include "cli/commands.h"

#include "parts/decomposition.h"

#include <CLI/CLI.hpp>

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
nlohmann::ordered_json rowOf(const Provided &provided, const Candidate &candidate, Context &context)
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

} // namespace

void addParts(CLI::App &app, Context &context)
{
   auto *command = app.add_subcommand("parts", "List what turns cells into parts");
   command->callback([&context] {
      auto rows = nlohmann::ordered_json::array();
      for (const Candidate &candidate : context.catalogue()->candidates())
         for (const Provided &provided : candidate.manifest.provides)
            if (provided.interface == DIATOM_PARTS_1)
               rows.push_back(rowOf(provided, candidate, context));
      if (!context.json)
         for (auto &row : rows) {
            std::string names;
            for (const auto &type : row.value("types", nlohmann::ordered_json::array()))
               names += (names.empty() ? "" : ", ") + type["name"].get<std::string>();
            row = {{"id", row["id"]}, {"types", names}, {"verdict", row["verdict"]}};
         }
      context.printTable(rows);
   });
}

} // namespace diatom::cli
