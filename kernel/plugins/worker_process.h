// The host's end of a worker: the process, the line to it, the memory that both see. The protocol's one
// caller.
#pragma once

#include "plugins/scene_pack.h"
#include "plugins/shared_memory.h"
#include "plugins/worker_protocol.h"

#include <diatom/abi/core.h>

#include <sys/types.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

inline constexpr const char *kWorkerDamaged = "what came from its process is damaged";

/// Says through report() why a call cannot be answered, and returns the status.
std::int32_t refuseCall(const diatom_call *call, const std::string &why,
                        std::int32_t status = DIATOM_INTERNAL);

/// One call at a time.
class WorkerProcess
{
public:
   struct Answer
   {
      WorkerReply reply;
      std::vector<std::string> texts;
   };

   /// Starts the program and has it load the plugin in `folder`; null after reporting why not.
   static std::unique_ptr<WorkerProcess> start(const diatom_call *call, const std::string &folder);
   ~WorkerProcess() { end(); }
   WorkerProcess(const WorkerProcess &) = delete;
   WorkerProcess &operator=(const WorkerProcess &) = delete;

   bool alive() const { return m_process > 0; }
   /// Room of at least so many bytes that the worker sees with the next request; null after reporting.
   std::byte *room(const diatom_call *call, std::size_t bytes);
   void dropRoom() { m_room = {}; }
   /// Puts it into that room; false after reporting.
   bool pack(const diatom_call *call, const SolverInput &input);

   /// One request and its reply, cancel and progress passed on while it runs. The status is the plugin's, or
   /// DIATOM_INTERNAL after reporting what became of the process.
   std::int32_t ask(const diatom_call *call, WorkerRequest request, std::string_view text, Answer &answer);

private:
   WorkerProcess(Line line, SharedMemory control, pid_t process);
   WorkerControl &control() const;
   std::int32_t ask(const diatom_call *call, WorkerRequest request, std::string_view text, Answer &answer,
                    const SharedMemory *block);
   std::int32_t wait(const diatom_call *call, Answer &answer);
   std::int32_t ended(const diatom_call *call);
   int end();

   Line m_line;
   SharedMemory m_control, m_room;
   bool m_sent = false; // the worker has m_room
   pid_t m_process;
};

} // namespace diatom
