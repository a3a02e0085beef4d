// Whether a solver keeps its word: the same bits each time, on any number of threads and in a process of its
// own; estimates that can be relied on; nothing accepted that it cannot do; and, in mechanics, known answers.
#include "plugin_check/checks.h"
#include "plugin_check/solver_scene.h"

#include "core/sanitizers.h"
#include "plugins/module.h"
#include "scene/solver_run.h"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace diatom::check {

namespace {

constexpr int kMostThreads = 7;
constexpr double kFarOff = 10, kOff = 3;  // factors of an estimate
constexpr double kLeastBytes = 64 * 1024; // an estimate below is about nothing

struct Tested
{
   Abilities can;
   std::vector<Trial> trials;
};

Tested prepare(const Subject &subject, Findings &findings)
{
   const auto can = abilitiesOf(subject);
   if (!can) {
      findings.fail(can.error().message);
      return {};
   }
   return {*can, trialsFor(subject, *can, findings)};
}

/// The first difference in words; empty when they are the same bit by bit.
std::string differenceOf(const Answers &a, const Answers &b)
{
   if (a.size() != b.size())
      return "other outputs";
   for (const auto &[name, values] : a) {
      const auto other = b.find(name);
      if (other == b.end() || other->second.size() != values.size())
         return "other rows of " + name;
      for (std::size_t i = 0; i < values.size(); ++i)
         if (values[i] != other->second[i])
            return fmt::format("number {} of {} is {} and {}", i, name, values[i], other->second[i]);
   }
   return {};
}

void checkSolverAbilities(const Subject &subject, Findings &findings)
{
   const auto can = abilitiesOf(subject);
   if (!can)
      return findings.fail(can.error().message);
   const std::pair<const char *, const std::vector<std::string> *> lists[] = {
       {"physics", &can->physics}, {"analyses", &can->analyses}, {"lattices", &can->lattices}};
   for (const auto &[what, list] : lists)
      if (list->empty() || can->has(*list, ""))
         findings.fail(fmt::format("it names no {}, or one without a name", what));
   if (!can->can(Analysis::dynamics) && !can->can(Analysis::statics) && !can->can(Analysis::modes))
      findings.fail("none of its analyses is one that Diatom asks for: dynamics, statics, modes");
   const auto again = abilitiesOf(subject);
   if (!again || again->effects != can->effects || again->analyses != can->analyses)
      findings.fail("asked twice, it says otherwise");
}

void checkSolverParameters(const Subject &subject, Findings &findings)
{
   const Tested tested = prepare(subject, findings);
   for (const Trial &trial : tested.trials)
      for (const Choice &choice : parameterChoices(subject, 5)) {
         RunOptions options;
         options.values = choice.values;
         const auto answers = runTrial(subject, trial, options);
         if (answers)
            continue;
         const std::string text =
             fmt::format("{}, with {}: {}", trial.label, choice.label, answers.error().message);
         if (choice.values.empty() || answers.error().code == ErrorCode::internal)
            findings.fail(text);
         else if (choice.values.size() == 1) // several may exclude each other
            findings.warn(text);
      }
}

/// Runs every trial twice, the second time with `other`, and wants the same bits.
void compareRuns(const Subject &subject, Findings &findings, const RunOptions &other, const std::string &how)
{
   for (const Trial &trial : prepare(subject, findings).trials) {
      const auto expected = runTrial(subject, trial, {});
      if (!expected)
         continue; // told by the check of parameters
      const auto found = runTrial(subject, trial, other);
      const std::string difference =
          found ? differenceOf(*expected, *found) : std::string(found.error().message);
      if (!difference.empty())
         findings.fail(fmt::format("{}: {} it answers differently: {}", trial.label, how, difference));
   }
}

void checkSolverRepeats(const Subject &subject, Findings &findings)
{
   compareRuns(subject, findings, {}, "asked twice,");
}

void checkSolverThreads(const Subject &subject, Findings &findings)
{
   const auto can = abilitiesOf(subject);
   if (can && !can->deterministic)
      return findings.skip("it does not claim to give the same bits on any number of threads");
   for (const int threads : {2, kMostThreads})
      compareRuns(subject, findings, {threads, false, {}}, fmt::format("on {} threads", threads));
}

void checkSolverWorker(const Subject &subject, Findings &findings)
{
   if (!kMayFork)
      return findings.skip("this build's sanitizer bears no other process");
   std::error_code failed;
   const auto folder = std::filesystem::read_symlink("/proc/self/exe", failed).parent_path();
   if (::access((folder / "diatom-worker").c_str(), X_OK) != 0)
      return findings.skip("diatom-worker is not beside this program");
   compareRuns(subject, findings, {1, true, {}}, "in a process of its own");
}

/// A solver made past SolverRun, so that it can be given what SolverRun would not.
Result<std::shared_ptr<const Instance>> create(const Subject &subject, const diatom_scene &scene)
{
   return subject.catalogue->createWith(
       DIATOM_SOLVER_1, subject.provided->id, {}, Job(),
       [&](const void *table, const diatom_call *call, const diatom_create *create, void **self) {
          return static_cast<const diatom_solver *>(table)->create(call, create, &scene, self);
       },
       [](const void *table) { return static_cast<const diatom_solver *>(table)->destroy; });
}

Status step(const Instance &solver, const diatom_step_request &request, diatom_step_result &result,
            const Job &job)
{
   return solver.call("step", job, [&](const diatom_call *call) {
      return solver.table<diatom_solver>()->step(solver.self(), call, &request, &result);
   });
}

/// Every output of a solver that `create` made, all rows.
Result<Answers> readAll(const Instance &solver)
{
   const auto *table = solver.table<diatom_solver>();
   const diatom_outputs *list = nullptr;
   const Status listed = solver.call(
       "outputs", Job(), [&](const diatom_call *call) { return table->outputs(solver.self(), call, &list); });
   if (!listed || !list)
      return listed ? Error{ErrorCode::internal, "it lists no outputs"} : listed.error();
   Answers answers;
   for (std::int64_t k = 0; k < list->count; ++k) {
      std::vector<double> values(static_cast<std::size_t>(list->output[k].count * list->output[k].stride));
      const Status read = solver.call("read", Job(), [&](const diatom_call *call) {
         return table->read(solver.self(), call, k, 0, list->output[k].count, values.data());
      });
      if (!read)
         return read.error();
      answers[list->output[k].name] = std::move(values);
   }
   return answers;
}

/// Whether it takes the scene, works, and answers with numbers that are none.
bool answersNonsense(const Subject &subject, const diatom_scene &scene)
{
   const auto solver = create(subject, scene);
   if (!solver)
      return false;
   diatom_step_result result = emptyResult();
   const Status stepped = step(**solver, requestOf(20), result, Job());
   if (!stepped || result.state == DIATOM_DIVERGED)
      return false;
   const auto answers = readAll(**solver);
   return answers && std::any_of(answers->begin(), answers->end(), [](const auto &one) {
             return std::any_of(one.second.begin(), one.second.end(),
                                [](double v) { return !std::isfinite(v); });
          });
}

void checkSolverBadNumbers(const Subject &subject, Findings &findings)
{
   auto random = subject.random("bad numbers");
   for (const Trial &trial : prepare(subject, findings).trials) {
      const auto scene = trial.scene(subject);
      if (!scene)
         continue;
      const diatom_scene &good = (*scene)->view();
      const auto tell = [&](const diatom_scene &bad, const std::string &what) {
         if (answersNonsense(subject, bad))
            findings.fail(
                fmt::format("{}: with {} it says that all is well and answers with numbers that are none",
                            trial.label, what));
      };
      const double none = std::numeric_limits<double>::quiet_NaN();
      const auto size = [](std::int64_t n) { return static_cast<std::size_t>(n); };
      for (std::int32_t k = 0; k < good.properties; ++k) {
         std::vector<double> property(good.property, good.property + good.materials * good.properties);
         for (std::int32_t m = 0; m < good.materials; ++m)
            property[size(m * good.properties + k)] = none;
         diatom_scene bad = good;
         bad.property = property.data();
         tell(bad, fmt::format("materials without {}", good.property_name[k]));
      }
      for (std::int64_t k = 0; k < good.channels; ++k) {
         const diatom_channel &channel = good.channel[k];
         if (channel.count * channel.stride == 0)
            continue;
         std::vector<double> one(channel.values, channel.values + channel.count * channel.stride);
         std::vector<double> all(one.size(), none);
         one[random() % one.size()] = none;
         std::vector<diatom_channel> channels(good.channel, good.channel + good.channels);
         diatom_scene bad = good;
         bad.channel = channels.data();
         for (const std::vector<double> *values : {&one, &all}) {
            channels[size(k)].values = values->data();
            tell(bad,
                 fmt::format("{} of {} that is none", values == &one ? "a number" : "numbers", channel.name));
         }
      }
   }
}

void checkSolverEstimate(const Subject &subject, Findings &findings)
{
   for (const Trial &trial : prepare(subject, findings).trials) {
      auto scene = trial.scene(subject);
      if (!scene)
         continue;
      const std::int64_t before = bytesInUse();
      auto run = SolverRun::create(subject.catalogue, *std::move(scene), trial.design.setup, {}, Job());
      if (!run)
         continue;
      diatom_step_result result = emptyResult();
      if (!(*run)->step(requestOf(1), result, Job()))
         continue;
      const double used = static_cast<double>(bytesInUse() - before), said = (*run)->estimate().bytes;
      if (!std::isfinite(said) || said < 0 || !std::isfinite((*run)->estimate().step_seconds))
         findings.fail(fmt::format("{}: its estimate is not a number", trial.label));
      if (kAddressSanitizer || kThreadSanitizer || used < kLeastBytes)
         continue; // small scenes: what is there whatever the cells
      const double factor = used / std::max(said, 1.0);
      const std::string text =
          fmt::format("{}: it said {:.0f} kB and took {:.0f} kB", trial.label, said / 1024, used / 1024);
      if (factor > kFarOff || factor < 1 / kFarOff)
         findings.fail(text);
      else if (factor > kOff || factor < 1 / kOff)
         findings.warn(text);
   }
}

void checkSolverReads(const Subject &subject, Findings &findings)
{
   for (const Trial &trial : prepare(subject, findings).trials) {
      auto scene = trial.scene(subject);
      if (!scene)
         continue;
      auto run = SolverRun::create(subject.catalogue, *std::move(scene), trial.design.setup, {}, Job());
      if (!run)
         continue;
      diatom_step_result result = emptyResult();
      if (!(*run)->step(requestOf(10), result, Job()))
         continue;
      for (const SolverRun::Told &one : (*run)->told()) {
         const auto whole = (*run)->output(one.name, Job());
         std::vector<double> pieces;
         for (std::int64_t row = 0; row < one.rows; row += 3) {
            const auto piece = (*run)->read(one.name, row, std::min<std::int64_t>(3, one.rows - row), Job());
            if (piece)
               pieces.insert(pieces.end(), piece->begin(), piece->end());
         }
         if (!whole || *whole != pieces)
            findings.fail(
                fmt::format("{}: {} read in pieces is not what it is read at once", trial.label, one.name));
      }
   }
}

void checkSolverLife(const Subject &subject, Findings &findings)
{
   for (const Trial &trial : prepare(subject, findings).trials) {
      const auto scene = trial.scene(subject);
      if (!scene)
         continue;
      const auto created = growthPerCall(100, [&] { (void)create(subject, (*scene)->view()); });
      if (!created)
         return findings.skip("this build's sanitizer keeps the memory; it reports leaks at the end itself");
      if (*created >= 8)
         findings.fail(fmt::format("{}: each time that it is created and destroyed it leaves {} bytes behind",
                                   trial.label, *created));
      const auto solver = create(subject, (*scene)->view());
      if (!solver || trial.analysis != Analysis::dynamics)
         continue;
      const auto stepped = growthPerCall(50, [&] {
         diatom_step_result result = emptyResult();
         (void)step(**solver, requestOf(2), result, Job());
         (void)readAll(**solver);
      });
      if (stepped && *stepped >= 8)
         findings.fail(fmt::format("{}: each step leaves {} bytes behind", trial.label, *stepped));
   }
}

void checkSolverCancel(const Subject &subject, Findings &findings)
{
   for (const Trial &trial : prepare(subject, findings).trials) {
      const auto scene = trial.scene(subject);
      const auto solver =
          scene ? create(subject, (*scene)->view()) : Result<std::shared_ptr<const Instance>>(scene.error());
      if (!solver)
         continue;
      Status ended;
      const auto seconds = secondsToCancel([&](const Job &job) {
         diatom_step_result result = emptyResult();
         ended = step(**solver, requestOf(std::numeric_limits<std::int64_t>::max()), result, job);
      });
      if (seconds && *seconds > kCancelSeconds)
         findings.warn(
             fmt::format("{}: cancelled, it goes on for {:.0f} ms, more than {:.0f}: look at cancelled() at "
                         "least every 50 ms",
                         trial.label, *seconds * 1e3, kCancelSeconds * 1e3));
   }
}

/// Saves, goes on, loads, goes on again: the same bits.
void checkSolverState(const Subject &subject, Findings &findings)
{
   const auto module = Module::load(subject.manifest);
   const auto *state =
       module ? static_cast<const diatom_solver_state *>((*module)->table(DIATOM_SOLVER_STATE_1)) : nullptr;
   if (!state)
      return findings.skip(fmt::format("it does not provide {}", DIATOM_SOLVER_STATE_1));
   for (const Trial &trial : prepare(subject, findings).trials) {
      const auto scene = trial.scene(subject);
      const auto solver =
          scene ? create(subject, (*scene)->view()) : Result<std::shared_ptr<const Instance>>(scene.error());
      if (!solver || trial.analysis != Analysis::dynamics)
         continue;
      const Instance &made = **solver;
      const auto advance = [&]() -> Result<Answers> {
         diatom_step_result result = emptyResult();
         if (const Status stepped = step(made, requestOf(10), result, Job()); !stepped)
            return stepped.error();
         return readAll(made);
      };
      if (!advance())
         continue;
      std::int64_t count = 0;
      const auto save = [&](void *bytes, std::int64_t room) {
         return made.call("save", Job(), [&](const diatom_call *call) {
            return state->save(made.self(), call, bytes, room, &count);
         });
      };
      (void)save(nullptr, 0); // tells how many
      std::vector<char> bytes(static_cast<std::size_t>(std::max<std::int64_t>(count, 0)));
      const Status saved = save(bytes.data(), count);
      const auto expected = advance();
      const Status loaded = made.call("load", Job(), [&](const diatom_call *call) {
         return state->load(made.self(), call, bytes.data(), count);
      });
      const auto found = advance();
      if (!saved || !loaded || !expected || !found)
         findings.fail(fmt::format("{}: it cannot save and load its state", trial.label));
      else if (const std::string difference = differenceOf(*expected, *found); !difference.empty())
         findings.fail(fmt::format("{}: after its state was loaded it goes on differently: {}", trial.label,
                                   difference));
   }
}

} // namespace

