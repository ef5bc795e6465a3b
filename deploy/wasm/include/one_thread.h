#pragma once

// Defines std::mutex, which libc++ for WebAssembly does not have because its programs have one
// thread. The build includes this header before each file of the libraries.

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
