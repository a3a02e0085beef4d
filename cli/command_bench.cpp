// diatom bench: runs benchmarks by name or group and tells seconds, rate, peak memory and the hash of the
// result.
#include "cli/bench.h"
#include "cli/commands.h"

#include "core/file.h"
#include "core/text.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>

namespace diatom::cli {

namespace {

struct Group
{
   std::string_view name;
   std::span<const Benchmark> (*benchmarks)();
};

constexpr Group kGroups[] = {
    {"cells", cellBenchmarks},          {"export", exportBenchmarks},  {"import", importBenchmarks},
    {"mechanics", mechanicsBenchmarks}, {"plugins", pluginBenchmarks},
};

struct BenchOptions
{
   std::vector<std::string> names;
   bool quick = false, list = false;
   std::string csv;
};

/// A line of /proc/self/status in bytes, 0 where there is none.
std::uint64_t statusBytes(std::string_view key)
{
   std::ifstream status("/proc/self/status");
   for (std::string line; std::getline(status, line);)
      if (line.starts_with(key)) {
         const auto digit = line.find_first_of("0123456789");
         const auto end = line.find(' ', digit);
         return static_cast<std::uint64_t>(parseInteger(line.substr(digit, end - digit)).value_or(0)) * 1024;
      }
   return 0;
}

/// Sets VmHWM back to the present use (proc(5), clear_refs).
void resetPeak() { std::ofstream("/proc/self/clear_refs") << "5"; }

bool wanted(const BenchOptions &options, std::string_view group, std::string_view name)
{
   const std::string full = std::string(group) + '/' + std::string(name);
   return options.names.empty() ||
          std::any_of(options.names.begin(), options.names.end(),
                      [&](const auto &n) { return n == group || n == name || n == full; });
}

/// The first name that nothing answers to; empty when all do.
std::string unknownName(const BenchOptions &options)
{
   for (const std::string &name : options.names) {
      BenchOptions one;
      one.names = {name};
      bool any = false;
      for (const Group &group : kGroups)
         for (const Benchmark &benchmark : group.benchmarks())
            any = any || wanted(one, group.name, benchmark.name);
      if (!any)
         return name;
   }
   return {};
}

nlohmann::ordered_json row(std::string_view name, const Measure &measure)
{
   nlohmann::ordered_json all{{"name", name},
                              {"seconds", measure.seconds()},
                              {"rate", measure.rate()},
                              {"unit", measure.unit() + "/s"},
                              {"peak_bytes", measure.peakBytes()},
                              {"hash", measure.hash().text()}};
   for (const auto &[column, value] : measure.more())
      all[column] = value;
   return all;
}

std::string csv(const nlohmann::ordered_json &rows)
{
   std::vector<std::string> columns{"name", "seconds", "rate", "unit", "peak_bytes", "hash"};
   for (const auto &r : rows)
      for (const auto &[column, value] : r.items())
         if (std::find(columns.begin(), columns.end(), column) == columns.end())
            columns.push_back(column);
   std::string text;
   for (const std::string &column : columns)
      text += (text.empty() ? "" : ",") + column;
   text += '\n';
   for (const auto &r : rows)
      for (std::size_t i = 0; i < columns.size(); ++i) {
         text += i == 0 ? "" : ",";
         if (const auto value = r.find(columns[i]); value != r.end()) {
            if (value->is_number_float())
               text += numberText(value->get<double>());
            else
               text += value->is_string() ? value->get<std::string>() : value->dump();
         }
         if (i + 1 == columns.size())
            text += '\n';
      }
   return text;
}

void listBenchmarks(Context &context)
{
   auto rows = nlohmann::ordered_json::array();
   for (const Group &group : kGroups)
      for (const Benchmark &benchmark : group.benchmarks())
         rows.push_back(
             {{"name", fmt::format("{}/{}", group.name, benchmark.name)}, {"what", benchmark.what}});
   context.printTable(rows);
}

void run(const BenchOptions &options, Context &context)
{
   if (options.list)
      return listBenchmarks(context);
   if (const std::string unknown = unknownName(options); !unknown.empty())
      return context.fail(
          {ErrorCode::usage,
           fmt::format("There is no benchmark '{}'; diatom bench --list names them all.", unknown)});
   auto rows = nlohmann::ordered_json::array();
   for (const Group &group : kGroups)
      for (const Benchmark &benchmark : group.benchmarks()) {
         if (!wanted(options, group.name, benchmark.name) || context.job().cancelled())
            continue;
         const std::string name = fmt::format("{}/{}", group.name, benchmark.name);
         context.job().progress(0, name);
         Measure measure(context.catalogue(), options.quick, benchmark.name);
         if (const Status status = benchmark.run(measure); !status)
            context.fail(status.error());
         else
            rows.push_back(row(name, measure));
      }
   context.printTable(rows);
   if (!options.csv.empty())
      if (const Status written = writeFileAtomic(options.csv, csv(rows)); !written)
         context.fail(written.error());
}

} // namespace

std::uint64_t residentBytes() { return statusBytes("VmRSS:"); }

void Measure::time(int times, const std::function<void()> &work)
{
   const std::uint64_t before = statusBytes("VmRSS:");
   resetPeak();
   for (int n = 0; n < (m_quick ? 1 : times); ++n) {
      const auto start = std::chrono::steady_clock::now();
      work();
      m_seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
   }
   const std::uint64_t peak = statusBytes("VmHWM:");
   m_peakBytes = std::max(m_peakBytes, peak > before ? peak - before : 0);
}

void Measure::did(double amount, std::string unit)
{
   m_amount = amount;
   m_unit = std::move(unit);
}

double Measure::seconds() const
{
   if (m_seconds.empty())
      return 0;
   auto sorted = m_seconds;
   std::sort(sorted.begin(), sorted.end());
   return sorted[sorted.size() / 2];
}

double Measure::rate() const { return seconds() > 0 ? m_amount / seconds() : 0; }

void addBench(CLI::App &app, Context &context)
{
   const auto options = std::make_shared<BenchOptions>();
   CLI::App *command =
       app.add_subcommand("bench", "Measure this machine: seconds, rate, peak memory, result hash");
   command->add_option("NAMES", options->names, "Benchmarks or groups; all when left out");
   command->add_flag("--quick", options->quick, "Less work, one run each");
   command->add_flag("--list", options->list, "Only list the benchmarks");
   command->add_option("--csv", options->csv, "Also write the table to this file");
   command->callback([options, &context] { run(*options, context); });
}

} // namespace diatom::cli
