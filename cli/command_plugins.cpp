// diatom plugins: every plugin folder found, accepted or not, and why; consent to run one, and another trial.
#include "cli/commands.h"

#include "plugins/consent.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace diatom::cli {

namespace {

/// Libraries that were never tried are, so that every verdict is the one that counts.
void listPlugins(Context &context)
{
   auto rows = nlohmann::ordered_json::array();
   const auto catalogue = Catalogue::find(context.searchFolders(), true);
   for (const Candidate &candidate : catalogue->candidates()) {
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

void trust(Context &context, const std::string &id)
{
   const auto decided = trustPlugin(*context.catalogue(), id);
   if (!decided)
      return context.fail(decided.error());
   for (const Decided &one : *decided)
      context.note(fmt::format("{} {} may run from now on: {} (sha256 {}). Another version of it asks again.",
                               id, one.candidate->manifest.version,
                               one.candidate->library().lexically_normal().string(), one.hash));
}

void retry(Context &context, const std::string &id)
{
   const auto decided = retryPlugins(*context.catalogue(), id);
   if (!decided)
      return context.fail(decided.error());
   const auto catalogue = Catalogue::find(context.searchFolders(), true);
   for (const Candidate &candidate : catalogue->candidates())
      for (const Decided &one : *decided)
         if (one.candidate->folder == candidate.folder)
            context.note(fmt::format("{}: {}", candidate.manifest.id, candidate.verdict));
}

} // namespace

void addPlugins(CLI::App &app, Context &context)
{
   CLI::App *command = app.add_subcommand("plugins", "List every plugin found, with its verdict");
   command->require_subcommand(0, 1);
   CLI::App *trusted =
       command->add_subcommand("trust", "Let a plugin of your own plugin folder run, as it is now");
   CLI::App *retried =
       command->add_subcommand("retry", "Try again a plugin that crashed or hung; all without an ID");
   const auto id = std::make_shared<std::string>();
   trusted->add_option("ID", *id, "Id of the plugin")->required();
   retried->add_option("ID", *id, "Id of the plugin");
   trusted->callback([&context, id] { trust(context, *id); });
   retried->callback([&context, id] { retry(context, *id); });
   command->callback([&context, command] {
      if (command->get_subcommands().empty())
         listPlugins(context);
   });
}

} // namespace diatom::cli
