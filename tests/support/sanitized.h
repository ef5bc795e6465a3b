#pragma once

namespace bandsaw::test {

/// Whether this is built with AddressSanitizer or ThreadSanitizer.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// How many times as long everything takes for that, about: what is long has so many times less to
/// do.
inline constexpr int kSlower = kSanitized ? 8 : 1;

}  // namespace bandsaw::test
