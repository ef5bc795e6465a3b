#pragma once

// Defines std::mutex. libc++ for WebAssembly does not have it, because WebAssembly programs have
// one thread. The build includes this header at the start of each source file.

#ifdef __cplusplus
#include <mutex>
namespace std {
class mutex {
 public:
  constexpr mutex() noexcept = default;
  mutex(const mutex&) = delete;
  mutex& operator=(const mutex&) = delete;
  void lock() {}
  bool try_lock() { return true; }
  void unlock() {}
};
}  // namespace std
#endif
