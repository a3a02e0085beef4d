// What plugins cost: at the start, when none of them is needed yet; the guard around each call; the border to
// a solver in a process of its own.
#include "cli/bench.h"

#include "core/clock.h"
#include "core/file.h"
#include "core/hash.h"
#include "scene/solver_run.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace diatom::cli {

namespace {

namespace fs = std::filesystem;

constexpr int kPlugins = 40;

/// A folder that is gone with its owner.
struct Temporary
{
   Temporary()
   {
      std::string name = (fs::temp_directory_path() / "diatom-bench-XXXXXX").string();
      if (mkdtemp(name.data()))
         path = name;
   }
   ~Temporary()
   {
      std::error_code ignored;
      if (!path.empty())
         fs::remove_all(path, ignored);
   }
   Temporary(const Temporary &) = delete;
   Temporary &operator=(const Temporary &) = delete;
   fs::path path;
};

/// Copies of an installed lattice under ids of their own.
Status makePlugins(const Catalogue &catalogue, const fs::path &folder)
{
   const Offer *cube = catalogue.offer(DIATOM_LATTICE_1, "org.diatom_cad.lattice.cube");
   if (!cube)
      return Error{ErrorCode::unsupported, "the cube lattice is not installed"};
   const std::string &id = cube->provided->id;
   if (Status folderMade = makeFolder(folder); !folderMade)
      return folderMade;
   for (int i = 0; i < kPlugins; ++i) {
      const fs::path to = folder / fmt::format("plugin{}", i);
      std::error_code error;
      fs::copy(cube->manifest->folder, to, fs::copy_options::recursive, error);
      std::string json = cube->manifest->bytes;
      const std::string own = fmt::format("org.example.bench{}", i);
      for (std::size_t at = json.find(id); at != std::string::npos; at = json.find(id, at + own.size()))
         json.replace(at, id.size(), own);
      if (error)
         return Error{ErrorCode::unwritable, fmt::format("{}: {}", to.string(), error.message())};
      if (Status written = writeFileAtomic(to / "plugin.json", json); !written)
         return written;
   }
   return {};
}

double medianOf(std::vector<double> values)
{
   std::sort(values.begin(), values.end());
   return values[values.size() / 2];
}

double medianSeconds(int times, const std::vector<PluginFolder> &folders)
{
   std::vector<double> seconds;
   for (int i = 0; i < times; ++i) {
      const auto before = Clock::now();
      (void)Catalogue::find(folders);
      seconds.push_back(secondsSince(before));
   }
   return medianOf(std::move(seconds));
}

/// The catalogue as every start makes it, with 40 plugins from outside the installation and without.
Status benchStart(Measure &measure)
{
   const Temporary temporary;
   if (temporary.path.empty())
      return Error{ErrorCode::unwritable, "no temporary folder could be made; set TMPDIR"};
   // What is remembered about them must not mix with what the user's own start remembers.
   const char *cache = std::getenv("XDG_CACHE_HOME");
   const std::string saved = cache ? cache : "";
   setenv("XDG_CACHE_HOME", (temporary.path / "cache").c_str(), 1);
   const fs::path plugins = temporary.path / "plugins";
   Status made = makePlugins(*measure.catalogue(), plugins);
   if (made.ok()) {
      const std::vector<PluginFolder> none = defaultPluginFolders();
      std::vector<PluginFolder> all = none;
      all.emplace_back(plugins);
      const int times = measure.quick() ? 1 : 21;
      std::size_t found = Catalogue::find(all)->candidates().size(); // the first start looks at each file
      measure.time(times, [&] { found = Catalogue::find(all)->candidates().size(); });
      measure.did(kPlugins, "plugins");
      measure.also("without_s", medianSeconds(times, none));
      Hasher hasher;
      hasher.add(std::uint64_t{found});
      measure.result(hasher.finish());
   }
   if (cache)
      setenv("XDG_CACHE_HOME", saved.c_str(), 1);
   else
      unsetenv("XDG_CACHE_HOME");
   return made;
}

/// A block of cubes held at the bottom under gravity.
Result<std::unique_ptr<Scene>> block(const Catalogue &catalogue, int nx, int ny, int nz, Setup &setup)
{
   Model model;
   Material material;
   material.id = "cube";
   const auto number = model.setMaterial(material);
   for (int x = 0; number && x < nx; ++x)
      for (int y = 0; y < ny; ++y)
         for (int z = 0; z < nz; ++z)
            model.root.cells.set({x, y, z}, Cell{*number, 0, 0});
   setup.supports.push_back({Box{{0, 0, 0}, {nx - 1, ny - 1, 0}}, kAllFreedoms});
   setup.gravity = {0, 0, -9.81};
   auto lattice = Lattice::make(catalogue, model.lattice, Job());
   if (!lattice)
      return lattice.error();
   return Scene::build(Hierarchy(*lattice, std::move(model)), setup, Job());
}

diatom_step_request steps(std::int64_t count) { return {sizeof(diatom_step_request), 1e9, 0, count, 0}; }
diatom_step_result noResult() { return {sizeof(diatom_step_result), DIATOM_RUNNING, 0, 0, 0, -1, -1, 0, 0}; }

/// Ten steps of 4096 cells, each with a guard of its own, against the same ten under one guard.
Status benchGuard(Measure &measure)
{
   constexpr int kSteps = 10;
   Setup setup;
   const auto scene = block(*measure.catalogue(), 16, 16, 16, setup);
   if (!scene)
      return scene.error();
   const auto solver = measure.catalogue()->createWith(
       DIATOM_SOLVER_1, setup.solver, {}, Job(),
       [&](const void *table, const diatom_call *call, const diatom_create *create, void **self) {
          return static_cast<const diatom_solver *>(table)->create(call, create, &(*scene)->view(), self);
       },
       [](const void *table) { return static_cast<const diatom_solver *>(table)->destroy; });
   if (!solver)
      return solver.error();
   Job job;
   job.setThreads(1);
   const auto *table = (*solver)->table<diatom_solver>();
   const auto step = [&](const diatom_call *call) {
      diatom_step_result result = noResult();
      const diatom_step_request request = steps(1);
      return table->step((*solver)->self(), call, &request, &result);
   };
   Status failed;
   const auto each = [&] {
      for (int i = 0; i < kSteps; ++i)
         if (const Status done = (*solver)->call("step", job, step); !done)
            failed = done;
   };
   const auto once = [&] {
      const Status done = (*solver)->call("step", job, [&](const diatom_call *call) {
         std::int32_t status = DIATOM_OK;
         for (int i = 0; i < kSteps && status == DIATOM_OK; ++i)
            status = step(call);
         return status;
      });
      if (!done)
         failed = done;
   };
   const auto timed = [](const std::function<void()> &work) {
      const auto before = Clock::now();
      work();
      return secondsSince(before);
   };
   std::vector<double> apart, together;
   measure.time(measure.quick() ? 1 : 201,
                [&] { // in turn, each as often first, so that both see the same machine
                   const bool eachFirst = apart.size() % 2 == 0;
                   const double first = timed(eachFirst ? std::function<void()>(each) : once);
                   const double second = timed(eachFirst ? std::function<void()>(once) : each);
                   apart.push_back(eachFirst ? first : second);
                   together.push_back(eachFirst ? second : first);
                });
   if (!failed)
      return failed;
   const double guarded = medianOf(apart), under = medianOf(together);
   measure.did(2 * kSteps * 4096.0, "cell-steps");
   measure.also("each_s", guarded);
   measure.also("once_s", under);
   measure.also("overhead", guarded / under - 1);
   return {};
}

/// Batches of 100 steps of 10 000 cells in the worker, against the same in this process.
Status benchBorder(Measure &measure)
{
   constexpr std::int64_t kBatch = 100;
   const std::int64_t batch = measure.quick() ? 1 : kBatch;
   Job job;
   job.setThreads(1);
   const auto isolated = Catalogue::find(defaultPluginFolders(), false, Isolate::all);
   std::array<std::unique_ptr<SolverRun>, 2> runs;
   for (std::size_t i = 0; i < 2; ++i) {
      Setup own;
      auto scene = block(*measure.catalogue(), 20, 20, 25, own);
      if (!scene)
         return scene.error();
      auto run = SolverRun::create(i == 0 ? measure.catalogue() : isolated, *std::move(scene), own, {}, job);
      if (!run)
         return run.error();
      runs[i] = *std::move(run);
   }
   std::vector<double> here;
   Status failed;
   const auto advance = [&](SolverRun &run) {
      diatom_step_result result = noResult();
      if (const Status done = run.step(steps(batch), result, job); !done)
         failed = done;
      if (const auto read = run.output("position", job); !read)
         failed = read.error();
   };
   std::vector<double> apart;
   measure.time(measure.quick() ? 1 : 9, [&] {
      auto before = Clock::now();
      advance(*runs[0]);
      here.push_back(secondsSince(before));
      before = Clock::now();
      advance(*runs[1]);
      apart.push_back(secondsSince(before));
   });
   if (!failed)
      return failed;
   const double inside = medianOf(here), outside = medianOf(apart);
   measure.did(2 * static_cast<double>(batch) * 10'000, "cell-steps");
   measure.also("in_process_s", inside);
   measure.also("in_worker_s", outside);
   measure.also("border", outside / inside - 1);
   const auto a = runs[0]->output("position", job), b = runs[1]->output("position", job);
   if (!a || !b || *a != *b)
      return Error{ErrorCode::internal, "the worker gives other bits"};
   Hasher hasher;
   hasher.add(std::span<const double>(*a));
   measure.result(hasher.finish());
   return {};
}

constexpr std::array kBenchmarks{
    Benchmark{"start", "The catalogue at the start, with 40 more plugins", benchStart},
    Benchmark{"guard", "The guard around each step of 4096 cells, over one around ten", benchGuard},
    Benchmark{"border", "Batches of 100 steps of 10 000 cells in the worker, over those in process",
              benchBorder}};

} // namespace

std::span<const Benchmark> pluginBenchmarks() { return kBenchmarks; }

} // namespace diatom::cli
