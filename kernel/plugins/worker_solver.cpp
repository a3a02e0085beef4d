#include "plugins/worker_solver.h"

#include "core/text.h"
#include "plugins/worker_process.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace diatom {

namespace {

/// Lists of names in the reply to `capabilities`, as the record that the host reads.
struct CapabilitiesCopy
{
   std::array<std::vector<std::string>, 4> names; // physics, analyses, effects, lattices
   std::array<std::vector<const char *>, 4> pointers;
   diatom_capabilities record{};

   bool read(const std::vector<std::string> &texts)
   {
      std::size_t at = 0;
      for (std::size_t list = 0; list < names.size(); ++list) {
         const auto count = at < texts.size() ? parseInteger(texts[at++]) : std::nullopt;
         if (!count || *count < 0 || static_cast<std::size_t>(*count) > texts.size() - at)
            return false;
         for (std::int64_t k = 0; k < *count; ++k)
            names[list].push_back(texts[at++]);
         for (const std::string &name : names[list])
            pointers[list].push_back(name.c_str());
      }
      const auto deterministic = at < texts.size() ? parseInteger(texts[at]) : std::nullopt;
      record.size = sizeof record;
      record.physics = static_cast<std::int32_t>(names[0].size());
      record.physics_name = pointers[0].data();
      record.analyses = static_cast<std::int32_t>(names[1].size());
      record.analysis_name = pointers[1].data();
      record.effects = static_cast<std::int64_t>(names[2].size());
      record.effect_name = pointers[2].data();
      record.lattices = static_cast<std::int64_t>(names[3].size());
      record.lattice = pointers[3].data();
      record.deterministic = deterministic.value_or(0);
      return deterministic.has_value();
   }
};

/// Solvers from outside by id. The table's functions have no other way to know the plugin.
class Registry
{
public:
   void add(const Manifest &manifest, const std::string &id)
   {
      const std::lock_guard lock(m_mutex);
      Entry &entry = m_entries[id];
      if (entry.folder != manifest.folder.string())
         entry = {manifest.folder.string(), nullptr, nullptr};
   }

   /// The worker that made the estimate, or a new one; null after reporting why there is none.
   std::unique_ptr<WorkerProcess> take(const diatom_call *call, const std::string &id)
   {
      std::string folder;
      {
         const std::lock_guard lock(m_mutex);
         Entry &entry = m_entries[id];
         if (entry.spare && entry.spare->alive())
            return std::move(entry.spare);
         entry.spare.reset();
         folder = entry.folder;
      }
      return WorkerProcess::start(call, folder);
   }
   void put(const std::string &id, std::unique_ptr<WorkerProcess> worker)
   {
      const std::lock_guard lock(m_mutex);
      m_entries[id].spare = std::move(worker);
   }

