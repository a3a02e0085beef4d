// diatom plugins: every plugin folder found, accepted or not, and why.
#include "cli/commands.h"

#include <CLI/CLI.hpp>

namespace diatom::cli {

namespace {

void listPlugins(Context &context)
{
   auto rows = nlohmann::ordered_json::array();
   for (const Candidate &candidate : context.catalogue()->candidates()) {
      std::string provides;
      for (const Provided &provided : candidate.manifest.provides)
         provides += (provides.empty() ? "" : ", ") + provided.interface;
      rows.push_back({{"id", candidate.manifest.id.empty() ? "?" : candidate.manifest.id},
                      {"version", candidate.manifest.version},
                      {"provides", provides},
                      {"verdict", candidate.verdict},
                      {"folder", candidate.folder.lexically_normal().string()}});
   }
   context.printTable(rows);
   if (rows.empty())
      context.note("No plugins were found. Set DIATOM_PLUGIN_PATH or give --plugins FOLDER.");
}

} // namespace

void addPlugins(CLI::App &app, Context &context)
{
   app.add_subcommand("plugins", "List every plugin found, with its verdict")->callback([&context] {
      listPlugins(context);
   });
}

} // namespace diatom::cli
