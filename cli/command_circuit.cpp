// diatom circuit: nets, sources and driven actuators of a design, what is wrong with them, and voltages over
// time.
#include "cli/commands.h"
#include "cli/number_checks.h"
#include "cli/scene_json.h"
#include "core/file.h"
#include "core/text.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>

namespace diatom::cli {

namespace {

constexpr double kSignalRows = 200, kMostRows = 1e7;

struct CircuitOptions
{
   std::string file, output = "-";
   double until = 0, every = 0;
};

nlohmann::ordered_json describe(const Networks &networks, const Setup &setup)
{
   nlohmann::ordered_json object;
   object["nets"] = nlohmann::ordered_json::array();
   for (const Network &net : networks.nets) {
      nlohmann::ordered_json row{{"cells", net.cells.size()}, {"first_cell", toJson(net.cells.front())}};
      row["sources"] = net.sources;
      row["returns"] = net.returns;
      row["actuators"] = net.actuators.size();
      object["nets"].push_back(std::move(row));
   }
   object["sources"] = nlohmann::ordered_json::array();
   for (const Source &source : setup.sources)
      object["sources"].push_back({{"cell", toJson(source.cell)},
                                   {"waveform", waveformName(source.waveform)},
                                   {"frequency_hz", source.frequency},
                                   {"phase", source.phase},
                                   {"duty", source.duty},
                                   {"inverted", source.inverted},
                                   {"amplitude_v", source.amplitude}});
   object["actuators"] = nlohmann::ordered_json::array();
   for (const DrivenActuator &actuator : networks.actuators)
      object["actuators"].push_back({{"cell", toJson(actuator.cell)},
                                     {"axis", std::string(1, "xyz"[actuator.axis])},
                                     {"net_minus", actuator.netA},
                                     {"net_plus", actuator.netB}});
   object["problems"] = toJson(networks.problems);
   return object;
}

/// Voltage of every net at regular times, as CSV.
Status writeVoltages(const Networks &networks, const Setup &setup, const CircuitOptions &options,
                     const Job &job)
{
   const double every = options.every > 0 ? options.every : options.until / kSignalRows;
   if (options.until / every > kMostRows)
      return Error{ErrorCode::usage, "--every is too short: the table would have more than ten million rows"};
   AtomicFile file(options.output);
   std::string line = "time (s)";
   for (std::size_t net = 0; net < networks.nets.size(); ++net)
      line += fmt::format(",net {} (V)", net);
   file.write(line + "\n");
   const auto rows = static_cast<std::int64_t>(std::floor(options.until / every * (1 + 1e-12)));
   for (std::int64_t row = 0; row <= rows; ++row) {
      if (job.cancelled())
         return Error{ErrorCode::cancelled, "cancelled while writing voltages"};
      const double time = every * static_cast<double>(row);
      line = numberText(time);
      for (const Network &net : networks.nets)
         line += "," + numberText(netVoltage(net, setup, time));
      file.write(line + "\n");
   }
   return file.commit();
}

void showCircuit(const CircuitOptions &options, Context &context)
{
   const auto input = context.open(options.file);
   if (!input)
      return;
   const Setup &setup = input->opened.design.setup;
   const Networks networks = findNetworks(*input->hierarchy, setup, context.job());
   if (context.job().cancelled())
      return context.fail({ErrorCode::cancelled, "cancelled while finding the nets"});
   const bool toOutput = options.output == "-";
   if (options.until > 0)
      if (const Status written = writeVoltages(networks, setup, options, context.job()); !written)
         return context.fail(written.error());
   if (options.until <= 0 || !toOutput)
      context.print(describe(networks, setup));
   else // standard output belongs to the table
      for (const Problem &problem : networks.problems)
         context.note("problem: " + problem.text);
   if (hasErrors(networks.problems))
      context.exit = kCheckFailed;
}

} // namespace

void addCircuit(CLI::App &app, Context &context)
{
   const auto options = std::make_shared<CircuitOptions>();
   CLI::App *command =
       app.add_subcommand("circuit", "Show conductor nets, sources, actuators and wiring problems");
   command->add_option("FILE", options->file, "A design of any readable format, - for standard input")
       ->required();
   command
       ->add_option("--until", options->until,
                    "Also write the voltage of every net until this time, s, as CSV")
       ->check(kPositive);
   command->add_option("--every", options->every, "Interval of the voltages, s")->check(kPositive);
   command->add_option("-o,--output", options->output, "File for the voltages, - for standard output");
   command->footer("Examples:\n  diatom circuit gripper.diatom --json\n"
                   "  diatom circuit gripper.diatom --until 0.1 --every 0.001 -o voltages.csv");
   command->callback([options, &context] { showCircuit(*options, context); });
}

} // namespace diatom::cli
