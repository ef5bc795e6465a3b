#pragma once

// std::vector for tables of megabytes that are read in random order. From 2 MiB on, its memory is
// on huge pages if the system provides them, so that a read seldom misses the TLB. (WebAssembly has
// no huge pages.) resize() and similar functions default-initialise new elements, so memory is not
// written twice.

#if !defined(__wasm__)
#include <sys/mman.h>
#endif

#include <cstddef>
#include <new>
#include <vector>

namespace bandsaw {

/// The allocator of HugeVector. Memory is aligned to 64 bytes, or to the size of a huge page if it
/// is at least as large as a huge page.
template <class T>
struct HugePages {
  using value_type = T;
  static constexpr std::size_t kPage = std::size_t{2} << 20;  ///< size of a huge page

  HugePages() = default;
  template <class U>
  explicit HugePages(const HugePages<U>&) {}

#if defined(__wasm__)
  static std::align_val_t alignment(std::size_t) { return std::align_val_t{64}; }
  static void use_huge_pages(void*, std::size_t) {}
#else
  static std::align_val_t alignment(std::size_t bytes) {
    return std::align_val_t{bytes >= kPage ? kPage : std::size_t{64}};
  }
  static void use_huge_pages(void* memory, std::size_t bytes) {
    if (bytes >= kPage) {
      ::madvise(memory, bytes, MADV_HUGEPAGE);  // a hint: if it is refused, pages are small
    }
  }
#endif
  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    void* memory = ::operator new(bytes, alignment(bytes));
    use_huge_pages(memory, bytes);
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) {
    ::operator delete(memory, alignment(count * sizeof(T)));
  }
  /// Default-initialises: numbers keep what is in the memory.
  template <class U>
  void construct(U* element) {
    ::new (static_cast<void*>(element)) U;
  }
  friend bool operator==(const HugePages&, const HugePages&) { return true; }
};

template <class T>
using HugeVector = std::vector<T, HugePages<T>>;

}  // namespace bandsaw
