// What every C++ plugin needs: parameter values, host services as a class, exceptions into statuses, the
// module record. Header-only; nothing here crosses the line to the host but the C tables of abi/.
#pragma once

#include <diatom/abi/core.h>

#include <cstdint>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

namespace diatom::sdk {
inline namespace v1 {

/// Thrown by a plugin to end a call with a status other than EXCEPTION; the text is what the user reads.
class Failure : public std::runtime_error
{
public:
   Failure(std::int32_t status, const std::string &text) : std::runtime_error(text), m_status(status) {}
   std::int32_t status() const { return m_status; }

private:
   std::int32_t m_status;
};

/// Host services of the current call.
class Call
{
public:
   explicit Call(const diatom_call *call) : m_call(call) {}

   void report(std::int32_t level, const std::string &text) const
   {
      m_call->report(m_call, level, text.c_str());
   }
   bool cancelled() const { return m_call->cancelled(m_call) != 0; }
   void progress(double fraction, const char *what) const { m_call->progress(m_call, fraction, what); }
   /// body(begin, end) over pieces of `grain`; must not throw.
   template<typename Body>
   void parallelFor(std::int64_t count, std::int64_t grain, Body &body) const
   {
      m_call->parallel_for(
          m_call, count, grain,
          [](void *context, std::int64_t begin, std::int64_t end) {
             (*static_cast<Body *>(context))(begin, end);
          },
          &body);
   }
   const diatom_call *raw() const { return m_call; }

private:
   const diatom_call *m_call;
};

/// Parameter values by name, as the host completed them.
class Values
{
public:
   explicit Values(const diatom_values *values) : m_values(values) {}

   double number(std::string_view name) const { return m_values->number[find(name)]; }
   std::string_view text(std::string_view name) const { return m_values->text[find(name)]; }

private:
   std::int64_t find(std::string_view name) const
   {
      for (std::int64_t i = 0; i < m_values->count; ++i)
         if (name == m_values->name[i])
            return i;
      throw Failure(DIATOM_INTERNAL, "the parameter \"" + std::string(name) + "\" is not in plugin.json");
   }
   const diatom_values *m_values;
};

/// Runs the body of a table entry: no exception leaves, each becomes a status and a text.
template<typename Body>
std::int32_t guarded(const diatom_call *call, Body &&body) noexcept
{
   try {
      body();
      return DIATOM_OK;
   } catch (const Failure &failure) {
      call->report(call, DIATOM_ERROR, failure.what());
      return failure.status();
   } catch (const std::bad_alloc &) {
      call->report(call, DIATOM_ERROR, "out of memory");
      return DIATOM_NO_MEMORY;
   } catch (const std::exception &exception) {
      call->report(call, DIATOM_ERROR, exception.what());
      return DIATOM_EXCEPTION;
   } catch (...) {
      call->report(call, DIATOM_ERROR, "an exception of unknown type");
      return DIATOM_EXCEPTION;
   }
}

} // namespace v1
} // namespace diatom::sdk

/// Defines the module's one exported symbol; `get` is a function from interface id to table.
#define DIATOM_MODULE(get)                                                                                   \
   extern "C" __attribute__((visibility("default"))) const diatom_module diatom_module_v1 = {                \
       sizeof(diatom_module), DIATOM_ABI_MINOR, 0, diatom_plugin_metadata, get};

#include DIATOM_PLUGIN_METADATA
