// What a solver's worker process and its host say to each other: a request, then one reply.
#pragma once

#include <diatom/abi/solver.h>

#include <atomic>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace diatom {

/// A page that both see while a call runs.
struct WorkerControl
{
   std::atomic<std::int32_t> cancelled{0};
   std::atomic<double> fraction{0};
};
static_assert(std::atomic<double>::is_always_lock_free && std::atomic<std::int32_t>::is_always_lock_free);

enum class WorkerOperation : std::int32_t {
   load,
   capabilities,
   estimate,
   create,
   apply,
   step,
   outputs,
   read
};

/// Followed by text where the operation has one. A block of memory, of `bytes`, comes as a descriptor with
/// the message: of `load` the control page, of `estimate`, `create` and `apply` packed input, of `read` the
/// room for values. A block stays until another one comes, or create() is done.
struct WorkerRequest
{
   WorkerOperation operation{};
   std::int32_t threads = 0; // that the call may use; 0 = all
   std::uint64_t bytes = 0;
   std::int64_t output = 0, first = 0, count = 0; // of read
   diatom_step_request step{};
};

/// Followed by what was reported and, where it succeeded, by what the operation gives: texts, each with its
/// length.
struct WorkerReply
{
   std::int32_t status = 0;
   std::int32_t texts = 0;
   diatom_estimate estimate{};
   diatom_step_result step{};
};

template<typename T>
void putRecord(std::string &message, const T &record)
{
   static_assert(std::is_trivially_copyable_v<T>);
   message.append(reinterpret_cast<const char *>(&record), sizeof record);
}

/// False when the message is too short.
template<typename T>
bool takeRecord(std::string_view &message, T &record)
{
   static_assert(std::is_trivially_copyable_v<T>);
   if (message.size() < sizeof record)
      return false;
   std::memcpy(&record, message.data(), sizeof record);
   message.remove_prefix(sizeof record);
   return true;
}

inline void putText(std::string &message, std::string_view text)
{
   putRecord(message, static_cast<std::uint32_t>(text.size()));
   message.append(text);
}

inline bool takeText(std::string_view &message, std::string &text)
{
   std::uint32_t length = 0;
   if (!takeRecord(message, length) || message.size() < length)
      return false;
   text.assign(message.substr(0, length));
   message.remove_prefix(length);
   return true;
}

} // namespace diatom
