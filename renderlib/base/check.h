#pragma once

// BANDSAW_CHECK(condition, "why it holds") is for bugs in this program: it prints and aborts. Bad input never reaches it.

#include <cstdio>
#include <cstdlib>

#define BANDSAW_CHECK(condition, why)                                                          \
  do {                                                                                         \
    if (!(condition)) {                                                                        \
      std::fprintf(stderr, "%s:%d: bug: %s (%s)\n", __FILE__, __LINE__, #condition, why);      \
      std::abort();                                                                            \
    }                                                                                          \
  } while (false)

/// The same where the cost matters: only in builds without NDEBUG.
#ifdef NDEBUG
#define BANDSAW_DCHECK(condition, why) \
  do {                                 \
  } while (false)
#else
#define BANDSAW_DCHECK(condition, why) BANDSAW_CHECK(condition, why)
#endif
