#include "cli/recorder.h"

#include "cli/scene_json.h"
#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace diatom::cli {

namespace {

std::string headed(const std::string &name, const std::string &unit)
{
   return unit.empty() ? name : fmt::format("{} ({})", name, unit);
}

/// A column group of the state file: an output, its columns and their units.
struct StateColumns
{
   std::string output;
   std::vector<std::pair<std::string, std::string>> columns;
};

bool isOfLinks(const SolverRun::Told &told) { return told.name.starts_with("link_"); }

/// An output with its name over each column, numbered where it has several.
StateColumns columnsOf(const SolverRun::Told &told)
{
   StateColumns group{told.name, {}};
   for (std::int64_t k = 0; k < told.stride; ++k)
      group.columns.emplace_back(told.stride == 1 ? told.name : fmt::format("{}.{}", told.name, k),
                                 told.unit);
   return group;
}

/// Those that the run has, and outputs of the solver's own where it is about other things than mechanics.
std::vector<StateColumns> stateColumns(const SolverRun &run)
{
   std::vector<StateColumns> groups{
       {"position", {{"x", "m"}, {"y", "m"}, {"z", "m"}}},
       {"rotation", {{"qw", ""}, {"qx", ""}, {"qy", ""}, {"qz", ""}}},
       {"velocity", {{"vx", "m/s"}, {"vy", "m/s"}, {"vz", "m/s"}}},
       {"angular_velocity", {{"wx", "rad/s"}, {"wy", "rad/s"}, {"wz", "rad/s"}}},
       {"strain", {{"strain", ""}}},
       {"reaction", {{"fx", "N"}, {"fy", "N"}, {"fz", "N"}, {"mx", "N m"}, {"my", "N m"}, {"mz", "N m"}}}};
   std::erase_if(groups, [&](const StateColumns &group) { return !run.hasOutput(group.output); });
   if (!run.mechanics())
      for (const SolverRun::Told &told : run.told())
         if (told.rows == run.scene().cells() && !isOfLinks(told) &&
             std::none_of(groups.begin(), groups.end(),
                          [&](const StateColumns &group) { return group.output == told.name; }))
            groups.push_back(columnsOf(told));
   return groups;
}

constexpr std::array<const char *, 6> kEnergies{"kinetic", "elastic",    "gravity",
                                                "contact", "dissipated", "work"};

std::string csvRow(const std::vector<std::string> &fields)
{
   return fmt::format("{}\n", fmt::join(fields, ","));
}

} // namespace

Result<Probe> parseProbe(const std::string &text, const Scene &scene, bool ownOutputs)
{
   const std::size_t colon = text.rfind(':');
   if (colon == std::string::npos)
      return Error{ErrorCode::usage,
                   fmt::format("--probe \"{}\": write X,Y,Z:CHANNEL, as in 0,13,0:z", text)};
   const auto index = parseIndex(text.substr(0, colon));
   if (!index)
      return Error{ErrorCode::usage, "--probe: " + index.error().message};
   Probe probe{text, scene.cellAt(*index), text.substr(colon + 1), ""};
   if (probe.cell < 0)
      return Error{ErrorCode::usage, fmt::format("--probe \"{}\": there is no cell at that index", text)};
   if (ownOutputs)
      return probe;
   std::string known;
   for (const auto &[channel, unit] : SolverRun::probeChannels()) {
      if (channel == probe.channel) {
         probe.unit = unit;
         return probe;
      }
      known += " " + channel;
   }
   return Error{ErrorCode::usage, fmt::format("--probe \"{}\": the channels are{}", text, known)};
}

Recorder::Recorder(const std::filesystem::path &file, std::vector<Probe> probes, const SolverRun &run,
                   const std::vector<std::string> &more)
    : m_file(file), m_probes(std::move(probes)), m_energies(run.hasOutput("energy"))
{
   std::vector<std::string> names{"time (s)"};
   for (const Probe &probe : m_probes)
      names.push_back(fmt::format("\"{}\"", headed(probe.name, probe.unit)));
   if (m_energies)
      for (const char *energy : kEnergies)
         names.push_back(headed(energy, "J"));
   names.insert(names.end(), more.begin(), more.end());
   m_file.write(csvRow(names));
}

