// What plugins cost at the start of the program, when none of them is needed yet.
#include "cli/bench.h"

#include "core/clock.h"
#include "core/file.h"
#include "core/hash.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <filesystem>

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
   if (const Status folderMade = makeFolder(folder); !folderMade)
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
      if (const Status written = writeFileAtomic(to / "plugin.json", json); !written)
         return written;
   }
   return {};
}

double medianSeconds(int times, const std::vector<PluginFolder> &folders)
{
   std::vector<double> seconds;
   for (int i = 0; i < times; ++i) {
      const auto before = Clock::now();
      (void)Catalogue::find(folders);
      seconds.push_back(secondsSince(before));
   }
   std::sort(seconds.begin(), seconds.end());
   return seconds[seconds.size() / 2];
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

constexpr std::array kBenchmarks{
    Benchmark{"start", "The catalogue at the start, with 40 more plugins", benchStart}};

} // namespace

std::span<const Benchmark> pluginBenchmarks() { return kBenchmarks; }

} // namespace diatom::cli
