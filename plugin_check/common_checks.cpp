// What holds for lattices, parts and machines alike: they have no state, so the same question gets the same
// answer, whoever asks, however often and from wherever.
#include "plugin_check/checks.h"
#include "plugin_check/thing.h"

#include "plugins/c_values.h"
#include "plugins/module.h"

#include <fmt/format.h>

#include <array>
#include <thread>

namespace diatom::check {

namespace {

constexpr int kThreads = 8;        // that ask at once
constexpr int kLives = 334;        // that are begun and ended in each of three rounds
constexpr int kRandomValues = 20;  // sets of parameters
constexpr std::int64_t kLeast = 8; // bytes a call that count as left behind

bool isRefusal(const Error &error)
{
   return error.code == ErrorCode::invalid || error.code == ErrorCode::unsupported;
}

void checkCommonLife(const Subject &subject, Findings &findings)
{
   Job job;
   job.setThreads(1);
   bool failed = false;
   const auto tell = [&](std::optional<std::int64_t> growth, const char *what) {
      if (!growth)
         findings.skip("this build's sanitizer keeps the memory; it reports leaks at the end itself");
      else if (*growth >= kLeast)
         findings.fail(fmt::format("each time that it is {} it leaves {} bytes behind", what, *growth));
   };
   const auto live = [&] {
      const auto made = makeThing(subject, {}, job, Look::unchecked);
      if (!made && !failed)
         findings.fail(made.error().message);
      failed = failed || !made;
   };
   const auto thing = makeThing(subject, {}, job);
   if (!thing)
      return findings.fail(thing.error().message);
   tell(growthPerCall(kLives, live), "created and destroyed");
   tell(growthPerCall(8, [&] { (void)(*thing)->answers(job); }), "asked");
}

void checkCommonParameters(const Subject &subject, Findings &findings)
{
   Job job;
   job.setThreads(1);
   for (const Choice &choice : parameterChoices(subject, kRandomValues)) {
      const auto made = makeThing(subject, choice.values, job);
      const auto answered = made ? (*made)->answers(job) : Result<Hash>(made.error());
      if (answered)
         continue;
      if (choice.values.empty() || !isRefusal(answered.error()))
         findings.fail(fmt::format("with {}: {}", choice.label, answered.error().message));
      else if (choice.values.size() == 1) // several may exclude each other
         findings.warn(fmt::format("with {}, which plugin.json allows, it refuses: {}", choice.label,
                                   answered.error().message));
   }
}

void checkCommonRepeats(const Subject &subject, Findings &findings)
{
   Job job;
   job.setThreads(1);
   for (const Choice &choice : parameterChoices(subject, 3)) {
      const auto first = makeThing(subject, choice.values, job),
                 second = makeThing(subject, choice.values, job);
      if (!first || !second)
         continue; // told by the check of parameters
      const auto once = (*first)->answers(job), again = (*first)->answers(job),
                 other = (*second)->answers(job);
      if (!once || !again || !other)
         continue;
      if (*once != *again)
         findings.fail(fmt::format("with {}: asked twice, it answers differently", choice.label));
      if (*once != *other)
         findings.fail(fmt::format("with {}: created twice, the two answer differently", choice.label));
   }
}

void checkCommonThreads(const Subject &subject, Findings &findings)
{
   Job job;
   job.setThreads(1);
   const auto thing = makeThing(subject, {}, job);
   const auto expected = thing ? (*thing)->answers(job) : Result<Hash>(thing.error());
   if (!expected)
      return findings.fail(expected.error().message);
   std::array<std::string, kThreads> faults;
   std::vector<std::thread> threads;
   for (std::string &told : faults)
      threads.emplace_back([&] {
         Job mine;
         mine.setThreads(1);
         for (int i = 0; i < 4 && told.empty(); ++i) {
            const auto other = makeThing(subject, {}, mine, Look::unchecked); // created at once as well
            const auto here = (*thing)->answers(mine);
            const auto there = other ? (*other)->answers(mine) : Result<Hash>(other.error());
            if (!here || !there)
               told = !here ? here.error().message : there.error().message;
            else if (*here != *expected || *there != *expected)
               told = "it answers differently";
         }
      });
   for (std::thread &thread : threads)
      thread.join();
   for (const std::string &told : faults)
      if (!told.empty())
         return findings.fail(fmt::format("asked by {} threads at once: {}", kThreads, told));
}

/// create() of any of the three, past the catalogue: with a call and a record of the check's own.
std::int32_t rawCreate(const void *table, const std::string &interface, const diatom_call *call,
                       const diatom_create *create, void **self, void (**destroy)(void *))
{
   const auto with = [&](const auto &of) {
      *destroy = of.destroy;
      return of.create(call, create, self);
   };
   if (interface == DIATOM_LATTICE_1)
      return with(*static_cast<const diatom_lattice *>(table));
   if (interface == DIATOM_PARTS_1)
      return with(*static_cast<const diatom_parts *>(table));
   return with(*static_cast<const diatom_machine *>(table));
}

void *noScratch(const diatom_call *, std::int64_t) { return nullptr; }
const void *noService(const diatom_call *, const char *) { return nullptr; }

/// Creates with default values and destroys, the records as `change` leaves them. How that went.
Status createChanged(const Subject &subject,
                     const std::function<void(diatom_call &, diatom_create &)> &change)
{
   const auto module = Module::load(subject.manifest);
   const auto values = completeValues(subject.provided->parameters, {});
   if (!module || !values)
      return module ? values.error() : module.error();
   const void *table = (*module)->table(subject.provided->interface.c_str());
   if (!table)
      return Error{ErrorCode::internal, "it has no table of " + subject.provided->interface};
   const CValues record(*values);
   const std::string folder = subject.manifest.folder.string();
   // Room for what a later minor may add; filled so that reading it would show.
   struct Grown
   {
      diatom_create create;
      std::array<unsigned char, 64> more;
   } grown{{sizeof(diatom_create), subject.provided->id.c_str(), folder.c_str(), &record.record}, {}};
   grown.more.fill(0xab);
   void *self = nullptr;
   void (*destroy)(void *) = nullptr;
   Status made = guardedCall(subject.provided->id, "create", Job(), [&](const diatom_call *call) {
      diatom_call changed = *call;
      change(changed, grown.create);
      return rawCreate(table, subject.provided->interface, &changed, &grown.create, &self, &destroy);
   });
   if (made && self)
      destroy(self);
   else if (made)
      return Error{ErrorCode::internal, "it says that it created something and hands over nothing"};
   return made;
}

void checkCommonScratch(const Subject &subject, Findings &findings)
{
   const Status made =
       createChanged(subject, [](diatom_call &call, diatom_create &) { call.scratch = noScratch; });
   if (!made && made.error().code != ErrorCode::internal)
      findings.warn("without scratch memory it cannot be created: " + made.error().message);
}

void checkCommonRecords(const Subject &subject, Findings &findings)
{
   const Status made = createChanged(subject, [](diatom_call &call, diatom_create &create) {
      call.size += 64;
      create.size += 64;
      call.service = noService;
   });
   if (!made)
      findings.fail("it does not take records that have grown at their ends: " + made.error().message);
}

struct Kind
{
   const char *name, *interface;
};
constexpr std::array kKinds{Kind{"lattice", DIATOM_LATTICE_1}, Kind{"parts", DIATOM_PARTS_1},
                            Kind{"machine", DIATOM_MACHINE_1}};

} // namespace

Result<std::unique_ptr<const Thing>> makeThing(const Subject &subject, const Values &values, const Job &job,
                                               Look look)
{
   const std::string &interface = subject.provided->interface;
   if (interface == DIATOM_LATTICE_1)
      return makeLatticeThing(subject, values, job, look);
   if (interface == DIATOM_PARTS_1)
      return makePartsThing(subject, values, job);
   return makeMachineThing(subject, values, job);
}

void addCommonChecks(std::vector<Check> &checks)
{
   for (const Kind &kind : kKinds) {
      const auto add = [&](const char *name, const char *promise, void (*run)(const Subject &, Findings &)) {
         checks.push_back({std::string(kind.name) + "." + name, promise, kind.interface, run});
      };
      add("life", "it can be created, asked and destroyed a thousand times and leaves nothing behind",
          checkCommonLife);
      add("parameters", "it works with the parameters that plugin.json allows, or says why not",
          checkCommonParameters);
      add("repeats", "the same question gets the same bytes, also from another one", checkCommonRepeats);
      add("threads", "eight threads at once get the same bytes", checkCommonThreads);
      add("scratch", "it bears that there is no scratch memory", checkCommonScratch);
      add("records", "it takes the longer records of a later minor", checkCommonRecords);
   }
}

} // namespace diatom::check
