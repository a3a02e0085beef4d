// diatom pipeline: the main job in one go: open, simulate, export STL by material, plan, write the machine
// program, render.
#include "assembly/chosen_parts.h"
#include "cli/commands.h"
#include "cli/picture.h"
#include "core/file.h"
#include "core/text.h"
#include "io/stl.h"
#include "scene/scene.h"
#include "scene/simulation.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <chrono>
#include <filesystem>

namespace diatom::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct PipelineOptions
{
   std::string file, folder = "out";
   double until = 0.1; // s
};

/// The stages share what was opened and write into one folder; each adds its findings to the report.
class Pipeline
{
public:
   Pipeline(Context &context, const Context::Input &input, const PipelineOptions &options)
       : m_context(context), m_input(input), m_options(options),
         m_base(fs::path(options.folder) / fs::path(options.file).stem())
   {}

   Status run()
   {
      std::error_code failed;
      fs::create_directories(m_options.folder, failed);
      if (failed)
         return Error{ErrorCode::unwritable,
                      fmt::format("{}: cannot be created: {}", m_options.folder, failed.message())};
      open();
      for (const auto stage : {&Pipeline::simulate, &Pipeline::exportStl, &Pipeline::make, &Pipeline::draw}) {
         const auto start = std::chrono::steady_clock::now();
         if (Status done = (this->*stage)(); !done)
            return done;
         m_report[m_stage]["wall_s"] =
             std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      }
      return {};
   }

   const Json &report() const { return m_report; }

private:
   void open()
   {
      const Hierarchy &hierarchy = *m_input.hierarchy;
      m_report["design"] = {{"file", m_options.file},
                            {"lattice", m_input.lattice->spec().id},
                            {"cells", hierarchy.cells()},
                            {"depth", hierarchy.depth()},
                            {"mass_kg", hierarchy.mass().mass}};
   }

   Status simulate()
   {
      m_stage = "simulation";
      const Setup &setup = m_input.opened.design.setup;
      auto scene = Scene::build(*m_input.hierarchy, setup, m_context.job());
      if (!scene)
         return scene.error();
      auto simulation = Simulation::start(m_context.catalogue(), *std::move(scene), setup, setup.solverValues,
                                          m_context.job());
      if (!simulation)
         return simulation.error();
      const auto rest = (*simulation)->frame(m_context.job());
      if (!rest)
         return rest.error();
      if (Status done = (*simulation)->advance(m_options.until, m_context.job()); !done)
         return done;
      const auto energy = (*simulation)->energy(m_context.job());
      if (!energy)
         return energy.error();
      m_report[m_stage] = {{"simulated_s", (*simulation)->time()},
                           {"steps", (*simulation)->steps()},
                           {"step_s", (*simulation)->step()},
                           {"energy_drift", energy->drift}};
      auto moment = momentOf(**simulation, *rest, m_context.job());
      if (!moment)
         return moment.error();
      m_moment = *std::move(moment);
      return {};
   }

   Status exportStl()
   {
      m_stage = "stl";
      auto reports =
          writeStlByMaterial(*m_input.hierarchy, nullptr, StlOptions{}, path(".stl"), m_context.job());
      if (!reports)
         return reports.error();
      Json files = Json::array();
      for (const StlReport &report : *reports)
         files.push_back({{"file", report.file.string()}, {"triangles", report.triangles}});
      m_report[m_stage] = {{"files", files}};
      return {};
   }

   Status make()
   {
      m_stage = "assembly";
      const AssemblySetup &setup = m_input.opened.design.assembly;
      auto maker =
          chosenParts(*m_context.catalogue(), setup, "", m_input.lattice->spec().id, m_context.job());
      if (!maker)
         return maker.error();
      auto parts = (*maker)->decompose(*m_input.hierarchy, m_context.job());
      if (!parts)
         return parts.error();
      auto plan = planAssembly(*m_input.hierarchy, *parts, m_context.job());
      if (!plan)
         return plan.error();
      auto machine =
          Machine::make(*m_context.catalogue(), setup.machine, setup.machineValues, m_context.job());
      if (!machine)
         return machine.error();
      const fs::path file = path(std::string(".") + (*machine)->description().suffix);
      AtomicFile program(file);
      auto summary = (*machine)->write(
          *m_input.hierarchy, *parts, *plan, m_base.filename().string(),
          [&](std::string_view text) { program.write(text); }, m_context.job());
      if (!summary)
         return summary.error();
      m_report[m_stage] = {{"file", file.string()},
                           {"placements", summary->placements},
                           {"parts_not_placed", plan->problems.size()},
                           {"path_m", summary->pathMetres},
                           {"machine_s", summary->seconds}};
      return program.commit();
   }

   Status draw()
   {
      m_stage = "picture";
      PictureRequest request;
      request.out = path(".png").string();
      request.moment = m_moment;
      request.byDisplacement = true;
      m_report[m_stage] = {{"file", request.out}};
      const auto drawn = drawPicture(m_input, request);
      return drawn ? Status() : drawn.error();
   }

   fs::path path(const std::string &suffix) const { return m_base.string() + suffix; }

   Context &m_context;
   const Context::Input &m_input;
   const PipelineOptions &m_options;
   fs::path m_base;
   std::string m_stage;
   Json m_report;
   std::shared_ptr<const render::Moment> m_moment;
};

} // namespace

void addPipeline(CLI::App &app, Context &context)
{
   auto options = std::make_shared<PipelineOptions>();
   auto *command = app.add_subcommand(
       "pipeline",
       "The main job in one go: simulate, export STL by material, plan, write a machine program, render");
   command->add_option("FILE", options->file, "The design")->required();
   command->add_option("-o,--output", options->folder, "Folder for the results")->capture_default_str();
   command->add_option("--until", options->until, "Simulated time, s")->capture_default_str();
   command->callback([&context, options] {
      const auto input = context.open(options->file);
      if (!input)
         return;
      Pipeline pipeline(context, *input, *options);
      if (const Status done = pipeline.run(); !done)
         context.fail(done.error());
      context.print(pipeline.report());
   });
}

} // namespace diatom::cli
