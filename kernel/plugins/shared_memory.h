// Memory that two processes see, and the line on which they send each other messages and such memory. POSIX.
#pragma once

#include "core/result.h"

#include <cstddef>
#include <string>
#include <string_view>

namespace diatom {

/// An open file descriptor; closes it.
class Descriptor
{
public:
   Descriptor() = default;
   explicit Descriptor(int number) : m_number(number) {}
   ~Descriptor() { reset(); }
   Descriptor(Descriptor &&other) noexcept : m_number(other.release()) {}
   Descriptor &operator=(Descriptor &&other) noexcept;

   int get() const { return m_number; }
   explicit operator bool() const { return m_number >= 0; }
   int release();
   void reset();

private:
   int m_number = -1;
};

/// Unmaps; the memory itself is gone when no process maps it and no descriptor is open.
class SharedMemory
{
public:
   SharedMemory() = default;
   /// Zeroed memory without a name.
   static Result<SharedMemory> make(std::size_t bytes);
   /// Memory that another process made. Errors: it is smaller than it should be.
   static Result<SharedMemory> map(Descriptor descriptor, std::size_t bytes);
   ~SharedMemory();
   SharedMemory(SharedMemory &&other) noexcept;
   SharedMemory &operator=(SharedMemory &&other) noexcept;

   std::byte *data() const { return m_data; } // aligned to pages; null when there is none
   std::size_t size() const { return m_size; }
   int descriptor() const { return m_descriptor.get(); }

private:
   Descriptor m_descriptor;
   std::byte *m_data = nullptr;
   std::size_t m_size = 0;
};

/// One end of a line. Messages arrive whole and in order, each with at most one descriptor.
class Line
{
public:
   static constexpr std::size_t kLongest = 64 * 1024; // bytes of a message; what is larger goes as memory

   explicit Line(Descriptor end) : m_end(std::move(end)) {}
   /// Two ends, closed in programs that are started.
   static Result<std::pair<Line, Line>> make();

   /// False once the other side is gone.
   bool send(std::string_view message, int descriptor = -1) const;
   enum class Got { message, nothing, closed };
   /// Waits at most so long; -1 = as long as it takes.
   Got receive(std::string &message, Descriptor &descriptor, int milliseconds) const;
   int get() const { return m_end.get(); }
   void close() { m_end.reset(); }

private:
   Descriptor m_end;
};

} // namespace diatom
