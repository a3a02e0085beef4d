#include "plugins/shared_memory.h"

#include <fmt/format.h>

#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace diatom {

Descriptor &Descriptor::operator=(Descriptor &&other) noexcept
{
   if (this != &other) {
      reset();
      m_number = other.release();
   }
   return *this;
}

int Descriptor::release() { return std::exchange(m_number, -1); }

void Descriptor::reset()
{
   if (m_number >= 0)
      ::close(release());
}

Result<SharedMemory> SharedMemory::make(std::size_t bytes)
{
   Descriptor descriptor(::memfd_create("diatom", MFD_CLOEXEC));
   if (!descriptor || ::ftruncate(descriptor.get(), static_cast<off_t>(bytes)) != 0)
      return Error{ErrorCode::internal,
                   fmt::format("{} bytes to share with another process cannot be had ({})", bytes,
                               std::strerror(errno))};
   return map(std::move(descriptor), bytes);
}

Result<SharedMemory> SharedMemory::map(Descriptor descriptor, std::size_t bytes)
{
   struct stat found = {};
   if (::fstat(descriptor.get(), &found) != 0 || static_cast<std::size_t>(found.st_size) < bytes ||
       bytes == 0)
      return Error{ErrorCode::internal, "memory shared with another process is smaller than was said"};
   void *data = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor.get(), 0);
   if (data == MAP_FAILED)
      return Error{ErrorCode::internal,
                   fmt::format("{} bytes shared with another process cannot be reached ({})", bytes,
                               std::strerror(errno))};
   SharedMemory memory;
   memory.m_descriptor = std::move(descriptor);
   memory.m_data = static_cast<std::byte *>(data);
   memory.m_size = bytes;
   return memory;
}

SharedMemory::~SharedMemory()
{
   if (m_data)
      ::munmap(m_data, m_size);
}

SharedMemory::SharedMemory(SharedMemory &&other) noexcept
    : m_descriptor(std::move(other.m_descriptor)), m_data(std::exchange(other.m_data, nullptr)),
      m_size(std::exchange(other.m_size, 0))
{}

SharedMemory &SharedMemory::operator=(SharedMemory &&other) noexcept
{
   if (this != &other) {
      if (m_data)
         ::munmap(m_data, m_size);
      m_descriptor = std::move(other.m_descriptor);
      m_data = std::exchange(other.m_data, nullptr);
      m_size = std::exchange(other.m_size, 0);
   }
   return *this;
}

Result<std::pair<Line, Line>> Line::make()
{
   std::array<int, 2> ends{};
   if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
      return Error{ErrorCode::internal,
                   fmt::format("a line to another process cannot be had ({})", std::strerror(errno))};
   return std::pair(Line(Descriptor(ends[0])), Line(Descriptor(ends[1])));
}

bool Line::send(std::string_view message, int descriptor) const
{
   iovec part{const_cast<char *>(message.data()), message.size()}; // sendmsg only reads it
   msghdr header{};
   header.msg_iov = &part;
   header.msg_iovlen = 1;
   alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
   if (descriptor >= 0) {
      header.msg_control = control.data();
      header.msg_controllen = control.size();
      cmsghdr *rights = CMSG_FIRSTHDR(&header);
      rights->cmsg_level = SOL_SOCKET;
      rights->cmsg_type = SCM_RIGHTS;
      rights->cmsg_len = CMSG_LEN(sizeof(int));
      std::memcpy(CMSG_DATA(rights), &descriptor, sizeof(int));
   }
   ssize_t sent = 0;
   do
      sent = ::sendmsg(m_end.get(), &header, MSG_NOSIGNAL);
   while (sent < 0 && errno == EINTR);
   return sent == static_cast<ssize_t>(message.size());
}

Line::Got Line::receive(std::string &message, Descriptor &descriptor, int milliseconds) const
{
   pollfd wait{m_end.get(), POLLIN, 0};
   const int ready = ::poll(&wait, 1, milliseconds);
   if (ready <= 0)
      return ready == 0 || errno == EINTR ? Got::nothing : Got::closed;
   message.resize(kLongest);
   iovec part{message.data(), message.size()};
   msghdr header{};
   header.msg_iov = &part;
   header.msg_iovlen = 1;
   alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
   header.msg_control = control.data();
   header.msg_controllen = control.size();
   const ssize_t got = ::recvmsg(m_end.get(), &header, MSG_CMSG_CLOEXEC);
   if (got < 0 && errno == EINTR)
      return Got::nothing;
   if (got <= 0)
      return Got::closed;
   message.resize(static_cast<std::size_t>(got));
   descriptor.reset();
   if (const cmsghdr *rights = CMSG_FIRSTHDR(&header);
       rights && rights->cmsg_level == SOL_SOCKET && rights->cmsg_type == SCM_RIGHTS)
   {
      int number = -1;
      std::memcpy(&number, CMSG_DATA(rights), sizeof(int));
      descriptor = Descriptor(number);
   }
   return Got::message;
}

} // namespace diatom
