#pragma once

// std::mutex for libraries, included before each of their files: libc++ for WebAssembly has none,
// because there is one thread.

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
