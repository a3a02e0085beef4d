#include "plugin_check/subject.h"

#include "core/clock.h"
#include "core/sanitizers.h"

#include <fmt/format.h>

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

namespace diatom::check {

namespace {

namespace fs = std::filesystem;

constexpr int kLeastCalls = 16;     // of a round that looks for growth
constexpr double kRoundSeconds = 1; // after which such a round is long enough

using Value = std::variant<double, std::string>;

std::vector<Value> ends(const Parameter &parameter)
{
   switch (parameter.kind) {
   case Parameter::Kind::choice:
      return {parameter.choices.begin(), parameter.choices.end()};
   case Parameter::Kind::text:
      return {std::string(), std::string("\xc3\xa4\xe2\x82\xac"), std::string(1000, 'x')};
   default:
      return {parameter.minimum, parameter.maximum};
   }
}

Value anyValue(const Parameter &parameter, std::mt19937_64 &random)
{
   switch (parameter.kind) {
   case Parameter::Kind::choice:
      return parameter.choices[random() % parameter.choices.size()];
   case Parameter::Kind::text:
      return parameter.text;
   default: {
      const double value =
          std::uniform_real_distribution<double>(parameter.minimum, parameter.maximum)(random);
      return parameter.kind == Parameter::Kind::integer
                 ? std::clamp(std::round(value), parameter.minimum, parameter.maximum)
                 : value;
   }
   }
}

std::string textOf(const Value &value)
{
   const auto *number = std::get_if<double>(&value);
   if (number)
      return fmt::format("{}", *number);
   const auto &text = std::get<std::string>(value);
   return text.size() > 20 ? fmt::format("({} characters)", text.size()) : "\"" + text + "\"";
}

std::string labelOf(const Values &values)
{
   std::string label;
   for (const auto &[name, value] : values)
      label += fmt::format("{}{}={}", label.empty() ? "" : " ", name, textOf(value));
   return label.empty() ? "defaults" : label;
}

} // namespace

std::mt19937_64 Subject::random(std::string_view use) const
{
   std::vector<std::uint32_t> words{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)};
   words.insert(words.end(), use.begin(), use.end());
   std::seed_seq sequence(words.begin(), words.end());
   return std::mt19937_64(sequence);
}

Result<Subject> openSubject(const fs::path &folder, std::uint64_t seed, std::vector<fs::path> designs)
{
   std::error_code failed;
   const fs::path real = fs::canonical(folder, failed);
   if (failed)
      return Error{ErrorCode::unreadable,
                   fmt::format("{}: it cannot be opened ({}); name the folder that holds plugin.json",
                               folder.string(), failed.message())};
   auto manifest = readManifest(real);
   if (!manifest)
      return manifest.error();
   Subject subject;
   subject.manifest = *std::move(manifest);
   subject.seed = seed;
   subject.designs = std::move(designs);
   // As an installed one: it is run without a trial and without asking, since each check has its own process.
   subject.folders.emplace_back(real.parent_path(), Origin::installed);
   for (PluginFolder &other : defaultPluginFolders())
      subject.folders.push_back(std::move(other));
   subject.catalogue = Catalogue::find(subject.folders);
   for (const Candidate &candidate : subject.catalogue->candidates())
      if (fs::equivalent(candidate.folder, real, failed) && !candidate.accepted)
         return Error{ErrorCode::unsupported, fmt::format("{}: {}", real.string(), candidate.verdict)};
   return subject;
}

std::int64_t bytesInUse()
{
   const auto info = mallinfo2();
   return static_cast<std::int64_t>(info.uordblks + info.hblkhd);
}

std::vector<Choice> parameterChoices(const Subject &subject, int random)
{
   std::vector<Choice> choices{{"defaults", {}}};
   const auto &parameters = subject.provided->parameters;
   for (const Parameter &parameter : parameters)
      for (const Value &value : ends(parameter)) {
         const Values values{{parameter.name, value}};
         choices.push_back({labelOf(values), values});
      }
   auto numbers = subject.random("parameters");
   for (int i = 0; i < random && !parameters.empty(); ++i) {
      Values values;
      for (const Parameter &parameter : parameters)
         values[parameter.name] = anyValue(parameter, numbers);
      choices.push_back({labelOf(values), values});
   }
   return choices;
}

std::optional<std::int64_t> growthPerCall(int calls, const std::function<void()> &call)
{
   if (kAddressSanitizer || kThreadSanitizer)
      return std::nullopt;
   const auto round = [&] {
      const std::int64_t before = bytesInUse();
      const auto begin = Clock::now();
      int made = 0;
      do {
         call();
         ++made;
      } while (made < calls && (made < kLeastCalls || secondsSince(begin) < kRoundSeconds));
      return (bytesInUse() - before) / made;
   };
   round(); // what is kept once
   return std::min(round(), round());
}

std::optional<double> secondsToCancel(const std::function<void(const Job &)> &work)
{
   Job job;
   job.setThreads(1);
   std::atomic<bool> ended{false};
   std::optional<Clock::time_point> cancelledAt;
   std::thread user([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (!ended.load()) {
         cancelledAt = Clock::now();
         job.cancel();
      }
   });
   work(job);
   ended.store(true);
   const auto end = Clock::now();
   user.join();
   if (!cancelledAt || end < *cancelledAt)
      return std::nullopt;
   return std::chrono::duration<double>(end - *cancelledAt).count();
}

} // namespace diatom::check
