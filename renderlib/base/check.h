#pragma once

// BANDSAW_CHECK(condition, "why it holds") detects bugs in this program: if the condition is false,
// it prints a message and aborts the program. Bad input never makes a condition false.

#include <cstdio>
#include <cstdlib>

#define BANDSAW_CHECK(condition, why)                                                     \
  do {                                                                                    \
    if (!(condition)) {                                                                   \
      std::fprintf(stderr, "%s:%d: bug: %s (%s)\n", __FILE__, __LINE__, #condition, why); \
      std::abort();                                                                       \
    }                                                                                     \
  } while (false)

/// Like BANDSAW_CHECK, but only in builds without NDEBUG; for places where the cost matters.
#ifdef NDEBUG
#define BANDSAW_DCHECK(condition, why) \
  do {                                 \
  } while (false)
#else
#define BANDSAW_DCHECK(condition, why) BANDSAW_CHECK(condition, why)
#endif