void addSolverChecks(std::vector<Check> &checks)
{
   const auto add = [&](const char *name, const char *promise, void (*run)(const Subject &, Findings &),
                        int threads = 1) {
      checks.push_back({name, promise, DIATOM_SOLVER_1, run, threads});
   };
   add("solver.abilities", "it says what it can do, in words that Diatom knows", checkSolverAbilities);
   add("solver.parameters", "it works with the parameters that plugin.json allows, or says why not",
       checkSolverParameters);
   add("solver.life", "it leaves nothing behind when it ends or steps", checkSolverLife);
   add("solver.repeats", "the same scene gets the same bits", checkSolverRepeats);
   add("solver.threads", "and on 1, 2 and 7 threads, where it claims so", checkSolverThreads, kMostThreads);
   add("solver.worker", "and in a process of its own", checkSolverWorker);
   add("solver.reads", "outputs can be read in pieces", checkSolverReads);
   add("solver.state", "saved, loaded and gone on with is gone on with", checkSolverState);
   add("solver.estimate", "it takes the memory that it said it would", checkSolverEstimate);
   add("solver.bad_numbers", "numbers that are none do not come out as an answer", checkSolverBadNumbers);
   add("solver.cancel", "it stops soon after it is cancelled", checkSolverCancel);
   add("solver.known", "a bar stretches, falls and swings as it must", checkSolverKnown);
}

} // namespace diatom::check
