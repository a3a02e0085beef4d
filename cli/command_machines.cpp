// diatom machines: the machines that programs can be written for, with their settings.
#include "cli/commands.h"

#include "assembly/plan.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace diatom::cli {

namespace {

nlohmann::ordered_json axesOf(const diatom_machine_description &machine)
{
   auto axes = nlohmann::ordered_json::array();
   for (int a = 0; a < machine.axes; ++a)
      axes.push_back({{"name", machine.axis_name[a]},
                      {"kind", machine.axis_kind[a] == DIATOM_AXIS_LINEAR ? "linear" : "rotary"},
                      {"range", {machine.axis_minimum[a], machine.axis_maximum[a]}},
                      {"speed", machine.axis_speed[a]}});
   return axes;
}

nlohmann::ordered_json settingsOf(const Provided &provided)
{
   auto settings = nlohmann::ordered_json::array();
   for (const Parameter &parameter : provided.parameters) {
      nlohmann::ordered_json setting{{"name", parameter.name}};
      if (parameter.kind == Parameter::Kind::number || parameter.kind == Parameter::Kind::integer) {
         setting["default"] = parameter.number;
         setting["range"] = {parameter.minimum, parameter.maximum};
      } else {
         setting["default"] = parameter.text;
      }
      if (!parameter.unit.empty())
         setting["unit"] = parameter.unit;
      if (!parameter.choices.empty())
         setting["choices"] = parameter.choices;
      setting["help"] = parameter.help;
      settings.push_back(std::move(setting));
   }
   return settings;
}

/// One row per thing on offer; one that cannot be created tells why in its verdict.
nlohmann::ordered_json machineRow(const Provided &provided, const Candidate &candidate, Context &context)
{
   nlohmann::ordered_json row{{"id", provided.id}, {"name", provided.name}, {"verdict", candidate.verdict}};
   if (candidate.accepted) {
      const auto machine = Machine::make(*context.catalogue(), provided.id, {}, context.job());
      if (machine) {
         row["axes"] = axesOf((*machine)->description());
         row["feeders"] = (*machine)->description().feeders;
         row["suffix"] = (*machine)->description().suffix;
      } else {
         row["verdict"] = machine.error().message;
      }
   }
   row["settings"] = settingsOf(provided);
   row["plugin"] = candidate.manifest.id;
   row["folder"] = candidate.folder.string();
   return row;
}

/// For people: ranges in millimetres in one word.
nlohmann::ordered_json shortRow(const nlohmann::ordered_json &row)
{
   std::string axes;
   for (const auto &axis : row.value("axes", nlohmann::ordered_json::array())) {
      const double scale = axis["kind"] == "linear" ? 1e3 : 1;
      axes += fmt::format("{}{} {:g}..{:g}", axes.empty() ? "" : ", ", axis["name"].get<std::string>(),
                          scale * axis["range"][0].get<double>(), scale * axis["range"][1].get<double>());
   }
   return {{"id", row["id"]},
           {"axes (mm)", axes},
           {"feeders", row.value("feeders", 0)},
           {"suffix", row.value("suffix", "")},
           {"verdict", row["verdict"]}};
}

} // namespace

void addMachines(CLI::App &app, Context &context)
{
   auto *command = app.add_subcommand("machines", "List the machines programs can be written for");
   command->footer("Settings of each, for diatom plan --set, with --json.");
   command->callback([&context] {
      auto rows = nlohmann::ordered_json::array();
      for (const Candidate &candidate : context.catalogue()->candidates())
         for (const Provided &provided : candidate.manifest.provides)
            if (provided.interface == DIATOM_MACHINE_1)
               rows.push_back(context.json ? machineRow(provided, candidate, context)
                                           : shortRow(machineRow(provided, candidate, context)));
      context.printTable(rows);
   });
}

} // namespace diatom::cli