   std::shared_ptr<const CapabilitiesCopy> capabilities(const std::string &id)
   {
      const std::lock_guard lock(m_mutex);
      return m_entries[id].capabilities;
   }
   /// Kept as long as the process, as the contract says of capabilities.
   const diatom_capabilities *keep(const std::string &id, std::shared_ptr<const CapabilitiesCopy> copy)
   {
      const std::lock_guard lock(m_mutex);
      m_kept.push_back(copy);
      m_entries[id].capabilities = std::move(copy);
      return &m_kept.back()->record;
   }

private:
   struct Entry
   {
      std::string folder;
      std::shared_ptr<const CapabilitiesCopy> capabilities;
      std::unique_ptr<WorkerProcess> spare;
   };
   std::mutex m_mutex;
   std::map<std::string, Entry> m_entries;
   std::vector<std::shared_ptr<const CapabilitiesCopy>> m_kept;
};

Registry &registry()
{
   static Registry solvers;
   return solvers;
}

struct RemoteSolver
{
   std::unique_ptr<WorkerProcess> worker;
   std::vector<std::string> texts; // of outputs
   std::vector<diatom_output> output;
   diatom_outputs outputs{};
};

RemoteSolver &remote(void *self) { return *static_cast<RemoteSolver *>(self); }

std::int32_t capabilities(const diatom_call *call, const char *id, const diatom_capabilities **caps)
{
   if (const auto known = registry().capabilities(id)) {
      *caps = &known->record;
      return DIATOM_OK;
   }
   auto worker = registry().take(call, id);
   if (!worker)
      return DIATOM_INTERNAL;
   WorkerRequest request;
   request.operation = WorkerOperation::capabilities;
   WorkerProcess::Answer answer;
   if (const std::int32_t status = worker->ask(call, request, id, answer); status != DIATOM_OK)
      return status;
   auto copy = std::make_shared<CapabilitiesCopy>();
   if (!copy->read(answer.texts))
      return refuseCall(call, kWorkerDamaged);
   *caps = registry().keep(id, std::move(copy));
   registry().put(id, std::move(worker));
   return DIATOM_OK;
}

std::int32_t estimate(const diatom_call *call, const diatom_create *create, const diatom_scene *scene,
                      diatom_estimate *found)
{
   auto worker = registry().take(call, create->id);
   if (!worker || !worker->pack(call, {create->values, scene, nullptr, 0}))
      return DIATOM_INTERNAL;
   WorkerRequest request;
   request.operation = WorkerOperation::estimate;
   WorkerProcess::Answer answer;
   const std::int32_t status = worker->ask(call, request, create->id, answer);
   if (status == DIATOM_OK)
      std::memcpy(found, &answer.reply.estimate,
                  std::min(static_cast<std::size_t>(found->size), sizeof answer.reply.estimate));
   registry().put(create->id, std::move(worker));
   return status;
}

std::int32_t create(const diatom_call *call, const diatom_create *create, const diatom_scene *scene,
                    void **self)
{
   auto solver = std::make_unique<RemoteSolver>();
   solver->worker = registry().take(call, create->id);
   if (!solver->worker || !solver->worker->pack(call, {create->values, scene, nullptr, 0}))
      return DIATOM_INTERNAL;
   WorkerRequest request;
   request.operation = WorkerOperation::create;
   WorkerProcess::Answer answer;
   const std::int32_t status = solver->worker->ask(call, request, create->id, answer);
   solver->worker->dropRoom();
   if (status == DIATOM_OK)
      *self = solver.release();
   return status;
}

std::int32_t apply(void *self, const diatom_call *call, const diatom_channel *channels, std::int64_t count)
{
   WorkerProcess &worker = *remote(self).worker;
   if (!worker.pack(call, {nullptr, nullptr, channels, count}))
      return DIATOM_NO_MEMORY;
   WorkerRequest request;
   request.operation = WorkerOperation::apply;
   WorkerProcess::Answer answer;
   return worker.ask(call, request, "", answer);
}

std::int32_t step(void *self, const diatom_call *call, const diatom_step_request *asked,
                  diatom_step_result *result)
{
   WorkerRequest request;
   request.operation = WorkerOperation::step;
   request.step = *asked;
   WorkerProcess::Answer answer;
   answer.reply.step.bad_cell = answer.reply.step.bad_link = -1;
   const std::int32_t status = remote(self).worker->ask(call, request, "", answer);
   // Also of a step that was cancelled; nothing of one whose process is gone.
   if (status == DIATOM_OK || answer.reply.step.size > 0)
      std::memcpy(result, &answer.reply.step,
                  std::min(static_cast<std::size_t>(result->size), sizeof answer.reply.step));
   return status;
}

std::int32_t outputs(void *self, const diatom_call *call, const diatom_outputs **list)
{
   RemoteSolver &solver = remote(self);
   WorkerRequest request;
   request.operation = WorkerOperation::outputs;
   WorkerProcess::Answer answer;
   if (const std::int32_t status = solver.worker->ask(call, request, "", answer); status != DIATOM_OK)
      return status;
   solver.texts = std::move(answer.texts);
   solver.output.clear();
   for (std::size_t k = 0; k + 3 < solver.texts.size(); k += 4) {
      const auto rows = parseInteger(solver.texts[k + 2]), stride = parseInteger(solver.texts[k + 3]);
      if (!rows || !stride || *rows < 0 || *stride < 1 || *stride > 1'000'000)
         return refuseCall(call, kWorkerDamaged);
      solver.output.push_back({solver.texts[k].c_str(), solver.texts[k + 1].c_str(), *rows, *stride});
   }
   solver.outputs = {sizeof solver.outputs, static_cast<std::int64_t>(solver.output.size()),
                     solver.output.data()};
   *list = &solver.outputs;
   return DIATOM_OK;
}

std::int32_t read(void *self, const diatom_call *call, std::int64_t output, std::int64_t first,
                  std::int64_t count, double *values)
{
   RemoteSolver &solver = remote(self);
   if (output < 0 || output >= solver.outputs.count)
      return refuseCall(call, "it has no such output");
   const auto bytes = sizeof(double) * static_cast<std::size_t>(
                                           count * solver.output[static_cast<std::size_t>(output)].stride);
   const std::byte *room = solver.worker->room(call, bytes);
   if (!room)
      return DIATOM_NO_MEMORY;
   WorkerRequest request;
   request.operation = WorkerOperation::read;
   request.output = output;
   request.first = first;
   request.count = count;
   WorkerProcess::Answer answer;
   const std::int32_t status = solver.worker->ask(call, request, "", answer);
   if (status == DIATOM_OK)
      std::memcpy(values, room, bytes);
   return status;
}

void destroy(void *self) { delete static_cast<RemoteSolver *>(self); }

} // namespace

const diatom_solver *workerSolver(const Manifest &manifest, const std::string &id)
{
   static constexpr diatom_solver kTable{capabilities, estimate, create, apply, step, outputs, read, destroy};
   registry().add(manifest, id);
   return &kTable;
}

} // namespace diatom
