// The plugin that is checked, and what checks of all kinds do with it.
#pragma once

#include "core/job.h"
#include "core/sanitizers.h"
#include "plugins/catalogue.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace diatom::check {

struct Subject
{
   Manifest manifest;
   std::vector<PluginFolder> folders;          // where the catalogue looks
   std::shared_ptr<const Catalogue> catalogue; // this plugin's folder first, then what is installed
   std::vector<std::filesystem::path> designs; // of the author's, to try it on
   std::uint64_t seed = 0;
   const Provided *provided = nullptr; // the thing that is checked; null in checks of the library

   /// Numbers that depend on the seed and on what they are for.
   std::mt19937_64 random(std::string_view use) const;
};

/// Reads the plugin's folder. Errors: no readable plugin.json, or another plugin takes its place.
Result<Subject> openSubject(const std::filesystem::path &folder, std::uint64_t seed,
                            std::vector<std::filesystem::path> designs);

/// A set of parameter values worth trying, and what it is called in messages.
struct Choice
{
   std::string label;
   Values values;
};

/// The defaults, each parameter at its ends and at each of its choices, and `random` sets at random.
std::vector<Choice> parameterChoices(const Subject &subject, int random);

/// Bytes allocated by this thread's allocator (mallinfo2).
std::int64_t bytesInUse();

/// Bytes that a call leaves allocated each time, over two rounds of `calls` or of a second; nothing where the
/// build's sanitizers own the memory.
std::optional<std::int64_t> growthPerCall(int calls, const std::function<void()> &call);

inline constexpr double kCancelSeconds = 0.2 * kSlowdown; // that a plugin may take to see a cancel

/// Seconds from the cancel, given after a moment, to the end of the work; nothing when it had ended before.
std::optional<double> secondsToCancel(const std::function<void(const Job &)> &work);

} // namespace diatom::check