Status Recorder::row(const SolverRun &run, const Job &job, const std::vector<double> &more)
{
   std::vector<std::string> fields{numberText(run.time())};
   for (const Probe &probe : m_probes) {
      const auto value = run.probe(probe.cell, probe.channel, job);
      if (!value)
         return value.error();
      fields.push_back(numberText(*value));
   }
   if (m_energies) {
      const auto energies = run.read("energy", 0, 1, job);
      if (!energies)
         return energies.error();
      if (energies->size() < kEnergies.size())
         return Error{ErrorCode::internal, fmt::format("{}: its output 'energy' must have {} numbers",
                                                       run.solver(), kEnergies.size())};
      for (std::size_t k = 0; k < kEnergies.size(); ++k)
         fields.push_back(numberText((*energies)[k]));
   }
   std::transform(more.begin(), more.end(), std::back_inserter(fields), numberText);
   m_file.write(csvRow(fields));
   return {};
}

Status Recorder::finish(std::string_view mark)
{
   if (!mark.empty())
      m_file.write(fmt::format("# {}\n", mark));
   return m_file.commit();
}

Status writeState(const SolverRun &run, const Model &model, const std::filesystem::path &file, const Job &job)
{
   const auto groups = stateColumns(run);
   std::vector<std::vector<double>> data;
   std::vector<std::string> names{"i", "j", "k", "material"};
   for (const StateColumns &group : groups) {
      auto values = run.output(group.output, job);
      if (!values)
         return values.error();
      data.push_back(*std::move(values));
      for (const auto &[name, unit] : group.columns)
         names.push_back(headed(name, unit));
   }
   const bool csv = file.extension() == ".csv";
   AtomicFile out(file);
   if (csv)
      out.write(csvRow(names));
   const diatom_scene &view = run.scene().view();
   for (std::int64_t cell = 0; cell < view.cells; ++cell) {
      const Index index = run.scene().indices()[static_cast<std::size_t>(cell)];
      const std::string &material = (*model.materials)[static_cast<std::size_t>(view.cell_material[cell])].id;
      std::vector<std::string> fields{fmt::to_string(index.x), fmt::to_string(index.y),
                                      fmt::to_string(index.z), material};
      nlohmann::ordered_json object{{"cell", toJson(index)}, {"material", material}};
      for (std::size_t group = 0; group < data.size(); ++group) {
         const auto width = static_cast<std::int64_t>(groups[group].columns.size());
         const auto begin = data[group].begin() + cell * width;
         if (csv)
            std::transform(begin, begin + width, std::back_inserter(fields), numberText);
         else if (width == 1)
            object[groups[group].output] = *begin;
         else
            object[groups[group].output] = std::vector<double>(begin, begin + width);
      }
      out.write(csv ? csvRow(fields) : object.dump() + "\n");
   }
   return out.commit();
}

Status writeLinks(const SolverRun &run, const std::filesystem::path &file, const Job &job)
{
   const diatom_scene &view = run.scene().view();
   std::vector<std::string> names{"i", "j", "k", "to i", "to j", "to k"};
   std::vector<std::pair<std::int64_t, std::vector<double>>> data; // numbers of each link, all of them
   for (const SolverRun::Told &told : run.told()) {
      if (told.rows != view.links || !isOfLinks(told))
         continue;
      auto values = run.output(told.name, job);
      if (!values)
         return values.error();
      for (const auto &[name, unit] : columnsOf(told).columns)
         names.push_back(headed(name, unit));
      data.emplace_back(told.stride, *std::move(values));
   }
   if (data.empty())
      return Error{ErrorCode::unsupported,
                   fmt::format("{} tells nothing of links; leave --links out", run.solver())};
   AtomicFile out(file);
   out.write(csvRow(names));
   for (std::int64_t link = 0; link < view.links; ++link) {
      std::vector<std::string> fields;
      for (const std::int32_t cell : {view.link_a[link], view.link_b[link]})
         for (int axis = 0; axis < 3; ++axis)
            fields.push_back(fmt::to_string(view.cell_index[3 * std::int64_t(cell) + axis]));
      for (const auto &[width, values] : data)
         std::transform(values.begin() + link * width, values.begin() + (link + 1) * width,
                        std::back_inserter(fields), numberText);
      out.write(csvRow(fields));
   }
   return out.commit();
}

} // namespace diatom::cli
