#pragma once

// Tells whether this build has a sanitizer, which makes every test several times slower.

namespace bandsaw::test {

/// True if built with AddressSanitizer or ThreadSanitizer.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// Approximate factor by which the sanitizer slows a test down. Long tests divide their amount of
/// work by this factor.
inline constexpr int kSlower = kSanitized ? 8 : 1;

}  // namespace bandsaw::test
