// Memory of what a step runs through: in pages of 2 MB where the system has them. With pages of 4 kB, looking
// up where they are costs a virtual machine as much as the step.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace bonds {

template<typename T>
struct PageAllocator
{
   using value_type = T;
   static constexpr std::size_t kPage = std::size_t{1} << 21;

   PageAllocator() = default;
   template<typename U>
   PageAllocator(const PageAllocator<U> &) noexcept
   {}

   T *allocate(std::size_t count)
   {
      if (!large(count))
         return std::allocator<T>().allocate(count);
      if (count > static_cast<std::size_t>(-1) / 2 / sizeof(T))
         throw std::bad_array_new_length();
      const std::size_t bytes = (count * sizeof(T) + kPage - 1) / kPage * kPage;
      void *memory = std::aligned_alloc(kPage, bytes);
      if (!memory)
         throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
      madvise(memory, bytes, MADV_HUGEPAGE); // a wish: without, all works the same
#endif
      return static_cast<T *>(memory);
   }
   void deallocate(T *memory, std::size_t count) noexcept
   {
      if (large(count))
         std::free(memory);
      else
         std::allocator<T>().deallocate(memory, count);
   }
   static bool large(std::size_t count) { return count >= kPage / sizeof(T); }
   template<typename U>
   bool operator==(const PageAllocator<U> &) const
   {
      return true;
   }
};

template<typename T>
using PageVector = std::vector<T, PageAllocator<T>>;

} // namespace bonds
