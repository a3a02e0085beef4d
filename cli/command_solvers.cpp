// diatom solvers: every solver found, what it can do, and which modules were turned down and why.
#include "cli/commands.h"

#include <CLI/CLI.hpp>

namespace diatom::cli {

namespace {

nlohmann::ordered_json listed(std::int64_t count, const char *const *names)
{
   auto list = nlohmann::ordered_json::array();
   for (std::int64_t k = 0; names && k < count; ++k)
      list.push_back(names[k]);
   return list;
}

/// A row of the table; capabilities need the module, and a module that does not load says so in the verdict.
nlohmann::ordered_json describe(const Provided &provided, const Candidate &candidate, Context &context)
{
   nlohmann::ordered_json row{
       {"id", provided.id}, {"name", provided.name}, {"version", candidate.manifest.version}};
   std::string verdict = candidate.verdict;
   for (const char *key : {"physics", "analyses", "effects", "lattices"})
      row[key] = nlohmann::ordered_json::array();
   row["deterministic"] = nullptr;
   if (candidate.accepted) {
      const Status asked = context.catalogue()->callWith(
          DIATOM_SOLVER_1, provided.id, {}, "capabilities", context.job(),
          [&](const void *table, const diatom_call *call, const diatom_create *create) -> std::int32_t {
             const diatom_capabilities *caps = nullptr;
             const auto *solver = static_cast<const diatom_solver *>(table);
             const std::int32_t status = solver->capabilities(call, create->id, &caps);
             if (status != DIATOM_OK || !caps)
                return status != DIATOM_OK ? status : DIATOM_INTERNAL;
             row["physics"] = listed(caps->physics, caps->physics_name);
             row["analyses"] = listed(caps->analyses, caps->analysis_name);
             row["effects"] = listed(caps->effects, caps->effect_name);
             row["lattices"] = listed(caps->lattices, caps->lattice);
             row["deterministic"] = caps->deterministic != 0;
             return DIATOM_OK;
          });
      if (!asked)
         verdict = asked.error().message;
   }
   auto parameters = nlohmann::ordered_json::array();
   for (const Parameter &parameter : provided.parameters)
      parameters.push_back(parameter.name);
   row["parameters"] = std::move(parameters);
   row["verdict"] = verdict;
   return row;
}

void listSolvers(Context &context)
{
   auto rows = nlohmann::ordered_json::array();
   for (const Candidate &candidate : context.catalogue()->candidates())
      for (const Provided &provided : candidate.manifest.provides)
         if (provided.interface == DIATOM_SOLVER_1)
            rows.push_back(describe(provided, candidate, context));
   context.printTable(rows);
   if (rows.empty())
      context.note("No solvers were found. Set DIATOM_PLUGIN_PATH or give --plugins FOLDER.");
}

} // namespace

void addSolvers(CLI::App &app, Context &context)
{
   app.add_subcommand("solvers", "List every solver found, what it can do, and its verdict")
       ->callback([&context] { listSolvers(context); });
}

} // namespace diatom::cli
