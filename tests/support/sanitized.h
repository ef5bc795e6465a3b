#pragma once

namespace bandsaw::test {

/// How many times as long a sample takes with a sanitizer, about: jobs of process tests have so
/// many fewer, and last as long.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr int kSlower = 8;
#else
inline constexpr int kSlower = 1;
#endif

}  // namespace bandsaw::test
