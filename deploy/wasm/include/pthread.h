#pragma once

// Defines the part of pthreads that Abseil refers to, for programs of one thread. The wasi-libc of
// Debian 12 has the types, but no pthread.h.

#include <sys/types.h>

#define PTHREAD_ONCE_INIT 0

#ifdef __cplusplus
extern "C" {
#endif
static inline pthread_t pthread_self(void) { return 0; }
static inline int pthread_once(pthread_once_t* once, void (*call)(void)) {
  if (*once == 0) {
    *once = 1;
    call();
  }
  return 0;
}
#ifdef __cplusplus
}
#endif
